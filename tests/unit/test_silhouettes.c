// Silhouettes are found where the photographs have them, and only where a hull is near the subject.
#include <math.h>
#include <stdio.h>

#include "io/picture.h"
#include "preprocess/cloud/silhouettes.h"
#include "test.h"

enum { SIDE = 64, PHOTOS = 8 };
static const double AWAY = 5, TAU = 6.283185307179586;

struct fixture {
    char *dir;
    struct orl_colmap_camera camera;
    struct orl_colmap_image images[PHOTOS];
    char names[PHOTOS][16];
    struct orl_colmap_model model;
    struct orl_names train;
    struct orl_points points;
    struct orl_prepare_params params;
    struct orl_job job;
};

// A picture with a square of `subject` before `ground`.
static void write_square(const struct fixture *f, const char *folder, const char *name, int channels,
                         uint8_t subject, uint8_t ground)
{
    struct orl_image picture;
    char path[8192];
    snprintf(path, sizeof path, "%s/%s/%s", f->dir, folder, name);
    assert_int_equal(orl_image_init(NULL, &picture, SIDE, SIDE, channels, ORL_PIXEL_U8), ORL_OK);
    for (int i = 0; i < SIDE * SIDE * channels; i++) {
        int x = i / channels % SIDE, y = i / channels / SIDE;
        picture.u8[i] = x >= 20 && x < 44 && y >= 20 && y < 44 ? subject : ground;
    }
    assert_int_equal(orl_png_write(NULL, path, &picture), ORL_OK);
    orl_image_finish(&picture);
}

static void write_all(const struct fixture *f, uint8_t ground)
{
    for (int i = 0; i < PHOTOS; i++)
        write_square(f, "images", f->names[i], 3, 180, ground);
}

// Photographs on an arc of so many radians around a point at the origin.
static void place(struct fixture *f, double arc)
{
    for (int i = 0; i < PHOTOS; i++) {
        double turn = arc * i / PHOTOS;
        f->images[i].cam_from_world = orl_pose_look_at(
            (double[3]){AWAY * cos(turn), AWAY * sin(turn), 0}, (double[3]){0}, (double[3]){0, 0, 1});
    }
}

static int set_up(void **state)
{
    struct fixture *f = calloc(1, sizeof *f);
    assert_non_null(f);
    f->dir = test_dir_make();
    f->camera = (struct orl_colmap_camera){.id = 1, .model = 1, .pinhole = {
        SIDE, SIDE, 100, 100, 0.5 * SIDE, 0.5 * SIDE}};
    for (int i = 0; i < PHOTOS; i++) {
        snprintf(f->names[i], sizeof f->names[i], "%d.png", i);
        f->images[i] = (struct orl_colmap_image){.id = (uint32_t)i + 1, .camera_id = 1,
                                                 .name = f->names[i]};
        assert_int_equal(orl_names_add(NULL, &f->train, f->names[i]), ORL_OK);
    }
    f->model = (struct orl_colmap_model){.cameras = &f->camera, .camera_count = 1,
                                         .images = f->images, .image_count = PHOTOS};
    assert_int_equal(orl_points_init(NULL, &f->points, 1), ORL_OK);
    f->job = (struct orl_job){.dir = f->dir, .lock_fd = -1, .params = &f->params};
    for (int i = 0; i < 2; i++) {
        char *path = test_path(f->dir, i ? "masks" : "images");
        assert_int_equal(orl_dir_make(NULL, path), ORL_OK);
        free(path);
    }
    place(f, TAU);
    *state = f;
    return 0;
}

static int tear_down(void **state)
{
    struct fixture *f = *state;
    orl_names_finish(&f->train);
    orl_points_finish(&f->points);
    test_dir_remove(f->dir);
    free(f);
    return 0;
}

// How many silhouettes are found. They must hold the square.
static size_t count_found(struct fixture *f)
{
    struct orl_silhouettes found;
    assert_int_equal(orl_silhouettes_find(&f->job, &f->model, &f->train, &f->points, &found), ORL_OK);
    size_t count = found.count;
    for (size_t i = 0; i < count; i++) {
        const uint8_t *mask = found.items[i].mask.u8;
        assert_true(mask[32 * SIDE + 32] && !mask[32 * SIDE + 10] && !mask[5 * SIDE + 32]);
        assert_string_equal(found.image[i]->name, f->names[i]);
    }
    orl_silhouettes_finish(&found);
    return count;
}

static void a_dark_backdrop_shows_them(void **state)
{
    write_all(*state, 12);
    assert_int_equal(count_found(*state), PHOTOS);
}

static void other_backdrops_do_not(void **state)
{
    struct fixture *f = *state;
    write_all(f, 230); // brighter than the subject
    assert_int_equal(count_found(f), 0);
    write_all(f, 150); // no darker than a shaded wall
    assert_int_equal(count_found(f), 0);
}

static void photographs_from_one_side_have_no_near_hull(void **state)
{
    struct fixture *f = *state;
    write_all(f, 12);
    place(f, TAU / 6);
    assert_int_equal(count_found(f), 0);
}

static void masks_are_silhouettes_if_each_photograph_has_one(void **state)
{
    struct fixture *f = *state;
    char name[32];
    write_all(f, 230);
    f->params.masks_dir = "masks";
    for (int i = 0; i < PHOTOS; i++) {
        assert_int_equal(count_found(f), 0);
        snprintf(name, sizeof name, "%s.png", f->names[i]);
        write_square(f, "masks", name, 1, 255, 0);
    }
    assert_int_equal(count_found(f), PHOTOS);
}

static void masks_that_leave_the_room_in_are_no_silhouettes(void **state)
{
    struct fixture *f = *state;
    char name[32];
    write_all(f, 230);
    f->params.masks_dir = "masks";
    for (int i = 0; i < PHOTOS; i++) {
        snprintf(name, sizeof name, "%s.png", f->names[i]);
        write_square(f, "masks", name, 1, 0, 255);
    }
    assert_int_equal(count_found(f), 0);
}

// A strip along one side, which is a third of the border, is no subject that photographs go around.
static void masks_that_leave_the_picture_are_no_silhouettes(void **state)
{
    struct fixture *f = *state;
    struct orl_image mask;
    char path[8192];
    write_all(f, 230);
    f->params.masks_dir = "masks";
    assert_int_equal(orl_image_init(NULL, &mask, SIDE, SIDE, 1, ORL_PIXEL_U8), ORL_OK);
    for (int i = 0; i < SIDE * SIDE; i++)
        mask.u8[i] = i % SIDE < SIDE / 4 || (i % SIDE < 44 && i / SIDE > 20 && i / SIDE < 44) ? 255 : 0;
    for (int i = 0; i < PHOTOS; i++) {
        snprintf(path, sizeof path, "%s/masks/%s.png", f->dir, f->names[i]);
        assert_int_equal(orl_png_write(NULL, path, &mask), ORL_OK);
    }
    struct orl_silhouettes found;
    assert_int_equal(orl_silhouettes_find(&f->job, &f->model, &f->train, &f->points, &found), ORL_OK);
    assert_int_equal(found.count, 0);
    orl_silhouettes_finish(&found);
    orl_image_finish(&mask);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test_setup_teardown(a_dark_backdrop_shows_them, set_up, tear_down),
        cmocka_unit_test_setup_teardown(other_backdrops_do_not, set_up, tear_down),
        cmocka_unit_test_setup_teardown(photographs_from_one_side_have_no_near_hull, set_up,
                                        tear_down),
        cmocka_unit_test_setup_teardown(masks_that_leave_the_room_in_are_no_silhouettes, set_up,
                                        tear_down),
        cmocka_unit_test_setup_teardown(masks_that_leave_the_picture_are_no_silhouettes, set_up,
                                        tear_down),
        cmocka_unit_test_setup_teardown(masks_are_silhouettes_if_each_photograph_has_one, set_up,
                                        tear_down),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
