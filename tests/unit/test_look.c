// What photographs look like: sharpness, one view, one picture; and the frames of a video.
#include "test.h"

#include <math.h>

#include "preprocess/photos/video_frames.h"
#include "preprocess/photos/look.h"

enum { W = 320, H = 240 };

// Any reproducible noise (Numerical Recipes' constants).
static uint32_t noise(uint32_t *state)
{
    *state = *state * 1664525u + 1013904223u;
    return *state >> 8;
}

// Detail of all sizes, `at` pixels to the right, blurred over 2 `across` + 1 and 2 `down` + 1
// pixels, at `gain` of the exposure.
static struct orl_look look_at(int at, int across, int down, double gain)
{
    static float pixels[H + 32][W + 192];
    static bool made;
    struct orl_image image;
    struct orl_look look;
    uint32_t state = 1;
    for (int size = 64; size >= 1 && !made; size /= 2)
        for (int y = 0; y < H + 32; y += size)
            for (int x = 0; x < W + 192; x += size) {
                float value = (float)(noise(&state) % 48) - 24;
                for (int v = y; v < y + size && v < H + 32; v++)
                    for (int u = x; u < x + size && u < W + 192; u++)
                        pixels[v][u] += value;
            }
    made = true;
    assert_int_equal(orl_image_init(NULL, &image, W, H, 1, ORL_PIXEL_U8), ORL_OK);
    for (int y = 0; y < H; y++)
        for (int x = 0; x < W; x++) {
            float sum = 0;
            for (int v = -down; v <= down; v++)
                for (int u = -across; u <= across; u++)
                    sum += pixels[16 + y + v][16 + at + x + u];
            double value = gain * (128 + sum / (float)((2 * across + 1) * (2 * down + 1)));
            image.u8[y * W + x] = (uint8_t)fmin(fmax(value, 0), 255);
        }
    assert_int_equal(orl_look_make(NULL, &image, &look), ORL_OK);
    orl_image_finish(&image);
    return look;
}

static void blur_shows_in_any_direction(void **state)
{
    (void)state;
    struct orl_look looks[9];
    float limit;
    for (int i = 0; i < 9; i++)
        looks[i] = look_at(16 * i, 0, 0, 1 - 0.05 * i);
    assert_int_equal(orl_look_blurred_below(NULL, looks, 9, &limit), ORL_OK);
    for (int i = 0; i < 9; i++)
        assert_true(looks[i].sharpness > limit + 1);
    assert_true(look_at(0, 4, 4, 1).sharpness < limit);  // out of focus
    assert_true(look_at(0, 10, 0, 1).sharpness < limit); // moved
    assert_true(look_at(0, 0, 10, 1).sharpness < limit);
    assert_int_equal(orl_look_blurred_below(NULL, looks, 3, &limit), ORL_OK);
    assert_true(isinf(limit)); // too few to tell
}

static void darkness_is_not_blur(void **state)
{
    (void)state;
    assert_true(isinf(look_at(0, 0, 0, 0.02).sharpness));
    // Nor does it make the other photographs blurred, however many are dark.
    static struct orl_look looks[30];
    float limit;
    for (int i = 0; i < 30; i++)
        looks[i] = i < 10 ? look_at(16 * i, 0, 0, 1) : look_at(0, 0, 0, 0.02);
    assert_int_equal(orl_look_blurred_below(NULL, looks, 30, &limit), ORL_OK);
    for (int i = 0; i < 10; i++)
        assert_true(looks[i].sharpness > limit && limit > looks[i].sharpness - 4);
}

static void one_picture_is_recognised(void **state)
{
    (void)state;
    struct orl_look a = look_at(0, 0, 0, 1), darker = look_at(0, 0, 0, 0.8);
    struct orl_look coded = look_at(0, 0, 0, 0.99), moved = look_at(8, 0, 0, 1);
    assert_true(orl_look_same_picture(&a, &coded));
    assert_true(orl_look_same_view(&a, &darker));
    assert_false(orl_look_same_picture(&a, &darker)); // a series of exposures
    assert_false(orl_look_same_picture(&a, &moved));
    struct orl_look nothing = {0};
    assert_false(orl_look_same_picture(&nothing, &nothing)); // no texture: nothing is known
}

static void sharpest_frames_are_chosen_evenly(void **state)
{
    (void)state;
    const float blur[] = {3, 1, 2, 9, 0, 0, 5, 4, 3, 2, 0, 0, INFINITY};
    size_t chosen[8];
    assert_int_equal(orl_frames_choose(blur, ORL_COUNT(blur), 6, chosen), 3);
    assert_int_equal(chosen[0], 1); // the last third is not looked at
    assert_int_equal(chosen[1], 9);
    assert_int_equal(chosen[2], 12);
    assert_int_equal(orl_frames_choose(blur, 5, 1, chosen), 5);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(blur_shows_in_any_direction),
        cmocka_unit_test(darkness_is_not_blur),
        cmocka_unit_test(one_picture_is_recognised),
        cmocka_unit_test(sharpest_frames_are_chosen_evenly),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
