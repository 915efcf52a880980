#include "test.h"

#include <math.h>
#include <string.h>
#include <sys/resource.h>
#include <unistd.h>

#include <jpeglib.h>
#include <png.h>

#include "core/memory.h"
#include "io/picture.h"

enum { W = 37, H = 29 };

static char *dir, *file;

static int set_up(void **state)
{
    (void)state;
    return test_file_make("picture", &dir, &file); // readers go by content
}

static int tear_down(void **state)
{
    (void)state;
    return test_file_remove(dir, file);
}

static uint32_t noise(uint32_t *state)
{
    *state = *state * 1664525u + 1013904223u;
    return *state >> 8;
}

// Smooth, so that JPEG keeps it.
static struct orl_image smooth(int channels)
{
    struct orl_image image;
    assert_int_equal(orl_image_init(NULL, &image, W, H, channels, ORL_PIXEL_U8), ORL_OK);
    for (int i = 0; i < W * H; i++)
        for (int c = 0; c < channels; c++)
            image.u8[channels * i + c] =
                (uint8_t)lround(128 + 90 * sin(0.13 * (i % W) + 0.1 * (i / W) * (c + 1)));
    return image;
}

static void write_bytes(const void *data, size_t size)
{
    // Many are written: a new file each, without orl_file_write's flush to disk.
    remove(file);
    FILE *out = fopen(file, "wb");
    assert_non_null(out);
    assert_int_equal(fwrite(data, 1, size, out), size);
    assert_int_equal(fclose(out), 0);
}

static enum orl_result read_back(int channels, struct orl_image *image)
{
    return orl_picture_read(NULL, file, channels, image);
}

static void expect_error(enum orl_result want)
{
    struct orl_image image;
    int width = 7, height = 7;
    assert_int_equal(read_back(3, &image), want);
    assert_null(image.data);
    assert_int_equal(orl_picture_size(NULL, file, &width, &height), want);
    assert_int_equal(width, 0);
    assert_int_equal(height, 0);
}

// --- round trips ---

static void png_comes_back_exactly(void **state)
{
    (void)state;
    for (int channels = 1; channels <= 3; channels += 2) {
        struct orl_image image = smooth(channels), back;
        int width, height;
        assert_int_equal(orl_png_write(NULL, file, &image), ORL_OK);
        assert_int_equal(orl_picture_size(NULL, file, &width, &height), ORL_OK);
        assert_int_equal(width, W);
        assert_int_equal(height, H);
        assert_int_equal(read_back(channels, &back), ORL_OK);
        assert_int_equal(back.channels, channels);
        assert_memory_equal(back.u8, image.u8, orl_image_bytes(&image));
        orl_image_finish(&image);
        orl_image_finish(&back);
    }
}

static void jpeg_comes_back_nearly(void **state)
{
    (void)state;
    for (int channels = 1; channels <= 3; channels += 2) {
        struct orl_image image = smooth(channels), back;
        assert_int_equal(orl_jpeg_write(NULL, file, &image, 95, NULL), ORL_OK);
        assert_int_equal(read_back(channels, &back), ORL_OK);
        for (size_t i = 0; i < orl_image_bytes(&image); i++)
            assert_true(abs(back.u8[i] - image.u8[i]) < 10);
        orl_image_finish(&image);
        orl_image_finish(&back);
    }
}

static void luma_of_pure_colours(void **state)
{
    (void)state;
    struct orl_image image, back;
    assert_int_equal(orl_image_init(NULL, &image, 4, 1, 3, ORL_PIXEL_U8), ORL_OK);
    const uint8_t pixels[12] = {255, 0, 0, 0, 255, 0, 0, 0, 255, 200, 100, 50};
    memcpy(image.u8, pixels, sizeof pixels);
    assert_int_equal(orl_png_write(NULL, file, &image), ORL_OK);
    assert_int_equal(read_back(1, &back), ORL_OK);
    const uint8_t want[4] = {76, 150, 29, 124};
    assert_memory_equal(back.u8, want, sizeof want);
    orl_image_finish(&image);
    orl_image_finish(&back);
}

static void gray_becomes_rgb(void **state)
{
    (void)state;
    struct orl_image image = smooth(1), back;
    assert_int_equal(orl_png_write(NULL, file, &image), ORL_OK);
    assert_int_equal(read_back(3, &back), ORL_OK);
    for (int i = 0; i < W * H * 3; i++)
        assert_int_equal(back.u8[i], image.u8[i / 3]);
    orl_image_finish(&image);
    orl_image_finish(&back);
}

static void quality_changes_the_size(void **state)
{
    (void)state;
    struct orl_image image = smooth(3);
    size_t low, high;
    uint8_t *data;
    assert_int_equal(orl_jpeg_write(NULL, file, &image, 30, NULL), ORL_OK);
    assert_int_equal(orl_file_read(NULL, file, 1 << 20, &data, &low), ORL_OK);
    free(data);
    assert_int_equal(orl_jpeg_write(NULL, file, &image, 98, NULL), ORL_OK);
    assert_int_equal(orl_file_read(NULL, file, 1 << 20, &data, &high), ORL_OK);
    free(data);
    assert_true(high > low);
    orl_image_finish(&image);
}

// --- PNG of every kind, made with libpng itself ---

struct png_kind {
    int depth, color, interlace;
};

// Rows of 4 pixels whose samples are `row`, twice.
static void write_png(struct png_kind kind, png_bytep row, const png_color *palette)
{
    FILE *out = fopen(file, "wb");
    png_structp png = png_create_write_struct(PNG_LIBPNG_VER_STRING, NULL, NULL, NULL);
    png_infop info = png_create_info_struct(png);
    assert_non_null(out);
    assert_int_equal(setjmp(png_jmpbuf(png)), 0);
    png_init_io(png, out);
    png_set_IHDR(png, info, 4, 2, kind.depth, kind.color, kind.interlace,
                 PNG_COMPRESSION_TYPE_DEFAULT, PNG_FILTER_TYPE_DEFAULT);
    png_set_gAMA(png, info, 1 / 2.2); // must not change what is stored
    if (palette)
        png_set_PLTE(png, info, palette, 3);
    png_bytep rows[2] = {row, row};
    png_set_rows(png, info, rows);
    png_write_png(png, info, PNG_TRANSFORM_IDENTITY, NULL);
    png_destroy_write_struct(&png, &info);
    fclose(out);
}

static void expect_rgb(const uint8_t want[12])
{
    struct orl_image image;
    assert_int_equal(read_back(3, &image), ORL_OK);
    assert_int_equal(image.width, 4);
    assert_int_equal(image.height, 2);
    assert_memory_equal(image.u8, want, 12);
    assert_memory_equal(image.u8 + 12, want, 12);
    orl_image_finish(&image);
}

static void png_of_sixteen_bits_is_rounded(void **state)
{
    (void)state;
    // 0x0081 is 0.502 steps of 257: 1; 0x0080 is 0.498: 0.
    uint8_t row[24] = {0x00, 0x81, 0x00, 0x80, 0xff, 0xff, 0x12, 0x12, 0x7f, 0x00, 0x80, 0x00,
                       0xff, 0x7e, 0xff, 0x80, 0x01, 0x00, 0x01, 0x82, 0x00, 0x00, 0xab, 0xcd};
    const uint8_t want[12] = {1, 0, 255, 0x12, 127, 128, 254, 255, 1, 2, 0, 171};
    write_png((struct png_kind){16, PNG_COLOR_TYPE_RGB, PNG_INTERLACE_NONE}, row, NULL);
    expect_rgb(want);
}

static void png_alpha_is_dropped(void **state)
{
    (void)state;
    uint8_t row[16] = {1, 2, 3, 0, 4, 5, 6, 128, 7, 8, 9, 255, 10, 11, 12, 1};
    const uint8_t want[12] = {1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11, 12};
    write_png((struct png_kind){8, PNG_COLOR_TYPE_RGBA, PNG_INTERLACE_ADAM7}, row, NULL);
    expect_rgb(want);
    uint8_t gray[8] = {10, 0, 20, 99, 30, 255, 40, 7};
    const uint8_t want_gray[12] = {10, 10, 10, 20, 20, 20, 30, 30, 30, 40, 40, 40};
    write_png((struct png_kind){8, PNG_COLOR_TYPE_GRAY_ALPHA, PNG_INTERLACE_NONE}, gray, NULL);
    expect_rgb(want_gray);
}

static void png_palette_and_bits_are_expanded(void **state)
{
    (void)state;
    const png_color palette[3] = {{1, 2, 3}, {40, 50, 60}, {255, 0, 7}};
    uint8_t indices[1] = {0x24}; // 2-bit: 0 2 1 0
    const uint8_t want[12] = {1, 2, 3, 255, 0, 7, 40, 50, 60, 1, 2, 3};
    write_png((struct png_kind){2, PNG_COLOR_TYPE_PALETTE, PNG_INTERLACE_NONE}, indices, palette);
    expect_rgb(want);
    uint8_t bits[1] = {0x50}; // 1-bit gray: 0 1 0 1
    const uint8_t want_bits[12] = {0, 0, 0, 255, 255, 255, 0, 0, 0, 255, 255, 255};
    write_png((struct png_kind){1, PNG_COLOR_TYPE_GRAY, PNG_INTERLACE_ADAM7}, bits, NULL);
    expect_rgb(want_bits);
}

// --- JPEG of other kinds ---

static void write_jpeg(J_COLOR_SPACE space, int components, bool progressive)
{
    struct jpeg_compress_struct info;
    struct jpeg_error_mgr error;
    FILE *out = fopen(file, "wb");
    assert_non_null(out);
    info.err = jpeg_std_error(&error);
    jpeg_create_compress(&info);
    jpeg_stdio_dest(&info, out);
    info.image_width = W;
    info.image_height = H;
    info.input_components = components;
    info.in_color_space = space;
    jpeg_set_defaults(&info);
    if (progressive)
        jpeg_simple_progression(&info);
    jpeg_start_compress(&info, TRUE);
    uint8_t row[W * 4];
    for (int y = 0; y < H; y++) {
        for (int i = 0; i < W * components; i++)
            row[i] = (uint8_t)(4 * (i / components) + y);
        JSAMPROW rows[1] = {row};
        jpeg_write_scanlines(&info, rows, 1);
    }
    jpeg_finish_compress(&info);
    jpeg_destroy_compress(&info);
    fclose(out);
}

static void progressive_jpeg(void **state)
{
    (void)state;
    struct orl_image image;
    write_jpeg(JCS_RGB, 3, true);
    assert_int_equal(read_back(3, &image), ORL_OK);
    assert_true(abs(image.u8[3 * (10 * W + 20)] - (80 + 10)) < 12);
    orl_image_finish(&image);
}

static void cmyk_jpeg_is_refused(void **state)
{
    (void)state;
    struct orl_image image;
    write_jpeg(JCS_CMYK, 4, false);
    assert_int_equal(read_back(3, &image), ORL_ERR_FORMAT);
    assert_null(image.data);
}

// --- damage ---

static void not_pictures(void **state)
{
    (void)state;
    write_bytes("", 0);
    expect_error(ORL_ERR_FORMAT);
    write_bytes("GIF89a", 6);
    expect_error(ORL_ERR_FORMAT);
    write_bytes("\xff\xd8\xff", 3);
    expect_error(ORL_ERR_FORMAT);
    write_bytes("\x89PNG\r\n\x1a\n", 8);
    expect_error(ORL_ERR_FORMAT);
    struct orl_image image;
    assert_int_equal(orl_picture_read(NULL, "/nowhere/at/all.jpg", 3, &image), ORL_ERR_NOT_FOUND);
    assert_int_equal(orl_picture_read(NULL, dir, 3, &image), ORL_ERR_IO);
}

static uint8_t *file_bytes(size_t *size)
{
    uint8_t *data;
    assert_int_equal(orl_file_read(NULL, file, 1 << 24, &data, size), ORL_OK);
    return data;
}

static void write_kind(int kind, int channels)
{
    struct orl_image image = smooth(channels);
    if (kind == 0)
        assert_int_equal(orl_png_write(NULL, file, &image), ORL_OK);
    else if (kind == 1)
        assert_int_equal(orl_jpeg_write(NULL, file, &image, 90, NULL), ORL_OK);
    else
        write_jpeg(JCS_RGB, 3, true);
    orl_image_finish(&image);
}

// A picture that was cut off anywhere, even before its last byte, is an error.
static void every_truncation_is_an_error(void **state)
{
    (void)state;
    for (int kind = 0; kind < 3; kind++) {
        size_t size;
        write_kind(kind, 3);
        uint8_t *data = file_bytes(&size);
        for (size_t keep = 0; keep < size; keep += keep < 700 && keep + 40 < size ? 13 : 1) {
            struct orl_image image;
            write_bytes(data, keep);
            assert_int_equal(read_back(3, &image), ORL_ERR_FORMAT);
            assert_null(image.data);
        }
        free(data);
    }
}

static void random_damage_never_crashes(void **state)
{
    (void)state;
    uint32_t seed = 3;
    for (int kind = 0; kind < 3; kind++) {
        size_t size, failed = 0;
        write_kind(kind, kind == 1 ? 1 : 3);
        uint8_t *data = file_bytes(&size), *copy = orl_array(NULL, size, 1);
        for (int round = 0; round < 700; round++) {
            memcpy(copy, data, size);
            for (uint32_t n = 1 + noise(&seed) % 4; n; n--) // half of them near the start
                copy[noise(&seed) % (round % 2 ? size : 64)] ^= (uint8_t)(1u << noise(&seed) % 8);
            write_bytes(copy, size);
            struct orl_image image;
            struct orl_picture_info info;
            int width, height;
            enum orl_result result = read_back(round % 3 ? 3 : 1, &image);
            assert_true(result == ORL_OK ? image.data != NULL : image.data == NULL);
            failed += result != ORL_OK;
            orl_image_finish(&image);
            result = orl_picture_size(NULL, file, &width, &height);
            assert_true(result == ORL_OK ? width > 0 && height > 0 : width == 0 && height == 0);
            result = orl_picture_inspect(NULL, file, &info);
            assert_true(result == ORL_OK || info.exif.make[0] == '\0');
        }
        assert_true(failed > 100);
        free(copy);
        free(data);
    }
}

static void put_be32(uint8_t *to, uint32_t value)
{
    for (int i = 0; i < 4; i++)
        to[i] = (uint8_t)(value >> (24 - 8 * i));
}

static uint32_t crc_of(const uint8_t *data, size_t size)
{
    uint32_t crc = 0xffffffff;
    for (size_t k = 0; k < size; k++) {
        crc ^= data[k];
        for (int bit = 0; bit < 8; bit++)
            crc = crc >> 1 ^ (crc & 1 ? 0xedb88320 : 0);
    }
    return ~crc;
}

// A few hostile bytes must not make the reader allocate what they claim.
static void huge_claims_are_refused(void **state)
{
    (void)state;
    size_t size;
    struct orl_image image;
    write_kind(1, 3);
    uint8_t *data = file_bytes(&size), *frame = NULL;
    for (size_t i = 2; i + 9 < size && !frame; i += 2u + (size_t)data[i + 2] * 256 + data[i + 3])
        if (data[i + 1] == 0xc0)
            frame = data + i;
    assert_non_null(frame);
    memset(frame + 5, 0xff, 2); // height 65535
    memset(frame + 7, 0xff, 2); // width
    write_bytes(data, size);
    assert_int_equal(read_back(3, &image), ORL_ERR_FORMAT);
    free(data);

    write_kind(0, 3);
    data = file_bytes(&size);
    const uint32_t sides[] = {60000, 0x7fffffff, 0xffffffff, 0};
    for (size_t i = 0; i < ORL_COUNT(sides); i++) {
        put_be32(data + 16, sides[i]);
        put_be32(data + 20, sides[i]);
        put_be32(data + 29, crc_of(data + 12, 17)); // so that only the size is wrong
        write_bytes(data, size);
        assert_int_equal(read_back(3, &image), ORL_ERR_FORMAT);
    }
    free(data);
}

// libpng zeroes what a chunk claims to hold ahead of reading it.
static void a_chunk_takes_no_more_than_the_file(void **state)
{
    (void)state;
    const long most_kib = 1 << 18; // beyond what the program took before
    const size_t header = 33; // signature and IHDR
    struct rusage before, after;
    struct orl_image image;
    struct orl_picture_info info;
    size_t size;
    write_kind(0, 3);
    uint8_t *data = file_bytes(&size), *longer = calloc(1, size + 8);
    assert_non_null(longer);
    memcpy(longer, data, header);
    put_be32(longer + header, 0x7f000000);
    memcpy(longer + header + 4, "tEXt", 4);
    memcpy(longer + header + 8, data + header, size - header);
    write_bytes(longer, size + 8);
    assert_int_equal(getrusage(RUSAGE_SELF, &before), 0);
    assert_int_equal(read_back(3, &image), ORL_ERR_FORMAT);
    assert_int_equal(orl_picture_inspect(NULL, file, &info), ORL_ERR_FORMAT);
    assert_int_equal(getrusage(RUSAGE_SELF, &after), 0);
    assert_true(after.ru_maxrss - before.ru_maxrss < most_kib);
    free(data);
    free(longer);
}

// Room for `room` bytes more than there are, until the test ends.
static struct rlimit limit_memory(size_t room)
{
    struct rlimit before, tight;
    unsigned long long pages = 0;
    FILE *statm = fopen("/proc/self/statm", "r");
    assert_non_null(statm);
    assert_int_equal(fscanf(statm, "%llu", &pages), 1);
    fclose(statm);
    assert_int_equal(getrlimit(RLIMIT_AS, &before), 0);
    tight = before;
    tight.rlim_cur = (rlim_t)pages * (rlim_t)sysconf(_SC_PAGE_SIZE) + room;
    assert_int_equal(setrlimit(RLIMIT_AS, &tight), 0);
    return before;
}

// A header may claim what the file could hold, and still be more than this machine has.
static void more_than_the_memory_left_is_refused(void **state)
{
    (void)state;
    struct said said;
    struct orl_log log = log_to(&said);
    for (int kind = 0; kind < 2; kind++) {
        struct orl_image image;
        size_t size, padded = 4 << 20;
        write_kind(kind, 3);
        uint8_t *data = file_bytes(&size), *bomb = calloc(1, padded);
        memcpy(bomb, data, size);
        if (kind == 0) {
            put_be32(bomb + 16, 30000);
            put_be32(bomb + 20, 30000);
            put_be32(bomb + 29, crc_of(bomb + 12, 17));
        }
        for (size_t i = 2; kind && i + 9 < size; i += 2u + (size_t)bomb[i + 2] * 256 + bomb[i + 3])
            if (bomb[i + 1] == 0xc0) {
                put_be32(bomb + i + 5, 30000u << 16 | 30000u);
                break;
            }
        write_bytes(bomb, padded);
        struct rlimit before = limit_memory((size_t)1 << 30);
        enum orl_result result = orl_picture_read(&log, file, 3, &image);
        assert_int_equal(setrlimit(RLIMIT_AS, &before), 0);
        assert_int_equal(result, ORL_ERR_MEMORY);
        assert_non_null(strstr(said.text, "30000x30000 pixels take 2.5 GiB of memory to read"));
        assert_null(image.data);
        free(data);
        free(bomb);
        said.text[0] = '\0';
    }
}

// --- writing ---

static void a_failed_write_leaves_nothing(void **state)
{
    (void)state;
    struct orl_image image = smooth(3);
    struct orl_names names;
    char *inside = orl_path_join(NULL, file, "b.png");
    write_bytes("old", 3); // so `inside` lies in no folder
    assert_int_equal(orl_png_write(NULL, inside, &image), ORL_ERR_IO);
    assert_int_equal(orl_jpeg_write(NULL, inside, &image, 90, NULL), ORL_ERR_IO);
    assert_int_equal(orl_dir_list(NULL, dir, &names), ORL_OK);
    assert_int_equal(names.count, 1);
    orl_names_finish(&names);
    free(inside);
    orl_image_finish(&image);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(png_comes_back_exactly),
        cmocka_unit_test(jpeg_comes_back_nearly),
        cmocka_unit_test(luma_of_pure_colours),
        cmocka_unit_test(gray_becomes_rgb),
        cmocka_unit_test(quality_changes_the_size),
        cmocka_unit_test(png_of_sixteen_bits_is_rounded),
        cmocka_unit_test(png_alpha_is_dropped),
        cmocka_unit_test(png_palette_and_bits_are_expanded),
        cmocka_unit_test(progressive_jpeg),
        cmocka_unit_test(cmyk_jpeg_is_refused),
        cmocka_unit_test(not_pictures),
        cmocka_unit_test(every_truncation_is_an_error),
        cmocka_unit_test(random_damage_never_crashes),
        cmocka_unit_test(huge_claims_are_refused),
        cmocka_unit_test(a_chunk_takes_no_more_than_the_file),
        cmocka_unit_test(more_than_the_memory_left_is_refused),
        cmocka_unit_test(a_failed_write_leaves_nothing),
    };
    return cmocka_run_group_tests(tests, set_up, tear_down);
}
