#include "test.h"

#include <math.h>

#include "eval/radiance_metrics.h"

static struct orl_image filled(int width, int height, float value)
{
    struct orl_image image;
    assert_int_equal(orl_image_init(NULL, &image, width, height, 3, ORL_PIXEL_F32), ORL_OK);
    for (int i = 0; i < width * height * 3; i++)
        image.f32[i] = value;
    return image;
}

static struct orl_radiance_metrics compare(const struct orl_image *a, const struct orl_image *b,
                                           const struct orl_image *coverage)
{
    struct orl_radiance_metrics m;
    assert_int_equal(orl_radiance_compare(NULL, a, b, coverage, &m), ORL_OK);
    return m;
}

// The published encoding: its ends (p_min, p_max of the authors' PyTorch version), and
// 100 cd/m2 near 256, which is what it was scaled for.
static void pu21_as_published(void **state)
{
    (void)state;
    assert_float_equal(orl_pu21_encode(0.005), 0, 1e-6);
    assert_float_equal(orl_pu21_encode(10000), 595.3939, 1e-3);
    assert_float_equal(orl_pu21_encode(100), 256, 1);
    assert_true(orl_pu21_encode(0) == orl_pu21_encode(0.005));
    assert_true(orl_pu21_encode(1e9) == orl_pu21_encode(10000));
    double last = -1;
    for (double stops = -7; stops < 13; stops += 0.5) {
        double value = orl_pu21_encode(exp2(stops));
        assert_true(value > last);
        last = value;
    }
}

static void equal_radiance(void **state)
{
    (void)state;
    struct orl_image a = filled(5, 4, 0.3f);
    struct orl_radiance_metrics m = compare(&a, &a, NULL);
    assert_float_equal(m.pu21_psnr_db, 100, 0);
    assert_float_equal(m.mu_psnr_db, 100, 0);
    assert_float_equal(m.log2_rmse, 0, 0);
    orl_image_finish(&a);
}

// Truth 1 and 0.5: the picture at 0.5 and 0.25 is one stop off, all of which one factor mends.
static void one_stop_of_scale(void **state)
{
    (void)state;
    struct orl_image truth = filled(2, 1, 1), half = filled(2, 1, 0.5f);
    for (int c = 0; c < 3; c++) {
        truth.f32[3 + c] = 0.5f;
        half.f32[3 + c] = 0.25f;
    }
    struct orl_radiance_metrics m = compare(&half, &truth, NULL);
    assert_float_equal(m.log2_rmse, 1, 1e-9);
    assert_float_equal(m.log2_rmse_fitted, 0, 1e-6);
    // mu-law: (log 5001 - log 2501) / log 5001 = 0.081361 and (log 2501 - log 1251) / log 5001
    // = 0.081338: -20 log10(0.081349) = 21.793.
    assert_float_equal(m.mu_psnr_db, 21.793, 2e-3);
    // mu-law: of shares of the greatest light, so that the unit of light does not matter.
    for (int i = 0; i < 6; i++) {
        truth.f32[i] *= 8;
        half.f32[i] *= 8;
    }
    assert_float_equal(compare(&half, &truth, NULL).mu_psnr_db, 21.793, 2e-3);
    for (int i = 0; i < 6; i++) {
        truth.f32[i] /= 8;
        half.f32[i] /= 8;
    }
    // PU21 at 100, 50 and 25 cd/m2, by the formula.
    double d1 = orl_pu21_encode(100) - orl_pu21_encode(50);
    double d2 = orl_pu21_encode(50) - orl_pu21_encode(25);
    assert_float_equal(m.pu21_psnr_db, 10 * log10(256 * 256 / ((d1 * d1 + d2 * d2) / 2)), 1e-9);
    orl_image_finish(&truth);
    orl_image_finish(&half);
}

// Errors of +1 and -1 stop: no factor helps.
static void fit_takes_no_more_than_scale(void **state)
{
    (void)state;
    struct orl_image truth = filled(2, 1, 1), other = filled(2, 1, 2);
    for (int c = 0; c < 3; c++)
        other.f32[3 + c] = 0.5f;
    struct orl_radiance_metrics m = compare(&other, &truth, NULL);
    assert_float_equal(m.log2_rmse, 1, 1e-9);
    assert_float_equal(m.log2_rmse_fitted, 1, 1e-9);
    orl_image_finish(&truth);
    orl_image_finish(&other);
}

static void coverage_counts_for_stops_alone(void **state)
{
    (void)state;
    struct orl_image truth = filled(2, 1, 1), other = filled(2, 1, 1), coverage;
    assert_int_equal(orl_image_init(NULL, &coverage, 2, 1, 1, ORL_PIXEL_F32), ORL_OK);
    coverage.f32[0] = 1;
    for (int c = 0; c < 3; c++)
        other.f32[3 + c] = 0.25f;
    struct orl_radiance_metrics m = compare(&other, &truth, &coverage);
    assert_float_equal(m.log2_rmse, 0, 0);
    assert_true(m.mu_psnr_db < 20 && m.pu21_psnr_db < 20);
    coverage.f32[1] = 1;
    m = compare(&other, &truth, &coverage);
    assert_float_equal(m.log2_rmse, sqrt(0.5 * 4), 1e-9); // two stops in half the pixels
    orl_image_finish(&truth);
    orl_image_finish(&other);
    orl_image_finish(&coverage);
}

// Black where there is light counts 20 stops below the brightest; black truth not at all.
static void black_has_a_floor(void **state)
{
    (void)state;
    struct orl_image truth = filled(2, 1, 1), other = filled(2, 1, 0);
    for (int c = 0; c < 3; c++)
        truth.f32[3 + c] = 0;
    other.f32[1] = NAN;
    other.f32[2] = -3;
    struct orl_radiance_metrics m = compare(&other, &truth, NULL);
    assert_float_equal(m.log2_rmse, 20, 1e-9);
    struct orl_radiance_metrics none;
    struct orl_image black = filled(2, 1, 0), wide = filled(3, 1, 1);
    assert_int_equal(orl_radiance_compare(NULL, &other, &black, NULL, &none), ORL_ERR_DATA);
    assert_int_equal(orl_radiance_compare(NULL, &wide, &truth, NULL, &none), ORL_ERR_ARGUMENT);
    orl_image_finish(&truth);
    orl_image_finish(&other);
    orl_image_finish(&black);
    orl_image_finish(&wide);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(pu21_as_published),
        cmocka_unit_test(equal_radiance),
        cmocka_unit_test(one_stop_of_scale),
        cmocka_unit_test(fit_takes_no_more_than_scale),
        cmocka_unit_test(coverage_counts_for_stops_alone),
        cmocka_unit_test(black_has_a_floor),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
