// Photographs and pictures as files. JPEG, PNG, binary PNM of 8 bits, TIFF, EXR and HEIF (HEIC,
// AVIF) are recognised by content, camera RAW files by their extension, since many of them begin
// like TIFF.
#ifndef ORL_IO_PICTURE_H
#define ORL_IO_PICTURE_H

#include "oriel/image.h"

// Values from EXIF; 0 or "" where EXIF has none.
struct orl_exif {
    char make[64], model[64];
    double exposure_s, aperture, iso, bias_ev;
    double focal_mm, focal_35mm;
    int orientation; // 1 to 8
    bool panorama;   // stitched by an iPhone
    bool adobe_rgb;  // the colours are those of Adobe RGB (DCF 2.0)
    double taken_s;  // when, by the camera's own clock, in seconds; 0: unknown
    bool placed;     // is its position known?
    double latitude, longitude; // degrees, north and east positive
};

// Facts from the file's header.
struct orl_picture_info {
    int width, height;
    int bits;       // per sample, uncompressed; more than 8: a deep picture
    bool unbounded; // float samples, which may exceed white
    bool panorama;  // EXIF says so, or XMP in JPEG and PNG (GPano)
    bool gain_map;  // JPEG and HEIF: HDR by a gain map, which is not used
    bool profiled;  // JPEG and PNG: the colours are not those of sRGB
    struct orl_exif exif;
};
#define ORL_PANORAMA_ADVICE                                                                        \
    "a panorama; Oriel needs pictures of ordinary lenses: cut flat views out of it"
// After the number of such photographs and of all.
#define ORL_GAIN_MAP_NEWS                                                                          \
    "%zu of %zu photographs are HDR by a gain map, which is not used: their ordinary (SDR) colours are"
enum orl_result orl_picture_inspect(const struct orl_log *log, const char *path,
                                    struct orl_picture_info *info) ORL_CHECK_RESULT;
// Reads the size alone.
enum orl_result orl_picture_size(const struct orl_log *log, const char *path, int *width,
                                 int *height) ORL_CHECK_RESULT;
// Reads 8-bit samples; `channels` is 1 (luma), 3 (RGB) or 4 (RGBA, for masks). 16-bit samples are rounded, linear light
// is clipped and sRGB-encoded; so are colours of another profile. EXIF orientation is ignored: pixels stay in the stored
// order; only HEIF files are turned as they ask, and have orientation 1. A truncated file is an error.
// Of 1 and 3 channels alpha is dropped. As one of 4 it is 255 where the file has none, or its format is not PNG; colour
// profiles do not matter then, and samples of more bits are rounded up, so that nothing but 0 becomes 0.
enum orl_result orl_picture_read(const struct orl_log *log, const char *path, int channels,
                                 struct orl_image *image) ORL_CHECK_RESULT;
// Reads linear light, F32 x3, Rec. 709 primaries. 8- and 16-bit samples are taken as sRGB with
// white at 1, except that the file's colour profile is applied (of JPEG also Adobe RGB by EXIF, of PNG
// also its gamma). Float TIFF and EXR samples (R, G, B, or Y) are taken unchanged. RAW files get the
// camera's white balance and are 1 where the sensor saturates.
enum orl_result orl_picture_read_linear(const struct orl_log *log, const char *path,
                                        struct orl_image *image) ORL_CHECK_RESULT;
// True when COLMAP needs an 8-bit copy of the file, by its extension; so it does of camera RAW.
bool orl_picture_needs_copy(const char *path);
// True when the extension is that of PNG.
bool orl_picture_is_png(const char *path);

// Writes 8-bit pictures of 1 or 3 channels, atomically.
enum orl_result orl_png_write(const struct orl_log *log, const char *path,
                              const struct orl_image *image) ORL_CHECK_RESULT;

// log2 of the exposure: log2(exposure_s * iso / 100 / aperture^2). A larger value gives a brighter
// picture of the same scene. False when the exposure time is unknown; a missing aperture or ISO
// speed counts as constant.
bool orl_exif_exposure_ev(const struct orl_exif *exif, double *ev);

// Writes a JPEG file. quality is in [1, 100]; from 90 on chroma keeps full resolution. exif may be
// NULL.
enum orl_result orl_jpeg_write(const struct orl_log *log, const char *path,
                               const struct orl_image *image, int quality,
                               const struct orl_exif *exif) ORL_CHECK_RESULT;
// Encodes to memory, faster and with a slightly larger result; *data is released with free().
enum orl_result orl_jpeg_encode(const struct orl_log *log, const struct orl_image *image,
                                int quality, uint8_t **data, size_t *size) ORL_CHECK_RESULT;

#endif
