// SCENE/walk.json: what is allowed in it, and what comes back.
#include "test.h"

#include <math.h>
#include <stdio.h>
#include <unistd.h>

#include "core/file.h"
#include "walk/settings.h"

static enum orl_result check(const char *text)
{
    json_t *settings = json_loads(text, 0, NULL);
    assert_non_null(settings);
    enum orl_result result = orl_walk_settings_check(NULL, "test", settings);
    json_decref(settings);
    return result;
}

#define FRAME(frame) "{\"start\": {" POSE ", \"fov_y_deg\": 90, \"frame\": " frame "}}"
#define KEY(seconds) "{" POSE ", \"fov_y_deg\": 60, \"seconds\": " seconds "}"
#define POSE "\"cam_from_world\": [[1,0,0,1],[0,1,0,2],[0,0,1,3]]"

static void test_what_is_allowed(void **state)
{
    (void)state;
    assert_int_equal(check("{}"), ORL_OK);
    assert_int_equal(check("{\"title\": \"T\", \"attribution\": \"\", \"modes\": [\"walk\"]}"), ORL_OK);
    assert_int_equal(check("{\"start\": {" POSE ", \"fov_y_deg\": 60}}"), ORL_OK);
    assert_int_equal(check("{\"tour\": {\"frames\": 9, \"keyframes\": [" KEY("2") ", " KEY("3600") "]},"
                           "\"unit_m\": 0.5}"), ORL_OK);
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
        FRAME("1"), FRAME("{\"aspect\": 1.5, \"fx\": 1, \"x\": 0}"),
        FRAME("{\"aspect\": 1e9, \"fx\": 1, \"x\": 0, \"y\": 0}"),
        "{\"unit_m\": 0}", "{\"unit_m\": \"1\"}", "{\"tour\": []}", "{\"tour\": {\"keyframes\": [" KEY("1") "]}}",
        "{\"tour\": {\"keyframes\": [" KEY("1") ", " KEY("-1") "]}}",
        "{\"tour\": {\"keyframes\": [" KEY("1") ", {}]}}",
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
    assert_float_equal(view.camera.cx, 20, 0); // in the middle
    assert_float_equal(view.cam_from_world.t[2], 3, 0);
    json_decref(settings);
    json_decref(read);
    test_dir_remove(dir);
}

static void test_frame_of_a_view(void **state)
{
    (void)state;
    json_t *settings = json_loads(
        FRAME("{\"aspect\": 1.5, \"fx\": 0.75, \"x\": -0.25, \"y\": 0.1}"), 0, NULL);
    const struct orl_camera camera = {.width = 40, .height = 20, .fx = 1, .fy = 1, .cx = 19, .cy = 9};
    struct orl_view view;
    assert_int_equal(orl_walk_settings_check(NULL, "test", settings), ORL_OK);
    assert_true(orl_walk_settings_start(settings, &camera, &view));
    assert_int_equal(view.camera.width, 30);
    assert_float_equal(view.camera.fx, 15, 1e-9);
    assert_float_equal(view.camera.fy, 10, 1e-9);
    assert_float_equal(view.camera.cx, 10, 1e-9); // 15 - 0.25 * 20
    assert_float_equal(view.camera.cy, 12, 1e-9);
    json_decref(settings);
}

// A stranger's scene has no file of the user's read or written.
static void test_links_out_of_the_scene(void **state)
{
    (void)state;
    char *dir = test_dir_make(), *elsewhere = test_dir_make();
    struct orl_scene scene = {.dir = dir};
    json_t *settings = json_loads("{\"title\": \"T\"}", 0, NULL), *read = NULL;
    const char *out = ORL_PATH(elsewhere, "theirs.json"), *link = ORL_PATH(dir, "walk.json");
    assert_int_equal(symlink(out, link), 0);
    assert_int_equal(orl_walk_settings_write(NULL, &scene, settings), ORL_ERR_DATA); // it leads nowhere yet
    assert_false(orl_path_is_file(out));
    assert_int_equal(orl_file_write(NULL, out, "{}", 2), ORL_OK);
    assert_int_equal(orl_walk_settings_read(NULL, &scene, &read), ORL_ERR_DATA);
    assert_int_equal(unlink(link), 0);
    assert_int_equal(orl_file_write(NULL, ORL_PATH(dir, "own.json"), "{}", 2), ORL_OK);
    assert_int_equal(symlink("own.json", link), 0);
    assert_int_equal(orl_walk_settings_read(NULL, &scene, &read), ORL_OK);
    json_decref(read);
    json_decref(settings);
    test_dir_remove(elsewhere);
    test_dir_remove(dir);
}

// Limits of each number alone still allow views that no camera has.
static void test_frames_of_no_camera(void **state)
{
    (void)state;
    json_t *settings = json_loads(
        FRAME("{\"aspect\": 0.11, \"fx\": 1, \"x\": 1.9, \"y\": 0}"), 0, NULL);
    assert_int_equal(orl_walk_settings_check(NULL, "test", settings), ORL_ERR_FORMAT);
    json_decref(settings);
    // Nine times as wide as a high photograph is wider than a picture may be.
    settings = json_loads(FRAME("{\"aspect\": 9, \"fx\": 1, \"x\": 0, \"y\": 0}"), 0, NULL);
    const struct orl_camera high = {.width = 20, .height = 60000, .fx = 9, .fy = 9};
    struct orl_view view = {.camera = high};
    assert_int_equal(orl_walk_settings_check(NULL, "test", settings), ORL_OK);
    assert_false(orl_walk_settings_start(settings, &view.camera, &view));
    assert_memory_equal(&view.camera, &high, sizeof high);
    json_decref(settings);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_what_is_allowed),
        cmocka_unit_test(test_what_is_refused),
        cmocka_unit_test(test_round_trip),
        cmocka_unit_test(test_links_out_of_the_scene),
        cmocka_unit_test(test_frame_of_a_view),
        cmocka_unit_test(test_frames_of_no_camera),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
