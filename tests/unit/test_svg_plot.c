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
    const struct orl_plot_series series[] = {{"one & only", x, y, labels, 3, true},
                                             {"dots", x, bad, NULL, 3, false}};
    struct orl_plot plot = {.title = "T", .subtitle = "<S>", .x_label = "x (px)",
                            .y_label = "y (ms)", .series = series, .series_count = 2};
    for (int kind = 0; kind < 4; kind++) {
        plot.x_log = kind & 1;
        plot.y_log = kind & 2;
        char *text = orl_plot_svg(NULL, &plot);
        assert_non_null(text);
        check_well_formed(text);
        // NaN is never shown, 0 not on a logarithmic axis.
        assert_int_equal(count(text, "<circle"), 3 + (plot.y_log ? 1 : 2));
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
    const struct orl_plot_series series = {"one", one, one, NULL, 1, true};
    struct orl_plot plot = {.title = "T", .x_label = "x", .y_label = "y", .series = &series};
    for (int kind = 0; kind < 4; kind++) {
        plot.series_count = kind & 1;
        plot.x_log = plot.y_log = kind & 2;
        char *text = orl_plot_svg(NULL, &plot);
        assert_non_null(text);
        check_well_formed(text);
        assert_null(strstr(text, "nan"));
        assert_null(strstr(text, "inf"));
        assert_int_equal(count(text, "<circle"), plot.series_count);
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
    const struct orl_plot_series dots = {"dots", x, y, NULL, 3, false};
    const struct orl_plot_series line = {"the front", x, y, NULL, 3, true};
    char *text = orl_plot_svg(NULL, &(struct orl_plot){.title = "T", .x_label = "x",
                                                       .y_label = "y", .series = &dots,
                                                       .series_count = 1, .behind = &line});
    check_well_formed(text);
    assert_int_equal(count(text, "<circle"), 3);
    assert_int_equal(count(text, "<polyline"), 1);
    assert_non_null(strstr(text, ">the front<"));
    assert_true(strstr(text, "<polyline") < strstr(text, "<circle"));
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
        cmocka_unit_test(draws_bars),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
