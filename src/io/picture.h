// Photographs and pictures as files. JPEG, PNG, binary PNM of 8 bits, TIFF and EXR are known by
// content, camera RAW files by their extension, as many begin like TIFF.
#ifndef ORL_IO_PICTURE_H
#define ORL_IO_PICTURE_H

#include "oriel/image.h"

// What the file's header says.
struct orl_picture_info {
    int width, height;
    int bits;       // of a sample, before any compression; more than 8: deep
    bool unbounded; // floats: light above white is kept
};
enum orl_result orl_picture_inspect(const struct orl_log *log, const char *path,
                                    struct orl_picture_info *info) ORL_CHECK_RESULT;
// Its size alone.
enum orl_result orl_picture_size(const struct orl_log *log, const char *path, int *width,
                                 int *height) ORL_CHECK_RESULT;
// 8-bit, `channels` 1 (luma) or 3 (RGB); alpha is dropped, 16-bit is rounded, linear
// light is clipped and sRGB-encoded. EXIF orientation is ignored: pixels as stored. A
// truncated file is an error.
enum orl_result orl_picture_read(const struct orl_log *log, const char *path, int channels,
                                 struct orl_image *image) ORL_CHECK_RESULT;
// Linear light, F32 x3, Rec. 709 primaries. 8 and 16-bit samples are taken as sRGB (TIFF's
// as its colour profile says, PNG's with a gamma of 1 as linear), white being 1; float TIFF
// and EXR (R, G, B, or Y) as they are; RAW with the camera's white balance, 1 where the
// sensor saturates.
enum orl_result orl_picture_read_linear(const struct orl_log *log, const char *path,
                                        struct orl_image *image) ORL_CHECK_RESULT;
// Camera RAW by its extension?
bool orl_picture_is_raw(const char *path);

// 8-bit, 1 or 3 channels. Written whole or not at all.
enum orl_result orl_png_write(const struct orl_log *log, const char *path,
                              const struct orl_image *image) ORL_CHECK_RESULT;

// What EXIF says; 0 or "" where it says nothing.
struct orl_exif {
    char make[64], model[64];
    double exposure_s, aperture, iso, bias_ev;
    double focal_mm, focal_35mm;
    int orientation; // 1 to 8
    double taken_s;  // when, by the camera's own clock, in seconds; 0: unknown
    bool placed;     // is its position known?
    double latitude, longitude; // degrees, north and east positive
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
// The same into memory, faster and a little larger; *data is released with free().
enum orl_result orl_jpeg_encode(const struct orl_log *log, const struct orl_image *image,
                                int quality, uint8_t **data, size_t *size) ORL_CHECK_RESULT;

#endif
