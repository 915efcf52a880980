// Scenes that get worse: are they as bad as they say, and does every method stay sane on them?
#include <math.h>
#include <string.h>

#include "core/file.h"
#include "eval/stress_internal.h"
#include "gpu_test.h"

static struct orl_gpu *gpu;
static const struct orl_stress_params params = {
    .side = ORL_STRESS_SIDE_MIN, .photographs = 5, .views = 1, .seed = 1};

static const struct stress_axis *axis_named(const char *name)
{
    const struct stress_axis *axis = orl_stress_axes;
    while (axis->name && strcmp(axis->name, name) != 0)
        axis++;
    assert_non_null(axis->name);
    return axis;
}

// --- the unchanged scene, made once ---

static struct stress_case base;
static char *dir, *base_dir, *changed_dir;

static int make_base(void **state)
{
    (void)state;
    const struct orl_synth_params generator = orl_stress_generator(&params);
    dir = test_dir_make();
    base_dir = orl_path_join(NULL, dir, "base");
    changed_dir = orl_path_join(NULL, dir, "changed");
    assert_int_equal(orl_stress_make_synth(gpu, &params, &generator, &base), ORL_OK);
    assert_int_equal(orl_stress_write_files(&base, base_dir, false), ORL_OK);
    return 0;
}

static int finish_base(void **state)
{
    (void)state;
    orl_stress_case_finish(&base);
    free(base_dir);
    free(changed_dir);
    test_dir_remove(dir);
    return 0;
}

static struct stress_case perturbed(const char *axis, double level)
{
    struct stress_case c;
    assert_int_equal(orl_stress_perturb(&base, &params, axis_named(axis), level, changed_dir, &c),
                     ORL_OK);
    return c;
}

static size_t photos_in_use(const struct stress_case *c)
{
    size_t count = 0;
    for (size_t i = 0; i < c->scene.photo_count; i++)
        count += !c->scene.photos[i].test;
    return count;
}

// --- as bad as they say ---

static void the_first_severity_is_the_scene(void **state)
{
    (void)state;
    for (const struct stress_axis *axis = orl_stress_axes; axis->name; axis++) {
        if (axis->flags & STRESS_OWN_START || axis->generate)
            continue;
        struct stress_case c = perturbed(axis->name, axis->levels[0]);
        // Radii that are set again may leave another point or two alone.
        size_t more = axis->flags & STRESS_CHANGES_POINTS ? base.scene.points.count / 100 : 0;
        assert_between(c.scene.points.count, base.scene.points.count - more,
                       base.scene.points.count);
        if (!more)
            assert_memory_equal(c.scene.points.color, base.scene.points.color,
                                3 * base.scene.points.count);
        for (size_t i = 0; i < base.scene.photo_count; i++) {
            const struct orl_photo *a = &c.scene.photos[i], *b = &base.scene.photos[i];
            assert_int_equal(a->test, b->test);
            for (int k = 0; k < 9; k++)
                assert_float_equal(a->view.cam_from_world.r[k / 3][k % 3],
                                   b->view.cam_from_world.r[k / 3][k % 3], 1e-12);
            assert_float_equal(a->view.camera.fx, b->view.camera.fx, 1e-12);
            if (!a->test)
                assert_memory_equal(c.photos[i].u8, base.photos[i].u8,
                                    orl_image_bytes(&base.photos[i]));
        }
        orl_stress_case_finish(&c);
    }
}

static void photographs_are_left_out(void **state)
{
    (void)state;
    const double levels[3] = {0, 25, 100};
    const size_t left[3] = {5, 4, 3};
    for (int i = 0; i < 3; i++) {
        struct stress_case c = perturbed("photographs", levels[i]);
        assert_int_equal(photos_in_use(&c), left[i]);
        orl_stress_case_finish(&c);
    }
}

static void points_are_as_bad_as_asked(void **state)
{
    (void)state;
    double count = (double)base.scene.points.count, off = 0, moved = 0;
    struct stress_case few = perturbed("points", 80), more = {0}, noisy = {0};
    assert_float_equal((double)few.scene.points.count / count, 0.2, 0.02);
    assert_int_equal(orl_stress_copy(&base, &more), ORL_OK);
    assert_int_equal(orl_stress_outliers(&more, 20, 1), ORL_OK);
    assert_float_equal((double)more.scene.points.count / count, 1.25, 0.01);
    assert_int_equal(orl_stress_copy(&base, &noisy), ORL_OK);
    assert_int_equal(orl_stress_noisy_points(&noisy, 2, 1), ORL_OK);
    for (size_t i = 0; i < base.scene.points.count; i++) {
        double eye[3], before = 0, after = 0;
        int pixel[2], photo = orl_stress_photo_of(&base, i, pixel);
        if (photo < 0)
            continue;
        orl_pose_centre(&base.scene.photos[photo].view.cam_from_world, eye);
        for (int k = 0; k < 3; k++) {
            before += pow((double)base.scene.points.position[i][k] - eye[k], 2);
            after += pow((double)noisy.scene.points.position[i][k] - eye[k], 2);
        }
        off += pow(sqrt(after / before) - 1, 2);
        moved++;
    }
    assert_float_equal(sqrt(off / moved), 0.02, 0.001);
    orl_stress_case_finish(&few);
    orl_stress_case_finish(&more);
    orl_stress_case_finish(&noisy);
}

static void cameras_are_as_wrong_as_asked(void **state)
{
    (void)state;
    struct stress_case posed = perturbed("pose", 2), zoomed = perturbed("focal", 3);
    for (size_t i = 0; i < base.scene.photo_count; i++) {
        const struct orl_view *right = &base.scene.photos[i].view;
        double sum = 0, count = 0;
        for (size_t p = 0; p < base.scene.points.count; p += 7) {
            double world[3], a[2], b[2], z;
            for (int k = 0; k < 3; k++)
                world[k] = (double)base.scene.points.position[p][k];
            if (!orl_view_project(right, world, a, &z) || a[0] < 0 || a[1] < 0 ||
                a[0] > right->camera.width || a[1] > right->camera.height ||
                !orl_view_project(&posed.scene.photos[i].view, world, b, &z))
                continue;
            sum += pow(a[0] - b[0], 2) + pow(a[1] - b[1], 2);
            count++;
        }
        bool test = base.scene.photos[i].test;
        assert_float_equal(sqrt(sum / count), test ? 0 : 2, 0.2);
        assert_float_equal(fabs(zoomed.scene.photos[i].view.camera.fx / right->camera.fx - 1),
                           test ? 0 : 0.03, 1e-9);
    }
    orl_stress_case_finish(&posed);
    orl_stress_case_finish(&zoomed);
}

static void photographs_are_as_bad_as_asked(void **state)
{
    (void)state;
    struct stress_case people = perturbed("passers-by", 15), gain = perturbed("exposure-aligned", 2);
    double low = 9, high = -9;
    for (size_t i = 0; i < base.scene.photo_count; i++) {
        const struct orl_image *now = &people.photos[i], *old = &base.photos[i];
        size_t changed = 0, pixels = (size_t)now->width * (size_t)now->height;
        if (base.scene.photos[i].test)
            continue;
        for (size_t p = 0; p < pixels; p++)
            changed += memcmp(&now->u8[3 * p], &old->u8[3 * p], 3) != 0;
        assert_float_equal((double)changed / (double)pixels, 0.15, 0.01);
        double ev = -log2((double)gain.scene.photos[i].gain[0]);
        low = fmin(low, ev);
        high = fmax(high, ev);
    }
    assert_float_equal(high - low, 2, 1e-5);
    orl_stress_case_finish(&people);
    orl_stress_case_finish(&gain);
}

static void near_photographs_are_skipped(void **state)
{
    (void)state;
    struct stress_case c = perturbed("angle", 25), far;
    size_t skipped = 0;
    for (size_t i = 0; i < c.scene.photo_count; i++)
        skipped += c.views[0].scene->photos[i].test && !c.scene.photos[i].test;
    assert_true(skipped > 0 && skipped + 2 <= photos_in_use(&c));
    assert_int_equal(orl_stress_perturb(&base, &params, axis_named("angle"), 170, changed_dir, &far),
                     ORL_ERR_NOT_FOUND);
    orl_stress_case_finish(&c);
    orl_stress_case_finish(&far);
}

static void fill_photo(struct orl_image *photo, const uint8_t color[3])
{
    for (size_t p = 0; p < (size_t)photo->width * (size_t)photo->height; p++)
        memcpy(&photo->u8[3 * p], color, 3);
}

static size_t points_of_color(const struct orl_scene *scene, const uint8_t color[3])
{
    size_t count = 0;
    for (size_t i = 0; i < scene->points.count; i++)
        count += memcmp(scene->points.color[i], color, 3) == 0;
    return count;
}

// A trial knows no colour of a photograph that it may not use, neither by pixels nor by points.
static void forbidden_photographs_color_no_point(void **state)
{
    (void)state;
    static const uint8_t forbidden[3] = {255, 0, 255}, allowed[3] = {0, 255, 0};
    struct stress_case c = perturbed("angle", 25), marked;
    assert_int_equal(orl_stress_copy(&base, &marked), ORL_OK);
    for (size_t i = 0; i < marked.scene.photo_count; i++)
        if (!marked.scene.photos[i].test)
            fill_photo(&marked.photos[i], c.views[0].scene->photos[i].test ? forbidden : allowed);
    for (size_t i = 0; i < marked.scene.points.count; i++)
        memcpy(marked.scene.points.color[i], forbidden, 3);
    assert_int_equal(orl_stress_angle(&marked, 25, 1), ORL_OK);
    assert_int_equal(points_of_color(marked.views[0].scene, allowed), base.scene.points.count);
    assert_int_equal(points_of_color(&marked.scene, forbidden), base.scene.points.count);
    orl_stress_case_finish(&c);
    orl_stress_case_finish(&marked);
}

// Two cameras look along z, one unit apart. The first sees both points behind one another, the
// second both beside one another; the first is nearer to both. The third point is in no frame.
static void hidden_points_are_not_painted(void **state)
{
    (void)state;
    static const uint8_t red[3] = {255, 0, 0}, green[3] = {0, 255, 0};
    struct orl_photo photos[2];
    struct orl_image pictures[2];
    struct orl_scene scene = {.photos = photos, .photo_count = 2};
    for (size_t i = 0; i < 2; i++) {
        photos[i] = (struct orl_photo){
            .view = {.camera = {.width = 32, .height = 32, .fx = 16, .fy = 16, .cx = 16, .cy = 16},
                     .cam_from_world = {.r = {{1, 0, 0}, {0, 1, 0}, {0, 0, 1}},
                                        .t = {-(double)i, 0, 0}}}};
        assert_int_equal(orl_image_init(NULL, &pictures[i], 32, 32, 3, ORL_PIXEL_U8), ORL_OK);
        fill_photo(&pictures[i], i ? green : red);
    }
    assert_int_equal(orl_points_init(NULL, &scene.points, 3), ORL_OK);
    const float at[3][3] = {{0, 0, 1}, {0, 0, 2}, {0, 0, -5}};
    memcpy(scene.points.position, at, sizeof at);
    for (size_t i = 0; i < 3; i++)
        scene.points.normal[i][2] = -1;
    assert_int_equal(orl_stress_color_points(NULL, pictures, &scene), ORL_OK);
    assert_memory_equal(scene.points.color[0], red, 3);
    assert_memory_equal(scene.points.color[1], green, 3);
    assert_memory_equal(scene.points.color[2], red, 3); // of the nearest point
    for (size_t i = 0; i < 2; i++)
        orl_image_finish(&pictures[i]);
    orl_points_finish(&scene.points);
}

static void losses_are_found_between_severities(void **state)
{
    (void)state;
    const double levels[5] = {0, 1, 2, 4, 8}, psnr[5] = {30, 29.5, 28, (double)NAN, 22};
    assert_float_equal(orl_stress_loss_at(levels, psnr, 5, 1), 1 + 0.5 / 1.5, 1e-9);
    assert_float_equal(orl_stress_loss_at(levels, psnr, 5, 3), 3, 1e-9);
    assert_true(isnan(orl_stress_loss_at(levels, psnr, 5, 9)));
    assert_true(isnan(orl_stress_loss_at(levels, psnr, 1, 1)));
}

// --- sane at every severity ---

// Worse input may make a picture better by accident, but by no more than this.
static const double luck_db = 0.75;

static void check_method(const struct stress_axis *axis, int level, const struct stress_case *c,
                         const struct orl_method *method, double *start_db)
{
    struct orl_render_params render;
    struct stress_result result;
    orl_render_params_tuned(NULL, method, &c->scene, &render);
    orl_stress_axis_options(axis, &render);
    struct stress_case still = *c; // flicker has tests of its own
    still.walk_count = 0;
    assert_int_equal(orl_stress_measure(&still, &render, &result), ORL_OK);
    const struct stress_invariants *i = &result.invariants;
    double db = result.figures[0];
    *start_db = level ? *start_db : db;
    bool lucky = !(axis->flags & STRESS_OWN_TRUTH) && db > *start_db + luck_db;
    if (!orl_stress_invariants_hold(i) || lucky)
        fail_msg("%s %g, %s: %.2f dB after %.2f; %zu not finite, brightness %g, overshoot %g, "
                 "moved %g, share %g", axis->name, axis->levels[level], method->name, db, *start_db,
                 i->not_finite, i->brightness, i->overshoot, i->moved_mean, i->moved_share);
    orl_image_finish(&result.picture);
}

static void every_method_keeps_the_invariants(void **state)
{
    (void)state;
    enum { METHODS_MAX = 32 };
    double unchanged_db[METHODS_MAX] = {0};
    for (const struct stress_axis *axis = orl_stress_axes; axis->name; axis++) {
        double start_db[METHODS_MAX];
        bool unchanged = !(axis->flags & STRESS_OWN_START) && !axis->settings[0];
        memcpy(start_db, unchanged_db, sizeof start_db);
        // The unchanged scene is measured with the first axis alone.
        for (int level = unchanged && axis != orl_stress_axes; level < ORL_STRESS_LEVELS; level++) {
            struct stress_case c;
            enum orl_result result =
                orl_stress_perturb(&base, &params, axis, axis->levels[level], changed_dir, &c);
            if (result == ORL_OK)
                assert_int_equal(orl_stress_open(&c), ORL_OK);
            else
                assert_int_equal(result, ORL_ERR_NOT_FOUND);
            for (int m = 0; c.renderer && orl_methods[m].name; m++) {
                assert_true(m < METHODS_MAX);
                check_method(axis, level, &c, &orl_methods[m], &start_db[m]);
            }
            orl_stress_case_finish(&c);
        }
        if (axis == orl_stress_axes)
            memcpy(unchanged_db, start_db, sizeof unchanged_db);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(the_first_severity_is_the_scene),
        cmocka_unit_test(photographs_are_left_out),
        cmocka_unit_test(points_are_as_bad_as_asked),
        cmocka_unit_test(cameras_are_as_wrong_as_asked),
        cmocka_unit_test(photographs_are_as_bad_as_asked),
        cmocka_unit_test(near_photographs_are_skipped),
        cmocka_unit_test(forbidden_photographs_color_no_point),
        cmocka_unit_test(hidden_points_are_not_painted),
        cmocka_unit_test(losses_are_found_between_severities),
        cmocka_unit_test(every_method_keeps_the_invariants),
    };
    gpu = gpu_test_device();
    int failed = cmocka_run_group_tests(tests, make_base, finish_base);
    orl_gpu_destroy(&gpu);
    return failed;
}
