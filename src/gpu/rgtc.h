// Photographs as luma (RGTC1, also known as BC4) and chroma at half the size (RGTC2, BC5): as JPEG
// files have them, 3/4 byte a pixel. Compressed on the CPU (libstb).
#ifndef ORL_GPU_RGTC_H
#define ORL_GPU_RGTC_H

#include <stdint.h>

// Both take opaque 8-bit RGBA, whose alpha is ignored, and give blocks of 4x4 texels in rows.
// Luma and chroma are those of JPEG files (ITU-R BT.601, full range, of gamma-encoded colours).

// Blocks of 8 bytes.
void orl_rgtc_encode_luma(const uint8_t *rgba, int width, int height, uint8_t *blocks);
// Blocks of 16 bytes, Cb and Cr: texel (x, y) of half_width * half_height is the mean of pixels
// 2x, 2x + 1 and 2y, 2y + 1 of the picture.
void orl_rgtc_encode_chroma(const uint8_t *rgba, int width, int height, int half_width,
                            int half_height, uint8_t *blocks);

#endif
