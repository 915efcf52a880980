// Silhouettes of pictures made by hand.
#include <stdlib.h>
#include <string.h>

#include "scene/silhouette.h"
#include "test.h"

enum { W = 80, H = 60 };

static struct orl_image filled(uint8_t r, uint8_t g, uint8_t b)
{
    struct orl_image image;
    assert_int_equal(orl_image_init(NULL, &image, W, H, 3, ORL_PIXEL_U8), ORL_OK);
    for (size_t i = 0; i < W * H; i++) {
        image.u8[3 * i] = r;
        image.u8[3 * i + 1] = g;
        image.u8[3 * i + 2] = b;
    }
    return image;
}

static void box(struct orl_image *image, int x0, int y0, int x1, int y1, uint8_t r, uint8_t g,
                uint8_t b)
{
    for (int y = y0; y < y1; y++)
        for (int x = x0; x < x1; x++) {
            uint8_t *at = image->u8 + 3 * (y * W + x);
            at[0] = r;
            at[1] = g;
            at[2] = b;
        }
}

// Exactly the box is set.
static void check_box(const struct orl_image *mask, int x0, int y0, int x1, int y1)
{
    for (int y = 0; y < H; y++)
        for (int x = 0; x < W; x++) {
            bool in = x >= x0 && x < x1 && y >= y0 && y < y1;
            // Opening rounds corners off.
            bool corner = (x == x0 || x == x1 - 1) && (y == y0 || y == y1 - 1);
            if (!corner && mask->u8[y * W + x] != (in ? 255 : 0))
                fail_msg("%d,%d is %d", x, y, mask->u8[y * W + x]);
        }
}

static void marks_edges(void **state)
{
    (void)state;
    struct orl_image mask;
    assert_int_equal(orl_image_init(NULL, &mask, 5, 4, 1, ORL_PIXEL_U8), ORL_OK);
    // The right two columns and the bottom row lie at the picture's end, which is no boundary.
    static const uint8_t given[20] = {0, 0, 0, 0, 0, 0, 1, 9, 255, 1,
                                      0, 1, 1, 1, 1, 0, 1, 1, 1, 1};
    static const uint8_t expected[20] = {0, 0, 0, 0, 0, 0, 128, 128, 128, 128,
                                         0, 128, 255, 255, 255, 0, 128, 255, 255, 255};
    memcpy(mask.u8, given, sizeof given);
    orl_silhouette_mark_edges(&mask);
    assert_memory_equal(mask.u8, expected, sizeof expected);
    orl_image_finish(&mask);
}

static void finds_what_is_bright(void **state)
{
    (void)state;
    struct orl_image picture = filled(12, 10, 9), mask;
    int used;
    box(&picture, 20, 15, 60, 45, 10, 120, 20); // one bright channel is enough
    box(&picture, 30, 25, 31, 26, 5, 5, 5);     // a shadow in it
    box(&picture, 70, 50, 71, 51, 200, 200, 200); // a glint beside it
    assert_int_equal(orl_silhouette_dark(NULL, &picture, -1, &used, &mask), ORL_OK);
    assert_between(used, 12, 119);
    check_box(&mask, 20, 15, 60, 45);
    orl_image_finish(&mask);
    assert_int_equal(orl_silhouette_dark(NULL, &picture, 119, &used, &mask), ORL_OK);
    assert_int_equal(used, 119);
    check_box(&mask, 20, 15, 60, 45);
    orl_image_finish(&mask);
    assert_int_equal(orl_silhouette_dark(NULL, &picture, 120, &used, &mask), ORL_OK);
    check_box(&mask, 0, 0, 0, 0);
    orl_image_finish(&mask);
    orl_image_finish(&picture);
}

static void learns_backgrounds(void **state)
{
    (void)state;
    struct orl_background background = {0};
    static const uint8_t values[] = {10, 20, 30, 40};
    for (size_t i = 0; i < ORL_COUNT(values); i++) {
        struct orl_image picture = filled(values[i], 7, 255);
        assert_int_equal(orl_background_add(NULL, &background, &picture), ORL_OK);
        orl_image_finish(&picture);
    }
    assert_float_equal(background.mean.f32[0], 25, 1e-4);
    assert_float_equal(background.deviation.f32[0], 125, 1e-3); // variance of 10, 20, 30, 40
    assert_float_equal(background.mean.f32[2], 255, 1e-4);
    assert_float_equal(background.deviation.f32[2], 0, 1e-4);
    struct orl_image other;
    struct said said;
    struct orl_log log = log_to(&said);
    assert_int_equal(orl_image_init(NULL, &other, 4, 4, 3, ORL_PIXEL_U8), ORL_OK);
    assert_int_equal(orl_background_add(&log, &background, &other), ORL_ERR_DATA);
    assert_non_null(strstr(said.text, "4x4 pixels among those of 80x60"));
    orl_image_finish(&other);
    orl_background_finish(&background);
}

static void tells_shadows_from_subjects(void **state)
{
    (void)state;
    const struct orl_difference_params params = {ORL_DIFFERENCE_DEFAULTS};
    struct orl_background background = {0};
    struct orl_image empty = filled(100, 140, 120), picture = filled(102, 139, 121), mask;
    assert_int_equal(orl_background_add(NULL, &background, &empty), ORL_OK);
    box(&picture, 2, 2, 20, 50, 70, 98, 84);    // a shadow: 0.7 of each colour
    box(&picture, 22, 2, 36, 50, 110, 154, 132); // reflected light: 1.1
    box(&picture, 40, 10, 60, 40, 160, 60, 60); // another colour
    assert_int_equal(orl_silhouette_difference(NULL, &background, &params, &picture, &mask),
                     ORL_OK);
    check_box(&mask, 40, 10, 60, 40);
    orl_image_finish(&mask);
    box(&picture, 40, 10, 60, 40, 30, 42, 36); // the same colour, too dark for a shadow
    assert_int_equal(orl_silhouette_difference(NULL, &background, &params, &picture, &mask),
                     ORL_OK);
    check_box(&mask, 40, 10, 60, 40);
    orl_image_finish(&mask);
    box(&picture, 40, 10, 60, 40, 150, 210, 180); // and too bright for a reflection
    assert_int_equal(orl_silhouette_difference(NULL, &background, &params, &picture, &mask),
                     ORL_OK);
    check_box(&mask, 40, 10, 60, 40);
    orl_image_finish(&mask);
    orl_image_finish(&empty);
    orl_image_finish(&picture);
    orl_background_finish(&background);
}

// Two pixels are a speck, five are not.
static void specks_go(void **state)
{
    (void)state;
    const struct orl_difference_params params = {ORL_DIFFERENCE_DEFAULTS};
    struct orl_background background = {0};
    struct orl_image empty = filled(100, 140, 120), picture = filled(100, 140, 120), mask;
    assert_int_equal(orl_background_add(NULL, &background, &empty), ORL_OK);
    box(&picture, 10, 10, 12, 11, 160, 60, 60);
    box(&picture, 40, 30, 45, 31, 160, 60, 60);
    assert_int_equal(orl_silhouette_difference(NULL, &background, &params, &picture, &mask),
                     ORL_OK);
    assert_int_equal(mask.u8[10 * W + 10], 0);
    assert_int_equal(mask.u8[30 * W + 42], 255);
    orl_image_finish(&mask);
    orl_image_finish(&empty);
    orl_image_finish(&picture);
    orl_background_finish(&background);
}

// Where the background itself moves, the same difference says nothing.
static void tolerates_unsteady_pixels(void **state)
{
    (void)state;
    const struct orl_difference_params params = {ORL_DIFFERENCE_DEFAULTS};
    struct orl_background background = {0};
    struct orl_image picture = filled(100, 100, 140), mask;
    for (int i = 0; i < 10; i++) {
        struct orl_image empty = filled(100, 100, 100);
        box(&empty, 0, 0, 40, H, 100, 100, i % 2 ? 60 : 140);
        assert_int_equal(orl_background_add(NULL, &background, &empty), ORL_OK);
        orl_image_finish(&empty);
    }
    assert_int_equal(orl_silhouette_difference(NULL, &background, &params, &picture, &mask),
                     ORL_OK);
    check_box(&mask, 40, 0, W, H);
    orl_image_finish(&mask);
    orl_image_finish(&picture);
    orl_background_finish(&background);
}

// What lies beyond the picture is unknown: a subject that fills it has no edge.
static void the_border_is_no_edge(void **state)
{
    (void)state;
    struct orl_image mask;
    assert_int_equal(orl_image_init(NULL, &mask, W, H, 1, ORL_PIXEL_U8), ORL_OK);
    memset(mask.u8, 255, W * H);
    mask.u8[30 * W + 40] = 0;
    orl_silhouette_mark_edges(&mask);
    for (int i = 0; i < W * H; i++) {
        int apart = abs(i % W - 40) + abs(i / W - 30);
        assert_int_equal(mask.u8[i], apart == 0 ? ORL_ALPHA_OUT
                                                : apart == 1 ? ORL_ALPHA_EDGE : ORL_ALPHA_IN);
    }
    orl_image_finish(&mask);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(the_border_is_no_edge),
        cmocka_unit_test(marks_edges), cmocka_unit_test(finds_what_is_bright),
        cmocka_unit_test(learns_backgrounds), cmocka_unit_test(tells_shadows_from_subjects),
        cmocka_unit_test(tolerates_unsteady_pixels), cmocka_unit_test(specks_go),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
