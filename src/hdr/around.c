// Hole filling in a panorama, whose left and right borders are adjacent.
#include <stdlib.h>
#include <string.h>

#include "core/memory.h"
#include "hdr/internal.h"

enum { LEVELS_MAX = 17 };

struct level {
    int width, height;
    float (*texels)[4]; // colour * weight, weight; weight at most 1
};

// Averages the known values among 2x2 finer pixels (Gortler 1996, pull).
static void pull(const struct level *fine, struct level *coarse)
{
    for (int y = 0; y < coarse->height; y++)
        for (int x = 0; x < coarse->width; x++) {
            float sum[4] = {0};
            for (int k = 0; k < 4; k++) {
                int fx = (2 * x + (k & 1)) % fine->width, fy = 2 * y + (k >> 1);
                if (fy >= fine->height)
                    continue;
                for (int c = 0; c < 4; c++)
                    sum[c] += fine->texels[(size_t)fy * (size_t)fine->width + (size_t)fx][c];
            }
            float scale = sum[3] > 1 ? 1 / sum[3] : 1;
            for (int c = 0; c < 4; c++)
                coarse->texels[(size_t)y * (size_t)coarse->width + (size_t)x][c] = sum[c] * scale;
        }
}

// Fills unknown values bilinearly from the coarser level (Gortler 1996, push).
static void push(const struct level *coarse, struct level *fine)
{
    for (int y = 0; y < fine->height; y++)
        for (int x = 0; x < fine->width; x++) {
            float *texel = fine->texels[(size_t)y * (size_t)fine->width + (size_t)x];
            if (texel[3] > 0)
                continue;
            for (int k = 0; k < 4; k++) {
                int cx = x / 2 + (k & 1 ? 2 * (x & 1) - 1 : 0);
                int cy = y / 2 + (k >> 1 ? 2 * (y & 1) - 1 : 0);
                float share = (k & 1 ? 0.25f : 0.75f) * (k >> 1 ? 0.25f : 0.75f);
                cx = (cx + coarse->width) % coarse->width;
                cy = cy < 0 ? 0 : cy >= coarse->height ? coarse->height - 1 : cy;
                for (int c = 0; c < 4; c++)
                    texel[c] += share *
                                coarse->texels[(size_t)cy * (size_t)coarse->width + (size_t)cx][c];
            }
        }
}

static void seed(const struct orl_image *color, const struct orl_image *known, struct level *level)
{
    size_t pixels = (size_t)color->width * (size_t)color->height;
    for (size_t i = 0; i < pixels; i++) {
        if (!(known->f32[i] > 0))
            continue;
        memcpy(level->texels[i], color->f32 + 3 * i, 3 * sizeof(float));
        level->texels[i][3] = 1;
    }
}

static void take(const struct level *level, const struct orl_image *known, struct orl_image *color)
{
    size_t pixels = (size_t)color->width * (size_t)color->height;
    for (size_t i = 0; i < pixels; i++) {
        const float *texel = level->texels[i];
        for (size_t c = 0; c < 3 && !(known->f32[i] > 0) && texel[3] > 0; c++)
            color->f32[3 * i + c] = texel[c] / texel[3];
    }
}

enum orl_result orl_fill_around(const struct orl_log *log, struct orl_image *color,
                                const struct orl_image *known)
{
    struct level levels[LEVELS_MAX] = {{.width = color->width, .height = color->height}};
    size_t texels = (size_t)color->width * (size_t)color->height;
    int count = 1;
    for (; count < LEVELS_MAX && (levels[count - 1].width > 1 || levels[count - 1].height > 1);
         count++) {
        levels[count].width = (levels[count - 1].width + 1) / 2;
        levels[count].height = (levels[count - 1].height + 1) / 2;
        texels += (size_t)levels[count].width * (size_t)levels[count].height;
    }
    levels[0].texels = orl_array(log, texels, sizeof *levels[0].texels); // of all levels
    ORL_TRY_MEMORY(levels[0].texels);
    seed(color, known, &levels[0]);
    for (int i = 0; i + 1 < count; i++) {
        levels[i + 1].texels = levels[i].texels + (size_t)levels[i].width * (size_t)levels[i].height;
        pull(&levels[i], &levels[i + 1]);
    }
    for (int i = count - 1; i > 0; i--)
        push(&levels[i], &levels[i - 1]);
    take(&levels[0], known, color);
    free(levels[0].texels);
    return ORL_OK;
}
