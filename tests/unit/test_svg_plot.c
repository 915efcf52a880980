// Plots are well-formed and show each value where it belongs.
#include <math.h>

#include "io/svg_plot.h"
#include "test.h"

// Every tag closed in its order, text without markup, attributes quoted.
static void check_well_formed(const char *text)
{
    char open[32][32];
    int depth = 0, roots = 0;
    for (const char *at = text; *at;) {
        if (*at != '<') {
            assert_int_not_equal(*at, '>');
            if (*at == '&')
                assert_true(strncmp(at, "&amp;", 5) == 0 || strncmp(at, "&lt;", 4) == 0 ||
                            strncmp(at, "&gt;", 4) == 0 || strncmp(at, "&quot;", 6) == 0);
            at++;
            continue;
        }
        const char *end = at;
        bool quoted = false;
        while (*end && (*end != '>' || quoted)) {
            quoted ^= *end == '"';
            assert_true(end == at || *end != '<');
            end++;
        }
        assert_int_equal(*end, '>');
        char name[32] = "";
        assert_int_equal(sscanf(at + 1 + (at[1] == '/'), "%31[a-z]", name), 1);
        if (at[1] == '/') {
            assert_true(depth > 0);
            assert_string_equal(open[--depth], name);
        } else if (end[-1] != '/') {
            roots += depth == 0;
            assert_true(depth < 32);
            snprintf(open[depth++], sizeof open[0], "%s", name);
        }
        at = end + 1;
    }
    assert_int_equal(depth, 0);
    assert_int_equal(roots, 1);
}

static const char dot[] = "<path class=\"dot\"";

static size_t count(const char *text, const char *what)
{
    size_t found = 0;
    for (; (text = strstr(text, what)); text++)
        found++;
    return found;
}

static void draws_lines(void **state)
{
    (void)state;
    static const double x[] = {1, 2, 4}, y[] = {10, 20, 40}, bad[] = {NAN, 5, 0};
    static const char *const labels[] = {"a < b", "\"c\" & d", NULL};
    const struct orl_plot_series series[] = {{"one & only", x, y, labels, NULL, 3, true},
                                             {"dots", x, bad, NULL, NULL, 3, false}};
    struct orl_plot plot = {.title = "T", .subtitle = "<S>", .x_label = "x (px)",
                            .y_label = "y (ms)", .series = series, .series_count = 2};
    for (int kind = 0; kind < 4; kind++) {
        plot.x_log = kind & 1;
        plot.y_log = kind & 2;
        char *text = orl_plot_svg(NULL, &plot);
        assert_non_null(text);
        check_well_formed(text);
        // NaN is never shown, 0 not on a logarithmic axis.
        assert_int_equal(count(text, dot), 3 + (plot.y_log ? 1 : 2));
        assert_int_equal(count(text, "<polyline"), 1);
        assert_null(strstr(text, "nan"));
        assert_non_null(strstr(text, ">a &lt; b<"));
        assert_non_null(strstr(text, ">y (ms)<"));
        free(text);
    }
    // Equal steps of a logarithm are equal steps on the paper.
    plot.x_log = true;
    char *text = orl_plot_svg(NULL, &plot);
    double at[3][2];
    const char *line = strstr(text, "points=\"");
    assert_int_equal(sscanf(line, "points=\"%lf,%lf %lf,%lf %lf,%lf", &at[0][0], &at[0][1],
                            &at[1][0], &at[1][1], &at[2][0], &at[2][1]), 6);
    assert_float_equal(at[1][0] - at[0][0], at[2][0] - at[1][0], 0.2);
    assert_true(at[0][1] > at[1][1] && at[1][1] > at[2][1]);
    free(text);
}

static void draws_without_data(void **state)
{
    (void)state;
    static const double one[] = {7};
    const struct orl_plot_series series = {"one", one, one, NULL, NULL, 1, true};
    struct orl_plot plot = {.title = "T", .x_label = "x", .y_label = "y", .series = &series};
    for (int kind = 0; kind < 4; kind++) {
        plot.series_count = kind & 1;
        plot.x_log = plot.y_log = kind & 2;
        char *text = orl_plot_svg(NULL, &plot);
        assert_non_null(text);
        check_well_formed(text);
        assert_null(strstr(text, "nan"));
        assert_null(strstr(text, "inf"));
        assert_int_equal(count(text, dot), plot.series_count);
        free(text);
    }
    char *text = orl_bars_svg(NULL, &(struct orl_bars){.title = "T", .x_label = "ms"});
    check_well_formed(text);
    free(text);
}

// A line behind dots has neither dots nor a colour of its own.
static void draws_a_line_behind(void **state)
{
    (void)state;
    static const double x[] = {1, 2, 3}, y[] = {1, 4, 9};
    const struct orl_plot_series dots = {"dots", x, y, NULL, NULL, 3, false};
    const struct orl_plot_series line = {"the front", x, y, NULL, NULL, 3, true};
    char *text = orl_plot_svg(NULL, &(struct orl_plot){.title = "T", .x_label = "x",
                                                       .y_label = "y", .series = &dots,
                                                       .series_count = 1, .behind = &line});
    check_well_formed(text);
    assert_int_equal(count(text, dot), 3);
    assert_int_equal(count(text, "<polyline"), 1);
    assert_non_null(strstr(text, ">the front<"));
    assert_true(strstr(text, "<polyline") < strstr(text, dot));
    free(text);
}

// The fill and the shape of the key of each name in the legend.
static void read_key(const char **at, char key[160])
{
    *at = strstr(*at, "<path class=\"key\"");
    assert_non_null(*at);
    const char *shape = strstr(*at, " d=\"");
    snprintf(key, 160, "%.*s", (int)strcspn(shape, ">"), shape);
    (*at)++;
}

// All of many series are in the legend, each with a key of its own.
static void names_every_series(void **state)
{
    (void)state;
    enum { SERIES = 20 };
    static const double x[] = {1}, y[] = {1};
    struct orl_plot_series series[SERIES];
    char names[SERIES][32], keys[SERIES][160], shown[64];
    for (int i = 0; i < SERIES; i++) {
        snprintf(names[i], sizeof names[i], "method number %d", i);
        series[i] = (struct orl_plot_series){.name = names[i], .x = x, .y = y, .count = 1};
    }
    char *text = orl_plot_svg(NULL, &(struct orl_plot){.title = "T", .x_label = "x",
                                                       .y_label = "y", .series = series,
                                                       .series_count = SERIES});
    check_well_formed(text);
    const char *at = text;
    for (int i = 0; i < SERIES; i++) {
        snprintf(shown, sizeof shown, ">%.31s<", names[i]);
        assert_non_null(strstr(text, shown));
        read_key(&at, keys[i]);
        for (int k = 0; k < i; k++)
            assert_string_not_equal(keys[i], keys[k]);
    }
    free(text);
}

// Labels that would cover each other are left out; those with room stay.
static void leaves_out_labels_without_room(void **state)
{
    (void)state;
    enum { DOTS = 40 };
    double x[DOTS], y[DOTS];
    const char *labels[DOTS], *hover[DOTS];
    for (int i = 0; i < DOTS; i++) {
        x[i] = y[i] = i ? 5 : 1; // one dot alone, the others in one place
        labels[i] = i ? "crowded" : "alone";
        hover[i] = "what & it is";
    }
    const struct orl_plot_series dots = {.name = "dots", .x = x, .y = y, .labels = labels,
                                         .hover = hover, .count = DOTS};
    char *text = orl_plot_svg(NULL, &(struct orl_plot){.title = "T", .x_label = "x",
                                                       .y_label = "y", .series = &dots,
                                                       .series_count = 1});
    check_well_formed(text);
    assert_int_equal(count(text, ">alone<"), 1);
    size_t crowded = count(text, ">crowded<");
    assert_true(crowded >= 1 && crowded <= 8);
    assert_int_equal(count(text, "<title>dots what &amp; it is: "), DOTS);
    free(text);
}

static void draws_bars(void **state)
{
    (void)state;
    static const char *const parts[] = {"p", "q"}, *const rows[] = {"r1", "r2"};
    static const double values[] = {100, 300, 0, 50};
    const struct orl_bars bars = {.title = "T", .subtitle = "S", .x_label = "ms", .parts = parts,
                                  .part_count = 2, .rows = rows, .values = values,
                                  .row_count = 2};
    char *text = orl_bars_svg(NULL, &bars);
    check_well_formed(text);
    assert_int_equal(count(text, "<rect"), 1 + 2 + 3); // paper, legend, bars
    assert_int_equal(count(text, "height=\"26\""), 3);
    assert_non_null(strstr(text, ">400.0<"));
    assert_non_null(strstr(text, ">50.0<"));
    // Widths as the values.
    double widths[3];
    const char *at = text;
    for (int i = 0; i < 3; i++) {
        at = strstr(at, "height=\"26\"");
        const char *width = at;
        while (strncmp(width, "width=", 6) != 0)
            width--;
        widths[i] = atof(width + 7);
        at++;
    }
    assert_float_equal(widths[1] / widths[0], 3, 0.02);
    assert_float_equal(widths[2] / widths[0], 0.5, 0.02);
    free(text);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(draws_lines),
        cmocka_unit_test(draws_without_data),
        cmocka_unit_test(draws_a_line_behind),
        cmocka_unit_test(names_every_series),
        cmocka_unit_test(leaves_out_labels_without_room),
        cmocka_unit_test(draws_bars),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
