#include "preprocess/expose/gain_guess.h"

#include <math.h>
#include <string.h>


// A guess is used only when its error is less than this fraction of the error without a guess.
static const double MUST_GAIN = 0.8;

const char *orl_gain_guess_name(enum orl_gain_guess guess)
{
    static const char *const names[] = {"reference", "neighbours", "exposure",
                                        "exposure and neighbours"};
    return names[guess];
}

// Weights nearby views, and views that share much of their content: automatic exposure and white
// balance follow the content, and vignetting and gloss change slowly with position.
static double weight(const struct orl_gain_view *a, const struct orl_gain_view *b,
                     uint32_t shared, uint32_t own)
{
    double squared = 1e-12, common = (1.0 + shared) / (1.0 + own);
    for (int i = 0; i < 3; i++)
        squared += (a->eye[i] - b->eye[i]) * (a->eye[i] - b->eye[i]);
    return common * common / squared;
}

// log2 of the gain of view `number`. If the view is one of the aligned ones, its own gain is left
// out.
static void guess_one(enum orl_gain_guess guess, const struct orl_gain_view *aligned,
                      size_t count, const struct orl_gain_view *view, size_t number,
                      const uint32_t *shared, const uint32_t *own, double gain[3])
{
    bool uses_ev = (guess == ORL_GUESS_EXPOSURE || guess == ORL_GUESS_BOTH) && view->known;
    bool uses_others = guess == ORL_GUESS_NEIGHBOURS || guess == ORL_GUESS_BOTH;
    double total = 0, sum[3] = {0};
    for (size_t k = 0; uses_others && k < count; k++) {
        if (k == number || (uses_ev && !aligned[k].known))
            continue;
        double w = weight(view, &aligned[k], shared[number * count + k], own[number]);
        total += w;
        for (int c = 0; c < 3; c++)
            sum[c] += w * (log2((double)aligned[k].gain[c]) + (uses_ev ? aligned[k].ev : 0));
    }
    for (int c = 0; c < 3; c++)
        gain[c] = (total > 0 ? sum[c] / total : 0) - (uses_ev ? view->ev : 0);
}

static double error_of(enum orl_gain_guess guess, const struct orl_gain_view *aligned,
                       size_t count, const uint32_t *shared, const uint32_t *own)
{
    double squares = 0;
    for (size_t i = 0; i < count; i++) {
        double gain[3];
        guess_one(guess, aligned, count, &aligned[i], i, shared, own, gain);
        for (int c = 0; c < 3; c++)
            squares += pow(gain[c] - log2((double)aligned[i].gain[c]), 2);
    }
    return sqrt(squares);
}

enum orl_gain_guess orl_gains_guess(const struct orl_gain_view *aligned, size_t aligned_count,
                                    struct orl_gain_view *others, size_t other_count,
                                    const uint32_t *shared, const uint32_t *own)
{
    bool all_known = true;
    for (size_t i = 0; i < aligned_count; i++)
        all_known = all_known && aligned[i].known;
    enum orl_gain_guess best = ORL_GUESS_REFERENCE;
    double limit = MUST_GAIN * error_of(best, aligned, aligned_count, shared, own);
    int last = all_known ? ORL_GUESS_BOTH : ORL_GUESS_NEIGHBOURS;
    for (int g = ORL_GUESS_NEIGHBOURS; g <= last; g++) {
        double error = error_of((enum orl_gain_guess)g, aligned, aligned_count, shared, own);
        if (error < limit) {
            limit = error;
            best = (enum orl_gain_guess)g;
        }
    }
    for (size_t i = 0; i < other_count; i++) {
        double gain[3];
        guess_one(best, aligned, aligned_count, &others[i], aligned_count + i, shared, own, gain);
        for (int c = 0; c < 3; c++)
            others[i].gain[c] = (float)exp2(gain[c]);
    }
    return best;
}
