// BC7 compression on the CPU, since drivers' own encoders differ and some are poor.
#ifndef ORL_GPU_BC7_H
#define ORL_GPU_BC7_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

enum { ORL_BC7_BLOCK_BYTES = 16 };

// Compresses opaque 8-bit RGBA to ceil(width / 4) * ceil(height / 4) blocks, in rows. Alpha is
// ignored and decodes to 254 or 255.
void orl_bc7_encode(const uint8_t *rgba, int width, int height, uint8_t *blocks);

#endif
