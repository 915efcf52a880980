// Blocks of 4x4 texels, which block compression encodes one by one.
#ifndef ORL_GPU_TEXEL_BLOCK_H
#define ORL_GPU_TEXEL_BLOCK_H

#include <stddef.h>
#include <stdint.h>
#include <string.h>

enum { ORL_BLOCK_TEXELS = 16 };

// Copies the block at column x and row y of an RGBA8 picture, row by row. Texels outside the picture
// repeat its last column and row.
static inline void orl_texel_block(const uint8_t *rgba, int width, int height, int x, int y,
                                   uint8_t texels[ORL_BLOCK_TEXELS][4])
{
    for (int i = 0; i < ORL_BLOCK_TEXELS; i++) {
        int u = x + i % 4 < width ? x + i % 4 : width - 1;
        int v = y + i / 4 < height ? y + i / 4 : height - 1;
        memcpy(texels[i], &rgba[4 * ((size_t)v * (size_t)width + (size_t)u)], 4);
    }
}

#endif
