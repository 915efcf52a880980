// Views: from the world into the picture and back, and between one another.
#include <math.h>

#include "oriel/camera.h"
#include "test.h"

static void test_unproject_known(void **state)
{
    (void)state;
    // At (1, 2, 3), looking along x, the picture's y down: z of the camera is x of the world.
    const double eye[3] = {1, 2, 3}, target[3] = {2, 2, 3}, up[3] = {0, -1, 0};
    struct orl_view view = {.camera = {.width = 40, .height = 30, .fx = 20, .fy = 10, .cx = 20,
                                       .cy = 15}};
    double world[3];
    view.cam_from_world = orl_pose_look_at(eye, target, up);
    orl_view_unproject(&view, 20, 15, 4, world);
    assert_float_equal(world[0], 5, 1e-12);
    assert_float_equal(world[1], 2, 1e-12);
    assert_float_equal(world[2], 3, 1e-12);
    orl_view_unproject(&view, 20, 20, 4, world); // 5 px down at depth 4: 2 along the world's y
    assert_float_equal(world[0], 5, 1e-12);
    assert_float_equal(world[1], 4, 1e-12);
    assert_float_equal(world[2], 3, 1e-12);
}

static void test_unproject_is_the_inverse(void **state)
{
    (void)state;
    const double eye[3] = {1, -2, 3}, target[3] = {0.2, 0.1, -0.5}, up[3] = {0, -1, 0.2};
    struct orl_view view = {.camera = {.width = 640, .height = 480, .fx = 500, .fy = 510,
                                       .cx = 321, .cy = 239}};
    view.cam_from_world = orl_pose_look_at(eye, target, up);
    for (int i = 0; i < 20; i++) {
        double u = 33.25 * i, v = 470 - 21.5 * i, z = 0.3 + i, world[3], pixel[2], depth;
        orl_view_unproject(&view, u, v, z, world);
        assert_true(orl_view_project(&view, world, pixel, &depth));
        assert_float_equal(pixel[0], u, 1e-9);
        assert_float_equal(pixel[1], v, 1e-9);
        assert_float_equal(depth, z, 1e-9);
    }
}

static struct orl_view turned(double degrees)
{
    const double half = degrees * 3.14159265358979323846 / 360, zero[3] = {0, 0, 0};
    const double about_y[4] = {3 * cos(half), 0, 3 * sin(half), 0}; // of any length
    struct orl_view view = {.camera = {100, 50, 80, 80, 50, 25}};
    assert_true(orl_pose_from_quat(about_y, zero, &view.cam_from_world));
    return view;
}

static void assert_turned(const struct orl_view *view, double degrees)
{
    double angle = degrees * 3.14159265358979323846 / 180;
    assert_float_equal(view->cam_from_world.r[0][0], cos(angle), 1e-9);
    assert_float_equal(view->cam_from_world.r[0][2], sin(angle), 1e-9);
    assert_float_equal(view->cam_from_world.r[1][1], 1, 1e-9);
}

// A quarter turn about z: x becomes y.
static void test_quaternions_turn_to_the_right_side(void **state)
{
    (void)state;
    const double quat[4] = {1, 0, 0, 1}, t[3] = {0, 0, 0}, x[3] = {1, 0, 0};
    struct orl_pose pose;
    double out[3], back[4];
    assert_true(orl_pose_from_quat(quat, t, &pose));
    orl_pose_apply(&pose, x, out);
    assert_float_equal(out[0], 0, 1e-12);
    assert_float_equal(out[1], 1, 1e-12);
    orl_pose_to_quat(&pose, back);
    assert_float_equal(back[0], sqrt(0.5), 1e-12);
    assert_float_equal(back[3], sqrt(0.5), 1e-12);
}

// At constant speed and the short way round.
static void test_rotations_between(void **state)
{
    (void)state;
    struct orl_view a = turned(0), b = turned(120), c = turned(170), d = turned(-150);
    struct orl_view view = orl_view_interpolate(&a, &b, 0.25);
    assert_turned(&view, 30);
    view = orl_view_interpolate(&c, &d, 0.5);
    assert_turned(&view, 190);
}

// Of a camera of another size and focal length, whose principal point is not in the middle.
static void test_cameras_between(void **state)
{
    (void)state;
    struct orl_view a = turned(0), b = turned(0);
    b.camera = (struct orl_camera){200, 100, 640, 640, 120, 40};
    struct orl_camera small = orl_camera_resized(&b.camera, 100, 50);
    assert_float_equal(small.fx, 320, 1e-9);
    assert_float_equal(small.cx, 60, 1e-9);
    assert_float_equal(small.cy, 20, 1e-9);
    struct orl_view view = orl_view_interpolate(&a, &b, 0.5);
    assert_float_equal(view.camera.fx, 160, 1e-9); // focal lengths by their ratio
    assert_float_equal(view.camera.cx, 55, 1e-9);
    assert_float_equal(view.camera.cy, 22.5, 1e-9);
}

// Another origin: what was at x is at x - origin, and is seen where it was.
static void test_another_origin(void **state)
{
    (void)state;
    const double origin[3] = {10, 20, 30}, x[3] = {11, 22, 34}, moved[3] = {1, 2, 4};
    const double eye[3] = {1, -2, 3}, target[3] = {0.2, 0.1, -0.5}, up[3] = {0, -1, 0.2};
    struct orl_pose pose = orl_pose_look_at(eye, target, up);
    double before[3], after[3];
    orl_pose_apply(&pose, x, before);
    orl_pose_move(&pose, origin);
    orl_pose_apply(&pose, moved, after);
    for (int k = 0; k < 3; k++)
        assert_float_equal(after[k], before[k], 1e-9);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_unproject_known),
        cmocka_unit_test(test_unproject_is_the_inverse),
        cmocka_unit_test(test_quaternions_turn_to_the_right_side),
        cmocka_unit_test(test_rotations_between),
        cmocka_unit_test(test_cameras_between),
        cmocka_unit_test(test_another_origin),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
