#include "preprocess/expose/align.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "core/cholesky.h"
#include "core/color.h"
#include "core/memory.h"
#include "preprocess/expose/robust_fit.h"

enum {
    ITERATIONS = 6,
    TUKEY_ITERATIONS = 2, // the last iterations, which give outliers weight 0
    ROUNDS = 3,           // fits, each without the photographs that were refused
    SAMPLES_MIN = 20,     // fewer observations cannot determine a photograph's gain
    LENS_PHOTOS_MIN = 3,  // fewer photographs cannot separate the lens from the scene
    LENS_TERMS = 3,
};
// Standard deviation of a sample's log colour from gloss and misregistration, without noise.
static const double SAMPLE_SIGMA = 0.1;
// Least standard deviation of a photograph's gain, however many samples it shares.
static const double GAIN_SIGMA = 0.02;
// A camera that processes each photograph by its content stays within this of what EXIF tells.
static const double UNLIKE_EV = 1;
// Standard deviation of EXIF exposures, and of the gains of photographs of unknown exposure.
static const double EXPOSURE_SIGMA_EV = 0.3, UNKNOWN_SIGMA_EV = 1;
// Greatest plausible difference from the known exposure, and of a channel's gain from the mean.
static const double LIMIT_EV = 2, COLOUR_LIMIT_EV = 1;

// --- the problem: log colour + log gain - log vignetting is equal for all observations of a point ---

struct lens {
    size_t photos;
    double terms[LENS_TERMS]; // found so far: log vignetting = sum of terms[k] r^(2 k + 2)
};

struct problem {
    const struct orl_log *log;
    const struct orl_samples *samples;
    struct orl_exposed *photos;
    size_t photo_count, all_count, lens_count;
    struct orl_robust_fit fit; // unknowns: log gain of each photograph, LENS_TERMS of each lens
    int channel;
    bool with_lens;
    float (*value)[4]; // log of linear colour: r g b and their mean; per observation
    double centre_ev;  // of the known exposures
    struct lens *lenses;
};

static double lens_log(const double terms[LENS_TERMS], double r2)
{
    return r2 * (terms[0] + r2 * (terms[1] + r2 * terms[2]));
}

static void set_equation(const void *problem, size_t i, struct orl_equation *equation)
{
    const struct problem *p = problem;
    const struct orl_observation *item = &p->samples->items[i];
    int lens = p->photos[item->photo].lens;
    double r2 = (double)item->r2, power = 1;
    equation->value = (double)(p->value[i][p->channel] - (float)lens_log(p->lenses[lens].terms, r2));
    orl_equation_add(equation, item->photo, 1);
    for (size_t k = 0; p->with_lens && k < LENS_TERMS; k++) {
        power *= r2;
        orl_equation_add(equation, p->photo_count + LENS_TERMS * (size_t)lens + k, -power);
    }
}

// Writes, for every observation, the residual from its point's mean.
static void residuals(struct problem *p)
{
    for (size_t i = 0; i < p->samples->count; i++) {
        struct orl_equation equation;
        double sum = 0;
        equation.count = 0;
        set_equation(p, i, &equation);
        for (int k = 0; k < equation.count; k++)
            sum += equation.factor[k] * p->fit.x[equation.index[k]];
        p->fit.residual[i] = (float)equation.value + (float)sum;
    }
    orl_robust_center(&p->fit);
}

// scale: of the samples' weight, against what is known without them.
static bool step(struct problem *p, double scale)
{
    size_t n = p->photo_count + (p->with_lens ? LENS_TERMS * p->lens_count : 0);
    double *x = p->fit.x;
    orl_robust_equations(&p->fit, n, p, set_equation);
    for (size_t i = 0; i < p->photo_count; i++) {
        const struct orl_exposed *photo = &p->photos[i];
        double sigma = M_LN2 * (photo->known ? EXPOSURE_SIGMA_EV : UNKNOWN_SIGMA_EV);
        double precision = 1 / (sigma * sigma) / scale;
        p->fit.matrix[i * n + i] += precision;
        x[i] += precision * (photo->known ? -M_LN2 * (photo->ev - p->centre_ev) : 0);
    }
    for (size_t i = p->photo_count; i < n; i++)
        p->fit.matrix[i * n + i] +=
            (p->lenses[(i - p->photo_count) / LENS_TERMS].photos < LENS_PHOTOS_MIN ? 1e12 : 1) / scale;
    return orl_cholesky_solve(p->fit.matrix, x, n);
}

// Solves by iteratively reweighted least squares. The unknowns are left in p->fit.x.
static enum orl_result fit(struct problem *p, int channel, bool with_lens)
{
    double information = 0;
    p->channel = channel;
    p->with_lens = with_lens;
    orl_robust_reset(&p->fit);
    for (size_t i = 0; i < p->samples->count; i++)
        information += orl_robust_weight(&p->fit, i);
    double limit = (double)p->photo_count / (GAIN_SIGMA * GAIN_SIGMA);
    double scale = information > limit ? limit / information : 1;
    for (int i = 0; i < ITERATIONS; i++) {
        if (!step(p, scale))
            return orl_fail(p->log, ORL_ERR_DATA, "photographs cannot be aligned: no solution");
        residuals(p);
        orl_robust_reweigh(&p->fit, i + 1 >= ITERATIONS - TUKEY_ITERATIONS, 0.1);
    }
    return ORL_OK;
}

// --- vignetting ---

// True when the light falls off by a plausible amount as far out as there are samples.
static bool is_lens(const double terms[LENS_TERMS], double r2_max)
{
    double last = 0;
    for (int i = 1; i <= 32; i++) {
        double now = lens_log(terms, r2_max * i / 32);
        if (now > last + 0.003 || now < -2)
            return false;
        last = now;
    }
    return true;
}

// Fits exp(sum of terms[k] r^(2k+2)) by 1 + v0 r^2 + v1 r^4 + v2 r^6 in least squares. Beyond the
// outermost sample, the vignetting stays constant.
static void to_polynomial(const double terms[LENS_TERMS], double r2_max, float v[3])
{
    double a[9] = {0}, b[3] = {0};
    for (int i = 1; i <= 64; i++) {
        double r2 = i / 64.0, power[3] = {r2, r2 * r2, r2 * r2 * r2};
        double light = exp(lens_log(terms, fmin(r2, r2_max)));
        for (int j = 0; j < 3; j++) {
            b[j] += power[j] * (light - 1);
            for (int k = 0; k < 3; k++)
                a[3 * j + k] += power[j] * power[k];
        }
    }
    bool ok = orl_cholesky_solve(a, b, 3);
    for (int k = 0; k < 3; k++)
        v[k] = ok ? (float)b[k] : 0;
}

static double farthest(const struct problem *p, size_t lens)
{
    float r2 = 0;
    for (size_t i = 0; i < p->samples->count; i++)
        if ((size_t)p->photos[p->samples->items[i].photo].lens == lens && isfinite(p->fit.sigma[i]))
            r2 = fmaxf(r2, p->samples->items[i].r2);
    return (double)r2;
}

static enum orl_result fit_lenses(struct problem *p)
{
    enum orl_result result = fit(p, 3, false);
    double before = orl_robust_spread(&p->fit, false);
    ORL_THEN(result, fit(p, 3, true));
    // Vignetting that explains less than a hundredth of the spread is rejected as noise.
    if (result != ORL_OK || orl_robust_spread(&p->fit, false) > 0.99 * before)
        return result;
    for (size_t k = 0; k < p->lens_count; k++) {
        const double *terms = p->fit.x + p->photo_count + LENS_TERMS * k;
        double r2_max = farthest(p, k);
        float vignette[3];
        if (!(r2_max > 0.3) || !is_lens(terms, r2_max))
            continue;
        memcpy(p->lenses[k].terms, terms, sizeof p->lenses[k].terms);
        to_polynomial(terms, r2_max, vignette);
        for (size_t i = 0; i < p->all_count; i++)
            if ((size_t)p->photos[i].lens == k)
                memcpy(p->photos[i].vignette, vignette, sizeof vignette);
    }
    return ORL_OK;
}

// --- gains ---

// Linear light of a value between two 8-bit values.
static double decode(const float *linear, float value)
{
    if (!linear)
        return (double)orl_srgb_decode(value / 255);
    int below = (int)value;
    below = below < 0 ? 0 : below > 254 ? 254 : below;
    float part = value - (float)below;
    return (double)(linear[below] + part * (linear[below + 1] - linear[below]));
}

static void set_values(struct problem *p)
{
    for (size_t i = 0; i < p->samples->count; i++) {
        const struct orl_observation *item = &p->samples->items[i];
        const struct orl_exposed *photo = &p->photos[item->photo];
        double noise = item->clipped ? INFINITY : 0;
        p->value[i][3] = 0;
        p->fit.sigma[i] = INFINITY;
        for (int c = 0; c < 3 && !item->clipped; c++) {
            const float *curve = photo->linear ? photo->linear[c] : NULL;
            double light = decode(curve, item->value[c]);
            if (!(light > 1e-6)) {
                noise = INFINITY;
                break;
            }
            // Relative noise, from the steps of the 8-bit values; it is largest in the dark.
            double more = decode(curve, fminf(item->value[c] + 1, 255));
            noise = fmax(noise, (more - light) / light);
            p->value[i][c] = (float)log(light);
            p->value[i][3] += p->value[i][c] / 3;
        }
        if (!photo->refused && isfinite(noise))
            p->fit.sigma[i] = (float)sqrt(SAMPLE_SIGMA * SAMPLE_SIGMA + noise * noise);
    }
}

static double mean_ev(const struct problem *p)
{
    double sum = 0, count = 0;
    for (size_t i = 0; i < p->photo_count; i++)
        if (p->photos[i].known) {
            sum += p->photos[i].ev;
            count++;
        }
    return count > 0 ? sum / count : 0;
}

// Shifts the channel's gains so that known exposures are undone on average.
static void set_gains(struct problem *p, int channel)
{
    double shift = 0, count = 0;
    bool any = false;
    for (size_t i = 0; i < p->photo_count; i++)
        any = any || p->photos[i].known;
    for (size_t i = 0; i < p->photo_count; i++)
        if ((p->photos[i].known || !any) && !p->photos[i].refused) {
            shift -= p->fit.x[i] + (any ? M_LN2 * p->photos[i].ev : 0);
            count++;
        }
    shift = count > 0 ? shift / count : 0;
    for (size_t i = 0; i < p->photo_count; i++)
        p->photos[i].gain[channel] = (float)exp(p->fit.x[i] + shift);
}

static void count_samples(struct problem *p)
{
    for (size_t i = 0; i < p->photo_count; i++)
        p->photos[i].samples = 0;
    for (size_t i = 0; i < p->samples->count; i++)
        p->photos[p->samples->items[i].photo].samples += isfinite(p->fit.sigma[i]);
}

static double mean_gain_ev(const struct orl_exposed *photo)
{
    double mean = 0;
    for (int c = 0; c < 3; c++)
        mean += log2((double)photo->gain[c]) / 3;
    return mean;
}

static bool is_plausible(const struct orl_exposed *photo)
{
    double mean = mean_gain_ev(photo);
    for (int c = 0; c < 3; c++)
        if (!(fabs(log2((double)photo->gain[c]) - mean) <= COLOUR_LIMIT_EV))
            return false;
    // A photograph of unknown exposure may differ from the reference by twice the limit.
    return fabs(mean + (photo->known ? photo->ev : 0)) <= (photo->known ? 1 : 2) * LIMIT_EV;
}

// Refuses implausible gains and returns true when it refused another photograph. A photograph
// without samples has the gain of its prior.
static bool refuse(struct problem *p)
{
    bool again = false;
    for (size_t i = 0; i < p->photo_count; i++) {
        struct orl_exposed *photo = &p->photos[i];
        if (photo->refused || photo->samples < SAMPLES_MIN)
            continue;
        photo->off_ev = photo->known ? fabs(mean_gain_ev(photo) + photo->ev) : 0;
        if (!is_plausible(photo))
            again = photo->refused = true;
    }
    return again;
}

static void fall_back(struct problem *p)
{
    for (size_t i = 0; i < p->photo_count; i++) {
        struct orl_exposed *photo = &p->photos[i];
        for (int c = 0; c < 3; c++)
            if (photo->refused || photo->samples < SAMPLES_MIN)
                photo->gain[c] = photo->known ? (float)exp2(-photo->ev) : 1;
    }
}

static enum orl_result solve_all(struct problem *p, struct orl_alignment *alignment)
{
    enum orl_result result = ORL_OK;
    bool again = true;
    p->centre_ev = mean_ev(p);
    for (int round = 0; result == ORL_OK && again && round < ROUNDS; round++) {
        set_values(p);
        count_samples(p);
        if (round == 0) {
            p->channel = 3;
            orl_robust_reset(&p->fit);
            residuals(p);
            alignment->spread_before_ev = orl_robust_spread(&p->fit, false) / M_LN2;
            result = fit_lenses(p);
        }
        for (int c = 0; result == ORL_OK && c < 4; c++) {
            result = fit(p, c, false);
            if (result == ORL_OK && c < 3)
                set_gains(p, c);
        }
        again = result == ORL_OK && refuse(p);
    }
    if (result == ORL_OK) {
        alignment->spread_after_ev = orl_robust_spread(&p->fit, false) / M_LN2;
        fall_back(p);
    }
    return result;
}

static enum orl_result count_lenses(struct problem *p)
{
    for (size_t i = 0; i < p->photo_count; i++)
        p->lens_count = (size_t)p->photos[i].lens >= p->lens_count ? (size_t)p->photos[i].lens + 1 : p->lens_count;
    p->lenses = orl_array(p->log, p->lens_count, sizeof *p->lenses);
    ORL_TRY_MEMORY(p->lenses);
    for (size_t i = 0; i < p->photo_count; i++)
        p->lenses[p->photos[i].lens].photos++;
    return ORL_OK;
}

enum orl_result orl_align(const struct orl_log *log, const struct orl_samples *samples,
                          struct orl_exposed *photos, size_t photo_count, size_t all_count,
                          struct orl_alignment *alignment)
{
    memset(alignment, 0, sizeof *alignment);
    struct problem p = {.log = log, .samples = samples, .photos = photos, .photo_count = photo_count,
                        .all_count = all_count, .value = orl_array(log, samples->count, sizeof *p.value)};
    for (size_t i = 0; i < all_count; i++) {
        photos[i].refused = false;
        photos[i].off_ev = 0;
        memset(photos[i].vignette, 0, sizeof photos[i].vignette);
    }
    enum orl_result result = p.value ? count_lenses(&p) : ORL_ERR_MEMORY;
    ORL_THEN(result, orl_robust_init(log, samples, photo_count + LENS_TERMS * p.lens_count, &p.fit));
    ORL_THEN(result, solve_all(&p, alignment));
    orl_robust_finish(&p.fit);
    free(p.value);
    free(p.lenses);
    return result;
}

bool orl_align_contradicts(const struct orl_exposed *photos, size_t count)
{
    size_t known = 0, unlike = 0;
    for (size_t i = 0; i < count; i++) {
        known += photos[i].known;
        unlike += photos[i].known && photos[i].off_ev > UNLIKE_EV;
    }
    return unlike > 0 && 4 * unlike >= known;
}
