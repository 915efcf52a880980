// Selects the reader of a file and converts between 8-bit and linear pictures.
#include "io/picture.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "core/color.h"
#include "core/file.h"
#include "core/memory.h"
#include "io/internal.h"

// Larger pictures are refused. Photographs are smaller, and a few hostile bytes must not make Oriel allocate all memory.
static const uint64_t max_pixels = (uint64_t)1 << 30;

static bool is_raw(const char *path)
{
    return orl_path_has_extension(path, "3fr arw cr2 cr3 crw dcr dng erf iiq k25 kdc mef mrw nef nrw orf "
                                        "pef raf raw rw2 sr2 srf srw x3f");
}

bool orl_picture_needs_copy(const char *path)
{
    return orl_path_has_extension(path, "tif tiff exr heic heif hif avif ppm") || is_raw(path);
}

bool orl_picture_is_png(const char *path)
{
    return orl_path_has_extension(path, "png");
}

// --- what readers call ---

enum orl_result orl_picture_set_size(struct orl_picture_file *file, uint64_t width, uint64_t height)
{
    if (width < 1 || height < 1 || width > ORL_IMAGE_MAX_SIDE || height > ORL_IMAGE_MAX_SIDE ||
        width * height > max_pixels)
        return orl_fail(file->log, ORL_ERR_FORMAT, "%s: its header asks for %llux%llu pixels", file->path,
                        (unsigned long long)width, (unsigned long long)height);
    file->info.width = (int)width;
    file->info.height = (int)height;
    return ORL_OK;
}

enum orl_result orl_picture_check_memory(const struct orl_picture_file *file, uint64_t bytes_per_pixel)
{
    const uint64_t small = 64 << 20; // too small to be worth the check
    const double gib = 1 << 30;
    uint64_t asked = (uint64_t)file->info.width * (uint64_t)file->info.height * bytes_per_pixel;
    uint64_t left = asked < small ? small : orl_memory_available();
    return asked <= left
               ? ORL_OK
               : orl_fail(file->log, ORL_ERR_MEMORY,
                          "%s: its %dx%d pixels take %.1f GiB of memory to read, and %.1f GiB are left", file->path,
                          file->info.width, file->info.height, (double)asked / gib, (double)left / gib);
}

enum orl_result orl_picture_check_bytes(const struct orl_picture_file *file, uint64_t least)
{
    return file->bytes >= least ? ORL_OK
                                : orl_fail(file->log, ORL_ERR_FORMAT, "%s: %llu bytes cannot hold %dx%d pixels",
                                           file->path, (unsigned long long)file->bytes, file->info.width,
                                           file->info.height);
}

bool orl_xmp_tells_panorama(const void *xmp, size_t size)
{
    static const char key[] = "ProjectionType", flat[] = "rectilinear";
    return memmem(xmp, size, key, sizeof key - 1) && !memmem(xmp, size, flat, sizeof flat - 1);
}

void orl_picture_set_profile(struct orl_picture_file *file, const void *icc, size_t icc_size, double gamma,
                             const struct orl_primaries *primaries)
{
    // Adobe RGB (1998), which cameras name in EXIF alone.
    const struct orl_primaries adobe = {
        .white = {0.3127, 0.3290}, .red = {0.64, 0.33}, .green = {0.21, 0.71}, .blue = {0.15, 0.06}};
    const double adobe_gamma = 563.0 / 256;
    bool told = primaries->white[1] > 0;
    if (icc_size)
        file->profile = orl_profile_create(file->profile_log, file->path, icc, icc_size);
    else if (gamma > 0 || told)
        file->profile = orl_profile_create_rgb(file->profile_log, file->path,
                                               told ? primaries : &orl_primaries_rec709, gamma > 0 ? 1 / gamma : 0);
    else if (file->info.exif.adobe_rgb)
        file->profile = orl_profile_create_rgb(file->profile_log, file->path, &adobe, adobe_gamma);
    file->info.profiled = file->profile != NULL;
}

// --- files ---

enum orl_result orl_picture_open(struct orl_picture_file *file)
{
    ORL_TRY(orl_file_open(file->log, file->path, &file->stream));
    file->bytes = fseeko(file->stream, 0, SEEK_END) == 0 ? (uint64_t)ftello(file->stream) : 0;
    rewind(file->stream);
    return ORL_OK;
}

// NULL, logged: not a picture of a known kind.
static orl_picture_reader *find_reader(struct orl_picture_file *file)
{
    static const struct {
        orl_picture_reader *read;
        size_t at, size; // of the magic bytes
        char magic[9];
    } known[] = {
        {orl_jpeg_read, 0, 3, "\xff\xd8\xff"}, {orl_png_read, 0, 8, "\x89PNG\r\n\x1a\n"},
        {orl_exr_read_picture, 0, 4, "\x76\x2f\x31\x01"},
        {orl_tiff_read, 0, 4, "II*\0"}, {orl_tiff_read, 0, 4, "MM\0*"},
        {orl_tiff_read, 0, 4, "II+\0"}, {orl_tiff_read, 0, 4, "MM\0+"}, // BigTIFF
        {orl_pnm_read, 0, 2, "P4"}, {orl_pnm_read, 0, 2, "P5"}, {orl_pnm_read, 0, 2, "P6"},
        {orl_heif_read, 4, 8, "ftypheic"}, {orl_heif_read, 4, 8, "ftypheix"}, {orl_heif_read, 4, 8, "ftypheim"},
        {orl_heif_read, 4, 8, "ftypheis"}, {orl_heif_read, 4, 8, "ftypmif1"}, {orl_heif_read, 4, 8, "ftypavif"},
    };
    uint8_t start[12];
    size_t got = fread(start, 1, sizeof start, file->stream);
    rewind(file->stream);
    orl_picture_reader *read = NULL;
    for (size_t i = 0; i < ORL_COUNT(known) && !read; i++)
        if (got >= known[i].at + known[i].size && memcmp(start + known[i].at, known[i].magic, known[i].size) == 0)
            read = known[i].read;
    if ((!read || read == orl_tiff_read) && got && is_raw(file->path))
        read = orl_raw_read;
    if (!read)
        orl_logf(file->log, ORL_LOG_ERROR, "%s: not a picture of a known kind "
                 "(JPEG, PNG, PNM, TIFF, EXR, HEIC, AVIF, RAW)", file->path);
    return read;
}

static enum orl_result read_file(struct orl_picture_file *file, struct orl_image *image)
{
    if (image)
        memset(image, 0, sizeof *image);
    ORL_TRY(orl_picture_open(file));
    orl_picture_reader *read = find_reader(file);
    enum orl_result result = read ? read(file, image) : ORL_ERR_FORMAT;
    file->info.panorama |= file->info.exif.panorama;
    fclose(file->stream);
    if (result != ORL_OK || !image)
        orl_profile_destroy(&file->profile);
    if (result != ORL_OK && image)
        orl_image_finish(image);
    return result;
}

enum orl_result orl_picture_inspect(const struct orl_log *log, const char *path,
                                    struct orl_picture_info *info)
{
    struct orl_picture_file file = {.log = log, .path = path};
    enum orl_result result = read_file(&file, NULL);
    *info = result == ORL_OK ? file.info : (struct orl_picture_info){0};
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

// --- pixels ---

// Makes floats of 8-bit samples: light, or with a profile samples as stored.
static enum orl_result widen(const struct orl_picture_file *file, struct orl_image *image)
{
    struct orl_image wide = {0};
    float value[256];
    for (int v = 0; v < 256; v++)
        value[v] = file->profile ? (float)v / 255 : orl_srgb_decode((float)v / 255);
    enum orl_result result = orl_picture_check_memory(file, 3 * sizeof(float));
    ORL_THEN(result, orl_image_init(file->log, &wide, image->width, image->height, 3, ORL_PIXEL_F32));
    const size_t count = result == ORL_OK ? orl_image_bytes(image) : 0;
    for (size_t i = 0; i < count; i++)
        wide.f32[i] = value[image->u8[i]];
    orl_image_finish(image);
    *image = wide;
    return result;
}

enum orl_result orl_picture_read_linear(const struct orl_log *log, const char *path,
                                        struct orl_image *image)
{
    struct orl_picture_file file = {.log = log, .profile_log = log, .path = path, .channels = 3};
    ORL_TRY(read_file(&file, image));
    enum orl_result result = ORL_OK;
    if (image->type == ORL_PIXEL_U8)
        result = widen(&file, image);
    else if (!file.light && !file.profile)
        for (size_t i = 0; i < orl_image_bytes(image) / sizeof(float); i++)
            image->f32[i] = orl_srgb_decode(image->f32[i]);
    if (result == ORL_OK && file.profile)
        orl_profile_to_linear(file.profile, image);
    orl_profile_destroy(&file.profile);
    return result;
}

// The 8-bit value of a sample; alpha is opaque where there is none.
static uint8_t eight(const struct orl_image *from, bool light, int channels, size_t pixel, int channel)
{
    size_t at = pixel * (size_t)from->channels + (size_t)channel;
    if (channel >= from->channels)
        return 255;
    if (from->type == ORL_PIXEL_U8)
        return from->u8[at];
    float value = 255 * (light ? orl_srgb_encode(from->f32[at]) : from->f32[at]);
    return (uint8_t)(channels == 4 ? ceilf(value) : rintf(value));
}

// Luma is made here: libpng's own conversion works in linear light when the file has a gamma chunk, so its result
// would depend on that chunk.
static enum orl_result to_eight(const struct orl_log *log, bool light, int channels, struct orl_image *image)
{
    struct orl_image made = {0};
    enum orl_result result = orl_image_init(log, &made, image->width, image->height, channels, ORL_PIXEL_U8);
    size_t count = result == ORL_OK ? (size_t)image->width * (size_t)image->height : 0;
    for (size_t i = 0; i < count; i++) {
        uint8_t v[4];
        for (int c = 0; c < 4; c++)
            v[c] = eight(image, light, channels, i, c);
        if (channels == 1)
            v[0] = (uint8_t)((299u * v[0] + 587u * v[1] + 114u * v[2] + 500u) / 1000u);
        memcpy(made.u8 + i * (size_t)channels, v, (size_t)channels);
    }
    orl_image_finish(image);
    *image = made;
    return result;
}

enum orl_result orl_picture_read(const struct orl_log *log, const char *path, int channels,
                                 struct orl_image *image)
{
    memset(image, 0, sizeof *image);
    ORL_REQUIRE(log, channels == 1 || channels == 3 || channels == 4);
    struct orl_picture_file file = {.log = log, .path = path, .channels = channels};
    ORL_TRY(read_file(&file, image));
    enum orl_result result = ORL_OK;
    if (channels == 4) // a mask, whose colours do not matter
        orl_profile_destroy(&file.profile);
    if (file.profile && image->type == ORL_PIXEL_U8)
        result = orl_profile_to_srgb(log, file.profile, image);
    else if (file.profile)
        orl_profile_to_linear(file.profile, image);
    if (image->type != ORL_PIXEL_U8 || image->channels != channels)
        ORL_THEN(result, to_eight(log, file.light || file.profile, channels, image));
    orl_profile_destroy(&file.profile);
    if (result != ORL_OK)
        orl_image_finish(image);
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
