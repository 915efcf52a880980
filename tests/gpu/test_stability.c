// Steadiness along a walk: known answers, first of made-up frames, then of a painted wall.
#include <math.h>
#include <string.h>

#include "eval/stability.h"
#include "wall_scene.h"

static struct orl_gpu *gpu;

enum { SIDE = 64, WALL = 160, PHOTOS = 3, FRAMES = 8 };

static struct orl_view look(double x)
{
    return look_from(x, 0, 0, SIDE, 60);
}

// --- made-up frames of a wall at z = 4 ---

static double wave(double u, double v)
{
    return 120 + 60 * sin(0.5 * u) * cos(0.4 * v);
}

// `shift`: the wall's pattern, in pixels. At 60/4 pixels a unit, x = 1/15 is a pixel.
static struct orl_stability_frame wall_frame(double x, double shift, double brighter)
{
    struct orl_stability_frame f = {.view = look(x)};
    assert_int_equal(orl_image_init(NULL, &f.srgb, SIDE, SIDE, 3, ORL_PIXEL_U8), ORL_OK);
    assert_int_equal(orl_image_init(NULL, &f.depth, SIDE, SIDE, 1, ORL_PIXEL_F32), ORL_OK);
    assert_int_equal(orl_image_init(NULL, &f.coverage, SIDE, SIDE, 1, ORL_PIXEL_F32), ORL_OK);
    for (int i = 0; i < SIDE * SIDE; i++) {
        double value = wave(i % SIDE + 15 * x + shift, i / SIDE) + brighter;
        for (int c = 0; c < 3; c++)
            f.srgb.u8[3 * i + c] = (uint8_t)lround(value);
        f.depth.f32[i] = 4;
        f.coverage.f32[i] = 1;
    }
    return f;
}

static void release(struct orl_stability_frame *f)
{
    orl_image_finish(&f->srgb);
    orl_image_finish(&f->depth);
    orl_image_finish(&f->coverage);
}

static struct orl_stability_step compare(struct orl_stability_frame *a,
                                         struct orl_stability_frame *b)
{
    struct orl_stability_counts counts = {0};
    struct orl_stability_step step;
    orl_stability_compare(a, b, &counts, &step);
    return step;
}

static void still_frames(void **state)
{
    (void)state;
    struct orl_stability_frame a = wall_frame(0.3, 0, 0);
    struct orl_stability_step step = compare(&a, &a);
    assert_true(step.compared > 0.85); // but for the border that interpolation needs
    assert_true(step.mean == 0 && step.p99 == 0 && step.floor == 0 && step.jump == 0);
    assert_true(step.block_worst == 0);
    release(&a);
}

static void moved_frames(void **state)
{
    (void)state;
    struct orl_stability_frame a = wall_frame(0, 0, 0), whole = wall_frame(2 / 15.0, 0, 0),
                               half = wall_frame(1.5 / 15, 0, 0),
                               slips = wall_frame(2 / 15.0, 1, 0);
    // By whole pixels nothing is interpolated; the difference is exact. By half a pixel what
    // remains is rounding and little more, and the floor says so. Bilinear weights would lose
    // 1 - cos(0.25) = 3 % of the wave: 0.8.
    struct orl_stability_step step = compare(&a, &whole);
    assert_true(step.compared > 0.8);
    assert_true(step.mean < 1e-3 && step.floor < 1e-3);
    step = compare(&a, &half);
    assert_true(step.mean < 0.4);
    assert_true(step.floor > 0.01 && step.floor < 0.4);
    assert_true(step.block_worst < 0.2);
    // A pattern that slides over the wall is not steady: mean |60 sin' cos| is about 12.
    step = compare(&a, &slips);
    assert_true(step.mean > 8 && step.mean < 16);
    assert_true(step.p99 > step.mean && step.p99 < 31);
    release(&a);
    release(&whole);
    release(&half);
    release(&slips);
}

static void brighter_frame(void **state)
{
    (void)state;
    struct orl_stability_frame a = wall_frame(0, 0, 0), b = wall_frame(2 / 15.0, 0, 7);
    struct orl_stability_step step = compare(&a, &b);
    assert_float_equal(step.mean, 7, 0.05);
    assert_float_equal(step.jump, 7, 0.05);
    assert_float_equal(step.block_worst, 7, 0.1);
    release(&b);
    b = wall_frame(2 / 15.0, 0, 0); // one block alone, by 40
    for (int y = 16; y < 32; y++)
        for (int x = 32; x < 48; x++)
            for (int c = 0; c < 3; c++)
                b.srgb.u8[3 * (y * SIDE + x) + c] += 40;
    step = compare(&a, &b);
    assert_float_equal(step.block_worst, 40, 0.1);
    assert_int_equal(step.block_x, 32);
    assert_int_equal(step.block_y, 16);
    assert_float_equal(step.p99, 40, 0.5);
    assert_true(step.mean > 2 && step.mean < 4);
    release(&a);
    release(&b);
}

// What only one frame sees is not compared: a plate at z = 2 before half of the wall.
static void other_surface(void **state)
{
    (void)state;
    struct orl_stability_frame a = wall_frame(0, 0, 0), b = wall_frame(0, 0, 0);
    for (int i = 0; i < SIDE * SIDE; i++)
        if (i % SIDE < SIDE / 2) {
            b.depth.f32[i] = 2;
            b.srgb.u8[3 * i] = 255;
        }
    struct orl_stability_step step = compare(&a, &b);
    assert_true(step.mean == 0);
    assert_true(step.compared > 0.4 && step.compared < 0.5);
    for (int i = 0; i < SIDE * SIDE; i++)
        a.coverage.f32[i] = 0;
    step = compare(&a, &b);
    assert_true(step.compared == 0 && step.mean == 0 && step.jump == 0);
    release(&a);
    release(&b);
}

// --- rendered: a wall at z = 4, 8 units wide, seen by photographs of one grey each ---

static void setup_walk(struct fixture *f, const uint8_t values[PHOTOS])
{
    setup_empty(f, 4);
    assert_int_equal(orl_points_init(NULL, &f->scene.points, WALL * WALL), ORL_OK);
    set_square(&f->scene.points, 0, WALL, 8, 0, 4, (uint8_t[3]){0});
    for (int i = 0; i < PHOTOS; i++)
        add_photo(f, look(0.5 * (i - 1)), (uint8_t[3]){values[i], values[i], values[i]});
}

static const bool *half_way(void *priv, size_t frame)
{
    bool *skip = priv;
    skip[1] = frame >= FRAMES / 2;
    return skip;
}

static struct orl_stability walk(struct fixture *f, const char *method, size_t still, bool pops)
{
    struct orl_renderer *renderer;
    struct orl_path path;
    struct orl_stability s;
    bool skip[PHOTOS] = {false};
    const struct orl_method *row = orl_method_find(NULL, method);
    assert_non_null(row);
    assert_int_equal(orl_stability_walk(NULL, &f->scene, NULL, FRAMES, 1, &path), ORL_OK);
    assert_int_equal(path.count, FRAMES);
    for (size_t i = 0; still && i < FRAMES; i++)
        path.views[i] = look(i < still ? 0.02 : 1000);
    assert_int_equal(orl_renderer_create(gpu, &f->scene, NULL, &renderer), ORL_OK);
    struct orl_choice choice = {.method = row};
    orl_render_params_tuned(NULL, row, &f->scene, &choice.params);
    const struct orl_stability_params params = {
        .choice = &choice, .path = &path, .skip = pops ? half_way : NULL, .skip_priv = skip};
    assert_int_equal(orl_stability_run(gpu, renderer, &params, &s), ORL_OK);
    assert_int_equal(s.step_count, FRAMES - 1);
    orl_renderer_destroy(&renderer);
    orl_path_finish(&path);
    return s;
}

static void one_colour_is_steady(void **state)
{
    (void)state;
    struct fixture f;
    setup_walk(&f, (uint8_t[]){140, 140, 140});
    for (const struct orl_method *m = orl_methods; m->name; m++) {
        struct orl_stability s = walk(&f, m->name, 0, false);
        assert_true(s.all.compared > 0.6);
        assert_true(s.all.mean < 0.01 && s.all.jump < 0.01);
        orl_stability_finish(&s);
    }
    teardown(&f);
}

static void standing_still_is_steady(void **state)
{
    (void)state;
    struct fixture f;
    setup_walk(&f, (uint8_t[]){100, 140, 180});
    struct orl_stability s = walk(&f, "oriel", FRAMES, false);
    assert_true(s.all.compared > 0.6);
    assert_true(s.all.mean == 0 && s.all.p99 == 0 && s.all.block_worst == 0);
    orl_stability_finish(&s);
    teardown(&f);
}

static void a_pop_is_found(void **state)
{
    (void)state;
    struct fixture f;
    setup_walk(&f, (uint8_t[]){100, 180, 100});
    struct orl_stability s = walk(&f, "oriel", FRAMES, true);
    for (size_t i = 0; i < s.step_count; i++) {
        bool pops = i == FRAMES / 2 - 1;
        assert_true(pops ? s.steps[i].jump > 30 : s.steps[i].jump == 0);
        assert_true(pops ? s.steps[i].mean > 30 : s.steps[i].mean == 0);
    }
    assert_int_equal(s.worst_jump_step, FRAMES / 2 - 1);
    assert_int_equal(s.worst_block_step, FRAMES / 2 - 1);
    assert_true(s.all.jump == s.steps[FRAMES / 2 - 1].jump);
    assert_true(s.all.block_worst > 30);
    assert_true(s.all.compared > 0.6);
    orl_stability_finish(&s);
    teardown(&f);
}

// Frames that show nothing of the scene, at the end, leave the means to the steps before them.
static void steps_without_pixels_do_not_count(void **state)
{
    (void)state;
    const size_t compared = FRAMES - 3, pop = FRAMES / 2 - 1;
    struct fixture f;
    setup_walk(&f, (uint8_t[]){100, 180, 100});
    struct orl_stability s = walk(&f, "oriel", compared + 1, true);
    for (size_t i = 0; i < s.step_count; i++)
        assert_true((s.steps[i].blocks > 0) == (i < compared));
    assert_int_equal(s.all.blocks, compared * s.steps[0].blocks);
    assert_float_equal(s.all.mean, s.steps[pop].mean / (double)compared, 1e-6);
    assert_float_equal(s.all.block_mean, s.steps[pop].block_mean / (double)compared, 1e-6);
    assert_float_equal(s.all.compared, s.steps[0].compared * (double)compared / (FRAMES - 1), 1e-6);
    orl_stability_finish(&s);
    teardown(&f);
}

// The figures of a walk whose last frames are smaller are over its pixels, not over its steps.
static void frames_count_by_their_pixels(void **state)
{
    (void)state;
    struct fixture f;
    struct orl_renderer *renderer;
    struct orl_path path;
    struct orl_stability s;
    bool skip[PHOTOS] = {false};
    struct orl_choice choice = {.method = orl_method_find(NULL, "oriel")};
    const struct orl_stability_params params = {
        .choice = &choice, .path = &path, .skip = half_way, .skip_priv = skip};
    double sum = 0, pixels = 0;
    setup_walk(&f, (uint8_t[]){100, 180, 100});
    orl_render_params_tuned(NULL, choice.method, &f.scene, &choice.params);
    assert_int_equal(orl_stability_walk(NULL, &f.scene, NULL, FRAMES, 1, &path), ORL_OK);
    for (size_t i = 0; i < FRAMES; i++) {
        path.views[i] = look(0.02);
        struct orl_camera *c = &path.views[i].camera;
        if (i >= FRAMES / 2 - 1)
            *c = orl_camera_resized(c, c->width / 2, c->height / 2);
    }
    assert_int_equal(orl_renderer_create(gpu, &f.scene, NULL, &renderer), ORL_OK);
    assert_int_equal(orl_stability_run(gpu, renderer, &params, &s), ORL_OK);
    for (size_t i = 0; i < s.step_count; i++) {
        sum += s.steps[i].mean * (double)s.steps[i].pixels;
        pixels += (double)s.steps[i].pixels;
    }
    assert_true(s.steps[FRAMES / 2 - 1].mean > 30);
    assert_true(3 * s.steps[FRAMES / 2 - 1].pixels < s.steps[0].pixels);
    assert_float_equal(s.all.mean, sum / pixels, 1e-6);
    orl_stability_finish(&s);
    orl_renderer_destroy(&renderer);
    orl_path_finish(&path);
    teardown(&f);
}

// The walk keeps away from photographs that are held out.
static void walks_past_training_photographs(void **state)
{
    (void)state;
    struct fixture f;
    struct orl_path path;
    setup_walk(&f, (uint8_t[]){100, 100, 100});
    f.photos[1].test = true;
    f.photos[1].view = look(50);
    assert_int_equal(orl_stability_walk(NULL, &f.scene, NULL, 5, 2, &path), ORL_OK);
    for (size_t i = 0; i < path.count; i++) {
        double centre[3];
        orl_pose_centre(&path.views[i].cam_from_world, centre);
        assert_float_equal(centre[0], 0.25 * (double)i - 0.5, 0.1);
        assert_int_equal(path.views[i].camera.width, SIDE / 2);
        assert_float_equal(path.views[i].camera.fx, 30, 1e-9);
    }
    orl_path_finish(&path);
    f.photos[0].test = true;
    assert_int_equal(orl_stability_walk(NULL, &f.scene, NULL, 5, 1, &path), ORL_ERR_ARGUMENT);
    teardown(&f);
}

int main(void)
{
    gpu = gpu_test_device();
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(still_frames),
        cmocka_unit_test(moved_frames),
        cmocka_unit_test(brighter_frame),
        cmocka_unit_test(other_surface),
        cmocka_unit_test(one_colour_is_steady),
        cmocka_unit_test(standing_still_is_steady),
        cmocka_unit_test(a_pop_is_found),
        cmocka_unit_test(steps_without_pixels_do_not_count),
        cmocka_unit_test(frames_count_by_their_pixels),
        cmocka_unit_test(walks_past_training_photographs),
    };
    int failed = cmocka_run_group_tests(tests, NULL, NULL);
    orl_gpu_destroy(&gpu);
    return failed;
}
