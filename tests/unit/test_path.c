// Camera paths in every format, against poses found by hand.
#include <math.h>
#include <time.h>

#include "oriel/path.h"
#include "test.h"

static char *dir;
static struct orl_photo photos[2];
static struct orl_scene scene;

static int set_up(void **state)
{
    (void)state;
    static char first[] = "a.jpg", second[] = "b.jpg";
    dir = test_dir_make();
    const double up[3] = {0, -1, 0}, left[3] = {-1, 0, 0}, right[3] = {3, 0, 0};
    const double ahead_left[3] = {-1, 0, 5}, ahead_right[3] = {3, 0, 5};
    scene = (struct orl_scene){.dir = dir, .photos = photos, .photo_count = 2};
    photos[0].name = first;
    photos[1].name = second;
    photos[0].view.camera = (struct orl_camera){200, 100, 150, 150, 100, 50};
    photos[1].view.camera = (struct orl_camera){200, 100, 300, 300, 100, 50};
    photos[0].view.cam_from_world = orl_pose_look_at(left, ahead_left, up);
    photos[1].view.cam_from_world = orl_pose_look_at(right, ahead_right, up);
    return 0;
}

static int tear_down(void **state)
{
    (void)state;
    test_dir_remove(dir);
    return 0;
}

static enum orl_result read_text(const char *name, const char *text, struct orl_path *path)
{
    char *file = orl_path_join(NULL, dir, name);
    assert_int_equal(orl_file_write(NULL, file, text, strlen(text)), ORL_OK);
    enum orl_result result = orl_path_read(NULL, &scene, file, path);
    free(file);
    return result;
}

static void assert_centre(const struct orl_view *view, double x, double y, double z)
{
    double c[3];
    orl_pose_centre(&view->cam_from_world, c);
    assert_float_equal(c[0], x, 1e-9);
    assert_float_equal(c[1], y, 1e-9);
    assert_float_equal(c[2], z, 1e-9);
}

// Where a view sees a world point.
static void assert_sees(const struct orl_view *view, double x, double y, double z, double u,
                        double v)
{
    const double world[3] = {x, y, z};
    double pixel[2], depth;
    assert_true(orl_view_project(view, world, pixel, &depth));
    assert_float_equal(pixel[0], u, 1e-6);
    assert_float_equal(pixel[1], v, 1e-6);
}

static void keyframes_stand_where_they_say(void **state)
{
    (void)state;
    struct orl_path path;
    assert_int_equal(
        read_text("keys.json",
                  "{\"keyframes\": [{\"photo\": \"b\"},"
                  " {\"position\": [0,0,-4], \"target\": [0,0,0], \"fov_y_deg\": 90},"
                  " {\"cam_from_world\": [[1,0,0,7],[0,1,0,8],[0,0,1,9]]}]}", &path), ORL_OK);
    assert_int_equal(path.count, 3);
    assert_centre(&path.views[0], 3, 0, 0);
    assert_float_equal(path.views[0].camera.fx, 300, 0);
    assert_centre(&path.views[1], 0, 0, -4);
    assert_float_equal(path.views[1].camera.fy, 50, 1e-9); // 90 degrees over 100 pixels
    assert_sees(&path.views[1], 0, 4, 0, 100, 100);        // y down: the lower edge
    assert_centre(&path.views[2], -7, -8, -9);
    orl_path_finish(&path);
}

static void frames_move_smoothly_from_end_to_end(void **state)
{
    (void)state;
    struct orl_path path;
    assert_int_equal(read_text("walk.json", "{\"keyframes\": [{\"photo\": \"a\"},"
                                            " {\"photo\": \"b\"}], \"frames\": 5}", &path),
                     ORL_OK);
    assert_int_equal(path.count, 5);
    assert_centre(&path.views[0], -1, 0, 0);
    assert_centre(&path.views[2], 1, 0, 0);
    assert_centre(&path.views[4], 3, 0, 0);
    assert_float_equal(path.views[2].camera.fx, sqrt(150.0 * 300), 1e-9);
    orl_path_finish(&path);
    assert_int_equal(orl_path_through_photos(NULL, &scene, 3, &path), ORL_OK);
    assert_centre(&path.views[1], 1, 0, 0);
    orl_path_finish(&path);
}

// Two cameras a quarter of a circle apart look level at (2, -2, 5) from 3 away.
static void a_circle_leads_around_what_they_see(void **state)
{
    (void)state;
    const double up[3] = {0, -1, 0}, level[3] = {2, -2, 5};
    const double eyes[2][3] = {{2, -2, 2}, {5, -2, 5}};
    struct orl_photo ring[2] = {photos[0], photos[1]};
    struct orl_scene round = {.photos = ring, .photo_count = 2};
    struct orl_path path;
    for (int i = 0; i < 2; i++)
        ring[i].view.cam_from_world = orl_pose_look_at(eyes[i], level, up);
    assert_int_equal(orl_path_around(NULL, &round, 4, &path), ORL_OK);
    assert_int_equal(path.count, 4);
    assert_centre(&path.views[0], 2, -2, 2);
    for (size_t i = 0; i < 4; i++) {
        double c[3];
        orl_pose_centre(&path.views[i].cam_from_world, c);
        assert_float_equal(hypot(c[0] - 2, c[2] - 5), 3, 1e-9);
        assert_float_equal(c[1], -2, 1e-9);
        assert_sees(&path.views[i], 2, -2, 5, 100, 50);
    }
    assert_centre(&path.views[2], 2, -2, 8);
    orl_path_finish(&path);
    // From above, in the photographs' order.
    const double above[4][3] = {{2, -6, 2}, {5, -6, 5}, {2, -6, 8}, {-1, -6, 5}};
    struct orl_photo four[4] = {photos[0], photos[0], photos[0], photos[0]};
    for (int i = 0; i < 4; i++)
        four[i].view.cam_from_world = orl_pose_look_at(above[i], level, up);
    assert_int_equal(orl_path_around(NULL, &(struct orl_scene){.photos = four, .photo_count = 4}, 4, &path), ORL_OK);
    for (size_t i = 0; i < 4; i++)
        assert_centre(&path.views[i], above[i][0], above[i][1], above[i][2]);
    orl_path_finish(&path);
    // Parallel axes meet nowhere, and those of cameras that look away meet behind them.
    assert_int_equal(orl_path_around(NULL, &scene, 4, &path), ORL_ERR_DATA);
    for (int i = 0; i < 2; i++) {
        const double away[3] = {2 * eyes[i][0] - 2, eyes[i][1], 2 * eyes[i][2] - 5};
        ring[i].view.cam_from_world = orl_pose_look_at(eyes[i], away, up);
    }
    assert_int_equal(orl_path_around(NULL, &round, 4, &path), ORL_ERR_DATA);
    // They may meet beyond all bounds, though the cameras themselves are within.
    for (int i = 0; i < 2; i++) {
        const double eye[3] = {i ? 8e17 : -8e17, 0, 0}, ahead[3] = {0, 0, 4e18};
        ring[i].view.cam_from_world = orl_pose_look_at(eye, ahead, up);
        assert_null(orl_view_problem(&ring[i].view));
    }
    assert_int_equal(orl_path_around(NULL, &round, 4, &path), ORL_ERR_DATA);
    assert_null(path.views);
}

static void keyframes_have_their_own_seconds(void **state)
{
    (void)state;
    // From -1 to 3 in one second, then back in three: at an eighth of the time halfway there, and
    // where the two meet the camera is at rest for a moment, without a jump.
    struct orl_path path;
    assert_int_equal(read_text("timed.json", "{\"keyframes\": [{\"photo\": \"a\", \"seconds\": 1},"
                                             " {\"photo\": \"b\", \"seconds\": 3},"
                                             " {\"photo\": \"a\"}], \"frames\": 9}", &path),
                     ORL_OK);
    const double centres[9] = {-1, 1.25, 3};
    for (int i = 0; i < 3; i++)
        assert_centre(&path.views[i], centres[i], 0, 0);
    assert_centre(&path.views[8], -1, 0, 0);
    orl_path_finish(&path);
    static const char *const wrong[] = {"0", "-1", "1e9", "\"1\""};
    for (size_t i = 0; i < ORL_COUNT(wrong); i++) {
        char text[160];
        snprintf(text, sizeof text, "{\"keyframes\": [{\"photo\": \"a\", \"seconds\": %s},"
                 " {\"photo\": \"b\"}], \"frames\": 5}", wrong[i]);
        assert_int_equal(read_text("wrong.json", text, &path), ORL_ERR_FORMAT);
    }
}

// At x = 0, 1 and 3 after 0, 1 and 3 seconds: the speed at the second keyframe is that of the chord
// from the first to the third, by time. Found by hand, half-way between keyframes.
static void speed_follows_the_seconds(void **state)
{
    (void)state;
    struct orl_path path;
    assert_int_equal(
        read_text("line.json",
                  "{\"keyframes\": [{\"position\": [0, 0, 0], \"target\": [0, 0, 5], \"seconds\": 1},"
                  " {\"position\": [1, 0, 0], \"target\": [1, 0, 5], \"seconds\": 2},"
                  " {\"position\": [3, 0, 0], \"target\": [3, 0, 5]}], \"frames\": 13}", &path),
        ORL_OK);
    assert_int_equal(path.count, 13);
    assert_centre(&path.views[2], 0.4375, 0, 0);
    assert_centre(&path.views[4], 1, 0, 0);
    assert_centre(&path.views[8], 2.125, 0, 0);
    assert_centre(&path.views[12], 3, 0, 0);
    orl_path_finish(&path);
}

// A view of another shape keeps the angle of view up and down.
static void another_shape_keeps_the_height(void **state)
{
    (void)state;
    const struct orl_camera wide = {200, 100, 150, 150, 110, 40};
    struct orl_camera c = orl_camera_reframed(&wide, 300, 300);
    assert_float_equal(c.fy, 450, 1e-9);
    assert_float_equal(c.fx, 450, 1e-9);
    assert_float_equal(c.cx, 180, 1e-9);
    assert_float_equal(c.cy, 120, 1e-9);
}

// A path of another program is in the coordinates that the scene had before its origin moved.
static void paths_move_with_the_origin(void **state)
{
    (void)state;
    struct orl_path path;
    const double origin[3] = {1000, 2000, 3000};
    memcpy(scene.origin, origin, sizeof origin);
    assert_int_equal(read_text("camera_path.json",
                               "{\"render_width\": 40, \"render_height\": 30, \"camera_path\": ["
                               "{\"camera_to_world\": [1,0,0,1001, 0,1,0,2002, 0,0,1,3003, 0,0,0,1],"
                               " \"fov\": 60}]}", &path), ORL_OK);
    assert_centre(&path.views[0], 1, 2, 3);
    orl_path_finish(&path);
}

static void nerfstudio_axes_are_turned(void **state)
{
    (void)state;
    // OpenGL axes at (1, 2, 3), looking along world -z with y up.
    struct orl_path path;
    assert_int_equal(
        read_text("ns.json",
                  "{\"render_width\": 80, \"render_height\": 60, \"keyframes\": [{\"fov\": 90}],"
                  " \"camera_path\": [{\"fov\": 90, \"camera_to_world\": [1,0,0,1, 0,1,0,2, 0,0,1,3, 0,0,0,1]}]}", &path),
        ORL_OK);
    assert_int_equal(path.views[0].camera.width, 80);
    assert_centre(&path.views[0], 1, 2, 3);
    assert_sees(&path.views[0], 1, 2, -7, 40, 30);
    assert_sees(&path.views[0], 1, 12, -7, 40, 0);  // above: the upper edge
    assert_sees(&path.views[0], 11, 2, -7, 70, 30); // to the right
    orl_path_finish(&path);
}

static void inria_rotation_is_world_from_camera(void **state)
{
    (void)state;
    // A camera at (5, 0, 0) looking along world +x: its z is world x, its x is world -z.
    struct orl_path path;
    assert_int_equal(
        read_text("inria.json",
                  "[{\"id\": 0, \"width\": 100, \"height\": 50, \"position\": [5,0,0],"
                  " \"rotation\": [[0,0,1],[0,1,0],[-1,0,0]], \"fx\": 60, \"fy\": 60}]", &path),
        ORL_OK);
    assert_centre(&path.views[0], 5, 0, 0);
    assert_sees(&path.views[0], 15, 0, 0, 50, 25);
    assert_sees(&path.views[0], 15, 0, -5, 80, 25);
    orl_path_finish(&path);
}

static void colmap_text_takes_the_cameras_beside_it(void **state)
{
    (void)state;
    struct orl_path path;
    static const char images[] = "# comment\n1 1 0 0 0 1 2 3 4 x.jpg\n10 20 -1\n"
                                 "2 0 1 0 0 0 0 0 4 y.jpg\n\n";
    assert_int_equal(read_text("images.txt", images, &path), ORL_OK);
    assert_int_equal(path.count, 2);
    assert_centre(&path.views[0], -1, -2, -3);
    assert_float_equal(path.views[0].camera.fx, 150, 0); // the scene's
    orl_path_finish(&path);
    char *file = orl_path_join(NULL, dir, "cameras.txt");
    static const char cameras[] = "# comment\n4 SIMPLE_PINHOLE 64 48 70 32 24\n";
    assert_int_equal(orl_file_write(NULL, file, cameras, sizeof cameras - 1), ORL_OK);
    free(file);
    assert_int_equal(read_text("images.txt", images, &path), ORL_OK);
    assert_int_equal(path.views[1].camera.width, 64);
    assert_float_equal(path.views[1].camera.fy, 70, 0);
    assert_float_equal(path.views[1].cam_from_world.r[1][1], -1, 1e-12); // half a turn about x
    orl_path_finish(&path);
}

static void damaged_paths_are_refused(void **state)
{
    (void)state;
    static const char *const bad[] = {
        "", "{", "{}", "[]", "{\"keyframes\": []}", "{\"keyframes\": [{}]}",
        "{\"keyframes\": [{\"photo\": \"none\"}]}",
        "{\"keyframes\": [{\"photo\": \"a\"}], \"frames\": 9}",
        "{\"keyframes\": [{\"photo\": \"a\"}, {\"photo\": \"b\"}], \"frames\": 1e12}",
        "{\"keyframes\": [{\"photo\": \"a\", \"fov_y_deg\": 180}]}",
        "{\"keyframes\": [{\"cam_from_world\": [[2,0,0,0],[0,1,0,0],[0,0,1,0]]}]}",
        "{\"keyframes\": [{\"position\": [0,0], \"target\": [0,0,1]}]}",
        "{\"render_width\": 0, \"render_height\": 60, \"camera_path\": [{}]}",
        "[{\"width\": 10, \"height\": 10, \"fx\": 5}]",
        // A mirror, a size that is 64 modulo 2^32, and numbers that nothing real has.
        "{\"keyframes\": [{\"cam_from_world\": [[-1,0,0,0],[0,1,0,0],[0,0,1,0]]}]}",
        "{\"keyframes\": [{\"cam_from_world\": [[1,0,0,1e308],[0,1,0,0],[0,0,1,0]]}]}",
        "{\"keyframes\": [{\"position\": [1e308,0,0], \"target\": [0,0,1]}]}",
        "[{\"width\": 4294967360, \"height\": 64, \"position\": [0,0,0], \"fx\": 60, \"fy\": 60,"
        " \"rotation\": [[1,0,0],[0,1,0],[0,0,1]]}]",
        "[{\"width\": 64, \"height\": 64, \"position\": [0,0,0], \"fx\": 1e-300, \"fy\": 60,"
        " \"rotation\": [[1,0,0],[0,1,0],[0,0,1]]}]",
        "[{\"width\": 64, \"height\": 64, \"position\": [0,0,0], \"fx\": 60, \"fy\": 60,"
        " \"rotation\": [[1,0,0],[0,-1,0],[0,0,1]]}]",
        "{\"render_width\": 4294967360, \"render_height\": 60, \"camera_path\": [{\"fov\": 90,"
        " \"camera_to_world\": [1,0,0,1, 0,1,0,2, 0,0,1,3, 0,0,0,1]}]}",
    };
    struct orl_path path;
    for (size_t i = 0; i < ORL_COUNT(bad); i++) {
        assert_int_not_equal(read_text("bad.json", bad[i], &path), ORL_OK);
        assert_null(path.views);
    }
    assert_int_not_equal(read_text("bad.txt", "1 0 0 0 0 1 2 3 4 x.jpg\n\n", &path), ORL_OK);
    assert_int_not_equal(read_text("bad.txt", "# nothing\n", &path), ORL_OK);
    assert_int_not_equal(read_text("bad.txt", "1 1 0 0 0 1e308 2 3 4 x.jpg\n\n", &path), ORL_OK);
}

static void refusals_say_why(void **state)
{
    (void)state;
    static const char *const cases[][2] = {
        {"{\"keyframes\": [{\"photo\": \"a\"}, {\"photo\": \"none\"}]}",
         "bad.json: keyframe 1 is not usable: the scene has no photograph none"},
        {"{\"keyframes\": [{\"photo\": \"a\"}, {\"cam_from_world\": [[-1,0,0,0],[0,1,0,0],[0,0,1,0]]}]}",
         "bad.json: keyframe 1 is not usable: its axes are no rotation, or a mirror's"},
        {"{\"keyframes\": [{\"cam_from_world\": [[1,0,0,1e308],[0,1,0,0],[0,0,1,0]]}]}",
         "keyframe 0 is not usable: its position is absurdly far"},
        {"[{\"width\": 64, \"height\": 64, \"position\": [0,0,0], \"fx\": 1e-300, \"fy\": 60,"
         " \"rotation\": [[1,0,0],[0,1,0],[0,0,1]]}]",
         "camera 0 is not usable: its size, focal length or principal point is absurd"},
    };
    for (size_t i = 0; i < ORL_COUNT(cases); i++) {
        struct said said;
        struct orl_log log = log_to(&said);
        struct orl_path path;
        char *file = test_path(dir, "bad.json");
        assert_int_equal(orl_file_write(NULL, file, cases[i][0], strlen(cases[i][0])), ORL_OK);
        assert_int_equal(orl_path_read(&log, &scene, file, &path), ORL_ERR_FORMAT);
        if (!strstr(said.text, cases[i][1]))
            fail_msg("case %zu: %s", i, said.text);
        free(file);
    }
}

// Processor seconds of reading poses with a camera each.
static double seconds_to_read(int count)
{
    FILE *cameras = test_create(dir, "cameras.txt"), *images = test_create(dir, "images.txt");
    for (int i = 0; i < count; i++) {
        fprintf(cameras, "%d PINHOLE 64 48 70 70 32 24\n", count - i);
        fprintf(images, "%d 1 0 0 0 %d 2 3 %d x.jpg\n\n", i + 1, i, i + 1);
    }
    assert_int_equal(fclose(cameras), 0);
    assert_int_equal(fclose(images), 0);
    char *file = orl_path_join(NULL, dir, "images.txt");
    struct orl_path path;
    clock_t start = clock();
    assert_int_equal(orl_path_read(NULL, &scene, file, &path), ORL_OK);
    clock_t end = clock();
    assert_int_equal(path.count, count);
    assert_centre(&path.views[count - 1], 1 - count, -2, -3);
    orl_path_finish(&path);
    free(file);
    return (double)(end - start) / CLOCKS_PER_SEC;
}

// Cameras and lines are looked at once, not once for every picture.
static void many_poses_take_little_time(void **state)
{
    (void)state;
    test_grows_in_proportion(seconds_to_read);
}

// Processor seconds of spreading frames over as many keyframes.
static double seconds_to_spread(int count)
{
    FILE *keys = test_create(dir, "many.json");
    fprintf(keys, "{\"frames\": %d, \"keyframes\": [", count);
    for (int i = 0; i < count; i++)
        fprintf(keys, "%s{\"photo\": \"%s\"}", i ? ",\n" : "", i % 2 ? "b" : "a");
    fprintf(keys, "]}");
    assert_int_equal(fclose(keys), 0);
    char *file = orl_path_join(NULL, dir, "many.json");
    struct orl_path path;
    clock_t start = clock();
    assert_int_equal(orl_path_read(NULL, &scene, file, &path), ORL_OK);
    clock_t end = clock();
    assert_int_equal(path.count, count);
    assert_centre(&path.views[count - 1], count % 2 ? -1 : 3, 0, 0);
    orl_path_finish(&path);
    free(file);
    return (double)(end - start) / CLOCKS_PER_SEC;
}

// A frame goes on from the keyframes of the one before it.
static void many_keyframes_take_little_time(void **state)
{
    (void)state;
    test_grows_in_proportion(seconds_to_spread);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test_setup_teardown(keyframes_stand_where_they_say, set_up, tear_down),
        cmocka_unit_test_setup_teardown(frames_move_smoothly_from_end_to_end, set_up, tear_down),
        cmocka_unit_test_setup_teardown(a_circle_leads_around_what_they_see, set_up, tear_down),
        cmocka_unit_test_setup_teardown(keyframes_have_their_own_seconds, set_up, tear_down),
        cmocka_unit_test_setup_teardown(speed_follows_the_seconds, set_up, tear_down),
        cmocka_unit_test(another_shape_keeps_the_height),
        cmocka_unit_test_setup_teardown(paths_move_with_the_origin, set_up, tear_down),
        cmocka_unit_test_setup_teardown(nerfstudio_axes_are_turned, set_up, tear_down),
        cmocka_unit_test_setup_teardown(inria_rotation_is_world_from_camera, set_up, tear_down),
        cmocka_unit_test_setup_teardown(colmap_text_takes_the_cameras_beside_it, set_up,
                                        tear_down),
        cmocka_unit_test_setup_teardown(damaged_paths_are_refused, set_up, tear_down),
        cmocka_unit_test_setup_teardown(refusals_say_why, set_up, tear_down),
        cmocka_unit_test_setup_teardown(many_poses_take_little_time, set_up, tear_down),
        cmocka_unit_test_setup_teardown(many_keyframes_take_little_time, set_up, tear_down),
    };
    return cmocka_run_group_tests_name("path", tests, NULL, NULL);
}
