// From pixels to radiance and trust, without a device.
#include <math.h>

#include "oriel/radiance.h"
#include "test.h"

static const struct orl_sensor sensor = {ORL_SENSOR_DEFAULTS};

static void trust_falls_towards_white(void **state)
{
    (void)state;
    assert_float_equal(orl_clip_trust(&sensor, 0.5f, 0), 1, 1e-6);
    float last = 1;
    for (float x = 0.7f; x < 1.2f; x += 0.01f) {
        float trust = orl_clip_trust(&sensor, x, 3);
        assert_true(trust <= last && trust > 0);
        last = trust;
    }
    // Of photographs that all clip the darkest counts most; half floats hold every trace.
    // A quarter of the way it has fallen by 3/16 - 2/64.
    float quarter = (float)(sensor.soft + 0.25 * (sensor.hard - sensor.soft));
    assert_float_equal(orl_clip_trust(&sensor, quarter, 60), 1 - 5 / 32.0, 1e-4);
    assert_float_equal(orl_clip_trust(&sensor, 1, 0), 0x1p-10, 1e-9);
    assert_float_equal(orl_clip_trust(&sensor, 1, 3), 0x1p-16, 1e-9);
    assert_float_equal(orl_clip_trust(&sensor, 1, 60), (double)ORL_TRUST_MIN, 1e-12);
}

static void noise_is_photons_reading_and_rounding(void **state)
{
    (void)state;
    const float half[3] = {0.5f, 0.5f, 0.5f}, dark[3] = {0.001f, 0.001f, 0.001f};
    // 1e-4 x + 4e-8, over x^2.
    assert_float_equal(orl_relative_variance(&sensor, half, false), (5e-5 + 4e-8) / 0.25, 1e-9);
    // A step of 8-bit sRGB is 1 / (12.92 * 255) there.
    double step = 1 / (12.92 * 255);
    assert_float_equal(orl_relative_variance(&sensor, dark, true),
                       (1e-7 + 4e-8 + step * step / 12) / 1e-6, 1e-5);
    // Brighter, steps grow as the root of the light.
    double bright = 1.6 * sqrt(0.5) / 255;
    assert_float_equal(orl_relative_variance(&sensor, half, true),
                       (5e-5 + 4e-8 + bright * bright / 12) / 0.25, 1e-8);
    assert_float_equal(orl_relative_variance(&sensor, dark, false), 0.14, 1e-5);
    assert_float_equal(orl_least_radiance(&sensor, 3, false), 2e-4 / 8, 1e-9);
    assert_true(orl_least_radiance(&sensor, 0, true) > orl_least_radiance(&sensor, 0, false));
}

static void decode(const struct orl_photo_response *response, struct orl_image *in,
                   struct orl_image *out, float *white)
{
    assert_int_equal(orl_radiance_decode(NULL, response, in, out, white), ORL_OK);
    assert_int_equal(out->channels, 4);
}

static void eight_bits_go_through_the_curve(void **state)
{
    (void)state;
    float curve[3][256], white;
    for (int c = 0; c < 3; c++)
        for (int v = 0; v < 256; v++)
            curve[c][v] = powf((float)v / 255, (float)(1 + c));
    struct orl_image in, out;
    assert_int_equal(orl_image_init(NULL, &in, 3, 1, 3, ORL_PIXEL_U8), ORL_OK);
    const uint8_t values[9] = {100, 100, 100, 255, 10, 10, 188, 188, 188};
    memcpy(in.u8, values, sizeof values);
    struct orl_photo_response response = {.sensor = &sensor, .centre = {1.5f, 0.5f}};
    response.linear = (const float (*)[256])curve;
    decode(&response, &in, &out, &white);
    assert_float_equal(white, 1, 0);
    assert_float_equal(out.f32[3], 1, 1e-6);
    for (int c = 0; c < 3; c++)
        assert_float_equal(out.f32[c], powf(100 / 255.0f, (float)(1 + c)), 1e-6);
    // One clipped channel spoils the pixel, whose colour leaves hardly a mark.
    assert_true(out.f32[7] < 0.002f && out.f32[4] < 0.002f);
    assert_float_equal(out.f32[4], out.f32[7], 1e-6);
    orl_image_finish(&out);
    // sRGB: 188 is about a half, and vignetting is undone: 0.8 of the light at r2 = 0.4.
    response.linear = NULL;
    response.vignette[0] = -0.5f;
    decode(&response, &in, &out, &white);
    assert_float_equal(out.f32[8] / out.f32[11], 0.5029 / 0.8, 1e-3);
    orl_image_finish(&out);
    orl_image_finish(&in);
}

static void linear_light_may_exceed_white(void **state)
{
    (void)state;
    struct orl_image in, out;
    float white;
    struct orl_photo_response response = {.sensor = &sensor, .centre = {1, 0.5f}};
    assert_int_equal(orl_image_init(NULL, &in, 2, 1, 3, ORL_PIXEL_F32), ORL_OK);
    const float bright[6] = {20, 2, 0.2f, NAN, -1, INFINITY};
    memcpy(in.f32, bright, sizeof bright);
    decode(&response, &in, &out, &white);
    assert_float_equal(white, 20, 0);
    assert_float_equal(out.f32[3], 1, 0); // nothing clips
    assert_float_equal(out.f32[0] * white, 20, 1e-5);
    assert_float_equal(out.f32[2] * white, 0.2, 1e-6);
    for (int k = 4; k < 8; k++) // what is not light has no trust, and no colour to spread
        assert_float_equal(out.f32[k], 0, 0);
    orl_image_finish(&out);
    // 16 bits and RAW clip at 1.
    const float clipped[6] = {1, 1, 1, 0.5f, 0.5f, 0.5f};
    memcpy(in.f32, clipped, sizeof clipped);
    decode(&response, &in, &out, &white);
    assert_true(out.f32[3] < 0.002f);
    assert_float_equal(out.f32[7], 1, 1e-6);
    orl_image_finish(&out);
    orl_image_finish(&in);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(trust_falls_towards_white),
        cmocka_unit_test(noise_is_photons_reading_and_rounding),
        cmocka_unit_test(eight_bits_go_through_the_curve),
        cmocka_unit_test(linear_light_may_exceed_white),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
