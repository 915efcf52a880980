// The held-out protocol on the tiny scene.
#include "../gpu/gpu_test.h"

#include <jansson.h>
#include <math.h>
#include <string.h>

#include "core/memory.h"
#include "eval/eval.h"
#include "eval/search.h"
#include "io/picture.h"
#include "tiny_scene.h"

static struct orl_gpu *gpu;

static int set_up(void **state)
{
    (void)state;
    gpu = gpu_test_device();
    return 0;
}

static int tear_down(void **state)
{
    (void)state;
    orl_gpu_destroy(&gpu);
    return 0;
}

static struct orl_eval evaluate(const struct orl_scene *scene, const char *method,
                                const char *image_dir)
{
    struct orl_renderer *renderer;
    struct orl_eval eval;
    const struct orl_method *row = orl_method_find(NULL, method);
    assert_non_null(row);
    assert_int_equal(orl_renderer_create(gpu, scene, NULL, &renderer), ORL_OK);
    const struct orl_choice choice = {.method = row, .params = row->params};
    const struct orl_eval_params params = {.choice = &choice, .image_dir = image_dir};
    assert_int_equal(orl_eval_run(gpu, renderer, scene, &params, &eval), ORL_OK);
    orl_renderer_destroy(&renderer);
    return eval;
}

static void check_picture(const char *dir, const char *name, int width, int height)
{
    char *path = orl_path_join(NULL, dir, name);
    int w, h;
    assert_int_equal(orl_picture_size(NULL, path, &w, &h), ORL_OK);
    assert_int_equal(w, width);
    assert_int_equal(h, height);
    free(path);
}

static void known_scene(void **state)
{
    (void)state;
    char *dir = test_dir_make(), *images = orl_path_join(NULL, dir, "out/pictures");
    struct orl_scene scene;
    tiny_scene_make(dir, &scene);
    struct orl_eval photos = evaluate(&scene, "airieau", images);
    struct orl_eval points = evaluate(&scene, "points", NULL);
    assert_int_equal(photos.view_count, 1);
    assert_int_equal(photos.views[0].photo, TINY_TEST_PHOTO);
    assert_int_equal(photos.views[0].width, TINY_WIDTH);
    assert_true(photos.views[0].render_ms > 0);
    assert_true(photos.pass_count > 0);
    print_message("airieau %.2f dB, SSIM %.4f, coverage %.3f; points %.2f dB\n",
                  photos.mean.metrics.psnr_db, photos.mean.metrics.ssim,
                  photos.mean.metrics.coverage, points.mean.metrics.psnr_db);
    assert_true(photos.mean.metrics.psnr_db > 24);
    assert_true(photos.mean.metrics.ssim > 0.85);
    assert_true(photos.mean.metrics.coverage > 0.8);
    assert_true(photos.mean.flip > 0.01 && photos.mean.flip < points.mean.flip);
    check_picture(images, "2.photo.png", TINY_WIDTH, TINY_HEIGHT);
    check_picture(images, "2.airieau.png", TINY_WIDTH, TINY_HEIGHT);
    check_picture(images, "2.airieau.diff.png", 3 * TINY_WIDTH, TINY_HEIGHT);
    orl_eval_finish(&photos);
    orl_eval_finish(&points);
    tiny_scene_finish(&scene);
    free(images);
    test_dir_remove(dir);
}

// What is held out must not be painted with: a held-out photograph of another colour
// changes the comparison, never the rendering.
static void held_out_pixels_are_not_used(void **state)
{
    (void)state;
    char *dir = test_dir_make();
    struct orl_scene scene;
    tiny_scene_make(dir, &scene);
    struct orl_eval before = evaluate(&scene, "airieau", NULL);
    struct orl_image black;
    assert_int_equal(orl_image_init(NULL, &black, TINY_WIDTH, TINY_HEIGHT, 3, ORL_PIXEL_U8),
                     ORL_OK);
    memset(black.u8, 1, orl_image_bytes(&black));
    char *path = strdup(orl_scene_file(&scene, TINY_TEST_PHOTO, ORL_FILE_PHOTO).text);
    char *out = orl_path_join(NULL, dir, "out"), *name = orl_path_join(NULL, out, "2.airieau.png");
    assert_int_equal(orl_png_write(NULL, path, &black), ORL_OK);
    struct orl_eval after = evaluate(&scene, "airieau", out);
    struct orl_image rendered;
    struct orl_metrics same;
    assert_true(after.mean.metrics.psnr_db < 15);
    assert_float_equal(after.mean.metrics.completeness, before.mean.metrics.completeness, 0);
    tiny_scene_finish(&scene);
    tiny_scene_make(dir, &scene); // the true photograph again
    struct orl_image truth, coverage;
    assert_int_equal(orl_picture_read(NULL, path, 3, &truth), ORL_OK);
    assert_int_equal(orl_picture_read(NULL, name, 3, &rendered), ORL_OK);
    assert_int_equal(orl_image_init(NULL, &coverage, TINY_WIDTH, TINY_HEIGHT, 1, ORL_PIXEL_F32),
                     ORL_OK);
    assert_int_equal(orl_metrics_compare(NULL, &rendered, &truth, &coverage, &same), ORL_OK);
    assert_float_equal(same.psnr_db, before.mean.metrics.psnr_db, 1e-9);
    orl_image_finish(&black);
    orl_image_finish(&truth);
    orl_image_finish(&rendered);
    orl_image_finish(&coverage);
    orl_eval_finish(&before);
    orl_eval_finish(&after);
    tiny_scene_finish(&scene);
    free(path);
    free(name);
    free(out);
    test_dir_remove(dir);
}

// oriel tune must seek what oriel eval reports: a photograph of an exposure of its own,
// vignetted, rendered without itself, has one figure for both.
static void tune_measures_what_eval_reports(void **state)
{
    (void)state;
    static const enum orl_alignment_use uses[] = {ORL_ALIGNMENT_ON, ORL_ALIGNMENT_OFF};
    char *dir = test_dir_make();
    struct orl_scene scene;
    tiny_scene_make(dir, &scene);
    const size_t last = scene.photo_count - 1; // what tune compares with when it is to take one
    for (size_t i = 0; i < scene.photo_count; i++)
        scene.photos[i].gain[0] = 1 + 0.1f * (float)i;
    scene.photos[last].gain[1] = 2;
    scene.photos[last].vignette[0] = -0.3f;
    double figures[2];
    for (size_t k = 0; k < ORL_COUNT(uses); k++) {
        struct orl_choice choice = {.method = orl_method_find(NULL, "oriel")};
        choice.params = choice.method->params;
        choice.params.alignment = uses[k];
        const struct orl_eval_params eval_params = {.choice = &choice};
        const struct orl_search_params params = {.size_divide = 1, .views = 1, .budget_s = 1e-6};
        struct orl_renderer *renderer;
        struct orl_eval eval;
        struct orl_search search;
        for (size_t i = 0; i < scene.photo_count; i++)
            scene.photos[i].test = i == last;
        assert_int_equal(orl_renderer_create(gpu, &scene, NULL, &renderer), ORL_OK);
        assert_int_equal(orl_eval_run(gpu, renderer, &scene, &eval_params, &eval), ORL_OK);
        orl_renderer_destroy(&renderer);
        scene.photos[last].test = false;
        assert_int_equal(orl_renderer_create(gpu, &scene, NULL, &renderer), ORL_OK);
        assert_int_equal(orl_search_run(gpu, renderer, &scene, &params, &choice, NULL, &search),
                         ORL_OK);
        orl_renderer_destroy(&renderer);
        assert_int_equal(search.trial_count, 1);
        assert_float_equal(search.trials[0].psnr_db, eval.mean.metrics.psnr_db, 1e-3);
        assert_float_equal(search.trials[0].ssim, eval.mean.metrics.ssim, 1e-5);
        figures[k] = search.trials[0].psnr_db;
        orl_eval_finish(&eval);
        orl_search_finish(&search);
    }
    assert_true(fabs(figures[0] - figures[1]) > 0.5); // the exposure is no trifle here
    tiny_scene_finish(&scene);
    test_dir_remove(dir);
}

static double number(const json_t *object, const char *key)
{
    const json_t *value = json_object_get(object, key);
    assert_true(json_is_number(value));
    return json_number_value(value);
}

static void check_figures(const json_t *object, const struct orl_eval_view *view)
{
    const struct orl_metrics *m = &view->metrics;
    assert_float_equal(number(object, "psnr_db"), m->psnr_db, 1e-4);
    assert_float_equal(number(object, "psnr_cc_db"), m->psnr_cc_db, 1e-4);
    assert_float_equal(number(object, "psnr_covered_db"), m->psnr_covered_db, 1e-4);
    assert_float_equal(number(object, "ssim"), m->ssim, 1e-6);
    assert_float_equal(number(object, "coverage"), m->coverage, 1e-6);
    assert_float_equal(number(object, "completeness"), m->completeness, 1e-6);
    assert_float_equal(number(object, "ncc_error"), m->ncc_error, 1e-6);
    assert_float_equal(number(object, "crumbs"), m->crumbs, 1e-6);
    assert_float_equal(number(object, "flip"), view->flip, 1e-6);
    assert_float_equal(number(object, "render_ms"), view->render_ms, 1e-3);
}

static void report_has_the_agreed_fields(void **state)
{
    (void)state;
    struct orl_photo photos[2] = {{.name = (char[]){"a.jpg"}, .test = true},
                                  {.name = (char[]){"b.jpg"}, .test = true}};
    struct orl_scene scene = {.dir = (char[]){"some/scene"}, .photos = photos, .photo_count = 2};
    struct orl_eval_view views[2] = {
        {0, 64, 48, {20.5, 21.5, 22.5, 0.75, 0.875, 0.9375, 0.125, 2.5}, {33, 34, 0.25, 0.5}, {0, 0, 0},
         3.5, 4.5, 0.0625},
        {1, 32, 24, {30.5, 31.5, 32.5, 0.25, 0.375, 0.4375, 1.125, 7.25}, {35, 36, 0.75, 1}, {0, 0, 0},
         1.5, 2.5, 0.03125}};
    struct orl_eval eval = {.scene = &scene, .method = "points", .device = "a device",
                            .views = views, .view_count = 2, .mean = views[1],
                            .passes = {{"splat", 0.5}}, .pass_count = 1};
    json_t *json = orl_eval_report(&eval);
    assert_string_equal(json_string_value(json_object_get(json, "scene")), "some/scene");
    assert_string_equal(json_string_value(json_object_get(json, "method")), "points");
    assert_string_equal(json_string_value(json_object_get(json, "device")), "a device");
    assert_int_equal(json_integer_value(json_array_get(json_object_get(json, "size"), 0)), 64);
    assert_int_equal(json_integer_value(json_array_get(json_object_get(json, "size"), 1)), 48);
    const json_t *list = json_object_get(json, "views");
    assert_int_equal(json_array_size(list), 2);
    for (size_t i = 0; i < 2; i++) {
        const json_t *view = json_array_get(list, i);
        assert_string_equal(json_string_value(json_object_get(view, "photo")), photos[i].name);
        check_figures(view, &views[i]);
    }
    check_figures(json_object_get(json, "mean"), &views[1]);
    assert_null(json_object_get(json_object_get(json, "mean"), "log2_rmse")); // no truth
    assert_float_equal(number(json_object_get(json, "passes_ms"), "splat"), 0.5, 1e-9);
    json_decref(json);

    eval.has_truth = true;
    json = orl_eval_report(&eval);
    const json_t *view = json_array_get(json_object_get(json, "views"), 0);
    assert_float_equal(number(view, "pu21_psnr_db"), 33, 0);
    assert_float_equal(number(view, "mu_psnr_db"), 34, 0);
    assert_float_equal(number(view, "log2_rmse"), 0.25, 0);
    assert_float_equal(number(view, "log2_rmse_fitted"), 0.5, 0);
    assert_float_equal(number(json_object_get(json, "mean"), "mu_psnr_db"), 36, 0);
    json_decref(json);
    eval.mean.flip = NAN;
    assert_null(orl_eval_report(&eval));
}

static void nothing_held_out(void **state)
{
    (void)state;
    char *dir = test_dir_make();
    struct orl_scene scene;
    tiny_scene_make(dir, &scene);
    scene.photos[TINY_TEST_PHOTO].test = false;
    assert_int_equal(orl_eval_check(NULL, &scene), ORL_ERR_DATA);
    scene.photos[TINY_TEST_PHOTO].test = true;
    assert_int_equal(orl_eval_check(NULL, &scene), ORL_OK);
    tiny_scene_finish(&scene);
    test_dir_remove(dir);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(report_has_the_agreed_fields),
        cmocka_unit_test(nothing_held_out),
        cmocka_unit_test(known_scene),
        cmocka_unit_test(held_out_pixels_are_not_used),
        cmocka_unit_test(tune_measures_what_eval_reports),
    };
    return cmocka_run_group_tests(tests, set_up, tear_down);
}
