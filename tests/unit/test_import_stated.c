// What a file of cameras states besides cameras is in the imported scene: masks, alpha, held-out
// photographs, a cloud, a far origin; and pictures that are missing or broken are left out with a word.
#include <math.h>
#include <png.h>
#include <string.h>
#include <unistd.h>

#include "core/json.h"
#include "exchange/export.h"
#include "io/picture.h"
#include "oriel/path.h"
#include "oriel/scene.h"
#include "preprocess/import.h"
#include "scene/mesh.h"
#include "test.h"

enum { W = 64, H = 48 };

struct work {
    char *dir, *out;
    struct said said;
    struct orl_log log;
    struct orl_scene *scene;
};

static int set_up(void **state)
{
    struct work *w = calloc(1, sizeof *w);
    w->dir = test_dir_make();
    w->out = test_path(w->dir, "scene");
    w->log = log_to(&w->said);
    *state = w;
    return 0;
}

static int tear_down(void **state)
{
    struct work *w = *state;
    orl_scene_destroy(&w->scene);
    free(w->out);
    test_dir_remove(w->dir);
    free(w);
    return 0;
}

static char *place(const struct work *w, const char *name)
{
    char *path = test_path(w->dir, name);
    assert_int_equal(orl_file_make_folder(NULL, path), ORL_OK);
    return path;
}

static void save(const struct work *w, const char *name, const char *text)
{
    char *path = place(w, name);
    assert_int_equal(orl_file_write(NULL, path, text, strlen(text)), ORL_OK);
    free(path);
}

// A picture of (200, 100, 50); with `alpha`, the right half is transparent and green below, and column
// 31 is half transparent.
static void save_picture(const struct work *w, const char *name, bool alpha)
{
    static uint8_t pixels[W * H * 4];
    char *path = place(w, name);
    png_image image = {.version = PNG_IMAGE_VERSION, .width = W, .height = H,
                       .format = alpha ? PNG_FORMAT_RGBA : PNG_FORMAT_RGB};
    size_t channels = alpha ? 4 : 3;
    for (size_t i = 0; i < W * H; i++) {
        size_t x = i % W;
        const uint8_t left[4] = {200, 100, 50, x == 31 ? 128 : 255}, right[4] = {0, 255, 0, 0};
        memcpy(pixels + channels * i, alpha && x > 31 ? right : left, channels);
    }
    assert_int_equal(png_image_write_to_file(&image, path, 0, pixels, 0, NULL), 1);
    free(path);
}

// A mask that is white on the right half.
static void save_mask(const struct work *w, const char *name)
{
    struct orl_image mask;
    char *path = place(w, name);
    assert_int_equal(orl_image_init(NULL, &mask, W, H, 1, ORL_PIXEL_U8), ORL_OK);
    for (size_t i = 0; i < W * H; i++)
        mask.u8[i] = i % W >= W / 2 ? 255 : 0;
    assert_int_equal(orl_png_write(NULL, path, &mask), ORL_OK);
    orl_image_finish(&mask);
    free(path);
}

#define LENS "\"fl_x\": 60, \"w\": 64, \"h\": 48"
#define FRAME(path, x, more) "{\"file_path\": \"" path "\", " more "\"transform_matrix\": [[1,0,0," x "]," \
    "[0,1,0,0],[0,0,1,0],[0,0,0,1]]}"

static enum orl_result import(struct work *w, const struct orl_import_params *wanted)
{
    struct orl_import_params params = {ORL_IMPORT_DEFAULTS};
    if (wanted)
        params = *wanted;
    params.cameras = w->dir;
    params.out = w->out;
    w->log = log_to(&w->said);
    enum orl_result result = orl_import(&w->log, &params, NULL);
    if (result == ORL_OK)
        assert_int_equal(orl_scene_open(NULL, w->out, &w->scene), ORL_OK);
    return result;
}

static void says(const struct work *w, const char *what)
{
    if (!strstr(w->said.text, what))
        fail_msg("\"%s\" does not say \"%s\"", w->said.text, what);
}

static void check_pixel(const char *path, int channels, int x, const uint8_t *want)
{
    struct orl_image image;
    assert_int_equal(orl_picture_read(NULL, path, channels, &image), ORL_OK);
    for (int c = 0; c < channels; c++)
        assert_int_equal(image.u8[channels * (W * 20 + x) + c], want[c]);
    orl_image_finish(&image);
}

static void takes_masks(void **state)
{
    struct work *w = *state;
    save_picture(w, "images/a.png", false);
    save_picture(w, "images/b.png", false);
    save_picture(w, "images/c.png", false);
    save_mask(w, "masks/a.png");
    save(w, "transforms.json", "{" LENS ", \"frames\": ["
         FRAME("images/a.png", "0", "\"mask_path\": \"masks/a.png\", ") ","
         FRAME("images/b.png", "1", "\"mask_path\": \"masks/gone.png\", ") ","
         FRAME("images/c.png", "2", "\"mask_path\": \"C:\\\\set\\\\masks\\\\a.png\", ") "]}");
    assert_int_equal(import(w, NULL), ORL_OK);
    assert_true(w->scene->photos[0].masked);
    assert_true(!w->scene->photos[1].masked && w->scene->photos[2].masked);
    says(w, "masks of 1 of 3 cameras, which their file names, are not here");
    char *mask = strdup(orl_scene_file(w->scene, 0, ORL_FILE_MASK).text);
    check_pixel(mask, 1, 10, (uint8_t[]){0});
    check_pixel(mask, 1, 50, (uint8_t[]){255});
    free(mask);
}

// The colours under transparent pixels mean nothing, and edges are mixed with white.
static void lays_alpha_on_white(void **state)
{
    struct work *w = *state;
    save_picture(w, "train/r_0.png", true);
    save_picture(w, "train/r_1.png", true);
    save_picture(w, "test/r_0.png", true);
    save_picture(w, "val/r_0.png", true);
    save(w, "transforms_train.json", "{" LENS ", \"frames\": [" FRAME("./train/r_0", "0", "") ","
         FRAME("./train/r_1", "1", "") "]}");
    save(w, "transforms_test.json", "{" LENS ", \"frames\": [" FRAME("./test/r_0", "2", "") "]}");
    save(w, "transforms_val.json", "{" LENS ", \"frames\": [" FRAME("./val/r_0", "3", "") "]}");
    assert_int_equal(import(w, NULL), ORL_OK);
    assert_int_equal(w->scene->photo_count, 3);
    assert_string_equal(w->scene->photos[0].name, "test/r_0.png");
    assert_true(w->scene->photos[0].test && !w->scene->photos[1].test);
    says(w, "3 of 3 photographs have alpha");
    says(w, "1 of 4 photographs are neither for training nor for testing");
    char *photo = strdup(orl_scene_file(w->scene, 1, ORL_FILE_PHOTO).text);
    char *mask = strdup(orl_scene_file(w->scene, 1, ORL_FILE_MASK).text);
    check_pixel(photo, 3, 10, (uint8_t[]){200, 100, 50});
    check_pixel(photo, 3, 31, (uint8_t[]){227, 177, 152});
    check_pixel(photo, 3, 50, (uint8_t[]){255, 255, 255});
    check_pixel(mask, 1, 10, (uint8_t[]){255});
    check_pixel(mask, 1, 50, (uint8_t[]){0});
    free(photo);
    free(mask);
}

static void takes_the_stated_split_and_cloud(void **state)
{
    struct work *w = *state;
    static const char *const names[] = {"images/a.png", "images/b.png", "images/c.png"};
    for (int i = 0; i < 3; i++)
        save_picture(w, names[i], false);
    save(w, "c.ply", "ply\nformat ascii 1.0\nelement vertex 1\nproperty double x\nproperty double y\n"
         "property double z\nproperty float radius\nend_header\n0 0 -5 0.1\n");
    save(w, "transforms.json", "{" LENS ", \"ply_file_path\": \"c.ply\", \"train_filenames\": [\"images/a.png\", "
         "\"images/c.png\"], \"test_filenames\": [\"images/b.png\"], \"frames\": [" FRAME("images/a.png", "0", "")
         "," FRAME("images/b.png", "1", "") "," FRAME("images/c.png", "2", "") "]}");
    assert_int_equal(import(w, NULL), ORL_OK);
    assert_true(w->scene->photos[1].test && !w->scene->photos[0].test);
    assert_int_equal(w->scene->points.count, 1);
    // What the user says counts more.
    orl_scene_destroy(&w->scene);
    assert_int_equal(orl_dir_remove(NULL, w->out), ORL_OK);
    struct orl_names first = {0};
    assert_int_equal(orl_names_add(NULL, &first, "a.png"), ORL_OK);
    assert_int_equal(import(w, &(struct orl_import_params){ORL_IMPORT_DEFAULTS, .test_list = &first,
                                                           .points = ORL_IMPORT_NO_POINTS}), ORL_OK);
    assert_true(w->scene->photos[0].test && !w->scene->photos[1].test);
    assert_int_equal(w->scene->points.count, 0);
    orl_names_finish(&first);
}

static void says_what_is_too_wide_for_a_flat_picture(void **state)
{
    struct work *w = *state;
    save_picture(w, "images/a.png", false);
    save_picture(w, "images/b.png", false);
    // 64 pixels at 18 a radian are 204 degrees.
    save(w, "transforms.json", "{\"fl_x\": 18, \"w\": 64, \"h\": 48, \"is_fisheye\": true, \"frames\": ["
         FRAME("images/a.png", "0", "") "," FRAME("images/b.png", "1", "") "]}");
    assert_int_equal(import(w, NULL), ORL_OK);
    says(w, "a.png: its flat picture keeps 73 % of its width");
}

// Programs that count it from the middle, or in shares of the picture.
static void doubts_a_principal_point_in_a_corner(void **state)
{
    struct work *w = *state;
    save_picture(w, "images/a.png", false);
    save_picture(w, "images/b.png", false);
    save(w, "transforms.json", "{" LENS ", \"cx\": 0.5, \"cy\": 0.5, \"frames\": [" FRAME("images/a.png", "0", "")
         "," FRAME("images/b.png", "1", "") "]}");
    assert_int_equal(import(w, NULL), ORL_OK);
    says(w, "a.png: the principal point of its camera, 0.5, 0.5, is at a corner");
}

static void leaves_out_what_is_no_picture(void **state)
{
    struct work *w = *state;
    save_picture(w, "images/a.png", false);
    save_picture(w, "images/b.png", false);
    save(w, "images/c.png", "");
    save(w, "images/d.png", "<html>not found</html>");
    save(w, "transforms.json", "{" LENS ", \"frames\": [" FRAME("images/a.png", "0", "") ","
         FRAME("images/b.png", "1", "") "," FRAME("images/c.png", "2", "") "," FRAME("images/d.png", "3", "") ","
         FRAME("images/e.png", "4", "") "]}");
    char *nowhere = place(w, "images/e.png");
    assert_int_equal(symlink("gone.png", nowhere), 0);
    free(nowhere);
    assert_int_equal(import(w, NULL), ORL_OK);
    assert_int_equal(w->scene->photo_count, 2);
    says(w, "no picture for 1 of 5 cameras, as e.png: left out");
    says(w, "c.png: not a picture that can be read: left out");
    says(w, "d.png: not a picture that can be read: left out");
}

// Pictures with equal names in two folders, and one that lies where its name alone says.
static void finds_pictures_in_folders(void **state)
{
    struct work *w = *state;
    save_picture(w, "images/left/a.png", false);
    save_picture(w, "images/right/a.png", true);
    save(w, "transforms.json", "{" LENS ", \"frames\": [" FRAME("images\\\\left\\\\a.png", "0", "") ","
         FRAME("images\\\\right\\\\a.png", "1", "") "]}");
    assert_int_equal(import(w, NULL), ORL_OK);
    assert_string_equal(w->scene->photos[1].name, "right/a.png");
    assert_true(w->scene->photos[1].masked && !w->scene->photos[0].masked);
}

// The folder of one model is given: its pictures are beside sparse/.
static void finds_the_pictures_of_a_model(void **state)
{
    struct work *w = *state;
    save_picture(w, "images/a.png", false);
    save_picture(w, "images/b.png", false);
    save(w, "sparse/0/cameras.txt", "7 PINHOLE 64 48 60 60 32 24\n");
    save(w, "sparse/0/images.txt", "1 1 0 0 0 0 0 4 7 a.png\n2 1 0 0 0 1 0 4 7 b.png\n");
    char *model = test_path(w->dir, "sparse/0");
    assert_int_equal(orl_import(NULL, &(struct orl_import_params){ORL_IMPORT_DEFAULTS, .cameras = model,
                                                                  .out = w->out}, NULL), ORL_OK);
    free(model);
}

// A COLMAP workspace brings its fused cloud; where nothing is left to draw, import says what helps.
static void takes_the_cloud_of_a_workspace(void **state)
{
    struct work *w = *state;
    save_picture(w, "images/a.png", false);
    save_picture(w, "images/b.png", false);
    save(w, "sparse/0/cameras.txt", "7 PINHOLE 64 48 60 60 32 24\n");
    save(w, "sparse/0/images.txt", "1 1 0 0 0 0 0 4 7 a.png\n2 1 0 0 0 1 0 4 7 b.png\n");
    assert_int_equal(import(w, NULL), ORL_OK);
    assert_int_equal(w->scene->points.count, 0);
    says(w, "neither points nor a mesh nor silhouettes");
    says(w, "--points densify");
    says(w, "--points FILE");
    orl_scene_destroy(&w->scene);
    assert_int_equal(orl_dir_remove(NULL, w->out), ORL_OK);
    save(w, "fused.ply", "ply\nformat ascii 1.0\nelement vertex 4\nproperty float x\nproperty float y\n"
         "property float z\nend_header\n0 0 0\n0.1 0 0\n0 0.1 0\n0.1 0.1 0\n");
    assert_int_equal(import(w, NULL), ORL_OK);
    assert_int_equal(w->scene->points.count, 4);
    assert_true(w->scene->points.radius[0] > 0);
    assert_null(strstr(w->said.text, "neither points"));
    orl_scene_destroy(&w->scene);
    assert_int_equal(orl_dir_remove(NULL, w->out), ORL_OK);
    assert_int_equal(import(w, &(struct orl_import_params){ORL_IMPORT_DEFAULTS, .points = ORL_IMPORT_NO_POINTS}), ORL_OK);
    assert_int_equal(w->scene->points.count, 0);
}

// Alpha means the same whatever the cameras' format, and a folder of masks that nobody names is told of.
static void takes_alpha_of_any_format(void **state)
{
    struct work *w = *state;
    save_picture(w, "images/a.png", true);
    save_picture(w, "images/b.png", false);
    save(w, "sparse/0/cameras.txt", "7 PINHOLE 64 48 60 60 32 24\n");
    save(w, "sparse/0/images.txt", "1 1 0 0 0 0 0 4 7 a.png\n2 1 0 0 0 1 0 4 7 b.png\n");
    assert_int_equal(import(w, NULL), ORL_OK);
    assert_true(w->scene->photos[0].masked && !w->scene->photos[1].masked);
    orl_scene_destroy(&w->scene);
    assert_int_equal(orl_dir_remove(NULL, w->out), ORL_OK);
    save_picture(w, "images/a.png", false);
    save_mask(w, "masks/a.png");
    assert_int_equal(import(w, NULL), ORL_OK);
    assert_false(w->scene->photos[0].masked);
    says(w, "masks is not used: --masks names a folder of masks");
}

// The folder of pictures is named otherwise, and another system has changed capitals.
static void finds_pictures_by_other_names(void **state)
{
    struct work *w = *state;
    save_picture(w, "extra/notes/a.png", false);
    save_picture(w, "input/IMG_a.PNG", false);
    save_picture(w, "input/img_b.png", false);
    save(w, "sparse/0/cameras.txt", "7 PINHOLE 64 48 60 60 32 24\n");
    save(w, "sparse/0/images.txt", "1 1 0 0 0 0 0 4 7 img_A.jpg\n2 1 0 0 0 1 0 4 7 img_b.JPG\n");
    assert_int_equal(import(w, NULL), ORL_OK);
    assert_int_equal(w->scene->photo_count, 2);
    assert_string_equal(w->scene->photos[0].name, "IMG_a.PNG");
}

// Cameras, cloud, mesh and room of a survey lose nothing, and a path in its coordinates fits.
static void keeps_a_far_origin(void **state)
{
    struct work *w = *state;
    save_picture(w, "images/a.png", false);
    save_picture(w, "images/b.png", false);
    save(w, "c.ply", "ply\nformat ascii 1.0\nelement vertex 3\nproperty double x\nproperty double y\n"
         "property double z\nproperty float radius\nelement face 1\nproperty list uchar int vertex_indices\n"
         "end_header\n512345.125 0.25 5412340 0.1\n512346 0 5412340 0.1\n512345 1 5412340 0.1\n3 0 1 2\n");
    save(w, "transforms.json", "{" LENS ", \"ply_file_path\": \"c.ply\", \"frames\": ["
#define FAR(path, x) "{\"file_path\": \"" path "\", \"transform_matrix\": [[1,0,0," x "],[0,1,0,0],[0,0,1,5412345]," \
    "[0,0,0,1]]}"
         FAR("images/a.png", "512345") "," FAR("images/b.png", "512347.5") "]}");
    save(w, "path/images.txt", "1 1 0 0 0 -512346 0 -5412345 1 view\n\n");
    char *mesh_path = test_path(w->dir, "c.ply"), *path_file = test_path(w->dir, "path/images.txt");
    assert_int_equal(import(w, &(struct orl_import_params){
                         ORL_IMPORT_DEFAULTS, .mesh = mesh_path,
                         .room = {{512340, -1, 5412330}, {512350, 3, 5412350}, true}}), ORL_OK);
    const double *o = w->scene->origin;
    assert_true(o[0] > 512000 && o[2] > 5412000);
    assert_float_equal(w->scene->points.position[0][0] + o[0], 512345.125, 1e-6);
    assert_float_equal(w->scene->room.low[2] + o[2], 5412330, 1e-6);
    double centre[3];
    orl_pose_centre(&w->scene->photos[1].view.cam_from_world, centre);
    assert_float_equal(centre[0] + o[0], 512347.5, 1e-6);
    assert_true(fabs(centre[0]) < 100 && fabs(centre[2]) < 100);
    struct orl_mesh mesh;
    char *made = strdup(orl_scene_mesh_path(w->scene).text);
    assert_int_equal(orl_mesh_read(NULL, made, NULL, &mesh), ORL_OK);
    assert_float_equal(mesh.position[0][0] + o[0], 512345.125, 1e-6);
    orl_mesh_finish(&mesh);
    struct orl_path path;
    assert_int_equal(orl_path_read(NULL, w->scene, path_file, &path), ORL_OK);
    orl_pose_centre(&path.views[0].cam_from_world, centre);
    assert_float_equal(centre[0] + o[0], 512346, 1e-6);
    orl_path_finish(&path);
    // The exported points and cameras are where they were.
    for (const struct orl_export_kind *kind = orl_export_kinds; kind->name; kind++) {
        bool folder = strcmp(kind->name, "nerfstudio") == 0;
        if (!folder && strcmp(kind->name, "ply") != 0)
            continue;
        char *out = test_path(w->dir, kind->name);
        char *cloud = folder ? test_path(out, "points.ply") : test_path(w->dir, kind->name);
        struct orl_points points;
        assert_int_equal(kind->write(NULL, NULL, w->scene, &(struct orl_export_params){.out = out}),
                         ORL_OK);
        assert_int_equal(orl_points_read(NULL, cloud, (double[3]){512345, 0, 5412345}, &points),
                         ORL_OK);
        assert_float_equal(points.position[0][0], 0.125, 1e-6);
        assert_float_equal(points.position[0][2], -5, 1e-6);
        orl_points_finish(&points);
        free(cloud);
        free(out);
    }
    char *transforms = test_path(w->dir, "nerfstudio/transforms.json");
    json_t *root = json_load_file(transforms, 0, NULL);
    json_t *matrix = json_object_get(json_array_get(json_object_get(root, "frames"), 1), "transform_matrix");
    assert_float_equal(json_number_value(json_array_get(json_array_get(matrix, 0), 3)), 512347.5, 1e-6);
    json_decref(root);
    free(transforms);
    free(made);
    free(mesh_path);
    free(path_file);
}

int main(void)
{
#define TEST(f) cmocka_unit_test_setup_teardown(f, set_up, tear_down)
    const struct CMUnitTest tests[] = {
        TEST(takes_masks), TEST(lays_alpha_on_white), TEST(takes_the_stated_split_and_cloud),
        TEST(says_what_is_too_wide_for_a_flat_picture), TEST(doubts_a_principal_point_in_a_corner),
        TEST(leaves_out_what_is_no_picture), TEST(finds_pictures_in_folders), TEST(keeps_a_far_origin), TEST(finds_the_pictures_of_a_model),
        TEST(finds_pictures_by_other_names), TEST(takes_alpha_of_any_format),
        TEST(takes_the_cloud_of_a_workspace),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
