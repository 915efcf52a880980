// HEIC and AVIF through libheif. The turning and cropping that the file asks for belong to the
// picture and are applied: other readers of these files see no other pixels.
#include <stdlib.h>
#include <string.h>

#include <libheif/heif.h>

#include "core/memory.h"
#include "io/internal.h"

struct heif_job {
    struct orl_picture_file *file;
    struct heif_context *context;
    struct heif_image_handle *picture; // the primary one
};

static enum orl_result check(const struct heif_job *job, struct heif_error error)
{
    if (error.code == heif_error_Ok)
        return ORL_OK;
    enum orl_result result =
        error.code == heif_error_Memory_allocation_error ? ORL_ERR_MEMORY
        : error.code == heif_error_Unsupported_feature ||
                error.code == heif_error_Unsupported_filetype
            ? ORL_ERR_UNSUPPORTED
            : ORL_ERR_FORMAT;
    return orl_fail(job->file->log, result, "%s: HEIF: %s", job->file->path, error.message);
}

static enum orl_result open_heif(struct heif_job *job)
{
    job->context = heif_context_alloc();
    if (!job->context)
        return orl_fail(job->file->log, ORL_ERR_MEMORY, "%s: no memory for a HEIF reader", job->file->path);
    ORL_TRY(check(job, heif_context_read_from_file(job->context, job->file->path, NULL)));
    ORL_TRY(check(job, heif_context_get_primary_image_handle(job->context, &job->picture)));
    job->file->info.bits = heif_image_handle_get_luma_bits_per_pixel(job->picture);
    return orl_picture_set_size(job->file, (uint64_t)heif_image_handle_get_width(job->picture),
                                (uint64_t)heif_image_handle_get_height(job->picture));
}

// --- EXIF ---

// Four bytes ahead of the block say how far on the TIFF data begins.
static enum orl_result read_exif(const struct heif_job *job)
{
    struct orl_picture_file *file = job->file;
    heif_item_id id;
    if (heif_image_handle_get_list_of_metadata_block_IDs(job->picture, "Exif", &id, 1) < 1)
        return ORL_OK;
    size_t size = heif_image_handle_get_metadata_size(job->picture, id);
    uint8_t *block = orl_array(file->log, size, 1);
    ORL_TRY_MEMORY(block);
    enum orl_result result = check(job, heif_image_handle_get_metadata(job->picture, id, block));
    size_t start = size < 4 ? size
                            : 4 + ((size_t)block[0] << 24 | (size_t)block[1] << 16 |
                                   (size_t)block[2] << 8 | (size_t)block[3]);
    if (result == ORL_OK && start < size) {
        result = orl_exif_decode(file->log, file->path, block + start, size - start, &file->info.exif);
        file->info.exif.orientation = 1; // the pixels are turned already
    }
    free(block);
    return result;
}

// Apple's, or that of ISO 21496-1.
static bool has_gain_map(const struct heif_job *job)
{
    enum { MOST = 16 };
    heif_item_id ids[MOST];
    bool found = false;
    int count = heif_image_handle_get_list_of_auxiliary_image_IDs(job->picture, 0, ids, MOST);
    for (int i = 0; i < count && !found; i++) {
        struct heif_image_handle *other = NULL;
        const char *type = NULL;
        if (heif_image_handle_get_auxiliary_image_handle(job->picture, ids[i], &other).code ==
                heif_error_Ok &&
            heif_image_handle_get_auxiliary_type(other, &type).code == heif_error_Ok)
            found = strstr(type, "gainmap") || strstr(type, "21496");
        heif_image_handle_free_auxiliary_types(other, &type);
        heif_image_handle_release(other);
    }
    return found;
}

// --- pixels ---

// ORL_ERR_UNSUPPORTED for the transfer curves of HDR video, whose white is not a picture's.
static enum orl_result check_curve(const struct heif_job *job)
{
    struct heif_color_profile_nclx *profile = NULL;
    struct heif_error error = heif_image_handle_get_nclx_color_profile(job->picture, &profile);
    bool hdr = error.code == heif_error_Ok &&
               (profile->transfer_characteristics ==
                    heif_transfer_characteristic_ITU_R_BT_2100_0_PQ ||
                profile->transfer_characteristics ==
                    heif_transfer_characteristic_ITU_R_BT_2100_0_HLG);
    heif_nclx_color_profile_free(profile); // made even for a curve that libheif does not know
    return hdr ? orl_fail(job->file->log, ORL_ERR_UNSUPPORTED,
                          "%s: HEIF: its samples are HDR (PQ or HLG); save it as SDR or as EXR",
                          job->file->path)
               : ORL_OK;
}

static void read_profile(const struct heif_job *job)
{
    struct orl_picture_file *file = job->file;
    size_t size = heif_image_handle_get_raw_color_profile_size(job->picture);
    void *icc = size ? orl_array(file->log, size, 1) : NULL;
    if (icc && heif_image_handle_get_raw_color_profile(job->picture, icc).code == heif_error_Ok)
        file->profile = orl_profile_create(file->profile_log, file->path, icc, size);
    free(icc);
}

static enum orl_result take_pixels(const struct heif_job *job, const struct heif_image *from,
                                   struct orl_image *image)
{
    const struct orl_picture_file *file = job->file;
    int stride, wide = file->info.bits > 8;
    const uint8_t *rows = heif_image_get_plane_readonly(from, heif_channel_interleaved, &stride);
    int bits = heif_image_get_bits_per_pixel_range(from, heif_channel_interleaved);
    float white = (float)((1u << bits) - 1);
    size_t row = 3 * (size_t)image->width;
    if (!rows || stride < 0 || (size_t)stride < row * (wide ? 2 : 1) || bits < 1 || bits > 16 ||
        heif_image_get_primary_width(from) != image->width ||
        heif_image_get_primary_height(from) != image->height)
        return orl_fail(file->log, ORL_ERR_FORMAT, "%s: HEIF: not the picture that its header "
                        "promises", file->path);
    for (size_t y = 0; y < (size_t)image->height; y++, rows += stride) {
        if (!wide)
            memcpy(image->u8 + y * row, rows, row);
        for (size_t i = 0; wide && i < row; i++)
            image->f32[y * row + i] = (float)(rows[2 * i] | rows[2 * i + 1] << 8) / white;
    }
    return ORL_OK;
}

static enum orl_result decode(const struct heif_job *job, struct orl_image *image)
{
    const struct orl_picture_file *file = job->file;
    bool wide = file->info.bits > 8;
    struct heif_image *decoded = NULL;
    // Bytes per pixel: planes and RGB of up to 16 bits each, and three samples.
    ORL_TRY(orl_picture_check_memory(file, 6 + 6 + 3 * sizeof(float)));
    ORL_TRY(check_curve(job));
    read_profile(job);
    enum orl_result result = check(job, heif_decode_image(job->picture, &decoded, heif_colorspace_RGB,
                                                          wide ? heif_chroma_interleaved_RRGGBB_LE
                                                               : heif_chroma_interleaved_RGB, NULL));
    ORL_THEN(result, orl_image_init(file->log, image, file->info.width, file->info.height, 3,
                                    wide ? ORL_PIXEL_F32 : ORL_PIXEL_U8));
    ORL_THEN(result, take_pixels(job, decoded, image));
    heif_image_release(decoded);
    return result;
}

enum orl_result orl_heif_read(struct orl_picture_file *file, struct orl_image *image)
{
    struct heif_job job = {.file = file};
    enum orl_result result = open_heif(&job);
    ORL_THEN(result, image ? decode(&job, image) : read_exif(&job));
    if (result == ORL_OK && !image)
        file->info.gain_map = has_gain_map(&job);
    heif_image_handle_release(job.picture);
    if (job.context)
        heif_context_free(job.context);
    return result;
}
