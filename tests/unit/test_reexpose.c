#include "test.h"

#include <math.h>

#include "core/color.h"
#include "render/output/reexpose.h"
#include "render/output/tone.h"
#include "scene/meter.h"

enum { W = 41, H = 31 };

static struct orl_photo photo;
static struct orl_response response;
static struct orl_scene scene = {.photos = &photo, .photo_count = 1};

static int set_up(void **state)
{
    (void)state;
    photo = (struct orl_photo){.view.camera = {W, H, 50, 50, 20.5, 15.5}, .gain = {1, 1, 1},
                               .response = -1};
    scene.responses = &response;
    scene.response_count = 1;
    return 0;
}

// A ramp that reaches beyond white.
static struct orl_image ramp(void)
{
    struct orl_image image;
    assert_int_equal(orl_image_init(NULL, &image, W, H, 3, ORL_PIXEL_F32), ORL_OK);
    for (int i = 0; i < W * H * 3; i++)
        image.f32[i] = 1.5f * (float)i / (W * H * 3);
    return image;
}

static struct orl_image expose(const struct orl_image *light)
{
    struct orl_image picture;
    assert_int_equal(orl_photo_expose(NULL, &scene, 0, light, &picture), ORL_OK);
    return picture;
}

static void plain_photographs_are_srgb(void **state)
{
    (void)state;
    struct orl_image light = ramp(), picture = expose(&light), srgb;
    struct orl_tone_params tone = {ORL_TONE_DEFAULTS};
    assert_int_equal(orl_tone_apply(NULL, &light, &tone, &srgb), ORL_OK);
    assert_memory_equal(picture.u8, srgb.u8, W * H * 3);
    orl_image_finish(&light);
    orl_image_finish(&picture);
    orl_image_finish(&srgb);
}

// A gain of 4 brings a photograph two stops under the middle exposure up to it.
static void gain_is_undone_per_channel(void **state)
{
    (void)state;
    struct orl_image light = ramp();
    photo.gain[0] = 4;
    photo.gain[2] = 0.5f;
    struct orl_image picture = expose(&light);
    for (int i = 0; i < W * H * 3; i++) {
        float exposure = light.f32[i] / photo.gain[i % 3];
        assert_int_equal(picture.u8[i], lrintf(255 * orl_srgb_encode(exposure)));
    }
    orl_image_finish(&light);
    orl_image_finish(&picture);
}

// Whatever the curve, a value's own exposure gives that value, and the middle between two
// is where they part.
static void curves_are_inverted(void **state)
{
    (void)state;
    photo.response = 0;
    for (int c = 0; c < 3; c++)
        for (int v = 0; v < 256; v++)
            response.linear[c][v] = powf((float)v / 255, 1.8f + 0.3f * (float)c);
    struct orl_image light;
    assert_int_equal(orl_image_init(NULL, &light, 256, 4, 3, ORL_PIXEL_F32), ORL_OK);
    for (int v = 0; v < 256; v++)
        for (int c = 0; c < 3; c++) {
            float here = response.linear[c][v], next = response.linear[c][v < 255 ? v + 1 : v];
            light.f32[3 * v + c] = here;
            light.f32[3 * (256 + v) + c] = here + 0.49f * (next - here);
            light.f32[3 * (512 + v) + c] = here + 0.51f * (next - here);
            light.f32[3 * (768 + v) + c] = v % 2 ? 7 : NAN;
        }
    struct orl_image picture = expose(&light);
    for (int v = 0; v < 256; v++)
        for (int c = 0; c < 3; c++) {
            assert_int_equal(picture.u8[3 * v + c], v);
            assert_int_equal(picture.u8[3 * (256 + v) + c], v);
            assert_int_equal(picture.u8[3 * (512 + v) + c], v < 255 ? v + 1 : v);
            assert_int_equal(picture.u8[3 * (768 + v) + c], v % 2 ? 255 : 0);
        }
    orl_image_finish(&light);
    orl_image_finish(&picture);
}

// 1 - 0.3 r^2 - 0.1 r^4 in units of half the diagonal, 25.7 pixels, from the principal point.
static void corners_lose_light(void **state)
{
    (void)state;
    struct orl_image light = ramp();
    photo.vignette[0] = -0.3f;
    photo.vignette[1] = -0.1f;
    for (int i = 0; i < W * H * 3; i++)
        light.f32[i] = 0.5f;
    struct orl_image picture = expose(&light);
    double r2 = (20.0 * 20 + 15.0 * 15) / (0.25 * (W * W + H * H));
    float corner = (float)(0.5 * (1 - 0.3 * r2 - 0.1 * r2 * r2));
    assert_int_equal(picture.u8[0], lrintf(255 * orl_srgb_encode(corner)));
    assert_int_equal(picture.u8[3 * (15 * W + 20)], 188); // 0.5, at the centre
    orl_image_finish(&picture);
    // A tenth at least, as where the vignetting of photographs is undone.
    photo.vignette[0] = -2;
    picture = expose(&light);
    assert_int_equal(picture.u8[0], lrintf(255 * orl_srgb_encode(0.05f)));
    orl_image_finish(&light);
    orl_image_finish(&picture);
}

// An even picture four times as light as the metering's: half of the two stops go into the gain.
static void gain_follows_metered_light(void **state)
{
    (void)state;
    struct orl_image light = {0};
    assert_int_equal(orl_image_init(NULL, &light, W, H, 3, ORL_PIXEL_F32), ORL_OK);
    for (int i = 0; i < W * H * 3; i++)
        light.f32[i] = 0.4f;
    assert_float_equal(orl_picture_metered(&light), log2(0.4), 1e-6);
    photo.metering = 0.5f;
    photo.metered_ev = (float)log2(0.1);
    struct orl_image picture = expose(&light);
    assert_int_equal(picture.u8[0], (int)lrintf(255 * orl_srgb_encode(0.2f)));
    orl_image_finish(&picture);
    orl_image_finish(&light);
}

// The centre counts more than the border, and light above white as white.
static void metering_is_centre_weighted(void **state)
{
    (void)state;
    struct orl_meter centre = {0}, border = {0}, white = {0};
    for (int y = 0; y < H; y++)
        for (int x = 0; x < W; x++) {
            bool inner = x >= W / 4 && x < 3 * W / 4 && y >= H / 4 && y < 3 * H / 4;
            const float in[3] = {inner, inner, inner}, out[3] = {!inner, !inner, !inner};
            const float sun[3] = {9, 9, 9};
            orl_meter_add(&centre, in, x + 0.5, y + 0.5, W, H);
            orl_meter_add(&border, out, x + 0.5, y + 0.5, W, H);
            orl_meter_add(&white, sun, x + 0.5, y + 0.5, W, H);
        }
    assert_float_equal(exp2(orl_meter_log2(&centre)) + exp2(orl_meter_log2(&border)), 1, 1e-5);
    assert_true(exp2(orl_meter_log2(&centre)) > 0.45); // a quarter of the area
    assert_float_equal(orl_meter_log2(&white), 0, 1e-6);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test_setup(plain_photographs_are_srgb, set_up),
        cmocka_unit_test_setup(gain_follows_metered_light, set_up),
        cmocka_unit_test_setup(metering_is_centre_weighted, set_up),
        cmocka_unit_test_setup(gain_is_undone_per_channel, set_up),
        cmocka_unit_test_setup(curves_are_inverted, set_up),
        cmocka_unit_test_setup(corners_lose_light, set_up),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
