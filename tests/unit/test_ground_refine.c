// Ground shifted and tilted back to where photographs agree on the tiles that it is laid with.
#include <math.h>
#include <string.h>

#include "core/file.h"
#include "core/memory.h"
#include "io/picture.h"
#include "preprocess/cloud/ground.h"
#include "scene/colmap.h"
#include "test.h"

enum { PHOTOS = 5, WIDTH = 192, HEIGHT = 128 };

struct yard {
    char *dir;
    struct orl_scene scene;
    struct orl_photo photos[PHOTOS];
    char names[PHOTOS][16];
};

// Light of the ground, y = 1.6, at x and z: tiles of many sizes.
static double tiles(double x, double z)
{
    return 120 + 50 * sin(2.1 * x + 0.7 * z) * cos(1.3 * z - 0.4 * x) +
           40 * sin(0.9 * x - 1.7 * z);
}

static void photograph(const struct yard *yard, int i)
{
    const struct orl_view *view = &yard->photos[i].view;
    struct orl_image image;
    double eye[3];
    orl_pose_centre(&view->cam_from_world, eye);
    assert_int_equal(orl_image_init(NULL, &image, WIDTH, HEIGHT, 3, ORL_PIXEL_U8), ORL_OK);
    for (int y = 0; y < HEIGHT; y++)
        for (int x = 0; x < WIDTH; x++) {
            double at[3];
            orl_view_unproject(view, x + 0.5, y + 0.5, 1, at);
            double fall = at[1] - eye[1], along = (1.6 - eye[1]) / fall;
            bool sky = !(fall > 0.02);
            // Each at another exposure.
            double light = sky ? 230 : (1 - 0.06 * i) * tiles(eye[0] + along * (at[0] - eye[0]),
                                                             eye[2] + along * (at[2] - eye[2]));
            memset(&image.u8[3 * (y * WIDTH + x)], (int)light, 3);
        }
    char *path = orl_scene_photo_path(NULL, &yard->scene, (size_t)i);
    assert_int_equal(orl_png_write(NULL, path, &image), ORL_OK);
    orl_image_finish(&image);
    free(path);
}

enum shown { NOTHING, WALL, GROUND };

// 12 % too low and tilted by 0.9 degrees, about a point of it under the photographs.
static struct orl_ground off(void)
{
    return (struct orl_ground){.known = true, .height = 1.78,
                               .plane = {0.016, -sqrt(1 - 0.016 * 0.016), 0, 1.79}};
}

// How deep the pixel sees the plane of off(); 0: it does not.
static float depth_of_ground(const struct orl_view *view, int x, int y)
{
    const struct orl_ground ground = off();
    double eye[3], at[3], from = ground.plane[3], fall = 0;
    orl_pose_centre(&view->cam_from_world, eye);
    orl_view_unproject(view, x + 0.5, y + 0.5, 1, at);
    for (int k = 0; k < 3; k++) {
        from += ground.plane[k] * eye[k];
        fall -= ground.plane[k] * (at[k] - eye[k]);
    }
    return fall > 0.02 ? (float)(from / fall) : 0;
}

// Writes what stereo found: nothing, a wall before everything, or all of the plane of off().
static void write_depth(const struct yard *yard, int i, enum shown shown)
{
    const struct orl_view *view = &yard->photos[i].view;
    struct orl_image depth;
    assert_int_equal(orl_image_init(NULL, &depth, WIDTH, HEIGHT, 1, ORL_PIXEL_F32), ORL_OK);
    for (int y = 0; y < HEIGHT; y++)
        for (int x = 0; x < WIDTH; x++)
            depth.f32[y * WIDTH + x] = shown == WALL ? 1 :
                                       shown == GROUND ? depth_of_ground(view, x, y) : 0;
    char *path = orl_format(NULL, "%s/stereo/depth_maps/%s.geometric.bin", yard->dir,
                            yard->names[i]);
    assert_int_equal(orl_colmap_map_write(NULL, path, &depth), ORL_OK);
    orl_image_finish(&depth);
    free(path);
}

static void build(struct yard *yard)
{
    static const char *const folders[] = {"images", "stereo", "stereo/depth_maps"};
    memset(yard, 0, sizeof *yard);
    yard->dir = test_dir_make();
    yard->scene = (struct orl_scene){.dir = yard->dir, .photos = yard->photos,
                                     .photo_count = PHOTOS};
    for (size_t k = 0; k < ORL_COUNT(folders); k++) {
        char *folder = orl_path_join(NULL, yard->dir, folders[k]);
        assert_int_equal(orl_dir_make(NULL, folder), ORL_OK);
        free(folder);
    }
    for (int i = 0; i < PHOTOS; i++) {
        const double eye[3] = {1.2 * i - 2.4, 0.03 * (i % 2), 0.4 * (i % 3)};
        const double target[3] = {0.4 * i - 0.8, 1.2, 8}, up[3] = {0, -1, 0};
        snprintf(yard->names[i], sizeof yard->names[i], "%d.png", i);
        yard->photos[i] = (struct orl_photo){.name = yard->names[i], .response = -1};
        yard->photos[i].view = (struct orl_view){
            .camera = {.width = WIDTH, .height = HEIGHT, .fx = 150, .fy = 150, .cx = WIDTH / 2.0,
                       .cy = HEIGHT / 2.0},
            .cam_from_world = orl_pose_look_at(eye, target, up)};
    }
}

static void tear_down(struct yard *yard)
{
    test_dir_remove(yard->dir);
}

static double height_at(const struct orl_ground *ground, double x, double z)
{
    return -(ground->plane[0] * x + ground->plane[2] * z + ground->plane[3]) / ground->plane[1];
}

static void finds_where_photographs_agree(void **state)
{
    (void)state;
    struct yard yard;
    build(&yard);
    yard.photos[2].test = true; // reading it would be an error: it is not there
    for (int i = 0; i < PHOTOS; i++) {
        write_depth(&yard, i, NOTHING);
        if (!yard.photos[i].test)
            photograph(&yard, i);
    }
    struct orl_ground was = yard.scene.ground = off();
    assert_int_equal(orl_ground_refine(NULL, &yard.scene), ORL_OK);
    const struct orl_ground *ground = &yard.scene.ground;
    assert_float_equal(height_at(&was, 0, 5), 1.79, 0.01);
    assert_float_equal(height_at(&was, 3, 5), 1.84, 0.01);
    assert_float_equal(height_at(ground, 0, 5), 1.6, 0.04);
    assert_float_equal(height_at(ground, 3, 5), 1.6, 0.04);
    assert_float_equal(height_at(ground, -3, 8), 1.6, 0.06);
    assert_float_equal(ground->height, 1.6, 0.05);
    assert_true(ground->known);
    tear_down(&yard);
}

static void leaves_what_it_cannot_tell(void **state)
{
    (void)state;
    struct yard yard;
    build(&yard);
    for (int i = 0; i < PHOTOS; i++)
        photograph(&yard, i);
    struct orl_ground was = yard.scene.ground = off(); // without depth maps
    assert_int_equal(orl_ground_refine(NULL, &yard.scene), ORL_OK);
    assert_float_equal(yard.scene.ground.height, was.height, 0);
    for (int k = 0; k < 4; k++)
        assert_float_equal(yard.scene.ground.plane[k], was.plane[k], 0);
    yard.scene.ground = (struct orl_ground){.known = true};
    assert_int_equal(orl_ground_refine(NULL, &yard.scene), ORL_OK);
    assert_float_equal(yard.scene.ground.height, 0, 0);
    // A photograph that is gone is an error, and says so.
    for (int i = 0; i < PHOTOS; i++)
        write_depth(&yard, i, NOTHING);
    char *path = orl_scene_photo_path(NULL, &yard.scene, 3);
    assert_int_equal(remove(path), 0);
    free(path);
    yard.scene.ground = was;
    assert_int_not_equal(orl_ground_refine(NULL, &yard.scene), ORL_OK);
    tear_down(&yard);
}

// Photographs of a wall in front of everything: a plane under it is none that they show.
static void takes_no_plane_that_nobody_sees(void **state)
{
    (void)state;
    struct yard yard;
    build(&yard);
    for (int i = 0; i < PHOTOS; i++) {
        photograph(&yard, i);
        write_depth(&yard, i, WALL);
    }
    yard.scene.ground = off();
    assert_int_equal(orl_ground_refine(NULL, &yard.scene), ORL_OK);
    assert_float_equal(yard.scene.ground.height, 0, 0);
    tear_down(&yard);
}

// Stereo has found all of the ground: nothing is left to compare, and the plane stays as it is.
static void keeps_a_plane_that_stereo_has_found(void **state)
{
    (void)state;
    struct yard yard;
    build(&yard);
    struct orl_ground was = yard.scene.ground = off();
    for (int i = 0; i < PHOTOS; i++) {
        photograph(&yard, i);
        write_depth(&yard, i, GROUND);
    }
    assert_int_equal(orl_ground_refine(NULL, &yard.scene), ORL_OK);
    assert_float_equal(yard.scene.ground.height, was.height, 0);
    tear_down(&yard);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(finds_where_photographs_agree),
        cmocka_unit_test(leaves_what_it_cannot_tell),
        cmocka_unit_test(takes_no_plane_that_nobody_sees),
        cmocka_unit_test(keeps_a_plane_that_stereo_has_found),
    };
    return cmocka_run_group_tests_name("ground refine", tests, NULL, NULL);
}
