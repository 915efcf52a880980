// Masks are brought to the pixels of the undistorted photographs.
#include <stdio.h>
#include <string.h>

#include "preprocess/calibrate/companions.h"
#include "test.h"

enum { W = 96, H = 80 };

static void write_text(const char *dir, const char *name, const char *text)
{
    char path[8192];
    snprintf(path, sizeof path, "%s/%s", dir, name);
    assert_int_equal(orl_file_write(NULL, path, text, strlen(text)), ORL_OK);
}

static void write_model(const char *scene, const char *name, const char *camera)
{
    char dir[4096];
    snprintf(dir, sizeof dir, "%s/%s", scene, name);
    assert_int_equal(orl_dir_make(NULL, dir), ORL_OK);
    write_text(dir, "cameras.txt", camera);
    write_text(dir, "images.txt", "1 1 0 0 0 0 0 0 1 a.png\n\n2 1 0 0 0 1 0 0 1 b.png\n\n");
    write_text(dir, "points3D.txt", "");
}

// White right of column 48, black left of it.
static void write_half(const char *path)
{
    struct orl_image mask;
    assert_int_equal(orl_image_init(NULL, &mask, W, H, 1, ORL_PIXEL_U8), ORL_OK);
    for (int i = 0; i < W * H; i++)
        mask.u8[i] = i % W >= W / 2 ? 255 : 0;
    assert_int_equal(orl_png_write(NULL, path, &mask), ORL_OK);
    orl_image_finish(&mask);
}

static void undistorts_masks(void **state)
{
    (void)state;
    char *dir = test_dir_make(), mask[4096], path[4096];
    snprintf(mask, sizeof mask, "%s/given.png", dir);
    write_half(mask);
    struct orl_source sources[] = {{.name = "a.png", .mask = mask}, {.name = "b.png"}};
    struct orl_job job = {.dir = dir, .lock_fd = -1, .sources = sources, .source_count = 2};
    // The distorted pixel of the undistorted column 95.5 is 47.5 (1 + 0.5 * 0.475^2) + 48 = 100.9,
    // outside; that of 92.5 is 96.9; of 91.5, 95.6, the last inside.
    write_model(dir, ".oriel/calibrate/model", "1 SIMPLE_RADIAL 96 80 100 48 40 0.5\n");
    write_model(dir, "sparse", "1 PINHOLE 96 80 100 100 48 40\n");
    const struct orl_colmap_model *model;
    size_t written;
    assert_int_equal(orl_job_sparse(&job, &model), ORL_OK);
    assert_int_equal(orl_undistort_companions(&job, ORL_COMPANION_MASK, model, "masks", &written), ORL_OK);
    assert_int_equal(written, 1);
    struct orl_image image;
    snprintf(path, sizeof path, "%s/masks/a.png.png", dir);
    assert_int_equal(orl_picture_read(NULL, path, 1, &image), ORL_OK);
    assert_int_equal(image.width, W);
    assert_int_equal(image.height, H);
    for (int x = 0; x < W; x++) {
        int value = image.u8[40 * W + x];
        assert_true(value == 0 || value == 255);
        if (x < 47 || x > 93)
            assert_int_equal(value, 0);
        if (x > 48 && x < 91)
            assert_int_equal(value, 255);
    }
    orl_image_finish(&image);
    snprintf(path, sizeof path, "%s/masks/b.png.png", dir);
    assert_false(orl_path_is_file(path));
    orl_colmap_finish(&job.calibrated);
    orl_colmap_finish(&job.sparse);
    test_dir_remove(dir);
}

// The colours of a JPEG stay those of the photograph, at full resolution.
static void undistorts_photographs(void **state)
{
    (void)state;
    const uint8_t red[3] = {200, 30, 30}, blue[3] = {30, 30, 200};
    char *dir = test_dir_make(), photo[4096], path[4096];
    struct orl_image image;
    snprintf(photo, sizeof photo, "%s/given.png", dir);
    assert_int_equal(orl_image_init(NULL, &image, W, H, 3, ORL_PIXEL_U8), ORL_OK);
    for (int i = 0; i < W * H; i++) // lines of one pixel
        memcpy(image.u8 + 3 * i, i / W % 2 ? red : blue, 3);
    assert_int_equal(orl_png_write(NULL, photo, &image), ORL_OK);
    orl_image_finish(&image);
    struct orl_source sources[] = {{.name = "a.jpg", .path = photo}, {.name = "b.jpg", .path = photo}};
    struct orl_job job = {.dir = dir, .lock_fd = -1, .sources = sources, .source_count = 2};
    static const char *const models[] = {".oriel/calibrate/model", "sparse"};
    for (int i = 0; i < 2; i++) {
        write_model(dir, models[i], "1 PINHOLE 96 80 100 100 48 40\n");
        snprintf(path, sizeof path, "%s/%s", dir, models[i]);
        write_text(path, "images.txt", "1 1 0 0 0 0 0 0 1 a.jpg\n\n2 1 0 0 0 1 0 0 1 b.jpg\n\n");
    }
    const struct orl_colmap_model *model;
    size_t written;
    assert_int_equal(orl_job_sparse(&job, &model), ORL_OK);
    assert_int_equal(orl_undistort_companions(&job, ORL_COMPANION_PHOTO, model, "images", &written), ORL_OK);
    for (int i = 0; i < 2; i++) {
        snprintf(path, sizeof path, "%s/images/%c.jpg", dir, "ab"[i]);
        assert_int_equal(orl_picture_read(NULL, path, 3, &image), ORL_OK);
        for (int k = 0; k < W * H; k++)
            for (int c = 0; c < 3; c++)
                assert_float_equal(image.u8[3 * k + c], (k / W % 2 ? red : blue)[c], 8);
        orl_image_finish(&image);
    }
    orl_colmap_finish(&job.calibrated);
    orl_colmap_finish(&job.sparse);
    test_dir_remove(dir);
}

int main(void)
{
    const struct CMUnitTest tests[] = {cmocka_unit_test(undistorts_masks),
                                       cmocka_unit_test(undistorts_photographs)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}
