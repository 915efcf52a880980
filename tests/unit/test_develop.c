// Prepare with photographs of more than 8 bits, by a stand-in for COLMAP.
#include "test.h"

#include <math.h>
#include <unistd.h>

#include "core/color.h"
#include "core/json.h"
#include "core/memory.h"
#include "eval/truth.h"
#include "io/exr.h"
#include "io/picture.h"
#include "opencv_files.h"
#include "oriel/prepare.h"
#include "render/photos/photo_loader.h"

enum { W = 96, H = 80 }; // the stand-in's camera

static char *dir, *photos, *scene_dir;

static int set_up(void **state)
{
    (void)state;
    dir = test_dir_make();
    photos = orl_path_join(NULL, dir, "photos");
    scene_dir = orl_path_join(NULL, dir, "scene");
    return dir && photos && scene_dir && orl_dir_make(NULL, photos) == ORL_OK &&
                   setenv("ORIEL_COLMAP", SOURCE_DIR "/tests/e2e/colmap_double", 1) == 0
               ? 0 : -1;
}

static int tear_down(void **state)
{
    (void)state;
    free(photos);
    free(scene_dir);
    test_dir_remove(dir);
    return 0;
}

// Light of the pictures: smooth, with a bright window; mean about 3, so that white has
// to be chosen.
static float light(int x, int y, int c)
{
    float base = 3 * (1 + 0.3f * sinf(0.1f * (float)x) + 0.2f * cosf(0.13f * (float)y));
    return base * (1 + 0.1f * (float)c) * (x > 40 && x < 60 && y > 30 && y < 50 ? 16 : 1);
}

static void path_of(char path[4096], const char *folder, const char *name)
{
    snprintf(path, 4096, "%s/%s", folder, name);
}

static void write_exr(const char *name, float factor)
{
    char path[4096];
    struct orl_image image;
    struct orl_exr_params exr = {.width = W, .height = H};
    static const char *const names[] = {"R", "G", "B"};
    assert_int_equal(orl_image_init(NULL, &image, W, H, 3, ORL_PIXEL_F32), ORL_OK);
    for (int i = 0; i < W * H * 3; i++)
        image.f32[i] = factor * light(i / 3 % W, i / 3 / W, i % 3);
    for (int c = 0; c < 3; c++)
        assert_true(orl_exr_add_channel(&exr, names[c], false, &image, c));
    path_of(path, photos, name);
    assert_int_equal(orl_exr_write(NULL, path, &exr), ORL_OK);
    orl_image_finish(&image);
}

static void write_sixteen(const char *name)
{
    static uint16_t rgb[W * H * 3];
    char path[4096];
    for (int i = 0; i < W * H * 3; i++)
        rgb[i] = (uint16_t)lrintf(
            65535 * orl_srgb_encode(0.05f * light(i / 3 % W, i / 3 / W, i % 3)));
    path_of(path, photos, name);
    assert_true(test_opencv_write_rgb16(path, W, H, rgb));
}

static void write_with_exif(const char *name, float grey, const struct orl_exif *exif)
{
    char path[4096];
    struct orl_image image;
    assert_int_equal(orl_image_init(NULL, &image, W, H, 3, ORL_PIXEL_U8), ORL_OK);
    memset(image.u8, (int)grey, W * H * 3);
    path_of(path, photos, name);
    assert_int_equal(orl_jpeg_write(NULL, path, &image, 95, exif), ORL_OK);
    orl_image_finish(&image);
}

static void write_eight(const char *name, float grey)
{
    write_with_exif(name, grey, NULL);
}

static void prepare(struct said *said, bool resume)
{
    const char *const inputs[] = {photos};
    struct orl_log log = log_to(said);
    const struct orl_prepare_params params = {.inputs = inputs, .input_count = 1,
                                              // Fewer than five are left to train, so that nothing is drawn: this
                                              // test looks for leaks, which drivers have.
                                              .test_every = 3,
                                              .out = scene_dir, .resume = resume};
    if (orl_prepare(&log, &params, NULL) != ORL_OK)
        fail_msg("%s", said->text);
}

// scale: of light, as the 8-bit copy has it.
static void check_photo(const struct orl_scene *scene, const char *name, float scale, bool clips)
{
    int index = orl_scene_find_photo(scene, name);
    assert_true(index >= 0);
    struct orl_image linear, eight;
    char *path = strdup(orl_scene_file(scene, (size_t)index, ORL_FILE_PHOTO).text);
    assert_true(scene->photos[index].linear);
    assert_int_equal(orl_photo_read(NULL, scene, (size_t)index, true, &linear), ORL_OK);
    assert_int_equal(orl_picture_read(NULL, path, 3, &eight), ORL_OK);
    for (int y = 20; y < 60; y++)
        for (int x = 25; x < 75; x++)
            for (int c = 0; c < 3; c++) {
                if (abs(x - 50) < 14 && abs(y - 40) < 14 && (abs(x - 50) > 6 || abs(y - 40) > 6))
                    continue; // the window's edge moves by a fraction of a pixel
                // Distortion is 0.01 r^2, r less than 0.4 here.
                float want = scale * light(x, y, c), value = linear.f32[3 * (y * W + x) + c];
                if (clips)
                    want = fminf(want, 1);
                assert_float_equal(value, want, 0.02 * (double)want);
                assert_float_equal(eight.u8[3 * (y * W + x) + c],
                                   255 * (double)orl_srgb_encode(value), 8); // JPEG rings
            }
    orl_image_finish(&linear);
    orl_image_finish(&eight);
    free(path);
}

static void deep_photographs_get_copies_and_linear_light(void **state)
{
    (void)state;
    struct said said;
    struct orl_scene *scene;
    write_exr("a.exr", 1);
    write_exr("b.exr", 0.5f);
    write_exr("c.exr", 2);
    write_sixteen("d.tif");
    write_sixteen("e.png");
    write_eight("f.jpg", 120);
    write_eight("a.JPG", 90); // the camera's own of a.exr
    write_eight("g.jpg", 100);
    char path[4096];
    path_of(path, photos, "g.dng"); // cannot be read: g.jpg serves
    assert_int_equal(orl_file_write(NULL, path, "II*", 4), ORL_OK);
    prepare(&said, false);
    assert_non_null(strstr(said.text, "g.dng: "));
    assert_non_null(strstr(said.text, "a.JPG: a.exr holds more of the same photograph"));
    assert_int_equal(orl_scene_open(NULL, scene_dir, &scene), ORL_OK);
    assert_int_equal(scene->photo_count, 7);
    // The median picture's average, about 3.3, becomes about 0.18 by a power of two.
    check_photo(scene, "a", 0.0625f, false);
    check_photo(scene, "b", 0.03125f, false);
    check_photo(scene, "c.jpg", 0.125f, false);
    check_photo(scene, "d.jpg", 0.05f, true);
    check_photo(scene, "e.png", 0.05f, true);
    // COLMAP reads no PNG of 16 bits.
    struct orl_picture_info info;
    char *deep = strdup(orl_scene_file(scene, (size_t)orl_scene_find_photo(scene, "e.png"), ORL_FILE_PHOTO).text);
    assert_int_equal(orl_picture_inspect(NULL, deep, &info), ORL_OK);
    assert_int_equal(info.bits, 8);
    free(deep);
    int plain = orl_scene_find_photo(scene, "f.jpg");
    assert_false(scene->photos[plain].linear);
    orl_scene_destroy(&scene);
    prepare(&said, true);
    assert_non_null(strstr(said.text, "undistort: done already"));
}

// The truth has the photographs' own pixels and exposures; the scene sees it undistorted.
static void true_radiance_is_undistorted(void **state)
{
    (void)state;
    struct orl_scene *scene;
    struct orl_truth truth;
    struct orl_image radiance;
    char *truth_dir = orl_path_join(NULL, dir, "truth"), path[4096];
    assert_non_null(truth_dir);
    path_of(path, truth_dir, "radiance");
    assert_int_equal(orl_scene_open(NULL, scene_dir, &scene), ORL_OK);
    assert_int_equal(orl_truth_open(NULL, scene, truth_dir, &truth), ORL_ERR_NOT_FOUND);
    assert_int_equal(orl_dir_make(NULL, path), ORL_OK);
    FILE *file = test_create(truth_dir, "synth.json");
    fprintf(file, "{\"photographs\": [");
    for (size_t i = 0; i < scene->photo_count; i++)
        fprintf(file, "%s{\"photo\": \"%s\", \"exposure_ev\": %d}", i ? ", " : "",
                scene->photos[i].name, (int)i);
    fprintf(file, "]}\n");
    fclose(file);
    snprintf(path, sizeof path, "%s/photos/b.exr", dir);
    uint8_t *data;
    size_t size;
    assert_int_equal(orl_file_read(NULL, path, 1 << 20, &data, &size), ORL_OK);
    path_of(path, truth_dir, "radiance/b.exr");
    assert_int_equal(orl_file_write(NULL, path, data, size), ORL_OK);
    free(data);
    int b = orl_scene_find_photo(scene, "b");
    assert_int_equal(orl_truth_open(NULL, scene, truth_dir, &truth), ORL_OK);
    assert_int_equal(orl_truth_read(NULL, &truth, (size_t)b, &radiance), ORL_OK);
    assert_int_equal(radiance.width, W);
    double stops = b - scene->photos[b].exposure_ev; // of the truth, above the scene's unit
    for (int x = 30; x < 66; x++) { // b.exr has half the light; above the window
        float want = 0.5f * light(x, 22, 1) * (float)exp2(stops);
        assert_float_equal(radiance.f32[3 * (22 * W + x) + 1], want, 0.02 * (double)want);
    }
    orl_image_finish(&radiance);
    assert_int_not_equal(orl_truth_read(NULL, &truth, (size_t)b + 1, &radiance), ORL_OK);
    orl_truth_finish(&truth);
    orl_scene_destroy(&scene);
    free(truth_dir);
}

static void without_deep_photographs_the_folder_goes(void **state)
{
    (void)state;
    struct said said;
    static const char *const deep[] = {"a.exr", "b.exr", "c.exr", "d.tif", "e.png"};
    char path[4096];
    for (size_t i = 0; i < ORL_COUNT(deep); i++) {
        path_of(path, photos, deep[i]);
        assert_int_equal(remove(path), 0);
    }
    prepare(&said, true);
    path_of(path, scene_dir, "images_linear");
    assert_false(orl_path_is_dir(path));
}

// Photographs of a zoom at two focal lengths, of another maker, and without EXIF.
static void cameras_are_told_apart_and_places_kept(void **state)
{
    (void)state;
    struct said said;
    char path[4096];
    json_t *root, *photo;
    size_t i, found = 0;
    const struct orl_exif wide = {.make = "A", .focal_mm = 24}, tele = {.make = "A", .focal_mm = 70};
    const struct orl_exif placed = {.make = "B", .focal_mm = 24, .placed = true,
                                    .latitude = 48.25, .longitude = -3.5};
    write_with_exif("h.jpg", 60, &wide);
    write_with_exif("i.jpg", 70, &wide);
    write_with_exif("j.jpg", 80, &tele);
    write_with_exif("k.jpg", 90, &placed);
    prepare(&said, true);
    // a, f and g have no EXIF, and all sizes are one: one camera.
    assert_non_null(strstr(said.text, "7 photographs, 4 cameras"));
    path_of(path, scene_dir, "scene.json");
    assert_int_equal(orl_json_read(NULL, path, &root), ORL_OK);
    json_array_foreach(json_object_get(root, "photographs"), i, photo) {
        const json_t *gps = json_object_get(photo, "gps");
        found += gps != NULL;
        if (gps) {
            assert_string_equal(orl_json_text(photo, "name"), "k.jpg");
            assert_float_equal(json_number_value(json_array_get(gps, 0)), 48.25, 1e-6);
            assert_float_equal(json_number_value(json_array_get(gps, 1)), -3.5, 1e-6);
        }
    }
    assert_int_equal(found, 1);
    json_decref(root);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(deep_photographs_get_copies_and_linear_light),
        cmocka_unit_test(true_radiance_is_undistorted),
        cmocka_unit_test(without_deep_photographs_the_folder_goes),
        cmocka_unit_test(cameras_are_told_apart_and_places_kept),
    };
    return cmocka_run_group_tests(tests, set_up, tear_down);
}
