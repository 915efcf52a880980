// Camera RAW files through LibRaw: linear light, white at the sensor's saturation.
#include <math.h>
#include <string.h>

#include <libraw/libraw.h>

#include "core/memory.h"
#include "io/internal.h"

static enum orl_result check(const struct orl_picture_file *file, int code)
{
    if (code == LIBRAW_SUCCESS)
        return ORL_OK;
    enum orl_result result = code == LIBRAW_UNSUFFICIENT_MEMORY || code == LIBRAW_TOO_BIG
                                 ? ORL_ERR_MEMORY
                             : code == LIBRAW_FILE_UNSUPPORTED ? ORL_ERR_UNSUPPORTED
                                                               : ORL_ERR_FORMAT;
    return orl_fail(file->log, result, "%s: RAW: %s", file->path,
                    code > 0 ? strerror(code) : libraw_strerror(code));
}

// The type of a file's offset in LibRaw's callbacks.
#if LIBRAW_COMPILE_CHECK_VERSION_NOTLESS(0, 22)
typedef INT64 raw_offset;
#else
typedef int raw_offset;
#endif

// Records damage; without a handler LibRaw prints to stderr.
static void drop_damage(void *priv, const char *file, const raw_offset offset)
{
    (void)file;
    (void)offset;
    *(bool *)priv = true;
}

static enum orl_result open_raw(const struct orl_picture_file *file, libraw_data_t *raw, bool *damaged)
{
    if (!raw)
        return orl_fail(file->log, ORL_ERR_MEMORY, "%s: no memory for a RAW reader", file->path);
    libraw_set_dataerror_handler(raw, drop_damage, damaged);
    libraw_output_params_t *p = &raw->params;
    p->output_bps = 16;
    p->gamm[0] = p->gamm[1] = 1; // linear
    p->output_color = 1;         // sRGB's primaries
    p->use_camera_wb = 1;
    p->no_auto_bright = 1;
    p->adjust_maximum_thr = 0; // otherwise white would depend on the picture
    p->user_flip = 0;          // pixels as stored
    return check(file, libraw_open_file(raw, file->path));
}

static double positive(float value)
{
    return isfinite(value) && value > 0 ? (double)value : 0;
}

static enum orl_result read_header(struct orl_picture_file *file, libraw_data_t *raw)
{
    // EXIF orientation for each of LibRaw's flip values.
    static const int orientations[8] = {[0] = 1, [3] = 3, [5] = 8, [6] = 6};
    struct orl_exif *exif = &file->info.exif;
    int flip = raw->sizes.flip; // read before LibRaw replaces it by user_flip
    ORL_TRY(check(file, libraw_adjust_sizes_info_only(raw)));
    ORL_TRY(orl_picture_set_size(file, raw->sizes.iwidth, raw->sizes.iheight));
    orl_exif_text(raw->idata.make, strlen(raw->idata.make), exif->make, sizeof exif->make);
    orl_exif_text(raw->idata.model, strlen(raw->idata.model), exif->model, sizeof exif->model);
    exif->exposure_s = positive(raw->other.shutter);
    exif->aperture = positive(raw->other.aperture);
    exif->iso = positive(raw->other.iso_speed);
    exif->focal_mm = positive(raw->other.focal_len);
    exif->focal_35mm = raw->lens.FocalLengthIn35mmFormat;
    exif->orientation = flip >= 0 && flip < 8 && orientations[flip] ? orientations[flip] : 1;
    return ORL_OK;
}

static enum orl_result take_pixels(struct orl_picture_file *file, const libraw_processed_image_t *from,
                                   struct orl_image *image)
{
    size_t count = (size_t)from->width * from->height * 3;
    bool gray = from->colors == 1;
    if (from->type != LIBRAW_IMAGE_BITMAP || from->bits != 16 || (from->colors != 3 && !gray) ||
        from->data_size / 2 < (gray ? count / 3 : count))
        return orl_fail(file->log, ORL_ERR_UNSUPPORTED, "%s: RAW: not a colour picture", file->path);
    ORL_TRY(orl_picture_set_size(file, from->width, from->height));
    ORL_TRY(orl_image_init(file->log, image, from->width, from->height, 3, ORL_PIXEL_F32));
    for (size_t i = 0; i < count; i++) {
        uint16_t value;
        memcpy(&value, from->data + 2 * (gray ? i / 3 : i), sizeof value);
        image->f32[i] = (float)value / 65535;
    }
    return ORL_OK;
}

static enum orl_result decode(struct orl_picture_file *file, libraw_data_t *raw, const bool *damaged,
                              struct orl_image *image)
{
    int code = LIBRAW_SUCCESS;
    // Bytes per pixel: a raw sample, four 16-bit samples, a bitmap of three, and three floats.
    ORL_TRY(orl_picture_set_size(file, raw->sizes.raw_width, raw->sizes.raw_height));
    ORL_TRY(orl_picture_check_memory(file, 2 + 8 + 6 + 3 * sizeof(float)));
    ORL_TRY(check(file, libraw_unpack(raw)));
    if (*damaged)
        return orl_fail(file->log, ORL_ERR_FORMAT, "%s: RAW: the file is damaged or cut off", file->path);
    ORL_TRY(check(file, libraw_dcraw_process(raw)));
    libraw_processed_image_t *bitmap = libraw_dcraw_make_mem_image(raw, &code);
    enum orl_result result = check(file, code);
    ORL_THEN(result, bitmap ? take_pixels(file, bitmap, image) : ORL_ERR_MEMORY);
    if (bitmap)
        libraw_dcraw_clear_mem(bitmap);
    return result;
}

enum orl_result orl_raw_read(struct orl_picture_file *file, struct orl_image *image)
{
    bool damaged = false;
    libraw_data_t *raw = libraw_init(0);
    enum orl_result result = open_raw(file, raw, &damaged);
    file->info.bits = 16;
    file->light = true;
    ORL_THEN(result, image ? decode(file, raw, &damaged, image) : read_header(file, raw));
    if (raw)
        libraw_close(raw);
    return result;
}
