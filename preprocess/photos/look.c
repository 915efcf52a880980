#include "preprocess/photos/look.h"

#include <math.h>
#include <stdlib.h>

#include "core/memory.h"
#include "core/order.h"

enum {
    BLOCK = 8,
    ACROSS = ORL_LOOK_WIDTH / BLOCK,
    DOWN = ORL_LOOK_HEIGHT / BLOCK,
    BLOCKS = ACROSS * DOWN,
    SHARP_SIDE = 1024,  // larger side at which sharpness is measured, at most twice of it
    FINE = 1, COARSE = 4, // pixels between the samples of fine and of coarse detail
    MEAN_MAX = 4,       // grey levels by which the means of one picture's blocks differ
    BLURRED_COUNT = 8,  // photographs that a median needs
};
// Energy of detail, as a share of the median photograph's, below which a photograph is blurred.
static const float BLURRED_LOG2 = -2.5f;
static const double COARSE_MIN = 16; // squared grey levels of coarse detail in a pixel

// --- making a look ---

// Mean of the pixels that fall into pixel (x, y) of a picture of width x height.
static float box_mean(const struct orl_image *image, int width, int height, int x, int y)
{
    int left = (int)((int64_t)x * image->width / width);
    int top = (int)((int64_t)y * image->height / height);
    int right = (int)((int64_t)(x + 1) * image->width / width);
    int bottom = (int)((int64_t)(y + 1) * image->height / height);
    right = right > left ? right : left + 1;
    bottom = bottom > top ? bottom : top + 1;
    uint64_t sum = 0;
    for (int v = top; v < bottom; v++)
        for (int u = left; u < right; u++)
            sum += image->u8[(size_t)v * (size_t)image->width + (size_t)u];
    return (float)sum / (float)((right - left) * (bottom - top));
}

// Energy of second differences over `step` pixels in the direction (dx, dy).
static double detail(const float *pixels, int width, int height, int dx, int dy, int step)
{
    int margin = COARSE;
    ptrdiff_t offset = ((ptrdiff_t)dy * width + dx) * step;
    double sum = 0;
    for (int y = margin; y < height - margin; y++) {
        const float *p = pixels + (size_t)y * (size_t)width + margin;
        for (int x = margin; x < width - margin; x++, p++) {
            float d = 2 * p[0] - p[offset] - p[-offset];
            sum += (double)(d * d);
        }
    }
    return sum;
}

// Motion blurs in one direction only, so the direction with least fine detail counts.
static float sharpness_of(const float *pixels, int width, int height)
{
    static const int directions[4][2] = {{1, 0}, {0, 1}, {1, 1}, {1, -1}};
    double least = INFINITY;
    for (size_t i = 0; i < ORL_COUNT(directions); i++) {
        int dx = directions[i][0], dy = directions[i][1];
        double coarse = detail(pixels, width, height, dx, dy, COARSE);
        // Dark photographs and plain walls have too little detail to tell.
        if (coarse < COARSE_MIN * (double)width * (double)height)
            return INFINITY;
        least = fmin(least, detail(pixels, width, height, dx, dy, FINE) / coarse);
    }
    return (float)log2(least);
}

enum orl_result orl_look_make(const struct orl_log *log, const struct orl_image *luma,
                              struct orl_look *look)
{
    int side = luma->width > luma->height ? luma->width : luma->height;
    int factor = side < 2 * SHARP_SIDE ? 1 : side / SHARP_SIDE;
    int width = luma->width / factor, height = luma->height / factor;
    float *pixels = orl_array(log, (size_t)width * (size_t)height, sizeof *pixels);
    ORL_TRY_MEMORY(pixels);
    for (int y = 0; y < height; y++)
        for (int x = 0; x < width; x++)
            pixels[(size_t)y * (size_t)width + (size_t)x] = box_mean(luma, width, height, x, y);
    look->sharpness = sharpness_of(pixels, width, height);
    for (int y = 0; y < ORL_LOOK_HEIGHT; y++)
        for (int x = 0; x < ORL_LOOK_WIDTH; x++)
            look->luma[y * ORL_LOOK_WIDTH + x] =
                (uint8_t)lrintf(box_mean(luma, ORL_LOOK_WIDTH, ORL_LOOK_HEIGHT, x, y));
    free(pixels);
    return ORL_OK;
}

// --- comparing two ---

// Block `b`, minus its mean. Returns its energy.
static float take_block(const struct orl_look *look, int b, float pixels[BLOCK * BLOCK],
                        float *mean)
{
    const uint8_t *from = look->luma + b / ACROSS * BLOCK * ORL_LOOK_WIDTH + b % ACROSS * BLOCK;
    float energy = 0;
    *mean = 0;
    for (int i = 0; i < BLOCK * BLOCK; i++) {
        pixels[i] = from[i / BLOCK * ORL_LOOK_WIDTH + i % BLOCK];
        *mean += pixels[i] / (BLOCK * BLOCK);
    }
    for (int i = 0; i < BLOCK * BLOCK; i++) {
        pixels[i] -= *mean;
        energy += pixels[i] * pixels[i];
    }
    return energy;
}

// Share of the blocks with texture whose correlation is at least `least` and whose means differ by
// at most `mean_max`; 0 where nothing has texture.
static float share_alike(const struct orl_look *a, const struct orl_look *b, float least,
                         float mean_max)
{
    const float textured = 16.0f * BLOCK * BLOCK;
    int seen = 0, alike = 0;
    for (int k = 0; k < BLOCKS; k++) {
        float x[BLOCK * BLOCK], y[BLOCK * BLOCK], mean_x, mean_y, product = 0;
        float energy_x = take_block(a, k, x, &mean_x), energy_y = take_block(b, k, y, &mean_y);
        if (fmaxf(energy_x, energy_y) < textured)
            continue;
        for (int i = 0; i < BLOCK * BLOCK; i++)
            product += x[i] * y[i];
        seen++;
        alike += product > least * sqrtf(energy_x * energy_y) &&
                 fabsf(mean_x - mean_y) <= mean_max;
    }
    return seen ? (float)alike / (float)seen : 0;
}

bool orl_look_same_view(const struct orl_look *a, const struct orl_look *b)
{
    return share_alike(a, b, 0.9f, 256) >= 0.8f;
}

bool orl_look_same_picture(const struct orl_look *a, const struct orl_look *b)
{
    // Most pairs differ at the first few of these pixels.
    for (int i = ORL_LOOK_WIDTH + 1; i < ORL_LOOK_WIDTH * ORL_LOOK_HEIGHT; i += 401)
        if (abs(a->luma[i] - b->luma[i]) > 32)
            return false;
    return share_alike(a, b, 0.97f, MEAN_MAX) >= 0.95f;
}

enum orl_result orl_look_blurred_below(const struct orl_log *log, const struct orl_look *looks,
                                       size_t count, float *limit)
{
    *limit = -INFINITY;
    size_t told = 0;
    float *sorted = orl_array(log, count, sizeof *sorted);
    ORL_TRY_MEMORY(sorted);
    for (size_t i = 0; i < count; i++)
        if (isfinite(looks[i].sharpness))
            sorted[told++] = looks[i].sharpness;
    qsort(sorted, told, sizeof *sorted, orl_order_floats);
    if (told >= BLURRED_COUNT)
        *limit = sorted[told / 2] + BLURRED_LOG2;
    free(sorted);
    return ORL_OK;
}
