#include "eval/radiance_metrics.h"

#include <math.h>
#include <string.h>

#include "eval/metrics.h"

double orl_pu21_encode(double cd_m2)
{
    static const double p[7] = {0.353487901, 0.3734658629, 8.277049286e-05, 0.9062562627,
                                0.09150303166, 0.9099517204, 596.3148142};
    double y = pow(fmin(fmax(cd_m2, 0.005), 10000), p[3]);
    return p[6] * (pow((p[0] + p[1] * y) / (1 + p[2] * y), p[4]) - p[5]);
}

// The mu-law of Kalantari and Ramamoorthi 2017.
static double mu_law(double light)
{
    const double mu = 5000;
    return log1p(mu * fmin(fmax(light, 0), 1)) / log1p(mu);
}

// NaN counts as no light.
static double light_of(float value)
{
    return value > 0 ? (double)value : 0;
}

static double largest(const struct orl_image *image, size_t count)
{
    double most = 0;
    for (size_t i = 0; i < count; i++)
        if (isfinite(image->f32[i]))
            most = fmax(most, (double)image->f32[i]);
    return most;
}

static void measure_psnr(const struct orl_image *a, const struct orl_image *b, size_t count,
                         double most, struct orl_radiance_metrics *metrics)
{
    double pu = 0, mu = 0;
    for (size_t i = 0; i < count; i++) {
        double x = light_of(a->f32[i]), y = light_of(b->f32[i]);
        double pu_error = orl_pu21_encode(x * ORL_RADIANCE_CD_M2) -
                          orl_pu21_encode(y * ORL_RADIANCE_CD_M2);
        double mu_error = mu_law(x / most) - mu_law(y / most);
        pu += pu_error * pu_error;
        mu += mu_error * mu_error;
    }
    // The reference implementation's peak: PU21 maps 0.1 to 100 cd/m2 to about 0 to 256.
    metrics->pu21_psnr_db = orl_psnr_db(pu, (double)count, 256);
    metrics->mu_psnr_db = orl_psnr_db(mu, (double)count, 1);
}

static void measure_log(const struct orl_image *a, const struct orl_image *b,
                        const struct orl_image *coverage, size_t count, double most,
                        struct orl_radiance_metrics *metrics)
{
    double floor = most * 0x1p-20, sum = 0, squares = 0, used = 0;
    for (size_t i = 0; i < count; i++) {
        double truth = light_of(b->f32[i]);
        if (truth < floor || (coverage && !(coverage->f32[i / 3] > 0.5f)))
            continue;
        double error = log2(fmax(light_of(a->f32[i]), floor) / truth);
        sum += error;
        squares += error * error;
        used++;
    }
    double mean = used > 0 ? sum / used : 0, square = used > 0 ? squares / used : 0;
    metrics->log2_rmse = sqrt(square);
    metrics->log2_rmse_fitted = sqrt(fmax(square - mean * mean, 0));
}

enum orl_result orl_radiance_compare(const struct orl_log *log, const struct orl_image *rendered,
                                     const struct orl_image *truth,
                                     const struct orl_image *coverage,
                                     struct orl_radiance_metrics *metrics)
{
    memset(metrics, 0, sizeof *metrics);
    ORL_REQUIRE(log, rendered->data && rendered->type == ORL_PIXEL_F32 && rendered->channels == 3);
    ORL_REQUIRE(log, truth->data && truth->type == ORL_PIXEL_F32 && truth->channels == 3);
    if (rendered->width != truth->width || rendered->height != truth->height ||
        (coverage && (coverage->width != truth->width || coverage->height != truth->height)))
        return orl_fail(log, ORL_ERR_ARGUMENT, "radiance of %dx%d and %dx%d cannot be compared",
                        rendered->width, rendered->height, truth->width, truth->height);
    size_t count = (size_t)truth->width * (size_t)truth->height * 3;
    double most = largest(truth, count);
    if (!(most > 0))
        return orl_fail(log, ORL_ERR_DATA, "the true radiance is black");
    measure_psnr(rendered, truth, count, most, metrics);
    measure_log(rendered, truth, coverage, count, most, metrics);
    return ORL_OK;
}
