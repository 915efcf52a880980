// Cameras as other programs write them: one camera by hand in each format, and damaged files.
#include <math.h>
#include <string.h>

#include "scene/known_cameras.h"
#include "test.h"

static void save(const char *dir, const char *name, const char *text)
{
    char path[4096];
    snprintf(path, sizeof path, "%s/%s", dir, name);
    assert_int_equal(orl_file_write(NULL, path, text, strlen(text)), ORL_OK);
}

// Reads DIR/name, or DIR itself for NULL.
static enum orl_result read(const struct orl_log *log, const char *dir, const char *name,
                            double pixel_centre, struct orl_known_cameras *known)
{
    char path[4096];
    snprintf(path, sizeof path, "%s/%s", dir, name ? name : "");
    return orl_known_cameras_read(log, path, pixel_centre, known);
}

// All formats below describe this camera: at (1, 2, 3), its x along -y, its y along x, its z
// along z of the world.
static const double rotation[3][3] = {{0, -1, 0}, {1, 0, 0}, {0, 0, 1}};

static void check_pose(const struct orl_known_cameras *known, size_t i)
{
    const struct orl_pose *pose = &known->model.images[i].cam_from_world;
    const double centre[3] = {1, 2, 3};
    double at[3];
    orl_pose_centre(pose, at);
    for (int k = 0; k < 3; k++) {
        assert_float_equal(at[k], centre[k], 1e-12);
        for (int j = 0; j < 3; j++)
            assert_float_equal(pose->r[k][j], rotation[k][j], 1e-12);
    }
}

static void check_params(const struct orl_colmap_camera *camera, int model, const double *params,
                         int count)
{
    assert_int_equal(camera->model, model);
    assert_int_equal(camera->param_count, count);
    for (int i = 0; i < count; i++)
        assert_float_equal(camera->params[i], params[i], 1e-12);
}

#define POSE "\"R\": [[0,-1,0],[1,0,0],[0,0,1]], \"t\": [2,-1,-3]"
#define K_MATRIX "\"K\": [[500,0,320],[0,510,240],[0,0,1]]"

static void reads_cameras_json(void **state)
{
    (void)state;
    char *dir = test_dir_make();
    struct orl_known_cameras known;
    save(dir, "cameras.json",
         "{\"cameras\": ["
         "{\"name\": \"b.png\", \"width\": 640, \"height\": 480, " K_MATRIX ", " POSE
         ", \"dist\": []},"
         "{\"name\": \"a.png\", \"width\": 640, \"height\": 480, " K_MATRIX ", " POSE
         ", \"dist\": [-0.37, 0.2, 0.001, 0.002, -0.07]}]}");
    assert_int_equal(read(NULL, dir, "cameras.json", -1, &known), ORL_OK);
    assert_int_equal(known.model.image_count, 2);
    assert_int_equal(known.model.camera_count, 2);
    assert_string_equal(known.model.images[0].name, "a.png"); // sorted
    check_pose(&known, 0);
    check_pose(&known, 1);
    // OpenCV's pixel centres are whole numbers.
    check_params(&known.model.cameras[0], 1, (double[]){500, 510, 320.5, 240.5}, 4);
    check_params(&known.model.cameras[1], 6,
                 (double[]){500, 510, 320.5, 240.5, -0.37, 0.2, 0.001, 0.002, -0.07, 0, 0, 0}, 12);
    orl_known_cameras_finish(&known);
    assert_int_equal(read(NULL, dir, NULL, 0.5, &known), ORL_OK); // its folder; told otherwise
    check_params(&known.model.cameras[0], 1, (double[]){500, 510, 320, 240}, 4);
    orl_known_cameras_finish(&known);
    test_dir_remove(dir);
}

static void reads_inria(void **state)
{
    (void)state;
    char *dir = test_dir_make();
    struct orl_known_cameras known;
    // rotation is world_from_cam.
    save(dir, "cameras.json",
         "[{\"id\": 0, \"img_name\": \"a\", \"width\": 640, \"height\": 480, "
         "\"position\": [1,2,3], \"rotation\": [[0,1,0],[-1,0,0],[0,0,1]], "
         "\"fx\": 500, \"fy\": 510, \"zfar\": 100}]");
    struct said said = {0};
    const struct orl_log log = log_to(&said);
    assert_int_equal(read(&log, dir, "cameras.json", -1, &known), ORL_OK);
    check_pose(&known, 0);
    check_params(&known.model.cameras[0], 1, (double[]){500, 510, 320, 240}, 4);
    assert_non_null(strstr(said.text, "not used: zfar\n"));
    orl_known_cameras_finish(&known);
    test_dir_remove(dir);
}

static void reads_nerfstudio(void **state)
{
    (void)state;
    char *dir = test_dir_make();
    struct orl_known_cameras known;
    // OpenGL's y and z are the negatives of ours: columns x, -y, -z.
#define MATRIX "\"transform_matrix\": [[0,-1,0,1],[-1,0,0,2],[0,0,-1,3],[0,0,0,1]]"
    save(dir, "transforms.json",
         "{\"fl_x\": 500, \"fl_y\": 510, \"cx\": 320, \"cy\": 240, \"w\": 640, \"h\": 480,"
         "\"k1\": 0.1, \"k2\": 0, \"p1\": 0.01, \"p2\": 0, \"frames\": ["
         "{\"file_path\": \"images/a.jpg\", " MATRIX "},"
         "{\"file_path\": \"images/b.jpg\", \"fl_x\": 600, " MATRIX "}]}");
    assert_int_equal(read(NULL, dir, NULL, -1, &known), ORL_OK);
    check_pose(&known, 1);
    assert_string_equal(known.model.images[0].name, "a.jpg");
    assert_string_equal(known.pictures[known.model.images[0].id - 1].path, "images/a.jpg");
    check_params(&known.model.cameras[0], 4, (double[]){500, 510, 320, 240, 0.1, 0, 0.01, 0}, 8);
    assert_float_equal(known.model.cameras[1].params[0], 600, 0);
    orl_known_cameras_finish(&known);
    // As Blender writes it: only an angle. 640 / 2 / tan(45 degrees) = 320.
    save(dir, "transforms.json",
         "{\"camera_angle_x\": 1.5707963267948966, \"frames\": ["
         "{\"file_path\": \"./train/r_0\", " MATRIX "}, {\"file_path\": \"./train/r_1\", " MATRIX
         "}]}");
    assert_int_equal(read(NULL, dir, NULL, -1, &known), ORL_OK);
    assert_int_equal(orl_known_camera_settle(NULL, &known, 0, "r_0.png", 640, 480), ORL_OK);
    check_params(&known.model.cameras[0], 1, (double[]){320, 320, 320, 240}, 4);
    orl_known_cameras_finish(&known);
    save(dir, "transforms.json",
         "{\"camera_model\": \"OPENCV_FISHEYE\", \"fl_x\": 500, \"cx\": 320, \"cy\": 240, "
         "\"w\": 640, \"h\": 480, \"k3\": 0.3, \"frames\": [{\"file_path\": \"a.jpg\", "
         // without the last row, which some programs leave out
         "\"transform_matrix\": [[0,-1,0,1],[-1,0,0,2],[0,0,-1,3]]}]}");
    assert_int_equal(read(NULL, dir, NULL, -1, &known), ORL_OK);
    check_params(&known.model.cameras[0], 5, (double[]){500, 500, 320, 240, 0, 0, 0.3, 0}, 8);
    orl_known_cameras_finish(&known);
    // instant-ngp's scripts name no model.
    save(dir, "transforms.json",
         "{\"is_fisheye\": true, \"fl_x\": 500, \"cx\": 320, \"cy\": 240, \"w\": 640, \"h\": 480, "
         "\"k1\": 0.3, \"k4\": 0.1, \"frames\": [{\"file_path\": \"a.jpg\", " MATRIX "}]}");
    assert_int_equal(read(NULL, dir, NULL, -1, &known), ORL_OK);
    check_params(&known.model.cameras[0], 5, (double[]){500, 500, 320, 240, 0.3, 0, 0, 0.1}, 8);
    orl_known_cameras_finish(&known);
    struct said said;
    struct orl_log log = log_to(&said);
    save(dir, "transforms.json",
         "{\"camera_model\": \"EQUIRECTANGULAR\", \"fl_x\": 500, \"w\": 640, \"h\": 320, "
         "\"frames\": [{\"file_path\": \"a.jpg\", " MATRIX "}]}");
    assert_int_equal(read(&log, dir, NULL, -1, &known), ORL_ERR_FORMAT);
    assert_non_null(strstr(said.text, "its camera_model, EQUIRECTANGULAR, is not read"));
    test_dir_remove(dir);
}

static void reads_middlebury(void **state)
{
    (void)state;
    char *dir = test_dir_make();
    struct orl_known_cameras known;
    save(dir, "thing_par.txt",
         "1\nthing1.png 500 0 320 0 510 240 0 0 1  0 -1 0 1 0 0 0 0 1  2 -1 -3\n");
    assert_int_equal(read(NULL, dir, NULL, -1, &known), ORL_OK); // found in its folder
    check_pose(&known, 0);
    assert_true(known.gaps[0].size);
    assert_int_equal(orl_known_camera_settle(NULL, &known, 0, "thing1.png", 640, 480), ORL_OK);
    check_params(&known.model.cameras[0], 1, (double[]){500, 510, 320.5, 240.5}, 4);
    orl_known_cameras_finish(&known);
    test_dir_remove(dir);
}

static void reads_bundler(void **state)
{
    (void)state;
    char *dir = test_dir_make();
    struct orl_known_cameras known;
    // y up, z backward: rows 2 and 3 of R and t change sign. The second was not registered.
    save(dir, "bundle.out",
         "# Bundle file v0.3\n3 2\n"
         "500 0.1 0.01\n0 -1 0\n-1 0 0\n0 0 -1\n2 1 3\n"
         "0 0 0\n0 0 0\n0 0 0\n0 0 0\n0 0 0\n"
         "500 0 0\n0 -1 0\n-1 0 0\n0 0 -1\n2 1 3\n"
         "1 2 8\n255 128 0\n2 0 5 10.5 -3 2 7 1 2\n"
         "4 5 9\n1 2 3\n1 1 0 0 0\n");
    save(dir, "list.txt", "photos/a.jpg 0 500\nphotos/b.jpg\nphotos/c.jpg\t0\t500\n");
    assert_int_equal(read(NULL, dir, "bundle.out", -1, &known), ORL_OK);
    assert_int_equal(known.model.image_count, 2);
    assert_string_equal(known.model.images[1].name, "c.jpg");
    check_pose(&known, 0);
    check_pose(&known, 1);
    assert_int_equal(orl_known_camera_settle(NULL, &known, 0, "a.jpg", 640, 480), ORL_OK);
    check_params(&known.model.cameras[0], 4, (double[]){500, 500, 320, 240, 0.1, 0.01, 0, 0}, 8);
    assert_int_equal(known.model.point_count, 2);
    assert_float_equal(known.model.points[0].position[2], 8, 0);
    assert_int_equal(known.model.points[0].rgb[1], 128);
    assert_int_equal(known.model.points[0].track_length, 2);
    assert_int_equal(known.model.points[1].track_length, 0);
    assert_int_equal(known.model.images[1].point_count, 1);
    assert_int_equal(known.model.images[1].points[0], 0);
    orl_known_cameras_finish(&known);
    // RealityCapture calls the list otherwise.
    char *list = test_path(dir, "list.txt"), *other = test_path(dir, "imagelist.lst");
    assert_int_equal(rename(list, other), 0);
    free(list);
    free(other);
    assert_int_equal(read(NULL, dir, "bundle.out", -1, &known), ORL_OK);
    assert_string_equal(known.model.images[1].name, "c.jpg");
    orl_known_cameras_finish(&known);
    test_dir_remove(dir);
}

// A model that was written is the model that is read.
static void writes_colmap(void **state)
{
    (void)state;
    char *dir = test_dir_make();
    struct orl_known_cameras known;
    struct orl_colmap_model model;
    save(dir, "cameras.txt", "7 OPENCV 640 480 500 510 320 240 0.1 0 0.01 0\n");
    save(dir, "images.txt", "3 0.5 0.5 0.5 0.5 0 0 4 7 b.jpg\n1 2 9 3 4 -1\n"
                            "1 1 0 0 0 0 0 4 7 a.jpg\n1 2 9\n");
    save(dir, "points3D.txt", "9 0.5 0.25 1 10 20 30 0.5 3 0 1 0\n");
    assert_int_equal(read(NULL, dir, NULL, -1, &known), ORL_OK);
    char *out = orl_path_join(NULL, dir, "out");
    assert_int_equal(orl_dir_make(NULL, out), ORL_OK);
    assert_int_equal(orl_colmap_write(NULL, out, &known.model, NULL), ORL_OK);
    assert_int_equal(orl_colmap_read(NULL, out, &model), ORL_OK);
    assert_int_equal(model.image_count, 2);
    assert_string_equal(model.images[0].name, "a.jpg");
    assert_int_equal(model.images[1].id, 3);
    assert_int_equal(model.images[1].camera_id, 7);
    assert_float_equal(model.images[1].cam_from_world.r[0][2], 1, 1e-12);
    assert_int_equal(model.images[0].point_count, 1);
    assert_int_equal(model.points[0].id, 9);
    assert_int_equal(model.points[0].track_length, 2);
    assert_float_equal(model.points[0].position[1], 0.25, 0);
    check_params(&model.cameras[0], 4, (double[]){500, 510, 320, 240, 0.1, 0, 0.01, 0}, 8);
    orl_colmap_finish(&model);
    orl_known_cameras_finish(&known);
    free(out);
    test_dir_remove(dir);
}

static void settles_for_pictures(void **state)
{
    (void)state;
    char *dir = test_dir_make();
    struct orl_known_cameras known;
    struct said said;
    struct orl_log log = log_to(&said);
    save(dir, "cameras.json", "{\"pixel_centre\": 0.5, \"cameras\": [{\"name\": \"a\", \"width\": "
                              "640, \"height\": 480, " K_MATRIX ", " POSE "}]}");
    assert_int_equal(read(NULL, dir, NULL, -1, &known), ORL_OK);
    assert_int_equal(orl_known_camera_settle(&log, &known, 0, "a.png", 640, 400), ORL_ERR_DATA);
    assert_non_null(strstr(said.text, "a.png: 640x400 pixels, but its camera has 640x480"));
    orl_known_cameras_finish(&known);
    assert_int_equal(read(NULL, dir, NULL, -1, &known), ORL_OK);
    assert_int_equal(orl_known_camera_settle(&log, &known, 0, "a.png", 320, 240), ORL_OK);
    check_params(&known.model.cameras[0], 1, (double[]){250, 255, 160, 120}, 4);
    orl_known_cameras_finish(&known);
    test_dir_remove(dir);
}

#define GOOD "{\"name\": \"a\", \"width\": 640, \"height\": 480, " K_MATRIX ", " POSE "}"

static void refuses_damage(void **state)
{
    (void)state;
    static const struct {
        const char *file, *text, *why;
        enum orl_result result;
    } cases[] = {
        {"cameras.json", "{\"cameras\": [\n{]}", "line 2 (byte ", ORL_ERR_FORMAT},
        {"cameras.json", "", "byte 0", ORL_ERR_FORMAT},
        {"cameras.json", "{}", "not a file of cameras that is known", ORL_ERR_FORMAT},
        {"cameras.json", "{\"cameras\": 3}", "not a file of cameras that is known", ORL_ERR_FORMAT},
        {"cameras.json", "{\"cameras\": []}", "no camera in it", ORL_ERR_DATA},
        {"cameras.json", "{\"cameras\": [7]}", "camera 0 has no \"name\"", ORL_ERR_FORMAT},
        {"cameras.json", "{\"cameras\": [{\"name\": 3}]}", "no \"name\"", ORL_ERR_FORMAT},
        {"cameras.json", "{\"cameras\": [{\"name\": \"a\"}]}", "camera 0 (a): \"K\"",
         ORL_ERR_FORMAT},
        {"cameras.json", "{\"cameras\": [" GOOD ", " GOOD "]}", "listed twice", ORL_ERR_FORMAT},
        {"cameras.json", "{\"pixel_centre\": 7, \"cameras\": [" GOOD "]}", "\"pixel_centre\"",
         ORL_ERR_FORMAT},
        {"cameras.json", "{\"cameras\": [{\"name\": \"a\", \"width\": 640, \"height\": 480, "
         K_MATRIX ", \"R\": [[1,0,0],[0,1,0],[0,0,2]], \"t\": [0,0,0]}]}", "not a rotation",
         ORL_ERR_FORMAT},
        {"cameras.json", "{\"cameras\": [{\"name\": \"a\", \"width\": 640, \"height\": 480, "
         K_MATRIX ", \"R\": [[1,0,0],[0,1,0],[0,0,-1]], \"t\": [0,0,0]}]}", "not a rotation",
         ORL_ERR_FORMAT},
        {"cameras.json", "{\"cameras\": [{\"name\": \"a\", \"width\": 640, \"height\": 480, "
         "\"K\": [[500,40,320],[0,510,240],[0,0,1]], " POSE "}]}", "skew", ORL_ERR_FORMAT},
        // 640 more than 32 bits hold.
        {"cameras.json", "{\"cameras\": [{\"name\": \"a\", \"width\": 4294967936, \"height\": 480, "
         K_MATRIX ", " POSE "}]}", "size is absurd", ORL_ERR_FORMAT},
        {"cameras.json", "{\"cameras\": [{\"name\": \"a\", \"width\": -1, \"height\": 480, "
         K_MATRIX ", " POSE "}]}", "size is absurd", ORL_ERR_FORMAT},
        {"cameras.json", "{\"cameras\": [{\"name\": \"a\", \"width\": 640, \"height\": 480, "
         "\"K\": [[1e308,0,320],[0,510,240],[0,0,1]], " POSE "}]}", "parameter is absurd",
         ORL_ERR_FORMAT},
        {"cameras.json", "{\"cameras\": [{\"name\": \"..\", \"width\": 640, \"height\": 480, "
         K_MATRIX ", " POSE "}]}", "leads out", ORL_ERR_FORMAT},
        {"cameras.json", "{\"cameras\": [{\"name\": \"a\", \"width\": 640, \"height\": 480, "
         K_MATRIX ", " POSE ", \"dist\": [1,2,3,4,5,6,7,8,9]}]}", "\"dist\"", ORL_ERR_FORMAT},
        {"cameras.json", "[{\"img_name\": \"a\", \"width\": 640}]", "camera 0 (a): position",
         ORL_ERR_FORMAT},
        {"transforms.json", "{\"frames\": [{\"file_path\": \"a\"}]}", "\"transform_matrix\"",
         ORL_ERR_FORMAT},
        {"transforms.json", "{\"frames\": [{\"file_path\": \"a\", " MATRIX "}]}",
         "neither fl_x nor camera_angle_x", ORL_ERR_FORMAT},
        {"transforms.json", "{\"fl_x\": 1, \"camera_model\": \"EQUIRECTANGULAR\", \"frames\": "
         "[{\"file_path\": \"a\", " MATRIX "}]}", "camera_model", ORL_ERR_FORMAT},
        {"transforms.json", "{\"fl_x\": 1, \"k4\": 0.1, \"frames\": [{\"file_path\": \"a\", " MATRIX "}]}",
         "k4 of its lens is not read", ORL_ERR_FORMAT},
        {"transforms.json", "{\"fl_x\": 1, \"is_fisheye\": true, \"frames\": [{\"file_path\": \"a\", "
         "\"p2\": 0.1, " MATRIX "}]}", "p2 of its lens is not read", ORL_ERR_FORMAT},
        {"transforms.json", "{\"fl_x\": 1, \"frames\": [{\"file_path\": \"a\", \"transform_matrix\": "
         "[[0,-1,0,1],[-1,0,0,2],[0,0,-1,3],[0,0,0,2]]}]}", "the last row", ORL_ERR_FORMAT},
        {"transforms.json", "{\"camera_angle_x\": 9, \"frames\": [{\"file_path\": \"a\", " MATRIX
         "}]}", "focal length is absurd", ORL_ERR_FORMAT},
        {"x_par.txt", "", "line 0", ORL_ERR_FORMAT},
        {"x_par.txt", "-1\n", "not the number of cameras", ORL_ERR_FORMAT},
        {"x_par.txt", "2\na.png 500 0 320 0 510 240 0 0 1 0 -1 0 1 0 0 0 0 1 2 -1 -3\n",
         "the file ends after 1 cameras of 2", ORL_ERR_FORMAT},
        {"x_par.txt", "1\na.png 500 0 320 0 510 240 0 0 1 0 -1 0 1 0 0 0 0\n", "line 2 (byte ",
         ORL_ERR_FORMAT},
        {"x_par.txt", "1\na.png 500 0 320 0 510 240 0 0 1 0 -1 0 1 0 0 0 0 nan 2 -1 -3\n",
         "line 2: its R is not a rotation", ORL_ERR_FORMAT},
        {"bundle.out", "# Bundle file v0.3\n", "not the numbers of cameras", ORL_ERR_FORMAT},
        {"bundle.out", "1000000 4000000000\n", "more cameras or points than", ORL_ERR_FORMAT},
        {"bundle.out", "2 0\n500 0 0\n0 -1 0\n-1 0 0\n0 0 -1\n2 1 3\n"
         "500 0 0\n0 -1 0\n-1 0 0\n0 0 -1\n2 1 3\n", "2 cameras, but list.txt names 1",
         ORL_ERR_DATA},
        {"bundle.out", "1 0\n500 0 0\n0 -1 0\n-1 0\n0 0 -1\n2 1 3\n", "line 4 (byte ",
         ORL_ERR_FORMAT},
        {"bundle.out", "1 1\n500 0 0\n0 -1 0\n-1 0 0\n0 0 -1\n2 1 3\n1 2 3\n4 5 6\n1 9 0 0 0\n",
         "a camera that is there", ORL_ERR_FORMAT},
        {"bundle.out", "1 1\n500 0 0\n0 -1 0\n-1 0 0\n0 0 -1\n2 1 3\n1 2 3\n4 5 6\n99 0 0 0 0\n",
         "a view needs a camera", ORL_ERR_FORMAT},
        {"cameras.xml", "<a/>", "not Metashape's cameras", ORL_ERR_FORMAT},
        {"cameras.yaml", "", "not a file of cameras that is known", ORL_ERR_FORMAT},
    };
    for (size_t i = 0; i < ORL_COUNT(cases); i++) {
        char *dir = test_dir_make();
        struct said said;
        struct orl_log log = log_to(&said);
        struct orl_known_cameras known;
        save(dir, "list.txt", "a.jpg\n");
        save(dir, cases[i].file, cases[i].text);
        enum orl_result result = read(&log, dir, cases[i].file, -1, &known);
        if (result != cases[i].result || !strstr(said.text, cases[i].why) ||
            !strstr(said.text, dir))
            fail_msg("case %zu: %s: \"%s\" does not say \"%s\"", i, orl_result_name(result),
                     said.text, cases[i].why);
        assert_null(known.model.images);
        test_dir_remove(dir);
    }
}

// A file cut off anywhere is refused or read, without harm.
static void survives_truncation(void **state)
{
    (void)state;
    static const char whole[] = "{\"cameras\": [" GOOD "]}";
    char *dir = test_dir_make();
    for (size_t cut = 0; cut < strlen(whole); cut++) {
        char text[sizeof whole];
        struct orl_known_cameras known;
        snprintf(text, sizeof text, "%.*s", (int)cut, whole);
        save(dir, "cameras.json", text);
        assert_int_not_equal(read(NULL, dir, "cameras.json", -1, &known), ORL_OK);
    }
    test_dir_remove(dir);
}

static void says_what_a_folder_lacks(void **state)
{
    (void)state;
    char *dir = test_dir_make();
    struct said said;
    struct orl_log log = log_to(&said);
    struct orl_known_cameras known;
    assert_int_equal(read(&log, dir, NULL, -1, &known), ORL_ERR_NOT_FOUND);
    assert_non_null(strstr(said.text, "no cameras here"));
    assert_int_equal(read(&log, dir, "cameras.json", -1, &known), ORL_ERR_NOT_FOUND);
    assert_int_equal(read(&log, dir, "sparse", -1, &known), ORL_ERR_NOT_FOUND);
    assert_non_null(strstr(said.text, "sparse: no such file or folder"));
    save(dir, "a_par.txt", "1\n");
    save(dir, "b_par.txt", "1\n");
    assert_int_equal(read(&log, dir, NULL, -1, &known), ORL_ERR_DATA);
    assert_non_null(strstr(said.text, "several files of cameras, a_par.txt and b_par.txt"));
    test_dir_remove(dir);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(reads_cameras_json), cmocka_unit_test(reads_inria),
        cmocka_unit_test(reads_nerfstudio), cmocka_unit_test(reads_middlebury),
        cmocka_unit_test(reads_bundler), cmocka_unit_test(writes_colmap),
        cmocka_unit_test(settles_for_pictures), cmocka_unit_test(refuses_damage),
        cmocka_unit_test(survives_truncation), cmocka_unit_test(says_what_a_folder_lacks),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
