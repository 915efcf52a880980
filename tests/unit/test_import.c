// Import: a figure's set becomes a scene, with and without distortion, and what is refused.
#include <math.h>
#include <string.h>
#include <unistd.h>

#include "datasets/figures.h"
#include "io/picture.h"
#include "mesh_help.h"
#include "preprocess/import.h"
#include "preprocess/import/import_internal.h"
#include "oriel/scene.h"
#include "render/photos/photo_loader.h"
#include "io/exr.h"
#include "scene/silhouette.h"
#include "test.h"

// A moving figure, made once: work/set, for scenes in work/NAME.
struct work {
    char *dir, *set, *cameras, *images, *masks, *background;
};

static char *join(const char *dir, const char *name)
{
    char *path = orl_path_join(NULL, dir, name);
    assert_non_null(path);
    return path;
}

static int set_up(void **state)
{
    struct work *w = calloc(1, sizeof *w);
    const struct orl_figures_params params = {.cameras = 4, .frames = 3, .width = 80,
                                              .height = 60};
    w->dir = test_dir_make();
    w->set = join(w->dir, "set");
    w->cameras = join(w->set, "cameras.json");
    w->images = join(w->set, "images");
    w->masks = join(w->set, "masks");
    w->background = join(w->set, "background");
    *state = w;
    return orl_figures_run(NULL, NULL, &params, w->set) == ORL_OK ? 0 : -1;
}

static int tear_down(void **state)
{
    struct work *w = *state;
    free(w->set);
    free(w->cameras);
    free(w->images);
    free(w->masks);
    free(w->background);
    test_dir_remove(w->dir);
    free(w);
    return 0;
}

static struct orl_image picture(const char *path, int channels)
{
    struct orl_image image;
    assert_int_equal(orl_picture_read(NULL, path, channels, &image), ORL_OK);
    return image;
}

static void check_same_picture(const char *a, const char *b, int channels, int tolerance)
{
    struct orl_image x = picture(a, channels), y = picture(b, channels);
    assert_int_equal(x.width, y.width);
    for (size_t i = 0; i < orl_image_bytes(&x); i++)
        assert_between(x.u8[i] + 255 - y.u8[i], 255 - tolerance, 255 + tolerance);
    orl_image_finish(&x);
    orl_image_finish(&y);
}

// The silhouette of photograph `photo` has about the pixels of the true one.
static void check_mask(const struct orl_scene *scene, size_t photo, const char *truth)
{
    char *path = strdup(orl_scene_file(scene, photo, ORL_FILE_MASK).text);
    struct orl_image mask = picture(path, 1), exact = picture(truth, 1);
    size_t both = 0, any = 0;
    for (size_t i = 0; i < orl_image_bytes(&mask); i++) {
        assert_true(mask.u8[i] == ORL_ALPHA_OUT || mask.u8[i] == ORL_ALPHA_EDGE ||
                    mask.u8[i] == ORL_ALPHA_IN);
        both += mask.u8[i] && exact.u8[i];
        any += mask.u8[i] || exact.u8[i];
    }
    assert_true(any > 100 && (double)both > 0.8 * (double)any);
    orl_image_finish(&mask);
    orl_image_finish(&exact);
    free(path);
}

static void imports_sequences(void **state)
{
    const struct work *w = *state;
    char *out = join(w->dir, "sequence"), *truth;
    struct orl_names test = {0};
    assert_int_equal(orl_names_add(NULL, &test, "cam02"), ORL_OK);
    const struct orl_import_params params = {
        .cameras = w->set, .out = out, ORL_IMPORT_DEFAULTS, .silhouettes = ORL_SILHOUETTES_GIVEN,
        .masks_dir = w->masks, .background = w->background, .test_list = &test, .hull_side = 48,
        .hull_triangles = 2000};
    assert_int_equal(orl_import(NULL, &params, NULL), ORL_OK);
    struct orl_scene *scene;
    assert_int_equal(orl_scene_open(NULL, out, &scene), ORL_OK);
    assert_int_equal(scene->photo_count, 4);
    assert_string_equal(scene->photos[2].name, "cam02.jpg");
    assert_true(scene->photos[2].test && !scene->photos[0].test);
    assert_int_equal(scene->points.count, 0); // a scene may have none
    assert_float_equal(scene->photo_distance, 3.2, 0.4);
    assert_int_equal(scene->frame_count, 3);
    assert_int_equal(scene->frame, -1);
    for (int frame = -1; frame < 3; frame++) {
        char name[64];
        assert_int_equal(orl_scene_set_frame(NULL, scene, frame), ORL_OK);
        snprintf(name, sizeof name, "cam01/%05d.png", frame < 0 ? 0 : frame);
        char *photo = strdup(orl_scene_file(scene, 1, ORL_FILE_PHOTO).text);
        truth = join(w->images, name);
        check_same_picture(photo, truth, 3, 40); // JPEG of small cells
        free(truth);
        free(photo);
        truth = join(w->masks, name);
        check_mask(scene, 1, truth);
        free(truth);
    }
    struct said said;
    struct orl_log log = log_to(&said);
    assert_int_equal(orl_scene_set_frame(&log, scene, 3), ORL_ERR_ARGUMENT);
    assert_non_null(strstr(said.text, "no time step 3: there are 3"));
    // A photograph that is missing leaves the time step as it was.
    char *gone = join(out, "frames/00001/images/cam03.jpg");
    assert_int_equal(unlink(gone), 0);
    assert_int_equal(orl_scene_set_frame(&log, scene, 1), ORL_ERR_NOT_FOUND);
    assert_int_equal(scene->frame, 2);
    free(gone);
    char *background = strdup(orl_scene_file(scene, 1, ORL_FILE_BACKGROUND).text);
    truth = join(w->background, "cam01.png");
    check_same_picture(background, truth, 3, 1);
    free(background);
    free(truth);
    // The hull holds the true figure, of which the held-out camera carved nothing.
    char *path = strdup(orl_scene_mesh_path(scene).text);
    struct orl_mesh mesh, figure;
    assert_int_equal(orl_mesh_read(NULL, path, NULL, &mesh), ORL_OK);
    truth = join(w->set, "mesh/00000.ply");
    assert_int_equal(orl_mesh_read(NULL, truth, NULL, &figure), ORL_OK);
    assert_true(mesh_volume(&mesh) > mesh_volume(&figure));
    assert_true(mesh_volume(&mesh) < 4 * mesh_volume(&figure));
    orl_mesh_finish(&mesh);
    orl_mesh_finish(&figure);
    free(truth);
    free(path);
    orl_scene_destroy(&scene);
    orl_names_finish(&test);
    free(out);
}

static void finds_silhouettes_by_difference(void **state)
{
    const struct work *w = *state;
    char *out = join(w->dir, "difference");
    const struct orl_import_params params = {
        .cameras = w->cameras, .out = out, ORL_IMPORT_DEFAULTS,
        .silhouettes = ORL_SILHOUETTES_BACKGROUND, .background = w->background};
    struct orl_import_params later = params;
    later.frames = (struct orl_frame_range){1, 0, 1};
    assert_int_equal(orl_import(NULL, &later, NULL), ORL_OK);
    struct orl_scene *scene;
    assert_int_equal(orl_scene_open(NULL, out, &scene), ORL_OK);
    assert_int_equal(scene->frame_count, 2);
    assert_int_equal(orl_scene_set_frame(NULL, scene, 1), ORL_OK);
    for (size_t i = 0; i < scene->photo_count; i++) {
        char name[64];
        snprintf(name, sizeof name, "cam%02zu/%05d.png", i, 2); // 1 + 1
        char *truth = join(w->masks, name);
        check_mask(scene, i, truth); // its shadow on the floor is not part of it
        free(truth);
    }
    orl_scene_destroy(&scene);
    free(out);
}

// --- distortion ---

static struct orl_colmap_camera distorted(double k1)
{
    return (struct orl_colmap_camera){
        .id = 1, .model = 4, .param_count = 8, .pinhole = {200, 150, 180, 180, 104, 73},
        .params = {180, 180, 104, 73, k1, 0, 0, 0}};
}

// All that the target sees was in the picture, and it could not be much larger.
static void chooses_targets(void **state)
{
    (void)state;
    static const double terms[] = {-0.3, -0.1, 0.05, 0.2};
    for (size_t i = 0; i < ORL_COUNT(terms); i++) {
        struct orl_colmap_camera from = distorted(terms[i]);
        struct orl_camera to = orl_import_target(&from, 0);
        double margin = INFINITY;
        assert_float_equal(to.fx, 180, 0);
        assert_true(terms[i] < 0 ? to.width > 200 : to.width <= 200);
        for (int k = 0; k < 400; k++) {
            double t = k % 100 / 99.0;
            const double u = k < 200 ? t * to.width : k < 300 ? 0 : to.width;
            const double v = k < 100 ? 0 : k < 200 ? to.height : t * to.height;
            const double ray[2] = {(u - to.cx) / to.fx, (v - to.cy) / to.fy};
            double pixel[2];
            orl_colmap_camera_project(&from, ray, pixel);
            assert_true(pixel[0] >= -0.5 && pixel[1] >= -0.5 && pixel[0] <= 200.5 &&
                        pixel[1] <= 150.5);
            margin = fmin(margin, fmin(fmin(pixel[0], 200 - pixel[0]),
                                       fmin(pixel[1], 150 - pixel[1])));
        }
        assert_true(margin < 2);
    }
    struct orl_colmap_camera plain = {.id = 1, .model = 1, .param_count = 4,
                                      .pinhole = {200, 150, 180, 181, 104, 73},
                                      .params = {180, 181, 104, 73}};
    struct orl_camera same = orl_import_target(&plain, 0), half = orl_import_target(&plain, 100);
    assert_true(orl_import_is_same(&plain, &same));
    // Distortion of exactly zero is none.
    struct orl_colmap_camera zero = distorted(0);
    same = orl_import_target(&zero, 0);
    assert_true(orl_import_is_same(&zero, &same));
    zero.model = 5; // an equidistant lens
    same = orl_import_target(&zero, 0);
    assert_false(orl_import_is_same(&zero, &same));
    assert_int_equal(half.width, 100);
    assert_int_equal(half.height, 75);
    assert_float_equal(half.fx, 90, 1e-9);
    assert_false(orl_import_is_same(&plain, &half));
}

// A grid of dots drawn where the distorted camera sees them is straight in the scene.
static void undistorts(void **state)
{
    const struct work *w = *state;
    enum { W = 200, H = 150 };
    char *dir = join(w->dir, "bent"), *out = join(w->dir, "straight"), path[4096];
    assert_int_equal(orl_dir_make(NULL, dir), ORL_OK);
    struct orl_colmap_camera from = distorted(-0.3);
    struct orl_image bent;
    assert_int_equal(orl_image_init(NULL, &bent, W, H, 3, ORL_PIXEL_U8), ORL_OK);
    const double dot[2] = {0.42, 0.3}; // x/z, y/z
    double pixel[2];
    orl_colmap_camera_project(&from, dot, pixel);
    for (int y = 0; y < H; y++)
        for (int x = 0; x < W; x++)
            if (hypot(x + 0.5 - pixel[0], y + 0.5 - pixel[1]) < 8) // more than a speck
                memset(bent.u8 + 3 * (y * W + x), 255, 3);
    for (int i = 0; i < 2; i++) {
        snprintf(path, sizeof path, "%s/%c.png", dir, "ab"[i]);
        assert_int_equal(orl_png_write(NULL, path, &bent), ORL_OK);
    }
    FILE *cameras = test_create(dir, "cameras.json");
    fprintf(cameras, "{\"pixel_centre\": 0.5, \"cameras\": [");
    for (int i = 0; i < 2; i++)
        fprintf(cameras, "%s{\"name\": \"%c\", \"width\": 200, \"height\": 150, \"K\": "
                "[[180,0,104],[0,180,73],[0,0,1]], \"R\": [[1,0,0],[0,1,0],[0,0,1]], \"t\": "
                "[%d,0,0], \"dist\": [-0.3]}", i ? "," : "", "ab"[i], i);
    fprintf(cameras, "]}");
    fclose(cameras);
    const struct orl_import_params params = {
        .cameras = dir, .out = out, ORL_IMPORT_DEFAULTS, .silhouettes = ORL_SILHOUETTES_DARK};
    assert_int_equal(orl_import(NULL, &params, NULL), ORL_OK);
    struct orl_scene *scene;
    assert_int_equal(orl_scene_open(NULL, out, &scene), ORL_OK);
    const struct orl_camera *c = &scene->photos[1].view.camera;
    for (int channels = 1; channels <= 3; channels += 2) { // the mask, then the photograph
        char *file = channels == 1 ? strdup(orl_scene_file(scene, 1, ORL_FILE_MASK).text)
                                   : strdup(orl_scene_file(scene, 1, ORL_FILE_PHOTO).text);
        struct orl_image straight = picture(file, channels);
        double sum = 0, at[2] = {0, 0};
        assert_int_equal(straight.width, c->width);
        for (int y = 0; y < c->height; y++)
            for (int x = 0; x < c->width; x++) {
                double v = straight.u8[(size_t)channels * (size_t)(y * c->width + x)];
                sum += v;
                at[0] += v * (x + 0.5);
                at[1] += v * (y + 0.5);
            }
        assert_true(sum > 0);
        assert_float_equal(at[0] / sum, c->fx * dot[0] + c->cx, 0.5);
        assert_float_equal(at[1] / sum, c->fy * dot[1] + c->cy, 0.5);
        orl_image_finish(&straight);
        free(file);
    }
    orl_scene_destroy(&scene);
    orl_image_finish(&bent);
    free(dir);
    free(out);
}

// --- masks ---

// A set of pictures front/1.png and back/1.png with cameras, in work/NAME.
static char *make_pair(const struct work *w, const char *name)
{
    enum { W = 64, H = 48 };
    char *dir = join(w->dir, name), path[4096];
    struct orl_image grey;
    assert_int_equal(orl_image_init(NULL, &grey, W, H, 3, ORL_PIXEL_U8), ORL_OK);
    memset(grey.u8, 128, orl_image_bytes(&grey));
    static const char *const sides[] = {"front", "back"};
    FILE *images;
    for (int i = 0; i < 2; i++) {
        snprintf(path, sizeof path, "%s/images/%s", dir, sides[i]);
        assert_int_equal(orl_dir_make(NULL, path), ORL_OK);
        snprintf(path, sizeof path, "%s/images/%s/1.png", dir, sides[i]);
        assert_int_equal(orl_png_write(NULL, path, &grey), ORL_OK);
    }
    FILE *file = test_create(dir, "cameras.txt");
    fprintf(file, "1 PINHOLE 64 48 60 60 32 24\n");
    fclose(file);
    images = test_create(dir, "images.txt");
    for (int i = 0; i < 2; i++)
        fprintf(images, "%d 1 0 0 0 %d 0 0 1 %s/1.png\n\n", i + 1, i, sides[i]);
    fclose(images);
    fclose(test_create(dir, "points3D.txt"));
    orl_image_finish(&grey);
    return dir;
}

static void refuses_absurd_lenses(void **state)
{
    const struct work *w = *state;
    static const struct {
        const char *k, *dist, *why;
    } cases[] = {{"[[180,0,32],[0,180,24],[0,0,1]]", "[10000000]", "its lens distortion leaves"},
                 {"[[5,0,32],[0,5,24],[0,0,1]]", "[]", "a focal length of 5 pixels"}};
    char *dir = make_pair(w, "absurd"), *out = join(w->dir, "absurd_scene");
    const struct orl_import_params params = {.cameras = dir, .out = out, ORL_IMPORT_DEFAULTS};
    for (size_t i = 0; i < ORL_COUNT(cases); i++) {
        char *file = join(dir, "cameras.json");
        struct orl_import_params one = params;
        struct said said;
        struct orl_log log = log_to(&said);
        one.cameras = file;
        FILE *cameras = test_create(dir, "cameras.json");
        fprintf(cameras, "{\"cameras\": [");
        for (int k = 0; k < 2; k++)
            fprintf(cameras, "%s{\"name\": \"%s/1.png\", \"width\": 64, \"height\": 48, \"K\": %s, "
                    "\"R\": [[1,0,0],[0,1,0],[0,0,1]], \"t\": [%d,0,0], \"dist\": %s}", k ? "," : "",
                    k ? "back" : "front", cases[i].k, k, cases[i].dist);
        fprintf(cameras, "]}");
        fclose(cameras);
        assert_int_equal(orl_import(&log, &one, NULL), ORL_ERR_DATA);
        if (!strstr(said.text, cases[i].why))
            fail_msg("%s", said.text);
        free(file);
    }
    free(dir);
    free(out);
}

// White left of `column`.
static void write_part(const char *dir, const char *name, int column)
{
    char *path = join(dir, name), *folder = join(dir, name);
    struct orl_image mask;
    *strrchr(folder, '/') = '\0';
    assert_int_equal(orl_dir_make(NULL, folder), ORL_OK);
    assert_int_equal(orl_image_init(NULL, &mask, 64, 48, 1, ORL_PIXEL_U8), ORL_OK);
    for (int i = 0; i < 64 * 48; i++)
        mask.u8[i] = i % 64 < column ? 1 : 0;
    assert_int_equal(orl_png_write(NULL, path, &mask), ORL_OK);
    orl_image_finish(&mask);
    free(path);
    free(folder);
}

static void expect_parts(const char *scene, int back, int front)
{
    const int want[2] = {back, front};
    for (int i = 0; i < 2; i++) {
        char *path = join(scene, i ? "masks/front/1.png.png" : "masks/back/1.png.png");
        struct orl_image mask = picture(path, 1);
        for (int x = 0; x < 64; x++)
            assert_int_equal(mask.u8[x] != 0, x < want[i]);
        orl_image_finish(&mask);
        free(path);
    }
}

static void finds_masks_in_folders(void **state)
{
    const struct work *w = *state;
    char *dir = make_pair(w, "pair"), *masks = join(dir, "m"), *out = join(w->dir, "pair_scene");
    struct said said;
    struct orl_log log = log_to(&said);
    struct orl_import_params params = {.cameras = dir, .out = out, ORL_IMPORT_DEFAULTS,
                                       .silhouettes = ORL_SILHOUETTES_GIVEN, .masks_dir = masks};
    // One file cannot be the mask of two pictures of the same name.
    write_part(dir, "m/1.png", 5);
    assert_int_equal(orl_import(&log, &params, NULL), ORL_ERR_NOT_FOUND);
    write_part(dir, "m/front/1.png", 10);
    write_part(dir, "m/back/1.png.png", 20);
    assert_int_equal(orl_import(&log, &params, NULL), ORL_OK);
    expect_parts(out, 20, 10);
    // The scene's own names.
    free(masks);
    free(out);
    params.masks_dir = masks = join(dir, "flat");
    params.out = out = join(w->dir, "pair_flat");
    write_part(dir, "flat/front_1.png", 30);
    write_part(dir, "flat/back_1.png", 40);
    assert_int_equal(orl_import(&log, &params, NULL), ORL_OK);
    expect_parts(out, 40, 30);
    free(dir);
    free(masks);
    free(out);
}

static void names_black_masks(void **state)
{
    const struct work *w = *state;
    char *dir = make_pair(w, "dark"), *masks = join(dir, "m"), *out = join(w->dir, "dark_scene");
    struct said said;
    struct orl_log log = log_to(&said);
    const struct orl_import_params params = {
        .cameras = dir, .out = out, ORL_IMPORT_DEFAULTS, .silhouettes = ORL_SILHOUETTES_GIVEN,
        .masks_dir = masks};
    write_part(dir, "m/front/1.png", 0);
    write_part(dir, "m/back/1.png", 0);
    assert_int_equal(orl_import(&log, &params, NULL), ORL_ERR_DATA);
    assert_non_null(strstr(said.text, "masks are black where the subject is not"));
    write_part(dir, "m/back/1.png", 7);
    assert_int_equal(orl_import(&log, &params, NULL), ORL_OK);
    assert_non_null(strstr(said.text, "front/1.png: 1 of 2 silhouettes are empty"));
    free(dir);
    free(masks);
    free(out);
}

// --- single pictures, points, meshes ---

// Light above white is kept beside the 8-bit copy.
static void keeps_linear_light(void **state)
{
    const struct work *w = *state;
    enum { W = 64, H = 64 };
    char *dir = join(w->dir, "deep"), *out = join(w->dir, "deep_scene"), path[4096];
    assert_int_equal(orl_dir_make(NULL, dir), ORL_OK);
    struct orl_image light;
    assert_int_equal(orl_image_init(NULL, &light, W, H, 3, ORL_PIXEL_F32), ORL_OK);
    for (size_t i = 0; i < 3 * W * H; i++)
        light.f32[i] = 2.5f;
    for (int i = 0; i < 2; i++) {
        snprintf(path, sizeof path, "%s/%c.exr", dir, "ab"[i]);
        assert_int_equal(orl_linear_write(NULL, path, &light), ORL_OK);
    }
    FILE *cameras = test_create(dir, "x_par.txt");
    fprintf(cameras, "2\na.exr 60 0 32 0 60 32 0 0 1 1 0 0 0 1 0 0 0 1 0 0 0\n"
                     "b.exr 60 0 32 0 60 32 0 0 1 1 0 0 0 1 0 0 0 1 1 0 0\n");
    fclose(cameras);
    const struct orl_import_params params = {.cameras = dir, .out = out, ORL_IMPORT_DEFAULTS};
    assert_int_equal(orl_import(NULL, &params, NULL), ORL_OK);
    struct orl_scene *scene;
    struct orl_image kept;
    assert_int_equal(orl_scene_open(NULL, out, &scene), ORL_OK);
    assert_string_equal(scene->photos[1].name, "b.jpg");
    assert_true(scene->photos[1].linear);
    assert_int_equal(orl_photo_read(NULL, scene, 1, true, &kept), ORL_OK);
    assert_float_equal(kept.f32[3 * (20 * W + 30) + 1], 2.5, 1e-3);
    orl_image_finish(&kept);
    orl_image_finish(&light);
    orl_scene_destroy(&scene);
    free(dir);
    free(out);
}

// A pinhole's pictures are copied byte by byte; a cloud gets radii.
static void copies_and_completes(void **state)
{
    const struct work *w = *state;
    char *out = join(w->dir, "still"), *photos = join(w->dir, "photos");
    char *cloud = join(w->dir, "cloud.ply"), *mesh = join(w->set, "mesh/00001.ply");
    assert_int_equal(orl_dir_make(NULL, photos), ORL_OK);
    uint8_t *a, *b;
    size_t size_a, size_b;
    for (int i = 0; i < 4; i++) {
        char from[4096], to[4096];
        snprintf(from, sizeof from, "%s/cam%02d/00001.png", w->images, i);
        // The second is called as cameras call HEIF files.
        snprintf(to, sizeof to, "%s/cam%02d.%s", photos, i, i == 1 ? "HIF" : "png");
        assert_int_equal(orl_file_read(NULL, from, SIZE_MAX / 2, &a, &size_a), ORL_OK);
        assert_int_equal(orl_file_write(NULL, to, a, size_a), ORL_OK);
        free(a);
    }
    FILE *ply = test_create(w->dir, "cloud.ply");
    fprintf(ply, "ply\nformat ascii 1.0\nelement vertex 100\nproperty float x\nproperty float y\n"
                 "property float z\nend_header\n");
    for (int i = 0; i < 100; i++)
        fprintf(ply, "%g %g 0\n", 0.1 * (i % 10), 0.1 * (i / 10));
    fclose(ply);
    const struct orl_import_params params = {
        .cameras = w->cameras, .out = out, ORL_IMPORT_DEFAULTS, .images_dir = photos,
        .test_every = 4, .test_block = {2, 3}, .points = ORL_IMPORT_CLOUD, .points_file = cloud, .mesh = mesh};
    assert_int_equal(orl_import(NULL, &params, NULL), ORL_OK);
    struct orl_scene *scene;
    assert_int_equal(orl_scene_open(NULL, out, &scene), ORL_OK);
    assert_string_equal(scene->photos[0].name, "cam00.png");
    assert_true(scene->photos[0].test && !scene->photos[1].test);
    assert_true(scene->photos[2].test && !scene->photos[3].test);
    assert_int_equal(scene->points.count, 100);
    assert_true(scene->points.radius[55] > 0.09f && scene->points.radius[55] < 0.3f);
    char *photo = strdup(orl_scene_file(scene, 3, ORL_FILE_PHOTO).text), *given = join(photos, "cam03.png");
    assert_int_equal(orl_file_read(NULL, photo, SIZE_MAX / 2, &a, &size_a), ORL_OK);
    assert_int_equal(orl_file_read(NULL, given, SIZE_MAX / 2, &b, &size_b), ORL_OK);
    assert_int_equal(size_a, size_b);
    assert_memory_equal(a, b, size_a);
    free(a);
    free(b);
    free(photo);
    free(given);
    orl_scene_destroy(&scene);
    free(out);
    free(photos);
    free(cloud);
    free(mesh);
}

// --- what is refused ---

static void refuses(void **state)
{
    const struct work *w = *state;
    char *out = join(w->dir, "refused"), *nowhere = join(w->dir, "nowhere");
    struct orl_names unknown = {0};
    const size_t entries = test_count_entries(w->dir);
    assert_int_equal(orl_names_add(NULL, &unknown, "cam77"), ORL_OK);
    const struct orl_import_params base = {.cameras = w->set, .out = out, ORL_IMPORT_DEFAULTS};
    struct {
        struct orl_import_params params;
        enum orl_result result;
        const char *why;
    } cases[11];
    for (size_t i = 0; i < ORL_COUNT(cases); i++)
        cases[i].params = base;
    cases[0].params.images_dir = nowhere;
    cases[0].result = ORL_ERR_NOT_FOUND, cases[0].why = "no such folder";
    cases[1].params.images_dir = w->dir;
    cases[1].result = ORL_ERR_NOT_FOUND, cases[1].why = "pictures of 0 of 4 cameras can be used; missing: ";
    cases[2].params.test_list = &unknown;
    cases[2].result = ORL_ERR_ARGUMENT, cases[2].why = "--test-list cam77: no photograph";
    cases[3].params.silhouettes = ORL_SILHOUETTES_GIVEN;
    cases[3].params.masks_dir = w->background;
    cases[3].result = ORL_ERR_DATA, cases[3].why = "a sequence needs a sequence of masks";
    cases[4].params.background = w->dir;
    cases[4].result = ORL_ERR_NOT_FOUND, cases[4].why = "nothing here for the camera cam00";
    cases[5].params.hull_side = 32;
    cases[5].result = ORL_ERR_DATA, cases[5].why = "a hull needs silhouettes";
    cases[6].params.frames.first = 3;
    cases[6].result = ORL_ERR_DATA, cases[6].why = "3 pictures, but the first frame asked for is 3";
    cases[7].params.points = ORL_IMPORT_CLOUD;
    cases[7].params.points_file = nowhere;
    cases[7].result = ORL_ERR_NOT_FOUND, cases[7].why = "nowhere";
    cases[8].params.mesh = w->cameras;
    cases[8].result = ORL_ERR_FORMAT, cases[8].why = "no faces";
    cases[10].params.test_block = (struct orl_test_block){1, 5};
    cases[10].result = ORL_ERR_ARGUMENT, cases[10].why = "--test-block 1:5: there are 4 photographs";
    cases[9].params.out = w->set;
    cases[9].result = ORL_ERR_ARGUMENT, cases[9].why = "not empty";
    for (size_t i = 0; i < ORL_COUNT(cases); i++) {
        struct said said;
        struct orl_log log = log_to(&said);
        enum orl_result result = orl_import(&log, &cases[i].params, NULL);
        if (result != cases[i].result || !strstr(said.text, cases[i].why))
            fail_msg("case %zu: %s: \"%s\" does not say \"%s\"", i, orl_result_name(result),
                     said.text, cases[i].why);
        // Nothing is left over, and what was there still is.
        assert_false(orl_path_is_dir(out));
        assert_int_equal(test_count_entries(w->dir), entries);
        assert_true(orl_path_is_file(w->cameras));
    }
    orl_names_finish(&unknown);
    free(out);
    free(nowhere);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(imports_sequences), cmocka_unit_test(finds_silhouettes_by_difference),
        cmocka_unit_test(chooses_targets), cmocka_unit_test(undistorts),
        cmocka_unit_test(refuses_absurd_lenses), cmocka_unit_test(finds_masks_in_folders),
        cmocka_unit_test(names_black_masks),
        cmocka_unit_test(copies_and_completes), cmocka_unit_test(keeps_linear_light), cmocka_unit_test(refuses),
    };
    return cmocka_run_group_tests(tests, set_up, tear_down);
}
