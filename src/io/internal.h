// Private to src/io: one reader per file format.
#ifndef ORL_IO_INTERNAL_H
#define ORL_IO_INTERNAL_H

#include <stdio.h>

#include "core/memory.h"
#include "io/picture.h"

// A picture's file as it is read.
struct orl_picture_file {
    const struct orl_log *log;
    const struct orl_log *profile_log; // is told of a colour profile that cannot be used
    const char *path;
    FILE *stream;   // at the file's start; the libraries of TIFF, EXR, RAW and HEIF read the path instead
    uint64_t bytes; // of the file
    int channels;   // wanted: 1: of JPEG the luma that it holds; 4: of PNG with alpha, opaque where there is none
    // Set by the reader:
    struct orl_picture_info info;
    struct orl_profile *profile; // owned; NULL: the colours are taken as sRGB
    bool light;                  // pixels are linear light
};

// Reads the header, and with `image` the pixels too: of 3 channels unless others are wanted, U8 or F32, as stored in
// [0, 1], or of light. After an error the caller releases what there is of the image and the profile.
typedef enum orl_result orl_picture_reader(struct orl_picture_file *file, struct orl_image *image);
orl_picture_reader orl_jpeg_read, orl_png_read, orl_pnm_read, orl_tiff_read, orl_exr_read_picture, orl_raw_read,
    orl_heif_read;

// Opens the stream and sets `bytes`.
enum orl_result orl_picture_open(struct orl_picture_file *file);
// Sets info.width and .height once they are within ORL_IMAGE_MAX_SIDE and 2^30 pixels.
enum orl_result orl_picture_set_size(struct orl_picture_file *file, uint64_t width, uint64_t height);
// Checks that the bytes per pixel that decoding takes fit the available memory. Called before anything of
// that size is allocated.
enum orl_result orl_picture_check_memory(const struct orl_picture_file *file, uint64_t bytes_per_pixel);
// Checks that the file has at least these bytes: a few hostile ones must not claim a large picture.
enum orl_result orl_picture_check_bytes(const struct orl_picture_file *file, uint64_t least);
// By Google's Photo Sphere schema, which flat pictures may have, too.
bool orl_xmp_tells_panorama(const void *xmp, size_t size);

// Chromaticities x, y of a space of RGB colours.
struct orl_primaries {
    double white[2], red[2], green[2], blue[2];
};
extern const struct orl_primaries orl_primaries_rec709; // sRGB's, too
// Sets the profile: by ICC, where there is one; by samples that are light to the power `gamma` (0: sRGB's curve) and
// by primaries (all 0: sRGB's); else by EXIF, which has been read.
void orl_picture_set_profile(struct orl_picture_file *file, const void *icc, size_t icc_size, double gamma,
                             const struct orl_primaries *primaries);

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
// Decodes the TIFF data of EXIF, which follow "Exif\0\0" where a file has that. Damaged data give zeroes.
enum orl_result orl_exif_decode(const struct orl_log *log, const char *path, const uint8_t *data,
                                size_t size, struct orl_exif *exif);
// Encodes `exif` as a block "Exif\0\0...", released with free().
enum orl_result orl_exif_encode(const struct orl_log *log, const struct orl_exif *exif,
                                uint8_t **data, size_t *size);

#endif
