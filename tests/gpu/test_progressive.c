// Frames of a viewer, which do not wait for photographs.
#include <math.h>
#include <pthread.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include "figure_scene.h"
#include "io/picture.h"

static struct orl_gpu *gpu;
enum { SIDE = 96, PHOTOS = 3, TRIES = 2000 };

// The test is linked with --wrap: orl_picture_read is the function below, which holds the files of photographs back
// while files_held is true. Masks are not held back, since drawing waits for them.
static pthread_mutex_t files_lock = PTHREAD_MUTEX_INITIALIZER;
static pthread_cond_t files_change = PTHREAD_COND_INITIALIZER;
static bool files_held;

enum orl_result __real_orl_picture_read(const struct orl_log *log, const char *path, int channels,
                                        struct orl_image *image);
enum orl_result __wrap_orl_picture_read(const struct orl_log *log, const char *path, int channels,
                                        struct orl_image *image);

enum orl_result __wrap_orl_picture_read(const struct orl_log *log, const char *path, int channels,
                                        struct orl_image *image)
{
    pthread_mutex_lock(&files_lock);
    while (files_held && strstr(path, "/images/"))
        pthread_cond_wait(&files_change, &files_lock);
    pthread_mutex_unlock(&files_lock);
    return __real_orl_picture_read(log, path, channels, image);
}

static void hold_files(bool held)
{
    pthread_mutex_lock(&files_lock);
    files_held = held;
    pthread_cond_broadcast(&files_change);
    pthread_mutex_unlock(&files_lock);
}

// A red wall that green photographs show.
static void setup_green(struct fixture *f)
{
    setup(f, false);
    for (int i = 0; i < PHOTOS; i++)
        add_photo(f, look_from(0.2 * (i - 1), 0, 0, SIDE, SIDE), green);
}

static struct orl_frame draw_progressive(struct orl_renderer *renderer, struct orl_view view,
                                         const struct orl_render_params *params,
                                         struct orl_progressive *progress)
{
    struct orl_frame frame;
    assert_int_equal(orl_renderer_draw_progressive(renderer, &view, params, progress, &frame),
                     ORL_OK);
    return frame;
}

// The first frame of a renderer, which is made here: no photograph is there yet.
static struct orl_frame draw_first(const struct fixture *f, struct orl_view view, const struct orl_render_params *params,
                                   struct orl_renderer **renderer)
{
    struct orl_progressive progress = {.seconds = 0};
    hold_files(true);
    assert_int_equal(orl_renderer_create(gpu, &f->scene, NULL, renderer), ORL_OK);
    struct orl_frame frame = draw_progressive(*renderer, view, params, &progress);
    hold_files(false);
    assert_true(progress.missing >= PHOTOS);
    return frame;
}

// Draws until no photograph is missing.
static struct orl_frame draw_to_the_end(struct orl_renderer *renderer, struct orl_view view,
                                        const struct orl_render_params *params)
{
    struct orl_progressive progress = {.at_rest = true, .missing = 1};
    struct orl_frame frame = {0};
    for (int i = 0; progress.missing > 0; i++) {
        assert_true(i < TRIES);
        orl_frame_finish(&frame);
        frame = draw_progressive(renderer, view, params, &progress);
        usleep(1000);
    }
    return frame;
}

static void assert_same(const struct orl_image *a, const struct orl_image *b)
{
    assert_int_equal(a->width, b->width);
    assert_memory_equal(a->f32, b->f32,
                        (size_t)a->width * (size_t)a->height * (size_t)a->channels * sizeof(float));
}

// Before its photographs come, a frame shows the points' colour. In the end it has the bits of a
// frame that waits for them.
static void test_from_points_to_photographs(const char *method)
{
    struct fixture f;
    struct orl_renderer *renderer;
    const struct orl_render_params *params = &orl_method_find(NULL, method)->params;
    struct orl_view view = look_from(0.1, 0, 0, SIDE, SIDE);
    setup_green(&f);
    struct orl_frame first = draw_first(&f, view, params, &renderer);
    const float *color = color_at(&first, SIDE / 2, SIDE / 2);
    assert_float_equal(color[0], 1, 0.01f);
    assert_float_equal(color[1], 0, 0.01f);
    struct orl_frame last = draw_to_the_end(renderer, view, params);
    assert_float_equal(color_at(&last, SIDE / 2, SIDE / 2)[1], 1, 0.01f);
    struct orl_frame waited = draw(gpu, &f, view, params, 0);
    assert_same(&last.color, &waited.color);
    assert_same(&last.coverage, &waited.coverage);
    orl_frame_finish(&first);
    orl_frame_finish(&last);
    orl_frame_finish(&waited);
    orl_renderer_destroy(&renderer);
    teardown(&f);
}

static void test_tiled(void **state)
{
    (void)state;
    test_from_points_to_photographs("oriel");
}

static void test_gather(void **state)
{
    (void)state;
    test_from_points_to_photographs("airieau");
}

// Methods of silhouettes: nothing waits, and in the end there is the frame that waited.
static void test_silhouettes(const char *method)
{
    struct fixture f;
    struct orl_renderer *renderer;
    struct orl_render_params params = orl_method_find(NULL, method)->params;
    params.hull_side = 24;
    setup_figure(&f, PHOTOS, 64, 48);
    struct orl_view view = f.photos[0].view;
    struct orl_frame first = draw_first(&f, view, &params, &renderer);
    struct orl_frame last = draw_to_the_end(renderer, view, &params);
    struct orl_frame waited = draw(gpu, &f, view, &params, 0);
    assert_same(&last.color, &waited.color);
    assert_same(&last.coverage, &waited.coverage);
    size_t bytes = (size_t)view.camera.width * (size_t)view.camera.height * 3 * sizeof(float);
    assert_memory_not_equal(first.color.f32, last.color.f32, bytes);
    orl_frame_finish(&first);
    orl_frame_finish(&last);
    orl_frame_finish(&waited);
    orl_renderer_destroy(&renderer);
    teardown(&f);
}

static void test_goldluecke(void **state)
{
    (void)state;
    test_silhouettes("goldluecke");
}

static void test_li(void **state)
{
    (void)state;
    test_silhouettes("li");
}

// With room for fewer photographs than there are, the nearest are there and none is awaited.
static void test_little_memory(void **state)
{
    (void)state;
    struct fixture f;
    struct orl_renderer *renderer;
    const struct orl_render_params *params = &orl_method_find(NULL, "oriel")->params;
    setup_green(&f);
    assert_int_equal(orl_renderer_create(gpu, &f.scene,
                                         &(struct orl_renderer_params){.max_vram_bytes = 1},
                                         &renderer), ORL_OK);
    struct orl_frame frame = draw_to_the_end(renderer, look_from(0.2, 0, 0, SIDE, SIDE), params);
    assert_float_equal(color_at(&frame, SIDE / 2, SIDE / 2)[1], 1, 0.01f);
    orl_frame_finish(&frame);
    orl_renderer_destroy(&renderer);
    teardown(&f);
}

// A photograph that is not there is left out; the others paint. With the next time step it is asked for again.
static void test_missing_file(void **state)
{
    (void)state;
    struct fixture f;
    struct orl_renderer *renderer;
    const struct orl_render_params *params = &orl_method_find(NULL, "oriel")->params;
    setup_green(&f);
    const size_t one = 3 * SIDE * SIDE; // bytes of a photograph
    char *path = strdup(orl_scene_file(&f.scene, 1, ORL_FILE_PHOTO).text);
    char *other = strdup(orl_scene_file(&f.scene, 0, ORL_FILE_PHOTO).text);
    assert_int_equal(unlink(path), 0);
    assert_int_equal(orl_renderer_create(gpu, &f.scene, NULL, &renderer), ORL_OK);
    struct orl_frame frame = draw_to_the_end(renderer, look_from(0, 0, 0, SIDE, SIDE), params);
    assert_float_equal(color_at(&frame, SIDE / 2, SIDE / 2)[1], 1, 0.01f);
    assert_int_equal(orl_renderer_uploaded(renderer), (PHOTOS - 1) * one);
    orl_frame_finish(&frame);
    assert_int_equal(orl_file_copy(NULL, other, path), ORL_OK);
    f.scene.frame++;
    frame = draw_to_the_end(renderer, look_from(0, 0, 0, SIDE, SIDE), params);
    assert_int_equal(orl_renderer_uploaded(renderer), (2 * PHOTOS - 1) * one);
    orl_frame_finish(&frame);
    orl_renderer_destroy(&renderer);
    free(path);
    free(other);
    teardown(&f);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_tiled),
        cmocka_unit_test(test_gather),
        cmocka_unit_test(test_goldluecke),
        cmocka_unit_test(test_li),
        cmocka_unit_test(test_little_memory),
        cmocka_unit_test(test_missing_file),
    };
    gpu = gpu_test_device();
    int failed = cmocka_run_group_tests(tests, NULL, NULL);
    assert_int_equal(orl_gpu_finish(gpu), ORL_OK);
    orl_gpu_destroy(&gpu);
    return failed;
}
