#include "test.h"

#include <math.h>
#include <string.h>

#include "bridge/bridge.h"
#include "eval/metrics.h"

enum { W = 24, H = 19 };

static struct orl_image make(int width, int height, int channels, enum orl_pixel type)
{
    struct orl_image image;
    assert_int_equal(orl_image_init(NULL, &image, width, height, channels, type), ORL_OK);
    return image;
}

static int pattern_a(int x, int y, int c)
{
    return (x * 7 + y * 13 + c * 50 + (x * y) % 11 * 5) % 256;
}

static int pattern_b(int x, int y, int c)
{
    int value = pattern_a(x, y, c) * 3 / 4 + 20 + ((x * 5 + y * 3 + c) % 7 - 3) * 4;
    return value < 0 ? 0 : value > 255 ? 255 : value;
}

static int pattern_inverse(int x, int y, int c)
{
    return 255 - pattern_a(x, y, c);
}

static struct orl_image paint(int (*pattern)(int, int, int))
{
    struct orl_image image = make(W, H, 3, ORL_PIXEL_U8);
    for (int i = 0; i < W * H * 3; i++)
        image.u8[i] = (uint8_t)pattern(i / 3 % W, i / 3 / W, i % 3);
    return image;
}

static struct orl_image flat(int width, int height, uint8_t r, uint8_t g, uint8_t b)
{
    struct orl_image image = make(width, height, 3, ORL_PIXEL_U8);
    for (int i = 0; i < width * height; i++) {
        image.u8[3 * i] = r;
        image.u8[3 * i + 1] = g;
        image.u8[3 * i + 2] = b;
    }
    return image;
}

static struct orl_image covered(int width, int height, float value)
{
    struct orl_image image = make(width, height, 1, ORL_PIXEL_F32);
    for (int i = 0; i < width * height; i++)
        image.f32[i] = value;
    return image;
}

// Compares and releases the pictures.
static struct orl_metrics compare(struct orl_image a, struct orl_image b,
                                  struct orl_image coverage)
{
    struct orl_metrics metrics;
    assert_int_equal(orl_metrics_compare(NULL, &a, &b, &coverage, &metrics), ORL_OK);
    orl_image_finish(&a);
    orl_image_finish(&b);
    orl_image_finish(&coverage);
    return metrics;
}

static void identical_pictures(void **state)
{
    (void)state;
    struct orl_metrics m = compare(paint(pattern_a), paint(pattern_a), covered(W, H, 1));
    assert_float_equal(m.psnr_db, 100, 0);
    assert_float_equal(m.psnr_cc_db, 100, 1e-6);
    assert_float_equal(m.psnr_covered_db, 100, 0);
    assert_float_equal(m.ssim, 1, 1e-6);
    assert_float_equal(m.coverage, 1, 0);
    assert_float_equal(m.completeness, 1, 0);
    assert_float_equal(m.ncc_error, 0, 1e-12);
    assert_float_equal(m.crumbs, 0, 0);
}

// MSE of an offset of 10 is 100: 10 log10(65025 / 100). A colour fit takes it away.
// SSIM of flat pictures is its luminance term alone.
static void constant_offset(void **state)
{
    (void)state;
    struct orl_metrics m =
        compare(flat(W, H, 100, 100, 100), flat(W, H, 110, 110, 110), covered(W, H, 1));
    assert_float_equal(m.psnr_db, 28.130803609, 1e-6);
    assert_float_equal(m.psnr_cc_db, 100, 1e-6);
    double c1 = 2.55 * 2.55;
    double want = (2 * 100.0 * 110 + c1) / (100.0 * 100 + 110.0 * 110 + c1);
    assert_float_equal(m.ssim, want, 1e-5);
    assert_float_equal(m.ncc_error, 0, 0);
}

// From a separate program in double precision with direct 2-D windows.
static void known_answers(void **state)
{
    (void)state;
    struct orl_metrics m = compare(paint(pattern_a), paint(pattern_b), covered(W, H, 1));
    assert_float_equal(m.psnr_db, 20.690803467, 1e-6);
    assert_float_equal(m.psnr_cc_db, 30.076602521, 1e-3);
    assert_float_equal(m.ssim, 0.938324333, 1e-5);
    assert_float_equal(m.ncc_error, 0.022611102, 1e-7);
    m = compare(paint(pattern_a), paint(pattern_inverse), covered(W, H, 1));
    assert_float_equal(m.ssim, -0.803330023, 1e-5);
    assert_true(m.psnr_cc_db > 90); // an inversion is affine
    assert_true(m.ncc_error > 1.9);
}

// Four wrong pixels of one 4x4 picture, half of them covered, by hand: MSE over all
// 4 * 60^2 * 3 / (16 * 3) = 900, over the eight covered pixels 2 * 60^2 / 8 = 900.
static void covered_pixels_count_alone(void **state)
{
    (void)state;
    struct orl_image a = flat(4, 4, 50, 50, 50), coverage = covered(4, 4, 0);
    for (int i = 0; i < 8; i++)
        coverage.f32[i] = 0.75f;
    const int wrong[4] = {0, 1, 8, 9};
    for (int k = 0; k < 4; k++)
        memset(a.u8 + 3 * wrong[k], 110, 3);
    struct orl_metrics m = compare(a, flat(4, 4, 50, 50, 50), coverage);
    assert_float_equal(m.coverage, 0.5, 0);
    assert_float_equal(m.psnr_db, 10 * log10(65025.0 / 900), 1e-9);
    assert_float_equal(m.psnr_covered_db, 10 * log10(65025.0 / 900), 1e-9);

    a = flat(4, 4, 50, 50, 50);
    coverage = covered(4, 4, 0);
    coverage.f32[5] = 1;
    memset(a.u8, 110, 3); // an uncovered pixel
    m = compare(a, flat(4, 4, 50, 50, 50), coverage);
    assert_float_equal(m.psnr_covered_db, 100, 0);
    assert_true(m.psnr_db < 30);
}

static void nothing_covered(void **state)
{
    (void)state;
    struct orl_metrics m = compare(paint(pattern_a), paint(pattern_b), covered(W, H, 0.5f));
    assert_float_equal(m.coverage, 0, 0);
    assert_float_equal(m.psnr_covered_db, 0, 0);
    assert_true(m.psnr_db > 20); // holes do not leave the headline figure
}

// One black pixel in the middle of a 15x15 picture spoils the 7x7 patches that hold it.
static void holes_are_incomplete(void **state)
{
    (void)state;
    struct orl_image a = flat(15, 15, 90, 90, 90), b = flat(15, 15, 90, 90, 90);
    for (int i = 0; i < 15 * 15; i++) {
        a.u8[3 * i] = (uint8_t)(80 + i % 7);
        b.u8[3 * i] = (uint8_t)(80 + i % 7);
    }
    memset(a.u8 + 3 * (7 * 15 + 7), 0, 3);
    struct orl_metrics m = compare(a, b, covered(15, 15, 1));
    assert_float_equal(m.completeness, 224.0 / 225, 1e-12);
    assert_float_equal(m.ncc_error, 0, 1e-12); // patches with the hole are left out

    m = compare(flat(9, 9, 0, 0, 0), flat(9, 9, 90, 90, 90), covered(9, 9, 0));
    assert_float_equal(m.completeness, 0, 0);
    assert_float_equal(m.ncc_error, 0, 0);
}

static void flat_against_textured(void **state)
{
    (void)state;
    struct orl_metrics m = compare(flat(W, H, 90, 90, 90), paint(pattern_a), covered(W, H, 1));
    assert_float_equal(m.ncc_error, 1, 1e-12);
}

static void dab(struct orl_image *image, int x, int y, uint8_t value)
{
    memset(image->u8 + 3 * (y * image->width + x), value, 3);
}

// Grey 100 has the square root of luma 0.626: grey 134 stands 0.0987 out of it and grey 135 0.1014;
// grey 66 -0.1175; in the photograph grey 110 stands 0.0306 out and grey 111 0.0335.
static void specks_are_crumbs(void **state)
{
    (void)state;
    struct orl_image a = flat(50, 20, 100, 100, 100), b = flat(50, 20, 100, 100, 100);
    dab(&a, 4, 4, 134);   // too faint; two of them, so that in luma itself there is one crumb more
    dab(&a, 4, 10, 134);
    dab(&a, 10, 4, 135);  // a crumb
    dab(&a, 20, 4, 66);   // a crumb: darker ones count alike
    dab(&a, 30, 4, 135);  // no crumb: two pixels away the photograph has a detail
    dab(&b, 32, 6, 111);
    dab(&a, 40, 4, 135);  // a crumb: this detail is three pixels away
    dab(&b, 43, 4, 111);
    dab(&a, 10, 14, 135); // a crumb: this detail is too faint
    dab(&b, 10, 14, 110);
    dab(&a, 49, 19, 135); // a crumb: repeated beyond the corner, it fills 9 of 25 pixels
    for (int y = 12; y < 15; y++) // 12 crumbs: the three in the middle are of 15 equal ones in 25
        for (int x = 20; x < 25; x++)
            dab(&a, x, y, 200);
    struct orl_metrics m = compare(a, b, covered(50, 20, 1));
    assert_float_equal(m.crumbs, 1e4 * (5 + 12) / 1000, 1e-9);
}

// Its left half is off by 10 and has a crumb, and a tenth of it is not covered.
static void figures_of_a_part_are_of_its_pixels(void **state)
{
    (void)state;
    struct orl_image a = flat(40, 20, 100, 100, 100), b = flat(40, 20, 100, 100, 100);
    struct orl_image coverage = covered(40, 20, 1), part = covered(40, 20, 0);
    for (int i = 0; i < 40 * 20; i++)
        if (i % 40 < 20) {
            dab(&b, i % 40, i / 40, 110);
            part.f32[i] = 1;
            coverage.f32[i] = i / 40 < 18;
        }
    struct orl_part_metrics m;
    assert_int_equal(orl_metrics_of_part(NULL, &a, &b, &coverage, &part, &m), ORL_OK);
    assert_float_equal(m.psnr_db, 20 * log10(255.0 / 10), 1e-6);
    assert_float_equal(m.coverage, 0.9, 1e-9);
    assert_float_equal(m.crumbs, 0, 0);
    dab(&a, 10, 10, 200); // a crumb of the part
    dab(&a, 30, 10, 200); // one that is not of the part
    assert_int_equal(orl_metrics_of_part(NULL, &a, &b, &coverage, &part, &m), ORL_OK);
    assert_float_equal(m.crumbs, 1e4 / 400, 1e-9);
    memset(part.f32, 0, orl_image_bytes(&part));
    assert_int_equal(orl_metrics_of_part(NULL, &a, &b, &coverage, &part, &m), ORL_OK);
    assert_float_equal(m.psnr_db, 0, 0);
    orl_image_finish(&a);
    orl_image_finish(&b);
    orl_image_finish(&coverage);
    orl_image_finish(&part);
}

static void colour_fit_undoes_an_affine_change(void **state)
{
    (void)state;
    struct orl_image a = paint(pattern_a), b = paint(pattern_a);
    for (int i = 0; i < W * H; i++) {
        const uint8_t *p = a.u8 + 3 * i;
        b.u8[3 * i] = (uint8_t)lround(0.3 * p[0] + 0.2 * p[1] + 40);
        b.u8[3 * i + 1] = (uint8_t)lround(0.6 * p[1] + 10);
        b.u8[3 * i + 2] = (uint8_t)lround(0.1 * p[0] + 0.5 * p[2] + 30);
    }
    struct orl_metrics m = compare(a, b, covered(W, H, 1));
    assert_true(m.psnr_db < 20);
    assert_true(m.psnr_cc_db > 57); // what rounding leaves: MSE 1/12
}

static void pictures_of_any_size(void **state)
{
    (void)state;
    const int sizes[][2] = {{1, 1}, {3, 200}, {10, 10}, {11, 11}, {6, 40}};
    for (size_t i = 0; i < ORL_COUNT(sizes); i++) {
        int w = sizes[i][0], h = sizes[i][1];
        struct orl_metrics m =
            compare(flat(w, h, 10, 200, 30), flat(w, h, 10, 200, 30), covered(w, h, 1));
        assert_float_equal(m.ssim, 1, 1e-6);
        assert_float_equal(m.psnr_cc_db, 100, 1e-6);
    }
}

static void different_sizes_are_refused(void **state)
{
    (void)state;
    struct orl_image a = flat(8, 8, 1, 1, 1), b = flat(8, 9, 1, 1, 1), c = covered(8, 8, 1);
    struct orl_metrics m;
    assert_int_equal(orl_metrics_compare(NULL, &a, &b, &c, &m), ORL_ERR_ARGUMENT);
    orl_image_finish(&a);
    orl_image_finish(&b);
    orl_image_finish(&c);
}

static void resize_averages_areas(void **state)
{
    (void)state;
    struct orl_image big = make(4, 2, 1, ORL_PIXEL_F32), small;
    for (int i = 0; i < 8; i++)
        big.f32[i] = (float)i;
    assert_int_equal(orl_bridge_resize(NULL, &big, 2, 1, &small), ORL_OK);
    assert_float_equal(small.f32[0], (0 + 1 + 4 + 5) / 4.0, 1e-6);
    assert_float_equal(small.f32[1], (2 + 3 + 6 + 7) / 4.0, 1e-6);
    orl_image_finish(&small);
    assert_int_equal(orl_bridge_resize(NULL, &big, 0, 1, &small), ORL_ERR_ARGUMENT);
    assert_null(small.data);
    orl_image_finish(&big);
}

static void blur_keeps_the_sum(void **state)
{
    (void)state;
    struct orl_image dot = make(31, 31, 1, ORL_PIXEL_F32), blurred;
    dot.f32[15 * 31 + 15] = 1;
    assert_int_equal(orl_bridge_blur(NULL, &dot, 11, 1.5, &blurred), ORL_OK);
    double sum = 0, taps = 0;
    for (int i = 0; i < 31 * 31; i++)
        sum += blurred.f32[i];
    for (int i = -5; i <= 5; i++)
        taps += exp(-i * i / 4.5);
    assert_float_equal(sum, 1, 1e-5);
    assert_float_equal(blurred.f32[15 * 31 + 15], 1 / (taps * taps), 1e-6);
    assert_float_equal(blurred.f32[15 * 31 + 21], 0, 0); // beyond the taps
    orl_image_finish(&dot);
    orl_image_finish(&blurred);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(identical_pictures),
        cmocka_unit_test(constant_offset),
        cmocka_unit_test(known_answers),
        cmocka_unit_test(covered_pixels_count_alone),
        cmocka_unit_test(nothing_covered),
        cmocka_unit_test(holes_are_incomplete),
        cmocka_unit_test(flat_against_textured),
        cmocka_unit_test(specks_are_crumbs),
        cmocka_unit_test(figures_of_a_part_are_of_its_pixels),
        cmocka_unit_test(colour_fit_undoes_an_affine_change),
        cmocka_unit_test(pictures_of_any_size),
        cmocka_unit_test(different_sizes_are_refused),
        cmocka_unit_test(resize_averages_areas),
        cmocka_unit_test(blur_keeps_the_sum),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
