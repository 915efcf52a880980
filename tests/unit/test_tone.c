#include "test.h"

#include <math.h>

#include "core/color.h"
#include "oriel/render.h"
#include "render/output/tone.h"

static struct orl_image pixels(const float (*rgb)[3], int count)
{
    struct orl_image image;
    assert_int_equal(orl_image_init(NULL, &image, count, 1, 3, ORL_PIXEL_F32), ORL_OK);
    memcpy(image.f32, rgb, (size_t)count * sizeof *rgb);
    return image;
}

static struct orl_image tone(const struct orl_image *linear, enum orl_tone_curve curve, double ev)
{
    struct orl_image srgb;
    struct orl_tone_params params = {ORL_TONE_DEFAULTS};
    params.curve = curve;
    params.exposure_ev = ev;
    assert_int_equal(orl_tone_apply(NULL, linear, &params, &srgb), ORL_OK);
    return srgb;
}

static void srgb_is_the_standard(void **state)
{
    (void)state;
    assert_float_equal(orl_srgb_encode(0.18f), 0.461356, 1e-5);
    assert_float_equal(orl_srgb_decode(0.5f), 0.214041, 1e-6);
    assert_float_equal(orl_srgb_encode(0.0031308f), 0.04045, 1e-5); // where line and power meet
    for (int v = 0; v < 256; v++)
        assert_int_equal(lrintf(255 * orl_srgb_encode(orl_srgb_decode((float)v / 255))), v);
    assert_true(orl_srgb_encode(NAN) == 0 && orl_srgb_encode(-1) == 0 && orl_srgb_encode(2) == 1);
}

static void default_clips_at_white(void **state)
{
    (void)state;
    const float rgb[][3] = {{0, 0.18f, 1}, {7, -1, NAN}, {INFINITY, 0.5f, 0.002f}};
    const uint8_t want[] = {0, 118, 255, 255, 0, 0, 255, 188, 7};
    struct orl_image linear = pixels(rgb, 3), srgb, same = tone(&linear, ORL_TONE_SRGB, 0);
    assert_int_equal(orl_tone_srgb(NULL, &linear, &srgb), ORL_OK);
    assert_memory_equal(srgb.u8, want, sizeof want);
    assert_memory_equal(same.u8, want, sizeof want);
    orl_image_finish(&srgb);
    orl_image_finish(&same);
    orl_image_finish(&linear);
}

static void exposure_is_in_stops(void **state)
{
    (void)state;
    const float dark[][3] = {{0.045f, 0.045f, 0.045f}}, bright[][3] = {{0.18f, 0.18f, 0.18f}};
    struct orl_image a = pixels(dark, 1), b = pixels(bright, 1);
    for (int curve = 0; curve < ORL_TONE_DRAGO; curve++) {
        struct orl_image lifted = tone(&a, (enum orl_tone_curve)curve, 2);
        struct orl_image plain = tone(&b, (enum orl_tone_curve)curve, 0);
        assert_memory_equal(lifted.u8, plain.u8, 3);
        orl_image_finish(&lifted);
        orl_image_finish(&plain);
    }
    orl_image_finish(&a);
    orl_image_finish(&b);
}

// Equation 4 by hand: L = 1 with white 8: (1 + 1/64) / 2 = 0.50781; L = 8 becomes 1.
static void reinhard_maps_its_white_to_white(void **state)
{
    (void)state;
    const float rgb[][3] = {{1, 1, 1}, {8, 8, 8}, {2, 1, 0}};
    struct orl_image linear = pixels(rgb, 3), srgb = tone(&linear, ORL_TONE_REINHARD, 0);
    assert_int_equal(srgb.u8[0], lrintf(255 * orl_srgb_encode(0.50781f)));
    assert_int_equal(srgb.u8[3], 255);
    // L = 2 * 0.2126 + 0.7152 = 1.1404: factor (1 + L/64) / (1 + L) = 0.47554; hue stays.
    assert_int_equal(srgb.u8[6], lrintf(255 * orl_srgb_encode(2 * 0.47554f)));
    assert_int_equal(srgb.u8[7], lrintf(255 * orl_srgb_encode(0.47554f)));
    assert_int_equal(srgb.u8[8], 0);
    orl_image_finish(&srgb);
    orl_image_finish(&linear);
}

// 0.18 * 0.6 = 0.108: 0.108 (2.51 0.108 + 0.03) / (0.108 (2.43 0.108 + 0.59) + 0.14) = 0.14005.
static void filmic_has_toe_and_shoulder(void **state)
{
    (void)state;
    const float rgb[][3] = {{0.18f, 0, 1e5f}};
    struct orl_image linear = pixels(rgb, 1), srgb = tone(&linear, ORL_TONE_FILMIC, 0);
    assert_int_equal(srgb.u8[0], lrintf(255 * orl_srgb_encode(0.14005f)));
    assert_int_equal(srgb.u8[1], 0);
    assert_int_equal(srgb.u8[2], 255);
    orl_image_finish(&srgb);
    orl_image_finish(&linear);
}

// A ramp over 16 stops: brighter never comes out darker, and more of it differs than clipped.
static void curves_rise_and_keep_range(void **state)
{
    (void)state;
    enum { SIZE = 64 };
    struct orl_image linear;
    assert_int_equal(orl_image_init(NULL, &linear, SIZE, SIZE, 3, ORL_PIXEL_F32), ORL_OK);
    for (int i = 0; i < SIZE * SIZE; i++)
        for (int c = 0; c < 3; c++)
            linear.f32[3 * i + c] = exp2f(16 * (float)i / (SIZE * SIZE) - 10);
    int levels[ORL_TONE_COUNT];
    for (int curve = 0; curve < ORL_TONE_COUNT; curve++) {
        struct orl_image srgb = tone(&linear, (enum orl_tone_curve)curve, 0);
        levels[curve] = 1;
        for (int i = 1; i < SIZE * SIZE; i++) {
            // Mantiuk's contrast works by neighbourhood, so it rises on the large scale only.
            if (curve != ORL_TONE_MANTIUK)
                assert_true(srgb.u8[3 * i] >= srgb.u8[3 * i - 3]);
            else if (i >= SIZE * SIZE / 2)
                assert_true(srgb.u8[3 * i] >= srgb.u8[3 * (i - SIZE * SIZE / 2)]);
            levels[curve] += linear.f32[3 * i] > 1 && srgb.u8[3 * i] > srgb.u8[3 * i - 3];
        }
        orl_image_finish(&srgb);
    }
    assert_int_equal(levels[ORL_TONE_SRGB], 1);
    for (int curve = ORL_TONE_SRGB + 1; curve < ORL_TONE_COUNT; curve++)
        assert_true(levels[curve] > 15);
    orl_image_finish(&linear);
}

static void nothing_breaks_whole_picture_curves(void **state)
{
    (void)state;
    const float black[][3] = {{0, 0, 0}, {0, 0, 0}}, odd[][3] = {{NAN, INFINITY, -1}, {1, 2, 3}};
    for (int curve = ORL_TONE_DRAGO; curve <= ORL_TONE_MANTIUK; curve++) {
        struct orl_image a = pixels(black, 2), b = pixels(odd, 2);
        struct orl_image dark = tone(&a, (enum orl_tone_curve)curve, 0);
        for (int i = 0; i < 6; i++)
            assert_int_equal(dark.u8[i], 0);
        struct orl_image any = tone(&b, (enum orl_tone_curve)curve, 0);
        orl_image_finish(&dark);
        orl_image_finish(&any);
        orl_image_finish(&a);
        orl_image_finish(&b);
    }
}

// Holes are black in every curve, never what is left of a division by nothing.
static void holes_stay_black(void **state)
{
    (void)state;
    float rgb[16 * 16][3] = {{0}};
    for (int i = 20; i < 16 * 16; i++)
        for (int c = 0; c < 3; c++)
            rgb[i][c] = 0.01f * (float)(i + c);
    struct orl_image linear;
    assert_int_equal(orl_image_init(NULL, &linear, 16, 16, 3, ORL_PIXEL_F32), ORL_OK);
    memcpy(linear.f32, rgb, sizeof rgb);
    for (int curve = 0; curve < ORL_TONE_COUNT; curve++) {
        struct orl_image srgb = tone(&linear, (enum orl_tone_curve)curve, 0);
        for (int i = 0; i < 20 * 3; i++)
            assert_int_equal(srgb.u8[i], 0);
        assert_true(srgb.u8[3 * 255] > 200);
        orl_image_finish(&srgb);
    }
    orl_image_finish(&linear);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(srgb_is_the_standard),
        cmocka_unit_test(default_clips_at_white),
        cmocka_unit_test(exposure_is_in_stops),
        cmocka_unit_test(reinhard_maps_its_white_to_white),
        cmocka_unit_test(filmic_has_toe_and_shoulder),
        cmocka_unit_test(curves_rise_and_keep_range),
        cmocka_unit_test(nothing_breaks_whole_picture_curves),
        cmocka_unit_test(holes_stay_black),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
