// The comparison itself: a golden test that passes on a visibly different picture is
// worse than none.
#include "test.h"

#include <math.h>
#include <string.h>

#include "compare.h"
#include "render_tolerance.h"

enum { W = 64, H = 48 };

static struct orl_image picture(void)
{
    struct orl_image image;
    assert_int_equal(orl_image_init(NULL, &image, W, H, 3, ORL_PIXEL_F32), ORL_OK);
    for (int i = 0; i < W * H; i++) {
        double x = i % W, y = i / W;
        image.f32[3 * i] = (float)(0.3 + 0.2 * sin(0.5 * x + 0.2 * y));
        image.f32[3 * i + 1] = (float)(0.3 + 0.2 * sin(0.6 * x) * sin(0.7 * y));
        image.f32[3 * i + 2] = (float)(0.2 + 0.1 * cos(0.3 * y));
    }
    return image;
}

static bool agrees(const struct orl_image *actual)
{
    struct orl_image expected = picture();
    struct golden_report report;
    bool ok = golden_compare(actual, &expected, &color_tolerance, &report);
    orl_image_finish(&expected);
    return ok;
}

static void the_same_picture_passes(void **state)
{
    (void)state;
    struct orl_image image = picture();
    assert_true(agrees(&image));
    // Rounding of another driver.
    for (int i = 0; i < W * H * 3; i++)
        image.f32[i] *= 1 + (i % 2 ? 1e-3f : -1e-3f);
    assert_true(agrees(&image));
    image.f32[3 * 777] += 0.1f; // one pixel decided the other way
    assert_true(agrees(&image));
    orl_image_finish(&image);
}

static void a_shift_by_one_pixel_fails(void **state)
{
    (void)state;
    const int steps[2] = {3, 3 * W};
    for (int k = 0; k < 2; k++) {
        struct orl_image image = picture(), from = picture();
        for (int i = steps[k]; i < W * H * 3; i++)
            image.f32[i] = from.f32[i - steps[k]];
        assert_false(agrees(&image));
        orl_image_finish(&image);
        orl_image_finish(&from);
    }
}

static void another_brightness_fails(void **state)
{
    (void)state;
    const float factors[] = {0.93f, 1.07f};
    for (size_t k = 0; k < ORL_COUNT(factors); k++) {
        struct orl_image image = picture();
        for (int i = 0; i < W * H * 3; i++)
            image.f32[i] *= factors[k];
        assert_false(agrees(&image));
        orl_image_finish(&image);
    }
}

static void a_hole_fails(void **state)
{
    (void)state;
    struct orl_image image = picture();
    for (int y = 20; y < 28; y++)
        memset(image.f32 + 3 * (y * W + 30), 0, 8 * 3 * sizeof(float));
    assert_false(agrees(&image));
    orl_image_finish(&image);
}

static void swapped_channels_fail(void **state)
{
    (void)state;
    struct orl_image image = picture();
    for (int i = 0; i < W * H; i++) {
        float red = image.f32[3 * i];
        image.f32[3 * i] = image.f32[3 * i + 2];
        image.f32[3 * i + 2] = red;
    }
    assert_false(agrees(&image));
    orl_image_finish(&image);
}

static void values_that_are_not_finite_fail(void **state)
{
    (void)state;
    const float values[] = {NAN, INFINITY, -INFINITY};
    for (size_t k = 0; k < ORL_COUNT(values); k++) {
        struct orl_image image = picture();
        image.f32[1234] = values[k];
        assert_false(agrees(&image));
        orl_image_finish(&image);
    }
}

static void another_size_fails(void **state)
{
    (void)state;
    struct orl_image image = picture();
    image.height--;
    assert_false(agrees(&image));
    orl_image_finish(&image);
}

// Through files: written on demand, kept apart by driver, and on a mismatch the
// pictures to look at appear.
static void goldens_in_files(void **state)
{
    (void)state;
    static const char *const rgb[] = {"R", "G", "B"};
    char *dir = test_dir_make(), path[4200];
    struct orl_image image = picture();
    assert_int_equal(unsetenv("ORIEL_UPDATE_GOLDEN"), 0);
    assert_false(golden_check(dir, dir, "a", "none", rgb, &image, &color_tolerance));
    assert_int_equal(setenv("ORIEL_UPDATE_GOLDEN", "1", 1), 0);
    assert_true(golden_check(dir, dir, "a", "none", rgb, &image, &color_tolerance));
    assert_int_equal(unsetenv("ORIEL_UPDATE_GOLDEN"), 0);
    assert_true(golden_check(dir, dir, "a", "none", rgb, &image, &color_tolerance));
    snprintf(path, sizeof path, "%s/a.diff.exr", dir);
    assert_false(orl_path_is_file(path));
    for (int i = 0; i < W * H * 3; i++)
        image.f32[i] += 0.1f;
    assert_false(golden_check(dir, dir, "a", "none", rgb, &image, &color_tolerance));
    assert_true(orl_path_is_file(path));
    snprintf(path, sizeof path, "%s/a.actual.exr", dir);
    assert_true(orl_path_is_file(path));
    // The brighter picture becomes the golden of one driver only.
    snprintf(path, sizeof path, "a.other");
    assert_int_equal(setenv("ORIEL_UPDATE_GOLDEN", "1", 1), 0);
    assert_true(golden_check(dir, dir, path, "none", rgb, &image, &color_tolerance));
    assert_int_equal(unsetenv("ORIEL_UPDATE_GOLDEN"), 0);
    assert_true(golden_check(dir, dir, "a", "other", rgb, &image, &color_tolerance));
    assert_false(golden_check(dir, dir, "a", "none", rgb, &image, &color_tolerance));
    orl_image_finish(&image);
    test_dir_remove(dir);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(the_same_picture_passes),
        cmocka_unit_test(a_shift_by_one_pixel_fails),
        cmocka_unit_test(another_brightness_fails),
        cmocka_unit_test(a_hole_fails),
        cmocka_unit_test(swapped_channels_fail),
        cmocka_unit_test(values_that_are_not_finite_fail),
        cmocka_unit_test(another_size_fails),
        cmocka_unit_test(goldens_in_files),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
