// Netpbm's binary pictures, by hand.
#include <string.h>

#include "io/picture.h"
#include "test.h"

static char *dir, *file;

static int set_up(void **state)
{
    (void)state;
    return test_file_make("picture", &dir, &file);
}

static int tear_down(void **state)
{
    (void)state;
    return test_file_remove(dir, file);
}

static enum orl_result read(const struct orl_log *log, const void *data, size_t size, int channels,
                            struct orl_image *image)
{
    assert_int_equal(orl_file_write(NULL, file, data, size), ORL_OK);
    return orl_picture_read(log, file, channels, image);
}

static void reads_bitmaps(void **state)
{
    (void)state;
    // 10 wide: two bytes a row; 1 is black.
    static const char data[] = "P4\n# made by hand\n10 2\n\xa0\x40\xff\xff";
    static const uint8_t expected[20] = {0, 255, 0, 255, 255, 255, 255, 255, 255, 0};
    struct orl_image image;
    int width, height;
    assert_int_equal(read(NULL, data, sizeof data - 1, 1, &image), ORL_OK);
    assert_int_equal(image.width, 10);
    assert_memory_equal(image.u8, expected, sizeof expected);
    assert_int_equal(orl_picture_size(NULL, file, &width, &height), ORL_OK);
    assert_int_equal(width, 10);
    assert_int_equal(height, 2);
    orl_image_finish(&image);
}

static void reads_grey_and_colour(void **state)
{
    (void)state;
    struct orl_image image;
    assert_int_equal(read(NULL, "P5 2 1 100\n\x32\x64", 13, 3, &image), ORL_OK);
    assert_int_equal(image.u8[0], 128); // 50 of 100
    assert_int_equal(image.u8[5], 255);
    orl_image_finish(&image);
    assert_int_equal(read(NULL, "P6\n1 2\n255\n\x01\x02\x03\x04\x05\x06", 17, 3, &image), ORL_OK);
    static const uint8_t expected[6] = {1, 2, 3, 4, 5, 6};
    assert_memory_equal(image.u8, expected, sizeof expected);
    orl_image_finish(&image);
    assert_int_equal(orl_picture_read_linear(NULL, file, &image), ORL_OK);
    assert_float_equal(image.f32[0], 1 / 255.0 / 12.92, 1e-7);
    orl_image_finish(&image);
}

static void refuses_damage(void **state)
{
    (void)state;
    static const struct {
        const char *text, *why;
    } cases[] = {
        {"P5 2 ", "a number of the PNM header is missing"},
        {"P5 2 x 255\n\x01\x02", "a number of the PNM header is missing"},
        {"P5 2 1 255", "a number of the PNM header is missing"},
        {"P5 2 1 65535\n\x01\x01\x02\x02", "white is 65535"},
        {"P5 2 2 255\n\x01\x02\x03", "4 bytes of samples are needed, but only 3 follow"},
        {"P4 9 2\n\x01\x02\x03", "4 bytes of samples"},
        {"P6 99999 99999 255\n\x01", "its header asks for 99999x99999"},
        {"P5 0 2 255\n\x01", "its header asks for 0x2"},
        {"P3 1 1 255\n1 2 3\n", "not a picture of a known kind"},
    };
    for (size_t i = 0; i < ORL_COUNT(cases); i++) {
        struct said said;
        struct orl_log log = log_to(&said);
        struct orl_image image;
        enum orl_result result = read(&log, cases[i].text, strlen(cases[i].text), 1, &image);
        if (result != ORL_ERR_FORMAT || !strstr(said.text, cases[i].why))
            fail_msg("case %zu: %s: \"%s\" does not say \"%s\"", i, orl_result_name(result),
                     said.text, cases[i].why);
        assert_null(image.data);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(reads_bitmaps), cmocka_unit_test(reads_grey_and_colour),
        cmocka_unit_test(refuses_damage),
    };
    return cmocka_run_group_tests(tests, set_up, tear_down);
}
