// Photographs and pictures as files: JPEG, PNG, and EXIF.
#ifndef ORL_IO_PICTURE_H
#define ORL_IO_PICTURE_H

#include "core/image.h"

// Size without decoding, from the file's header. JPEG or PNG, by content.
enum orl_result orl_picture_size(const struct orl_log *log, const char *path, int *width,
                                 int *height) ORL_CHECK_RESULT;
// 8-bit, `channels` 1 (luma) or 3 (RGB); alpha is dropped, 16-bit is rounded. EXIF
// orientation is ignored: pixels as stored. A truncated file is an error.
enum orl_result orl_picture_read(const struct orl_log *log, const char *path, int channels,
                                 struct orl_image *image) ORL_CHECK_RESULT;
// 8-bit, 1 or 3 channels. Written whole or not at all.
enum orl_result orl_png_write(const struct orl_log *log, const char *path,
                              const struct orl_image *image) ORL_CHECK_RESULT;

// What EXIF says; 0 or "" where it says nothing.
struct orl_exif {
    char make[64], model[64];
    double exposure_s, aperture, iso, bias_ev;
    double focal_mm, focal_35mm;
    int orientation; // 1 to 8
};
// ORL_OK with zeroes for a file without EXIF; errors only for unreadable files.
enum orl_result orl_exif_read(const struct orl_log *log, const char *path,
                              struct orl_exif *exif) ORL_CHECK_RESULT;
// log2 of the exposure: EV100-like, larger = brighter picture of the same scene:
// log2(exposure_s * iso / 100 / aperture^2). False when time is unknown; missing
// aperture or ISO count as constant.
bool orl_exif_exposure_ev(const struct orl_exif *exif, double *ev);

// quality [1, 100], no chroma subsampling from 90 on. exif may be NULL.
enum orl_result orl_jpeg_write(const struct orl_log *log, const char *path,
                               const struct orl_image *image, int quality,
                               const struct orl_exif *exif) ORL_CHECK_RESULT;

#endif
