#include "gpu/bc1.h"

#include <stb_dxt.h>

#include "gpu/texel_block.h"

enum { BLOCK_BYTES = 8 };

void orl_bc1_encode(const uint8_t *rgba, int width, int height, uint8_t *blocks)
{
    uint8_t texels[ORL_BLOCK_TEXELS][4];
    for (int y = 0; y < height; y += 4)
        for (int x = 0; x < width; x += 4, blocks += BLOCK_BYTES) {
            orl_texel_block(rgba, width, height, x, y, texels);
            // Different alphas would be different colours to the encoder.
            for (int i = 0; i < ORL_BLOCK_TEXELS; i++)
                texels[i][3] = 255;
            stb_compress_dxt_block(blocks, texels[0], 0, STB_DXT_HIGHQUAL);
        }
}
