// JPEG through libjpeg-turbo. libjpeg reports errors by longjmp. State that must
// survive a longjmp is in struct jpeg_job, owned by the caller of the function that
// calls setjmp.
#include <setjmp.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include <jpeglib.h>
#include <jerror.h>

#include "core/file.h"
#include "io/internal.h"

enum {
    // Enough for the coefficients of a progressive picture of the largest size.
    MAX_MEMORY_GIB = 8,
    // More scans than any encoder writes. Each scan costs time for every pixel.
    MAX_SCANS = 200,
    // A JPEG block of 8x8 samples takes at least one bit of each component's data.
    MAX_PIXELS_PER_BYTE = 1024,
};

struct jpeg_job {
    const struct orl_log *log;
    const char *path;
    struct jpeg_error_mgr error;
    struct jpeg_progress_mgr progress;
    jmp_buf on_error;
    char message[JMSG_LENGTH_MAX];
};

static void stop(j_common_ptr info)
{
    struct jpeg_job *job = info->client_data;
    info->err->format_message(info, job->message);
    longjmp(job->on_error, 1);
}

// libjpeg continues after damage and paints the rest grey; here damage is an error. Padding before
// the end marker and irregular optional markers lose no pixels and are accepted.
static void take_message(j_common_ptr info, int level)
{
    if (level >= 0)
        return;
    bool harmless = info->err->msg_code == JWRN_ADOBE_XFORM ||
                    info->err->msg_code == JWRN_JFIF_MAJOR ||
                    (info->err->msg_code == JWRN_EXTRANEOUS_DATA &&
                     info->err->msg_parm.i[1] == JPEG_EOI);
    if (!harmless)
        stop(info);
}

static void drop_message(j_common_ptr info)
{
    (void)info;
}

static void limit_scans(j_common_ptr info)
{
    struct jpeg_job *job = info->client_data;
    if (info->is_decompressor && ((j_decompress_ptr)info)->input_scan_number > MAX_SCANS) {
        snprintf(job->message, sizeof job->message, "more than %d scans", MAX_SCANS);
        longjmp(job->on_error, 1);
    }
}

static void start_job(struct jpeg_job *job, struct jpeg_common_struct *info,
                      const struct orl_log *log, const char *path)
{
    job->log = log;
    job->path = path;
    info->err = jpeg_std_error(&job->error);
    job->error.error_exit = stop;
    job->error.emit_message = take_message;
    job->error.output_message = drop_message;
    job->progress.progress_monitor = limit_scans;
    info->client_data = job;
}

static enum orl_result fail(const struct jpeg_job *job)
{
    bool memory = job->error.msg_code == JERR_OUT_OF_MEMORY;
    return orl_fail(job->log, memory ? ORL_ERR_MEMORY : ORL_ERR_FORMAT, "%s: JPEG: %s",
                    job->path, job->message);
}

// --- header ---

static bool is_exif(const struct jpeg_marker_struct *marker)
{
    return marker->marker == JPEG_APP0 + 1 && marker->data_length > 6 &&
           memcmp(marker->data, "Exif\0", 6) == 0;
}

static bool is_xmp(const struct jpeg_marker_struct *marker)
{
    static const char head[] = "http://ns.adobe.com/xap/1.0/";
    return marker->marker == JPEG_APP0 + 1 && marker->data_length > sizeof head &&
           memcmp(marker->data, head, sizeof head) == 0;
}

static bool has_word(const struct jpeg_marker_struct *marker, const char *word)
{
    return memmem(marker->data, marker->data_length, word, strlen(word)) != NULL;
}

// Adobe's schema (Ultra HDR), or the segment of ISO 21496-1.
static bool is_gain_map(const struct jpeg_marker_struct *marker)
{
    static const char iso[] = "urn:iso:std:iso:ts:21496:-1";
    return (is_xmp(marker) && has_word(marker, "http://ns.adobe.com/hdr-gain-map/1.0/") &&
            has_word(marker, "hdrgm:Version")) ||
           (marker->marker == JPEG_APP0 + 2 && marker->data_length >= sizeof iso &&
            memcmp(marker->data, iso, sizeof iso) == 0);
}

static enum orl_result take_header(j_decompress_ptr info, struct orl_picture_file *file)
{
    JOCTET *icc = NULL;
    unsigned icc_size = 0;
    const struct jpeg_marker_struct *exif = NULL;
    ORL_TRY(orl_picture_set_size(file, info->image_width, info->image_height));
    file->info.bits = info->data_precision;
    for (jpeg_saved_marker_ptr marker = info->marker_list; marker; marker = marker->next) {
        file->info.panorama |= is_xmp(marker) && orl_xmp_tells_panorama(marker->data, marker->data_length);
        file->info.gain_map |= is_gain_map(marker);
        if (is_exif(marker) && !exif)
            exif = marker;
    }
    if (exif)
        ORL_TRY(orl_exif_decode(file->log, file->path, exif->data + 6, exif->data_length - 6, &file->info.exif));
    jpeg_read_icc_profile(info, &icc, &icc_size);
    orl_picture_set_profile(file, icc, icc_size, 0, &(struct orl_primaries){0});
    free(icc);
    return ORL_OK;
}

// --- pixels ---

static enum orl_result check_header(const struct orl_picture_file *file, j_decompress_ptr info)
{
    // libjpeg keeps a progressive picture as two-byte coefficients until its last scan.
    uint64_t pixel = 3 + (jpeg_has_multiple_scans(info) ? 2 * (uint64_t)info->num_components : 0);
    ORL_TRY(orl_picture_check_memory(file, pixel));
    if (info->jpeg_color_space == JCS_CMYK || info->jpeg_color_space == JCS_YCCK)
        return orl_fail(file->log, ORL_ERR_FORMAT,
                        "%s: CMYK print colours cannot be used; save it as RGB", file->path);
    return orl_picture_check_bytes(file, (uint64_t)info->image_width * info->image_height / MAX_PIXELS_PER_BYTE);
}

static enum orl_result read_all(struct jpeg_job *job, j_decompress_ptr info, struct orl_picture_file *file,
                                struct orl_image *image)
{
    if (setjmp(job->on_error))
        return fail(job);
    jpeg_create_decompress(info);
    info->mem->max_memory_to_use = (long)MAX_MEMORY_GIB << 30;
    info->progress = &job->progress;
    jpeg_save_markers(info, JPEG_APP0 + 1, 0xffff);
    jpeg_save_markers(info, JPEG_APP0 + 2, 0xffff);
    jpeg_stdio_src(info, file->stream);
    jpeg_read_header(info, TRUE);
    ORL_TRY(take_header(info, file));
    if (!image)
        return ORL_OK;
    ORL_TRY(check_header(file, info));
    int channels = file->channels == 1 && !file->profile ? 1 : 3;
    info->out_color_space = channels == 1 ? JCS_GRAYSCALE : JCS_RGB;
    ORL_TRY(orl_image_init(job->log, image, file->info.width, file->info.height, channels, ORL_PIXEL_U8));
    jpeg_start_decompress(info);
    while (info->output_scanline < info->output_height) {
        JSAMPROW row = image->u8 +
                       (size_t)info->output_scanline * (size_t)image->width * (size_t)channels;
        jpeg_read_scanlines(info, &row, 1);
    }
    jpeg_finish_decompress(info); // reads up to the end marker and reports when it is missing
    return ORL_OK;
}

enum orl_result orl_jpeg_read(struct orl_picture_file *file, struct orl_image *image)
{
    struct jpeg_job job = {0};
    struct jpeg_decompress_struct info = {0};
    start_job(&job, (j_common_ptr)&info, file->log, file->path);
    enum orl_result result = read_all(&job, &info, file, image);
    jpeg_destroy_decompress(&info);
    return result;
}

// --- writing ---

struct jpeg_output {
    const struct orl_image *image;
    int quality;
    uint8_t *exif;
    size_t exif_size;
    FILE *stream;
    bool smaller; // costs a second pass over the picture
};

static enum orl_result encode(struct jpeg_job *job, j_compress_ptr info, struct jpeg_output *out)
{
    const struct orl_image *image = out->image;
    ORL_REQUIRE(job->log, image->type == ORL_PIXEL_U8 && image->data);
    ORL_REQUIRE(job->log, image->channels == 1 || image->channels == 3);
    ORL_REQUIRE(job->log, out->quality >= 1 && out->quality <= 100);
    if (setjmp(job->on_error))
        return orl_fail(job->log, ORL_ERR_IO, "%s: %s", job->path, job->message);
    jpeg_create_compress(info);
    jpeg_stdio_dest(info, out->stream);
    info->image_width = (JDIMENSION)image->width;
    info->image_height = (JDIMENSION)image->height;
    info->input_components = image->channels;
    info->in_color_space = image->channels == 1 ? JCS_GRAYSCALE : JCS_RGB;
    jpeg_set_defaults(info);
    jpeg_set_quality(info, out->quality, TRUE);
    info->optimize_coding = out->smaller;
    if (out->quality >= 90 && image->channels == 3) {
        info->comp_info[0].h_samp_factor = 1;
        info->comp_info[0].v_samp_factor = 1;
    }
    jpeg_start_compress(info, TRUE);
    if (out->exif)
        jpeg_write_marker(info, JPEG_APP0 + 1, out->exif, (unsigned)out->exif_size);
    while (info->next_scanline < info->image_height) {
        JSAMPROW row = image->u8 + (size_t)info->next_scanline * (size_t)image->width *
                                       (size_t)image->channels;
        jpeg_write_scanlines(info, &row, 1);
    }
    jpeg_finish_compress(info);
    return ORL_OK;
}

enum orl_result orl_jpeg_write(const struct orl_log *log, const char *path,
                               const struct orl_image *image, int quality,
                               const struct orl_exif *exif)
{
    struct jpeg_job job = {0};
    struct jpeg_compress_struct info = {0};
    struct orl_atomic_file file = {0};
    struct jpeg_output out = {.image = image, .quality = quality, .smaller = true};
    start_job(&job, (j_common_ptr)&info, log, path);
    if (image->width > JPEG_MAX_DIMENSION || image->height > JPEG_MAX_DIMENSION)
        return orl_fail(log, ORL_ERR_UNSUPPORTED, "%s: a JPEG has at most %ld pixels a side",
                        path, JPEG_MAX_DIMENSION);
    enum orl_result result = exif ? orl_exif_encode(log, exif, &out.exif, &out.exif_size) : ORL_OK;
    ORL_THEN(result, orl_atomic_open(log, path, &file));
    if (result == ORL_OK) {
        out.stream = file.stream;
        result = encode(&job, &info, &out);
        jpeg_destroy_compress(&info);
    }
    ORL_THEN(result, orl_atomic_commit(log, &file));
    orl_atomic_abort(&file);
    free(out.exif);
    return result;
}

enum orl_result orl_jpeg_encode(const struct orl_log *log, const struct orl_image *image,
                                int quality, uint8_t **data, size_t *size)
{
    struct jpeg_job job = {0};
    struct jpeg_compress_struct info = {0};
    char *bytes = NULL;
    *data = NULL;
    // Not libjpeg's own memory: when that cannot grow, nobody knows any more which of it is still to be freed.
    FILE *stream = open_memstream(&bytes, size);
    if (!stream)
        return orl_fail(log, ORL_ERR_MEMORY, "no memory for a JPEG picture");
    struct jpeg_output out = {.image = image, .quality = quality, .stream = stream};
    start_job(&job, (j_common_ptr)&info, log, "picture");
    enum orl_result result = encode(&job, &info, &out);
    jpeg_destroy_compress(&info);
    if (fclose(stream) != 0 && result == ORL_OK)
        result = orl_fail(log, ORL_ERR_MEMORY, "no memory for a JPEG picture");
    if (result == ORL_OK)
        *data = (uint8_t *)bytes;
    else
        free(bytes);
    return result;
}
