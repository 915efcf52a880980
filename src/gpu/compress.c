#include "gpu/compress.h"

#include <math.h>
#include <stddef.h>
#include <string.h>

#include <stb_dxt.h>

enum { TEXELS = 16, BC1_BYTES = 8, LUMA_BYTES = 8, CHROMA_BYTES = 16 };

// Copies the block at column x and row y of an RGBA8 picture, row by row.
static void copy_block(const uint8_t *rgba, int width, int height, int x, int y, uint8_t texels[TEXELS][4])
{
    for (int i = 0; i < TEXELS; i++) {
        int u = x + i % 4 < width ? x + i % 4 : width - 1;
        int v = y + i / 4 < height ? y + i / 4 : height - 1;
        memcpy(texels[i], &rgba[4 * ((size_t)v * (size_t)width + (size_t)u)], 4);
    }
}

void orl_bc1_encode(const uint8_t *rgba, int width, int height, uint8_t *blocks)
{
    uint8_t texels[TEXELS][4];
    for (int y = 0; y < height; y += 4)
        for (int x = 0; x < width; x += 4, blocks += BC1_BYTES) {
            copy_block(rgba, width, height, x, y, texels);
            // Different alphas would be different colours to the encoder.
            for (int i = 0; i < TEXELS; i++)
                texels[i][3] = 255;
            stb_compress_dxt_block(blocks, texels[0], 0, STB_DXT_HIGHQUAL);
        }
}

static float luma(const uint8_t rgba[4])
{
    return 0.299f * (float)rgba[0] + 0.587f * (float)rgba[1] + 0.114f * (float)rgba[2];
}

static uint8_t byte_of(float value)
{
    return (uint8_t)lrintf(fminf(fmaxf(value, 0), 255));
}

void orl_rgtc_encode_luma(const uint8_t *rgba, int width, int height, uint8_t *blocks)
{
    uint8_t texels[TEXELS][4], values[TEXELS];
    for (int y = 0; y < height; y += 4)
        for (int x = 0; x < width; x += 4, blocks += LUMA_BYTES) {
            copy_block(rgba, width, height, x, y, texels);
            for (int i = 0; i < TEXELS; i++)
                values[i] = byte_of(luma(texels[i]));
            stb_compress_bc4_block(blocks, values);
        }
}

static int least(int a, int b)
{
    return a < b ? a : b;
}

// Cb and Cr of the texel at (x, y) of half the size.
static void chroma_at(const uint8_t *rgba, int width, int height, int x, int y, uint8_t chroma[2])
{
    float mean[3] = {0}; // R, B, luma
    for (int i = 0; i < 4; i++) {
        size_t u = (size_t)least(2 * x + i % 2, width - 1);
        size_t v = (size_t)least(2 * y + i / 2, height - 1);
        const uint8_t *pixel = &rgba[4 * (v * (size_t)width + u)];
        mean[0] += 0.25f * (float)pixel[0];
        mean[1] += 0.25f * (float)pixel[2];
        mean[2] += 0.25f * luma(pixel);
    }
    chroma[0] = byte_of((mean[1] - mean[2]) / 1.772f + 128);
    chroma[1] = byte_of((mean[0] - mean[2]) / 1.402f + 128);
}

void orl_rgtc_encode_chroma(const uint8_t *rgba, int width, int height, int half_width,
                            int half_height, uint8_t *blocks)
{
    uint8_t texels[TEXELS][2];
    for (int y = 0; y < half_height; y += 4)
        for (int x = 0; x < half_width; x += 4, blocks += CHROMA_BYTES) {
            for (int i = 0; i < TEXELS; i++)
                chroma_at(rgba, width, height, least(x + i % 4, half_width - 1),
                          least(y + i / 4, half_height - 1), texels[i]);
            stb_compress_bc5_block(blocks, texels[0]);
        }
}
