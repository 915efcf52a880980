// Plots of the benchmark.
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "core/file.h"
#include "core/memory.h"
#include "eval/bench.h"
#include "io/svg_plot.h"

enum { PARTS_MAX = 12, SERIES_MAX = 8, DOTS_MAX = 64, ROWS_MAX = 24, NAME_MAX_BYTES = 96 };

// Writes a plot and releases `svg`.
static enum orl_result save(const struct orl_log *log, const char *dir, const char *name,
                            char *svg)
{
    char *path = svg ? orl_path_join(log, dir, name) : NULL;
    enum orl_result result = path ? orl_file_write(log, path, svg, strlen(svg)) : ORL_ERR_MEMORY;
    free(path);
    free(svg);
    return result;
}

static void describe(const struct orl_bench *bench, char text[256])
{
    snprintf(text, 256, "%s: %zu points, %zu photographs of up to %dx%d; %.60s%s",
             orl_path_name(bench->scene->dir), orl_scene_point_count(bench->scene),
             bench->photographs, bench->photo_width, bench->photo_height, bench->device,
             bench->software ? " (no GPU)" : "");
}

// --- passes and memory ---

// Index of `name` among the parts, added if new; PARTS_MAX: no room.
static size_t part_of(const char *name, const char **parts, size_t *count)
{
    size_t i = 0;
    while (i < *count && strcmp(parts[i], name) != 0)
        i++;
    if (i == *count && i < PARTS_MAX)
        parts[(*count)++] = name;
    return i;
}

static enum orl_result plot_passes(const struct orl_log *log, const struct orl_bench *bench,
                                   const char *dir)
{
    const char *parts[PARTS_MAX], *rows[ROWS_MAX];
    char names[ROWS_MAX][NAME_MAX_BYTES], subtitle[256];
    double table[ROWS_MAX][PARTS_MAX] = {{0}}, values[ROWS_MAX * PARTS_MAX];
    size_t part_count = 0, row_count = 0;
    for (size_t i = 0; i < bench->run_count && row_count < ROWS_MAX; i++) {
        const struct orl_bench_run *run = &bench->runs[i];
        if (run->kind != ORL_BENCH_SIZES)
            continue;
        for (size_t k = 0; k < run->timing.pass_count; k++) {
            size_t part = part_of(run->timing.passes[k].name, parts, &part_count);
            if (part < PARTS_MAX)
                table[row_count][part] = run->timing.passes[k].ms;
        }
        snprintf(names[row_count], NAME_MAX_BYTES, "%s, %dx%d", run->method, run->width,
                 run->height);
        rows[row_count] = names[row_count];
        row_count++;
    }
    for (size_t r = 0; r < row_count; r++)
        memcpy(&values[r * part_count], table[r], part_count * sizeof *values);
    describe(bench, subtitle);
    const struct orl_bars bars = {.title = "Time of a frame by pass", .subtitle = subtitle,
                                  .x_label = "milliseconds, median of frames", .parts = parts,
                                  .part_count = part_count, .rows = rows, .values = values,
                                  .row_count = row_count};
    return save(log, dir, "passes.svg", orl_bars_svg(log, &bars));
}

static enum orl_result plot_memory(const struct orl_log *log, const struct orl_bench *bench,
                                   const char *dir)
{
    enum { PROCESS = ORL_OWNER_COUNT, OWNERS };
    static const char *const rows[] = {"device", "host, at most"};
    const char *parts[OWNERS] = {[PROCESS] = "process"};
    double values[2][OWNERS] = {{0}};
    char subtitle[256];
    for (size_t i = 0; i < bench->memory_count; i++)
        values[0][bench->memory[i].owner] += (double)bench->memory[i].bytes / (1 << 20);
    for (size_t k = 0; k < ORL_OWNER_COUNT; k++)
        parts[k] = orl_owner_names[k];
    values[1][PROCESS] = (double)bench->host_peak_bytes / (1 << 20);
    describe(bench, subtitle);
    const struct orl_bars bars = {.title = "Memory by owner", .subtitle = subtitle,
                                  .x_label = "MiB", .parts = parts, .part_count = OWNERS,
                                  .rows = rows,
                                  .values = &values[0][0], .row_count = 2};
    return save(log, dir, "memory.svg", orl_bars_svg(log, &bars));
}

// --- growth ---

struct curves {
    struct orl_plot_series series[SERIES_MAX];
    double x[SERIES_MAX][DOTS_MAX], y[SERIES_MAX][DOTS_MAX];
    char text[SERIES_MAX][DOTS_MAX][NAME_MAX_BYTES];
    const char *labels[SERIES_MAX][DOTS_MAX];
    size_t count;
};

static void add_dot(struct curves *c, const char *name, double x, double y, const char *label)
{
    size_t s = 0;
    while (s < c->count && strcmp(c->series[s].name, name) != 0)
        s++;
    if (s == SERIES_MAX)
        return;
    struct orl_plot_series *series = &c->series[s];
    if (s == c->count) {
        c->count++;
        *series = (struct orl_plot_series){.name = name, .x = c->x[s], .y = c->y[s], .line = true,
                                           .labels = label ? c->labels[s] : NULL};
    }
    if (series->count == DOTS_MAX)
        return;
    c->x[s][series->count] = x;
    c->y[s][series->count] = y;
    snprintf(c->text[s][series->count], NAME_MAX_BYTES, "%s", label ? label : "");
    c->labels[s][series->count] = c->text[s][series->count];
    series->count++;
}

static double x_of(const struct orl_bench_run *run)
{
    switch (run->kind) {
    case ORL_BENCH_PHOTOGRAPHS: return (double)run->photographs;
    case ORL_BENCH_POINTS: return (double)run->points;
    default: return 1.0 / run->photo_divide;
    }
}

static void collect(const struct orl_bench *bench, enum orl_bench_kind kind, struct curves *c)
{
    for (size_t i = 0; i < bench->run_count; i++) {
        const struct orl_bench_run *run = &bench->runs[i];
        char label[NAME_MAX_BYTES];
        if (run->kind != kind)
            continue;
        snprintf(label, sizeof label, "%.0f MiB", (double)run->device_bytes / (1 << 20));
        bool labelled = kind == ORL_BENCH_RESOLUTION && strcmp(run->method,
                                                               bench->runs[0].method) == 0;
        add_dot(c, run->method, x_of(run), run->timing.median_ms, labelled ? label : NULL);
    }
}

static enum orl_result plot_growth(const struct orl_log *log, const struct orl_bench *bench,
                                   enum orl_bench_kind kind, const char *dir)
{
    static const struct {
        const char *title, *x_label, *file;
        bool log;
    } kinds[ORL_BENCH_KIND_COUNT] = {
        [ORL_BENCH_PHOTOGRAPHS] = {"Time of a frame by number of photographs",
                                   "photographs in use", "photographs.svg", false},
        [ORL_BENCH_POINTS] = {"Time of a frame, and of drawing the points alone, by number of points",
                              "points", "points.svg", true},
        [ORL_BENCH_RESOLUTION] = {"Time and device memory by resolution of the photographs",
                                  "width and height of the photographs, fraction of full size",
                                  "resolution.svg", false},
    };
    char subtitle[256], text[320];
    struct curves *c = orl_array(log, 1, sizeof *c);
    if (!c)
        return ORL_ERR_MEMORY;
    collect(bench, kind, c);
    for (size_t i = 0; kind == ORL_BENCH_POINTS && i < bench->raster_count; i++) {
        add_dot(c, "splat alone", (double)bench->rasters[i].points, bench->rasters[i].splat_ms,
                NULL);
        add_dot(c, "GL_POINTS alone", (double)bench->rasters[i].points,
                bench->rasters[i].raster_ms, NULL);
    }
    describe(bench, subtitle);
    snprintf(text, sizeof text, "%s; picture of %dx%d", subtitle, bench->runs[0].width,
             bench->runs[0].height);
    const struct orl_plot plot = {.title = kinds[kind].title, .subtitle = text,
                                  .x_label = kinds[kind].x_label,
                                  .y_label = "milliseconds, median of frames",
                                  .x_log = kinds[kind].log, .y_log = kinds[kind].log,
                                  .series = c->series, .series_count = c->count};
    enum orl_result result = save(log, dir, kinds[kind].file, orl_plot_svg(log, &plot));
    free(c);
    return result;
}

enum orl_result orl_bench_plot(const struct orl_log *log, const struct orl_bench *bench,
                               const char *dir)
{
    bool growth = bench->raster_count > 0;
    enum orl_result result = orl_dir_make(log, dir);
    if (result == ORL_OK)
        result = plot_passes(log, bench, dir);
    if (result == ORL_OK)
        result = plot_memory(log, bench, dir);
    for (int kind = ORL_BENCH_PHOTOGRAPHS; growth && result == ORL_OK &&
                                           kind < ORL_BENCH_KIND_COUNT; kind++)
        result = plot_growth(log, bench, (enum orl_bench_kind)kind, dir);
    return result;
}
