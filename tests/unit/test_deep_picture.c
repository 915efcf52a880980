// Photographs with more than 8 bits a sample: PNG, TIFF, EXR and RAW.
#include "test.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

#include <jpeglib.h>
#include <lcms2.h>
#include <png.h>
#include <tiffio.h>

#include "core/color.h"
#include "core/file.h"
#include "core/memory.h"
#include "io/exr.h"
#include "io/picture.h"
#include "opencv_files.h"

enum { W = 90, H = 70 };

static char *dir;

static int set_up(void **state)
{
    (void)state;
    dir = test_dir_make();
    return dir ? 0 : -1;
}

static int tear_down(void **state)
{
    (void)state;
    test_dir_remove(dir);
    return 0;
}

static const char *in_dir(const char *name)
{
    static char path[4096];
    snprintf(path, sizeof path, "%s/%s", dir, name);
    return path;
}

// Every level that 16 bits have, in no order.
static uint16_t sample(int i)
{
    return (uint16_t)(((uint32_t)i * 40503u) >> 3);
}

static struct orl_image read_linear(const char *path, int bits, bool unbounded)
{
    struct orl_picture_info info;
    struct orl_image image;
    assert_int_equal(orl_picture_inspect(NULL, path, &info), ORL_OK);
    assert_int_equal(info.width, W);
    assert_int_equal(info.height, H);
    assert_int_equal(info.bits, bits);
    assert_int_equal(info.unbounded, unbounded);
    assert_int_equal(orl_picture_read_linear(NULL, path, &image), ORL_OK);
    assert_true(image.width == W && image.height == H && image.channels == 3);
    return image;
}

static void sixteen_bits_of_srgb(void **state)
{
    (void)state;
    static const char *const names[] = {"a.png", "a.tif"};
    static uint16_t rgb[W * H * 3];
    for (int i = 0; i < W * H * 3; i++)
        rgb[i] = sample(i);
    for (size_t n = 0; n < ORL_COUNT(names); n++) {
        const char *path = in_dir(names[n]);
        assert_true(test_opencv_write_rgb16(path, W, H, rgb));
        struct orl_image image = read_linear(path, 16, false), eight;
        for (int i = 0; i < W * H * 3; i++)
            assert_true(image.f32[i] == orl_srgb_decode((float)rgb[i] / 65535));
        assert_int_equal(orl_picture_read(NULL, path, 3, &eight), ORL_OK);
        for (int i = 0; i < W * H * 3; i++)
            assert_true(fabs(eight.u8[i] - rgb[i] / 257.0) <= 0.51);
        orl_image_finish(&image);
        orl_image_finish(&eight);
    }
}

// --- TIFF's varieties, by libtiff ---

struct variety {
    uint16_t bits, samples, planar, compression;
    uint32_t tile; // 0: strips
    const char *mode;
};

static uint16_t value_at(const struct variety *v, uint32_t x, uint32_t y, uint32_t s)
{
    uint16_t value = sample((int)((y * W + x) * v->samples + s));
    return v->bits == 8 ? value >> 8 : value;
}

// `plane` -1: samples interleaved.
static void fill_block(const struct variety *v, uint32_t x0, uint32_t y0, uint32_t width,
                       uint32_t height, int plane, uint8_t *to)
{
    uint32_t first = plane < 0 ? 0 : (uint32_t)plane, last = plane < 0 ? v->samples : first + 1;
    for (uint32_t y = y0; y < y0 + height; y++)
        for (uint32_t x = x0; x < x0 + width; x++)
            for (uint32_t s = first; s < last; s++) {
                uint16_t value = value_at(v, x, y, s);
                if (v->bits == 8)
                    *to++ = (uint8_t)value;
                else
                    memcpy(to, &value, 2), to += 2;
            }
}

static TIFF *begin_tiff(const char *path, const struct variety *v, uint16_t photometric)
{
    TIFF *t = TIFFOpen(path, v->mode);
    assert_non_null(t);
    TIFFSetField(t, TIFFTAG_IMAGEWIDTH, W);
    TIFFSetField(t, TIFFTAG_IMAGELENGTH, H);
    TIFFSetField(t, TIFFTAG_BITSPERSAMPLE, v->bits);
    TIFFSetField(t, TIFFTAG_SAMPLESPERPIXEL, v->samples);
    TIFFSetField(t, TIFFTAG_PLANARCONFIG, v->planar);
    TIFFSetField(t, TIFFTAG_COMPRESSION, v->compression);
    TIFFSetField(t, TIFFTAG_PHOTOMETRIC, photometric);
    return t;
}

static void write_variety(const char *path, const struct variety *v)
{
    static uint8_t block[W * H * 8];
    bool separate = v->planar == PLANARCONFIG_SEPARATE;
    TIFF *t = begin_tiff(path, v, v->samples >= 3 ? PHOTOMETRIC_RGB : PHOTOMETRIC_MINISBLACK);
    if (v->tile) {
        TIFFSetField(t, TIFFTAG_TILEWIDTH, v->tile);
        TIFFSetField(t, TIFFTAG_TILELENGTH, v->tile);
    } else {
        TIFFSetField(t, TIFFTAG_ROWSPERSTRIP, 9);
    }
    for (int plane = 0; plane < (separate ? v->samples : 1); plane++) {
        for (uint32_t y = 0; y < H; y += v->tile ? v->tile : 1)
            for (uint32_t x = 0; x < (v->tile ? W : 1); x += v->tile ? v->tile : 1) {
                fill_block(v, x, y, v->tile ? v->tile : W, v->tile ? v->tile : 1,
                           separate ? plane : -1, block);
                if (v->tile)
                    assert_true(TIFFWriteTile(t, block, x, y, 0, (uint16_t)plane) > 0);
                else
                    assert_int_equal(TIFFWriteScanline(t, block, y, (uint16_t)plane), 1);
            }
    }
    TIFFClose(t);
}

static void tiff_varieties(void **state)
{
    (void)state;
    const struct variety all[] = {
        {16, 3, PLANARCONFIG_CONTIG, COMPRESSION_NONE, 0, "w"},
        {16, 3, PLANARCONFIG_CONTIG, COMPRESSION_LZW, 0, "wb"}, // big endian
        {16, 4, PLANARCONFIG_CONTIG, COMPRESSION_ADOBE_DEFLATE, 0, "w8"}, // BigTIFF
        {16, 3, PLANARCONFIG_SEPARATE, COMPRESSION_NONE, 0, "w"},
        {16, 3, PLANARCONFIG_CONTIG, COMPRESSION_LZW, 32, "w"},
        {16, 4, PLANARCONFIG_SEPARATE, COMPRESSION_NONE, 16, "w"},
        {16, 1, PLANARCONFIG_CONTIG, COMPRESSION_NONE, 0, "w"},
        {8, 3, PLANARCONFIG_CONTIG, COMPRESSION_LZW, 0, "w"},
        {8, 1, PLANARCONFIG_CONTIG, COMPRESSION_PACKBITS, 48, "w"},
    };
    for (size_t n = 0; n < ORL_COUNT(all); n++) {
        const struct variety *v = &all[n];
        const char *path = in_dir("v.tiff");
        write_variety(path, v);
        struct orl_image image = read_linear(path, v->bits, false);
        float white = v->bits == 8 ? 255 : 65535;
        for (uint32_t i = 0; i < W * H * 3; i++) {
            uint32_t s = v->samples >= 3 ? i % 3 : 0;
            float want = orl_srgb_decode((float)value_at(v, i / 3 % W, i / 3 / W, s) / white);
            assert_true(image.f32[i] == want);
        }
        orl_image_finish(&image);
    }
}

static void floats_are_light_as_it_is(void **state)
{
    (void)state;
    static float rgb[W * H * 3];
    for (int i = 0; i < W * H * 3; i++)
        rgb[i] = exp2f((float)(i % 24) - 12);
    const struct variety v = {32, 3, PLANARCONFIG_CONTIG, COMPRESSION_ADOBE_DEFLATE, 0, "w"};
    const char *path = in_dir("f.tif");
    TIFF *t = begin_tiff(path, &v, PHOTOMETRIC_RGB);
    TIFFSetField(t, TIFFTAG_SAMPLEFORMAT, SAMPLEFORMAT_IEEEFP);
    for (uint32_t y = 0; y < H; y++)
        assert_int_equal(TIFFWriteScanline(t, rgb + (size_t)y * W * 3, y, 0), 1);
    TIFFClose(t);
    struct orl_image image = read_linear(path, 32, true);
    assert_memory_equal(image.f32, rgb, sizeof rgb);
    orl_image_finish(&image);

    struct orl_image from;
    assert_int_equal(orl_image_init(NULL, &from, W, H, 3, ORL_PIXEL_F32), ORL_OK);
    memcpy(from.f32, rgb, sizeof rgb);
    struct orl_exr_params exr = {.width = W, .height = H};
    static const char *const names[] = {"R", "G", "B"};
    for (int c = 0; c < 3; c++)
        assert_true(orl_exr_add_channel(&exr, names[c], false, &from, c));
    path = in_dir("f.exr");
    assert_int_equal(orl_exr_write(NULL, path, &exr), ORL_OK);
    image = read_linear(path, 32, true);
    assert_memory_equal(image.f32, rgb, sizeof rgb);
    orl_image_finish(&image);
    exr.channel_count = 1;
    strcpy(exr.channels[0].name, "Y");
    assert_int_equal(orl_exr_write(NULL, path, &exr), ORL_OK);
    image = read_linear(path, 32, true);
    for (int i = 0; i < W * H * 3; i++)
        assert_true(image.f32[i] == rgb[i / 3 * 3]);
    orl_image_finish(&image);
    // Of luminance and chroma, luminance alone would be a picture without colours.
    struct orl_picture_info info;
    exr.channel_count = 3;
    strcpy(exr.channels[1].name, "RY");
    strcpy(exr.channels[2].name, "BY");
    assert_int_equal(orl_exr_write(NULL, path, &exr), ORL_OK);
    assert_int_equal(orl_picture_inspect(NULL, path, &info), ORL_ERR_UNSUPPORTED);
    assert_int_equal(orl_picture_read_linear(NULL, path, &image), ORL_ERR_UNSUPPORTED);
    orl_image_finish(&from);
}

static const double gamma_adobe = 563.0 / 256;
static uint8_t icc[8192];

// Takes `profile` and writes it to icc; returns its size.
static cmsUInt32Number save_profile(cmsHPROFILE profile)
{
    cmsUInt32Number size = 0;
    assert_true(cmsSaveProfileToMem(profile, NULL, &size));
    assert_true(size <= sizeof icc && cmsSaveProfileToMem(profile, icc, &size));
    cmsCloseProfile(profile);
    return size;
}

// ProPhoto RGB (ROMM RGB): white point D50, a power of 1.8.
static cmsUInt32Number make_prophoto(void)
{
    const cmsCIExyYTRIPLE primaries = {{0.7347, 0.2653, 1}, {0.1596, 0.8404, 1}, {0.0366, 0.0001, 1}};
    cmsToneCurve *curve = cmsBuildGamma(NULL, 1.8);
    cmsToneCurve *const curves[3] = {curve, curve, curve};
    cmsHPROFILE prophoto = cmsCreateRGBProfile(cmsD50_xyY(), &primaries, curves);
    cmsFreeToneCurve(curve);
    return save_profile(prophoto);
}

// Its matrix to Rec. 709, adapted from D50 to D65 by Bradford (brucelindbloom.com).
static void want_prophoto(const double stored[3], double want[3])
{
    static const double m[3][3] = {{2.0343, -0.7277, -0.3067}, {-0.2288, 1.2317, -0.0029},
                                   {-0.0085, -0.1533, 1.1618}};
    for (int c = 0; c < 3; c++) {
        want[c] = 0;
        for (int k = 0; k < 3; k++)
            want[c] += m[c][k] * pow(stored[k], 1.8);
    }
}

// Adobe RGB (1998), whose matrix to Rec. 709 is well known: both have D65 and the same red
// and blue.
static cmsUInt32Number make_adobe(void)
{
    const cmsCIExyY white = {0.3127, 0.3290, 1};
    const cmsCIExyYTRIPLE primaries = {{0.64, 0.33, 1}, {0.21, 0.71, 1}, {0.15, 0.06, 1}};
    cmsToneCurve *curve = cmsBuildGamma(NULL, gamma_adobe);
    cmsToneCurve *const curves[3] = {curve, curve, curve};
    cmsHPROFILE adobe = cmsCreateRGBProfile(&white, &primaries, curves);
    cmsFreeToneCurve(curve);
    return save_profile(adobe);
}

static void want_adobe(const double stored[3], double want[3])
{
    double r = pow(stored[0], gamma_adobe), g = pow(stored[1], gamma_adobe);
    double b = pow(stored[2], gamma_adobe);
    want[0] = 1.39836 * r - 0.39836 * g;
    want[1] = g;
    want[2] = -0.04293 * g + 1.04293 * b;
}

static void tiff_profiles_are_applied(void **state)
{
    (void)state;
    cmsUInt32Number size = make_adobe();
    const struct variety v = {16, 3, PLANARCONFIG_CONTIG, COMPRESSION_NONE, 0, "w"};
    const double stored[3] = {0.5, 0.6, 0.3};
    const char *path = in_dir("p.tif");
    struct said said;
    struct orl_log log = log_to(&said);
    for (int broken = 0; broken < 2; broken++) {
        uint16_t row[W * 3];
        for (int i = 0; i < W * 3; i++)
            row[i] = (uint16_t)lround(65535 * stored[i % 3]);
        TIFF *t = begin_tiff(path, &v, PHOTOMETRIC_RGB);
        TIFFSetField(t, TIFFTAG_ICCPROFILE, broken ? 200 : size, icc);
        for (uint32_t y = 0; y < H; y++)
            assert_int_equal(TIFFWriteScanline(t, row, y, 0), 1);
        TIFFClose(t);
        struct orl_image image;
        assert_int_equal(orl_picture_read_linear(&log, path, &image), ORL_OK);
        double want[3];
        want_adobe(stored, want);
        for (int c = 0; c < 3; c++)
            assert_float_equal(image.f32[3 * 1000 + c],
                               broken ? (double)orl_srgb_decode((float)stored[c]) : want[c], 1e-3);
        assert_int_equal(strstr(said.text, "its colour profile cannot be used") != NULL, broken);
        orl_image_finish(&image);
    }
}

// A JPEG of one colour, or of greys from black on the left to white, with a profile of `size` bytes where there is one.
static void write_jpeg(const char *path, const uint8_t *pixel, int channels,
                       cmsUInt32Number size, int segment, const void *data, unsigned data_size)
{
    struct jpeg_compress_struct info;
    struct jpeg_error_mgr error;
    FILE *out = fopen(path, "wb");
    assert_non_null(out);
    info.err = jpeg_std_error(&error);
    jpeg_create_compress(&info);
    jpeg_stdio_dest(&info, out);
    info.image_width = W;
    info.image_height = H;
    info.input_components = channels;
    info.in_color_space = channels == 1 ? JCS_GRAYSCALE : JCS_RGB;
    jpeg_set_defaults(&info);
    jpeg_set_quality(&info, 100, TRUE);
    jpeg_start_compress(&info, TRUE);
    if (data)
        jpeg_write_marker(&info, JPEG_APP0 + segment, data, data_size);
    if (size)
        jpeg_write_icc_profile(&info, icc, size);
    uint8_t row[W * 3];
    for (int i = 0; i < W * channels; i++)
        row[i] = channels == 1 ? (uint8_t)(255 * i / (W - 1)) : pixel[i % channels];
    while (info.next_scanline < info.image_height) {
        JSAMPROW rows[1] = {row};
        jpeg_write_scanlines(&info, rows, 1);
    }
    jpeg_finish_compress(&info);
    jpeg_destroy_compress(&info);
    fclose(out);
}

// With a profile of `size` bytes, or a gamma, or the primaries of P3 (cHRM), or code points (cICP).
static void write_png(const char *path, const uint8_t pixel[3], int depth, cmsUInt32Number size,
                      double gamma, bool p3, const uint8_t code[4], const char *xmp)
{
    FILE *out = fopen(path, "wb");
    png_structp png = png_create_write_struct(PNG_LIBPNG_VER_STRING, NULL, NULL, NULL);
    png_infop info = png_create_info_struct(png);
    assert_non_null(out);
    assert_int_equal(setjmp(png_jmpbuf(png)), 0);
    png_init_io(png, out);
    png_set_IHDR(png, info, W, H, depth, PNG_COLOR_TYPE_RGB, PNG_INTERLACE_NONE,
                 PNG_COMPRESSION_TYPE_DEFAULT, PNG_FILTER_TYPE_DEFAULT);
    if (size)
        png_set_iCCP(png, info, "profile", 0, icc, size);
    if (gamma > 0)
        png_set_gAMA(png, info, gamma);
    if (p3)
        png_set_cHRM(png, info, 0.3127, 0.3290, 0.680, 0.320, 0.265, 0.690, 0.150, 0.060);
    png_text text = {.compression = PNG_ITXT_COMPRESSION_NONE, .key = (char *)"XML:com.adobe.xmp",
                     .text = (char *)xmp};
    if (xmp)
        png_set_text(png, info, &text, 1);
    png_write_info(png, info);
    if (code)
        png_write_chunk(png, (png_const_bytep) "cICP", code, 4);
    static uint8_t row[W * 6];
    size_t bytes = (size_t)depth / 8;
    for (size_t i = 0; i < W * 3 * bytes; i++)
        row[i] = pixel[i / bytes % 3];
    for (int y = 0; y < H; y++)
        png_write_row(png, row);
    png_write_end(png, info);
    png_destroy_write_struct(&png, &info);
    fclose(out);
}

// The picture has this light, and of 8 bits its sRGB value.
static void expect_light(const char *path, const double want[3], bool profiled)
{
    struct orl_picture_info info;
    struct orl_image light, eight;
    assert_int_equal(orl_picture_inspect(NULL, path, &info), ORL_OK);
    assert_int_equal(info.profiled, profiled);
    assert_int_equal(orl_picture_read_linear(NULL, path, &light), ORL_OK);
    assert_int_equal(orl_picture_read(NULL, path, 3, &eight), ORL_OK);
    for (int c = 0; c < 3; c++) {
        assert_float_equal(light.f32[3 * 1000 + c], want[c], 1e-2); // a step of 8 bits
        assert_float_equal(eight.u8[3 * 1000 + c], 255 * orl_srgb_encode((float)want[c]), 3);
    }
    orl_image_finish(&light);
    orl_image_finish(&eight);
}

// The same of greys from black to white, whose light is what is stored to the power of `gamma`.
static void expect_greys(const char *path, double gamma)
{
    struct orl_image light, eight;
    assert_int_equal(orl_picture_read_linear(NULL, path, &light), ORL_OK);
    assert_int_equal(orl_picture_read(NULL, path, 3, &eight), ORL_OK);
    for (int i = 0; i < 3 * W; i++) {
        const double want = pow((double)(i / 3) / (W - 1), gamma);
        assert_float_equal(light.f32[i], want, 2e-2);
        assert_float_equal(eight.u8[i], 255 * orl_srgb_encode((float)want), 5);
    }
    orl_image_finish(&light);
    orl_image_finish(&eight);
}

// A TIFF of such greys.
static void write_grey_tiff(const char *path, cmsUInt32Number size)
{
    const struct variety v = {16, 1, PLANARCONFIG_CONTIG, COMPRESSION_NONE, 0, "w"};
    uint16_t row[W];
    for (int i = 0; i < W; i++)
        row[i] = (uint16_t)(65535 * i / (W - 1));
    TIFF *t = begin_tiff(path, &v, PHOTOMETRIC_MINISBLACK);
    TIFFSetField(t, TIFFTAG_ICCPROFILE, size, icc);
    for (uint32_t y = 0; y < H; y++)
        assert_int_equal(TIFFWriteScanline(t, row, y, 0), 1);
    TIFFClose(t);
}

// As a mask the picture has this pixel everywhere, whatever its profile.
static void expect_stored(const char *path, const uint8_t pixel[3])
{
    struct orl_image rgba;
    assert_int_equal(orl_picture_read(NULL, path, 4, &rgba), ORL_OK);
    for (size_t i = 0; i < orl_image_bytes(&rgba); i++)
        assert_int_equal(rgba.u8[i], i % 4 == 3 ? 255 : pixel[i % 4]);
    orl_image_finish(&rgba);
}

static void jpeg_and_png_profiles_are_applied(void **state)
{
    (void)state;
    const uint8_t pixel[3] = {128, 153, 77};
    double stored[3], want[3], plain[3];
    for (int c = 0; c < 3; c++) {
        stored[c] = pixel[c] / 255.0;
        plain[c] = (double)orl_srgb_decode((float)stored[c]);
    }
    want_adobe(stored, want);
    cmsUInt32Number size = make_adobe();
    write_jpeg(in_dir("p.jpg"), pixel, 3, size, 0, NULL, 0);
    expect_light(in_dir("p.jpg"), want, true);
    write_png(in_dir("p.png"), pixel, 8, size, 0, false, NULL, NULL);
    expect_light(in_dir("p.png"), want, true);
    expect_stored(in_dir("p.png"), pixel);
    write_png(in_dir("p.png"), pixel, 16, size, 0, false, NULL, NULL);
    expect_light(in_dir("p.png"), want, true);
    want_prophoto(stored, want);
    size = make_prophoto();
    write_jpeg(in_dir("p.jpg"), pixel, 3, size, 0, NULL, 0);
    expect_light(in_dir("p.jpg"), want, true);
    write_png(in_dir("p.png"), pixel, 16, size, 0, false, NULL, NULL);
    expect_light(in_dir("p.png"), want, true);
    // sRGB itself, under whatever name, changes nothing.
    size = save_profile(cmsCreate_sRGBProfile());
    write_jpeg(in_dir("p.jpg"), pixel, 3, size, 0, NULL, 0);
    expect_light(in_dir("p.jpg"), plain, false);
    // Grey of another gamma.
    cmsToneCurve *curve = cmsBuildGamma(NULL, 1.8);
    size = save_profile(cmsCreateGrayProfile(cmsD50_xyY(), curve));
    cmsFreeToneCurve(curve);
    write_jpeg(in_dir("p.jpg"), NULL, 1, size, 0, NULL, 0);
    expect_greys(in_dir("p.jpg"), 1.8);
    write_grey_tiff(in_dir("p.tif"), size);
    expect_greys(in_dir("p.tif"), 1.8);
}

// In whichever way a PNG is read; that of sRGB changes nothing.
static void png_gamma_is_applied(void **state)
{
    (void)state;
    static const double gammas[] = {1, 1 / 1.8, 0.45455};
    const uint8_t pixel[3] = {128, 153, 77};
    double want[3];
    for (size_t i = 0; i < ORL_COUNT(gammas); i++)
        for (int depth = 8; depth <= 16; depth += 8) {
            bool plain = i == 2;
            for (int c = 0; c < 3; c++)
                want[c] = plain ? (double)orl_srgb_decode((float)(pixel[c] / 255.0))
                                : pow(pixel[c] / 255.0, 1 / gammas[i]);
            write_png(in_dir("p.png"), pixel, depth, 0, gammas[i], false, NULL, NULL);
            expect_light(in_dir("p.png"), want, !plain);
        }
}

// Matrices to Rec. 709 by Lindbloom's method, of the same white point.
static const double p3_to_709[3][3] = {
    {1.2249, -0.2247, 0}, {-0.0420, 1.0419, 0}, {-0.0197, -0.0786, 1.0979}};
static const double rec2020_to_709[3][3] = {
    {1.6605, -0.5876, -0.0728}, {-0.1246, 1.1329, -0.0083}, {-0.0182, -0.1006, 1.1187}};

static void want_709(const double from_light[3], const double matrix[3][3], double want[3])
{
    for (int c = 0; c < 3; c++)
        want[c] = matrix[c][0] * from_light[0] + matrix[c][1] * from_light[1] + matrix[c][2] * from_light[2];
}

static void png_primaries_are_applied(void **state)
{
    (void)state;
    const uint8_t pixel[3] = {128, 153, 77};
    const uint8_t srgb[4] = {1, 13, 0, 1}, p3[4] = {12, 13, 0, 1}, rec2020[4] = {9, 13, 0, 1},
                  linear[4] = {1, 8, 0, 1};
    const uint8_t pq[4] = {9, 16, 0, 1}, refused[3][4] = {{1, 13, 0, 0}, {1, 9, 0, 1}, {5, 13, 0, 1}};
    double light[3], plain[3], want[3];
    for (int c = 0; c < 3; c++) {
        plain[c] = pixel[c] / 255.0;
        light[c] = (double)orl_srgb_decode((float)plain[c]);
    }
    write_png(in_dir("p.png"), pixel, 8, 0, 0, false, srgb, NULL);
    expect_light(in_dir("p.png"), light, false);
    write_png(in_dir("p.png"), pixel, 16, 0, 0, false, linear, NULL);
    expect_light(in_dir("p.png"), plain, true);
    want_709(light, rec2020_to_709, want);
    write_png(in_dir("p.png"), pixel, 8, 0, 0, false, rec2020, NULL);
    expect_light(in_dir("p.png"), want, true);
    want_709(light, p3_to_709, want);
    write_png(in_dir("p.png"), pixel, 8, 0, 0, false, p3, NULL);
    expect_light(in_dir("p.png"), want, true);
    write_png(in_dir("p.png"), pixel, 8, 0, 0.45455, true, NULL, NULL);
    expect_light(in_dir("p.png"), want, true);
    // Code points come before the others.
    write_png(in_dir("p.png"), pixel, 8, 0, 0.45455, true, srgb, NULL);
    expect_light(in_dir("p.png"), light, false);

    struct said said;
    struct orl_log log = log_to(&said);
    struct orl_picture_info info;
    write_png(in_dir("p.png"), pixel, 16, 0, 0, false, pq, NULL);
    assert_int_equal(orl_picture_inspect(&log, in_dir("p.png"), &info), ORL_ERR_UNSUPPORTED);
    assert_non_null(strstr(said.text, "its samples are HDR"));
    for (size_t i = 0; i < ORL_COUNT(refused); i++) {
        write_png(in_dir("p.png"), pixel, 8, 0, 0, false, refused[i], NULL);
        assert_int_equal(orl_picture_inspect(&log, in_dir("p.png"), &info), ORL_ERR_UNSUPPORTED);
        assert_non_null(strstr(said.text, "the space of its colours"));
    }
}

// Adds "chromaticities" of P3 at the beginning of a header, and moves what the table of lines says.
static void state_p3(const char *path)
{
    static const float p3[8] = {0.680f, 0.320f, 0.265f, 0.690f, 0.150f, 0.060f, 0.3127f, 0.3290f};
    static const char head[] = "chromaticities\0chromaticities\0\x20\0\0"; // and the last 0: 32 bytes
    uint8_t *data;
    size_t size, first = 8, added = sizeof head + sizeof p3;
    assert_int_equal(orl_file_read(NULL, path, 1 << 24, &data, &size), ORL_OK);
    size_t at = first;
    while (data[at]) {
        uint32_t length;
        at += strlen((char *)data + at) + 1;
        at += strlen((char *)data + at) + 1;
        memcpy(&length, data + at, 4);
        at += 4 + length;
    }
    uint64_t offset, begin = 0;
    memcpy(&begin, data + at + 1, 8); // the first line follows the table
    for (size_t i = at + 1; i < begin; i += 8) {
        memcpy(&offset, data + i, 8);
        offset += added;
        memcpy(data + i, &offset, 8);
    }
    FILE *out = fopen(path, "wb");
    assert_non_null(out);
    assert_int_equal(fwrite(data, 1, first, out) + fwrite(head, 1, sizeof head, out) +
                         fwrite(p3, 1, sizeof p3, out) + fwrite(data + first, 1, size - first, out),
                     size + added);
    assert_int_equal(fclose(out), 0);
    free(data);
}

static void exr_primaries_are_applied(void **state)
{
    (void)state;
    static const char *const names[] = {"R", "G", "B"};
    const double light[3] = {0.5, 3, 0.25};
    double want[3];
    struct orl_image from;
    struct orl_exr_params exr = {.width = W, .height = H};
    assert_int_equal(orl_image_init(NULL, &from, W, H, 3, ORL_PIXEL_F32), ORL_OK);
    for (int i = 0; i < W * H * 3; i++)
        from.f32[i] = i < 3 ? INFINITY : (float)light[i % 3]; // the sun
    for (int c = 0; c < 3; c++)
        assert_true(orl_exr_add_channel(&exr, names[c], false, &from, c));
    assert_int_equal(orl_exr_write(NULL, in_dir("p.exr"), &exr), ORL_OK);
    state_p3(in_dir("p.exr"));
    want_709(light, p3_to_709, want);
    struct orl_image image = read_linear(in_dir("p.exr"), 32, true);
    for (int i = 0; i < W * H * 3; i++)
        if (i < 3)
            assert_true(image.f32[i] > 1e6f);
        else
            assert_float_equal(image.f32[i], fmax(want[i % 3], 0), 1e-2);
    orl_image_finish(&image);
    orl_image_finish(&from);
}

// Colours that were multiplied by alpha are divided by it; beside other alpha they stay.
static void tiff_alpha_is_taken_out(void **state)
{
    (void)state;
    const struct variety v = {8, 4, PLANARCONFIG_CONTIG, COMPRESSION_NONE, 0, "w"};
    static uint8_t row[W * 4];
    for (uint16_t kind = EXTRASAMPLE_UNSPECIFIED; kind <= EXTRASAMPLE_UNASSALPHA; kind++) {
        uint8_t share = kind == EXTRASAMPLE_ASSOCALPHA ? 2 : 1;
        for (int i = 0; i < W * 4; i++)
            row[i] = (uint8_t)(i % 4 == 3 ? 127 : 100 / share);
        TIFF *t = begin_tiff(in_dir("a.tif"), &v, PHOTOMETRIC_RGB);
        TIFFSetField(t, TIFFTAG_EXTRASAMPLES, 1, &kind);
        for (uint32_t y = 0; y < H; y++)
            assert_int_equal(TIFFWriteScanline(t, row, y, 0), 1);
        TIFFClose(t);
        struct orl_image image = read_linear(in_dir("a.tif"), 8, false);
        for (int i = 0; i < W * H * 3; i++)
            assert_float_equal(orl_srgb_encode(image.f32[i]), 100.0 / 255, 1e-2);
        orl_image_finish(&image);
    }
    // Light beyond white stays.
    const struct variety floats = {32, 4, PLANARCONFIG_CONTIG, COMPRESSION_NONE, 0, "w"};
    const uint16_t multiplied = EXTRASAMPLE_ASSOCALPHA;
    static float light[W * 4];
    for (int i = 0; i < W; i++)
        memcpy(light + 4 * i, (float[]){1, 2, 0.125f, 0.5f}, 4 * sizeof *light);
    TIFF *t = begin_tiff(in_dir("a.tif"), &floats, PHOTOMETRIC_RGB);
    TIFFSetField(t, TIFFTAG_SAMPLEFORMAT, SAMPLEFORMAT_IEEEFP);
    TIFFSetField(t, TIFFTAG_EXTRASAMPLES, 1, &multiplied);
    for (uint32_t y = 0; y < H; y++)
        assert_int_equal(TIFFWriteScanline(t, light, y, 0), 1);
    TIFFClose(t);
    struct orl_image image = read_linear(in_dir("a.tif"), 32, true);
    for (int i = 0; i < W * H * 3; i++)
        assert_true(image.f32[i] == 2 * light[i / 3 % W * 4 + i % 3]);
    orl_image_finish(&image);
}

// Cameras that are set to Adobe RGB say so in EXIF (DCF 2.0), without a profile.
static void adobe_rgb_by_exif_is_applied(void **state)
{
    (void)state;
    static const uint8_t exif[] = {
        'E', 'x', 'i', 'f', 0, 0, 'I', 'I', 42, 0, 8, 0, 0, 0,
        1, 0, 0x69, 0x87, 4, 0, 1, 0, 0, 0, 26, 0, 0, 0, 0, 0, 0, 0, // the EXIF IFD at 26
        1, 0, 0x05, 0xa0, 4, 0, 1, 0, 0, 0, 44, 0, 0, 0, 0, 0, 0, 0, // of interoperability at 44
        1, 0, 0x01, 0x00, 2, 0, 4, 0, 0, 0, 'R', '0', '3', 0, 0, 0, 0, 0};
    const uint8_t pixel[3] = {128, 153, 77};
    const double stored[3] = {128 / 255.0, 153 / 255.0, 77 / 255.0};
    double want[3];
    want_adobe(stored, want);
    write_jpeg(in_dir("p.jpg"), pixel, 3, 0, 1, exif, sizeof exif);
    expect_light(in_dir("p.jpg"), want, true);
}

// Flat pictures may have Google's schema, too, and an iPhone marks what it stitched in EXIF.
static void panoramas_are_known(void **state)
{
    (void)state;
#define XMP "http://ns.adobe.com/xap/1.0/\0<x:xmpmeta><rdf:Description "
    static const char sphere[] = XMP "GPano:ProjectionType=\"equirectangular\"/></x:xmpmeta>",
                      cylinder[] = XMP "GPano:ProjectionType=\"cylindrical\"/></x:xmpmeta>",
                      flat[] = XMP "GPano:ProjectionType=\"rectilinear\"/></x:xmpmeta>", none[] = XMP;
    static const char stitched[] = "Exif\0\0II*\0\10\0\0\0"
                                   "\1\0\x69\x87\4\0\1\0\0\0\32\0\0\0\0\0\0\0"   // the EXIF IFD at 26
                                   "\1\0\1\xa4\3\0\1\0\0\0\6\0\0\0\0\0\0\0";      // CustomRendered 6
    static const struct {
        const char *data;
        unsigned size;
        bool found;
    } cases[] = {{sphere, sizeof sphere, true}, {cylinder, sizeof cylinder, true}, {flat, sizeof flat, false},
                 {none, sizeof none, false}, {stitched, sizeof stitched, true}};
    const uint8_t pixel[3] = {128, 153, 77};
    struct orl_picture_info info;
    for (size_t i = 0; i < ORL_COUNT(cases); i++) {
        write_jpeg(in_dir("p.jpg"), pixel, 3, 0, 1, cases[i].data, cases[i].size);
        assert_int_equal(orl_picture_inspect(NULL, in_dir("p.jpg"), &info), ORL_OK);
        assert_int_equal(info.panorama, cases[i].found);
        assert_false(info.gain_map);
        if (memcmp(cases[i].data, "Exif", 4) == 0)
            continue;
        write_png(in_dir("p.png"), pixel, 8, 0, 0, false, NULL, cases[i].data + sizeof "http://ns.adobe.com/xap/1.0/");
        assert_int_equal(orl_picture_inspect(NULL, in_dir("p.png"), &info), ORL_OK);
        assert_int_equal(info.panorama, cases[i].found);
    }
#undef XMP
}

// Ultra HDR says so in XMP, ISO 21496-1 in a segment of its own.
static void gain_maps_are_known(void **state)
{
    (void)state;
    static const char xmp[] = "http://ns.adobe.com/xap/1.0/\0<x:xmpmeta><rdf:Description "
                              "xmlns:hdrgm=\"http://ns.adobe.com/hdr-gain-map/1.0/\" "
                              "hdrgm:Version=\"1.0\"/></x:xmpmeta>";
    static const char iso[] = "urn:iso:std:iso:ts:21496:-1\0\0\0\0";
    static const struct {
        int segment;
        const char *data;
        unsigned size;
        bool found;
    } cases[] = {{1, xmp, sizeof xmp, true}, {2, iso, sizeof iso, true}, {1, xmp, 60, false},
                 {2, iso, 12, false}, {0, NULL, 0, false}};
    const uint8_t pixel[3] = {128, 153, 77};
    struct orl_picture_info info;
    for (size_t i = 0; i < ORL_COUNT(cases); i++) {
        write_jpeg(in_dir("p.jpg"), pixel, 3, 0, cases[i].segment, cases[i].data, cases[i].size);
        assert_int_equal(orl_picture_inspect(NULL, in_dir("p.jpg"), &info), ORL_OK);
        assert_int_equal(info.gain_map, cases[i].found);
    }
}

static void damaged_tiff_is_an_error(void **state)
{
    (void)state;
    const struct variety v = {16, 3, PLANARCONFIG_CONTIG, COMPRESSION_LZW, 0, "w"};
    char path[4096], cut[4096];
    snprintf(path, sizeof path, "%s", in_dir("d.tif"));
    snprintf(cut, sizeof cut, "%s", in_dir("cut.tif"));
    write_variety(path, &v);
    uint8_t *data;
    size_t size;
    struct orl_image image;
    assert_int_equal(orl_file_read(NULL, path, 1 << 20, &data, &size), ORL_OK);
    for (size_t keep = 5; keep < size; keep += size / 50) {
        assert_int_equal(orl_file_write(NULL, cut, data, keep), ORL_OK);
        assert_int_not_equal(orl_picture_read_linear(NULL, cut, &image), ORL_OK);
        assert_null(image.data);
    }
    uint32_t seed = 5;
    for (int round = 0; round < 200; round++) { // any result, no crash
        uint8_t *copy = orl_array(NULL, size, 1);
        memcpy(copy, data, size);
        for (int k = 0; k < 4; k++) {
            seed = seed * 1664525u + 1013904223u;
            size_t at = round % 2 ? (seed >> 8) % size : size - 1 - (seed >> 8) % 250;
            copy[at] ^= (uint8_t)(1u << (seed >> 5) % 8);
        }
        FILE *out = fopen(cut, "wb");
        assert_int_equal(fwrite(copy, 1, size, out), size);
        fclose(out);
        if (orl_picture_read_linear(NULL, cut, &image) != ORL_OK)
            assert_null(image.data);
        orl_image_finish(&image);
        free(copy);
    }
    free(data);
    assert_int_equal(orl_file_write(NULL, cut, "II*\0", 4), ORL_OK);
    assert_int_not_equal(orl_picture_read_linear(NULL, cut, &image), ORL_OK);
}

static void unusual_tiff_is_refused_with_advice(void **state)
{
    (void)state;
    struct said said;
    struct orl_log log = log_to(&said);
    struct orl_image image;
    const struct variety v = {8, 4, PLANARCONFIG_CONTIG, COMPRESSION_NONE, 0, "w"};
    const char *path = in_dir("cmyk.tif");
    uint8_t row[W * 4] = {0};
    TIFF *t = begin_tiff(path, &v, PHOTOMETRIC_SEPARATED);
    for (uint32_t y = 0; y < H; y++)
        assert_int_equal(TIFFWriteScanline(t, row, y, 0), 1);
    TIFFClose(t);
    assert_int_equal(orl_picture_read_linear(&log, path, &image), ORL_ERR_UNSUPPORTED);
    assert_non_null(strstr(said.text, "save it as RGB"));
}

// --- RAW ---

static const double camera_light[2][3] = {{0.25, 0.5, 0.125}, {0.02, 0.04, 0.03}};
static const double neutral[3] = {0.5, 1, 0.8};

// A DNG of a camera whose primaries are sRGB's and that sees neutral light as `neutral`:
// two halves of one colour each and a saturated corner, RGGB.
static bool write_dng(const char *path)
{
    enum { BLACK = 512, WHITE = 15360 };
    static const float xyz_to_srgb[9] = {3.2404542f, -1.5371385f, -0.4985314f,
                                         -0.9692660f, 1.8760108f, 0.0415560f,
                                         0.0556434f, -0.2040259f, 1.0572252f};
    const float shot[3] = {(float)neutral[0], (float)neutral[1], (float)neutral[2]};
    const uint16_t repeat[2] = {2, 2};
    const float black = BLACK;
    const uint32_t white = WHITE;
    struct variety v = {16, 1, PLANARCONFIG_CONTIG, COMPRESSION_NONE, 0, "w"};
    TIFF *t = begin_tiff(path, &v, 32803 /* CFA */);
    // What the camera sees of XYZ: sRGB's matrix, rows scaled by its neutral.
    float matrix[9];
    for (int i = 0; i < 9; i++)
        matrix[i] = xyz_to_srgb[i] * shot[i / 3];
    bool ok = TIFFSetField(t, TIFFTAG_SUBFILETYPE, 0) && TIFFSetField(t, TIFFTAG_MAKE, "Oriel") &&
              TIFFSetField(t, TIFFTAG_MODEL, "Test") &&
              TIFFSetField(t, TIFFTAG_UNIQUECAMERAMODEL, "Oriel Test") &&
              TIFFSetField(t, TIFFTAG_DNGVERSION, "\001\004\000\000") &&
              TIFFSetField(t, TIFFTAG_CFAREPEATPATTERNDIM, repeat) &&
              TIFFSetField(t, TIFFTAG_CFAPATTERN, 4, "\000\001\001\002") &&
              TIFFSetField(t, TIFFTAG_CFAPLANECOLOR, 3, "\000\001\002") &&
              TIFFSetField(t, TIFFTAG_CFALAYOUT, 1) &&
              TIFFSetField(t, TIFFTAG_BLACKLEVEL, 1, &black) &&
              TIFFSetField(t, TIFFTAG_WHITELEVEL, 1, &white) &&
              TIFFSetField(t, TIFFTAG_COLORMATRIX1, 9, matrix) &&
              TIFFSetField(t, TIFFTAG_CALIBRATIONILLUMINANT1, 21) &&
              TIFFSetField(t, TIFFTAG_ASSHOTNEUTRAL, 3, shot);
    for (uint32_t y = 0; y < H && ok; y++) {
        uint16_t row[W];
        for (uint32_t x = 0; x < W; x++) {
            int c = y % 2 == 0 ? (x % 2 == 0 ? 0 : 1) : (x % 2 == 0 ? 1 : 2);
            double seen = x > 70 && y > 50 ? 9 : camera_light[x >= W / 2][c] * neutral[c];
            row[x] = (uint16_t)fmin(WHITE, lround(BLACK + seen * (WHITE - BLACK)));
        }
        ok = TIFFWriteScanline(t, row, y, 0) == 1;
    }
    TIFFClose(t);
    return ok;
}

// White balance divides by the neutral; the smallest multiplier is 1, so white stays the
// sensor's full scale and light comes out as it went in.
static void raw_is_linear_with_the_cameras_white_balance(void **state)
{
    (void)state;
    const char *path = in_dir("a.dng");
    struct orl_picture_info info;
    if (!write_dng(path)) {
        printf("skipped: this libtiff cannot write a DNG\n");
        skip();
    }
    struct orl_image image = read_linear(path, 16, false);
    for (int half = 0; half < 2; half++)
        for (int c = 0; c < 3; c++) {
            float got = image.f32[3 * (30 * W + (half ? 60 : 20)) + c];
            assert_float_equal(got, camera_light[half][c], 0.01 * camera_light[half][c] + 2e-4);
        }
    for (int c = 0; c < 3; c++)
        assert_float_equal(image.f32[3 * (62 * W + 82) + c], 1, 0.01);
    orl_image_finish(&image);
    assert_int_equal(orl_picture_inspect(NULL, path, &info), ORL_OK);
    assert_string_equal(info.exif.model, "Test");

    uint8_t *data;
    size_t size;
    assert_int_equal(orl_file_read(NULL, path, 1 << 20, &data, &size), ORL_OK);
    assert_int_equal(orl_file_write(NULL, path, data, size / 2), ORL_OK);
    assert_int_not_equal(orl_picture_read_linear(NULL, path, &image), ORL_OK);
    assert_null(image.data);
    assert_int_equal(orl_file_write(NULL, path, "nothing of the kind", 19), ORL_OK);
    assert_int_not_equal(orl_picture_read_linear(NULL, path, &image), ORL_OK);
    free(data);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(sixteen_bits_of_srgb),
        cmocka_unit_test(floats_are_light_as_it_is),
        cmocka_unit_test(tiff_varieties),
        cmocka_unit_test(tiff_profiles_are_applied),
        cmocka_unit_test(jpeg_and_png_profiles_are_applied),
        cmocka_unit_test(png_gamma_is_applied),
        cmocka_unit_test(png_primaries_are_applied),
        cmocka_unit_test(exr_primaries_are_applied),
        cmocka_unit_test(tiff_alpha_is_taken_out),
        cmocka_unit_test(adobe_rgb_by_exif_is_applied),
        cmocka_unit_test(panoramas_are_known),
        cmocka_unit_test(gain_maps_are_known),
        cmocka_unit_test(damaged_tiff_is_an_error),
        cmocka_unit_test(unusual_tiff_is_refused_with_advice),
        cmocka_unit_test(raw_is_linear_with_the_cameras_white_balance),
    };
    return cmocka_run_group_tests(tests, set_up, tear_down);
}
