#include "io/svg_plot.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum { WIDTH = 760, LEFT = 78, RIGHT = 24, TOP = 96, PLOT_HEIGHT = 330, BOTTOM = 58 };

// Okabe and Ito's palette, which colour-blind readers can distinguish.
static const char *const colors[] = {"#0072b2", "#d55e00", "#009e73", "#cc79a7",
                                     "#e69f00", "#56b4e9", "#666666", "#b8a900"};

static const char *color_of(size_t i)
{
    return colors[i % (sizeof colors / sizeof *colors)];
}

// --- text ---

static void put_escaped(FILE *out, const char *text)
{
    for (; text && *text; text++) {
        switch (*text) {
        case '&': fputs("&amp;", out); break;
        case '<': fputs("&lt;", out); break;
        case '>': fputs("&gt;", out); break;
        case '"': fputs("&quot;", out); break;
        default: fputc((unsigned char)*text < 32 ? ' ' : *text, out);
        }
    }
}

// anchor: start, middle or end.
static void put_text(FILE *out, double x, double y, const char *anchor, const char *style,
                     const char *text)
{
    fprintf(out, "<text x=\"%.1f\" y=\"%.1f\" text-anchor=\"%s\" %s>", x, y, anchor, style);
    put_escaped(out, text);
    fputs("</text>\n", out);
}

// Writes numbers such as "2.5", "400", "12 k", "1.5 M".
static void format_number(double value, char text[32])
{
    double size = fabs(value);
    if (size >= 1e6)
        snprintf(text, 32, "%.4g M", value / 1e6);
    else if (size >= 1e4)
        snprintf(text, 32, "%.4g k", value / 1e3);
    else
        snprintf(text, 32, "%.4g", value);
}

// --- axes ---

enum { TICKS_MAX = 24 };

struct axis {
    bool log;
    double low, high;      // range in data space; logarithms on a logarithmic axis
    double from, to;       // pixels
    double ticks[TICKS_MAX]; // values
    size_t tick_count;
};

static double place(const struct axis *axis, double value)
{
    double at = axis->log ? log10(value) : value;
    return axis->from + (at - axis->low) / (axis->high - axis->low) * (axis->to - axis->from);
}

static bool can_place(const struct axis *axis, double value)
{
    return isfinite(value) && (!axis->log || value > 0);
}

static void set_linear(struct axis *axis, double low, double high)
{
    if (!(high > low))
        high = low + (low != 0 ? fabs(low) : 1);
    double raw = (high - low) / 6, unit = pow(10, floor(log10(raw)));
    double step = raw <= unit ? unit : raw <= 2 * unit ? 2 * unit : raw <= 5 * unit ? 5 * unit
                                                                                    : 10 * unit;
    double first = floor(low / step + 1e-9), last = ceil(high / step - 1e-9);
    axis->low = first * step;
    axis->high = last * step;
    for (double k = first; k <= last && axis->tick_count < TICKS_MAX; k++)
        axis->ticks[axis->tick_count++] = k * step;
}

// Ticks at 1, 2 and 5 of each decade, or only at decades when there are many.
static void set_log(struct axis *axis, double low, double high)
{
    static const double steps[] = {1, 2, 5};
    axis->low = log10(low) - 0.04;
    axis->high = log10(high) + 0.04;
    if (high < 2 * low) {
        axis->low -= 0.15;
        axis->high += 0.15;
    }
    int parts = axis->high - axis->low > 5 ? 1 : 3;
    for (int decade = (int)floor(axis->low); decade <= (int)ceil(axis->high); decade++)
        for (int i = 0; i < parts; i++) {
            double value = steps[i] * pow(10, decade), at = log10(value);
            if (at >= axis->low && at <= axis->high && axis->tick_count < TICKS_MAX)
                axis->ticks[axis->tick_count++] = value;
        }
}

static void find_range(const struct orl_plot *plot, bool y, double *low, double *high)
{
    const struct axis both[2] = {{.log = plot->x_log}, {.log = plot->y_log}};
    *low = INFINITY, *high = -INFINITY;
    for (size_t s = 0; s < plot->series_count; s++)
        for (size_t i = 0; i < plot->series[s].count; i++) {
            double at[2] = {plot->series[s].x[i], plot->series[s].y[i]};
            if (!can_place(&both[0], at[0]) || !can_place(&both[1], at[1]))
                continue;
            *low = fmin(*low, at[y]);
            *high = fmax(*high, at[y]);
        }
    if (*low > *high)
        *low = both[y].log ? 1 : 0, *high = both[y].log ? 10 : 1;
}

static struct axis make_axis(const struct orl_plot *plot, bool y, double from, double to)
{
    struct axis axis = {.log = y ? plot->y_log : plot->x_log, .from = from, .to = to};
    double low, high;
    find_range(plot, y, &low, &high);
    if (axis.log)
        set_log(&axis, low, high);
    else
        set_linear(&axis, y && plot->y_fit ? low : fmin(low, 0), high);
    return axis;
}

// --- what both kinds share ---

#define GREY "fill=\"#555\" font-size=\"12\""
#define SMALL "fill=\"#222\" font-size=\"12\""

static void begin(FILE *out, int height, const char *title, const char *subtitle)
{
    fprintf(out, "<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"%d\" height=\"%d\" "
                 "viewBox=\"0 0 %d %d\" font-family=\"Helvetica, Arial, sans-serif\">\n"
                 "<rect width=\"%d\" height=\"%d\" fill=\"#fff\"/>\n", WIDTH, height, WIDTH, height,
            WIDTH, height);
    put_text(out, 20, 28, "start", "fill=\"#111\" font-size=\"17\" font-weight=\"bold\"", title);
    bool wide = subtitle && strlen(subtitle) > 112;
    put_text(out, 20, 48, "start", wide ? "fill=\"#555\" font-size=\"10\"" : GREY, subtitle);
}

// A row of coloured names under the title; names that do not fit are left out.
static void put_legend(FILE *out, const char *const *names, size_t count)
{
    double x = 20;
    for (size_t i = 0; i < count; i++) {
        double width = 7.0 * (double)strlen(names[i]) + 34;
        if (x + width > WIDTH)
            return;
        fprintf(out, "<rect x=\"%.1f\" y=\"62\" width=\"12\" height=\"12\" fill=\"%s\"/>\n", x,
                color_of(i));
        put_text(out, x + 17, 73, "start", SMALL, names[i]);
        x += width;
    }
}

static void put_line(FILE *out, double x1, double y1, double x2, double y2, const char *color)
{
    fprintf(out, "<line x1=\"%.1f\" y1=\"%.1f\" x2=\"%.1f\" y2=\"%.1f\" stroke=\"%s\"/>\n", x1, y1,
            x2, y2, color);
}

static void put_x_axis(FILE *out, const struct axis *x, double top, double bottom,
                       const char *label)
{
    char text[32];
    double last = -INFINITY;
    for (size_t i = 0; i < x->tick_count; i++) {
        double at = place(x, x->ticks[i]);
        put_line(out, at, top, at, bottom, "#e4e4e4");
        format_number(x->ticks[i], text);
        if (at - last < 44) // no room for the label
            continue;
        put_text(out, at, bottom + 18, "middle", SMALL, text);
        last = at;
    }
    put_line(out, x->from, bottom, x->to, bottom, "#333");
    put_text(out, 0.5 * (x->from + x->to), bottom + 42, "middle",
             "fill=\"#111\" font-size=\"13\"", label);
}

static void put_y_axis(FILE *out, const struct axis *y, const char *label)
{
    char text[32], style[96];
    for (size_t i = 0; i < y->tick_count; i++) {
        double at = place(y, y->ticks[i]);
        put_line(out, LEFT, at, WIDTH - RIGHT, at, "#e4e4e4");
        format_number(y->ticks[i], text);
        put_text(out, LEFT - 8, at + 4, "end", SMALL, text);
    }
    put_line(out, LEFT, y->to, LEFT, y->from, "#333");
    double middle = 0.5 * (y->from + y->to);
    snprintf(style, sizeof style,
             "fill=\"#111\" font-size=\"13\" transform=\"rotate(-90 22 %.1f)\"", middle);
    put_text(out, 22, middle, "middle", style, label);
}

// --- lines and dots ---

static void put_joined(FILE *out, const struct orl_plot_series *s, const struct axis *x,
                       const struct axis *y, const char *color)
{
    bool first = true;
    for (size_t i = 0; i < s->count; i++) {
        if (!can_place(x, s->x[i]) || !can_place(y, s->y[i]))
            continue;
        fprintf(out, "%s%.1f,%.1f", first ? "<polyline points=\"" : " ", place(x, s->x[i]),
                place(y, s->y[i]));
        first = false;
    }
    if (!first)
        fprintf(out, "\" fill=\"none\" stroke=\"%s\" stroke-width=\"2\"/>\n", color);
}

static void put_series(FILE *out, const struct orl_plot_series *s, const struct axis *x,
                       const struct axis *y, size_t number)
{
    if (s->line)
        put_joined(out, s, x, y, color_of(number));
    for (size_t i = 0; i < s->count; i++) {
        if (!can_place(x, s->x[i]) || !can_place(y, s->y[i]))
            continue;
        double at_x = place(x, s->x[i]), at_y = place(y, s->y[i]);
        fprintf(out, "<circle cx=\"%.1f\" cy=\"%.1f\" r=\"4\" fill=\"%s\"/>\n", at_x, at_y,
                color_of(number));
        if (!s->labels || !s->labels[i])
            continue;
        bool left = at_x + 3.5 * (double)strlen(s->labels[i]) > WIDTH - RIGHT;
        put_text(out, at_x, at_y - 9, left ? "end" : "middle", SMALL, s->labels[i]);
    }
}

// Closes the stream, which sets *text (open_memstream).
static char *finish(const struct orl_log *log, FILE *out, char **text)
{
    fputs("</svg>\n", out);
    bool ok = !ferror(out);
    if (fclose(out) == 0 && ok)
        return *text;
    free(*text);
    orl_logf(log, ORL_LOG_ERROR, "no memory for a plot");
    return NULL;
}

static FILE *open_text(const struct orl_log *log, char **text, size_t *size)
{
    FILE *out = open_memstream(text, size);
    if (!out)
        orl_logf(log, ORL_LOG_ERROR, "no memory for a plot");
    return out;
}

char *orl_plot_svg(const struct orl_log *log, const struct orl_plot *plot)
{
    char *text = NULL;
    size_t size = 0;
    FILE *out = open_text(log, &text, &size);
    if (!out)
        return NULL;
    const char *names[8];
    size_t named = 0;
    for (size_t i = 0; i < plot->series_count && i < 8; i++)
        names[named++] = plot->series[i].name;
    struct axis x = make_axis(plot, false, LEFT, WIDTH - RIGHT);
    struct axis y = make_axis(plot, true, TOP + PLOT_HEIGHT, TOP);
    begin(out, TOP + PLOT_HEIGHT + BOTTOM, plot->title, plot->subtitle);
    put_legend(out, names, named);
    put_x_axis(out, &x, TOP, TOP + PLOT_HEIGHT, plot->x_label);
    put_y_axis(out, &y, plot->y_label);
    if (plot->behind) {
        put_joined(out, plot->behind, &x, &y, "#999");
        put_text(out, WIDTH - RIGHT, TOP - 6, "end", GREY, plot->behind->name);
    }
    for (size_t i = 0; i < plot->series_count; i++)
        put_series(out, &plot->series[i], &x, &y, i);
    return finish(log, out, &text);
}

// --- bars ---

enum { BAR_LEFT = 190, BAR_HEIGHT = 26, BAR_STEP = 40 };

static double row_sum(const struct orl_bars *bars, size_t row)
{
    double sum = 0;
    for (size_t i = 0; i < bars->part_count; i++)
        sum += fmax(0, bars->values[row * bars->part_count + i]);
    return sum;
}

static void put_bar(FILE *out, const struct orl_bars *bars, const struct axis *x, size_t row,
                    double top)
{
    char text[32];
    double done = 0;
    put_text(out, BAR_LEFT - 10, top + 18, "end", SMALL, bars->rows[row]);
    for (size_t i = 0; i < bars->part_count; i++) {
        double value = bars->values[row * bars->part_count + i];
        if (!(value > 0))
            continue;
        double from = place(x, done), to = place(x, done + value);
        fprintf(out, "<rect x=\"%.1f\" y=\"%.1f\" width=\"%.1f\" height=\"%d\" fill=\"%s\"/>\n",
                from, top, to - from, BAR_HEIGHT, color_of(i));
        snprintf(text, sizeof text, value < 10 ? "%.1f" : "%.0f", value);
        if (to - from > 8.0 * (double)strlen(text) + 4)
            put_text(out, 0.5 * (from + to), top + 18, "middle", "fill=\"#fff\" font-size=\"12\"",
                     text);
        done += value;
    }
    snprintf(text, sizeof text, done < 10 ? "%.2f" : "%.1f", done);
    put_text(out, place(x, done) + 6, top + 18, "start",
             "fill=\"#111\" font-size=\"12\" font-weight=\"bold\"", text);
}

char *orl_bars_svg(const struct orl_log *log, const struct orl_bars *bars)
{
    char *text = NULL;
    size_t size = 0;
    FILE *out = open_text(log, &text, &size);
    if (!out)
        return NULL;
    double most = 0, bottom = TOP + BAR_STEP * (double)bars->row_count;
    for (size_t i = 0; i < bars->row_count; i++)
        most = fmax(most, row_sum(bars, i));
    struct axis x = {.from = BAR_LEFT, .to = WIDTH - RIGHT - 46};
    set_linear(&x, 0, most);
    begin(out, (int)bottom + BOTTOM, bars->title, bars->subtitle);
    put_legend(out, bars->parts, bars->part_count);
    put_x_axis(out, &x, TOP, bottom, bars->x_label);
    for (size_t i = 0; i < bars->row_count; i++)
        put_bar(out, bars, &x, i, TOP + BAR_STEP * (double)i + 0.5 * (BAR_STEP - BAR_HEIGHT));
    return finish(log, out, &text);
}
