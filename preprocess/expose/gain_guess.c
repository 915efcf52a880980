#include "preprocess/expose/gain_guess.h"

#include <math.h>
#include <stdint.h>

// A guess is used only when its error is less than this fraction of the error without a guess.
// Exposures need only be better: a camera measured them, and a few photographs whose processing
// differs tell little against that.
static const double MUST_GAIN = 0.8;
// The same for metering against the best other guess or, if that is less, what any guess must reach. It asks for more,
// because the light of a rendering is not quite that of the photograph, and a camera set by hand does not follow it.
static const double METERING_MUST_GAIN = 2.0 / 3;

// What all guesses are made from.
struct known {
    const struct orl_exposed *aligned;
    size_t count;
    const uint32_t *shared, *own;
};

static bool is_metered(enum orl_gain_guess guess)
{
    return guess == ORL_GUESS_METER || guess == ORL_GUESS_METER_NEAR;
}

static bool is_exposed(enum orl_gain_guess guess)
{
    return guess == ORL_GUESS_EXPOSURE || guess == ORL_GUESS_BOTH;
}

// An exposure that is estimated from the scene tells nothing that gains do not.
static bool is_told(const struct orl_exposed *photo)
{
    return photo->known && photo->from != ORL_EXPOSURE_SCENE;
}

// Weights nearby views, and views that share much of their content: automatic exposure and white
// balance follow the content, and vignetting and gloss change slowly with position.
static double weight(const struct orl_exposed *a, const struct orl_exposed *b,
                     uint32_t shared, uint32_t own)
{
    double squared = 1e-12, common = (1.0 + shared) / (1.0 + own), from[3], to[3];
    orl_pose_centre(&a->view.cam_from_world, from);
    orl_pose_centre(&b->view.cam_from_world, to);
    for (int i = 0; i < 3; i++)
        squared += (from[i] - to[i]) * (from[i] - to[i]);
    return common * common / squared;
}

// Mean light of the aligned views but `left_out`, and the slope of the gains over the light by least
// squares, in stops per stop: 1 for a camera that always reaches the same brightness, 0 for a fixed
// exposure.
static void fit_metering(const struct known *known, size_t left_out, double metering[2])
{
    double n = 0, light = 0, gain = 0, lights = 0, both = 0;
    for (size_t k = 0; k < known->count; k++) {
        const struct orl_exposed *view = &known->aligned[k];
        if (k == left_out)
            continue;
        double stops = 0;
        for (int c = 0; c < 3; c++)
            stops += log2((double)view->gain[c]) / 3;
        n++;
        light += view->light;
        gain += stops;
        lights += view->light * view->light;
        both += view->light * stops;
    }
    double spread = lights - light * light / fmax(n, 1);
    metering[0] = spread > 1e-9 ? fmin(fmax((both - light * gain / n) / spread, 0), 1) : 0;
    metering[1] = light / fmax(n, 1);
}

// log2 of the gain of view `number`. If the view is one of the aligned ones, its own gain is left
// out. metering: see fit_metering.
static void guess_one(enum orl_gain_guess guess, const struct known *known,
                      const struct orl_exposed *view, size_t number, const double metering[2],
                      double gain[3])
{
    bool uses_ev = is_exposed(guess) && is_told(view);
    bool uses_others = is_metered(guess) || guess == ORL_GUESS_NEIGHBOURS ||
                       guess == ORL_GUESS_BOTH;
    double slope = is_metered(guess) ? metering[0] : 0, total = 0, sum[3] = {0};
    for (size_t k = 0; uses_others && k < known->count; k++) {
        const struct orl_exposed *other = &known->aligned[k];
        if (k == number || (uses_ev && !is_told(other)))
            continue;
        double w = guess == ORL_GUESS_METER ? 1
                   : weight(view, other, known->shared[number * known->count + k],
                            known->own[number]);
        double expected = slope * (other->light - metering[1]) - (uses_ev ? other->ev : 0);
        total += w;
        for (int c = 0; c < 3; c++)
            sum[c] += w * (log2((double)other->gain[c]) - expected);
    }
    for (int c = 0; c < 3; c++)
        gain[c] = (total > 0 ? sum[c] / total : 0) - (uses_ev ? view->ev : 0);
}

static double error_of(enum orl_gain_guess guess, const struct known *known)
{
    double squares = 0;
    for (size_t i = 0; i < known->count; i++) {
        const struct orl_exposed *view = &known->aligned[i];
        double gain[3], metering[2] = {0};
        if (is_metered(guess))
            fit_metering(known, i, metering);
        guess_one(guess, known, view, i, metering, gain);
        double brighter = metering[0] * (view->light - metering[1]);
        for (int c = 0; c < 3; c++)
            squares += pow(gain[c] + brighter - log2((double)view->gain[c]), 2);
    }
    return sqrt(squares);
}

static enum orl_gain_guess best_guess(const struct known *known)
{
    bool all_known = true;
    for (size_t i = 0; i < known->count; i++)
        all_known = all_known && is_told(&known->aligned[i]);
    enum orl_gain_guess best = ORL_GUESS_REFERENCE;
    double reference = error_of(best, known), limit = reference;
    for (int g = ORL_GUESS_NEIGHBOURS; g <= ORL_GUESS_METER_NEAR; g++) {
        enum orl_gain_guess guess = (enum orl_gain_guess)g;
        bool exposed = is_exposed(guess), turns = is_metered(guess) && !is_metered(best);
        if (exposed && !all_known)
            continue;
        double error = error_of(guess, known);
        double most = exposed ? limit : fmin(limit, MUST_GAIN * reference);
        if (error < most * (turns ? METERING_MUST_GAIN : 1)) {
            limit = error;
            best = guess;
        }
    }
    return best;
}

enum orl_gain_guess orl_gains_guess(struct orl_exposed *photos, size_t aligned_count, size_t count,
                                    const uint32_t *shared, const uint32_t *own, double metering[2])
{
    const struct known known = {photos, aligned_count, shared, own};
    enum orl_gain_guess best = best_guess(&known);
    fit_metering(&known, SIZE_MAX, metering);
    for (size_t i = aligned_count; i < count; i++) {
        double gain[3];
        guess_one(best, &known, &photos[i], i, metering, gain);
        for (int c = 0; c < 3; c++)
            photos[i].gain[c] = (float)exp2(gain[c]);
    }
    if (!is_metered(best))
        metering[0] = 0;
    return best;
}
