// What the densifier plans for a photograph from the sparse points that it sees.
#include <stdlib.h>

#include "io/picture.h"
#include "preprocess/densify/densify_internal.h"
#include "test.h"

enum { CAMERAS = 3, POINTS = 6000, WALL = 10, VEHICLE = 4 };

// Cameras at x = 0, 1 and 2 look along z. All see a wall ten away. One of `every` points is on a vehicle
// before it.
static void make_row(int every, struct orl_colmap_model *model)
{
    *model = (struct orl_colmap_model){
        .cameras = calloc(1, sizeof *model->cameras), .camera_count = 1,
        .images = calloc(CAMERAS, sizeof *model->images), .image_count = CAMERAS,
        .points = calloc(POINTS, sizeof *model->points), .point_count = POINTS};
    model->cameras[0].id = 1;
    model->cameras[0].pinhole = (struct orl_camera){100, 80, 90, 90, 50, 40};
    for (int i = 0; i < CAMERAS; i++) {
        struct orl_colmap_image *image = &model->images[i];
        image->camera_id = 1;
        image->name = strdup((const char *[]){"a", "b", "c"}[i]);
        image->points = calloc(POINTS, sizeof *image->points);
        for (int k = 0; k < 3; k++)
            image->cam_from_world.r[k][k] = 1;
        image->cam_from_world.t[0] = -i;
        while (image->point_count < POINTS) {
            image->points[image->point_count] = (uint32_t)image->point_count;
            image->point_count++;
        }
    }
    for (int p = 0; p < POINTS; p++) {
        model->points[p].position[0] = p % 20 * 0.1;
        model->points[p].position[1] = p % 7 * 0.1;
        model->points[p].position[2] = p % every ? WALL : VEHICLE;
    }
}

// Checks where the ranges begin.
static void check_ranges(int every, double nearest)
{
    struct orl_colmap_model model;
    struct densify_photos photos;
    struct densify_plan *plans;
    make_row(every, &model);
    assert_int_equal(orl_densify_photos_init(NULL, &model, NULL, &photos), ORL_OK);
    assert_int_equal(orl_densify_plans_make(NULL, &photos, 8, &plans), ORL_OK);
    for (int i = 0; i < CAMERAS; i++) {
        assert_int_equal(plans[i].count, CAMERAS - 1);
        assert_float_equal(plans[i].w_min, 1.0 / (50 * WALL), 1e-9);
        assert_float_equal(plans[i].w_max, 1.0 / (0.6 * nearest), 1e-9);
        assert_float_equal(plans[i].w_typical, 0.5 * (plans[i].w_min + 1.0 / WALL), 1e-9);
    }
    free(plans);
    orl_densify_photos_finish(&photos);
    orl_colmap_finish(&model);
}

// 30 of 6000 points are too few for a hundredth of them, and stereo must find the vehicle all the same.
static void test_range_reaches_what_few_points_are_on(void **state)
{
    (void)state;
    check_ranges(200, VEHICLE);
}

static void test_outliers_do_not_widen_the_range(void **state)
{
    (void)state;
    check_ranges(1000, WALL);
}

// Sides that are no multiples of four: the quarter shows what the whole photograph shows, to its borders.
static void test_halved_photographs_are_whole(void **state)
{
    (void)state;
    enum { WIDTH = 103, HEIGHT = 81, SHRINK = 2 };
    struct orl_colmap_model model;
    struct densify_photos photos;
    struct orl_image picture;
    const struct densify_pyramid *pyramid;
    char *dir = test_dir_make(), *path = test_path(dir, "a");
    make_row(200, &model);
    model.cameras[0].pinhole = (struct orl_camera){WIDTH, HEIGHT, 90, 90, 50, 40};
    assert_int_equal(orl_densify_photos_init(NULL, &model, NULL, &photos), ORL_OK);
    assert_int_equal(orl_image_init(NULL, &picture, WIDTH, HEIGHT, 3, ORL_PIXEL_U8), ORL_OK);
    for (int i = 0; i < 3 * WIDTH * HEIGHT; i++)
        picture.u8[i] = (uint8_t)(2 * (i / 3 % WIDTH));
    assert_int_equal(orl_png_write(NULL, path, &picture), ORL_OK);
    struct densify_cache cache = {.photos = &photos, .images_dir = dir, .shrink = SHRINK};
    assert_int_equal(orl_densify_cache_get(&cache, 0, &pyramid), ORL_OK);
    const struct orl_image *small = &pyramid->levels[SHRINK];
    assert_int_equal(small->width, WIDTH >> SHRINK);
    assert_int_equal(small->height, HEIGHT >> SHRINK);
    const struct orl_camera camera = orl_densify_level_camera(&pyramid->camera, SHRINK);
    const struct orl_camera whole = orl_camera_resized(&model.cameras[0].pinhole, small->width, small->height);
    assert_float_equal(camera.fx, whole.fx, 1e-4);
    assert_float_equal(camera.fy, whole.fy, 1e-4);
    assert_float_equal(camera.cx, whole.cx, 1e-4);
    assert_float_equal(camera.cy, whole.cy, 1e-4);
    for (int x = 0; x < small->width; x++) { // what the photograph has at the middle of the pixel
        double there = 2 * ((x + 0.5) * WIDTH / small->width - 0.5);
        assert_float_equal(small->u8[x], there, 2);
    }
    orl_densify_cache_finish(&cache);
    orl_image_finish(&picture);
    orl_densify_photos_finish(&photos);
    orl_colmap_finish(&model);
    free(path);
    test_dir_remove(dir);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_range_reaches_what_few_points_are_on),
        cmocka_unit_test(test_outliers_do_not_widen_the_range),
        cmocka_unit_test(test_halved_photographs_are_whole),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
