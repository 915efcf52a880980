#include "test.h"

#include <math.h>
#include <signal.h>
#include <string.h>
#include <sys/resource.h>
#include <unistd.h>

#include <OpenEXR/openexr.h>

#include "core/memory.h"
#include "core/process.h"
#include "io/exr.h"
#include "opencv_files.h"

static char *dir, *file;

static int set_up(void **state)
{
    (void)state;
    return test_file_make("a.exr", &dir, &file);
}

static int tear_down(void **state)
{
    (void)state;
    return test_file_remove(dir, file);
}

// Any reproducible noise (Numerical Recipes' constants).
static uint32_t noise(uint32_t *state)
{
    *state = *state * 1664525u + 1013904223u;
    return *state >> 8;
}

static struct orl_image picture(int width, int height, int channels)
{
    struct orl_image image;
    assert_int_equal(orl_image_init(NULL, &image, width, height, channels, ORL_PIXEL_F32), ORL_OK);
    for (int i = 0; i < width * height * channels; i++)
        image.f32[i] = (float)sin(0.01 * i) * (float)(1 + i % channels);
    return image;
}

static struct orl_exr_params rgb_params(const struct orl_image *image, bool half)
{
    static const char *const names[] = {"R", "G", "B", "A"};
    struct orl_exr_params params = {.width = image->width, .height = image->height,
                                    .channel_count = image->channels};
    for (int c = 0; c < image->channels; c++) {
        params.channels[c] = (struct orl_exr_channel){
            .half = half, .data = image->f32 + c, .stride = (size_t)image->channels};
        strcpy(params.channels[c].name, names[c]);
    }
    return params;
}

// Sizes around the 16 lines of a chunk.
static void floats_come_back_exactly(void **state)
{
    (void)state;
    static const char *const rgb[] = {"R", "G", "B"};
    const int sizes[][2] = {{1, 1}, {7, 15}, {16, 16}, {33, 17}, {5, 64}, {200, 33}};
    for (size_t i = 0; i < ORL_COUNT(sizes); i++) {
        struct orl_image image = picture(sizes[i][0], sizes[i][1], 3), back;
        image.f32[0] = INFINITY;
        struct orl_exr_params params = rgb_params(&image, false);
        assert_int_equal(orl_exr_write(NULL, file, &params), ORL_OK);
        assert_int_equal(orl_exr_read(NULL, file, rgb, 3, &back), ORL_OK);
        assert_int_equal(back.width, image.width);
        assert_int_equal(back.height, image.height);
        assert_int_equal(back.channels, 3);
        assert_memory_equal(back.f32, image.f32, orl_image_bytes(&image));
        orl_image_finish(&image);
        orl_image_finish(&back);
    }
}

static void piz_is_lossless_too(void **state)
{
    (void)state;
    static const char *const rgb[] = {"R", "G", "B"};
    const int sizes[][2] = {{1, 1}, {7, 31}, {33, 32}, {64, 65}};
    for (size_t i = 0; i < 2 * ORL_COUNT(sizes); i++) {
        struct orl_image image = picture(sizes[i / 2][0], sizes[i / 2][1], 3), back;
        bool half = i % 2 == 0;
        for (size_t k = 0; half && k < orl_image_bytes(&image) / sizeof(float); k++)
            image.f32[k] = (float)((int)k % 1024) / 512; // halves hold these exactly
        struct orl_exr_params params = rgb_params(&image, half);
        params.compression = ORL_EXR_PIZ;
        assert_int_equal(orl_exr_write(NULL, file, &params), ORL_OK);
        assert_int_equal(orl_exr_read(NULL, file, rgb, 3, &back), ORL_OK);
        assert_memory_equal(back.f32, image.f32, orl_image_bytes(&image));
        orl_image_finish(&image);
        orl_image_finish(&back);
    }
}

static void halves_round_and_clamp(void **state)
{
    (void)state;
    static const char *const red[] = {"R"};
    const float given[] = {0, 1, -2.5f, 0.1f, 1e6f, -1e6f, 65504, 65519, INFINITY, 1e-8f};
    // 0.1 lies between 1638 and 1639 / 16384; 2^-24 is the smallest half.
    const float want[] = {0, 1, -2.5f, 0.0999755859375f, 65504, -65504, 65504, 65504, INFINITY, 0};
    struct orl_image image, back;
    assert_int_equal(orl_image_init(NULL, &image, (int)ORL_COUNT(given), 1, 1, ORL_PIXEL_F32),
                     ORL_OK);
    memcpy(image.f32, given, sizeof given);
    struct orl_exr_params params = rgb_params(&image, true);
    assert_int_equal(orl_exr_write(NULL, file, &params), ORL_OK);
    assert_int_equal(orl_exr_read(NULL, file, red, 1, &back), ORL_OK);
    for (size_t i = 0; i < ORL_COUNT(want); i++)
        assert_true(back.f32[i] == want[i]);
    orl_image_finish(&image);
    orl_image_finish(&back);
}

// Every mix of noise and order, so that many chunks compress to about their own size:
// one that compresses to exactly that size must not be taken for uncompressed.
static void chunks_that_hardly_compress(void **state)
{
    (void)state;
    static const char *const red[] = {"R"};
    enum { WIDTH = 8, CHUNKS = 4000 };
    struct orl_image image, back;
    assert_int_equal(orl_image_init(NULL, &image, WIDTH, 16 * CHUNKS, 1, ORL_PIXEL_F32), ORL_OK);
    uint32_t seed = 1;
    for (int i = 0; i < WIDTH * 16 * CHUNKS; i++) {
        uint32_t bits = 0x3f000000u | (noise(&seed) & 0x7fffffu);
        if (i % 128 < i / 128 % 32) // this many orderly samples in the chunk
            bits = 0x3f000000u;
        memcpy(&image.f32[i], &bits, sizeof bits);
    }
    struct orl_exr_params params = rgb_params(&image, false);
    assert_int_equal(orl_exr_write(NULL, file, &params), ORL_OK);
    assert_int_equal(orl_exr_read(NULL, file, red, 1, &back), ORL_OK);
    assert_memory_equal(back.f32, image.f32, orl_image_bytes(&image));
    orl_image_finish(&image);
    orl_image_finish(&back);
}

static void layers_and_channel_choice(void **state)
{
    (void)state;
    struct orl_image color = picture(40, 20, 3), depth = picture(40, 20, 1), back;
    struct orl_exr_params params = rgb_params(&color, false);
    params.channels[3] =
        (struct orl_exr_channel){.name = "depth.Z", .data = depth.f32, .stride = 1};
    params.channel_count = 4;
    assert_int_equal(orl_exr_write(NULL, file, &params), ORL_OK);
    static const char *const two[] = {"depth.Z", "G"}, *const missing[] = {"G", "normal.X"};
    assert_int_equal(orl_exr_read(NULL, file, two, 2, &back), ORL_OK);
    for (int i = 0; i < 40 * 20; i++) {
        assert_true(back.f32[2 * i] == depth.f32[i]);
        assert_true(back.f32[2 * i + 1] == color.f32[3 * i + 1]);
    }
    orl_image_finish(&back);
    assert_int_equal(orl_exr_read(NULL, file, missing, 2, &back), ORL_ERR_NOT_FOUND);
    assert_null(back.data);
    orl_image_finish(&color);
    orl_image_finish(&depth);
}

// --- attributes ---

static exr_attr_m44f_t matrix(exr_context_t context, const char *name)
{
    exr_attr_m44f_t m;
    assert_int_equal(exr_attr_get_m44f(context, 0, name, &m), EXR_ERR_SUCCESS);
    return m;
}

// Row vector from the left, divided by w.
static void transform(const exr_attr_m44f_t *m, const double point[3], double out[3])
{
    double h[4];
    for (int c = 0; c < 4; c++)
        h[c] = point[0] * m->m[c] + point[1] * m->m[4 + c] + point[2] * m->m[8 + c] + m->m[12 + c];
    for (int c = 0; c < 3; c++)
        out[c] = h[c] / h[3];
}

static void camera_attributes(void **state)
{
    (void)state;
    struct orl_image image = picture(64, 32, 1);
    struct orl_view view = {.camera = {64, 32, 70, 75, 30, 17}};
    view.cam_from_world =
        orl_pose_look_at((double[]){1, -2, 3}, (double[]){0.2, 0.1, -0.5}, (double[]){0, -1, 0.2});
    struct orl_exr_params params = rgb_params(&image, true);
    params.attributes = (struct orl_exr_view_attributes){
        .view = &view, .srgb_primaries = true, .comments = "a comment"};
    assert_int_equal(orl_exr_write(NULL, file, &params), ORL_OK);

    exr_context_t context;
    assert_int_equal(exr_start_read(&context, file, NULL), EXR_ERR_SUCCESS);
    exr_attr_m44f_t camera = matrix(context, "worldToCamera"), ndc = matrix(context, "worldToNDC");
    const double world[3] = {0.3, 0.4, -0.2};
    double cam[3], pixel[2], depth, out[3];
    orl_pose_apply(&view.cam_from_world, world, cam);
    assert_true(orl_view_project(&view, world, pixel, &depth));
    transform(&camera, world, out);
    assert_float_equal(out[0], cam[0], 1e-5);
    assert_float_equal(out[1], -cam[1], 1e-5); // y up
    assert_float_equal(out[2], cam[2], 1e-5);  // z forward
    transform(&ndc, world, out);
    assert_float_equal(out[0], pixel[0] / 64, 1e-5);
    assert_float_equal(out[1], pixel[1] / 32, 1e-5);
    float number;
    exr_attr_v2f_t centre;
    assert_int_equal(exr_get_screen_window_width(context, 0, &number), EXR_ERR_SUCCESS);
    assert_float_equal(number, 64.0 / 70, 1e-6);
    assert_int_equal(exr_get_screen_window_center(context, 0, &centre), EXR_ERR_SUCCESS);
    assert_float_equal(centre.x, (32 - 30) / 70.0, 1e-6); // right of the axis
    assert_float_equal(centre.y, (17 - 16) / 75.0, 1e-6); // above it
    exr_attr_chromaticities_t c;
    assert_int_equal(exr_attr_get_chromaticities(context, 0, "chromaticities", &c),
                     EXR_ERR_SUCCESS);
    assert_float_equal(c.green_y, 0.6, 1e-6);
    int32_t length;
    const char *text;
    assert_int_equal(exr_attr_get_string(context, 0, "comments", &length, &text),
                     EXR_ERR_SUCCESS);
    assert_string_equal(text, "a comment");
    exr_finish(&context);
    orl_image_finish(&image);
}

static void nothing_is_said_that_is_not_known(void **state)
{
    (void)state;
    struct orl_image image = picture(4, 4, 1);
    struct orl_exr_params params = rgb_params(&image, true);
    assert_int_equal(orl_exr_write(NULL, file, &params), ORL_OK);
    exr_context_t context;
    exr_context_initializer_t init = EXR_DEFAULT_CONTEXT_INITIALIZER;
    assert_int_equal(exr_start_read(&context, file, &init), EXR_ERR_SUCCESS);
    static const char *const names[] = {"worldToCamera", "worldToNDC", "chromaticities", "comments"};
    const exr_attribute_t *attribute;
    for (size_t i = 0; i < ORL_COUNT(names); i++)
        assert_int_not_equal(exr_get_attribute_by_name(context, 0, names[i], &attribute),
                             EXR_ERR_SUCCESS);
    exr_finish(&context);
    orl_image_finish(&image);
}

// --- other readers ---

static struct orl_exr_params framed(const struct orl_image *color, const struct orl_image *depth,
                                    const struct orl_view *view)
{
    struct orl_exr_params params = rgb_params(color, true);
    params.attributes = (struct orl_exr_view_attributes){
        .view = view, .srgb_primaries = true, .comments = "seen by others"};
    assert_true(orl_exr_add_channel(&params, "depth.Z", false, depth, 0));
    assert_false(orl_exr_add_channel(&params, "a name that is longer than any channel's", false,
                                     depth, 0));
    return params;
}

// OpenCV decodes with OpenEXR's C++ library.
static void opencv_reads_the_same_colours(void **state)
{
    (void)state;
    struct orl_image color = picture(37, 21, 3), depth = picture(37, 21, 1);
    float *seen = orl_array(NULL, 37 * 21 * 3, sizeof *seen);
    for (int compression = ORL_EXR_ZIP; compression <= ORL_EXR_PIZ; compression++) {
        struct orl_exr_params params = framed(&color, &depth, NULL);
        params.compression = (enum orl_exr_compression)compression;
        assert_int_equal(orl_exr_write(NULL, file, &params), ORL_OK);
        assert_true(test_opencv_read_rgb(file, 37, 21, seen));
        for (int i = 0; i < 37 * 21 * 3; i++)
            assert_float_equal(seen[i], color.f32[i], 1e-3 * fabsf(color.f32[i]) + 1e-7);
    }
    free(seen);
    orl_image_finish(&color);
    orl_image_finish(&depth);
}

static void keep_line(void *priv, const char *line)
{
    struct said *said = priv;
    test_listen(said, ORL_LOG_INFO, line);
}

// False when the program is not installed.
static bool ask(const char *const *argv, struct said *said)
{
    said->text[0] = '\0';
    enum orl_result result = orl_process_run(
        NULL, &(struct orl_process_params){.argv = argv, .line = keep_line, .line_priv = said},
        NULL);
    if (result == ORL_ERR_NOT_FOUND)
        return false;
    assert_int_equal(result, ORL_OK);
    return true;
}

static void exrheader_sees_channels_and_attributes(void **state)
{
    (void)state;
    struct orl_image color = picture(64, 32, 3), depth = picture(64, 32, 1);
    struct orl_view view = {.camera = {64, 32, 70, 75, 30, 17}};
    view.cam_from_world.r[0][0] = view.cam_from_world.r[1][1] = view.cam_from_world.r[2][2] = 1;
    view.cam_from_world.t[1] = 2;
    view.cam_from_world.t[2] = 5;
    struct orl_exr_params params = framed(&color, &depth, &view);
    assert_int_equal(orl_exr_write(NULL, file, &params), ORL_OK);
    struct said said;
    if (!ask((const char *const[]){"exrheader", file, NULL}, &said)) {
        printf("skipped: exrheader (Debian's openexr) is not installed\n");
        orl_image_finish(&color);
        orl_image_finish(&depth);
        skip();
    }
    static const char *const lines[] = {
        "depth.Z, 32-bit floating-point", "R, 16-bit floating-point", "(type compression): zip",
        "red   (0.64 0.33)", "seen by others",
        "software (type string): \"Oriel",
        // y down to y up; translation in the last row
        "worldToCamera (type m44f):\n   (1 0 0 0\n    0 -1 0 0\n    0 0 1 0\n    0 -2 5 1)"};
    for (size_t i = 0; i < ORL_COUNT(lines); i++)
        if (!strstr(said.text, lines[i]))
            fail_msg("exrheader does not say \"%s\" but:\n%s", lines[i], said.text);
    orl_image_finish(&color);
    orl_image_finish(&depth);
}

static void imagemagick_reads_the_same_colours(void **state)
{
    (void)state;
    struct orl_image color = picture(8, 4, 3), depth = picture(8, 4, 1);
    for (int i = 0; i < 8 * 4 * 3; i++)
        color.f32[i] = (float)(i + 1) / 128;
    struct orl_exr_params params = framed(&color, &depth, NULL);
    assert_int_equal(orl_exr_write(NULL, file, &params), ORL_OK);
    struct said said;
    const char *const formats[] = {"sh", "-c", "convert -list format | grep EXR || true", NULL};
    if (!ask(formats, &said) || !strstr(said.text, "EXR")) {
        printf("skipped: no ImageMagick that reads EXR (Debian's libmagickcore-6.q16-6-extra)\n");
        orl_image_finish(&color);
        orl_image_finish(&depth);
        skip();
    }
    const char *const argv[] = {"convert", file, "-format",
                                "%[fx:p{5,2}.r] %[fx:p{5,2}.g] %[fx:p{5,2}.b]\n", "info:", NULL};
    assert_true(ask(argv, &said));
    double rgb[3];
    assert_int_equal(sscanf(said.text, "%lf %lf %lf", &rgb[0], &rgb[1], &rgb[2]), 3);
    for (int c = 0; c < 3; c++)
        assert_float_equal(rgb[c], color.f32[3 * (2 * 8 + 5) + c], 2e-4);
    orl_image_finish(&color);
    orl_image_finish(&depth);
}

// --- files of others ---

// Tiles of unsigned integers, the sample at (x, y) being x + 100 y.
static void write_tiled(int width, int height, int tile)
{
    exr_context_t context;
    int part;
    assert_int_equal(exr_start_write(&context, file, EXR_WRITE_FILE_DIRECTLY, NULL), 0);
    assert_int_equal(exr_add_part(context, "tiles", EXR_STORAGE_TILED, &part), 0);
    assert_int_equal(exr_initialize_required_attr_simple(context, part, width, height,
                                                         EXR_COMPRESSION_NONE), 0);
    assert_int_equal(exr_set_tile_descriptor(context, part, (uint32_t)tile, (uint32_t)tile,
                                             EXR_TILE_ONE_LEVEL, EXR_TILE_ROUND_DOWN), 0);
    assert_int_equal(exr_add_channel(context, part, "Z", EXR_PIXEL_UINT,
                                     EXR_PERCEPTUALLY_LOGARITHMIC, 1, 1), 0);
    assert_int_equal(exr_write_header(context), 0);
    for (int y = 0; y < height; y += tile) {
        for (int x = 0; x < width; x += tile) {
            uint32_t samples[32 * 32];
            int w = width - x < tile ? width - x : tile, h = height - y < tile ? height - y : tile;
            for (int i = 0; i < w * h; i++)
                samples[i] = (uint32_t)(x + i % w + 100 * (y + i / w));
            assert_int_equal(exr_write_tile_chunk(context, part, x / tile, y / tile, 0, 0, samples,
                                                  (uint64_t)(w * h) * 4), 0);
        }
    }
    assert_int_equal(exr_finish(&context), 0);
}

static void tiles_and_unsigned_integers(void **state)
{
    (void)state;
    static const char *const z[] = {"Z"};
    struct orl_image back;
    write_tiled(37, 21, 16);
    assert_int_equal(orl_exr_read(NULL, file, z, 1, &back), ORL_OK);
    for (int i = 0; i < 37 * 21; i++)
        assert_true(back.f32[i] == (float)(i % 37 + 100 * (i / 37)));
    orl_image_finish(&back);
}

// --- damage ---

static void expect_error(const void *data, size_t size)
{
    static const char *const rgb[] = {"R", "G", "B"};
    struct orl_image back;
    assert_int_equal(orl_file_write(NULL, file, data, size), ORL_OK);
    assert_int_not_equal(orl_exr_read(NULL, file, rgb, 3, &back), ORL_OK);
    assert_null(back.data);
}

static void not_exr(void **state)
{
    (void)state;
    static const char *const rgb[] = {"R", "G", "B"};
    struct orl_image back;
    expect_error("", 0);
    expect_error("PNG", 3);
    expect_error("\x76\x2f\x31\x01\x02\x00\x00\x00", 8);
    assert_int_equal(orl_exr_read(NULL, "/nowhere/a.exr", rgb, 3, &back), ORL_ERR_NOT_FOUND);
}

static void every_truncation_is_an_error(void **state)
{
    (void)state;
    struct orl_image image = picture(24, 40, 3);
    struct orl_exr_params params = rgb_params(&image, true);
    uint8_t *data;
    size_t size;
    assert_int_equal(orl_exr_write(NULL, file, &params), ORL_OK);
    assert_int_equal(orl_file_read(NULL, file, 1 << 20, &data, &size), ORL_OK);
    for (size_t keep = 0; keep < size; keep += keep < 600 ? 7 : 61)
        expect_error(data, keep);
    expect_error(data, size - 1);
    free(data);
    orl_image_finish(&image);
}

// Whatever the bytes say: a result code, no crash, nothing left behind (ASan watches).
static void random_damage_never_crashes(void **state)
{
    (void)state;
    static const char *const rgb[] = {"R", "G", "B"};
    struct orl_image image = picture(24, 40, 3), back;
    struct orl_exr_params params = rgb_params(&image, true);
    uint8_t *data, *copy;
    size_t size, failed = 0;
    assert_int_equal(orl_exr_write(NULL, file, &params), ORL_OK);
    assert_int_equal(orl_file_read(NULL, file, 1 << 20, &data, &size), ORL_OK);
    copy = orl_array(NULL, size, 1);
    uint32_t seed = 7;
    for (int round = 0; round < 600; round++) {
        memcpy(copy, data, size);
        for (uint32_t n = 1 + noise(&seed) % 4; n; n--) // half of them in the header
            copy[noise(&seed) % (round % 2 ? size : 400)] ^= (uint8_t)(1u << noise(&seed) % 8);
        remove(file);
        FILE *out = fopen(file, "wb"); // without the flush to disk
        assert_non_null(out);
        assert_int_equal(fwrite(copy, 1, size, out), size);
        assert_int_equal(fclose(out), 0);
        enum orl_result result = orl_exr_read(NULL, file, rgb, 3, &back);
        assert_true(result == ORL_OK ? back.data != NULL : back.data == NULL);
        failed += result != ORL_OK;
        orl_image_finish(&back);
    }
    assert_true(failed > 100);
    free(copy);
    free(data);
    orl_image_finish(&image);
}

// --- writing ---

static void a_failed_write_keeps_the_old_file(void **state)
{
    (void)state;
    struct orl_image image = picture(4, 4, 1);
    struct orl_exr_params params = rgb_params(&image, true);
    struct orl_names names;
    char *inside = orl_path_join(NULL, file, "b.exr");
    assert_int_equal(orl_file_write(NULL, file, "old", 3), ORL_OK);
    assert_int_equal(orl_exr_write(NULL, inside, &params), ORL_ERR_IO); // file is no folder
    assert_int_equal(orl_dir_list(NULL, dir, &names), ORL_OK);
    assert_int_equal(names.count, 1);
    orl_names_finish(&names);
    free(inside);
    orl_image_finish(&image);
}

// A disk that fills up half way: an error, not a wait for a lock that OpenEXR holds.
static void a_cut_write_ends_with_an_error(void **state)
{
    (void)state;
    struct orl_image image = picture(200, 200, 3);
    struct orl_exr_params params = rgb_params(&image, false);
    struct rlimit before, tight;
    assert_int_equal(orl_file_write(NULL, file, "old", 3), ORL_OK);
    assert_int_equal(getrlimit(RLIMIT_FSIZE, &before), 0);
    signal(SIGXFSZ, SIG_IGN);
    alarm(60);
    for (rlim_t size = 16; size < 65536; size *= 4) {
        tight = (struct rlimit){.rlim_cur = size, .rlim_max = before.rlim_max};
        assert_int_equal(setrlimit(RLIMIT_FSIZE, &tight), 0);
        enum orl_result result = orl_exr_write(NULL, file, &params);
        assert_int_equal(setrlimit(RLIMIT_FSIZE, &before), 0);
        assert_int_equal(result, ORL_ERR_IO);
    }
    alarm(0);
    struct orl_names names;
    assert_int_equal(orl_dir_list(NULL, dir, &names), ORL_OK);
    assert_int_equal(names.count, 1);
    orl_names_finish(&names);
    orl_image_finish(&image);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(floats_come_back_exactly),
        cmocka_unit_test(piz_is_lossless_too),
        cmocka_unit_test(halves_round_and_clamp),
        cmocka_unit_test(chunks_that_hardly_compress),
        cmocka_unit_test(layers_and_channel_choice),
        cmocka_unit_test(camera_attributes),
        cmocka_unit_test(nothing_is_said_that_is_not_known),
        cmocka_unit_test(opencv_reads_the_same_colours),
        cmocka_unit_test(exrheader_sees_channels_and_attributes),
        cmocka_unit_test(imagemagick_reads_the_same_colours),
        cmocka_unit_test(tiles_and_unsigned_integers),
        cmocka_unit_test(not_exr),
        cmocka_unit_test(every_truncation_is_an_error),
        cmocka_unit_test(random_damage_never_crashes),
        cmocka_unit_test(a_failed_write_keeps_the_old_file),
        cmocka_unit_test(a_cut_write_ends_with_an_error),
    };
    return cmocka_run_group_tests(tests, set_up, tear_down);
}
