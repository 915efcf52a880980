// Compression of photographs on the CPU (libstb), since the encoders of some drivers are poor. All take
// opaque 8-bit RGBA, whose alpha is ignored, and give blocks of 4x4 texels in rows. Texels outside the
// picture repeat its last column and row.
#ifndef ORL_GPU_COMPRESS_H
#define ORL_GPU_COMPRESS_H

#include <stdint.h>

// BC1: ceil(width / 4) * ceil(height / 4) blocks of 8 bytes.
void orl_bc1_encode(const uint8_t *rgba, int width, int height, uint8_t *blocks);

// --- luma (RGTC1, also known as BC4) and chroma at half the size (RGTC2, BC5): as JPEG files have them ---

// These are of ITU-R BT.601, full range, of gamma-encoded colours, and take 3/4 byte a pixel.
// Blocks of 8 bytes.
void orl_rgtc_encode_luma(const uint8_t *rgba, int width, int height, uint8_t *blocks);
// Blocks of 16 bytes, Cb and Cr: texel (x, y) of half_width * half_height is the mean of pixels
// 2x, 2x + 1 and 2y, 2y + 1 of the picture.
void orl_rgtc_encode_chroma(const uint8_t *rgba, int width, int height, int half_width,
                            int half_height, uint8_t *blocks);

#endif
