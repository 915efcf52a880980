// Frames that are the mean of several pictures, against these pictures drawn one by one.
#include <math.h>

#include "wall_scene.h"

enum { SIDE = 48, PIXELS = SIDE * SIDE };

static struct orl_gpu *gpu;

// A part of a pixel from the grid of the wall's points, so that the size of splats shows.
static struct orl_view ahead(void)
{
    return look_from(0.013, 0.007, 0, SIDE, 40);
}

// The points' own colours, in three sizes that src/render/reconstructions.c names.
static void the_mean_is_that_of_the_pictures(void **state)
{
    (void)state;
    static const struct {
        float scale;
        double shift;
    } pictures[3] = {{1, 0}, {1 / 1.75f, 0.17}, {1.75f, -0.17}};
    struct fixture f;
    setup(&f, true);
    struct orl_render_params params = orl_method_find(NULL, "points")->params;
    params.reconstructions = 3;
    struct orl_frame mean = draw(gpu, &f, ahead(), &params, 0);
    params.reconstructions = 1;
    float sum[3 * PIXELS] = {0}, apart = 0;
    for (int k = 0; k < 3; k++) {
        struct orl_render_params own = params;
        struct orl_view view = ahead();
        own.splat_scale *= pictures[k].scale;
        view.camera.cx += pictures[k].shift;
        view.camera.cy += pictures[k].shift;
        struct orl_frame one = draw(gpu, &f, view, &own, 0);
        for (int i = 0; i < 3 * PIXELS; i++)
            sum[i] += sqrtf(one.color.f32[i]) / 3;
        orl_frame_finish(&one);
    }
    struct orl_frame single = draw(gpu, &f, ahead(), &params, 0);
    for (int i = 0; i < 3 * PIXELS; i++) {
        assert_float_equal(mean.color.f32[i], sum[i] * sum[i], 2e-3);
        apart = fmaxf(apart, fabsf(mean.color.f32[i] - single.color.f32[i]));
    }
    assert_true(apart > 0.1); // at the plate's outline
    // What is read back beside the picture is that of the scene's own splats.
    assert_memory_equal(mean.depth.f32, single.depth.f32, PIXELS * sizeof(float));
    assert_memory_equal(mean.normal.f32, single.normal.f32, 3 * PIXELS * sizeof(float));
    assert_memory_equal(mean.coverage.f32, single.coverage.f32, PIXELS * sizeof(float));
    orl_frame_finish(&mean);
    orl_frame_finish(&single);
    teardown(&f);
}

// A frame whose photographs arrive one by one becomes that of a renderer that waits for them.
static void photographs_that_arrive_give_the_same_frame(void **state)
{
    (void)state;
    struct fixture f;
    setup(&f, true);
    for (int i = 0; i < 3; i++)
        add_photo(&f, look_from(0.4 * i - 0.4, 0, 0, SIDE, 40), i % 2 ? green : blue);
    struct orl_render_params params = orl_method_find(NULL, "oriel-high")->params;
    struct orl_frame whole = draw(gpu, &f, ahead(), &params, 0), frame = {0};
    struct orl_view view = ahead();
    struct orl_renderer *renderer;
    struct orl_progressive progress = {.seconds = 1, .at_rest = true, .missing = 1};
    assert_int_equal(orl_renderer_create(gpu, &f.scene, NULL, &renderer), ORL_OK);
    for (int tries = 0; progress.missing && tries < 1000; tries++) {
        orl_frame_finish(&frame);
        assert_int_equal(orl_renderer_draw_progressive(renderer, &view, &params, &progress, &frame),
                         ORL_OK);
    }
    assert_int_equal(progress.missing, 0);
    assert_memory_equal(whole.color.f32, frame.color.f32, 3 * PIXELS * sizeof(float));
    orl_renderer_destroy(&renderer);
    orl_frame_finish(&whole);
    orl_frame_finish(&frame);
    teardown(&f);
}

int main(void)
{
    gpu = gpu_test_device();
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(the_mean_is_that_of_the_pictures),
        cmocka_unit_test(photographs_that_arrive_give_the_same_frame),
    };
    int failed = cmocka_run_group_tests_name("reconstructions", tests, NULL, NULL);
    orl_gpu_destroy(&gpu);
    return failed;
}
