// The report's files: chart.json, SVG figures, the page.
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "core/json.h"
#include "core/memory.h"
#include "eval/chart_internal.h"
#include "eval/report_page.h"
#include "io/svg_plot.h"

enum { PAGE_VIEWS = 2 };

// --- figures ---

struct dots {
    struct orl_plot_series *series; // one per method, then the front
    size_t series_count;
    double *x, *y;
    const char **labels, **hover;
    size_t count;
};

static double psnr_of(const json_t *row)
{
    return json_number_value(json_object_get(json_object_get(row, "mean"), "psnr_db"));
}

static bool is_of(const json_t *row, const char *scene)
{
    return (!scene || strcmp(orl_row_text(row, "scene"), scene) == 0) &&
           json_is_number(json_object_get(row, "frame_ms"));
}

static void add_dot(struct dots *dots, const json_t *row, bool labelled)
{
    size_t i = dots->count++;
    const char *setting = orl_row_text(row, "setting");
    dots->x[i] = json_number_value(json_object_get(row, "frame_ms"));
    dots->y[i] = psnr_of(row);
    dots->labels[i] = labelled ? orl_row_text(row, "method") : "";
    dots->hover[i] = setting;
    dots->series[dots->series_count - 1].count++;
}

static void begin_series(struct dots *dots, const char *name, bool line)
{
    dots->series[dots->series_count++] = (struct orl_plot_series){
        .name = name, .x = dots->x + dots->count, .y = dots->y + dots->count,
        .labels = dots->labels + dots->count, .hover = dots->hover + dots->count, .line = line};
}

static void add_methods(struct dots *dots, const json_t *rows, const char *scene)
{
    const json_t *row, *other;
    size_t i, k;
    json_array_foreach((json_t *)(uintptr_t)rows, i, row) {
        bool seen = !is_of(row, scene);
        for (size_t s = 0; !seen && s < dots->series_count; s++)
            seen = strcmp(dots->series[s].name, orl_row_text(row, "method")) == 0;
        if (seen)
            continue;
        begin_series(dots, orl_row_text(row, "method"), false);
        json_array_foreach((json_t *)(uintptr_t)rows, k, other)
            if (is_of(other, scene) &&
                strcmp(orl_row_text(other, "method"), orl_row_text(row, "method")) == 0)
                add_dot(dots, other, orl_row_text(other, "setting")[0] == '\0');
    }
}

// Adds the front, from its fastest point on.
static void add_front(struct dots *dots, const json_t *rows, const char *scene)
{
    begin_series(dots, "line: the front", true);
    double last = 0;
    for (;;) {
        const json_t *next = NULL, *row;
        double next_ms = 0;
        size_t i;
        json_array_foreach((json_t *)(uintptr_t)rows, i, row) {
            double ms = json_number_value(json_object_get(row, "frame_ms"));
            if (!is_of(row, scene) || !json_is_true(json_object_get(row, "on_front")) ||
                ms <= last || (next && ms >= next_ms))
                continue;
            next = row;
            next_ms = ms;
        }
        if (!next)
            return;
        add_dot(dots, next, false);
        last = next_ms;
    }
}

static enum orl_result write_figure(const struct orl_log *log, const char *out,
                                    const char *file, const json_t *rows, const char *scene,
                                    const char *subtitle)
{
    size_t room = 2 * json_array_size(rows) + 1;
    struct dots dots = {.series = orl_array(log, room, sizeof *dots.series),
                        .x = orl_array(log, room, sizeof *dots.x),
                        .y = orl_array(log, room, sizeof *dots.y),
                        .labels = orl_array(log, room, sizeof *dots.labels),
                        .hover = orl_array(log, room, sizeof *dots.hover)};
    char *path = orl_path_join(log, out, file), *svg = NULL;
    enum orl_result result =
        dots.series && dots.x && dots.y && dots.labels && dots.hover && path
            ? ORL_OK : ORL_ERR_MEMORY;
    if (result == ORL_OK) {
        add_methods(&dots, rows, scene);
        add_front(&dots, rows, scene);
        svg = orl_plot_svg(log, &(struct orl_plot){
            .title = "Accuracy against time", .subtitle = subtitle,
            .x_label = "milliseconds a frame, median", .y_label = "PSNR of whole pictures, dB",
            .x_log = true, .y_fit = true, .series = dots.series,
            .series_count = dots.series_count - 1,
            .behind = &dots.series[dots.series_count - 1]});
        result = svg ? orl_file_write(log, path, svg, strlen(svg)) : ORL_ERR_MEMORY;
    }
    free(dots.series);
    free(dots.x);
    free(dots.y);
    free(dots.labels);
    free(dots.hover);
    free(path);
    free(svg);
    return result;
}

static enum orl_result write_figures(const struct orl_log *log, const char *out,
                                     const json_t *root)
{
    const json_t *scenes = json_object_get(root, "scenes"), *scene;
    const char *device = orl_row_text(root, "device");
    char subtitle[320], file[300];
    size_t i;
    snprintf(subtitle, sizeof subtitle, "means over %zu scene%s; %.100s",
             json_array_size(scenes), json_array_size(scenes) == 1 ? "" : "s", device);
    enum orl_result result = write_figure(log, out, "chart.svg",
                                          json_object_get(root, "overall"), NULL, subtitle);
    json_array_foreach((json_t *)(uintptr_t)scenes, i, scene) {
        if (result != ORL_OK)
            break;
        const char *name = orl_row_text(scene, "name");
        snprintf(file, sizeof file, "chart.%.200s.svg", name);
        snprintf(subtitle, sizeof subtitle, "%.100s: %zu photographs held out; %.100s", name,
                 json_array_size(json_object_get(scene, "views")), device);
        result = write_figure(log, out, file, json_object_get(root, "rows"), name, subtitle);
    }
    return result;
}

// --- the page ---

// Collects the pictures of the first views of each row of `list`.
static enum orl_result add_pictures_of(const struct orl_log *log, const json_t *list,
                                       struct orl_names *pictures)
{
    static const char *const keys[] = {"picture", "error_map"};
    enum orl_result result = ORL_OK;
    for (size_t i = 0; i < json_array_size(list); i++) {
        const json_t *views = json_object_get(json_array_get(list, i), "views");
        for (size_t v = 0; v < json_array_size(views) && v < PAGE_VIEWS; v++)
            for (size_t k = 0; result == ORL_OK && k < ORL_COUNT(keys); k++) {
                const char *name =
                    json_string_value(json_object_get(json_array_get(views, v), keys[k]));
                if (name)
                    result = orl_names_add(log, pictures, name);
            }
    }
    return result;
}

static enum orl_result write_page(const struct orl_log *log, const char *dir, const json_t *root)
{
    struct orl_names pictures = {0};
    enum orl_result result = add_pictures_of(log, json_object_get(root, "scenes"), &pictures);
    if (result == ORL_OK)
        result = add_pictures_of(log, json_object_get(root, "rows"), &pictures);
    if (result == ORL_OK)
        result = orl_page_write(log, &(struct orl_page){.dir = dir, .file = "chart.html",
                                                        .html = orl_chart_page, .data = root,
                                                        .pictures = &pictures});
    orl_names_finish(&pictures);
    return result;
}

enum orl_result orl_chart_write(const struct orl_log *log, const char *out, const json_t *root)
{
    char *path = orl_path_join(log, out, "chart.json");
    enum orl_result result = path ? orl_json_write(log, path, root) : ORL_ERR_MEMORY;
    if (result == ORL_OK)
        result = write_figures(log, out, root);
    if (result == ORL_OK)
        result = write_page(log, out, root);
    free(path);
    return result;
}
