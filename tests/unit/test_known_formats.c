// Where cameras of other programs are found, how their files' variants are read, and what they state
// besides cameras: one camera, by hand, in each format.
#include <math.h>
#include <string.h>
#include <sys/resource.h>

#include "oriel/path.h"
#include "scene/known_cameras.h"
#include "scene/mesh.h"
#include "test.h"

// What a test works with.
struct work {
    char *dir;
    struct said said;
    struct orl_log log;
    struct orl_known_cameras known;
};

static int set_up(void **state)
{
    struct work *w = calloc(1, sizeof *w);
    w->dir = test_dir_make();
    w->log = log_to(&w->said);
    *state = w;
    return 0;
}

static int tear_down(void **state)
{
    struct work *w = *state;
    orl_known_cameras_finish(&w->known);
    test_dir_remove(w->dir);
    free(w);
    return 0;
}

static void save(const struct work *w, const char *name, const char *text)
{
    char *path = test_path(w->dir, name);
    assert_int_equal(orl_file_make_folder(NULL, path), ORL_OK);
    assert_int_equal(orl_file_write(NULL, path, text, strlen(text)), ORL_OK);
    free(path);
}

// Reads DIR/name, or DIR itself for "", in place of what was read before.
static enum orl_result read(struct work *w, const char *name)
{
    char path[4096];
    orl_known_cameras_finish(&w->known);
    w->log = log_to(&w->said);
    snprintf(path, sizeof path, "%s/%s", w->dir, name);
    return orl_known_cameras_read(&w->log, path, -1, &w->known);
}

static void says(const struct work *w, const char *what)
{
    if (!strstr(w->said.text, what))
        fail_msg("\"%s\" does not say \"%s\"", w->said.text, what);
}

static const char *name_of(const struct work *w, size_t i)
{
    assert_true(i < w->known.model.image_count);
    return w->known.model.images[i].name;
}

// All formats below describe this camera: at (1, 2, 3), its x along -y, its y along x, its z along z of
// the world.
static void check_pose(const struct work *w, size_t i)
{
    static const double rotation[3][3] = {{0, -1, 0}, {1, 0, 0}, {0, 0, 1}}, centre[3] = {1, 2, 3};
    const struct orl_pose *pose = &w->known.model.images[i].cam_from_world;
    double at[3];
    orl_pose_centre(pose, at);
    for (int k = 0; k < 3; k++) {
        assert_float_equal(at[k] + w->known.origin[k], centre[k], 1e-6);
        for (int j = 0; j < 3; j++)
            assert_float_equal(pose->r[k][j], rotation[k][j], 1e-6);
    }
}

static void check_params(const struct work *w, int model, const double *params, int count)
{
    const struct orl_colmap_camera *camera = &w->known.model.cameras[0];
    assert_int_equal(camera->model, model);
    assert_int_equal(camera->param_count, count);
    for (int i = 0; i < count; i++)
        assert_float_equal(camera->params[i], params[i], 1e-9);
}

// --- COLMAP ---

#define IMAGE "0.5 0.5 0.5 0.5 0 0 4 7 "

static void takes_the_largest_model(void **state)
{
    struct work *w = *state;
    save(w, "sparse/0/cameras.txt", "7 PINHOLE 640 480 500 510 320 240\n");
    save(w, "sparse/0/images.txt", "1 " IMAGE "a.jpg\n\n");
    save(w, "sparse/1/cameras.txt", "7 PINHOLE 640 480 500 510 320 240\n");
    save(w, "sparse/1/images.txt", "1 " IMAGE "a.jpg\n\n2 " IMAGE "b.jpg\n\n");
    assert_int_equal(read(w, ""), ORL_OK);
    assert_int_equal(w->known.model.image_count, 2);
    says(w, "2 COLMAP models; taking the largest");
    says(w, "sparse/1/cameras.txt: COLMAP model: 2 cameras");
    assert_int_equal(read(w, "sparse"), ORL_OK); // the folder of models
    assert_int_equal(w->known.model.image_count, 2);
    assert_int_equal(read(w, "sparse/0"), ORL_OK); // one of them
    assert_int_equal(w->known.model.image_count, 1);
}

// Pictures are looked for beside the nearest images/.
static void finds_models_in_other_folders(void **state)
{
    static const char *const folders[] = {"sparse/aligned", "model", "dense/0/sparse", "colmap/sparse/0"};
    struct work *w = *state;
    for (size_t i = 0; i < ORL_COUNT(folders); i++) {
        char set[64], name[128];
        snprintf(set, sizeof set, "set %zu", i);
        snprintf(name, sizeof name, "%s/%s/cameras.txt", set, folders[i]);
        save(w, name, "7 PINHOLE 640 480 500 510 320 240\n");
        snprintf(name, sizeof name, "%s/%s/images.txt", set, folders[i]);
        save(w, name, "1 " IMAGE "a.jpg\n\n");
        snprintf(name, sizeof name, "%s/%simages/a.jpg", set, i == 2 ? "dense/0/" : "");
        save(w, name, "");
        assert_int_equal(read(w, set), ORL_OK);
        char *images = test_path(w->known.folder, "images");
        assert_true(orl_path_is_dir(images));
        free(images);
    }
}

static void reads_models_without_points(void **state)
{
    struct work *w = *state;
    save(w, "cameras.txt", "7 PINHOLE 640 480 500 510 320 240\n");
    save(w, "images.txt", "1 " IMAGE "a.jpg\n1 2 9\n");
    assert_int_equal(read(w, ""), ORL_OK);
    assert_int_equal(w->known.model.point_count, 0);
    save(w, "written/x", "");
    char *dir = test_path(w->dir, "written"), *points = test_path(dir, "points3D.bin");
    struct orl_colmap_model model;
    assert_int_equal(orl_colmap_write(NULL, dir, &w->known.model, NULL), ORL_OK);
    assert_int_equal(remove(points), 0);
    assert_int_equal(orl_colmap_read(NULL, dir, &model), ORL_OK);
    assert_int_equal(model.image_count, 1);
    orl_colmap_finish(&model);
    free(points);
    free(dir);
}

// Lines of observations are missing for some pictures, and there for others.
static void reads_images_of_one_line(void **state)
{
    struct work *w = *state;
    save(w, "cameras.txt", "\xef\xbb\xbf" "7 PINHOLE 640 480 500 510 320 240\n"); // a byte order mark
    save(w, "points3D.txt", "9 0.5 0.25 1 10 20 30 0.5\n");
    save(w, "images.txt", "1 " IMAGE "a 1.jpg\n2 " IMAGE "b.jpg\n1 2 9\n3 " IMAGE "c.jpg\n\n4 " IMAGE "4\n");
    assert_int_equal(read(w, ""), ORL_OK);
    assert_int_equal(w->known.model.image_count, 4);
    assert_string_equal(name_of(w, 1), "a 1.jpg");
    assert_int_equal(w->known.model.images[1].point_count, 0);
    assert_int_equal(w->known.model.images[2].point_count, 1);
    save(w, "images.txt", "1 " IMAGE "a.jpg\n1 2\n");
    assert_int_equal(read(w, ""), ORL_ERR_FORMAT);
}

static void reads_names_of_other_systems(void **state)
{
    struct work *w = *state;
    save(w, "cameras.txt", "7 PINHOLE 640 480 500 510 320 240\n");
    save(w, "images.txt", "1 " IMAGE "front\\a.jpg\n\n2 " IMAGE "D:\\my photos\\b.jpg\n\n");
    assert_int_equal(read(w, ""), ORL_OK);
    assert_string_equal(name_of(w, 0), "front/a.jpg");
    assert_string_equal(name_of(w, 1), "my photos/b.jpg");
    save(w, "images.txt", "1 " IMAGE "..\\..\\a.jpg\n\n");
    assert_int_equal(read(w, ""), ORL_ERR_FORMAT);
    says(w, "leads out of its folder");
}

// --- transforms.json ---

#define LENS "\"fl_x\": 500, \"fl_y\": 510, \"cx\": 320, \"cy\": 240, \"w\": 640, \"h\": 480"
#define MATRIX "\"transform_matrix\": [[0,-1,0,1],[-1,0,0,2],[0,0,-1,3],[0,0,0,1]]"
#define FRAME(path) "{\"file_path\": \"" path "\", " MATRIX "}"

static void takes_what_transforms_state(void **state)
{
    struct work *w = *state;
    save(w, "transforms.json", "\xef\xbb\xbf{" LENS ", \"aabb_scale\": 4, \"ply_file_path\": \"c.ply\", "
         "\"train_filenames\": [\"images/a.jpg\", \"./images/d.jpg\"], \"val_filenames\": [\"images/c.jpg\"], "
         "\"test_filenames\": [\"images/b.jpg\"], \"frames\": ["
         "{\"file_path\": \"images/a.jpg\", \"mask_path\": \"masks\\\\a.png\", \"sharpness\": 3, " MATRIX "},"
         FRAME("images/b.jpg") "," FRAME("images/c.jpg") "," FRAME("images/d.jpg") "]}");
    assert_int_equal(read(w, ""), ORL_OK);
    const struct orl_known_picture *pictures = w->known.pictures;
    assert_true(w->known.splits);
    assert_int_equal(pictures[0].split, ORL_KNOWN_TRAIN);
    assert_int_equal(pictures[1].split, ORL_KNOWN_TEST);
    assert_int_equal(pictures[2].split, ORL_KNOWN_UNUSED);
    assert_int_equal(pictures[3].split, ORL_KNOWN_TRAIN);
    assert_string_equal(pictures[0].mask, "masks/a.png");
    assert_null(pictures[1].mask);
    assert_string_equal(w->known.points_file, "c.ply"); // it is not there
    says(w, "not used: aabb_scale, sharpness\n");
    // Where nothing is for testing, what is for validation is held out.
    save(w, "transforms.json", "{" LENS ", \"val_filenames\": [\"b.jpg\"], \"train_filenames\": [\"a.jpg\"], "
         "\"frames\": [" FRAME("a.jpg") "," FRAME("b.jpg") "]}");
    assert_int_equal(read(w, ""), ORL_OK);
    assert_int_equal(w->known.pictures[1].split, ORL_KNOWN_TEST);
    // The last row of a matrix may be missing.
    save(w, "transforms.json", "{" LENS ", \"frames\": [{\"file_path\": \"a.jpg\", \"transform_matrix\": "
         "[[0,-1,0,1],[-1,0,0,2],[0,0,-1,3]]}]}");
    assert_int_equal(read(w, ""), ORL_OK);
    check_pose(w, 0);
}

// Lists of other machines: without extensions, with folders that are not here, with other separators.
static void takes_lists_as_others_write_them(void **state)
{
    struct work *w = *state;
    save(w, "clouds/c.ply", "");
    save(w, "transforms.json", "{" LENS ", \"ply_file_path\": \"D:\\\\set\\\\clouds\\\\c.ply\", "
         "\"train_filenames\": [\"a\", \"images\\\\d.jpg\"], "
         "\"test_filenames\": [\"/home/me/images/b.jpg\"], \"frames\": ["
         FRAME("images/a.jpg") "," FRAME("images/b.jpg") "," FRAME("images/ba.jpg") "," FRAME("./images/d.jpg") "]}");
    assert_int_equal(read(w, ""), ORL_OK);
    static const enum orl_known_split want[] = {ORL_KNOWN_TRAIN, ORL_KNOWN_TEST, ORL_KNOWN_UNUSED,
                                                ORL_KNOWN_TRAIN};
    for (size_t i = 0; i < ORL_COUNT(want); i++)
        assert_int_equal(w->known.pictures[i].split, want[i]);
    assert_non_null(strstr(w->known.points_file, "/clouds/c.ply"));
    save(w, "transforms.json", "{" LENS ", \"test_filenames\": [\"x.jpg\"], \"frames\": ["
         FRAME("images/a.jpg") "]}");
    assert_int_equal(read(w, ""), ORL_OK);
    says(w, "test_filenames has none of the frames");
    save(w, "transforms.json", "{" LENS ", \"train_filenames\": [\"x.jpg\"], \"frames\": ["
         FRAME("images/a.jpg") "]}");
    assert_int_equal(read(w, ""), ORL_ERR_DATA);
    says(w, "train_filenames has none of the frames");
}

// The terms of distortion in one list: k1 k2 k3 k4 p1 p2.
static void takes_distortion_in_a_list(void **state)
{
    struct work *w = *state;
    save(w, "transforms.json", "{" LENS ", \"k1\": 0.9, \"distortion_params\": [0.1, 0.2, 0, 0, 0.3, 0.4], "
         "\"frames\": [" FRAME("a.jpg") "]}");
    assert_int_equal(read(w, ""), ORL_OK);
    check_params(w, 4, (double[]){500, 510, 320, 240, 0.1, 0.2, 0.3, 0.4}, 8);
    save(w, "transforms.json", "{" LENS ", \"camera_model\": \"OPENCV_FISHEYE\", \"frames\": [{\"file_path\": "
         "\"a.jpg\", \"distortion_params\": [0.1, 0.2, 0.3, 0.4, 0, 0], " MATRIX "}]}");
    assert_int_equal(read(w, ""), ORL_OK);
    check_params(w, 5, (double[]){500, 510, 320, 240, 0.1, 0.2, 0.3, 0.4}, 8);
    save(w, "transforms.json", "{" LENS ", \"distortion_params\": [0.1, 0.2], \"frames\": [" FRAME("a.jpg") "]}");
    assert_int_equal(read(w, ""), ORL_ERR_FORMAT);
    says(w, "\"distortion_params\" is not k1 k2 k3 k4 p1 p2");
}

// instant-ngp's keys of lenses that are not flat.
static void refuses_lenses_of_instant_ngp(void **state)
{
    struct work *w = *state;
    save(w, "transforms.json", "{" LENS ", \"equirectangular\": true, \"frames\": [" FRAME("a.jpg") "]}");
    assert_int_equal(read(w, ""), ORL_ERR_FORMAT);
    says(w, "camera 0 (a.jpg): its lens, equirectangular, is not read");
    save(w, "transforms.json", "{" LENS ", \"frames\": [{\"file_path\": \"a.jpg\", \"ftheta_p0\": 0, " MATRIX "}]}");
    assert_int_equal(read(w, ""), ORL_ERR_FORMAT);
    says(w, "camera 0 (a.jpg): its lens, ftheta_p0, is not read");
}

// Processor seconds of the script for frames that are all in a list.
static double seconds_for_lists(struct work *w, int count)
{
    struct rusage before, after;
    FILE *file = test_create(w->dir, "transforms.json");
    fprintf(file, "{" LENS ", \"train_filenames\": [");
    for (int i = 0; i < count; i++)
        fprintf(file, "\"images/%05d.jpg\", ", i);
    fprintf(file, "\"x.jpg\"], \"frames\": [");
    for (int i = 0; i < count; i++)
        fprintf(file, "%s{\"file_path\": \"images/%05d.jpg\", " MATRIX "}", i ? ", " : "", i);
    fprintf(file, "]}");
    assert_int_equal(fclose(file), 0);
    assert_int_equal(getrusage(RUSAGE_CHILDREN, &before), 0);
    assert_int_equal(read(w, "transforms.json"), ORL_OK);
    assert_int_equal(getrusage(RUSAGE_CHILDREN, &after), 0);
    assert_int_equal(w->known.model.image_count, count);
    return (double)(after.ru_utime.tv_sec - before.ru_utime.tv_sec) +
           1e-6 * (double)(after.ru_utime.tv_usec - before.ru_utime.tv_usec);
}

// Eight times as many frames take eight times as long at most, not 64 times.
static void long_lists_take_little_time(void **state)
{
    struct work *w = *state;
    double few = seconds_for_lists(w, 1000), many = seconds_for_lists(w, 8000);
    if (many > 24 * few)
        fail_msg("1000 frames take %.3f s, 8000 take %.3f s", few, many);
}

static void knows_fisheye_lenses_by_all_spellings(void **state)
{
    struct work *w = *state;
    static const char *const spellings[] = {"\"is_fisheye\": true", "\"is_fisheye\": 1", "\"is_fisheye\": \"True\"",
                                            "\"camera_model\": \"opencv_fisheye\""};
    for (size_t i = 0; i < ORL_COUNT(spellings); i++) {
        char text[1024];
        snprintf(text, sizeof text, "{" LENS ", %s, \"k1\": 0.1, \"frames\": [" FRAME("a.jpg") "]}", spellings[i]);
        save(w, "transforms.json", text);
        assert_int_equal(read(w, ""), ORL_OK);
        check_params(w, 5, (double[]){500, 510, 320, 240, 0.1, 0, 0, 0}, 8);
    }
}

static void names_pictures_by_what_tells_them_apart(void **state)
{
    struct work *w = *state;
    save(w, "transforms.json", "{" LENS ", \"frames\": [" FRAME(".\\\\images\\\\a.jpg") ","
         FRAME("images/b.jpg") "]}");
    assert_int_equal(read(w, ""), ORL_OK);
    assert_string_equal(name_of(w, 0), "a.jpg");
    assert_string_equal(w->known.pictures[0].path, "images/a.jpg");
    save(w, "transforms.json", "{" LENS ", \"frames\": [" FRAME("../x/left/a.jpg") ","
         FRAME("../x/right/a.jpg") "]}");
    assert_int_equal(read(w, ""), ORL_OK);
    assert_string_equal(name_of(w, 0), "left/a.jpg");
    assert_string_equal(name_of(w, 1), "right/a.jpg");
    save(w, "transforms.json", "{" LENS ", \"frames\": [" FRAME("a/../../b.jpg") ","
         FRAME("c/b.jpg") "]}");
    assert_int_equal(read(w, ""), ORL_ERR_FORMAT);
    says(w, "leads out of its folder");
    save(w, "transforms.json", "{" LENS ", \"frames\": [" FRAME("a.jpg") "," FRAME("./a.jpg") "]}");
    assert_int_equal(read(w, ""), ORL_ERR_FORMAT);
    says(w, "a.jpg is listed twice");
}

static void reads_blender_sets(void **state)
{
    struct work *w = *state;
    save(w, "transforms_train.json", "{\"camera_angle_x\": 1, \"frames\": [" FRAME("./train/r_0") ","
         FRAME("./train/r_1") "]}");
    save(w, "transforms_val.json", "{\"camera_angle_x\": 1, \"frames\": [" FRAME("./val/r_0") "]}");
    assert_int_equal(read(w, ""), ORL_OK);
    assert_int_equal(w->known.pictures[2].split, ORL_KNOWN_TEST);
    save(w, "transforms_test.json", "{\"camera_angle_x\": 1, \"frames\": [" FRAME("./test/r_0") "]}");
    assert_int_equal(read(w, ""), ORL_OK);
    assert_true(w->known.splits);
    assert_int_equal(w->known.model.image_count, 4);
    assert_string_equal(name_of(w, 0), "test/r_0");
    assert_int_equal(w->known.pictures[2].split, ORL_KNOWN_TEST);
    assert_int_equal(w->known.pictures[3].split, ORL_KNOWN_UNUSED);
    says(w, "Blender's set: 4 cameras");
}

// --- text ---

#define BUNDLER "500 0 0\n0 -1 0\n-1 0 0\n0 0 -1\n2 1 3\n"

static void reads_lists_with_spaces(void **state)
{
    struct work *w = *state;
    save(w, "bundle.out", "# Bundle file v0.3\n4 0\n" BUNDLER BUNDLER BUNDLER BUNDLER);
    save(w, "list.txt", "my photos/a 1.jpg 0 507.25\r\nD:\\my photos\\b 2.jpg\r\nmy photos/c.jpg\n"
                        "my photos/image 4\n");
    assert_int_equal(read(w, ""), ORL_OK);
    assert_string_equal(name_of(w, 0), "a 1.jpg");
    assert_string_equal(name_of(w, 1), "b 2.jpg");
    assert_string_equal(name_of(w, 2), "c.jpg");
    assert_string_equal(name_of(w, 3), "image 4");
    check_pose(w, 0);
    // COLMAP's names of the two files.
    save(w, "colmap/scene.bundle.out", "# Bundle file v0.3\n1 0\n" BUNDLER);
    save(w, "colmap/scene.list.txt", "my photos/d 4.jpg\n");
    assert_int_equal(read(w, "colmap/scene.bundle.out"), ORL_OK);
    assert_string_equal(name_of(w, 0), "d 4.jpg");
}

static void refuses_utf16(void **state)
{
    struct work *w = *state;
    save(w, "transforms.json", "\xff\xfe{");
    assert_int_equal(read(w, ""), ORL_ERR_FORMAT);
    says(w, "is UTF-16: save it as UTF-8");
    save(w, "a_par.txt", "\xfe\xff" "1");
    assert_int_equal(read(w, "a_par.txt"), ORL_ERR_FORMAT);
    says(w, "is UTF-16: save it as UTF-8");
}

// --- programs that calibrate ---

// A rotation by 90 degrees about z: cam_from_world is (x, y) -> (-y, x), so t is (2, -1, -3).
#define SHOT "{\"rotation\": [0, 0, 1.5707963267948966], \"translation\": [2, -1, -3], \"camera\": \"v2\", " \
    "\"gps_dop\": 5}"
#define OPENSFM(camera) "[{\"cameras\": {\"v2\": {" camera ", \"width\": 640, \"height\": 480}}, " \
    "\"shots\": {\"a.jpg\": " SHOT "}, \"points\": {\"7\": {\"coordinates\": [1, 2, 9], " \
    "\"color\": [255, 128, 0]}}}]"

static void reads_opensfm(void **state)
{
    struct work *w = *state;
    save(w, "reconstruction.json", OPENSFM("\"projection_type\": \"brown\", \"focal_x\": 0.78125, "
         "\"focal_y\": 0.796875, \"c_x\": 0.015625, \"c_y\": 0, \"k1\": 0.1, \"k2\": 0.2, \"p1\": 0.3, "
         "\"p2\": 0.4, \"k3\": 0"));
    assert_int_equal(read(w, ""), ORL_OK);
    check_pose(w, 0);
    check_params(w, 4, (double[]){500, 510, 330, 240, 0.1, 0.2, 0.3, 0.4}, 8);
    assert_int_equal(w->known.model.point_count, 1);
    assert_float_equal(w->known.model.points[0].position[2], 9, 0);
    assert_int_equal(w->known.model.points[0].rgb[1], 128);
    says(w, "not used: gps_dop\n");
    save(w, "reconstruction.json", OPENSFM("\"projection_type\": \"fisheye\", \"focal\": 0.5, \"k1\": 0.1"));
    assert_int_equal(read(w, ""), ORL_OK);
    check_params(w, 5, (double[]){320, 320, 320, 240, 0.1, 0, 0, 0}, 8);
    save(w, "reconstruction.json", OPENSFM("\"projection_type\": \"spherical\""));
    assert_int_equal(read(w, ""), ORL_ERR_FORMAT);
    says(w, "camera v2: its projection_type is none of");
    // The largest of several.
    save(w, "reconstruction.json", "[{\"cameras\": {}, \"shots\": {}}, {\"cameras\": {\"v2\": {"
         "\"projection_type\": \"perspective\", \"focal\": 1, \"width\": 480, \"height\": 640}}, \"shots\": "
         "{\"a.jpg\": " SHOT "}}]");
    assert_int_equal(read(w, ""), ORL_OK);
    says(w, "2 reconstructions; taking the largest, with 1");
    check_params(w, 1, (double[]){640, 640, 240, 320}, 4);
}

// The rotation is written column by column.
#define MESHROOM(version, lens) "{\"version\": [" version "], \"views\": [{\"viewId\": \"5\", \"poseId\": " \
    "\"6\", \"intrinsicId\": \"7\", \"path\": \"C:/photos/a.jpg\"}, {\"viewId\": \"8\", \"poseId\": \"9\", " \
    "\"intrinsicId\": \"7\", \"path\": \"C:/photos/b.jpg\"}], \"intrinsics\": [{\"intrinsicId\": \"7\", " \
    "\"width\": \"640\", \"height\": \"480\", " lens "}], \"poses\": [{\"poseId\": \"6\", \"pose\": " \
    "{\"transform\": {\"rotation\": [\"0\", \"1\", \"0\", \"-1\", \"0\", \"0\", \"0\", \"0\", \"1\"], " \
    "\"center\": [\"1\", \"2\", \"3\"]}}, \"locked\": \"0\"}], \"structure\": [{\"landmarkId\": \"1\", \"color\": [\"1\", " \
    "\"2\", \"3\"], \"X\": [\"1\", \"2\", \"9\"], \"observations\": [{\"observationId\": \"5\"}]}]}"

static void reads_meshroom(void **state)
{
    struct work *w = *state;
    save(w, "cameras.sfm", MESHROOM("\"1\", \"2\", \"6\"", "\"type\": \"radial3\", \"focalLength\": \"28.125\", "
         "\"sensorWidth\": \"36\", \"principalPoint\": [\"10\", \"0\"], \"distortionParams\": [\"0.1\", \"0.2\", "
         "\"0\"]"));
    assert_int_equal(read(w, ""), ORL_OK);
    assert_int_equal(w->known.model.image_count, 1);
    says(w, "1 of 2 photographs have no pose: left out");
    says(w, "not used: locked\n");
    check_pose(w, 0);
    check_params(w, 4, (double[]){500, 500, 330, 240, 0.1, 0.2, 0, 0}, 8);
    assert_int_equal(w->known.model.point_count, 1);
    assert_int_equal(w->known.model.images[0].point_count, 1);
    // Earlier versions.
    save(w, "cameras.sfm", MESHROOM("\"1\", \"0\", \"0\"", "\"type\": \"brown\", \"pxFocalLength\": \"500\", "
         "\"principalPoint\": [\"330\", \"240\"], \"distortionParams\": [\"0.1\", \"0.2\", \"0\", \"0.3\", "
         "\"0.4\"]"));
    assert_int_equal(read(w, ""), ORL_OK);
    check_params(w, 4, (double[]){500, 500, 330, 240, 0.1, 0.2, 0.3, 0.4}, 8);
    // "pixelRatio" is fx / fy before 1.2.5, then fy / fx. The focal length is that of x, since 1.2.11 that of y.
    static const struct {
        const char *revision;
        double fx, fy;
    } ratios[] = {{"4", 500, 400}, {"5", 500, 625}, {"10", 500, 625}, {"11", 400, 500}};
    for (size_t i = 0; i < ORL_COUNT(ratios); i++) {
        char text[4096];
        snprintf(text, sizeof text, MESHROOM("\"1\", \"2\", \"%s\"", "\"type\": \"pinhole\", \"focalLength\": "
                 "\"28.125\", \"sensorWidth\": \"36\", \"pixelRatio\": \"1.25\""), ratios[i].revision);
        save(w, "cameras.sfm", text);
        assert_int_equal(read(w, ""), ORL_OK);
        check_params(w, 1, (double[]){ratios[i].fx, ratios[i].fy, 320, 240}, 4);
    }
    save(w, "cameras.sfm", MESHROOM("\"1\", \"2\", \"6\"", "\"type\": \"pinhole\", \"pxFocalLength\": [\"500\", "
         "\"510\"], \"distortionType\": \"3declassicld\""));
    assert_int_equal(read(w, ""), ORL_ERR_FORMAT);
    says(w, "intrinsic 7: its type is none of");
    // Lenses of 1.2.8 and later that are not pinholes, though their distortion is "none".
    save(w, "cameras.sfm", MESHROOM("\"1\", \"2\", \"8\"", "\"type\": \"equidistant\", \"focalLength\": \"28.125\", "
         "\"sensorWidth\": \"36\", \"distortionType\": \"none\", \"undistortionType\": \"none\""));
    assert_int_equal(read(w, ""), ORL_ERR_FORMAT);
    says(w, "intrinsic 7: its type is none of");
    save(w, "cameras.sfm", MESHROOM("\"1\", \"2\", \"8\"", "\"type\": \"pinhole\", \"focalLength\": \"28.125\", "
         "\"sensorWidth\": \"36\", \"distortionType\": \"none\", \"undistortionType\": \"3deanamorphic4\""));
    assert_int_equal(read(w, ""), ORL_ERR_FORMAT);
    says(w, "intrinsic 7: its type is none of");
    save(w, "cameras.sfm", MESHROOM("\"1\", \"2\", \"8\"", "\"type\": \"pinhole\", \"focalLength\": \"28.125\", "
         "\"sensorWidth\": \"36\", \"distortionType\": \"none\", \"undistortionType\": \"none\""));
    assert_int_equal(read(w, ""), ORL_OK);
    check_params(w, 1, (double[]){500, 500, 320, 240}, 4);
}

static void names_openmvg(void **state)
{
    struct work *w = *state;
    save(w, "sfm_data.json", "{\"sfm_data_version\": \"0.3\", \"root_path\": \"\", \"views\": [{\"key\": 0}], "
         "\"intrinsics\": [], \"extrinsics\": []}");
    assert_int_equal(read(w, "sfm_data.json"), ORL_ERR_FORMAT);
    says(w, "sfm_data.json: OpenMVG's cameras are not read: openMVG_main_openMVG2Colmap makes");
}

#define XML_OF(type, sensor, cameras) "<?xml version=\"1.0\"?><document><chunk><sensors>" \
    "<sensor id=\"3\" type=\"frame\"><resolution width=\"640\" height=\"480\"/>" \
    "<calibration class=\"initial\"><f>1</f></calibration>" \
    "<calibration type=\"" type "\" class=\"adjusted\"><f>500</f><cx>10</cx>" sensor \
    "</calibration></sensor></sensors><components><component id=\"1\"><transform><rotation>0 -1 0 1 0 0 0 0 " \
    "1</rotation><translation>5 0 1</translation><scale>2</scale></transform></component></components>" \
    "<cameras><group>" cameras "</group></cameras></chunk></document>"
#define XML(sensor, cameras) XML_OF("frame", sensor, cameras)
// In the component's frame: axes turned back by 90 degrees, and (1, 2, 3) = 2 R (1, 2, 1) + (5, 0, 1).
#define PLACED(attributes) "<camera id=\"0\" sensor_id=\"3\" component_id=\"1\" label=\"a\"" attributes ">" \
    "<transform>-1 0 0 1 0 -1 0 2 0 0 1 1 0 0 0 1</transform></camera>"

static void reads_metashape(void **state)
{
    struct work *w = *state;
    save(w, "cameras.xml", XML("<b1>2</b1><k1>0.1</k1><p1>0.3</p1><p2>0.4</p2>", PLACED("")
         "<camera id=\"1\" sensor_id=\"3\" label=\"b\"/>"));
    assert_int_equal(read(w, ""), ORL_OK);
    assert_int_equal(w->known.model.image_count, 1);
    check_pose(w, 0);
    // p1 and p2 have each other's place in OpenCV's model.
    check_params(w, 4, (double[]){502, 500, 330, 240, 0.1, 0, 0.4, 0.3}, 8);
    says(w, "1 of 2 cameras are not aligned: left out");
    // A fisheye, with the terms that Metashape fits by default, is a thin prism of COLMAP's.
    save(w, "cameras.xml", XML_OF("fisheye", "<k1>0.1</k1><k2>0.2</k2><k3>0.5</k3><k4>0.6</k4>", PLACED("")));
    assert_int_equal(read(w, ""), ORL_OK);
    check_params(w, 5, (double[]){500, 500, 330, 240, 0.1, 0.2, 0.5, 0.6}, 8);
    save(w, "cameras.xml", XML_OF("equidistant_fisheye", "<k1>0.1</k1><k2>0.2</k2><k3>0.5</k3><k4>0.6</k4>"
         "<p1>0.3</p1><p2>0.4</p2>", PLACED("")));
    assert_int_equal(read(w, ""), ORL_OK);
    check_params(w, 10, (double[]){500, 500, 330, 240, 0.1, 0.2, 0.4, 0.3, 0.5, 0.6, 0, 0}, 12);
    save(w, "cameras.xml", XML("", PLACED(" enabled=\"false\"")));
    assert_int_equal(read(w, ""), ORL_ERR_DATA);
    says(w, "1 of 1 cameras are disabled: left out");
    save(w, "cameras.xml", XML("<k4>0.1</k4>", PLACED("")));
    assert_int_equal(read(w, ""), ORL_ERR_FORMAT);
    says(w, "camera a: its calibration has b2, k4, p3 or p4");
    save(w, "cameras.xml", XML("<k1>x</k1>", PLACED("")));
    assert_int_equal(read(w, ""), ORL_ERR_FORMAT);
    save(w, "cameras.xml", "<document>\n<chunk>");
    assert_int_equal(read(w, ""), ORL_ERR_FORMAT);
    says(w, "cameras.xml: line 2 (byte ");
}

#define HEADS "#name,x,y,alt,heading,pitch,roll,f,px,py,k1,k2,k3,k4,t1,t2\n"

// A rotation that RealityCapture wrote both as XMP, cam_from_world, and as angles:
// https://forums.unrealengine.com/t/different-rotation-of-cameras-in-xmp-and-csv/710449
static void reads_realityscan(void **state)
{
    static const double rotation[9] = {0.982594073038806, 0.185426733553445, -0.0112166890261935,
                                       -0.032113633044729, 0.11008102707942, -0.993403685341366,
                                       -0.18296885582437, 0.976472781986697, 0.1141196904};
    struct work *w = *state;
    save(w, "cameras.csv", "#cameras 2\r\n" HEADS
         "a.jpg,1,2,3,163.736597399311,83.4154313461628,174.386496244756,28.125,0.015625,0,0.1,0,0,0,0.3,0\r\n"
         "\"b, c.jpg\",1,2,3,0,0,0,28.125,0,0,0,0,0,0,0,0\r\n");
    assert_int_equal(read(w, ""), ORL_OK);
    assert_string_equal(name_of(w, 1), "b, c.jpg");
    const struct orl_pose *pose = &w->known.model.images[0].cam_from_world;
    double centre[3];
    orl_pose_centre(pose, centre);
    assert_float_equal(centre[1], 2, 1e-9);
    for (int i = 0; i < 9; i++)
        assert_float_equal(pose->r[i / 3][i % 3], rotation[i], 1e-6);
    // 28.125 mm of a picture 36 mm wide, whatever its size: 28.125 / 36 * 640 = 500.
    assert_int_equal(orl_known_camera_settle(NULL, &w->known, 0, "a.jpg", 640, 480), ORL_OK);
    check_params(w, 4, (double[]){500, 500, 330, 240, 0.1, 0, 0.3, 0}, 8);
    // As countries write numbers that have a comma in them.
    save(w, "cameras.csv", "#name;x;y;alt;heading;pitch;roll;f\na.jpg;1,5;2;3;0;0;0;28,125\n");
    assert_int_equal(read(w, ""), ORL_OK);
    orl_pose_centre(&w->known.model.images[0].cam_from_world, centre);
    assert_float_equal(centre[0], 1.5, 1e-9);
    save(w, "cameras.csv", HEADS "a.jpg,1,2,3,0,0,0,28,0,0,0,0,0,0.1,0,0\n");
    assert_int_equal(read(w, ""), ORL_ERR_FORMAT);
    says(w, "line 2 (byte ");
    save(w, "cameras.csv", "#name,x,y,alt\na.jpg,1,2,3\n");
    assert_int_equal(read(w, ""), ORL_ERR_FORMAT);
    says(w, "export \"Internal/External camera parameters\"");
}

static void reads_nvm(void **state)
{
    struct work *w = *state;
    // A quarter turn about z: w x y z.
    save(w, "model.nvm", "NVM_V3\n\n2\nmy photos/a 1.jpg 500 0.7071067811865476 0 0 0.7071067811865476 1 2 3 -0.1 0\n"
         "c\"2.jpg\t500 1 0 0 0 4 2 3 0 0\n\n1\n1 2 9 255 128 0 2 0 5 10 10 1 6 11 11\n\n0\n");
    assert_int_equal(read(w, ""), ORL_OK);
    assert_string_equal(name_of(w, 0), "a 1.jpg");
    assert_string_equal(name_of(w, 1), "c 2.jpg");
    check_pose(w, 0);
    assert_int_equal(orl_known_camera_settle(NULL, &w->known, 0, "a.jpg", 640, 480), ORL_OK);
    // The distortion maps the other way: a point undistorted to u is projected to d, u = d (1 - 0.1 d^2).
    double pixel[2];
    orl_colmap_camera_project(&w->known.model.cameras[0], (double[]){0.4 * (1 - 0.1 * 0.16), 0}, pixel);
    assert_float_equal(pixel[0], 320 + 500 * 0.4, 0.05);
    assert_int_equal(w->known.model.point_count, 1);
    assert_int_equal(w->known.model.points[0].track_length, 2);
    save(w, "model.nvm", "NVM_V3\n2\na.jpg 500 1 0 0 0 1 2 3 0 0\n");
    assert_int_equal(read(w, ""), ORL_ERR_FORMAT);
    says(w, "fewer cameras than the file says");
}

// Axes down, right, backwards.
static void reads_llff(void **state)
{
    struct work *w = *state;
    const double numbers[17] = {1, 0, 0, 1, 480, 0, -1, 0, 2, 640, 0, 0, -1, 3, 500, 1, 9};
    char header[129], data[128 + sizeof numbers] = "\x93NUMPY\1\0\x76", *path;
    snprintf(header, sizeof header, "%-117s\n", "{'descr': '<f8', 'fortran_order': False, 'shape': (1, 17), }");
    memcpy(data + 10, header, 118);
    memcpy(data + 128, numbers, sizeof numbers);
    path = test_path(w->dir, "poses_bounds.npy");
    assert_int_equal(orl_file_write(NULL, path, data, sizeof data), ORL_OK);
    assert_int_equal(read(w, ""), ORL_ERR_NOT_FOUND);
    says(w, "its pictures must be in");
    save(w, "images/a.jpg", "");
    assert_int_equal(read(w, ""), ORL_OK);
    assert_string_equal(name_of(w, 0), "a.jpg");
    check_pose(w, 0);
    check_params(w, 1, (double[]){500, 500, 320, 240}, 4);
    save(w, "images/b.jpg", "");
    assert_int_equal(read(w, ""), ORL_ERR_DATA);
    says(w, "1 cameras, but images/ has 2 files");
    assert_int_equal(orl_file_write(NULL, path, data, sizeof data - 1), ORL_OK);
    assert_int_equal(read(w, ""), ORL_ERR_FORMAT);
    free(path);
}

#define PHONE "{\"fx\": 500, \"fy\": 510, \"cx\": 330, \"cy\": 240, \"width\": 640, \"height\": 480, " \
    "\"t_00\": 0, \"t_01\": -1, \"t_02\": 0, \"t_03\": 1, \"t_10\": -1, \"t_11\": 0, \"t_12\": 0, " \
    "\"t_13\": 2, \"t_20\": 0, \"t_21\": 0, \"t_22\": -1, \"t_23\": 3, " \
    "\"blur_score\": 90}"

static void reads_telephones(void **state)
{
    struct work *w = *state;
    save(w, "keyframes/cameras/123.json", PHONE);
    assert_int_equal(read(w, ""), ORL_OK);
    says(w, "Polycam: 1 cameras");
    says(w, "not used: blur_score\n");
    assert_string_equal(w->known.pictures[0].path, "keyframes/images/123");
    check_pose(w, 0);
    check_params(w, 1, (double[]){500, 510, 330, 240}, 4);
    save(w, "keyframes/corrected_cameras/124.json", PHONE);
    assert_int_equal(read(w, ""), ORL_OK);
    assert_string_equal(w->known.pictures[0].path, "keyframes/corrected_images/124");
    // x y z w of the same pose with OpenGL's axes: half a turn about x - y.
    save(w, "r3d/metadata.json", "{\"poses\": [[0.7071067811865476, -0.7071067811865476, 0, 0, 1, 2, 3]], \"K\": "
         "[500, 0, 0, 0, 510, 0, 330, 240, 1], \"w\": 640, \"h\": 480, \"fps\": 30}");
    assert_int_equal(read(w, "r3d"), ORL_OK);
    assert_string_equal(w->known.pictures[0].path, "rgbd/0");
    check_pose(w, 0);
    check_params(w, 1, (double[]){500, 510, 330, 240}, 4);
    says(w, "not used: fps");
}

// --- far away ---

static void takes_a_far_origin_off(void **state)
{
    struct work *w = *state;
    // Cameras at (512345, 40, 5412345) and two and four units beside it, as a survey's.
    save(w, "cameras.json", "{\"pixel_centre\": 0.5, \"room\": [[512340, 0, 5412340], [512350, 99, 5412350]], "
         "\"cameras\": ["
#define AT(name, x) "{\"name\": \"" name "\", \"width\": 640, \"height\": 480, \"K\": [[500,0,320],[0,510,240]," \
    "[0,0,1]], \"R\": [[1,0,0],[0,1,0],[0,0,1]], \"t\": [" x ", -40, -5412345]}"
         AT("a", "-512343.125") "," AT("b", "-512345") "," AT("c", "-512349.5") "]}");
    assert_int_equal(read(w, ""), ORL_OK);
    says(w, "the cameras are far from 0");
    const double *o = w->known.origin;
    assert_true(fabs(o[0] - 512345) < 2 && fabs(o[2] - 5412345) < 2);
    double centre[3];
    orl_pose_centre(&w->known.model.images[0].cam_from_world, centre);
    assert_float_equal(centre[0] + o[0], 512343.125, 1e-6);
    assert_true(fabs(centre[0]) < 10 && fabs(centre[2]) < 10);
    assert_float_equal(w->known.room.low[2] + o[2], 5412340, 1e-6);
    assert_true(fabs(w->known.room.low[2]) < 100);
    // Cameras near 0 keep their coordinates.
    save(w, "cameras.json", "{\"cameras\": [" AT("a", "0") "," AT("b", "-90000") "]}");
    assert_int_equal(read(w, ""), ORL_OK);
    assert_true(w->known.origin[2] == 0);
    save(w, "cameras.json", "{\"cameras\": [{\"name\": \"a\", \"width\": 640, \"height\": 480, \"K\": "
         "[[500,0,320],[0,510,240],[0,0,1]], \"R\": [[1,0,0],[0,1,0],[0,0,1]], \"t\": [0,0,0]}]}");
    assert_int_equal(read(w, ""), ORL_OK);
    assert_true(w->known.origin[0] == 0);
}

// Clouds and meshes lose nothing of it, either.
static void reads_far_points_and_meshes(void **state)
{
    struct work *w = *state;
    const double origin[3] = {512345, 0, 5412345};
    struct orl_points points;
    struct orl_mesh mesh;
    save(w, "far.ply", "ply\nformat ascii 1.0\nelement vertex 3\nproperty double x\nproperty double y\n"
         "property double z\nelement face 1\nproperty list uchar int vertex_indices\nend_header\n"
         "512345.125 1 5412345.25\n512346 2 5412345\n512345 3 5412346\n3 0 1 2\n");
    save(w, "far.obj", "v 512345.125 1 5412345.25\nv 512346 2 5412345\nv 512345 3 5412346\nf 1 2 3\n");
    save(w, "coarse.ply", "ply\nformat ascii 1.0\nelement vertex 1\nproperty float x\nproperty float y\n"
         "property float z\nend_header\n512345.125 1 5412345.25\n");
    char *cloud = test_path(w->dir, "far.ply"), *obj = test_path(w->dir, "far.obj");
    char *coarse = test_path(w->dir, "coarse.ply");
    assert_int_equal(orl_points_read(NULL, cloud, origin, &points), ORL_OK);
    assert_float_equal(points.position[0][0], 0.125, 0);
    assert_float_equal(points.position[0][2], 0.25, 0);
    orl_points_finish(&points);
    const char *const meshes[] = {cloud, obj};
    for (int i = 0; i < 2; i++) {
        assert_int_equal(orl_mesh_read(NULL, meshes[i], origin, &mesh), ORL_OK);
        assert_float_equal(mesh.position[0][0], 0.125, 0);
        assert_float_equal(mesh.position[0][2], 0.25, 0);
        orl_mesh_finish(&mesh);
    }
    assert_int_equal(orl_points_read(&w->log, coarse, origin, &points), ORL_OK);
    says(w, "32-bit floats, which are too coarse");
    orl_points_finish(&points);
    free(cloud);
    free(obj);
    free(coarse);
}

static void lists_formats(void **state)
{
    (void)state;
    char *text = orl_known_formats_text(NULL);
    assert_non_null(strstr(text, "COLMAP"));
    assert_non_null(strstr(text, "reconstruction.json"));
    free(text);
}

int main(void)
{
#define TEST(f) cmocka_unit_test_setup_teardown(f, set_up, tear_down)
    const struct CMUnitTest tests[] = {
        TEST(takes_the_largest_model), TEST(finds_models_in_other_folders), TEST(takes_lists_as_others_write_them),
        TEST(takes_distortion_in_a_list), TEST(refuses_lenses_of_instant_ngp), TEST(long_lists_take_little_time),
        TEST(knows_fisheye_lenses_by_all_spellings), TEST(reads_models_without_points), TEST(reads_images_of_one_line),
        TEST(reads_names_of_other_systems), TEST(takes_what_transforms_state),
        TEST(names_pictures_by_what_tells_them_apart), TEST(reads_blender_sets),
        TEST(reads_lists_with_spaces), TEST(refuses_utf16), TEST(reads_opensfm),
        TEST(reads_meshroom), TEST(names_openmvg), TEST(reads_metashape), TEST(reads_realityscan), TEST(reads_nvm),
        TEST(reads_llff), TEST(reads_telephones),
        TEST(takes_a_far_origin_off), TEST(reads_far_points_and_meshes), TEST(lists_formats),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
