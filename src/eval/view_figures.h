// Every figure of a held-out view: its name in reports, and how tables print it.
#ifndef ORL_EVAL_VIEW_FIGURES_H
#define ORL_EVAL_VIEW_FIGURES_H

#include "eval/eval.h"

enum orl_figure_group {
    ORL_FIGURES_PICTURE,
    ORL_FIGURES_RADIANCE, // only with a truth
    ORL_FIGURES_VEHICLE,  // only with one that has a vehicle
    ORL_FIGURE_GROUPS
};

struct orl_figure {
    const char *name;  // in JSON (docs/reference/metrics.md); NULL after the last
    const char *title; // of a table's column; NULL: reports alone
    int width, digits; // of the column
    double scale;      // from reports to tables
    enum orl_figure_group group;
    size_t offset;     // of the double in struct orl_eval_view
};
extern const struct orl_figure orl_figures[];

bool orl_figures_known(enum orl_figure_group group, const struct orl_eval *eval);
double orl_figure_value(const struct orl_figure *figure, const struct orl_eval_view *view);

#endif
