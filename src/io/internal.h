// Private to src/io: one reader per file format. Where a function also takes data or a stream,
// `path` is for messages only.
#ifndef ORL_IO_INTERNAL_H
#define ORL_IO_INTERNAL_H

#include <stdio.h>

#include "core/memory.h"
#include "io/picture.h"

// Larger pictures are refused. Photographs are smaller, and a few hostile bytes must not
// make Oriel allocate all memory.
#define ORL_PICTURE_MAX_PIXELS ((uint64_t)1 << 30)

// Checks that the size in the header is within ORL_IMAGE_MAX_SIDE and ORL_PICTURE_MAX_PIXELS.
enum orl_result orl_picture_check_size(const struct orl_log *log, const char *path,
                                       uint64_t width, uint64_t height);

// Checks the size, and also that the bytes per pixel that decoding takes fit the available memory.
// Called before anything of that size is allocated.
enum orl_result orl_picture_check_memory(const struct orl_log *log, const char *path,
                                         uint64_t width, uint64_t height,
                                         uint64_t bytes_per_pixel);

// Chromaticities x, y of a space of RGB colours.
struct orl_primaries {
    double white[2], red[2], green[2], blue[2];
};
extern const struct orl_primaries orl_primaries_rec709; // sRGB's, too

// The header of a picture, read from a stream at its start. exif: the EXIF block ("Exif\0\0" and
// TIFF data), of no bytes when the file has none before its pixels. The same of icc, a colour profile.
struct orl_picture_header {
    struct orl_picture_info info; // but for `profiled`, which gamma, primaries, icc and exif tell
    struct orl_bytes exif, icc;
    double gamma; // PNG: samples are light to this power; 0: they have sRGB's curve
    struct orl_primaries primaries; // PNG; all 0: sRGB's
};
// By Google's Photo Sphere schema, which flat pictures may have, too.
bool orl_xmp_tells_panorama(const void *xmp, size_t size);
enum orl_result orl_jpeg_read_header(const struct orl_log *log, const char *path, FILE *stream,
                                     struct orl_picture_header *header);
enum orl_result orl_png_read_header(const struct orl_log *log, const char *path, FILE *stream,
                                    struct orl_picture_header *header);

// Decode samples as stored, to U8 RGB, or of JPEG with 1 channel to the luma that it holds. Of PNG also to F32 in [0, 1]: with
// ORL_PNG_RGB_DEEP always, and with ORL_PNG_RGBA where the file has 16 bits a sample. Alpha is opaque where the file has none.
enum orl_png_kind { ORL_PNG_RGB, ORL_PNG_RGB_DEEP, ORL_PNG_RGBA };
enum orl_result orl_jpeg_decode(const struct orl_log *log, const char *path, const uint8_t *data,
                                size_t size, int channels, struct orl_image *image);
enum orl_result orl_png_decode(const struct orl_log *log, const char *path, const uint8_t *data,
                               size_t size, enum orl_png_kind kind, struct orl_image *image);
// True for binary Netpbm files (P4, P5, P6), recognised by their first bytes.
bool orl_pnm_is(const uint8_t *data, size_t size);
enum orl_result orl_pnm_read_header(const struct orl_log *log, const char *path, FILE *stream,
                                    struct orl_picture_header *header);
enum orl_result orl_pnm_decode(const struct orl_log *log, const char *path, const uint8_t *data,
                               size_t size, struct orl_image *image);

// TIFF, RAW and HEIF are read from the file at `path`, as their libraries require; exif is filled from the header.
// Values of TIFF and RAW are linear light, F32 x3. After an error the caller releases what there is of the image.
enum orl_result orl_tiff_inspect(const struct orl_log *log, const char *path,
                                 struct orl_picture_info *info, struct orl_exif *exif);
enum orl_result orl_tiff_decode_linear(const struct orl_log *log, const char *path,
                                       struct orl_image *image);
enum orl_result orl_raw_inspect(const struct orl_log *log, const char *path,
                                struct orl_picture_info *info, struct orl_exif *exif);
enum orl_result orl_raw_decode_linear(const struct orl_log *log, const char *path,
                                      struct orl_image *image);

// The primaries that an EXR file states in "chromaticities"; false: they are those of Rec. 709.
bool orl_exr_primaries(const char *path, struct orl_primaries *primaries);

struct orl_profile;
// HEIC and AVIF, recognised by their first 12 bytes.
bool orl_heif_is(const uint8_t *data, size_t size);
enum orl_result orl_heif_inspect(const struct orl_log *log, const char *path,
                                 struct orl_picture_info *info, struct orl_exif *exif);
// Bits of a sample, and the colour profile; NULL: the colours are taken as sRGB. 0 and NULL for a damaged file.
void orl_heif_profile(const struct orl_log *log, const char *path, int *bits, struct orl_profile **profile);
// Samples as stored, x3: U8, or of more than 8 bits F32 in [0, 1].
enum orl_result orl_heif_decode(const struct orl_log *log, const char *path, struct orl_image *image);

// A conversion from the RGB or grey space of a colour profile (ICC) to linear light, Rec. 709
// primaries.
// NULL for a profile that is sRGB's within two steps of 8 bits, and, with a warning, for one that
// cannot be used: the caller then assumes sRGB.
struct orl_profile *orl_profile_create(const struct orl_log *log, const char *path,
                                       const void *icc, size_t size);
// That of samples which are light when raised to the power `gamma`, or with 0 by sRGB's curve. NULL
// for sRGB itself, and, with a warning, for primaries that no colours have.
struct orl_profile *orl_profile_create_rgb(const struct orl_log *log, const char *path,
                                           const struct orl_primaries *primaries, double gamma);
void orl_profile_destroy(struct orl_profile **profile);
// Converts stored samples in [0, 1], F32 x3, to linear light. Colours outside the Rec. 709 gamut
// are clipped to it.
void orl_profile_to_linear(const struct orl_profile *profile, struct orl_image *image);
// Converts stored samples, U8 x3, to sRGB within one step, in a tenth of the time.
enum orl_result orl_profile_to_srgb(const struct orl_log *log, const struct orl_profile *profile,
                                    struct orl_image *image) ORL_CHECK_RESULT;

// Copies a text of at most `count` bytes, which ends before a zero byte, into `size` bytes.
void orl_exif_text(const void *bytes, size_t count, char *text, size_t size);
// Decodes a block "Exif\0\0...". A damaged block gives zeroes and a warning.
enum orl_result orl_exif_decode(const struct orl_log *log, const char *path, const uint8_t *data,
                                size_t size, struct orl_exif *exif);
// Encodes `exif` as a block "Exif\0\0...", released with free().
enum orl_result orl_exif_encode(const struct orl_log *log, const struct orl_exif *exif,
                                uint8_t **data, size_t *size);

#endif
