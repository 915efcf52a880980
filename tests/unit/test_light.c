// The light that a scene is shown in.
#include <math.h>

#include "oriel/render.h"
#include "render/output/reexpose.h"
#include "scene/meter.h"
#include "test.h"

enum { SIDE = 8, COUNT = 3 };

static struct orl_photo photos[COUNT];
static struct orl_scene scene = {.dir = "scene", .photos = photos, .photo_count = COUNT};

static int set_up(void **state)
{
    (void)state;
    static char *const names[] = {"a.jpg", "b.jpg", "held.jpg"};
    static const float gain[][3] = {{0.5f, 1, 2}, {4, 2, 1}, {1, 1, 1}};
    for (int i = 0; i < COUNT; i++)
        photos[i] = (struct orl_photo){.name = names[i], .test = i == 2, .response = -1,
                                       .view.camera = {SIDE, SIDE, 10, 10, 4, 4},
                                       .gain = {gain[i][0], gain[i][1], gain[i][2]}};
    return 0;
}

static void its_photograph_keeps_its_colours(void **state)
{
    (void)state;
    static const float expected[][3] = {{0.125f, 0.5f, 2}, {1, 1, 1}, {0.25f, 0.5f, 1}};
    assert_int_equal(orl_scene_set_light(NULL, &scene, "b"), ORL_OK);
    for (int i = 0; i < COUNT; i++)
        for (int c = 0; c < 3; c++)
            assert_float_equal(photos[i].gain[c], expected[i][c], 1e-6);
    // Again from there: only the ratio between photographs counts.
    assert_int_equal(orl_scene_set_light(NULL, &scene, "a.jpg"), ORL_OK);
    for (int c = 0; c < 3; c++)
        assert_float_equal(photos[0].gain[c], 1, 1e-6);
    assert_float_equal(photos[1].gain[0], 8, 1e-6);
}

static void other_photographs_are_refused(void **state)
{
    (void)state;
    assert_int_equal(orl_scene_set_light(NULL, &scene, NULL), ORL_OK);
    assert_int_equal(orl_scene_set_light(NULL, &scene, "c"), ORL_ERR_ARGUMENT);
    assert_int_equal(orl_scene_set_light(NULL, &scene, "held"), ORL_ERR_ARGUMENT);
    for (int c = 0; c < 3; c++)
        assert_float_equal(photos[2].gain[c], 1, 0);
}

// What a held-out photograph's camera makes of the rendering stays the same when the rendering
// becomes as much darker as the light says.
static void metered_exposure_follows(void **state)
{
    (void)state;
    struct orl_image light = {0}, before = {0}, after = {0};
    photos[2].metering = 0.75f;
    photos[2].metered_ev = -2;
    for (int c = 0; c < 3; c++)
        photos[1].gain[c] = 4;
    assert_int_equal(orl_image_init(NULL, &light, SIDE, SIDE, 3, ORL_PIXEL_F32), ORL_OK);
    for (int i = 0; i < SIDE * SIDE * 3; i++)
        light.f32[i] = 0.5f * (float)(i + 1) / (SIDE * SIDE * 3);
    assert_int_equal(orl_photo_expose(NULL, &scene, 2, &light, &before), ORL_OK);
    assert_int_equal(orl_scene_set_light(NULL, &scene, "b"), ORL_OK);
    for (int i = 0; i < SIDE * SIDE * 3; i++)
        light.f32[i] /= 4;
    assert_int_equal(orl_photo_expose(NULL, &scene, 2, &light, &after), ORL_OK);
    assert_true(before.u8[100] > 20);
    for (int i = 0; i < SIDE * SIDE * 3; i++)
        assert_between(after.u8[i] + 1 - before.u8[i], 0, 2); // but for rounding
    orl_image_finish(&light);
    orl_image_finish(&before);
    orl_image_finish(&after);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test_setup(its_photograph_keeps_its_colours, set_up),
        cmocka_unit_test_setup(other_photographs_are_refused, set_up),
        cmocka_unit_test_setup(metered_exposure_follows, set_up),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
