// SCENE/walk.json: what is allowed in it, and what comes back.
#include "test.h"

#include <math.h>
#include <stdio.h>

#include "walk/settings.h"

static enum orl_result check(const char *text)
{
    json_t *settings = json_loads(text, 0, NULL);
    assert_non_null(settings);
    enum orl_result result = orl_walk_settings_check(NULL, "test", settings);
    json_decref(settings);
    return result;
}

#define POSE "\"cam_from_world\": [[1,0,0,1],[0,1,0,2],[0,0,1,3]]"

static void test_what_is_allowed(void **state)
{
    (void)state;
    assert_int_equal(check("{}"), ORL_OK);
    assert_int_equal(check("{\"title\": \"T\", \"attribution\": \"\", \"modes\": [\"walk\"]}"), ORL_OK);
    assert_int_equal(check("{\"start\": {" POSE ", \"fov_y_deg\": 60}}"), ORL_OK);
    assert_int_equal(check("{\"notes\": [{\"title\": \"a\", \"text\": \"b\", \"position\": [1,2,3],"
                           "\"view\": {" POSE ", \"fov_y_deg\": 60}}]}"), ORL_OK);
}

static void test_what_is_refused(void **state)
{
    (void)state;
    static const char *const wrong[] = {
        "[]", "{\"other\": 1}", "{\"title\": 1}", "{\"modes\": []}", "{\"modes\": [\"swim\"]}",
        "{\"modes\": \"walk\"}", "{\"start\": {}}", "{\"start\": {" POSE "}}",
        "{\"start\": {" POSE ", \"fov_y_deg\": 180}}",
        "{\"start\": {\"cam_from_world\": [[2,0,0,1],[0,1,0,2],[0,0,1,3]], \"fov_y_deg\": 60}}",
        "{\"notes\": {}}", "{\"notes\": [{\"title\": \"a\"}]}",
        "{\"notes\": [{\"title\": \"a\", \"position\": [1,2]}]}",
        "{\"notes\": [{\"position\": [1,2,3]}]}",
        "{\"notes\": [{\"title\": \"a\", \"position\": [1,2,3], \"view\": {}}]}",
    };
    for (size_t i = 0; i < sizeof wrong / sizeof *wrong; i++)
        assert_int_equal(check(wrong[i]), ORL_ERR_FORMAT);
}

static void test_round_trip(void **state)
{
    (void)state;
    char *dir = test_dir_make();
    struct orl_scene scene = {.dir = dir};
    json_t *settings, *read;
    assert_int_equal(orl_walk_settings_read(NULL, &scene, &settings), ORL_OK);
    assert_int_equal(json_object_size(settings), 0); // a scene without
    json_decref(settings);
    settings = json_loads("{\"title\": \"T\", \"start\": {" POSE ", \"fov_y_deg\": 90}}", 0, NULL);
    assert_int_equal(orl_walk_settings_write(NULL, &scene, settings), ORL_OK);
    assert_int_equal(orl_walk_settings_read(NULL, &scene, &read), ORL_OK);
    assert_true(json_equal(settings, read));
    const struct orl_camera camera = {.width = 40, .height = 20, .fx = 1, .fy = 1, .cx = 19, .cy = 9};
    struct orl_view view;
    assert_true(orl_walk_settings_start(read, &camera, &view));
    assert_float_equal(view.camera.fy, 10, 1e-9); // half the height at 90 degrees
    assert_float_equal(view.camera.cx, 19, 0);
    assert_float_equal(view.cam_from_world.t[2], 3, 0);
    json_decref(settings);
    json_decref(read);
    test_dir_remove(dir);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_what_is_allowed),
        cmocka_unit_test(test_what_is_refused),
        cmocka_unit_test(test_round_trip),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
