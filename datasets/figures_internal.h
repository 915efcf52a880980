// Private to the figures.
#ifndef ORL_DATASETS_FIGURES_INTERNAL_H
#define ORL_DATASETS_FIGURES_INTERNAL_H

#include "datasets/figures.h"

// From the part's segment to a point, the shortest way.
void orl_figure_part_offset(const struct orl_figure_part *part, const double at[3], double off[3]);
// What the part reflects at a point of its surface, linear.
void orl_figure_part_color(const struct orl_figure_part *part, const double at[3],
                           double color[3]);

#endif
