#include "soft/descent.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "core/memory.h"

enum { REACH = 5, TAPS = 2 * REACH + 1, PLANES = 12 };
static const double SIGMA = 1.5;
static const float C1 = 1e-4f, C2 = 9e-4f, SSIM_SHARE = 0.2f;

struct planes {
    int width, height;
    size_t pixels;
    float taps[TAPS];
    float *memory; // owned: PLANES planes
};

static float *plane(const struct planes *p, int i)
{
    return p->memory + (size_t)i * p->pixels;
}

// Blurs a plane, 0 outside the picture. in and out may be the same; `spare` is overwritten.
static void blur(const struct planes *p, const float *in, float *spare, float *out)
{
    for (int y = 0; y < p->height; y++) {
        const float *from = in + (size_t)y * (size_t)p->width;
        float *to = spare + (size_t)y * (size_t)p->width;
        for (int x = 0; x < p->width; x++) {
            float sum = 0;
            for (int k = x < REACH ? REACH - x : 0; k < TAPS && x + k - REACH < p->width; k++)
                sum += p->taps[k] * from[x + k - REACH];
            to[x] = sum;
        }
    }
    for (int y = 0; y < p->height; y++) {
        float *to = out + (size_t)y * (size_t)p->width;
        memset(to, 0, (size_t)p->width * sizeof *to);
        for (int k = y < REACH ? REACH - y : 0; k < TAPS && y + k - REACH < p->height; k++) {
            const float *from = spare + (size_t)(y + k - REACH) * (size_t)p->width;
            for (int x = 0; x < p->width; x++)
                to[x] += p->taps[k] * from[x];
        }
    }
}

// One channel: planes 0 and 1 hold picture and photograph; plane 2 gets the gradient of the sum of SSIM.
static double ssim_gradient(const struct planes *p)
{
    float *x = plane(p, 0), *y = plane(p, 1), *gradient = plane(p, 2), *spare = plane(p, 3);
    float *mx = plane(p, 4), *my = plane(p, 5), *xx = plane(p, 6), *yy = plane(p, 7), *xy = plane(p, 8);
    float *by_mean = plane(p, 9), *by_square = plane(p, 10), *by_product = plane(p, 11);
    double sum = 0;
    for (size_t i = 0; i < p->pixels; i++) {
        xx[i] = x[i] * x[i];
        yy[i] = y[i] * y[i];
        xy[i] = x[i] * y[i];
    }
    blur(p, x, spare, mx);
    blur(p, y, spare, my);
    blur(p, xx, spare, xx);
    blur(p, yy, spare, yy);
    blur(p, xy, spare, xy);
    for (size_t i = 0; i < p->pixels; i++) {
        float a = 2 * mx[i] * my[i] + C1, b = 2 * (xy[i] - mx[i] * my[i]) + C2;
        float c = mx[i] * mx[i] + my[i] * my[i] + C1;
        float d = xx[i] - mx[i] * mx[i] + yy[i] - my[i] * my[i] + C2;
        float s = a * b / (c * d);
        sum += (double)s;
        by_mean[i] = 2 * my[i] * (b - a) / (c * d) + 2 * mx[i] * s * (1 / d - 1 / c);
        by_square[i] = -s / d;
        by_product[i] = 2 * a / (c * d);
    }
    blur(p, by_mean, spare, by_mean);
    blur(p, by_square, spare, by_square);
    blur(p, by_product, spare, by_product);
    for (size_t i = 0; i < p->pixels; i++)
        gradient[i] = by_mean[i] + 2 * x[i] * by_square[i] + y[i] * by_product[i];
    return sum;
}

enum orl_result orl_soft_loss(const struct orl_log *log, const struct orl_image *picture,
                              const struct orl_image *photograph, const struct orl_image *use,
                              struct orl_image *gradient, double *loss)
{
    ORL_REQUIRE(log, picture->channels == 4 && photograph->channels == 3 && gradient->channels == 4);
    struct planes p = {.width = picture->width, .height = picture->height,
                       .pixels = (size_t)picture->width * (size_t)picture->height};
    p.memory = orl_array(log, p.pixels, PLANES * sizeof *p.memory);
    ORL_TRY_MEMORY(p.memory);
    double whole = 0, sum = 0;
    for (int k = 0; k < TAPS; k++)
        whole += exp(-0.5 * (k - REACH) * (k - REACH) / (SIGMA * SIGMA));
    for (int k = 0; k < TAPS; k++)
        p.taps[k] = (float)(exp(-0.5 * (k - REACH) * (k - REACH) / (SIGMA * SIGMA)) / whole);
    const float share = 1 / (3 * (float)p.pixels);
    for (size_t c = 0; c < 3; c++) {
        float *x = plane(&p, 0), *y = plane(&p, 1), *by = plane(&p, 2);
        for (size_t i = 0; i < p.pixels; i++) {
            y[i] = photograph->f32[3 * i + c];
            x[i] = use && !use->u8[i] ? y[i] : picture->f32[4 * i + c];
        }
        double alike = ssim_gradient(&p);
        sum += (double)SSIM_SHARE * ((double)p.pixels - alike);
        for (size_t i = 0; i < p.pixels; i++) {
            float off = x[i] - y[i], sign = off > 0 ? 1.0f : off < 0 ? -1.0f : 0.0f;
            sum += (double)((1 - SSIM_SHARE) * fabsf(off));
            bool used = !use || use->u8[i];
            gradient->f32[4 * i + c] = used ? share * ((1 - SSIM_SHARE) * sign - SSIM_SHARE * by[i]) : 0;
        }
    }
    *loss = sum * (double)share;
    free(p.memory);
    return ORL_OK;
}
