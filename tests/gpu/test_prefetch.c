// The next time step of a sequence, prepared while one is drawn: the same pictures, and nothing is read
// twice.
#include <math.h>
#include <unistd.h>

#include "figure_scene.h"
#include "render/hull/prefetch.h"
#include "render/photos/photos.h"

enum { W = 96, H = 72, CAMERAS = 5, TIME_STEPS = 3 };

static struct orl_gpu *gpu;

static void make_folder(const struct fixture *f, const char *name)
{
    char *path = orl_path_join(NULL, f->dir, name);
    assert_int_equal(orl_dir_make(NULL, path), ORL_OK);
    free(path);
}

// The figure, which walks on from time step to time step.
static void setup_time_steps(struct fixture *f)
{
    const struct orl_figures_params params = {CAMERAS, 1, W, H};
    struct orl_view views[CAMERAS];
    struct orl_figure figure;
    setup_empty(f, 3);
    make_folder(f, "frames");
    f->scene.frame_count = TIME_STEPS;
    orl_figures_views(&params, views);
    for (f->scene.frame = 0; f->scene.frame < TIME_STEPS; f->scene.frame++) {
        char folder[48];
        snprintf(folder, sizeof folder, "frames/%05d", f->scene.frame);
        make_folder(f, folder);
        snprintf(folder, sizeof folder, "frames/%05d/images", f->scene.frame);
        make_folder(f, folder);
        snprintf(folder, sizeof folder, "frames/%05d/masks", f->scene.frame);
        make_folder(f, folder);
        orl_figure_pose(4 * f->scene.frame, &figure);
        for (size_t i = 0; i < CAMERAS; i++) {
            struct orl_figures_picture picture;
            assert_int_equal(orl_figures_draw(NULL, &figure, &views[i], &picture), ORL_OK);
            if (f->scene.frame == 0)
                add_photo(f, views[i], red);
            char *photo = strdup(orl_scene_file(&f->scene, i, ORL_FILE_PHOTO).text);
            char *mask = strdup(orl_scene_file(&f->scene, i, ORL_FILE_MASK).text);
            assert_int_equal(orl_png_write(NULL, photo, &picture.photo), ORL_OK);
            assert_int_equal(orl_png_write(NULL, mask, &picture.mask), ORL_OK);
            f->photos[i].masked = true;
            free(photo);
            free(mask);
            orl_figures_picture_finish(&picture);
        }
    }
    f->scene.frame = 0;
}

static struct orl_render_params params_of(const char *method, const char *choice)
{
    struct orl_render_params params = orl_method_find(NULL, method)->params;
    assert_int_equal(orl_render_params_set(NULL, &params, choice), ORL_OK);
    return params;
}

// --- pictures ---

// Draws the time steps in this order; expected: what is said of the next one, NULL: nothing.
static void draw_time_steps(struct fixture *f, const struct orl_render_params *params,
                            const int *time_steps, const int *expected, struct orl_frame frames[4])
{
    struct orl_renderer *renderer;
    const struct orl_view *view = &f->photos[1].view;
    assert_int_equal(orl_renderer_create(gpu, &f->scene, NULL, &renderer), ORL_OK);
    for (int i = 0; i < 4; i++) {
        // The last of the views does without one photograph and its silhouette.
        const bool skip[CAMERAS] = {[0] = i == 3};
        assert_int_equal(orl_scene_set_frame(NULL, &f->scene, time_steps[i]), ORL_OK);
        if (expected)
            orl_renderer_expect(renderer, expected[i]);
        assert_int_equal(orl_renderer_draw(renderer, view, params, skip, &frames[i]), ORL_OK);
    }
    orl_renderer_destroy(&renderer);
}

static void assert_same(const struct orl_image *a, const struct orl_image *b)
{
    assert_int_equal(orl_image_bytes(a), orl_image_bytes(b));
    assert_memory_equal(a->data, b->data, orl_image_bytes(a));
}

static void pictures_are_the_same(void **state)
{
    (void)state;
    static const char *const rows[][2] = {{"li", "hull_side=64"},
                                          {"goldluecke", "hull_side=32"}};
    // Time step 1 is shown twice. The second list expects what does not come.
    static const int time_steps[4] = {0, 1, 1, 2}, expected[2][4] = {{1, 1, 2, -1}, {2, 0, 2, 0}};
    struct fixture f;
    setup_time_steps(&f);
    for (size_t row = 0; row < ORL_COUNT(rows); row++) {
        struct orl_render_params params = params_of(rows[row][0], rows[row][1]);
        struct orl_frame plain[4], early[4];
        draw_time_steps(&f, &params, time_steps, NULL, plain);
        for (int list = 0; list < 2; list++) {
            draw_time_steps(&f, &params, time_steps, expected[list], early);
            for (int i = 0; i < 4; i++) {
                assert_same(&plain[i].color, &early[i].color);
                assert_same(&plain[i].depth, &early[i].depth);
                orl_frame_finish(&early[i]);
            }
        }
        // The time steps differ, or equal pictures would say nothing.
        assert_memory_not_equal(plain[0].color.data, plain[1].color.data,
                                orl_image_bytes(&plain[0].color));
        assert_memory_not_equal(plain[2].color.data, plain[3].color.data,
                                orl_image_bytes(&plain[2].color));
        for (int i = 0; i < 4; i++)
            orl_frame_finish(&plain[i]);
    }
    teardown(&f);
}

// --- what is prepared ---

struct stage {
    struct fixture f;
    struct orl_render_params params;
    struct photos photos;
    struct proxy proxy;
    struct frame frame;
};

static void setup_stage(struct stage *s)
{
    const struct orl_renderer_params none = {0};
    setup_time_steps(&s->f);
    s->params = params_of("li", "hull_side=64");
    assert_int_equal(orl_photos_init(gpu, &s->f.scene, &none, 0, &s->photos), ORL_OK);
    assert_int_equal(orl_proxy_create(gpu, &s->f.scene, &orl_proxy_hull, 0, &s->proxy), ORL_OK);
    s->frame = (struct frame){.gpu = gpu, .scene = &s->f.scene, .params = &s->params,
                              .proxy = &s->proxy, .photos = &s->photos};
}

static void finish_stage(struct stage *s)
{
    orl_proxy_finish(gpu, &s->proxy);
    orl_photos_finish(gpu, &s->photos);
    teardown(&s->f);
}

static void remove_file(char *path)
{
    assert_int_equal(remove(path), 0);
    free(path);
}

// Prepares time step 1 with all its photographs, as while time step 0 is drawn.
static struct prefetch *prepare(struct stage *s)
{
    static const size_t all[CAMERAS] = {0, 1, 2, 3, 4};
    struct prefetch *prefetch;
    assert_int_equal(orl_prefetch_create(&s->frame, 1, &prefetch), ORL_OK);
    assert_int_equal(orl_prefetch_time_step(prefetch), 1);
    orl_prefetch_want(prefetch, all, CAMERAS);
    orl_prefetch_show(prefetch, &s->photos); // waits for the silhouettes
    assert_int_equal(orl_prefetch_carve(gpu, prefetch), ORL_OK);
    assert_int_equal(orl_prefetch_collect(gpu, prefetch), ORL_OK);
    orl_photo_loader_wait(s->photos.ahead);
    orl_prefetch_show(NULL, &s->photos);
    return prefetch;
}

// Nothing is left to read: the files may be gone.
static void files_are_read_once(void **state)
{
    (void)state;
    struct stage s;
    setup_stage(&s);
    struct prefetch *prefetch = prepare(&s);
    s.f.scene.frame = 1;
    assert_int_equal(orl_proxy_update(&s.frame), ORL_OK); // as without
    size_t count = s.proxy.vertex_count;
    float (*plain)[3] = malloc(count * sizeof *plain);
    memcpy(plain, s.proxy.vertices, count * sizeof *plain);
    for (size_t i = 0; i < CAMERAS; i++) {
        remove_file(strdup(orl_scene_file(&s.f.scene, i, ORL_FILE_PHOTO).text));
        remove_file(strdup(orl_scene_file(&s.f.scene, i, ORL_FILE_MASK).text));
    }
    orl_proxy_finish(gpu, &s.proxy);
    assert_int_equal(orl_proxy_create(gpu, &s.f.scene, &orl_proxy_hull, 0, &s.proxy), ORL_OK);
    orl_prefetch_show(prefetch, &s.photos);
    s.frame.prefetch = prefetch;
    assert_int_equal(orl_proxy_update(&s.frame), ORL_OK);
    assert_int_equal(s.proxy.vertex_count, count);
    assert_memory_equal(s.proxy.vertices, plain, count * sizeof *plain);
    for (size_t i = 0; i < CAMERAS; i++) {
        assert_int_equal(orl_photos_require(&s.frame, i, false), ORL_OK);
        assert_int_equal(orl_photos_require_mask(&s.frame, i), ORL_OK);
    }
    free(plain);
    orl_prefetch_destroy(gpu, &prefetch);
    finish_stage(&s);
}

// A hull of other triangles, voxels or silhouettes is not the one that was prepared.
static void another_hull_is_not_taken(void **state)
{
    (void)state;
    struct stage s;
    struct voxels voxels;
    struct orl_mesh mesh;
    setup_stage(&s);
    struct prefetch *prefetch = prepare(&s);
    s.f.scene.frame = 1;
    uint64_t key = orl_voxels_key(&s.frame);
    const bool skip[CAMERAS] = {[2] = true};
    s.frame.skip = skip;
    assert_false(orl_prefetch_take_hull(gpu, prefetch, orl_voxels_key(&s.frame), &voxels,
                                         &mesh));
    assert_true(orl_prefetch_take_hull(gpu, prefetch, key, &voxels, &mesh));
    assert_false(orl_prefetch_take_hull(gpu, NULL, key, &voxels, &mesh));
    orl_voxels_finish(&voxels);
    orl_mesh_finish(&mesh);
    orl_prefetch_destroy(gpu, &prefetch);
    finish_stage(&s);
}

// A time step without all of its files is left to the frame that shows it.
static void missing_files_are_left_alone(void **state)
{
    (void)state;
    struct stage s;
    struct prefetch *prefetch;
    setup_stage(&s);
    s.f.scene.frame = 1;
    remove_file(strdup(orl_scene_file(&s.f.scene, 3, ORL_FILE_PHOTO).text));
    s.f.scene.frame = 0;
    assert_int_equal(orl_prefetch_create(&s.frame, 1, &prefetch), ORL_OK);
    assert_null(prefetch);
    orl_prefetch_show(prefetch, &s.photos);
    assert_null(s.photos.ahead);
    finish_stage(&s);
}

// So is a file that turns out to be broken.
static void broken_files_are_left_alone(void **state)
{
    (void)state;
    struct stage s;
    struct voxels voxels;
    struct orl_mesh mesh;
    struct orl_image image;
    setup_stage(&s);
    s.f.scene.frame = 1;
    char *photo = strdup(orl_scene_file(&s.f.scene, 3, ORL_FILE_PHOTO).text);
    char *mask = strdup(orl_scene_file(&s.f.scene, 2, ORL_FILE_MASK).text);
    uint64_t key = orl_voxels_key(&s.frame);
    s.f.scene.frame = 0;
    assert_int_equal(truncate(photo, 100), 0);
    assert_int_equal(truncate(mask, 50), 0);
    struct prefetch *prefetch = prepare(&s);
    orl_prefetch_show(prefetch, &s.photos);
    assert_int_equal(orl_photo_loader_take(s.photos.ahead, 3, true, &image), PHOTO_FAILED);
    assert_int_equal(orl_photo_loader_take(s.photos.ahead, 2, true, &image), PHOTO_READ);
    orl_image_finish(&image);
    assert_null(s.photos.masks_ahead[2].data);
    assert_false(orl_prefetch_take_hull(gpu, prefetch, key, &voxels, &mesh));
    orl_prefetch_destroy(gpu, &prefetch);
    free(photo);
    free(mask);
    finish_stage(&s);
}

// Nothing is read again that a frame has taken, or reads itself, until it is asked for again.
static void loader_reads_what_is_asked_for(void **state)
{
    (void)state;
    static const size_t first[] = {1, 3}, second[] = {3};
    struct stage s;
    struct photo_loader *loader;
    struct orl_image image;
    setup_stage(&s);
    assert_int_equal(orl_photo_loader_create(NULL, &s.f.scene, false, &loader), ORL_OK);
    assert_int_equal(orl_photo_loader_take(loader, 3, true, &image), PHOTO_AWAITED); // is the caller's
    assert_int_equal(orl_photo_loader_take(loader, 2, false, &image), PHOTO_AWAITED);
    for (int round = 0; round < 2; round++) {
        orl_photo_loader_want(loader, first, 2);
        orl_photo_loader_wait(loader);
        assert_int_equal(orl_photo_loader_take(loader, 1, false, &image), PHOTO_READ);
        assert_int_equal(image.width, W);
        orl_image_finish(&image);
        assert_int_equal(orl_photo_loader_take(loader, 1, round, &image), PHOTO_AWAITED);
    }
    orl_photo_loader_want(loader, second, 1); // it was read, and stays
    assert_int_equal(orl_photo_loader_take(loader, 3, false, &image), PHOTO_READ);
    orl_image_finish(&image);
    orl_photo_loader_destroy(&loader);
    finish_stage(&s);
}

int main(void)
{
    gpu = gpu_test_device();
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(pictures_are_the_same),
        cmocka_unit_test(files_are_read_once),
        cmocka_unit_test(another_hull_is_not_taken),
        cmocka_unit_test(missing_files_are_left_alone),
        cmocka_unit_test(broken_files_are_left_alone),
        cmocka_unit_test(loader_reads_what_is_asked_for),
    };
    int failed = cmocka_run_group_tests_name("prefetch", tests, NULL, NULL);
    orl_gpu_destroy(&gpu);
    return failed;
}
