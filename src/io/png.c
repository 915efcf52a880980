// PNG through libpng, which reports errors by longjmp. State that must survive a longjmp
// is in struct png_job, owned by the caller of the function that calls setjmp.
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include <png.h>

#include "core/file.h"
#include "io/internal.h"

// Of one allocation of libpng. A row of ORL_IMAGE_MAX_SIDE pixels takes 512 KiB.
enum { MEMORY_MAX = 1 << 26 };

struct png_job {
    const struct orl_log *log;
    const char *path;
    png_structp png;
    png_infop info;
    const uint8_t *data; // next byte to read
    size_t size;
    png_bytepp rows;     // owned
    bool wide;           // the decoded samples have 16 bits each
};

static void stop(png_structp png, png_const_charp message)
{
    struct png_job *job = png_get_error_ptr(png);
    orl_logf(job->log, ORL_LOG_ERROR, "%s: PNG: %s", job->path, message);
    png_longjmp(png, 1);
}

static void take_warning(png_structp png, png_const_charp message)
{
    struct png_job *job = png_get_error_ptr(png);
    orl_logf(job->log, ORL_LOG_DEBUG, "%s: PNG: %s", job->path, message);
}

static void read_bytes(png_structp png, png_bytep out, size_t size)
{
    struct png_job *job = png_get_io_ptr(png);
    if (size > job->size)
        png_error(png, "the file ends too early");
    memcpy(out, job->data, size);
    job->data += size;
    job->size -= size;
}

// libpng allocates, and zeroes, what a chunk's header claims before it reads the chunk: up to 2 GiB
// for a file of some bytes.
static png_voidp allocate(png_structp png, png_alloc_size_t size)
{
    if (size > MEMORY_MAX)
        png_error(png, "a chunk claims to be larger than 64 MiB");
    return malloc(size);
}

static enum orl_result start_reading(struct png_job *job)
{
    job->png = png_create_read_struct_2(PNG_LIBPNG_VER_STRING, job, stop, take_warning, NULL,
                                        allocate, NULL);
    job->info = job->png ? png_create_info_struct(job->png) : NULL;
    if (!job->info)
        return orl_fail(job->log, ORL_ERR_MEMORY, "%s: no memory for a PNG reader", job->path);
    png_set_user_limits(job->png, ORL_IMAGE_MAX_SIDE, ORL_IMAGE_MAX_SIDE);
    return ORL_OK;
}

static void end_reading(struct png_job *job)
{
    png_destroy_read_struct(&job->png, &job->info, NULL);
    free(job->rows);
}

// --- header ---

// The space of the colours by their code points (PNG's third edition, ITU-T H.273), which come before
// profile, gamma and primaries. False: the file has none.
static bool read_code_points(const struct png_job *job, struct orl_picture_header *header,
                             enum orl_result *result)
{
    enum { REC709 = 1, UNSTATED = 2, REC2020 = 9, P3 = 12 }; // primaries
    // Curves; those of SDR video (1, 14, 15) are shown as sRGB's.
    enum { VIDEO = 1, LINEAR = 8, SRGB = 13, VIDEO_10 = 14, VIDEO_12 = 15, PQ = 16, HLG = 18 };
    static const struct orl_primaries p3 = {
        {0.3127, 0.3290}, {0.680, 0.320}, {0.265, 0.690}, {0.150, 0.060}};
    static const struct orl_primaries rec2020 = {
        {0.3127, 0.3290}, {0.708, 0.292}, {0.170, 0.797}, {0.131, 0.046}};
    png_unknown_chunkp chunks;
    int count = png_get_unknown_chunks(job->png, job->info, &chunks);
    const uint8_t *code = NULL;
    for (int i = 0; i < count && !code; i++)
        if (memcmp(chunks[i].name, "cICP", 4) == 0 && chunks[i].size == 4)
            code = chunks[i].data;
    if (!code)
        return false;
    uint8_t primaries = code[0], curve = code[1];
    if (curve == PQ || curve == HLG)
        *result = orl_fail(job->log, ORL_ERR_UNSUPPORTED, "%s: PNG: its samples are HDR (PQ or HLG); "
                           "save it as SDR or as EXR", job->path);
    else if ((primaries != REC709 && primaries != UNSTATED && primaries != REC2020 && primaries != P3) ||
             (curve != VIDEO && curve != UNSTATED && curve != LINEAR && curve != SRGB &&
              curve != VIDEO_10 && curve != VIDEO_12) || code[2] != 0 || code[3] != 1)
        *result = orl_fail(job->log, ORL_ERR_UNSUPPORTED, "%s: PNG: the space of its colours (cICP "
                           "%d, %d, %d, %d) is not read; save it as sRGB", job->path, primaries, curve,
                           code[2], code[3]);
    header->gamma = curve == LINEAR ? 1 : 0;
    header->primaries = primaries == P3 ? p3 : primaries == REC2020 ? rec2020 : orl_primaries_rec709;
    return true;
}

// Samples are sRGB-encoded, of 16 bits too, unless the file says otherwise.
static double gamma_of(const struct png_job *job)
{
    const double srgb = 1 / 2.2, tolerance = 0.05;
    double gamma = 0;
    int intent;
    bool told = !png_get_sRGB(job->png, job->info, &intent) &&
                png_get_gAMA(job->png, job->info, &gamma);
    return told && gamma > 0.1 && gamma < 10 && fabs(gamma / srgb - 1) > tolerance ? gamma : 0;
}

static void read_primaries(const struct png_job *job, struct orl_primaries *p)
{
    int intent;
    if (!png_get_sRGB(job->png, job->info, &intent))
        (void)png_get_cHRM(job->png, job->info, &p->white[0], &p->white[1], &p->red[0], &p->red[1],
                           &p->green[0], &p->green[1], &p->blue[0], &p->blue[1]);
}

static enum orl_result read_header(struct png_job *job, FILE *stream,
                                   struct orl_picture_header *header)
{
    if (setjmp(png_jmpbuf(job->png)))
        return ORL_ERR_FORMAT;
    png_init_io(job->png, stream);
    png_set_keep_unknown_chunks(job->png, PNG_HANDLE_CHUNK_ALWAYS, (png_const_bytep) "cICP", 1);
    png_read_info(job->png, job->info);
    png_uint_32 width = png_get_image_width(job->png, job->info);
    png_uint_32 height = png_get_image_height(job->png, job->info);
    ORL_TRY(orl_picture_check_size(job->log, job->path, width, height));
    enum orl_result result = ORL_OK;
    bool by_code = read_code_points(job, header, &result);
    ORL_TRY(result);
    header->info = (struct orl_picture_info){.width = (int)width, .height = (int)height,
                                             .bits = png_get_bit_depth(job->png, job->info)};
    png_textp texts;
    int text_count = png_get_text(job->png, job->info, &texts, NULL);
    for (int i = 0; i < text_count; i++)
        header->info.panorama |= strcmp(texts[i].key, "XML:com.adobe.xmp") == 0 &&
                                 orl_xmp_tells_panorama(texts[i].text, strlen(texts[i].text));
#ifdef PNG_eXIf_SUPPORTED
    png_uint_32 size = 0;
    png_bytep exif = NULL;
    if (png_get_eXIf_1(job->png, job->info, &size, &exif) && size) {
        ORL_TRY(orl_bytes_add(job->log, &header->exif, "Exif\0", 6));
        ORL_TRY(orl_bytes_add(job->log, &header->exif, exif, size));
    }
#endif
    png_charp name;
    png_bytep icc;
    int compression;
    png_uint_32 icc_size = 0;
    if (by_code)
        return ORL_OK;
    if (png_get_iCCP(job->png, job->info, &name, &compression, &icc, &icc_size) && icc_size)
        return orl_bytes_add(job->log, &header->icc, icc, icc_size);
    header->gamma = gamma_of(job);
    read_primaries(job, &header->primaries);
    return ORL_OK;
}

enum orl_result orl_png_read_header(const struct orl_log *log, const char *path, FILE *stream,
                                    struct orl_picture_header *header)
{
    struct png_job job = {.log = log, .path = path};
    enum orl_result result = start_reading(&job);
    ORL_THEN(result, read_header(&job, stream, header));
    end_reading(&job);
    return result;
}

// --- pixels ---

// Deep samples have the file's depth, in the machine's byte order.
static enum orl_result decode(struct png_job *job, size_t file_size, enum orl_png_kind kind,
                              struct orl_image *image)
{
    int channels = kind == ORL_PNG_RGBA ? 4 : 3;
    // Deflate compresses at most 1032 to 1 (zlib's technical notes).
    const uint64_t max_ratio = 1032;
    if (setjmp(png_jmpbuf(job->png)))
        return ORL_ERR_FORMAT;
    png_set_read_fn(job->png, job, read_bytes);
    png_read_info(job->png, job->info);
    png_uint_32 width = png_get_image_width(job->png, job->info);
    png_uint_32 height = png_get_image_height(job->png, job->info);
    bool sixteen = png_get_bit_depth(job->png, job->info) == 16;
    bool deep = kind == ORL_PNG_RGB_DEEP || (kind == ORL_PNG_RGBA && sixteen);
    size_t pixel = (size_t)channels * (deep ? sizeof(float) : 1);
    ORL_TRY(orl_picture_check_memory(job->log, job->path, width, height, pixel));
    if ((uint64_t)png_get_rowbytes(job->png, job->info) * height > file_size * max_ratio)
        return orl_fail(job->log, ORL_ERR_FORMAT, "%s: %zu bytes cannot hold %ux%u pixels",
                        job->path, file_size, (unsigned)width, (unsigned)height);
    png_set_expand(job->png);
    job->wide = deep && sixteen;
    if (!deep)
        png_set_scale_16(job->png); // rounds, unlike strip_16
    else if (job->wide)
        png_set_swap(job->png);
    if (channels == 3)
        png_set_strip_alpha(job->png);
    else
        png_set_add_alpha(job->png, 0xffff, PNG_FILLER_AFTER);
    png_set_gray_to_rgb(job->png);
    png_set_interlace_handling(job->png);
    png_read_update_info(job->png, job->info);
    size_t row = (size_t)width * (size_t)channels * (job->wide ? 2 : 1);
    if (png_get_rowbytes(job->png, job->info) != row)
        png_error(job->png, "unexpected row size");
    // With `deep` the samples go to the end of the image, where they are converted to floats
    // in place.
    ORL_TRY(orl_image_init(job->log, image, (int)width, (int)height, channels,
                           deep ? ORL_PIXEL_F32 : ORL_PIXEL_U8));
    job->rows = orl_array(job->log, height, sizeof *job->rows);
    ORL_TRY_MEMORY(job->rows);
    for (size_t y = 0; y < height; y++)
        job->rows[y] = image->u8 + (orl_image_bytes(image) - row * height) + y * row;
    png_read_image(job->png, job->rows);
    png_read_end(job->png, NULL);
    return ORL_OK;
}

// Converts the samples of a deep picture to floats in place, 1 at white.
static void to_floats(const struct png_job *job, struct orl_image *image)
{
    // From the front, a float overwrites only samples that were already read.
    size_t count = orl_image_bytes(image) / sizeof(float);
    size_t sample = job->wide ? 2 : 1;
    const uint8_t *from = image->u8 + orl_image_bytes(image) - count * sample;
    for (size_t i = 0; i < count; i++) {
        uint16_t value = from[i];
        if (job->wide)
            memcpy(&value, from + 2 * i, 2);
        image->f32[i] = (float)value / (job->wide ? 65535 : 255);
    }
}

enum orl_result orl_png_decode(const struct orl_log *log, const char *path, const uint8_t *data,
                               size_t size, enum orl_png_kind kind, struct orl_image *image)
{
    struct png_job job = {.log = log, .path = path, .data = data, .size = size};
    enum orl_result result = start_reading(&job);
    ORL_THEN(result, decode(&job, size, kind, image));
    end_reading(&job);
    if (result == ORL_OK && image->type == ORL_PIXEL_F32)
        to_floats(&job, image);
    return result;
}

// --- writing ---

static enum orl_result encode(struct png_job *job, FILE *stream, const struct orl_image *image)
{
    if (setjmp(png_jmpbuf(job->png)))
        return ORL_ERR_IO;
    png_init_io(job->png, stream);
    png_set_IHDR(job->png, job->info, (png_uint_32)image->width, (png_uint_32)image->height, 8,
                 image->channels == 1 ? PNG_COLOR_TYPE_GRAY : PNG_COLOR_TYPE_RGB,
                 PNG_INTERLACE_NONE, PNG_COMPRESSION_TYPE_DEFAULT, PNG_FILTER_TYPE_DEFAULT);
    if (image->channels == 3)
        png_set_sRGB(job->png, job->info, PNG_sRGB_INTENT_PERCEPTUAL);
    // Renderings are written by the hundred. Level 4 is twice as fast as level 6, and files are a
    // few percent larger.
    png_set_compression_level(job->png, 4);
    png_write_info(job->png, job->info);
    size_t stride = (size_t)image->width * (size_t)image->channels;
    for (size_t y = 0; y < (size_t)image->height; y++)
        png_write_row(job->png, image->u8 + y * stride);
    png_write_end(job->png, job->info);
    return ORL_OK;
}

enum orl_result orl_png_write(const struct orl_log *log, const char *path,
                              const struct orl_image *image)
{
    ORL_REQUIRE(log, image->type == ORL_PIXEL_U8 && image->data);
    ORL_REQUIRE(log, image->channels == 1 || image->channels == 3);
    struct png_job job = {.log = log, .path = path};
    struct orl_atomic_file file;
    ORL_TRY(orl_atomic_open(log, path, &file));
    job.png = png_create_write_struct(PNG_LIBPNG_VER_STRING, &job, stop, take_warning);
    job.info = job.png ? png_create_info_struct(job.png) : NULL;
    enum orl_result result =
        job.info ? encode(&job, file.stream, image)
                 : orl_fail(log, ORL_ERR_MEMORY, "%s: no memory for a PNG writer", path);
    png_destroy_write_struct(&job.png, &job.info);
    ORL_THEN(result, orl_atomic_commit(log, &file));
    orl_atomic_abort(&file);
    return result;
}
