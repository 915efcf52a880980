#include "io/svg_plot.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "core/memory.h"

enum { WIDTH = 760, LEFT = 78, RIGHT = 24, PLOT_HEIGHT = 330, BOTTOM = 58 };
// Of the legend; the plot begins under it.
enum { LEGEND_TOP = 62, LEGEND_STEP = 20 };

// Okabe and Ito's palette, which colour-blind readers can distinguish, and four colours more.
// Series also differ in their markers, so that none of the first sixty looks like another.
static const char *const colors[] = {"#0072b2", "#d55e00", "#009e73", "#cc79a7",
                                     "#e69f00", "#56b4e9", "#666666", "#b8a900",
                                     "#6a3d9a", "#b15928", "#2f9e44", "#e7298a"};
// Paths of a marker around (0, 0): circle, square, triangle, diamond, triangle upside down.
static const char *const markers[] = {
    "M-4 0a4 4 0 1 0 8 0a4 4 0 1 0 -8 0z", "M-3.7 -3.7h7.4v7.4h-7.4z", "M0 -4.8L4.7 3.6h-9.4z",
    "M0 -5.2L5.2 0L0 5.2L-5.2 0z", "M0 4.8L4.7 -3.6h-9.4z"};

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

// Closed by the caller, who may put a title into it.
static void begin_marker(FILE *out, double x, double y, size_t number, const char *kind)
{
    fprintf(out, "<path class=\"%s\" transform=\"translate(%.1f %.1f)\" d=\"%s\" fill=\"%s\">",
            kind, x, y, markers[number % (sizeof markers / sizeof *markers)], color_of(number));
}

// Where a name of the legend stands.
struct legend {
    double x, y;
};

// Moves on to the place of the next name, in a new row where this one is full.
static struct legend legend_next(struct legend *after, const char *name)
{
    double width = 7.0 * (double)strlen(name) + 34;
    if (after->x > 20 && after->x + width > WIDTH)
        *after = (struct legend){20, after->y + LEGEND_STEP};
    struct legend at = *after;
    after->x += width;
    return at;
}

static struct legend legend_start(void)
{
    return (struct legend){20, LEGEND_TOP};
}

// The upper edge of the plot.
static double top_under(struct legend last)
{
    return last.y + 34;
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

// What the pointer shows over a dot.
static void put_hover(FILE *out, const struct orl_plot_series *s, size_t i)
{
    char x[32], y[32];
    format_number(s->x[i], x);
    format_number(s->y[i], y);
    fputs("<title>", out);
    put_escaped(out, s->name);
    if (s->hover && s->hover[i] && *s->hover[i]) {
        fputc(' ', out);
        put_escaped(out, s->hover[i]);
    }
    fprintf(out, ": %s, %s</title>", x, y);
}

static void put_series(FILE *out, const struct orl_plot_series *s, const struct axis *x,
                       const struct axis *y, size_t number)
{
    if (s->line)
        put_joined(out, s, x, y, color_of(number));
    for (size_t i = 0; i < s->count; i++) {
        if (!can_place(x, s->x[i]) || !can_place(y, s->y[i]))
            continue;
        begin_marker(out, place(x, s->x[i]), place(y, s->y[i]), number, "dot");
        put_hover(out, s, i);
        fputs("</path>\n", out);
    }
}

// --- labels of dots ---

struct box {
    double left, top, right, bottom;
};

struct boxes {
    struct box *items;
    size_t count;
};

static bool is_free(const struct boxes *taken, const struct box *b)
{
    for (size_t i = 0; i < taken->count; i++) {
        const struct box *t = &taken->items[i];
        if (b->left < t->right && t->left < b->right && b->top < t->bottom && t->top < b->bottom)
            return false;
    }
    return true;
}

// Puts a label at the first place beside its dot where it covers neither a dot nor a label. Without
// such a place it is left out: the legend and the pointer name the dot.
static void put_label(FILE *out, const char *text, double dot_x, double dot_y,
                      const struct box *plot, struct boxes *taken)
{
    static const struct {
        int side, down; // side: -1 ends before the dot, 0 centred on it, 1 begins behind it
    } places[] = {{0, -9}, {1, 4}, {-1, 4}, {0, 19}, {1, -7}, {-1, -7}, {1, 15}, {-1, 15}};
    double width = 6.6 * (double)strlen(text);
    for (size_t k = 0; k < sizeof places / sizeof *places; k++) {
        int side = places[k].side;
        double left = side > 0 ? dot_x + 8 : side < 0 ? dot_x - 8 - width : dot_x - 0.5 * width;
        double base = dot_y + places[k].down;
        struct box b = {left, base - 10, left + width, base + 3};
        if (b.left < plot->left || b.right > plot->right || b.top < plot->top ||
            b.bottom > plot->bottom || !is_free(taken, &b))
            continue;
        put_text(out, left, base, "start", SMALL, text);
        taken->items[taken->count++] = b;
        return;
    }
}

static enum orl_result put_labels(const struct orl_log *log, FILE *out, const struct orl_plot *plot,
                                  const struct axis *x, const struct axis *y)
{
    enum { SIDE = 5 }; // of a marker, from its centre
    size_t dots = 0;
    for (size_t s = 0; s < plot->series_count; s++)
        dots += plot->series[s].count;
    struct boxes taken = {.items = orl_array(log, 2 * dots, sizeof *taken.items)};
    if (!taken.items)
        return ORL_ERR_MEMORY;
    // Labels may reach above the plot's upper edge, where its dots do.
    const struct box room = {x->from, y->to - 14, x->to, y->from};
    for (int pass = 0; pass < 2; pass++) // dots first: they stay where they are
        for (size_t s = 0; s < plot->series_count; s++)
            for (size_t i = 0; i < plot->series[s].count; i++) {
                const struct orl_plot_series *of = &plot->series[s];
                const char *label = of->labels ? of->labels[i] : NULL;
                if (!can_place(x, of->x[i]) || !can_place(y, of->y[i]))
                    continue;
                double at_x = place(x, of->x[i]), at_y = place(y, of->y[i]);
                if (pass == 0)
                    taken.items[taken.count++] =
                        (struct box){at_x - SIDE, at_y - SIDE, at_x + SIDE, at_y + SIDE};
                else if (label && *label)
                    put_label(out, label, at_x, at_y, &room, &taken);
            }
    free(taken.items);
    return ORL_OK;
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

// Puts the names of all series; returns where the last one stands.
static struct legend put_markers(FILE *out, const struct orl_plot *plot, bool draw)
{
    struct legend after = legend_start(), at = after;
    for (size_t i = 0; i < plot->series_count; i++) {
        at = legend_next(&after, plot->series[i].name);
        if (!draw)
            continue;
        begin_marker(out, at.x + 6, at.y + 7, i, "key");
        fputs("</path>\n", out);
        put_text(out, at.x + 17, at.y + 11, "start", SMALL, plot->series[i].name);
    }
    return at;
}

char *orl_plot_svg(const struct orl_log *log, const struct orl_plot *plot)
{
    char *text = NULL;
    size_t size = 0;
    FILE *out = open_text(log, &text, &size);
    if (!out)
        return NULL;
    double top = top_under(put_markers(out, plot, false)), bottom = top + PLOT_HEIGHT;
    struct axis x = make_axis(plot, false, LEFT, WIDTH - RIGHT);
    struct axis y = make_axis(plot, true, bottom, top);
    begin(out, (int)bottom + BOTTOM, plot->title, plot->subtitle);
    put_markers(out, plot, true);
    put_x_axis(out, &x, top, bottom, plot->x_label);
    put_y_axis(out, &y, plot->y_label);
    if (plot->behind) {
        put_joined(out, plot->behind, &x, &y, "#999");
        put_text(out, WIDTH - RIGHT, top - 6, "end", GREY, plot->behind->name);
    }
    for (size_t i = 0; i < plot->series_count; i++)
        put_series(out, &plot->series[i], &x, &y, i);
    enum orl_result result = put_labels(log, out, plot, &x, &y);
    text = finish(log, out, &text);
    if (result != ORL_OK) {
        free(text);
        text = NULL;
    }
    return text;
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

static struct legend put_parts(FILE *out, const struct orl_bars *bars, bool draw)
{
    struct legend after = legend_start(), at = after;
    for (size_t i = 0; i < bars->part_count; i++) {
        at = legend_next(&after, bars->parts[i]);
        if (!draw)
            continue;
        fprintf(out, "<rect x=\"%.1f\" y=\"%.1f\" width=\"12\" height=\"12\" fill=\"%s\"/>\n", at.x,
                at.y, color_of(i));
        put_text(out, at.x + 17, at.y + 11, "start", SMALL, bars->parts[i]);
    }
    return at;
}

char *orl_bars_svg(const struct orl_log *log, const struct orl_bars *bars)
{
    char *text = NULL;
    size_t size = 0;
    FILE *out = open_text(log, &text, &size);
    if (!out)
        return NULL;
    double most = 0, top = top_under(put_parts(out, bars, false));
    double bottom = top + BAR_STEP * (double)bars->row_count;
    for (size_t i = 0; i < bars->row_count; i++)
        most = fmax(most, row_sum(bars, i));
    struct axis x = {.from = BAR_LEFT, .to = WIDTH - RIGHT - 46};
    set_linear(&x, 0, most);
    begin(out, (int)bottom + BOTTOM, bars->title, bars->subtitle);
    put_parts(out, bars, true);
    put_x_axis(out, &x, top, bottom, bars->x_label);
    for (size_t i = 0; i < bars->row_count; i++)
        put_bar(out, bars, &x, i, top + BAR_STEP * (double)i + 0.5 * (BAR_STEP - BAR_HEIGHT));
    return finish(log, out, &text);
}
