// TIFF through libtiff: 8 or 16 bits in sRGB or in the space of an embedded colour profile,
// or 32-bit floats of linear light.
#include <math.h>
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include <tiffio.h>

#include "core/memory.h"
#include "io/internal.h"

// Largest accepted compression ratio; a header that implies more states a false size.
enum { MAX_RATIO = 20000 };

struct tiff_job {
    struct orl_picture_file *file;
    TIFF *tiff;
    uint32_t width, height;
    uint16_t bits, samples, format, photometric, planar;
    bool multiplied; // by the alpha that follows the colours
    char message[512]; // libtiff's first error
};

static int take_error(TIFF *tiff, void *priv, const char *module, const char *format, va_list args)
{
    (void)tiff;
    (void)module;
    struct tiff_job *job = priv;
    if (!*job->message)
        vsnprintf(job->message, sizeof job->message, format, args);
    return 1; // the error is handled
}

static int take_warning(TIFF *tiff, void *priv, const char *module, const char *format,
                        va_list args)
{
    (void)tiff;
    (void)module;
    struct tiff_job *job = priv;
    char text[512];
    vsnprintf(text, sizeof text, format, args);
    orl_logf(job->file->log, ORL_LOG_DEBUG, "%s: TIFF: %s", job->file->path, text);
    return 1;
}

static enum orl_result fail(const struct tiff_job *job)
{
    return orl_fail(job->file->log, ORL_ERR_FORMAT, "%s: TIFF: %s", job->file->path,
                    *job->message ? job->message : "damaged");
}

static enum orl_result open_tiff(struct tiff_job *job)
{
    TIFFOpenOptions *options = TIFFOpenOptionsAlloc();
    ORL_TRY_MEMORY(options);
    TIFFOpenOptionsSetErrorHandlerExtR(options, take_error, job);
    TIFFOpenOptionsSetWarningHandlerExtR(options, take_warning, job);
    TIFFOpenOptionsSetMaxSingleMemAlloc(options, (tmsize_t)1 << 30);
    job->tiff = TIFFOpenExt(job->file->path, "rm", options); // m: not mapped into memory
    TIFFOpenOptionsFree(options);
    return job->tiff ? ORL_OK : fail(job);
}

// --- header ---

static bool is_supported(const struct tiff_job *job)
{
    bool integer = job->format == SAMPLEFORMAT_UINT && (job->bits == 8 || job->bits == 16);
    bool floating = job->format == SAMPLEFORMAT_IEEEFP && job->bits == 32;
    bool gray = job->photometric == PHOTOMETRIC_MINISBLACK && job->samples >= 1;
    bool colour = job->photometric == PHOTOMETRIC_RGB && job->samples >= 3;
    return (integer || floating) && (gray || colour);
}

static enum orl_result read_header(struct tiff_job *job)
{
    struct orl_picture_file *file = job->file;
    TIFF *t = job->tiff;
    uint16_t extra_count = 0, *extra = NULL;
    TIFFGetField(t, TIFFTAG_IMAGEWIDTH, &job->width);
    TIFFGetField(t, TIFFTAG_IMAGELENGTH, &job->height);
    TIFFGetFieldDefaulted(t, TIFFTAG_BITSPERSAMPLE, &job->bits);
    TIFFGetFieldDefaulted(t, TIFFTAG_SAMPLESPERPIXEL, &job->samples);
    TIFFGetFieldDefaulted(t, TIFFTAG_SAMPLEFORMAT, &job->format);
    TIFFGetFieldDefaulted(t, TIFFTAG_PLANARCONFIG, &job->planar);
    TIFFGetField(t, TIFFTAG_PHOTOMETRIC, &job->photometric);
    job->multiplied = TIFFGetFieldDefaulted(t, TIFFTAG_EXTRASAMPLES, &extra_count, &extra) &&
                      extra_count && extra[0] == EXTRASAMPLE_ASSOCALPHA &&
                      job->samples > (job->photometric == PHOTOMETRIC_RGB ? 3 : 1);
    ORL_TRY(orl_picture_set_size(file, job->width, job->height));
    if (!is_supported(job))
        return orl_fail(file->log, ORL_ERR_UNSUPPORTED,
                        "%s: a TIFF of %u samples of %u bits in this colour space cannot be read; "
                        "save it as RGB with 8 or 16 bits", file->path, job->samples, job->bits);
    if (job->multiplied && job->planar == PLANARCONFIG_SEPARATE)
        return orl_fail(file->log, ORL_ERR_UNSUPPORTED, "%s: a TIFF with premultiplied alpha in a plane "
                        "of its own cannot be read; save it without alpha", file->path);
    file->info.bits = job->bits;
    file->info.unbounded = file->light = job->format == SAMPLEFORMAT_IEEEFP;
    uint64_t bytes = (uint64_t)job->width * job->height * job->samples * (job->bits / 8);
    return orl_picture_check_bytes(file, bytes / MAX_RATIO);
}

static void copy_text(TIFF *tiff, uint32_t tag, char *text, size_t size)
{
    const char *value = NULL;
    if (TIFFGetField(tiff, tag, &value) && value)
        orl_exif_text(value, strlen(value), text, size);
}

static double positive(TIFF *tiff, uint32_t tag)
{
    float value = 0;
    return TIFFGetField(tiff, tag, &value) && isfinite(value) && value > 0 ? (double)value : 0;
}

// Changes the current directory from the picture to its EXIF block, so it must come last.
static void read_exif(TIFF *t, struct orl_exif *exif)
{
    static const uint32_t wide[] = {EXIFTAG_ISOSPEED, EXIFTAG_RECOMMENDEDEXPOSUREINDEX,
                                    EXIFTAG_STANDARDOUTPUTSENSITIVITY}; // as in exif.c
    uint16_t orientation = 1, iso_count = 0, focal_35 = 0, *iso = NULL;
    uint32_t other = 0;
    float bias = 0;
    toff_t offset = 0;
    copy_text(t, TIFFTAG_MAKE, exif->make, sizeof exif->make);
    copy_text(t, TIFFTAG_MODEL, exif->model, sizeof exif->model);
    TIFFGetFieldDefaulted(t, TIFFTAG_ORIENTATION, &orientation);
    exif->orientation = orientation;
    if (!TIFFGetField(t, TIFFTAG_EXIFIFD, &offset) || !TIFFReadEXIFDirectory(t, offset))
        return;
    exif->exposure_s = positive(t, EXIFTAG_EXPOSURETIME);
    exif->aperture = positive(t, EXIFTAG_FNUMBER);
    exif->focal_mm = positive(t, EXIFTAG_FOCALLENGTH);
    if (TIFFGetField(t, EXIFTAG_EXPOSUREBIASVALUE, &bias) && isfinite(bias))
        exif->bias_ev = (double)bias;
    if (TIFFGetField(t, EXIFTAG_ISOSPEEDRATINGS, &iso_count, &iso) && iso_count && iso)
        exif->iso = iso[0];
    for (size_t i = 0; i < ORL_COUNT(wide) && !(exif->iso > 0 && exif->iso < 65535) && !other; i++)
        if (TIFFGetField(t, wide[i], &other) && other)
            exif->iso = other;
    if (TIFFGetField(t, EXIFTAG_FOCALLENGTHIN35MMFILM, &focal_35))
        exif->focal_35mm = focal_35;
}

// --- pixels ---

static float stored(const struct tiff_job *job, const uint8_t *sample)
{
    uint16_t wide = *sample;
    float value = 0;
    if (job->bits == 32)
        memcpy(&value, sample, sizeof value);
    else if (job->bits == 16)
        memcpy(&wide, sample, sizeof wide);
    return job->bits == 32 ? value : (float)wide / (job->bits == 16 ? 65535 : 255);
}

// What has been multiplied by alpha is divided by it. Light may exceed white.
static float sample(const struct tiff_job *job, const uint8_t *from, float alpha)
{
    float value = stored(job, from), whole = alpha > 0 ? value / alpha : 0;
    if (alpha >= 1)
        return value;
    return whole > 1 && job->format != SAMPLEFORMAT_IEEEFP ? 1 : whole;
}

// Copies `count` pixels from a buffer into a row of the image. plane -1: samples are interleaved.
static void take_pixels(const struct tiff_job *job, const uint8_t *from, size_t count, int plane,
                        float *rgb)
{
    size_t bytes = job->bits / 8, step = plane < 0 ? bytes * job->samples : bytes;
    bool gray = job->photometric == PHOTOMETRIC_MINISBLACK;
    for (size_t i = 0; i < count; i++, from += step) {
        float alpha = job->multiplied ? stored(job, from + (gray ? 1 : 3) * bytes) : 1;
        if (gray && plane <= 0)
            rgb[3 * i] = rgb[3 * i + 1] = rgb[3 * i + 2] = sample(job, from, alpha);
        else if (!gray && plane < 0)
            for (size_t c = 0; c < 3; c++)
                rgb[3 * i + c] = sample(job, from + c * bytes, alpha);
        else if (!gray && plane < 3)
            rgb[3 * i + (size_t)plane] = sample(job, from, alpha);
    }
}

// Reads the picture's tiles, or its rows, which are tiles as wide as it.
static enum orl_result read_tiles(struct tiff_job *job, struct orl_image *image)
{
    bool separate = job->planar == PLANARCONFIG_SEPARATE, tiled = TIFFIsTiled(job->tiff);
    uint32_t width = tiled ? 0 : job->width, height = !tiled;
    if (tiled) {
        TIFFGetField(job->tiff, TIFFTAG_TILEWIDTH, &width);
        TIFFGetField(job->tiff, TIFFTAG_TILELENGTH, &height);
    }
    tmsize_t size = tiled ? TIFFTileSize(job->tiff) : TIFFScanlineSize(job->tiff);
    uint64_t pitch = (uint64_t)width * (job->bits / 8) * (separate ? 1 : job->samples);
    if (!width || !height || size <= 0 || (uint64_t)size / height < pitch || size > 1 << 30)
        return fail(job);
    uint8_t *tile = orl_array(job->file->log, (size_t)size, 1);
    ORL_TRY_MEMORY(tile);
    enum orl_result result = ORL_OK;
    for (uint16_t plane = 0; plane < (separate ? job->samples : 1); plane++)
        for (uint32_t y = 0; y < job->height && result == ORL_OK; y += height)
            for (uint32_t x = 0; x < job->width && result == ORL_OK; x += width) {
                if (tiled ? TIFFReadTile(job->tiff, tile, x, y, 0, plane) < 0
                          : TIFFReadScanline(job->tiff, tile, y, plane) != 1)
                    result = fail(job);
                uint32_t columns = job->width - x < width ? job->width - x : width;
                uint32_t rows = job->height - y < height ? job->height - y : height;
                for (uint32_t r = 0; r < rows && result == ORL_OK; r++)
                    take_pixels(job, tile + r * pitch, columns, separate ? plane : -1,
                                image->f32 + ((size_t)(y + r) * job->width + x) * 3);
            }
    free(tile);
    return result;
}

// The colour profile of a file of integer samples. Converters of RAW files often write a wider colour space than sRGB.
static void read_profile(const struct tiff_job *job)
{
    const void *icc = NULL;
    uint32_t size = 0;
    if (job->format == SAMPLEFORMAT_UINT && TIFFGetField(job->tiff, TIFFTAG_ICCPROFILE, &size, &icc) && size)
        job->file->profile = orl_profile_create(job->file->log, job->file->path, icc, size);
}

enum orl_result orl_tiff_read(struct orl_picture_file *file, struct orl_image *image)
{
    struct tiff_job job = {.file = file};
    enum orl_result result = open_tiff(&job);
    ORL_THEN(result, read_header(&job));
    if (result == ORL_OK && image) {
        read_profile(&job);
        result = orl_picture_check_memory(file, 3 * sizeof(float));
        ORL_THEN(result, orl_image_init(file->log, image, file->info.width, file->info.height, 3, ORL_PIXEL_F32));
        ORL_THEN(result, read_tiles(&job, image));
    } else if (result == ORL_OK) {
        read_exif(job.tiff, &file->info.exif);
    }
    if (job.tiff)
        TIFFClose(job.tiff);
    return result;
}
