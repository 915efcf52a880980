#include "test.h"

#include <math.h>
#include <string.h>

#include "io/picture.h"

static char *dir, *file;

static int set_up(void **state)
{
    (void)state;
    return test_file_make("a.jpg", &dir, &file);
}

static int tear_down(void **state)
{
    (void)state;
    return test_file_remove(dir, file);
}

static struct orl_exif through_file(const struct orl_exif *exif)
{
    struct orl_image image;
    struct orl_picture_info back;
    assert_int_equal(orl_image_init(NULL, &image, 16, 8, 3, ORL_PIXEL_U8), ORL_OK);
    assert_int_equal(orl_jpeg_write(NULL, file, &image, 80, exif), ORL_OK);
    assert_int_equal(orl_picture_inspect(NULL, file, &back), ORL_OK);
    orl_image_finish(&image);
    return back.exif;
}

static void everything_comes_back(void **state)
{
    (void)state;
    const struct orl_exif exif = {.make = "A Maker", .model = "Model 5 \"x\"",
                                  .exposure_s = 1 / 800., .aperture = 6.3, .iso = 400,
                                  .bias_ev = -2 / 3., .focal_mm = 50.5, .focal_35mm = 75,
                                  .orientation = 8, .taken_s = 1718973296, .placed = true,
                                  .latitude = -33.8567844, .longitude = 151.2152967};
    struct orl_exif back = through_file(&exif);
    assert_string_equal(back.make, exif.make);
    assert_string_equal(back.model, exif.model);
    assert_float_equal(back.exposure_s, exif.exposure_s, 1e-12); // 1/800, as a fraction
    assert_float_equal(back.aperture, exif.aperture, 1e-8);
    assert_float_equal(back.iso, 400, 0);
    assert_float_equal(back.bias_ev, exif.bias_ev, 1e-9);
    assert_float_equal(back.focal_mm, 50.5, 0);
    assert_float_equal(back.focal_35mm, 75, 0);
    assert_int_equal(back.orientation, 8);
    assert_float_equal(back.taken_s, 1718973296, 0);
    assert_true(back.placed);
    assert_float_equal(back.latitude, exif.latitude, 1.5e-7); // a thousandth of a second
    assert_float_equal(back.longitude, exif.longitude, 1.5e-7);
}

static void north_and_west_come_back(void **state)
{
    (void)state;
    struct orl_exif back = through_file(
        &(struct orl_exif){.placed = true, .latitude = 48.8582602, .longitude = -2.2944991});
    assert_float_equal(back.latitude, 48.8582602, 1.5e-7);
    assert_float_equal(back.longitude, -2.2944991, 1.5e-7);
    assert_float_equal(back.taken_s, 0, 0);
}

// Geometry needs pixels as stored: a photograph on its side stays so.
static void orientation_does_not_turn_pixels(void **state)
{
    (void)state;
    const struct orl_exif exif = {.orientation = 6};
    struct orl_image image;
    int width, height;
    assert_int_equal(through_file(&exif).orientation, 6);
    assert_int_equal(orl_picture_size(NULL, file, &width, &height), ORL_OK);
    assert_int_equal(width, 16);
    assert_int_equal(height, 8);
    assert_int_equal(orl_picture_read(NULL, file, 3, &image), ORL_OK);
    assert_int_equal(image.width, 16);
    assert_int_equal(image.height, 8);
    orl_image_finish(&image);
}

static void extreme_values_survive(void **state)
{
    (void)state;
    const struct orl_exif exif = {.exposure_s = 1 / 32000., .aperture = 0.95, .iso = 409600};
    struct orl_exif back = through_file(&exif);
    assert_float_equal(back.exposure_s, 1 / 32000., 1e-12);
    assert_float_equal(back.aperture, 0.95, 1e-8);
    assert_float_equal(back.iso, 409600, 0);
    const struct orl_exif slow = {.exposure_s = 3600.5, .iso = 50};
    back = through_file(&slow);
    assert_float_equal(back.exposure_s, 3600.5, 1e-6);
}

static void silence_reads_as_zeroes(void **state)
{
    (void)state;
    const struct orl_exif zero = {0};
    struct orl_exif back = through_file(NULL);
    assert_memory_equal(&back, &zero, sizeof zero);
    back = through_file(&zero);
    assert_memory_equal(&back, &zero, sizeof zero);
    struct orl_picture_info info;
    assert_int_equal(orl_picture_inspect(NULL, "/nowhere.jpg", &info), ORL_ERR_NOT_FOUND);
}

static void exposure(void **state)
{
    (void)state;
    double ev;
    assert_true(orl_exif_exposure_ev(
        &(struct orl_exif){.exposure_s = 1 / 64., .aperture = 4, .iso = 200}, &ev));
    assert_float_equal(ev, -6 + 1 - 4, 1e-12);
    // Twice the time: one EV brighter. What is missing counts as constant.
    assert_true(orl_exif_exposure_ev(&(struct orl_exif){.exposure_s = 2}, &ev));
    assert_float_equal(ev, 1, 1e-12);
    assert_false(orl_exif_exposure_ev(&(struct orl_exif){.aperture = 4, .iso = 200}, &ev));
    assert_false(orl_exif_exposure_ev(&(struct orl_exif){.exposure_s = NAN}, &ev));
}

// Reads a file with this segment of fewer than 258 bytes, whose length is set here.
static struct orl_exif with_block(const uint8_t *block, size_t block_size)
{
    (void)through_file(NULL);
    uint8_t *plain, *with = malloc(65536);
    size_t size;
    assert_int_equal(orl_file_read(NULL, file, 32768, &plain, &size), ORL_OK);
    memcpy(with, plain, 2);
    memcpy(with + 2, block, block_size);
    with[5] = (uint8_t)(block_size - 2);
    memcpy(with + 2 + block_size, plain + 2, size - 2);
    assert_int_equal(orl_file_write(NULL, file, with, size + block_size), ORL_OK);
    struct orl_picture_info info;
    assert_int_equal(orl_picture_inspect(NULL, file, &info), ORL_OK);
    free(plain);
    free(with);
    return info.exif;
}

// A block that was written by hand: big-endian, the time only as APEX value, 1/0 as
// aperture, a text entry that points beyond the block.
static void foreign_and_broken_blocks(void **state)
{
    (void)state;
    static const uint8_t block[] = {
        0xff, 0xe1, 0, 0, 'E', 'x', 'i', 'f', 0, 0,
        'M', 'M', 0, 42, 0, 0, 0, 8,                      // TIFF head, first directory at 8
        0, 3,                                             // three entries
        0x01, 0x0f, 0, 2, 0, 0, 0, 40, 0x7f, 0, 0, 0,     // Make: far away
        0x01, 0x12, 0, 3, 0, 0, 0, 1, 0, 6, 0, 0,         // Orientation 6
        0x87, 0x69, 0, 4, 0, 0, 0, 1, 0, 0, 0, 50,        // EXIF directory at 50
        0, 0, 0, 0,
        0, 2,                                             // at 50: two entries
        0x92, 0x01, 0, 10, 0, 0, 0, 1, 0, 0, 0, 80,       // ShutterSpeedValue at 80
        0x82, 0x9d, 0, 5, 0, 0, 0, 1, 0, 0, 0, 88,        // FNumber at 88
        0, 0, 0, 0,
        0, 0, 0, 6, 0, 0, 0, 1,                           // at 80: 6/1 APEX, 1/64 s
        0, 0, 0, 1, 0, 0, 0, 0,                           // at 88: 1/0
    };
    struct orl_exif back = with_block(block, sizeof block);
    assert_string_equal(back.make, "");
    assert_int_equal(back.orientation, 6);
    assert_float_equal(back.exposure_s, 1 / 64., 1e-12);
    assert_float_equal(back.aperture, 0, 0);
}

// ISO 102400 as Canon writes it.
static void the_recommended_exposure_index_is_a_speed(void **state)
{
    (void)state;
    static const uint8_t block[] = {
        0xff, 0xe1, 0, 0, 'E', 'x', 'i', 'f', 0, 0,
        'M', 'M', 0, 42, 0, 0, 0, 8,                      // TIFF head, first directory at 8
        0, 1,
        0x87, 0x69, 0, 4, 0, 0, 0, 1, 0, 0, 0, 26,        // EXIF directory at 26
        0, 0, 0, 0,
        0, 3,                                             // at 26: three entries
        0x82, 0x9a, 0, 5, 0, 0, 0, 1, 0, 0, 0, 68,        // ExposureTime at 68
        0x88, 0x27, 0, 3, 0, 0, 0, 1, 0xff, 0xff, 0, 0,   // PhotographicSensitivity: 65535
        0x88, 0x32, 0, 4, 0, 0, 0, 1, 0, 1, 0x90, 0,      // RecommendedExposureIndex: 102400
        0, 0, 0, 0,
        0, 0, 0, 1, 0, 0, 0, 64,                          // at 68: 1/64 s
    };
    struct orl_exif back = with_block(block, sizeof block);
    assert_float_equal(back.exposure_s, 1 / 64., 1e-12);
    assert_float_equal(back.iso, 102400, 0);
}

// Real cameras' files, where the datasets are.
static void photographs(void **state)
{
    (void)state;
    const char *base = getenv("ORL_DATASETS");
    char path[4096];
    snprintf(path, sizeof path, "%s/sceaux-castle/images/100_7103.JPG",
             base ? base : SOURCE_DIR "/../shared/datasets");
    if (!orl_path_is_file(path)) {
        print_message("no photographs at %s\n", path);
        skip();
    }
    struct orl_picture_info info;
    assert_int_equal(orl_picture_inspect(NULL, path, &info), ORL_OK);
    const struct orl_exif exif = info.exif;
    assert_string_equal(exif.make, "EASTMAN KODAK COMPANY");
    assert_string_equal(exif.model, "KODAK Z612 ZOOM DIGITAL CAMERA");
    assert_float_equal(exif.exposure_s, 0.0015625, 1e-9);
    assert_float_equal(exif.aperture, 2.8, 1e-6);
    assert_float_equal(exif.iso, 80, 0);
    assert_float_equal(exif.focal_mm, 5.85, 1e-6);
    assert_int_equal(exif.orientation, 1);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(everything_comes_back), cmocka_unit_test(north_and_west_come_back),
        cmocka_unit_test(orientation_does_not_turn_pixels),
        cmocka_unit_test(extreme_values_survive),
        cmocka_unit_test(silence_reads_as_zeroes),
        cmocka_unit_test(exposure),
        cmocka_unit_test(foreign_and_broken_blocks),
        cmocka_unit_test(the_recommended_exposure_index_is_a_speed),
        cmocka_unit_test(photographs),
    };
    return cmocka_run_group_tests(tests, set_up, tear_down);
}
