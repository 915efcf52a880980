// HEIC and AVIF files, made by libheif's own encoder.
#include "test.h"

#include <math.h>

#include <lcms2.h>
#include <libheif/heif.h>

#include "core/color.h"
#include "io/internal.h"
#include "io/picture.h"

enum { W = 96, H = 64 };

static char *dir, *file;
static struct heif_encoder *encoder;
static struct heif_context *context;

static int set_up(void **state)
{
    (void)state;
    return test_file_make("a.heic", &dir, &file);
}

static int tear_down(void **state)
{
    (void)state;
    return test_file_remove(dir, file);
}

static void fine(struct heif_error error)
{
    if (error.code != heif_error_Ok)
        fail_msg("libheif: %s", error.message);
}

static int value_at(int x, int y, int c)
{
    return c == 0 ? 2 * x + 20 : c == 1 ? 3 * y + 20 : 120;
}

// A picture whose red grows to the right and whose green grows downwards.
static struct heif_image *make_picture(int bits)
{
    struct heif_image *image;
    int stride;
    fine(heif_image_create(W, H, heif_colorspace_RGB,
                           bits > 8 ? heif_chroma_interleaved_RRGGBB_LE
                                    : heif_chroma_interleaved_RGB, &image));
    fine(heif_image_add_plane(image, heif_channel_interleaved, W, H, bits));
    uint8_t *rows = heif_image_get_plane(image, heif_channel_interleaved, &stride);
    for (int y = 0; y < H; y++)
        for (int i = 0; i < 3 * W; i++) {
            int value = value_at(i / 3, y, i % 3) << (bits - 8);
            if (bits > 8) {
                rows[y * stride + 2 * i] = (uint8_t)value;
                rows[y * stride + 2 * i + 1] = (uint8_t)(value >> 8);
            } else {
                rows[y * stride + i] = (uint8_t)value;
            }
        }
    return image;
}

static bool get_encoder(enum heif_compression_format format)
{
    context = heif_context_alloc();
    return heif_context_get_encoder_for_format(context, format, &encoder).code == heif_error_Ok;
}

static void save(struct heif_image *image, enum heif_orientation turned,
                 const struct orl_exif *exif)
{
    struct heif_image_handle *handle;
    struct heif_encoding_options *options = heif_encoding_options_alloc();
    options->image_orientation = turned;
    heif_encoder_set_lossy_quality(encoder, 95);
    fine(heif_context_encode_image(context, image, encoder, options, &handle));
    uint8_t *block = NULL;
    size_t size;
    if (exif) {
        assert_int_equal(orl_exif_encode(NULL, exif, &block, &size), ORL_OK);
        fine(heif_context_add_exif_metadata(context, handle, block, (int)size));
    }
    fine(heif_context_write_to_file(context, file));
    free(block);
    heif_encoding_options_free(options);
    heif_image_handle_release(handle);
    heif_encoder_release(encoder);
    heif_image_release(image);
    heif_context_free(context);
}

static void expect_pixels(const struct orl_image *image, bool turned)
{
    for (int y = 4; y < H - 4; y += 7)
        for (int x = 4; x < W - 4; x += 5)
            for (int c = 0; c < 3; c++) {
                int at = turned ? x * image->width + (H - 1 - y) : y * image->width + x;
                assert_between(image->u8[3 * at + c] + 6, value_at(x, y, c),
                               value_at(x, y, c) + 12);
            }
}

static void pixels_and_exif_come_back(void **state)
{
    (void)state;
    static const enum heif_compression_format formats[] = {heif_compression_HEVC,
                                                           heif_compression_AV1};
    const struct orl_exif exif = {.make = "A Maker", .focal_35mm = 26, .orientation = 6,
                                  .placed = true, .latitude = 48.5, .longitude = 2.25};
    for (size_t i = 0; i < ORL_COUNT(formats); i++) {
        struct orl_image image;
        struct orl_picture_info info;
        assert_true(get_encoder(formats[i]));
        save(make_picture(8), heif_orientation_rotate_90_cw, &exif);
        assert_int_equal(orl_picture_inspect(NULL, file, &info), ORL_OK);
        assert_int_equal(info.width, H); // turned, as the file asks
        assert_int_equal(info.height, W);
        assert_int_equal(info.bits, 8);
        assert_int_equal(orl_picture_read(NULL, file, 3, &image), ORL_OK);
        expect_pixels(&image, true);
        orl_image_finish(&image);
        const struct orl_exif back = info.exif;
        assert_string_equal(back.make, "A Maker");
        assert_float_equal(back.focal_35mm, 26, 0);
        assert_int_equal(back.orientation, 1);
        assert_true(back.placed);
        assert_float_equal(back.latitude, 48.5, 1e-6);
    }
}

static void ten_bits_are_deep(void **state)
{
    (void)state;
    struct orl_image image;
    struct orl_picture_info info;
    assert_true(get_encoder(heif_compression_HEVC));
    save(make_picture(10), heif_orientation_normal, NULL);
    assert_int_equal(orl_picture_inspect(NULL, file, &info), ORL_OK);
    assert_int_equal(info.bits, 10);
    assert_int_equal(orl_picture_read(NULL, file, 3, &image), ORL_OK);
    expect_pixels(&image, false);
    orl_image_finish(&image);
}

// Phones write Display P3: its grey is sRGB's, its red lies outside.
static void colour_profiles_are_applied(void **state)
{
    (void)state;
    const cmsCIExyY white = {0.3127, 0.3290, 1};
    const cmsCIExyYTRIPLE p3 = {{0.680, 0.320, 1}, {0.265, 0.690, 1}, {0.150, 0.060, 1}};
    cmsToneCurve *line = cmsBuildGamma(NULL, 1), *curves[3] = {line, line, line};
    cmsHPROFILE profile = cmsCreateRGBProfile(&white, &p3, curves);
    uint8_t icc[4096];
    cmsUInt32Number size = sizeof icc;
    assert_true(cmsSaveProfileToMem(profile, icc, &size));
    cmsCloseProfile(profile);
    cmsFreeToneCurve(line);
    struct heif_image *picture = make_picture(8);
    struct orl_image image, eight;
    fine(heif_image_set_raw_color_profile(picture, "prof", icc, size));
    assert_true(get_encoder(heif_compression_HEVC));
    save(picture, heif_orientation_normal, NULL);
    assert_int_equal(orl_picture_read_linear(NULL, file, &image), ORL_OK);
    int x = 80, y = 20;
    const float *rgb = image.f32 + 3 * (y * W + x);
    float r = (float)value_at(x, y, 0) / 255, g = (float)value_at(x, y, 1) / 255;
    // P3's primaries in those of Rec. 709.
    assert_float_equal(rgb[0], 1.2249f * r - 0.2249f * g, 0.03);
    assert_float_equal(rgb[1], -0.0420f * r + 1.0420f * g, 0.03);
    // As sRGB of 8 bits, for which it does not go by light.
    assert_int_equal(orl_picture_read(NULL, file, 3, &eight), ORL_OK);
    for (int i = 0; i < 3 * W * H; i++)
        assert_float_equal(eight.u8[i], 255 * orl_srgb_encode(image.f32[i]), 1.01);
    orl_image_finish(&image);
    orl_image_finish(&eight);
}

// libheif writes no gain map: the alpha of a picture is renamed to one.
static void gain_maps_are_known(void **state)
{
    (void)state;
    static const char alpha[] = "auxid:1", map[] = "gainmap";
    struct orl_picture_info info;
    struct heif_image *picture;
    uint8_t *data, *at;
    size_t size;
    fine(heif_image_create(W, H, heif_colorspace_RGB, heif_chroma_interleaved_RGBA, &picture));
    fine(heif_image_add_plane(picture, heif_channel_interleaved, W, H, 8));
    assert_true(get_encoder(heif_compression_HEVC));
    save(picture, heif_orientation_normal, NULL);
    assert_int_equal(orl_picture_inspect(NULL, file, &info), ORL_OK);
    assert_false(info.gain_map);
    assert_int_equal(orl_file_read(NULL, file, 1 << 20, &data, &size), ORL_OK);
    at = memmem(data, size, alpha, sizeof alpha);
    assert_non_null(at);
    memcpy(at, map, sizeof map);
    assert_int_equal(orl_file_write(NULL, file, data, size), ORL_OK);
    assert_int_equal(orl_picture_inspect(NULL, file, &info), ORL_OK);
    assert_true(info.gain_map);
    free(data);
}

static void damage_is_an_error(void **state)
{
    (void)state;
    uint8_t *data;
    size_t size;
    struct orl_image image;
    assert_true(get_encoder(heif_compression_HEVC));
    save(make_picture(8), heif_orientation_normal, NULL);
    assert_int_equal(orl_file_read(NULL, file, 1 << 20, &data, &size), ORL_OK);
    for (size_t part = 1; part < 8; part++) {
        assert_int_equal(orl_file_write(NULL, file, data, size * part / 8), ORL_OK);
        assert_int_not_equal(orl_picture_read(NULL, file, 3, &image), ORL_OK);
        orl_image_finish(&image);
    }
    free(data);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test_setup_teardown(pixels_and_exif_come_back, set_up, tear_down),
        cmocka_unit_test_setup_teardown(ten_bits_are_deep, set_up, tear_down),
        cmocka_unit_test_setup_teardown(colour_profiles_are_applied, set_up, tear_down),
        cmocka_unit_test_setup_teardown(gain_maps_are_known, set_up, tear_down),
        cmocka_unit_test_setup_teardown(damage_is_an_error, set_up, tear_down),
    };
    if (!heif_have_encoder_for_format(heif_compression_HEVC) ||
        !heif_have_encoder_for_format(heif_compression_AV1)) {
        printf("skipped: libheif here cannot write HEIC and AVIF\n");
        return 77;
    }
    return cmocka_run_group_tests(tests, NULL, NULL);
}
