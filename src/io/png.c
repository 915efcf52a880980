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
    png_bytepp rows; // owned
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

// libpng allocates, and zeroes, what a chunk's header claims before it reads the chunk: up to 2 GiB
// for a file of some bytes.
static png_voidp allocate(png_structp png, png_alloc_size_t size)
{
    if (size > MEMORY_MAX)
        png_error(png, "a chunk claims to be larger than 64 MiB");
    return malloc(size);
}

// --- header ---

// The space of the colours by their code points (PNG's third edition, ITU-T H.273), which come before
// profile, gamma and primaries. False: the file has none.
static bool read_code_points(const struct png_job *job, double *gamma, struct orl_primaries *space,
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
    *gamma = curve == LINEAR ? 1 : 0;
    *space = primaries == P3 ? p3 : primaries == REC2020 ? rec2020 : orl_primaries_rec709;
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

static enum orl_result take_header(const struct png_job *job, struct orl_picture_file *file)
{
    struct orl_primaries primaries = {0};
    double gamma = 0;
    png_charp name;
    png_bytep icc = NULL, exif = NULL;
    int compression;
    png_uint_32 icc_size = 0, exif_size = 0;
    enum orl_result result = ORL_OK;
    ORL_TRY(orl_picture_set_size(file, png_get_image_width(job->png, job->info),
                                 png_get_image_height(job->png, job->info)));
    file->info.bits = png_get_bit_depth(job->png, job->info);
    png_textp texts;
    int text_count = png_get_text(job->png, job->info, &texts, NULL);
    for (int i = 0; i < text_count; i++)
        file->info.panorama |= strcmp(texts[i].key, "XML:com.adobe.xmp") == 0 &&
                               orl_xmp_tells_panorama(texts[i].text, strlen(texts[i].text));
    if (png_get_eXIf_1(job->png, job->info, &exif_size, &exif) && exif_size)
        ORL_TRY(orl_exif_decode(job->log, job->path, exif, exif_size, &file->info.exif));
    if (!read_code_points(job, &gamma, &primaries, &result)) {
        (void)png_get_iCCP(job->png, job->info, &name, &compression, &icc, &icc_size);
        gamma = gamma_of(job);
        read_primaries(job, &primaries);
    }
    orl_picture_set_profile(file, icc, icc_size, gamma, &primaries);
    return result;
}

// --- pixels ---

// Samples of 16 bits become floats, 1 at white.
static enum orl_result take_pixels(struct png_job *job, const struct orl_picture_file *file, struct orl_image *image)
{
    // Deflate compresses at most 1032 to 1 (zlib's technical notes).
    const uint64_t max_ratio = 1032;
    bool wide = file->info.bits == 16;
    size_t height = (size_t)file->info.height, channels = file->channels == 4 ? 4 : 3;
    ORL_TRY(orl_picture_check_memory(file, channels * (wide ? sizeof(float) : 1)));
    ORL_TRY(orl_picture_check_bytes(file, (uint64_t)png_get_rowbytes(job->png, job->info) * height / max_ratio));
    png_set_expand(job->png);
    if (wide)
        png_set_swap(job->png);
    if (channels == 3)
        png_set_strip_alpha(job->png);
    else
        png_set_add_alpha(job->png, 0xffff, PNG_FILLER_AFTER);
    png_set_gray_to_rgb(job->png);
    png_set_interlace_handling(job->png);
    png_read_update_info(job->png, job->info);
    size_t row = (size_t)file->info.width * channels * (wide ? 2 : 1);
    if (png_get_rowbytes(job->png, job->info) != row)
        png_error(job->png, "unexpected row size");
    ORL_TRY(orl_image_init(job->log, image, file->info.width, file->info.height, (int)channels,
                           wide ? ORL_PIXEL_F32 : ORL_PIXEL_U8));
    job->rows = orl_array(job->log, height, sizeof *job->rows);
    ORL_TRY_MEMORY(job->rows);
    // Wide samples go to the end of the image. From the front, a float overwrites only samples that were already read.
    uint8_t *samples = image->u8 + (orl_image_bytes(image) - row * height);
    for (size_t y = 0; y < height; y++)
        job->rows[y] = samples + y * row;
    png_read_image(job->png, job->rows);
    png_read_end(job->png, NULL);
    for (size_t i = 0; wide && i < row / 2 * height; i++) {
        uint16_t value;
        memcpy(&value, samples + 2 * i, sizeof value);
        image->f32[i] = (float)value / 65535;
    }
    return ORL_OK;
}

static enum orl_result read_all(struct png_job *job, struct orl_picture_file *file, struct orl_image *image)
{
    if (setjmp(png_jmpbuf(job->png)))
        return ORL_ERR_FORMAT;
    png_set_user_limits(job->png, ORL_IMAGE_MAX_SIDE, ORL_IMAGE_MAX_SIDE);
    png_init_io(job->png, file->stream);
    png_set_keep_unknown_chunks(job->png, PNG_HANDLE_CHUNK_ALWAYS, (png_const_bytep) "cICP", 1);
    png_read_info(job->png, job->info);
    ORL_TRY(take_header(job, file));
    return image ? take_pixels(job, file, image) : ORL_OK;
}

enum orl_result orl_png_read(struct orl_picture_file *file, struct orl_image *image)
{
    struct png_job job = {.log = file->log, .path = file->path};
    job.png = png_create_read_struct_2(PNG_LIBPNG_VER_STRING, &job, stop, take_warning, NULL, allocate, NULL);
    job.info = job.png ? png_create_info_struct(job.png) : NULL;
    enum orl_result result = job.info ? read_all(&job, file, image)
                                      : orl_fail(file->log, ORL_ERR_MEMORY, "%s: no memory for a PNG reader", file->path);
    png_destroy_read_struct(&job.png, &job.info, NULL);
    free(job.rows);
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
