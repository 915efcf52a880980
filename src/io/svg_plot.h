// Plots as SVG text: lines or dots over two axes, and stacked bars.
#ifndef ORL_IO_SVG_PLOT_H
#define ORL_IO_SVG_PLOT_H

#include "oriel/log.h"

struct orl_plot_series {
    const char *name;
    const double *x, *y;
    const char *const *labels; // text beside each dot; NULL: none. Left out where there is no room
    const char *const *hover;  // what a dot is, shown under the pointer beside its name; NULL: none
    size_t count;
    bool line;                 // joins the dots in their order
};

struct orl_plot {
    const char *title, *subtitle, *x_label, *y_label; // labels with units
    bool x_log, y_log; // logarithmic, for positive values; linear axes start at 0 or below
    bool y_fit;        // a linear y axis may start above 0
    const struct orl_plot_series *series;
    size_t series_count;
    const struct orl_plot_series *behind; // a grey line without dots, behind the others; or NULL
};

// Rows of stacked bars; all rows have the same parts.
struct orl_bars {
    const char *title, *subtitle, *x_label;
    const char *const *parts;
    size_t part_count;
    const char *const *rows;
    const double *values; // row_count * part_count, row by row, >= 0
    size_t row_count;
};

// These return SVG text, released with free(); NULL, logged, when memory runs out. Dots that are
// not finite, or not positive on a logarithmic axis, are left out.
char *orl_plot_svg(const struct orl_log *log, const struct orl_plot *plot);
char *orl_bars_svg(const struct orl_log *log, const struct orl_bars *bars);

#endif
