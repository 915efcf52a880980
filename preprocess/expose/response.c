#include "preprocess/expose/response.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "core/cholesky.h"
#include "core/color.h"
#include "core/memory.h"
#include "preprocess/expose/robust_fit.h"

enum {
    NODES = 256,       // 8-bit values; 0 is not used, since its logarithm is unbounded
    TERMS = 6,         // of the polynomial
    ITERATIONS = 12,
    TUKEY_ITERATIONS = 2,
    POINTS_MIN = 200,  // least number of points seen at different exposures
    BINS = 16,         // of 8-bit values; samples must cover BINS_MIN of them
    BINS_MIN = 12,
    PER_BIN_MIN = 20,
    VALUE_MAX = 251,   // above it noise clips the brighter samples, which biases the others
    FLOOR_MAX = 64,    // a floor is below this value
};
static const double SAMPLE_SIGMA = 0.1; // of log colour, as in align.c
static const double PAIR_MIN_EV = 0.4;  // least difference of exposure between two observations of
                                        // a point
// Values below the floor rise by less than FLAT_MAX of the difference in exposure to another
// photograph, which is at most FLOOR_EV_MAX darker.
static const double FLAT_MAX = 0.3, FLOOR_EV_MAX = 2.1;
// Weight of the squared second derivative of the curve's logarithm, relative to the samples'
// weight.
static const double SMOOTHNESS = 1e-6;
static const double PULL = 1e-3;        // regularization of the terms: a solution always exists
static const double OFFSET_SIGMA = 0.2; // of a photograph's log exposure from the known value
static const double STRETCH_MAX = 0.03; // of the steps between exposures, which sRGB is forgiven
static const double FIRM = 1e8;         // weight of equality constraints
static const double MUST_GAIN = 0.9;    // greatest ratio of the curve's spread to that of sRGB
// The least rise of log exposure per 8-bit value, which keeps the curve monotone.
static const double RISE_MIN = 1e-4;

struct problem {
    const struct orl_samples *samples;
    const struct orl_exposed *photos;
    int camera;
    struct orl_robust_fit fit; // unknowns: the terms, then an offset of each photograph's log exposure
    float *light;    // log of vignetting times exposure
    double floor;    // 8-bit value; darker values have no weight
    double off[NODES]; // log exposure of the curve minus that of sRGB
    int channel;
    size_t photo_count;
    double *offset;  // of each photograph's log exposure
    double *share;   // of each photograph in the weight of all samples, times photo_count
};

// Is it of the camera, with a known exposure?
static bool counts(const struct problem *p, size_t photo)
{
    return p->photos[photo].camera == p->camera && p->photos[photo].known;
}

static double vignetting(const float v[3], double r2)
{
    return fmax(1 + r2 * ((double)v[0] + r2 * ((double)v[1] + r2 * (double)v[2])), 0.05);
}

// The nodes around a value, and the weight of the upper node.
static size_t node_of(double value, double *upper)
{
    double at = fmin(fmax(value, 1), NODES - 1);
    size_t node = (size_t)at;
    node = node < NODES - 2 ? node : NODES - 2;
    *upper = at - (double)node;
    return node;
}

// Log exposure of sRGB.
static double srgb_at(double value)
{
    return log((double)orl_srgb_decode((float)value / 255));
}

static double curve_at(const struct problem *p, double value)
{
    double u;
    size_t n = node_of(value, &u);
    return srgb_at(value) + (1 - u) * p->off[n] + u * p->off[n + 1];
}

static bool is_usable(const struct problem *p, const struct orl_observation *item)
{
    double value = (double)item->value[p->channel];
    return counts(p, item->photo) && !(item->clipped & 1u << p->channel) && value >= 2 &&
           value <= VALUE_MAX;
}

// The same point's observation at the next lower exposure; NULL: none is low enough.
static const struct orl_observation *darker(const struct problem *p, size_t begin, size_t end,
                                            const struct orl_observation *item)
{
    const struct orl_observation *best = NULL;
    double ev = p->photos[item->photo].ev;
    for (size_t i = begin; i < end; i++) {
        const struct orl_observation *other = &p->samples->items[i];
        double less = ev - p->photos[other->photo].ev;
        if (is_usable(p, other) && less >= PAIR_MIN_EV && less <= FLOOR_EV_MAX &&
            (!best || p->photos[other->photo].ev > p->photos[best->photo].ev))
            best = other;
    }
    return best;
}

// Where black is not 0 (scans of film, stray light), dark values hardly follow exposure. Counts
// samples by value: all of them, and those that do not follow exposure.
static void count_flat(const struct problem *p, size_t flat[NODES], size_t all[NODES])
{
    for (size_t point = 0; point < p->samples->point_count; point++) {
        size_t begin = p->samples->first[point], end = p->samples->first[point + 1];
        for (size_t i = begin; i < end; i++) {
            const struct orl_observation *item = &p->samples->items[i], *other = NULL;
            if (is_usable(p, item) && item->value[p->channel] < FLOOR_MAX)
                other = darker(p, begin, end, item);
            if (!other)
                continue;
            double value = (double)item->value[p->channel];
            double ratio = (double)orl_srgb_decode((float)value / 255) /
                           (double)orl_srgb_decode(other->value[p->channel] / 255);
            double ev = p->photos[item->photo].ev - p->photos[other->photo].ev;
            all[(size_t)value]++;
            flat[(size_t)value] += log2(ratio) < FLAT_MAX * ev;
        }
    }
}

// The largest dark value that does not follow exposure yet; 0: all values do.
static double find_floor(const struct problem *p)
{
    size_t flat[NODES] = {0}, all[NODES] = {0}, flat_sum = 0, sum = 0;
    double floor = 0;
    count_flat(p, flat, all);
    for (size_t v = 0; v < FLOOR_MAX; v++) {
        flat_sum += flat[v];
        sum += all[v];
        if (sum < PER_BIN_MIN)
            continue;
        if (4 * flat_sum < sum)
            break;
        floor = (double)v;
        flat_sum = sum = 0;
    }
    return floor;
}

// Chooses points whose exposures differ enough to constrain the curve. Returns their number.
static size_t choose(struct problem *p)
{
    size_t points = 0;
    p->floor = find_floor(p);
    for (size_t point = 0; point < p->samples->point_count; point++) {
        size_t begin = p->samples->first[point], end = p->samples->first[point + 1];
        double least = INFINITY, most = -INFINITY;
        for (size_t i = begin; i < end; i++) {
            const struct orl_observation *item = &p->samples->items[i];
            if (!counts(p, item->photo))
                continue;
            least = fmin(least, p->photos[item->photo].ev);
            most = fmax(most, p->photos[item->photo].ev);
        }
        bool differ = most - least >= PAIR_MIN_EV;
        points += differ;
        for (size_t i = begin; i < end; i++) {
            const struct orl_observation *item = &p->samples->items[i];
            const struct orl_exposed *photo = &p->photos[item->photo];
            double value = (double)item->value[p->channel] - p->floor, slope;
            p->fit.sigma[i] = INFINITY;
            p->light[i] = (float)(M_LN2 * photo->ev +
                                  log(vignetting(photo->vignette, (double)item->r2)));
            if (!differ || !is_usable(p, item) || value < 2)
                continue;
            slope = log((double)orl_srgb_decode((float)(value + 1) / 255) /
                        (double)orl_srgb_decode((float)(value - 1) / 255)) / 2;
            p->fit.sigma[i] = (float)sqrt(SAMPLE_SIGMA * SAMPLE_SIGMA + slope * slope);
        }
    }
    return points;
}

static bool spans(const struct problem *p)
{
    size_t bins[BINS] = {0};
    int full = 0;
    for (size_t i = 0; i < p->samples->count; i++)
        if (isfinite(p->fit.sigma[i]))
            bins[(int)(p->samples->items[i].value[p->channel] * BINS / 256)]++;
    for (int b = 0; b < BINS; b++)
        full += bins[b] >= PER_BIN_MIN;
    return full >= BINS_MIN;
}

static void set_residuals(struct problem *p)
{
    for (size_t i = 0; i < p->samples->count; i++)
        if (isfinite(p->fit.sigma[i])) {
            double value = (double)p->samples->items[i].value[p->channel];
            p->fit.residual[i] = (float)(curve_at(p, value) - (double)p->light[i] -
                                         p->offset[p->samples->items[i].photo]);
        }
    orl_robust_center(&p->fit);
}

// Chebyshev polynomials of degree 1 to TERMS, with 0 to 255 mapped to their range.
static void terms_at(double value, double t[TERMS])
{
    double x = 2 * value / (NODES - 1) - 1, before = 1, now = x;
    for (int k = 0; k < TERMS; k++) {
        double next = 2 * x * now - before;
        t[k] = now;
        before = now;
        now = next;
    }
}

static void set_equation(const void *problem, size_t i, struct orl_equation *equation)
{
    const struct problem *p = problem;
    const struct orl_observation *item = &p->samples->items[i];
    double value = (double)item->value[p->channel], t[TERMS];
    terms_at(value, t);
    equation->value = srgb_at(value) - (double)p->light[i];
    for (size_t k = 0; k < TERMS; k++)
        orl_equation_add(equation, k, t[k]);
    orl_equation_add(equation, TERMS + item->photo, -1);
}

// Adds the integral of the squared second derivative over [0, 1].
static void add_smoothness(double *a, size_t n, double weight)
{
    enum { STEPS = 64 };
    for (int i = 1; i < STEPS; i++) {
        double h = 1.0 / STEPS, below[TERMS], here[TERMS], above[TERMS];
        terms_at((i - 1) * h * (NODES - 1), below);
        terms_at(i * h * (NODES - 1), here);
        terms_at((i + 1) * h * (NODES - 1), above);
        for (size_t k = 0; k < TERMS; k++)
            for (size_t m = 0; m < TERMS; m++)
                a[k * n + m] += weight * h * (below[k] - 2 * here[k] + above[k]) *
                                (below[m] - 2 * here[m] + above[m]) / (h * h * h * h);
    }
}

static double mean_ev(const struct problem *p)
{
    double mean = 0, total = 0;
    for (size_t i = 0; i < p->photo_count; i++) {
        mean += p->share[i] * p->photos[i].ev;
        total += p->share[i];
    }
    return mean / total;
}

// How much longer the steps between exposures are by the offsets than known.
static double stretch_of(const struct problem *p)
{
    double mean = mean_ev(p), along = 0, all = 0;
    for (size_t i = 0; i < p->photo_count; i++) {
        double ev = p->photos[i].ev - mean;
        along += counts(p, i) ? p->share[i] * ev * p->offset[i] : 0;
        all += counts(p, i) ? p->share[i] * ev * ev : 0;
    }
    return all > 0 ? along / all : 0;
}

// Constrains the offsets so that they neither shift nor, unless that is allowed, stretch the known
// exposures: a stretch of the exposures and of the curve's exponent together would fit as well.
// Photographs are weighted by their samples (`share`, with mean 1); otherwise nearly black ones would
// compensate for a stretch of the rest.
static void add_offsets(const struct problem *p, bool stretches, double *a, size_t n)
{
    const double *share = p->share;
    double mean = mean_ev(p), firm = stretches ? 0 : 1;
    for (size_t i = 0; i < p->photo_count; i++) {
        a[(TERMS + i) * n + TERMS + i] += counts(p, i) ? 1 / (OFFSET_SIGMA * OFFSET_SIGMA) : 1;
        for (size_t k = 0; k < p->photo_count; k++)
            if (counts(p, i) && counts(p, k))
                a[(TERMS + i) * n + TERMS + k] +=
                    FIRM * share[i] * share[k] *
                    (1 + firm * (p->photos[i].ev - mean) * (p->photos[k].ev - mean));
    }
}

// Returns the weight of all samples.
static double set_shares(struct problem *p)
{
    double *share = p->share, total = 0;
    memset(share, 0, p->photo_count * sizeof *share);
    for (size_t i = 0; i < p->samples->count; i++) {
        share[p->samples->items[i].photo] += orl_robust_weight(&p->fit, i);
        total += orl_robust_weight(&p->fit, i);
    }
    for (size_t i = 0; i < p->photo_count; i++)
        share[i] *= (double)p->photo_count / total;
    return total;
}

// What is unknown besides the offsets: the curve; nothing, for sRGB; how much exposures are stretched.
enum unknown { CURVE, SRGB, SRGB_STRETCHED };

// Solves once.
static bool step(struct problem *p, enum unknown unknown)
{
    size_t n = TERMS + p->photo_count;
    double t[TERMS], *a = p->fit.matrix, *b = p->fit.x;
    orl_robust_equations(&p->fit, n, p, set_equation);
    add_smoothness(a, n, SMOOTHNESS * set_shares(p));
    add_offsets(p, unknown == SRGB_STRETCHED, a, n);
    for (size_t k = 0; k < TERMS; k++)
        a[k * n + k] += unknown == CURVE ? PULL : FIRM * FIRM;
    if (!orl_cholesky_solve(a, b, n))
        return false;
    for (size_t v = 0; v < NODES; v++) {
        terms_at((double)v, t);
        p->off[v] = 0;
        for (int k = 0; k < TERMS; k++)
            p->off[v] += b[k] * t[k];
    }
    memcpy(p->offset, b + TERMS, p->photo_count * sizeof *b);
    return true;
}

// Converts the curve to linear light, monotone, with 1 at 255.
static void finish_curve(const struct problem *p, float linear[256])
{
    double g[NODES];
    for (size_t v = 1; v < NODES; v++)
        g[v] = srgb_at((double)v) + p->off[v];
    // Starts from the middle, where the samples constrain the curve best.
    for (size_t v = NODES / 2 + 1; v < NODES; v++)
        g[v] = fmax(g[v], g[v - 1] + RISE_MIN);
    for (size_t v = NODES / 2 - 1; v > 0; v--)
        g[v] = fmin(g[v], g[v + 1] - RISE_MIN);
    linear[0] = 0;
    for (size_t v = 1; v < NODES; v++)
        linear[v] = (float)exp(g[v] - g[NODES - 1]);
    linear[NODES - 1] = 1;
}

// Iteratively reweighted least squares. *spread_ev: the spread of the residuals.
static bool iterate(struct problem *p, enum unknown unknown, double *spread_ev)
{
    orl_robust_reset(&p->fit);
    set_residuals(p);
    for (int i = 0; i < ITERATIONS; i++) {
        orl_robust_reweigh(&p->fit, i >= ITERATIONS - TUKEY_ITERATIONS, 0.05);
        if (!step(p, unknown))
            return false;
        set_residuals(p);
    }
    orl_robust_reset(&p->fit);
    set_residuals(p);
    *spread_ev = orl_robust_spread(&p->fit, false) / M_LN2;
    return true;
}

// The spread of the residuals by a curve that has been found in another way, in EV.
static double judge_curve(struct problem *p, const float linear[256])
{
    for (size_t v = 1; v < NODES; v++)
        p->off[v] = log(fmax((double)linear[v], 1e-9)) - srgb_at((double)v);
    p->off[0] = p->off[1];
    memset(p->offset, 0, p->photo_count * sizeof *p->offset);
    orl_robust_reset(&p->fit);
    set_residuals(p);
    return orl_robust_spread(&p->fit, false) / M_LN2;
}

// Fits sRGB. Shutter times are told as 1/60 where they are 1/64: a stretch of the exposures by so little
// says nothing against sRGB.
static bool fit_srgb(struct problem *p, double *spread_ev)
{
    return iterate(p, SRGB_STRETCHED, spread_ev) &&
           (fabs(stretch_of(p)) <= STRETCH_MAX || iterate(p, SRGB, spread_ev));
}

// linear: in: the curve, unless it is to be found here.
static enum orl_result fit_channel(const struct orl_log *log, struct problem *p, bool finds, int channel,
                                   float linear[256], struct orl_response_fit *fit)
{
    p->channel = channel;
    memset(p->off, 0, sizeof p->off);
    memset(p->offset, 0, p->photo_count * sizeof *p->offset);
    fit->points = choose(p);
    if (fit->points < POINTS_MIN || !spans(p)) {
        fit->outcome = ORL_RESPONSE_FEW_SAMPLES;
        return ORL_OK;
    }
    double srgb = 0, found = 0;
    if (!fit_srgb(p, &srgb) || (finds && !iterate(p, CURVE, &found)))
        return orl_fail(log, ORL_ERR_DATA, "the response curve has no solution");
    if (!finds)
        found = judge_curve(p, linear);
    fit->spread_srgb_ev += srgb / 3;
    fit->spread_ev += found / 3;
    finish_curve(p, linear);
    return ORL_OK;
}

static double exposure_range(const struct problem *p)
{
    double least = INFINITY, most = -INFINITY;
    for (size_t i = 0; i < p->samples->count; i++) {
        uint32_t photo = p->samples->items[i].photo;
        if (counts(p, photo)) {
            least = fmin(least, p->photos[photo].ev);
            most = fmax(most, p->photos[photo].ev);
        }
    }
    return most - least;
}

static void set_srgb(struct orl_response *response)
{
    for (int c = 0; c < 3; c++)
        for (int v = 0; v < 256; v++)
            response->linear[c][v] = orl_srgb_decode((float)v / 255);
}

enum orl_result orl_response_fit(const struct orl_log *log, enum orl_response_method method,
                                 const struct orl_samples *samples,
                                 const struct orl_exposed *photos, size_t photo_count, int camera,
                                 struct orl_response *response, struct orl_response_fit *fit)
{
    memset(fit, 0, sizeof *fit);
    set_srgb(response);
    fit->outcome = ORL_RESPONSE_ONE_EXPOSURE;
    struct problem p = {.samples = samples, .photos = photos, .photo_count = photo_count, .camera = camera};
    if (!(exposure_range(&p) >= ORL_RESPONSE_RANGE_EV))
        return ORL_OK;
    fit->outcome = ORL_RESPONSE_FOUND;
    enum orl_result result = orl_robust_init(log, samples, TERMS + photo_count, &p.fit);
    p.light = orl_array(log, samples->count, sizeof *p.light);
    p.offset = orl_array(log, photo_count, 2 * sizeof *p.offset);
    if (!p.light || !p.offset)
        result = ORL_ERR_MEMORY;
    else
        p.share = p.offset + photo_count;
    bool finds = method == ORL_RESPONSE_POLYNOMIAL;
    bool is_found = false;
    if (result == ORL_OK && !finds)
        result = orl_response_opencv(log, method, samples, photos, photo_count, camera, response->linear,
                                     &is_found);
    if (!finds && !is_found)
        fit->outcome = ORL_RESPONSE_FEW_SAMPLES;
    for (int c = 0; result == ORL_OK && c < 3 && fit->outcome == ORL_RESPONSE_FOUND; c++)
        result = fit_channel(log, &p, finds, c, response->linear[c], fit);
    if (finds && fit->outcome == ORL_RESPONSE_FOUND && fit->spread_ev > MUST_GAIN * fit->spread_srgb_ev)
        fit->outcome = ORL_RESPONSE_SRGB;
    if (result != ORL_OK || fit->outcome != ORL_RESPONSE_FOUND)
        set_srgb(response);
    orl_robust_finish(&p.fit);
    free(p.light);
    free(p.offset);
    return result;
}
