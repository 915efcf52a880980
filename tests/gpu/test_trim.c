// What oriel trim takes away: points that no photograph shows, photographs that show nothing new.
#include <math.h>
#include <string.h>

#include "core/memory.h"
#include "eval/validation.h"
#include "eval/trim.h"
#include "eval/trim_search.h"
#include "scene/colmap.h"
#include "scene/manifest.h"
#include "wall_scene.h"

static struct orl_gpu *gpu;

enum { SIDE = 48, WALL = 120 };

static void look_along(struct fixture *f, size_t count, double step)
{
    for (size_t k = 0; k < count; k++)
        add_photo(f, look_from(step * (double)k, 0, 0, SIDE, SIDE), red);
}

// Points behind the wall are hidden from all photographs, and points far beside it are in no view.
static void hidden_points_go_first(void **state)
{
    (void)state;
    enum { HIDDEN = 30, SEEN = WALL * WALL, ALL = SEEN + HIDDEN * HIDDEN };
    struct fixture f;
    struct orl_point_ranking ranking;
    setup_empty(&f, 4);
    assert_int_equal(orl_points_init(NULL, &f.scene.points, ALL), ORL_OK);
    set_square(&f.scene.points, 0, WALL, 3, 0, 4, red);
    set_square(&f.scene.points, SEEN, HIDDEN, 0.5, 0, 5, blue);
    look_along(&f, 3, 0.1);
    assert_int_equal(orl_point_ranking_make(gpu, &f.scene, 16, NULL, &ranking), ORL_OK);
    assert_int_equal(ranking.count, ALL);
    static bool listed[ALL];
    memset(listed, 0, sizeof listed);
    for (size_t i = 0; i < ALL; i++) {
        assert_false(listed[ranking.order[i]]); // each point once
        listed[ranking.order[i]] = true;
        if (i > 0 && ranking.order[i - 1] >= SEEN && ranking.pixels[ranking.order[i - 1]] == 0)
            assert_int_equal(ranking.pixels[ranking.order[i]], 0);
    }
    for (size_t i = SEEN; i < ALL; i++)
        assert_int_equal(ranking.pixels[i], 0);
    // The first points are spread over the wall, which a square millimetre of it would not be.
    float low = INFINITY, high = -INFINITY;
    for (size_t i = 0; i < 12; i++) {
        assert_true(ranking.order[i] < SEEN);
        low = fminf(low, f.scene.points.position[ranking.order[i]][0]);
        high = fmaxf(high, f.scene.points.position[ranking.order[i]][0]);
    }
    assert_true(high - low > 1.2f);
    orl_point_ranking_finish(&ranking);
    teardown(&f);
}

// Of a flat wall with noise, the points that are left lie on its mean, wider than before.
static void merged_points_lie_on_the_mean(void **state)
{
    (void)state;
    enum { N = 40 * 40, KEPT = N / 4 };
    struct orl_points wall, thin;
    static uint32_t order[N];
    assert_int_equal(orl_points_init(NULL, &wall, N), ORL_OK);
    set_square(&wall, 0, 40, 4, 0, 4, red);
    for (size_t i = 0; i < N; i++) {
        wall.position[i][2] += i % 2 ? 0.02f : -0.02f;
        order[i] = (uint32_t)(i * 7 % N); // 7 and N have no common factor
    }
    assert_int_equal(orl_points_thin_out(NULL, &wall, order, KEPT, &thin), ORL_OK);
    double off = 0, radius = 0;
    for (size_t k = 0; k < KEPT; k++) {
        off += fabs((double)thin.position[k][2] - 4) / KEPT;
        radius += (double)thin.radius[k] / KEPT;
    }
    assert_true(off < 0.008); // each lay 0.02 off
    assert_true(radius > 1.3 * (double)wall.radius[0]);
    assert_int_equal(orl_points_thin_out(NULL, &wall, order, N, &thin), ORL_OK);
    assert_int_equal(thin.count, N);
    orl_points_finish(&wall);
    orl_points_finish(&thin);
}

static void same_places_are_left_out_together(void **state)
{
    (void)state;
    struct fixture f;
    setup_empty(&f, 4);
    look_along(&f, 2, 0.5);
    add_photo(&f, look_from(0.001, 0, 0, SIDE, SIDE), red);
    assert_true(orl_validation_same_place(&f.scene, 0, 2));
    assert_false(orl_validation_same_place(&f.scene, 0, 1));
    teardown(&f);
}

// Where held-out photographs have the reference exposure for want of a better guess, training
// photographs are judged without their own exposure, too.
static void an_exposure_that_none_could_guess_does_not_judge(void **state)
{
    (void)state;
    struct fixture f;
    setup_empty(&f, 4);
    look_along(&f, 4, 0.5);
    for (int c = 0; c < 3; c++)
        f.scene.photos[1].gain[c] = 2;
    f.scene.photos[3].test = true;
    for (int guessed = 0; guessed < 2; guessed++) {
        struct orl_validation validation;
        f.scene.photos[3].gain[0] = guessed ? 1.5f : 1;
        assert_int_equal(orl_validation_load(NULL, &f.scene, 0, 1, &validation), ORL_OK);
        assert_int_equal(validation.count, 3);
        assert_float_equal(validation.scene.photos[1].gain[0], guessed ? 2 : 1, 0);
        assert_float_equal(f.scene.photos[1].gain[0], 2, 0); // the scene's own stays
        orl_validation_finish(&validation);
    }
    teardown(&f);
}

static bool is_taken(const struct orl_trim *trim, const char *what)
{
    for (size_t i = 0; i < trim->step_count; i++)
        if (trim->steps[i].taken && strcmp(trim->steps[i].what, what) == 0)
            return true;
    return false;
}

static void setup_wall(struct fixture *f)
{
    setup_empty(f, 4);
    assert_int_equal(orl_points_init(NULL, &f->scene.points, WALL * WALL), ORL_OK);
    set_square(&f->scene.points, 0, WALL, 8, 0, 4, red);
}

// A photograph of the wall, on which there are stripes, from (x, 0, 0).
static void add_striped(struct fixture *f, double x)
{
    struct orl_image image;
    add_photo(f, look_from(x, 0, 0, SIDE, SIDE), red);
    assert_int_equal(orl_image_init(NULL, &image, SIDE, SIDE, 3, ORL_PIXEL_U8), ORL_OK);
    for (int i = 0; i < SIDE * SIDE; i++) {
        double wall_x = x + 4 * (i % SIDE + 0.5 - SIDE / 2.0) / SIDE;
        double wall_y = 4 * (i / SIDE + 0.5 - SIDE / 2.0) / SIDE;
        for (int c = 0; c < 3; c++)
            image.u8[3 * i + c] =
                (uint8_t)(128 + 60 * sin(2 * wall_x + c) + 50 * sin(3 * wall_y - c));
    }
    repaint_photo(f, &image);
}

// Photographs side by side, of which the last repeats the first.
static void setup_same_places(struct fixture *f)
{
    enum { PHOTOS = 5 };
    setup_wall(f);
    for (size_t k = 0; k < PHOTOS; k++)
        add_striped(f, k + 1 < PHOTOS ? 0.8 * (double)k - 1.2 : -1.2);
}

// Writes what makes the fixture's folder a scene.
static void save_scene(const struct fixture *f)
{
    size_t count = f->scene.photo_count;
    struct orl_colmap_camera cameras[PHOTOS_MAX] = {0};
    struct orl_colmap_image images[PHOTOS_MAX] = {0};
    char *points = orl_path_join(NULL, f->dir, "points.ply");
    char *sparse = orl_path_join(NULL, f->dir, "sparse");
    char *manifest = orl_path_join(NULL, f->dir, "scene.json");
    FILE *json = fopen(manifest, "w");
    assert_non_null(json);
    fprintf(json, "{\"version\": 1, \"ground\": null, \"photographs\": [");
    for (size_t i = 0; i < count; i++) {
        const struct orl_camera *c = &f->photos[i].view.camera;
        cameras[i] = (struct orl_colmap_camera){
            .id = (uint32_t)i + 1, .model = 1, .pinhole = *c,
            .params = {c->fx, c->fy, c->cx, c->cy}, .param_count = 4};
        images[i] = (struct orl_colmap_image){.id = (uint32_t)i + 1, .camera_id = (uint32_t)i + 1,
                                              .name = f->photos[i].name,
                                              .cam_from_world = f->photos[i].view.cam_from_world};
        fprintf(json, "%s{\"name\": \"%s\", \"split\": \"%s\"}", i ? ", " : "",
                f->photos[i].name, f->photos[i].test ? "test" : "train");
    }
    fprintf(json, "]}\n");
    assert_int_equal(fclose(json), 0);
    assert_int_equal(orl_dir_make(NULL, sparse), ORL_OK);
    const struct orl_colmap_model model = {.cameras = cameras, .camera_count = count,
                                           .images = images, .image_count = count};
    assert_int_equal(orl_colmap_write(NULL, sparse, &model, NULL), ORL_OK);
    assert_int_equal(orl_points_write(NULL, points, &f->scene.points, false, NULL), ORL_OK);
    free(points);
    free(sparse);
    free(manifest);
}

// Trims the fixture's scene by method oriel, and removes what that makes.
static void trim(const struct fixture *f, double tolerance_db, double tolerance_ssim,
                 struct orl_trim *result)
{
    const struct orl_choice start = {.method = orl_method_find(NULL, "oriel"),
                                     .params = orl_method_find(NULL, "oriel")->params};
    char *out = orl_format(NULL, "%s-trimmed", f->dir);
    const struct orl_trim_params params = {
        .start = &start, .keep_options = true, .out = out, .tolerance_db = tolerance_db,
        .tolerance_ssim = tolerance_ssim,
        .worst_db = 5 * tolerance_db, .views = 8, .size_divide = 1};
    save_scene(f);
    assert_int_equal(orl_trim_run(gpu, &f->scene, &params, result), ORL_OK);
    assert_int_equal(orl_dir_remove(NULL, out), ORL_OK);
    free(out);
}

static void a_budget_that_cannot_be_kept_is_refused(void **state)
{
    (void)state;
    struct fixture f;
    struct orl_trim result;
    const struct orl_choice start = {.method = orl_method_find(NULL, "points"),
                                     .params = orl_method_find(NULL, "points")->params};
    setup_same_places(&f);
    char *out = orl_format(NULL, "%s-too-small", f.dir);
    const struct orl_trim_params params = {.start = &start, .keep_options = true, .out = out,
                                           .max_mib = 1e-6, .views = 2, .size_divide = 1};
    assert_int_equal(orl_trim_run(gpu, &f.scene, &params, &result), ORL_ERR_DATA);
    assert_null(result.steps);
    assert_false(orl_path_is_dir(out));
    free(out);
    teardown(&f);
}

// The tolerance holds for all training photographs, and nothing but it decides.
static void the_tolerance_is_kept(void **state)
{
    (void)state;
    static const double tolerances[] = {0.02, 0.5};
    struct fixture f;
    setup_same_places(&f);
    for (size_t i = 0; i < ORL_COUNT(tolerances); i++) {
        struct orl_trim result;
        trim(&f, tolerances[i], 1, &result);
        const struct orl_trim_figures *a = &result.before, *b = &result.after;
        assert_true(a->psnr_db - b->psnr_db <= tolerances[i]);
        assert_true(b->worst_loss_db <= 5 * tolerances[i]);
        assert_true(b->photo_bytes < a->photo_bytes);
        assert_true(is_taken(&result, "depth 1/1, 16 bits"));
        orl_trim_finish(&result);
    }
    teardown(&f);
}

// Where PSNR would let everything go, SSIM does not.
static void the_tolerance_of_ssim_is_kept(void **state)
{
    (void)state;
    static const double tolerances[] = {1, 0.002};
    double lost[ORL_COUNT(tolerances)];
    struct fixture f;
    setup_same_places(&f);
    for (size_t i = 0; i < ORL_COUNT(tolerances); i++) {
        struct orl_trim result;
        trim(&f, 20, tolerances[i], &result);
        lost[i] = result.before.ssim - result.after.ssim;
        orl_trim_finish(&result);
    }
    assert_true(lost[0] > 0.004);
    assert_true(lost[1] <= tolerances[1]);
    teardown(&f);
}

// Steps are taken back, the last one first, while all targets together lose more than they may.
static void steps_that_lose_too_much_are_taken_back(void **state)
{
    (void)state;
    struct fixture f;
    setup_same_places(&f);
    const struct orl_choice start = {.params = orl_method_find(NULL, "points")->params};
    const struct orl_trim_params params = {.start = &start};
    for (int fine = 0; fine < 2; fine++) {
        struct orl_trim report = {0};
        struct trim_search s = {.gpu = gpu, .scene = &f.scene, .params = &params, .trim = &report,
                                .most = {.psnr_db = 0.5, .ssim = 1, .worst_db = 9}};
        assert_int_equal(orl_validation_load(NULL, &f.scene, 0, 1, &s.targets), ORL_OK);
        assert_int_equal(orl_trim_state_begin(&s, ORL_TRIM_DEPTH, &s.first), ORL_OK);
        s.now = s.first;
        s.first->step.bytes = 100;
        assert_int_equal(orl_trim_model_open(&s, s.first), ORL_OK);
        assert_int_equal(orl_trim_measure_all(&s, &report.before), ORL_OK);
        for (size_t level = 1; level <= 2; level++) {
            struct trim_state *t;
            assert_int_equal(orl_trim_state_begin(&s, ORL_TRIM_DEPTH, &t), ORL_OK);
            t->level[ORL_TRIM_DEPTH] = level;
            t->step.bytes = s.now->step.bytes - 10;
            assert_int_equal(orl_trim_take(&s, &t), ORL_OK);
        }
        for (size_t i = 0; i < s.targets.count; i++)
            s.first->score.views[i][0] += fine ? 0.4 : 0.6;
        assert_int_equal(orl_trim_confirm(&s), ORL_OK);
        assert_true((s.now == s.first) == !fine);
        assert_int_equal(s.now->level[ORL_TRIM_DEPTH], fine ? 2 : 0);
        assert_int_equal(report.undone, fine ? 0 : 2);
        assert_true(report.steps[1].taken == fine);
        assert_float_equal(s.now->step.bytes, fine ? 80 : 100, 0);
        while (s.now) {
            struct trim_state *before = s.now->before;
            orl_trim_state_destroy(&s.now);
            s.now = before;
        }
        orl_validation_finish(&s.targets);
        orl_trim_finish(&report);
    }
    teardown(&f);
}

// Moves the photographs to a folder images/side, and gives each a background.
static void move_to_folder(struct fixture *f)
{
    for (size_t i = 0; i < f->scene.photo_count; i++) {
        char *from = strdup(orl_scene_file(&f->scene, i, ORL_FILE_PHOTO).text);
        char *name = orl_format(NULL, "side/%s", f->photos[i].name);
        free(f->photos[i].name);
        f->photos[i].name = name;
        char *to = strdup(orl_scene_file(&f->scene, i, ORL_FILE_PHOTO).text);
        char *background = strdup(orl_scene_file(&f->scene, i, ORL_FILE_BACKGROUND).text);
        assert_int_equal(orl_file_copy(NULL, from, to), ORL_OK);
        assert_int_equal(orl_file_copy(NULL, from, background), ORL_OK);
        free(from);
        free(to);
        free(background);
    }
}

// The files of photographs that are left out are left out too, and all others are there.
static void check_files(const struct orl_scene *whole, const struct orl_scene *small)
{
    struct orl_scene both = *whole; // its photographs in the folder of `small`
    size_t bad, files;
    both.dir = small->dir;
    for (size_t i = 0; i < whole->photo_count; i++) {
        bool kept = orl_scene_find_photo(small, whole->photos[i].name) >= 0;
        char *photo = strdup(orl_scene_file(&both, i, ORL_FILE_PHOTO).text);
        char *background = strdup(orl_scene_file(&both, i, ORL_FILE_BACKGROUND).text);
        assert_true(orl_path_is_file(photo) == kept);
        assert_true(orl_path_is_file(background) == kept);
        free(photo);
        free(background);
    }
    assert_int_equal(orl_manifest_check(NULL, small->dir, &bad, &files), ORL_OK);
    assert_int_equal(bad, 0);
    assert_int_equal(files, 4 + 2 * small->photo_count);
}

// Of two photographs from one place one goes, and the other photographs, which alone show parts of
// the wall, stay. The result opens, without the photograph.
static void a_photograph_that_repeats_another_goes(void **state)
{
    (void)state;
    struct fixture f;
    struct orl_trim result;
    struct orl_scene *whole, *small;
    setup_same_places(&f);
    move_to_folder(&f);
    save_scene(&f);
    char *out = orl_format(NULL, "%s-trimmed-scene", f.dir);
    assert_int_equal(orl_dir_remove(NULL, out), ORL_OK);
    assert_int_equal(orl_scene_open(NULL, f.dir, &whole), ORL_OK);
    const struct orl_choice start = {.method = orl_method_find(NULL, "airieau"),
                                     .params = orl_method_find(NULL, "airieau")->params};
    const struct orl_trim_params params = {.start = &start, .keep_options = true, .out = out, .tolerance_db = 0.1,
                                           .tolerance_ssim = 1, .worst_db = 0.5, .views = 8,
                                           .size_divide = 1};
    assert_int_equal(orl_trim_run(gpu, whole, &params, &result), ORL_OK);
    assert_true(is_taken(&result, "photographs 4 of 5"));
    assert_int_equal(result.after.photographs, 4);
    assert_true(result.after.file_bytes < result.before.file_bytes);
    assert_true(result.before.psnr_db - result.after.psnr_db <= 0.1);
    assert_int_equal(orl_scene_open(NULL, out, &small), ORL_OK);
    assert_int_equal(small->photo_count, 4);
    assert_true((orl_scene_find_photo(small, "side/0.png") < 0) !=
                (orl_scene_find_photo(small, "side/4.png") < 0));
    assert_int_equal(small->points.count, result.after.points);
    assert_string_equal(small->defaults.method, "airieau");
    check_files(whole, small);
    orl_scene_destroy(&small);
    orl_scene_destroy(&whole);
    orl_trim_finish(&result);
    assert_int_equal(orl_dir_remove(NULL, out), ORL_OK);
    free(out);
    teardown(&f);
}

// Where photographs stand close to each other, many of them go, within the tolerances.
static void photographs_that_stand_close_go(void **state)
{
    (void)state;
    enum { PHOTOS = 40 };
    struct fixture f;
    struct orl_trim result;
    struct orl_scene *whole;
    setup_wall(&f);
    for (size_t k = 0; k < PHOTOS; k++)
        add_striped(&f, 0.1 * (double)k - 2);
    save_scene(&f);
    char *out = orl_format(NULL, "%s-trimmed-row", f.dir);
    assert_int_equal(orl_dir_remove(NULL, out), ORL_OK);
    assert_int_equal(orl_scene_open(NULL, f.dir, &whole), ORL_OK);
    const struct orl_choice start = {.method = orl_method_find(NULL, "airieau"),
                                     .params = orl_method_find(NULL, "airieau")->params};
    // All differ from the truth by 55 dB or more, which depends on how a device rounds.
    const struct orl_trim_params params = {.start = &start, .keep_options = true, .out = out, .tolerance_db = 3,
                                           .tolerance_ssim = 0.01, .worst_db = 6, .views = 4,
                                           .size_divide = 1};
    assert_int_equal(orl_trim_run(gpu, whole, &params, &result), ORL_OK);
    assert_true(result.after.photographs <= PHOTOS - PHOTOS / 4);
    assert_true(result.before.psnr_db - result.after.psnr_db <= 3);
    assert_true(result.before.ssim - result.after.ssim <= 0.01);
    assert_true(result.after.worst_loss_db <= 6);
    orl_scene_destroy(&whole);
    orl_trim_finish(&result);
    assert_int_equal(orl_dir_remove(NULL, out), ORL_OK);
    free(out);
    teardown(&f);
}

// What a held-out photograph shows changes nothing but its own figures.
static void held_out_photographs_never_steer(void **state)
{
    (void)state;
    struct orl_trim results[2];
    for (int k = 0; k < 2; k++) {
        struct fixture f;
        setup_same_places(&f);
        add_photo(&f, look_from(0.4, 0, 0, SIDE, SIDE), k ? red : blue);
        f.photos[f.scene.photo_count - 1].test = true;
        trim(&f, 0.1, 1, &results[k]);
        teardown(&f);
    }
    const struct orl_trim *a = &results[0], *b = &results[1];
    assert_true(a->before.psnr_db == b->before.psnr_db);
    assert_true(a->before.held_psnr_db != b->before.held_psnr_db);
    // Which step comes next depends on times too. The first one does not.
    assert_string_equal(a->steps[0].what, b->steps[0].what);
    assert_true(a->steps[0].loss_db == b->steps[0].loss_db);
    orl_trim_finish(&results[0]);
    orl_trim_finish(&results[1]);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(hidden_points_go_first),
        cmocka_unit_test(merged_points_lie_on_the_mean),
        cmocka_unit_test(same_places_are_left_out_together),
        cmocka_unit_test(an_exposure_that_none_could_guess_does_not_judge),
        cmocka_unit_test(a_budget_that_cannot_be_kept_is_refused),
        cmocka_unit_test(the_tolerance_is_kept),
        cmocka_unit_test(the_tolerance_of_ssim_is_kept),
        cmocka_unit_test(steps_that_lose_too_much_are_taken_back),
        cmocka_unit_test(a_photograph_that_repeats_another_goes),
        cmocka_unit_test(photographs_that_stand_close_go),
        cmocka_unit_test(held_out_photographs_never_steer),
    };
    gpu = gpu_test_device();
    int failed = cmocka_run_group_tests(tests, NULL, NULL);
    orl_gpu_destroy(&gpu);
    return failed;
}
