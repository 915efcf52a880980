// Every figure of a held-out view: its name in reports, and how tables print it.
#ifndef ORL_EVAL_VIEW_FIGURES_H
#define ORL_EVAL_VIEW_FIGURES_H

#include "eval/eval.h"

struct orl_figure {
    const char *name;  // in JSON (docs/reference/metrics.md); NULL after the last
    const char *title; // of a table's column; NULL: reports alone
    int width, digits; // of the column
    double scale;      // from reports to tables
    bool of_radiance;  // only with a truth
    size_t offset;     // of the double in struct orl_eval_view
};
extern const struct orl_figure orl_figures[];

double orl_figure_value(const struct orl_figure *figure, const struct orl_eval_view *view);

#endif
