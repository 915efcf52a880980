// Camera RAW files through LibRaw: linear light, white at the sensor's saturation.
#include <math.h>
#include <string.h>

#include <libraw/libraw.h>

#include "core/memory.h"
#include "io/internal.h"

static enum orl_result check(const struct orl_log *log, const char *path, int code)
{
    if (code == LIBRAW_SUCCESS)
        return ORL_OK;
    enum orl_result result = code == LIBRAW_UNSUFFICIENT_MEMORY || code == LIBRAW_TOO_BIG
                                 ? ORL_ERR_MEMORY
                             : code == LIBRAW_FILE_UNSUPPORTED ? ORL_ERR_UNSUPPORTED
                                                               : ORL_ERR_FORMAT;
    return orl_fail(log, result, "%s: RAW: %s", path,
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

static enum orl_result open_raw(const struct orl_log *log, const char *path, bool *damaged,
                                libraw_data_t **out)
{
    libraw_data_t *raw = libraw_init(0);
    *out = raw;
    if (!raw)
        return orl_fail(log, ORL_ERR_MEMORY, "%s: no memory for a RAW reader", path);
    libraw_set_dataerror_handler(raw, drop_damage, damaged);
    libraw_output_params_t *p = &raw->params;
    p->output_bps = 16;
    p->gamm[0] = p->gamm[1] = 1; // linear
    p->output_color = 1;         // sRGB's primaries
    p->use_camera_wb = 1;
    p->no_auto_bright = 1;
    p->adjust_maximum_thr = 0; // otherwise white would depend on the picture
    p->user_flip = 0;          // pixels as stored
    return check(log, path, libraw_open_file(raw, path));
}

static double positive(float value)
{
    return isfinite(value) && value > 0 ? (double)value : 0;
}

enum orl_result orl_raw_inspect(const struct orl_log *log, const char *path,
                                struct orl_picture_info *info, struct orl_exif *exif)
{
    // EXIF orientation for each of LibRaw's flip values.
    static const int orientations[8] = {[0] = 1, [3] = 3, [5] = 8, [6] = 6};
    libraw_data_t *raw = NULL;
    bool damaged = false;
    enum orl_result result = open_raw(log, path, &damaged, &raw);
    int flip = raw ? raw->sizes.flip : 0; // read before LibRaw replaces it by user_flip
    ORL_THEN(result, check(log, path, libraw_adjust_sizes_info_only(raw)));
    ORL_THEN(result, orl_picture_check_size(log, path, raw->sizes.iwidth, raw->sizes.iheight));
    if (result == ORL_OK) {
        *info = (struct orl_picture_info){.width = raw->sizes.iwidth,
                                          .height = raw->sizes.iheight, .bits = 16};
        orl_exif_text(raw->idata.make, strlen(raw->idata.make), exif->make, sizeof exif->make);
        orl_exif_text(raw->idata.model, strlen(raw->idata.model), exif->model, sizeof exif->model);
        exif->exposure_s = positive(raw->other.shutter);
        exif->aperture = positive(raw->other.aperture);
        exif->iso = positive(raw->other.iso_speed);
        exif->focal_mm = positive(raw->other.focal_len);
        exif->focal_35mm = raw->lens.FocalLengthIn35mmFormat;
        exif->orientation = flip >= 0 && flip < 8 && orientations[flip] ? orientations[flip] : 1;
    }
    if (raw)
        libraw_close(raw);
    return result;
}

static enum orl_result take_pixels(const struct orl_log *log, const char *path,
                                   const libraw_processed_image_t *from, struct orl_image *image)
{
    size_t count = (size_t)from->width * from->height * 3;
    bool gray = from->colors == 1;
    if (from->type != LIBRAW_IMAGE_BITMAP || from->bits != 16 || (from->colors != 3 && !gray) ||
        from->data_size / 2 < (gray ? count / 3 : count))
        return orl_fail(log, ORL_ERR_UNSUPPORTED, "%s: RAW: not a colour picture", path);
    enum orl_result result = orl_picture_check_size(log, path, from->width, from->height);
    ORL_THEN(result, orl_image_init(log, image, from->width, from->height, 3, ORL_PIXEL_F32));
    for (size_t i = 0; result == ORL_OK && i < count; i++) {
        uint16_t value;
        memcpy(&value, from->data + 2 * (gray ? i / 3 : i), sizeof value);
        image->f32[i] = (float)value / 65535;
    }
    return result;
}

enum orl_result orl_raw_decode_linear(const struct orl_log *log, const char *path,
                                      struct orl_image *image)
{
    libraw_data_t *raw = NULL;
    libraw_processed_image_t *bitmap = NULL;
    bool damaged = false;
    int code = LIBRAW_SUCCESS;
    enum orl_result result = open_raw(log, path, &damaged, &raw);
    // Bytes per pixel: a raw sample, four 16-bit samples, a bitmap of three, and three floats.
    ORL_THEN(result, orl_picture_check_memory(log, path, raw->sizes.raw_width, raw->sizes.raw_height,
                                              2 + 8 + 6 + 3 * sizeof(float)));
    ORL_THEN(result, check(log, path, libraw_unpack(raw)));
    if (result == ORL_OK && damaged)
        result = orl_fail(log, ORL_ERR_FORMAT, "%s: RAW: the file is damaged or cut off", path);
    ORL_THEN(result, check(log, path, libraw_dcraw_process(raw)));
    if (result == ORL_OK) {
        bitmap = libraw_dcraw_make_mem_image(raw, &code);
        result = check(log, path, code);
    }
    ORL_THEN(result, bitmap ? take_pixels(log, path, bitmap, image) : ORL_ERR_MEMORY);
    if (bitmap)
        libraw_dcraw_clear_mem(bitmap);
    if (raw)
        libraw_close(raw);
    return result;
}
