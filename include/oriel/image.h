// A picture in host memory.
#ifndef ORIEL_IMAGE_H
#define ORIEL_IMAGE_H

#include "oriel/log.h"

enum orl_pixel {
    ORL_PIXEL_U8,  // sRGB-encoded colour, or a mask
    ORL_PIXEL_F32, // scene-linear colour, or any other quantity
};

// Pixels are row-major, top row first, with interleaved channels and no padding.
struct orl_image {
    int width, height, channels; // channels 1 to 4
    enum orl_pixel type;
    union {
        uint8_t *u8;
        float *f32;
        void *data; // owned
    };
};

// Largest width and height accepted anywhere, in pixels.
#define ORL_IMAGE_MAX_SIDE 65536

// Allocates zeroed pixels. ORL_ERR_ARGUMENT for sizes outside
// [1, ORL_IMAGE_MAX_SIDE] or channels outside [1, 4].
enum orl_result orl_image_init(const struct orl_log *log, struct orl_image *image, int width,
                               int height, int channels, enum orl_pixel type) ORL_CHECK_RESULT;
// Releases the pixels and zeroes the struct.
void orl_image_finish(struct orl_image *image);
size_t orl_image_bytes(const struct orl_image *image);

#endif
