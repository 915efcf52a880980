// Selects the reader of a file and converts between 8-bit and linear pictures.
#include "io/picture.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "core/color.h"
#include "core/file.h"
#include "core/memory.h"
#include "io/exr.h"
#include "io/internal.h"

enum format { FORMAT_UNKNOWN, FORMAT_JPEG, FORMAT_PNG, FORMAT_TIFF, FORMAT_EXR, FORMAT_RAW,
              FORMAT_PNM, FORMAT_HEIF, FORMATS };

static const size_t max_file_bytes = (size_t)1 << 30;

bool orl_picture_is_raw(const char *path)
{
    return orl_path_has_extension(path, "3fr arw cr2 cr3 crw dcr dng erf iiq k25 kdc mef mrw nef nrw orf "
                                        "pef raf raw rw2 sr2 srf srw x3f");
}

bool orl_picture_is_png(const char *path)
{
    return orl_path_has_extension(path, "png");
}

static enum format format_of(const char *path, const uint8_t *data, size_t size)
{
    static const struct {
        enum format format;
        size_t size;
        uint8_t magic[8];
    } known[] = {
        {FORMAT_JPEG, 3, {0xff, 0xd8, 0xff}},
        {FORMAT_PNG, 8, {0x89, 'P', 'N', 'G', '\r', '\n', 0x1a, '\n'}},
        {FORMAT_EXR, 4, {0x76, 0x2f, 0x31, 0x01}},
        {FORMAT_TIFF, 4, {'I', 'I', 42, 0}}, {FORMAT_TIFF, 4, {'M', 'M', 0, 42}},
        {FORMAT_TIFF, 4, {'I', 'I', 43, 0}}, {FORMAT_TIFF, 4, {'M', 'M', 0, 43}}, // BigTIFF
    };
    enum format format = FORMAT_UNKNOWN;
    for (size_t i = 0; i < ORL_COUNT(known) && format == FORMAT_UNKNOWN; i++)
        if (size >= known[i].size && memcmp(data, known[i].magic, known[i].size) == 0)
            format = known[i].format;
    if (format == FORMAT_UNKNOWN && orl_pnm_is(data, size))
        format = FORMAT_PNM;
    if (format == FORMAT_UNKNOWN && orl_heif_is(data, size))
        format = FORMAT_HEIF;
    bool may_be_raw = format == FORMAT_UNKNOWN || format == FORMAT_TIFF;
    return may_be_raw && size && orl_picture_is_raw(path) ? FORMAT_RAW : format;
}

enum orl_result orl_picture_check_size(const struct orl_log *log, const char *path,
                                       uint64_t width, uint64_t height)
{
    if (width < 1 || height < 1 || width > ORL_IMAGE_MAX_SIDE || height > ORL_IMAGE_MAX_SIDE ||
        width * height > ORL_PICTURE_MAX_PIXELS)
        return orl_fail(log, ORL_ERR_FORMAT, "%s: its header asks for %llux%llu pixels", path,
                        (unsigned long long)width, (unsigned long long)height);
    return ORL_OK;
}

enum orl_result orl_picture_check_memory(const struct orl_log *log, const char *path,
                                         uint64_t width, uint64_t height,
                                         uint64_t bytes_per_pixel)
{
    const uint64_t small = 64 << 20; // too small to be worth the check
    const double gib = 1 << 30;
    enum orl_result result = orl_picture_check_size(log, path, width, height);
    uint64_t asked = width * height * bytes_per_pixel;
    if (result != ORL_OK || asked < small)
        return result;
    uint64_t left = orl_memory_available();
    return asked <= left
               ? ORL_OK
               : orl_fail(log, ORL_ERR_MEMORY,
                          "%s: its %llux%llu pixels take %.1f GiB of memory to read, and %.1f GiB "
                          "are left", path, (unsigned long long)width, (unsigned long long)height,
                          (double)asked / gib, (double)left / gib);
}

// --- headers ---

static enum orl_result open_file(const struct orl_log *log, const char *path, FILE **stream,
                                 enum format *format)
{
    uint8_t magic[12];
    ORL_TRY(orl_file_open(log, path, stream));
    size_t got = fread(magic, 1, sizeof magic, *stream);
    rewind(*stream);
    *format = format_of(path, magic, got);
    if (*format != FORMAT_UNKNOWN)
        return ORL_OK;
    fclose(*stream);
    return orl_fail(log, ORL_ERR_FORMAT, "%s: not a picture of a known kind "
                    "(JPEG, PNG, PNM, TIFF, EXR, HEIC, AVIF, RAW)", path);
}

static enum orl_result decode_exif(const struct orl_log *log, const char *path,
                                   const struct orl_picture_header *header, struct orl_exif *exif)
{
    return orl_exif_decode(log, path, (const uint8_t *)header->exif.data, header->exif.size, exif);
}

// NULL: the colours are taken as sRGB.
static struct orl_profile *make_profile(const struct orl_log *log, const char *path,
                                        const struct orl_picture_header *header)
{
    // Adobe RGB (1998), which cameras name in EXIF alone.
    const struct orl_primaries adobe = {
        .white = {0.3127, 0.3290}, .red = {0.64, 0.33}, .green = {0.21, 0.71}, .blue = {0.15, 0.06}};
    const double adobe_gamma = 563.0 / 256;
    struct orl_exif exif = {0};
    bool told = header->primaries.white[1] > 0;
    if (header->icc.size)
        return orl_profile_create(log, path, header->icc.data, header->icc.size);
    if (header->gamma > 0 || told)
        return orl_profile_create_rgb(log, path, told ? &header->primaries : &orl_primaries_rec709,
                                      header->gamma > 0 ? 1 / header->gamma : 0);
    if (!header->exif.size || decode_exif(NULL, path, header, &exif) != ORL_OK || !exif.adobe_rgb)
        return NULL;
    return orl_profile_create_rgb(log, path, &adobe, adobe_gamma);
}

bool orl_xmp_tells_panorama(const void *xmp, size_t size)
{
    static const char key[] = "ProjectionType", flat[] = "rectilinear";
    return memmem(xmp, size, key, sizeof key - 1) && !memmem(xmp, size, flat, sizeof flat - 1);
}

static enum orl_result read_stream_header(const struct orl_log *log, const char *path,
                                          FILE *stream, enum format format,
                                          struct orl_picture_info *info, struct orl_exif *exif)
{
    struct orl_picture_header header = {0};
    enum orl_result result =
        format == FORMAT_JPEG  ? orl_jpeg_read_header(log, path, stream, &header)
        : format == FORMAT_PNG ? orl_png_read_header(log, path, stream, &header)
                               : orl_pnm_read_header(log, path, stream, &header);
    struct orl_profile *profile = result == ORL_OK ? make_profile(NULL, path, &header) : NULL;
    *info = header.info;
    info->profiled = profile != NULL;
    orl_profile_destroy(&profile);
    if (result == ORL_OK && header.exif.size)
        result = decode_exif(log, path, &header, exif);
    free(header.exif.data);
    free(header.icc.data);
    return result;
}

static enum orl_result inspect_exr(const struct orl_log *log, const char *path, struct orl_picture_info *info,
                                   struct orl_exif *exif)
{
    (void)exif;
    *info = (struct orl_picture_info){.bits = 32, .unbounded = true};
    return orl_exr_size(log, path, &info->width, &info->height);
}

static enum orl_result read_exr(const struct orl_log *log, const char *path, struct orl_image *image);

// Formats that are read from the file's path alone.
static const struct {
    enum orl_result (*inspect)(const struct orl_log *log, const char *path, struct orl_picture_info *info,
                               struct orl_exif *exif);
    enum orl_result (*decode_linear)(const struct orl_log *log, const char *path, struct orl_image *image);
} by_path[FORMATS] = {[FORMAT_TIFF] = {orl_tiff_inspect, orl_tiff_decode_linear},
                      [FORMAT_HEIF] = {orl_heif_inspect, NULL},
                      [FORMAT_RAW] = {orl_raw_inspect, orl_raw_decode_linear},
                      [FORMAT_EXR] = {inspect_exr, read_exr}};

static enum orl_result read_header(const struct orl_log *log, const char *path,
                                   struct orl_picture_info *info, struct orl_exif *exif)
{
    FILE *stream = NULL;
    enum format format = FORMAT_UNKNOWN;
    ORL_TRY(open_file(log, path, &stream, &format));
    enum orl_result result = by_path[format].inspect ? by_path[format].inspect(log, path, info, exif)
                                                     : read_stream_header(log, path, stream, format, info, exif);
    info->panorama |= exif->panorama;
    fclose(stream);
    return result;
}

enum orl_result orl_picture_inspect(const struct orl_log *log, const char *path,
                                    struct orl_picture_info *info)
{
    struct orl_exif unused = {0};
    memset(info, 0, sizeof *info);
    enum orl_result result = read_header(log, path, info, &unused);
    if (result != ORL_OK)
        memset(info, 0, sizeof *info);
    return result;
}

enum orl_result orl_picture_size(const struct orl_log *log, const char *path, int *width,
                                 int *height)
{
    struct orl_picture_info info;
    enum orl_result result = orl_picture_inspect(log, path, &info);
    *width = info.width;
    *height = info.height;
    return result;
}

enum orl_result orl_exif_read(const struct orl_log *log, const char *path, struct orl_exif *exif)
{
    memset(exif, 0, sizeof *exif);
    struct orl_picture_info info = {0};
    return read_header(log, path, &info, exif);
}

// --- pixels ---

static enum orl_result read_exr(const struct orl_log *log, const char *path,
                                struct orl_image *image)
{
    static const char *const rgb[] = {"R", "G", "B"}, *const gray[] = {"Y"};
    struct orl_image luma;
    struct orl_primaries primaries;
    if (orl_exr_read(NULL, path, rgb, 3, image) == ORL_OK) {
        struct orl_profile *profile =
            orl_exr_primaries(path, &primaries) ? orl_profile_create_rgb(log, path, &primaries, 1) : NULL;
        if (profile)
            orl_profile_to_linear(profile, image);
        orl_profile_destroy(&profile);
        return ORL_OK;
    }
    if (orl_exr_read(NULL, path, gray, 1, &luma) != ORL_OK)
        return orl_exr_read(log, path, rgb, 3, image); // to get its error message
    enum orl_result result = orl_image_init(log, image, luma.width, luma.height, 3, ORL_PIXEL_F32);
    size_t count = result == ORL_OK ? orl_image_bytes(&luma) / sizeof(float) : 0;
    for (size_t i = 0; i < 3 * count; i++)
        image->f32[i] = luma.f32[i / 3];
    orl_image_finish(&luma);
    return result;
}

// What is known of a file before its pixels are decoded.
struct facts {
    enum format format;
    int bits; // a sample; 0: not known
    struct orl_profile *profile; // of the samples as stored, owned; NULL: they are taken as sRGB, or decoded as light
};

// Damage is left to the decoder to find. profile_log: is told of a profile that cannot be used
static enum orl_result look_at(const struct orl_log *log, const struct orl_log *profile_log, const char *path,
                               struct facts *facts)
{
    struct orl_picture_header header = {0};
    FILE *stream = NULL;
    *facts = (struct facts){0};
    ORL_TRY(open_file(log, path, &stream, &facts->format));
    enum format format = facts->format;
    if ((format == FORMAT_JPEG && orl_jpeg_read_header(NULL, path, stream, &header) == ORL_OK) ||
        (format == FORMAT_PNG && orl_png_read_header(NULL, path, stream, &header) == ORL_OK))
        facts->profile = make_profile(profile_log, path, &header);
    facts->bits = header.info.bits;
    if (format == FORMAT_HEIF)
        orl_heif_profile(profile_log, path, &facts->bits, &facts->profile);
    fclose(stream);
    free(header.exif.data);
    free(header.icc.data);
    return ORL_OK;
}

// Decodes the samples of a JPEG, PNG, PNM or HEIF file as stored. channels: of JPEG; kind: of PNG
static enum orl_result decode_file(const struct orl_log *log, const char *path, enum format format, int channels,
                                   enum orl_png_kind kind, struct orl_image *image)
{
    uint8_t *data = NULL;
    size_t size = 0;
    if (format == FORMAT_HEIF)
        return orl_heif_decode(log, path, image);
    ORL_TRY(orl_file_read(log, path, max_file_bytes, &data, &size));
    enum orl_result result = format == FORMAT_JPEG  ? orl_jpeg_decode(log, path, data, size, channels, image)
                             : format == FORMAT_PNG ? orl_png_decode(log, path, data, size, kind, image)
                                                    : orl_pnm_decode(log, path, data, size, image);
    free(data);
    return result;
}

// Makes floats of 8-bit samples: light, or with a profile samples as stored.
static enum orl_result widen(const struct orl_log *log, const char *path, bool stored, struct orl_image *image)
{
    struct orl_image wide = {0};
    float value[256];
    for (int v = 0; v < 256; v++)
        value[v] = stored ? (float)v / 255 : orl_srgb_decode((float)v / 255);
    enum orl_result result = orl_picture_check_memory(log, path, (uint64_t)image->width, (uint64_t)image->height,
                                                      3 * sizeof(float));
    ORL_THEN(result, orl_image_init(log, &wide, image->width, image->height, 3, ORL_PIXEL_F32));
    const size_t count = result == ORL_OK ? orl_image_bytes(image) : 0;
    for (size_t i = 0; i < count; i++)
        wide.f32[i] = value[image->u8[i]];
    orl_image_finish(image);
    *image = wide;
    return result;
}

static enum orl_result decode_linear(const struct orl_log *log, const char *path, const struct facts *facts,
                                     struct orl_image *image)
{
    if (by_path[facts->format].decode_linear)
        return by_path[facts->format].decode_linear(log, path, image);
    ORL_TRY(decode_file(log, path, facts->format, 3, ORL_PNG_RGB_DEEP, image));
    if (image->type == ORL_PIXEL_U8) {
        ORL_TRY(widen(log, path, facts->profile != NULL, image));
    } else if (!facts->profile) {
        for (size_t i = 0; i < orl_image_bytes(image) / sizeof(float); i++)
            image->f32[i] = orl_srgb_decode(image->f32[i]);
    }
    if (facts->profile)
        orl_profile_to_linear(facts->profile, image);
    return ORL_OK;
}

enum orl_result orl_picture_read_linear(const struct orl_log *log, const char *path,
                                        struct orl_image *image)
{
    memset(image, 0, sizeof *image);
    struct facts facts;
    ORL_TRY(look_at(log, log, path, &facts));
    enum orl_result result = decode_linear(log, path, &facts, image);
    orl_profile_destroy(&facts.profile);
    if (result != ORL_OK)
        orl_image_finish(image);
    return result;
}

// Converts linear light to 8-bit sRGB.
static enum orl_result encode_eight(const struct orl_log *log, const struct orl_image *linear,
                                    struct orl_image *image)
{
    ORL_TRY(orl_image_init(log, image, linear->width, linear->height, 3, ORL_PIXEL_U8));
    for (size_t i = 0; i < orl_image_bytes(image); i++)
        image->u8[i] = (uint8_t)lrintf(255 * orl_srgb_encode(linear->f32[i]));
    return ORL_OK;
}

// Converts RGB to luma. libpng's own conversion works in linear light when the file has a gamma
// chunk, so its result would depend on that chunk.
static enum orl_result to_luma(const struct orl_log *log, struct orl_image *image)
{
    struct orl_image luma;
    ORL_TRY(orl_image_init(log, &luma, image->width, image->height, 1, ORL_PIXEL_U8));
    for (size_t i = 0; i < orl_image_bytes(&luma); i++) {
        const uint8_t *p = image->u8 + 3 * i;
        luma.u8[i] = (uint8_t)((299u * p[0] + 587u * p[1] + 114u * p[2] + 500u) / 1000u);
    }
    orl_image_finish(image);
    *image = luma;
    return ORL_OK;
}

enum orl_result orl_picture_read(const struct orl_log *log, const char *path, int channels,
                                 struct orl_image *image)
{
    memset(image, 0, sizeof *image);
    ORL_REQUIRE(log, channels == 1 || channels == 3);
    struct orl_image linear = {0};
    struct facts facts;
    ORL_TRY(look_at(log, NULL, path, &facts));
    // PNG of 16 bits is rounded to 8 unless it has a profile.
    bool deep = facts.bits > 8 && (facts.profile || facts.format != FORMAT_PNG);
    bool eight = !by_path[facts.format].decode_linear && !deep;
    enum orl_result result = eight ? decode_file(log, path, facts.format, facts.profile ? 3 : channels, ORL_PNG_RGB, image)
                                   : orl_picture_read_linear(log, path, &linear);
    if (result == ORL_OK && eight && facts.profile)
        result = orl_profile_to_srgb(log, facts.profile, image);
    orl_profile_destroy(&facts.profile);
    if (result == ORL_OK && !eight)
        result = encode_eight(log, &linear, image);
    if (result == ORL_OK && image->channels != channels)
        result = to_luma(log, image);
    if (result != ORL_OK)
        orl_image_finish(image);
    orl_image_finish(&linear);
    return result;
}

// Takes RGB or RGBA: U8, or F32 with the samples of an encoded picture.
static enum orl_result to_rgba(const struct orl_log *log, const struct orl_image *from,
                               struct orl_image *image)
{
    enum orl_result result = orl_image_init(log, image, from->width, from->height, 4,
                                            ORL_PIXEL_U8);
    size_t count = (size_t)from->width * (size_t)from->height;
    size_t channels = (size_t)from->channels;
    for (size_t i = 0; result == ORL_OK && i < count; i++)
        for (size_t c = 0; c < 4; c++) {
            size_t at = channels * i + c;
            image->u8[4 * i + c] =
                c >= channels ? 255
                : from->type == ORL_PIXEL_U8 ? from->u8[at]
                                             : (uint8_t)ceilf(255 * from->f32[at]);
        }
    return result;
}

enum orl_result orl_picture_read_rgba(const struct orl_log *log, const char *path,
                                      struct orl_image *image)
{
    memset(image, 0, sizeof *image);
    struct orl_image from = {0};
    FILE *stream = NULL;
    enum format format = FORMAT_UNKNOWN;
    ORL_TRY(open_file(log, path, &stream, &format));
    fclose(stream);
    enum orl_result result = ORL_OK;
    if (format == FORMAT_PNG) {
        result = decode_file(log, path, format, 3, ORL_PNG_RGBA, &from);
    } else if (format == FORMAT_JPEG || format == FORMAT_PNM) {
        result = orl_picture_read(log, path, 3, &from);
    } else {
        result = orl_picture_read_linear(log, path, &from);
        size_t count = result == ORL_OK ? orl_image_bytes(&from) / sizeof(float) : 0;
        for (size_t i = 0; i < count; i++)
            from.f32[i] = orl_srgb_encode(from.f32[i]);
    }
    ORL_THEN(result, to_rgba(log, &from, image));
    if (result != ORL_OK)
        orl_image_finish(image);
    orl_image_finish(&from);
    return result;
}

bool orl_exif_exposure_ev(const struct orl_exif *exif, double *ev)
{
    *ev = 0;
    if (!(exif->exposure_s > 0))
        return false;
    double exposure = exif->exposure_s;
    if (exif->iso > 0)
        exposure *= exif->iso / 100;
    if (exif->aperture > 0)
        exposure /= exif->aperture * exif->aperture;
    *ev = log2(exposure);
    return isfinite(*ev);
}
