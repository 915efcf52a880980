// Private to src/io: one reader per file format. `path` is for messages only.
#ifndef ORL_IO_INTERNAL_H
#define ORL_IO_INTERNAL_H

#include <stdio.h>

#include "io/picture.h"

// Decoded pictures above this are refused: nobody photographs a gigapixel in one
// file, and a few hostile bytes must not ask for all memory.
#define ORL_PICTURE_MAX_PIXELS ((uint64_t)1 << 30)

// Size as the header says, within ORL_IMAGE_MAX_SIDE and ORL_PICTURE_MAX_PIXELS.
enum orl_result orl_picture_check_size(const struct orl_log *log, const char *path,
                                       uint64_t width, uint64_t height);

// The same, and that memory is left for as many bytes a pixel as reading it takes: called before
// anything of that size is allocated.
enum orl_result orl_picture_check_memory(const struct orl_log *log, const char *path,
                                         uint64_t width, uint64_t height,
                                         uint64_t bytes_per_pixel);

// Header only, from a stream at its start. exif: the EXIF block ("Exif\0\0" and TIFF
// data), released with free(); NULL when the file has none before its pixels.
struct orl_picture_header {
    int width, height;
    uint8_t *exif;
    size_t exif_size;
    int bits; // of a sample
};
enum orl_result orl_jpeg_read_header(const struct orl_log *log, const char *path, FILE *stream,
                                     struct orl_picture_header *header);
enum orl_result orl_png_read_header(const struct orl_log *log, const char *path, FILE *stream,
                                    struct orl_picture_header *header);

// channels 1 or 3.
enum orl_result orl_jpeg_decode(const struct orl_log *log, const char *path, const uint8_t *data,
                                size_t size, int channels, struct orl_image *image);
enum orl_result orl_png_decode(const struct orl_log *log, const char *path, const uint8_t *data,
                               size_t size, int channels, struct orl_image *image);
// Binary Netpbm files (P4, P5, P6) of 8 bits, by their first bytes.
bool orl_pnm_is(const uint8_t *data, size_t size);
enum orl_result orl_pnm_read_header(const struct orl_log *log, const char *path, FILE *stream,
                                    struct orl_picture_header *header);
enum orl_result orl_pnm_decode(const struct orl_log *log, const char *path, const uint8_t *data,
                               size_t size, int channels, struct orl_image *image);
// F32 x3, linear light, from 8 or 16 bits: sRGB unless its gamma says linear.
enum orl_result orl_png_decode_linear(const struct orl_log *log, const char *path,
                                      const uint8_t *data, size_t size,
                                      struct orl_image *image);

// TIFF and RAW: straight from the file, as their libraries want it. Values are linear
// light, F32 x3; exif says what the header does.
enum orl_result orl_tiff_inspect(const struct orl_log *log, const char *path,
                                 struct orl_picture_info *info, struct orl_exif *exif);
enum orl_result orl_tiff_decode_linear(const struct orl_log *log, const char *path,
                                       struct orl_image *image);
enum orl_result orl_raw_inspect(const struct orl_log *log, const char *path,
                                struct orl_picture_info *info, struct orl_exif *exif);
enum orl_result orl_raw_decode_linear(const struct orl_log *log, const char *path,
                                      struct orl_image *image);

// A colour profile (ICC) of RGB samples, to linear light of Rec. 709 primaries.
struct orl_profile;
// NULL, with a warning, for one that cannot be used: colours count as sRGB then.
struct orl_profile *orl_profile_create(const struct orl_log *log, const char *path,
                                       const void *icc, size_t size);
void orl_profile_destroy(struct orl_profile **profile);
// F32 x3: samples in [0, 1] as stored become light. Colours that Rec. 709 has not are
// brought to its border.
void orl_profile_apply(const struct orl_profile *profile, struct orl_image *image);

// From a block "Exif\0\0...". Damaged blocks say nothing, with a warning.
enum orl_result orl_exif_decode(const struct orl_log *log, const char *path, const uint8_t *data,
                                size_t size, struct orl_exif *exif);
// A malloc'ed block "Exif\0\0..." that says what `exif` says.
enum orl_result orl_exif_encode(const struct orl_log *log, const struct orl_exif *exif,
                                uint8_t **data, size_t *size);

#endif
