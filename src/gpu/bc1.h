// BC1 compression on the CPU (libstb), since the encoders of some drivers are poor.
#ifndef ORL_GPU_BC1_H
#define ORL_GPU_BC1_H

#include <stdint.h>

// Compresses opaque 8-bit RGBA to ceil(width / 4) * ceil(height / 4) blocks of 8 bytes, in rows.
// Alpha is ignored.
void orl_bc1_encode(const uint8_t *rgba, int width, int height, uint8_t *blocks);

#endif
