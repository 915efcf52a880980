// Renderings of the tiny scene against the pictures kept here.
#include "../gpu/gpu_test.h"

#include <string.h>

#include "compare.h"
#include "core/memory.h"
#include "oriel/render.h"
#include "render_tolerance.h"
#include "tiny_scene.h"

static struct orl_gpu *gpu;
static struct orl_scene scene;
static struct orl_renderer *renderer;
static char *dir;

static int set_up(void **state)
{
    (void)state;
    gpu = gpu_test_device(); // may end the program
    dir = test_dir_make();
    tiny_scene_make(dir, &scene);
    assert_int_equal(orl_renderer_create(gpu, &scene, NULL, &renderer), ORL_OK);
    return 0;
}

static int tear_down(void **state)
{
    (void)state;
    orl_renderer_destroy(&renderer);
    tiny_scene_finish(&scene);
    assert_int_equal(orl_gpu_finish(gpu), ORL_OK);
    orl_gpu_destroy(&gpu);
    test_dir_remove(dir);
    return 0;
}

static const char *driver_name(void)
{
    static const char *const known[] = {"llvmpipe", "NVIDIA", "AMD", "Intel"};
    const struct orl_gpu_caps *caps = orl_gpu_caps(gpu);
    for (size_t i = 0; i < ORL_COUNT(known); i++)
        if (strstr(caps->renderer, known[i]) || strstr(caps->vendor, known[i]))
            return known[i];
    return "other";
}

static void draw(const char *method, struct orl_frame *frame)
{
    struct orl_log log = orl_log_stderr(ORL_LOG_WARNING);
    const struct orl_method *row = orl_method_find(&log, method);
    assert_non_null(row);
    assert_int_equal(orl_renderer_draw(renderer, &scene.photos[TINY_TEST_PHOTO].view, &row->params,
                                       NULL, frame), ORL_OK);
}

static bool check(const char *name, const struct orl_image *image,
                  const struct golden_tolerance *tolerance)
{
    static const char *const rgb[] = {"R", "G", "B"}, *const z[] = {"Z"};
    return golden_check(GOLDEN_DIR, GOLDEN_OUT, name, driver_name(), image->channels == 1 ? z : rgb,
                        image, tolerance);
}

static void points_color(void **state)
{
    (void)state;
    struct orl_frame frame;
    draw("points", &frame);
    assert_true(check("points_color", &frame.color, &color_tolerance));
    orl_frame_finish(&frame);
}

static void airieau_color_and_depth(void **state)
{
    (void)state;
    struct orl_frame frame;
    draw("airieau", &frame);
    bool color = check("airieau_color", &frame.color, &color_tolerance);
    bool depth = check("airieau_depth", &frame.depth, &depth_tolerance);
    orl_frame_finish(&frame);
    assert_true(color);
    assert_true(depth);
}

static void oriel_color(void **state)
{
    (void)state;
    struct orl_frame frame;
    draw("oriel", &frame);
    assert_true(check("oriel_color", &frame.color, &color_tolerance));
    orl_frame_finish(&frame);
}

// Not a golden: the truth. Depth within a splat's tilt of the traced one nearly everywhere.
static void depth_is_true(void **state)
{
    (void)state;
    struct orl_frame frame;
    struct orl_image color, depth;
    draw("airieau", &frame);
    tiny_scene_trace(&scene.photos[TINY_TEST_PHOTO].view, &color, &depth);
    const struct golden_tolerance tolerance = {.relative = 0.01, .fraction = 0.05};
    struct golden_report report;
    bool ok = golden_compare(&frame.depth, &depth, &tolerance, &report);
    print_message("%zu of %zu depths differ by over 1 %%\n", report.wrong, report.pixels);
    orl_image_finish(&color);
    orl_image_finish(&depth);
    orl_frame_finish(&frame);
    assert_true(ok);
}

// The goldens of two methods must not pass for one another.
static void goldens_differ(void **state)
{
    (void)state;
    const char *update = getenv("ORIEL_UPDATE_GOLDEN");
    if (update && strcmp(update, "1") == 0)
        skip();
    struct orl_frame frame;
    draw("points", &frame);
    assert_false(check("airieau_color", &frame.color, &color_tolerance));
    orl_frame_finish(&frame);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(points_color),
        cmocka_unit_test(airieau_color_and_depth),
        cmocka_unit_test(oriel_color),
        cmocka_unit_test(depth_is_true),
        cmocka_unit_test(goldens_differ),
    };
    return cmocka_run_group_tests(tests, set_up, tear_down);
}
