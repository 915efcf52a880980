// Masks of the kinds that programs write mean one thing.
#include <math.h>
#include <string.h>

#include <png.h>

#include "io/mask.h"
#include "io/picture.h"
#include "test.h"

static char *dir, *file;

static int set_up(void **state)
{
    (void)state;
    return test_file_make("mask.png", &dir, &file);
}

static int tear_down(void **state)
{
    (void)state;
    return test_file_remove(dir, file);
}

// --- what a mask's pixels mean ---

// Writes one row of four pixels.
static void write_png(int depth, int color, uint8_t *row, const png_color palette[4])
{
    FILE *out = fopen(file, "wb");
    png_structp png = png_create_write_struct(PNG_LIBPNG_VER_STRING, NULL, NULL, NULL);
    png_infop info = png_create_info_struct(png);
    assert_non_null(out);
    assert_int_equal(setjmp(png_jmpbuf(png)), 0);
    png_init_io(png, out);
    png_set_IHDR(png, info, 4, 1, depth, color, PNG_INTERLACE_NONE, PNG_COMPRESSION_TYPE_DEFAULT,
                 PNG_FILTER_TYPE_DEFAULT);
    if (palette)
        png_set_PLTE(png, info, palette, 4);
    png_bytep rows[1] = {row};
    png_set_rows(png, info, rows);
    png_write_png(png, info, PNG_TRANSFORM_IDENTITY, NULL);
    png_destroy_write_struct(&png, &info);
    fclose(out);
}

// `want` has a letter for each pixel: x counts, . does not.
static void expect(const char *want)
{
    struct orl_image mask;
    assert_int_equal(orl_mask_read(NULL, file, false, &mask), ORL_OK);
    assert_int_equal(mask.channels, 1);
    size_t count = 0;
    for (int i = 0; i < 4; i++) {
        assert_int_equal(mask.u8[i], want[i] == 'x' ? 255 : 0);
        count += want[i] == 'x';
    }
    assert_int_equal(orl_mask_count(&mask), count);
    orl_image_finish(&mask);
}

static void takes_the_nearer_of_black_and_white(void **state)
{
    (void)state;
    write_png(8, PNG_COLOR_TYPE_GRAY, (uint8_t[]){0, 127, 128, 255}, NULL);
    expect("..xx");
    write_png(8, PNG_COLOR_TYPE_GRAY, (uint8_t[]){0, 100, 3, 90}, NULL);
    expect(".x.x");
    write_png(8, PNG_COLOR_TYPE_GRAY, (uint8_t[]){0, 0, 0, 0}, NULL);
    expect("....");
    write_png(1, PNG_COLOR_TYPE_GRAY, (uint8_t[]){0x50}, NULL);
    expect(".x.x");
}

static void takes_labels(void **state)
{
    (void)state;
    write_png(8, PNG_COLOR_TYPE_GRAY, (uint8_t[]){0, 1, 0, 1}, NULL);
    expect(".x.x");
    write_png(8, PNG_COLOR_TYPE_GRAY, (uint8_t[]){0, 1, 7, 20}, NULL);
    expect(".xxx");
    // Of 16 bits, where 1 is less than half a step of 8 bits.
    write_png(16, PNG_COLOR_TYPE_GRAY, (uint8_t[]){0, 0, 0, 1, 0, 0, 0, 2}, NULL);
    expect(".x.x");
    write_png(16, PNG_COLOR_TYPE_GRAY, (uint8_t[]){0, 0, 0, 1, 255, 255, 128, 0}, NULL);
    expect("..xx");
}

static void takes_colours(void **state)
{
    (void)state;
    write_png(8, PNG_COLOR_TYPE_RGB, (uint8_t[]){0, 0, 0, 255, 0, 0, 0, 0, 255, 0, 64, 0}, NULL);
    expect(".xxx");
    const png_color palette[4] = {{0, 0, 0}, {128, 0, 0}, {64, 0, 0}, {192, 128, 0}};
    write_png(2, PNG_COLOR_TYPE_PALETTE, (uint8_t[]){0x1b}, palette); // 0 1 2 3
    expect(".xxx");
}

static void takes_alpha_that_varies(void **state)
{
    (void)state;
    // White or black, with the mask in alpha; alpha that is everywhere the same says nothing.
    write_png(8, PNG_COLOR_TYPE_GRAY_ALPHA, (uint8_t[]){255, 0, 255, 255, 255, 9, 255, 200}, NULL);
    expect(".x.x");
    write_png(8, PNG_COLOR_TYPE_GRAY_ALPHA, (uint8_t[]){0, 0, 0, 255, 0, 9, 0, 200}, NULL);
    expect(".x.x");
    write_png(8, PNG_COLOR_TYPE_GRAY_ALPHA, (uint8_t[]){255, 0, 0, 0, 255, 0, 0, 0}, NULL);
    expect("x.x.");
    write_png(16, PNG_COLOR_TYPE_GRAY_ALPHA,
              (uint8_t[]){9, 9, 0, 0, 9, 9, 255, 255, 0, 0, 255, 255, 9, 9, 0, 0}, NULL);
    expect(".xx.");
}

static void reads_the_alpha_of_photographs(void **state)
{
    (void)state;
    struct orl_image mask;
    write_png(8, PNG_COLOR_TYPE_RGBA,
              (uint8_t[]){9, 8, 7, 0, 9, 8, 7, 255, 0, 0, 0, 255, 255, 255, 255, 1}, NULL);
    assert_int_equal(orl_mask_read(NULL, file, true, &mask), ORL_OK);
    assert_memory_equal(mask.u8, ((uint8_t[]){0, 255, 255, 0}), 4);
    orl_image_finish(&mask);
    write_png(8, PNG_COLOR_TYPE_GRAY, (uint8_t[]){0, 127, 128, 255}, NULL);
    assert_int_equal(orl_mask_read(NULL, file, true, &mask), ORL_OK);
    assert_null(mask.data);
}

static void takes_the_noise_of_jpeg(void **state)
{
    (void)state;
    enum { SIDE = 32 };
    struct orl_image image, mask;
    assert_int_equal(orl_image_init(NULL, &image, SIDE, SIDE, 1, ORL_PIXEL_U8), ORL_OK);
    for (int i = 0; i < SIDE * SIDE; i++)
        image.u8[i] = hypot(i % SIDE - 15.5, i / SIDE - 15.5) < 10 ? 255 : 0;
    assert_int_equal(orl_jpeg_write(NULL, file, &image, 75, NULL), ORL_OK);
    assert_int_equal(orl_mask_read(NULL, file, false, &mask), ORL_OK);
    int wrong = 0;
    for (int i = 0; i < SIDE * SIDE; i++)
        wrong += mask.u8[i] != image.u8[i];
    assert_true(wrong <= 4);
    orl_image_finish(&image);
    orl_image_finish(&mask);
}

// --- where a mask is ---

static void expect_found(const char *name, const char *want)
{
    char path[ORL_PATH_SIZE];
    assert_int_equal(orl_mask_find(dir, name, path), want != NULL);
    if (want)
        assert_string_equal(path, ORL_PATH(dir, "%s", want));
}

static void finds_masks(void **state)
{
    (void)state;
    static const char *const files[] = {"a/1.jpg.png", "b/1.png", "2_mask.png", "3.mask.PNG",
                                        "4.jpg", "5.v1.png"};
    for (size_t i = 0; i < sizeof files / sizeof *files; i++) {
        char *path = orl_path_join(NULL, dir, files[i]);
        char *folder = orl_path_join(NULL, dir, files[i][1] == '/' ? (char[]){files[i][0], 0} : "");
        assert_int_equal(orl_dir_make(NULL, folder), ORL_OK);
        assert_int_equal(orl_file_write(NULL, path, "", 0), ORL_OK);
        free(path);
        free(folder);
    }
    expect_found("a/1.jpg", "a/1.jpg.png");
    expect_found("b/1.jpg", "b/1.png");
    expect_found("1.jpg", NULL);
    expect_found("2.jpg", "2_mask.png");
    expect_found("3.jpg", "3.mask.PNG");
    expect_found("4.png", "4.jpg");
    expect_found("5.v1.jpg", "5.v1.png");
    expect_found("c.d/5", NULL);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test_setup_teardown(takes_the_nearer_of_black_and_white, set_up, tear_down),
        cmocka_unit_test_setup_teardown(takes_labels, set_up, tear_down),
        cmocka_unit_test_setup_teardown(takes_colours, set_up, tear_down),
        cmocka_unit_test_setup_teardown(takes_alpha_that_varies, set_up, tear_down),
        cmocka_unit_test_setup_teardown(reads_the_alpha_of_photographs, set_up, tear_down),
        cmocka_unit_test_setup_teardown(takes_the_noise_of_jpeg, set_up, tear_down),
        cmocka_unit_test_setup_teardown(finds_masks, set_up, tear_down),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
