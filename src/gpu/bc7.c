// A BC7 encoder that uses mode 6 only: one line through colour space with 16 steps, which suits
// photographs. Layout: Khronos Data Format Specification 1.3, section 20 (BPTC).
#include <math.h>
#include <string.h>

#include "gpu/bc7.h"
#include "gpu/texel_block.h"

enum { TEXELS = ORL_BLOCK_TEXELS, RGB = 3 };

static const unsigned char weights[16] = {0,  4,  9,  13, 17, 21, 26, 30,
                                          34, 38, 43, 47, 51, 55, 60, 64};

struct line {
    float end[2][RGB];          // end points before quantisation
    int code[2][RGB], low[2];   // 7 bits each; the lowest bit, shared by all channels of an end
    unsigned char index[TEXELS];
    float error;
};

// Finds the direction of largest variance of the texels by power iteration.
static void find_axis(float texels[TEXELS][RGB], const float mean[RGB], float axis[RGB])
{
    float cov[RGB][RGB] = {{0}};
    for (int i = 0; i < TEXELS; i++)
        for (int a = 0; a < RGB; a++)
            for (int b = 0; b < RGB; b++)
                cov[a][b] += (texels[i][a] - mean[a]) * (texels[i][b] - mean[b]);
    int widest = cov[1][1] >= cov[0][0] ? 1 : 0;
    widest = cov[2][2] > cov[widest][widest] ? 2 : widest;
    memcpy(axis, cov[widest], sizeof cov[widest]); // power iteration's first step
    for (int step = 0; step < 4; step++) {
        float next[RGB], largest = 1e-6f;
        for (int a = 0; a < RGB; a++) {
            next[a] = cov[a][0] * axis[0] + cov[a][1] * axis[1] + cov[a][2] * axis[2];
            largest = fmaxf(largest, fabsf(next[a]));
        }
        for (int a = 0; a < RGB; a++)
            axis[a] = next[a] / largest;
    }
}

// Places the ends at the outermost texels along the axis.
static void span(float texels[TEXELS][RGB], struct line *line)
{
    float mean[RGB] = {0}, axis[RGB], low = 0, high = 0;
    for (int i = 0; i < TEXELS; i++)
        for (int c = 0; c < RGB; c++)
            mean[c] += texels[i][c] / TEXELS;
    find_axis(texels, mean, axis);
    float length2 = axis[0] * axis[0] + axis[1] * axis[1] + axis[2] * axis[2] + 1e-12f;
    for (int i = 0; i < TEXELS; i++) {
        float t = 0;
        for (int c = 0; c < RGB; c++)
            t += (texels[i][c] - mean[c]) * axis[c] / length2;
        low = fminf(low, t);
        high = fmaxf(high, t);
    }
    for (int c = 0; c < RGB; c++) {
        line->end[0][c] = mean[c] + low * axis[c];
        line->end[1][c] = mean[c] + high * axis[c];
    }
}

// Quantises the ends to the nearest storable values, with the shared bit of smaller error.
static void quantize(struct line *line)
{
    for (int e = 0; e < 2; e++) {
        float least = INFINITY;
        for (int bit = 0; bit < 2; bit++) {
            int code[RGB];
            float error = 0;
            for (int c = 0; c < RGB; c++) {
                float wanted = fminf(fmaxf(line->end[e][c], 0), 255);
                int nearest = (int)((wanted - (float)bit) / 2 + 0.5f);
                code[c] = nearest < 127 ? nearest : 127;
                float off = (float)(2 * code[c] + bit) - wanted;
                error += off * off;
            }
            if (error < least) {
                least = error;
                line->low[e] = bit;
                memcpy(line->code[e], code, sizeof code);
            }
        }
    }
}

// Assigns the nearest step to each texel and computes the remaining error.
static void assign(float texels[TEXELS][RGB], struct line *line)
{
    float start[RGB], along[RGB], length2 = 1e-12f;
    for (int c = 0; c < RGB; c++) {
        start[c] = (float)(2 * line->code[0][c] + line->low[0]);
        along[c] = (float)(2 * line->code[1][c] + line->low[1]) - start[c];
        length2 += along[c] * along[c];
    }
    line->error = 0;
    for (int i = 0; i < TEXELS; i++) {
        float t = 0;
        for (int c = 0; c < RGB; c++)
            t += (texels[i][c] - start[c]) * along[c] / length2;
        // The steps are 4 or 5 of 64 apart, so that the nearest of evenly spaced steps is the
        // nearest one or one beside it.
        int index = (int)(fminf(fmaxf(t, 0), 1) * 15 + 0.5f);
        line->index[i] = (unsigned char)index;
        for (int c = 0; c < RGB; c++) {
            float off = start[c] + along[c] * (float)weights[index] / 64 - texels[i][c];
            line->error += off * off;
        }
    }
}

// Fits the ends by least squares for the assigned steps. False: the system is singular.
static bool refine(float texels[TEXELS][RGB], const struct line *line, struct line *better)
{
    float aa = 0, ab = 0, bb = 0, ax[RGB] = {0}, bx[RGB] = {0};
    for (int i = 0; i < TEXELS; i++) {
        float b = (float)weights[line->index[i]] / 64, a = 1 - b;
        aa += a * a;
        ab += a * b;
        bb += b * b;
        for (int c = 0; c < RGB; c++) {
            ax[c] += a * texels[i][c];
            bx[c] += b * texels[i][c];
        }
    }
    float det = aa * bb - ab * ab;
    if (!(det > 1e-3f))
        return false;
    for (int c = 0; c < RGB; c++) {
        better->end[0][c] = (ax[c] * bb - bx[c] * ab) / det;
        better->end[1][c] = (bx[c] * aa - ax[c] * ab) / det;
    }
    return true;
}

static void put(uint8_t *block, int *at, int bits, int value)
{
    for (int i = 0; i < bits; i++, (*at)++)
        block[*at / 8] |= (uint8_t)((value >> i & 1) << *at % 8);
}

static void store(const struct line *line, uint8_t *block)
{
    // The highest bit of the first texel's index is not stored and must be 0; otherwise the ends
    // swap.
    int at = 0, first = line->index[0] >= 8, flip = first ? 15 : 0;
    memset(block, 0, ORL_BC7_BLOCK_BYTES);
    put(block, &at, 7, 1 << 6); // mode 6
    for (int c = 0; c < RGB; c++)
        for (int e = 0; e < 2; e++)
            put(block, &at, 7, line->code[e ^ first][c]);
    put(block, &at, 14, (1 << 14) - 1); // alpha
    put(block, &at, 1, line->low[first]);
    put(block, &at, 1, line->low[!first]);
    for (int i = 0; i < TEXELS; i++)
        put(block, &at, i == 0 ? 3 : 4, line->index[i] ^ flip);
}

static void encode_block(float texels[TEXELS][RGB], uint8_t *block)
{
    struct line line, better;
    span(texels, &line);
    quantize(&line);
    assign(texels, &line);
    if (refine(texels, &line, &better)) {
        quantize(&better);
        assign(texels, &better);
        if (better.error < line.error)
            line = better;
    }
    store(&line, block);
}

void orl_bc7_encode(const uint8_t *rgba, int width, int height, uint8_t *blocks)
{
    for (int y = 0; y < height; y += 4) {
        for (int x = 0; x < width; x += 4, blocks += ORL_BC7_BLOCK_BYTES) {
            uint8_t block[TEXELS][4];
            float texels[TEXELS][RGB];
            orl_texel_block(rgba, width, height, x, y, block);
            for (int i = 0; i < TEXELS; i++)
                for (int c = 0; c < RGB; c++)
                    texels[i][c] = block[i][c];
            encode_block(texels, blocks);
        }
    }
}
