// Definitions are in docs/reference/metrics.md.
#include "eval/metrics.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "bridge/bridge.h"
#include "core/cholesky.h"
#include "core/memory.h"

static const double psnr_max_db = 100;

double orl_psnr_db(double squared_error, double count, double peak)
{
    double mse = squared_error / count;
    return mse > 0 ? fmin(psnr_max_db, 10 * log10(peak * peak / mse)) : psnr_max_db;
}

static size_t pixel_count(const struct orl_image *image)
{
    return (size_t)image->width * (size_t)image->height;
}

static double squared_error(const uint8_t *a, const uint8_t *b)
{
    double sum = 0;
    for (int c = 0; c < 3; c++)
        sum += (double)((a[c] - b[c]) * (a[c] - b[c]));
    return sum;
}

static void measure_psnr(const struct orl_image *a, const struct orl_image *b,
                         const struct orl_image *coverage, struct orl_metrics *metrics)
{
    size_t count = pixel_count(a), covered = 0;
    double sum = 0, covered_sum = 0;
    for (size_t i = 0; i < count; i++) {
        double error = squared_error(a->u8 + 3 * i, b->u8 + 3 * i);
        sum += error;
        if (coverage->f32[i] > 0.5f) {
            covered_sum += error;
            covered++;
        }
    }
    metrics->psnr_db = orl_psnr_db(sum, 3.0 * (double)count, 255);
    metrics->psnr_covered_db = covered ? orl_psnr_db(covered_sum, 3.0 * (double)covered, 255) : 0;
    metrics->coverage = (double)covered / (double)count;
}

// --- colour fit ---

struct affine {
    double m[3][3], offset[3];
};

// Least squares of b = m a + offset over all pixels. A weak pull towards the identity makes the
// solution unique for pictures of few colours.
static void fit_colour(const struct orl_image *a, const struct orl_image *b, struct affine *fit)
{
    const double pull = 1e-3; // variance in squared 8-bit steps; typical pictures have hundreds
    size_t count = pixel_count(a);
    double n = (double)count, mean_a[3] = {0}, mean_b[3] = {0}, aa[3][3] = {{0}}, ba[3][3] = {{0}};
    for (size_t i = 0; i < count; i++) {
        for (int j = 0; j < 3; j++) {
            mean_a[j] += a->u8[3 * i + (size_t)j] / n;
            mean_b[j] += b->u8[3 * i + (size_t)j] / n;
        }
    }
    for (size_t i = 0; i < count; i++) {
        const uint8_t *p = a->u8 + 3 * i, *q = b->u8 + 3 * i;
        for (int j = 0; j < 3; j++) {
            for (int k = 0; k < 3; k++) {
                aa[j][k] += (p[j] - mean_a[j]) * (p[k] - mean_a[k]) / n;
                ba[j][k] += (q[j] - mean_b[j]) * (p[k] - mean_a[k]) / n;
            }
        }
    }
    for (int j = 0; j < 3; j++) {
        aa[j][j] += pull;
        ba[j][j] += pull;
    }
    for (int j = 0; j < 3; j++) {
        double factor[3][3];
        memcpy(factor, aa, sizeof factor);
        memcpy(fit->m[j], ba[j], sizeof fit->m[j]);
        orl_cholesky_solve(factor[0], fit->m[j], 3); // with the pull there is a solution
        fit->offset[j] = mean_b[j];
        for (int k = 0; k < 3; k++)
            fit->offset[j] -= fit->m[j][k] * mean_a[k];
    }
}

static double psnr_after_fit(const struct orl_image *a, const struct orl_image *b)
{
    struct affine fit = {0};
    fit_colour(a, b, &fit);
    size_t count = pixel_count(a);
    double sum = 0;
    for (size_t i = 0; i < count; i++) {
        const uint8_t *p = a->u8 + 3 * i, *q = b->u8 + 3 * i;
        for (int j = 0; j < 3; j++) {
            double value = fit.offset[j] + fit.m[j][0] * p[0] + fit.m[j][1] * p[1] +
                           fit.m[j][2] * p[2];
            double error = fmin(fmax(value, 0), 255) - q[j];
            sum += error * error;
        }
    }
    return orl_psnr_db(sum, 3.0 * (double)count, 255);
}

// --- SSIM ---

enum { SSIM_TAPS = 11 };

// Luma minus 128 has the same variances, which lose less precision in float.
static const float luma_shift = 128;

static float luma(const uint8_t *rgb)
{
    return 0.299f * rgb[0] + 0.587f * rgb[1] + 0.114f * rgb[2];
}

// Blurred x, y, xx, yy or xy (which: 0 to 4).
static enum orl_result moment(const struct orl_log *log, const struct orl_image *a,
                              const struct orl_image *b, int which, struct orl_image *blurred)
{
    struct orl_image product;
    ORL_TRY(orl_image_init(log, &product, a->width, a->height, 1, ORL_PIXEL_F32));
    size_t count = pixel_count(a);
    for (size_t i = 0; i < count; i++) {
        float x = luma(a->u8 + 3 * i) - luma_shift, y = luma(b->u8 + 3 * i) - luma_shift;
        const float values[5] = {x, y, x * x, y * y, x * y};
        product.f32[i] = values[which];
    }
    enum orl_result result = orl_bridge_blur(log, &product, SSIM_TAPS, 1.5, blurred);
    orl_image_finish(&product);
    return result;
}

// Wang et al. 2004, equation 13.
static double ssim_at(struct orl_image *const moments, size_t i)
{
    const double c1 = (0.01 * 255) * (0.01 * 255), c2 = (0.03 * 255) * (0.03 * 255);
    double x = moments[0].f32[i], y = moments[1].f32[i];
    double var_x = moments[2].f32[i] - x * x, var_y = moments[3].f32[i] - y * y;
    double cov = moments[4].f32[i] - x * y;
    x += luma_shift;
    y += luma_shift;
    return (2 * x * y + c1) * (2 * cov + c2) /
           ((x * x + y * y + c1) * (fmax(var_x, 0) + fmax(var_y, 0) + c2));
}

enum orl_result orl_metrics_ssim(const struct orl_log *log, const struct orl_image *a,
                                 const struct orl_image *b, double *ssim)
{
    struct orl_image moments[5] = {{0}};
    enum orl_result result = ORL_OK;
    for (int i = 0; i < 5 && result == ORL_OK; i++)
        result = moment(log, a, b, i, &moments[i]);
    if (result == ORL_OK) {
        // Only windows inside the picture count, as in the authors' program. A picture smaller than
        // a window counts as a whole.
        bool small = a->width < SSIM_TAPS || a->height < SSIM_TAPS;
        int border = small ? 0 : SSIM_TAPS / 2;
        double sum = 0, count = 0;
        for (int y = border; y < a->height - border; y++) {
            for (int x = border; x < a->width - border; x++) {
                sum += ssim_at(moments, (size_t)y * (size_t)a->width + (size_t)x);
                count++;
            }
        }
        *ssim = sum / count;
    }
    for (int i = 0; i < 5; i++)
        orl_image_finish(&moments[i]);
    return result;
}

// --- Virtual Rephotography ---

enum { PATCH = 7, SUMS = 6 }; // SUMS: complete pixels, x, y, xx, yy, xy

static int64_t int_luma(const uint8_t *rgb)
{
    return (299 * rgb[0] + 587 * rgb[1] + 114 * rgb[2] + 500) / 1000;
}

static void pixel_terms(const uint8_t *a, const uint8_t *b, int64_t terms[SUMS])
{
    int64_t x = int_luma(a), y = int_luma(b);
    int64_t complete = (a[0] | a[1] | a[2]) != 0;
    const int64_t values[SUMS] = {complete, x, y, x * x, y * y, x * y};
    memcpy(terms, values, sizeof values);
}

// 1 - NCC from a patch's sums, which are exact integers: a flat patch has variance exactly 0.
static double patch_error(const int64_t sums[SUMS])
{
    const int64_t n = (int64_t)PATCH * PATCH;
    int64_t var_x = n * sums[3] - sums[1] * sums[1], var_y = n * sums[4] - sums[2] * sums[2];
    int64_t cov = n * sums[5] - sums[1] * sums[2];
    if (var_x == 0 || var_y == 0)
        return var_x == var_y ? 0 : 1;
    return 1 - (double)cov / sqrt((double)var_x * (double)var_y);
}

// Column sums over PATCH rows slide down, patch sums over PATCH columns slide right.
static enum orl_result measure_rephoto(const struct orl_log *log, const struct orl_image *a,
                                       const struct orl_image *b, struct orl_metrics *metrics)
{
    size_t width = (size_t)a->width;
    int64_t(*columns)[SUMS] = orl_array(log, width, sizeof *columns);
    ORL_TRY_MEMORY(columns);
    double error = 0, patches = 0, complete = 0;
    for (int y = 0; y < a->height; y++) {
        int64_t patch[SUMS] = {0};
        for (size_t x = 0; x < width; x++) {
            size_t i = 3 * ((size_t)y * width + x);
            int64_t in[SUMS], out[SUMS] = {0};
            pixel_terms(a->u8 + i, b->u8 + i, in);
            if (y >= PATCH)
                pixel_terms(a->u8 + i - 3 * width * PATCH, b->u8 + i - 3 * width * PATCH, out);
            complete += (double)in[0];
            for (int k = 0; k < SUMS; k++) {
                columns[x][k] += in[k] - out[k];
                patch[k] += columns[x][k] - (x >= PATCH ? columns[x - PATCH][k] : 0);
            }
            if (y >= PATCH - 1 && x >= PATCH - 1 && patch[0] == (int64_t)PATCH * PATCH) {
                error += patch_error(patch);
                patches++;
            }
        }
    }
    free(columns);
    metrics->completeness = complete / (double)pixel_count(a);
    metrics->ncc_error = patches > 0 ? error / patches : 0;
    return ORL_OK;
}

// --- crumbs ---

enum { CRUMB_REACH = 2 }; // pixels: half of the 5x5 median's window

// How far each pixel stands out of the median of its surroundings, in the square root of luma.
static enum orl_result prominence(const struct orl_log *log, const struct orl_image *image,
                                  struct orl_image *out)
{
    struct orl_image root, median = {0};
    *out = (struct orl_image){0};
    enum orl_result result =
        orl_image_init(log, &root, image->width, image->height, 1, ORL_PIXEL_F32);
    for (size_t i = 0; result == ORL_OK && i < pixel_count(image); i++)
        root.f32[i] = sqrtf(luma(image->u8 + 3 * i) / 255);
    ORL_THEN(result, orl_bridge_median(log, &root, &median));
    if (result == ORL_OK) {
        for (size_t i = 0; i < pixel_count(image); i++)
            root.f32[i] = fabsf(root.f32[i] - median.f32[i]);
        *out = root;
        root = (struct orl_image){0};
    }
    orl_image_finish(&root);
    orl_image_finish(&median);
    return result;
}

static float greatest_near(const struct orl_image *image, int x, int y)
{
    float greatest = 0;
    for (int j = y - CRUMB_REACH; j <= y + CRUMB_REACH; j++)
        for (int i = x - CRUMB_REACH; i <= x + CRUMB_REACH; i++)
            if (i >= 0 && j >= 0 && i < image->width && j < image->height)
                greatest = fmaxf(greatest, image->f32[(size_t)j * (size_t)image->width + (size_t)i]);
    return greatest;
}

// Of the pixels where `part`, F32 x1, is above 0.5; NULL: of all.
static enum orl_result count_crumbs(const struct orl_log *log, const struct orl_image *a,
                                    const struct orl_image *b, const struct orl_image *part,
                                    size_t *count)
{
    const float stands_out = 0.1f, in_photograph = stands_out / 3;
    struct orl_image rendered, photograph = {0};
    size_t crumbs = 0;
    enum orl_result result = prominence(log, a, &rendered);
    ORL_THEN(result, prominence(log, b, &photograph));
    for (int y = 0; result == ORL_OK && y < a->height; y++)
        for (int x = 0; x < a->width; x++) {
            size_t i = (size_t)y * (size_t)a->width + (size_t)x;
            crumbs += (!part || part->f32[i] > 0.5f) && rendered.f32[i] > stands_out &&
                      greatest_near(&photograph, x, y) <= in_photograph;
        }
    *count = crumbs;
    orl_image_finish(&rendered);
    orl_image_finish(&photograph);
    return result;
}

double orl_metrics_psnr_db(const struct orl_image *a, const struct orl_image *b)
{
    double sum = 0;
    for (size_t i = 0; i < pixel_count(a); i++)
        sum += squared_error(&a->u8[3 * i], &b->u8[3 * i]);
    return orl_psnr_db(sum, 3.0 * (double)pixel_count(a), 255);
}

enum orl_result orl_metrics_compare(const struct orl_log *log, const struct orl_image *a,
                                    const struct orl_image *b, const struct orl_image *coverage,
                                    struct orl_metrics *metrics)
{
    memset(metrics, 0, sizeof *metrics);
    ORL_REQUIRE(log, a->data && a->type == ORL_PIXEL_U8 && a->channels == 3);
    ORL_REQUIRE(log, b->data && b->type == ORL_PIXEL_U8 && b->channels == 3);
    ORL_REQUIRE(log, coverage->data && coverage->type == ORL_PIXEL_F32 && coverage->channels == 1);
    if (a->width != b->width || a->height != b->height || coverage->width != a->width ||
        coverage->height != a->height)
        return orl_fail(log, ORL_ERR_ARGUMENT, "pictures of %dx%d and %dx%d cannot be compared",
                        a->width, a->height, b->width, b->height);
    struct orl_metrics measured = {0};
    measure_psnr(a, b, coverage, &measured);
    measured.psnr_cc_db = psnr_after_fit(a, b);
    ORL_TRY(orl_metrics_ssim(log, a, b, &measured.ssim));
    ORL_TRY(measure_rephoto(log, a, b, &measured));
    size_t crumbs = 0;
    ORL_TRY(count_crumbs(log, a, b, NULL, &crumbs));
    measured.crumbs = 1e4 * (double)crumbs / (double)pixel_count(a);
    *metrics = measured;
    return ORL_OK;
}

enum orl_result orl_metrics_of_part(const struct orl_log *log, const struct orl_image *a,
                                    const struct orl_image *b, const struct orl_image *coverage,
                                    const struct orl_image *part, struct orl_part_metrics *metrics)
{
    memset(metrics, 0, sizeof *metrics);
    ORL_REQUIRE(log, part->data && part->type == ORL_PIXEL_F32 && part->width == a->width &&
                         part->height == a->height);
    struct orl_metrics whole = {0};
    size_t shown = 0, covered = 0, crumbs = 0;
    measure_psnr(a, b, part, &whole);
    for (size_t i = 0; i < pixel_count(part); i++) {
        shown += part->f32[i] > 0.5f;
        covered += part->f32[i] > 0.5f && coverage->f32[i] > 0.5f;
    }
    ORL_TRY(count_crumbs(log, a, b, part, &crumbs));
    if (!shown)
        return ORL_OK;
    *metrics = (struct orl_part_metrics){whole.psnr_covered_db, 1e4 * (double)crumbs / (double)shown,
                                         (double)covered / (double)shown};
    return ORL_OK;
}
