// Robust least squares on what photographs show of scene points: gains (align.h) and responses (response.h).
#ifndef ORL_PREPROCESS_ROBUST_FIT_H
#define ORL_PREPROCESS_ROBUST_FIT_H

#include "preprocess/expose/samples.h"

// value + the sum of factor[k] * x[index[k]] is equal for all observations of a point, but for errors.
struct orl_equation {
    double value;
    int count;
    size_t index[4 * ORL_SAMPLES_PER_POINT];
    double factor[4 * ORL_SAMPLES_PER_POINT];
};
// Adds a term; terms of one unknown are added up.
void orl_equation_add(struct orl_equation *equation, size_t index, double factor);

struct orl_robust_fit {
    const struct orl_samples *samples;
    float *sigma;    // per observation, the caller sets it: standard deviation; INFINITY: takes no part
    float *weight;   // robust; 0: takes no part
    float *residual; // the caller sets it, orl_robust_center makes it that from the point's mean
    float *scratch;
    double *matrix, *x; // orl_robust_equations: normal equations and right side; x: unknowns once they are solved
};
enum orl_result orl_robust_init(const struct orl_log *log, const struct orl_samples *samples, size_t unknowns,
                                struct orl_robust_fit *fit) ORL_CHECK_RESULT;
void orl_robust_finish(struct orl_robust_fit *fit);
// Gives all that take part weight 1.
void orl_robust_reset(struct orl_robust_fit *fit);
// The robust weight of an observation over its variance.
double orl_robust_weight(const struct orl_robust_fit *fit, size_t i);
// Subtracts from each residual the weighted mean of its point's.
void orl_robust_center(struct orl_robust_fit *fit);
// Robust standard deviation of the residuals, absolute or relative to their sigmas.
double orl_robust_spread(struct orl_robust_fit *fit, bool relative);
// Applies Huber's weights or Tukey's, which give outliers weight 0. scale_min: least scale, in sigmas.
void orl_robust_reweigh(struct orl_robust_fit *fit, bool tukey, double scale_min);
// Makes the normal equations of the first `unknowns`. equation: sets that of observation i, an empty one.
void orl_robust_equations(struct orl_robust_fit *fit, size_t unknowns, const void *problem,
                          void (*equation)(const void *problem, size_t i, struct orl_equation *equation));

#endif
