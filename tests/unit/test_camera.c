// Views: from the world into the picture and back.
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

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_unproject_known),
        cmocka_unit_test(test_unproject_is_the_inverse),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
