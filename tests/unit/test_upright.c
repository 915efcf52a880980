// The EXIF orientation says which way is up, and moves no pixel.
#include <math.h>
#include <string.h>

#include "oriel/path.h"
#include "scene/upright.h"
#include "test.h"

static const struct orl_view stored = {
    {.width = 40, .height = 30, .fx = 50, .fy = 60, .cx = 18, .cy = 14},
    {.r = {{1, 0, 0}, {0, 1, 0}, {0, 0, 1}}, .t = {0.1, -0.2, 0.3}}};

static void project(const struct orl_view *view, const double p[3], double pixel[2])
{
    double c[3];
    for (int i = 0; i < 3; i++)
        c[i] = view->cam_from_world.r[i][0] * p[0] + view->cam_from_world.r[i][1] * p[1] +
               view->cam_from_world.r[i][2] * p[2] + view->cam_from_world.t[i];
    pixel[0] = view->camera.fx * c[0] / c[2] + view->camera.cx;
    pixel[1] = view->camera.fy * c[1] / c[2] + view->camera.cy;
}

// Where a picture of each orientation is shown: EXIF 2.3, 4.6.4, by where row 0 and column 0 are.
static void turns_views(void **state)
{
    (void)state;
    const double point[3] = {0.4, 0.1, 2};
    double was[2], is[2];
    project(&stored, point, was);
    const struct {
        int orientation, width, height;
        double x, y;   // of the shown pixel
        double up[3];  // world, as the stored picture's axes are
    } wanted[] = {
        {0, 40, 30, was[0], was[1], {0, -1, 0}},           {1, 40, 30, was[0], was[1], {0, -1, 0}},
        {3, 40, 30, 40 - was[0], 30 - was[1], {0, 1, 0}},  {6, 30, 40, 30 - was[1], was[0], {-1, 0, 0}},
        {8, 30, 40, was[1], 40 - was[0], {1, 0, 0}},
    };
    for (size_t i = 0; i < sizeof wanted / sizeof *wanted; i++) {
        struct orl_photo photo = {.view = stored, .orientation = wanted[i].orientation};
        struct orl_scene scene = {.photos = &photo, .photo_count = 1};
        struct orl_view view = orl_photo_upright(&photo);
        double up[3];
        assert_int_equal(view.camera.width, wanted[i].width);
        assert_int_equal(view.camera.height, wanted[i].height);
        project(&view, point, is);
        assert_float_equal(is[0], wanted[i].x, 1e-9);
        assert_float_equal(is[1], wanted[i].y, 1e-9);
        assert_true(orl_scene_mean_up(&scene, up));
        for (int k = 0; k < 3; k++)
            assert_float_equal(up[k], wanted[i].up[k], 1e-9);
    }
}

// Photographs around the origin, all on their side: the circle stays at their height, upright.
static void circles_around_what_lies_on_its_side(void **state)
{
    (void)state;
    enum { COUNT = 6 };
    struct orl_photo photos[COUNT];
    struct orl_scene scene = {.photos = photos, .photo_count = COUNT};
    memset(photos, 0, sizeof photos);
    for (int i = 0; i < COUNT; i++) {
        double angle = 0.3 * i, turn = i % 2 ? 1 : -1;
        const double eye[3] = {5 * cos(angle), 1, 5 * sin(angle)}, target[3] = {0, 1, 0};
        photos[i].orientation = i % 2 ? 6 : 8; // one upright way or the other
        photos[i].view.camera = stored.camera;
        // The world's y points upwards; stored, it points to the left or to the right.
        struct orl_pose upright = orl_pose_look_at(eye, target, (const double[3]){0, 1, 0});
        photos[i].view.cam_from_world = upright;
        for (int k = 0; k < 3; k++) {
            photos[i].view.cam_from_world.r[0][k] = turn * upright.r[1][k];
            photos[i].view.cam_from_world.r[1][k] = -turn * upright.r[0][k];
        }
        photos[i].view.cam_from_world.t[0] = turn * upright.t[1];
        photos[i].view.cam_from_world.t[1] = -turn * upright.t[0];
    }
    struct orl_path path;
    assert_int_equal(orl_path_around(NULL, &scene, 8, &path), ORL_OK);
    for (size_t i = 0; i < path.count; i++) {
        double eye[3];
        orl_pose_centre(&path.views[i].cam_from_world, eye);
        assert_float_equal(eye[1], 1, 1e-6);
        assert_float_equal(path.views[i].cam_from_world.r[1][1], -1, 1e-6);
        assert_int_equal(path.views[i].camera.width, stored.camera.height);
    }
    orl_path_finish(&path);
    assert_int_equal(orl_path_through_photos(NULL, &scene, 5, &path), ORL_OK);
    for (size_t i = 0; i < path.count; i++)
        assert_float_equal(path.views[i].cam_from_world.r[1][1], -1, 1e-6);
    orl_path_finish(&path);
}

// Where the room is not known, a photograph that is held out has no part in the shell that stands for it.
static void a_shell_is_as_large_as_the_photographs_want(void **state)
{
    (void)state;
    struct orl_photo photos[3];
    struct orl_scene scene = {.photos = photos, .photo_count = 3};
    const double low[3] = {0, -1, -1}, high[3] = {2, 1, 1}, at[3] = {-3, 3, 100};
    double middle[3], half[3];
    memset(photos, 0, sizeof photos);
    for (int i = 0; i < 3; i++) {
        photos[i].view = stored;
        orl_pose_set_centre(&photos[i].view.cam_from_world, (const double[3]){at[i], 0, 0});
        photos[i].test = i == 2;
    }
    orl_room_measure(&scene, low, high, middle, half);
    for (int k = 0; k < 3; k++) {
        assert_float_equal(middle[k], k == 0, 1e-9);
        assert_float_equal(half[k], 8, 1e-9); // the first is 4 away
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {cmocka_unit_test(turns_views),
                                       cmocka_unit_test(circles_around_what_lies_on_its_side),
                                       cmocka_unit_test(a_shell_is_as_large_as_the_photographs_want)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}
