#include "preprocess/expose/robust_fit.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "core/memory.h"
#include "core/order.h"

enum orl_result orl_robust_init(const struct orl_log *log, const struct orl_samples *samples, size_t unknowns,
                                struct orl_robust_fit *fit)
{
    float *floats = orl_array(log, samples->count, 4 * sizeof *floats);
    double *doubles = orl_array(log, unknowns, (unknowns + 1) * sizeof *doubles);
    *fit = (struct orl_robust_fit){.samples = samples, .sigma = floats, .matrix = doubles};
    if (!floats || !doubles)
        return ORL_ERR_MEMORY;
    fit->weight = floats + samples->count;
    fit->residual = floats + 2 * samples->count;
    fit->scratch = floats + 3 * samples->count;
    fit->x = doubles + unknowns * unknowns;
    return ORL_OK;
}

void orl_robust_finish(struct orl_robust_fit *fit)
{
    free(fit->sigma);
    free(fit->matrix);
    memset(fit, 0, sizeof *fit);
}

// --- weights ---

void orl_robust_reset(struct orl_robust_fit *fit)
{
    for (size_t i = 0; i < fit->samples->count; i++)
        fit->weight[i] = isfinite(fit->sigma[i]) ? 1 : 0;
}

double orl_robust_weight(const struct orl_robust_fit *fit, size_t i)
{
    return (double)fit->weight[i] / ((double)fit->sigma[i] * (double)fit->sigma[i]);
}

void orl_robust_center(struct orl_robust_fit *fit)
{
    for (size_t point = 0; point < fit->samples->point_count; point++) {
        size_t begin = fit->samples->first[point], end = fit->samples->first[point + 1];
        double total = 0, mean = 0;
        for (size_t i = begin; i < end; i++) {
            total += orl_robust_weight(fit, i);
            mean += orl_robust_weight(fit, i) * (double)fit->residual[i];
        }
        for (size_t i = begin; i < end; i++)
            fit->residual[i] = total > 0 ? fit->residual[i] - (float)(mean / total) : 0;
    }
}

double orl_robust_spread(struct orl_robust_fit *fit, bool relative)
{
    size_t count = 0;
    for (size_t i = 0; i < fit->samples->count; i++)
        if (isfinite(fit->sigma[i]))
            fit->scratch[count++] = fabsf(fit->residual[i]) / (relative ? fit->sigma[i] : 1);
    qsort(fit->scratch, count, sizeof *fit->scratch, orl_order_floats);
    return count ? 1.4826 * (double)fit->scratch[count / 2] : 0;
}

void orl_robust_reweigh(struct orl_robust_fit *fit, bool tukey, double scale_min)
{
    double scale = fmax(orl_robust_spread(fit, true), scale_min);
    for (size_t i = 0; i < fit->samples->count; i++) {
        double t = fabs((double)fit->residual[i]) / ((double)fit->sigma[i] * scale), u = t / 4.685;
        double huber = t <= 1.345 ? 1 : 1.345 / t;
        fit->weight[i] = !isfinite(fit->sigma[i]) ? 0
                         : !tukey ? (float)huber
                                  : u < 1 ? (float)((1 - u * u) * (1 - u * u)) : 0;
    }
}

// --- normal equations ---

void orl_equation_add(struct orl_equation *equation, size_t index, double factor)
{
    int k = 0;
    while (k < equation->count && equation->index[k] != index)
        k++;
    equation->index[k] = index;
    equation->factor[k] = factor + (k < equation->count ? equation->factor[k] : 0);
    equation->count += k == equation->count;
}

static void add_square(struct orl_robust_fit *fit, size_t n, const struct orl_equation *e, double weight)
{
    for (int k = 0; k < e->count; k++) {
        double factor = weight * e->factor[k];
        fit->x[e->index[k]] -= factor * e->value;
        for (int m = 0; m < e->count; m++)
            fit->matrix[e->index[k] * n + e->index[m]] += factor * e->factor[m];
    }
}

void orl_robust_equations(struct orl_robust_fit *fit, size_t unknowns, const void *problem,
                          void (*equation)(const void *problem, size_t i, struct orl_equation *equation))
{
    struct orl_equation one, all; // of an observation; sum of a point's
    memset(fit->matrix, 0, unknowns * unknowns * sizeof *fit->matrix);
    memset(fit->x, 0, unknowns * sizeof *fit->x);
    for (size_t point = 0; point < fit->samples->point_count; point++) {
        double total = 0;
        all.value = 0;
        all.count = 0;
        for (size_t i = fit->samples->first[point]; i < fit->samples->first[point + 1]; i++) {
            double weight = orl_robust_weight(fit, i);
            if (!(weight > 0))
                continue;
            one.count = 0;
            equation(problem, i, &one);
            add_square(fit, unknowns, &one, weight);
            total += weight;
            all.value += weight * one.value;
            for (int k = 0; k < one.count; k++)
                orl_equation_add(&all, one.index[k], weight * one.factor[k]);
        }
        // Eliminates the point's own value, the weighted mean of its equations.
        if (total > 0)
            add_square(fit, unknowns, &all, -1 / total);
    }
}
