// Analyses measured rows: Pareto fronts, sentences, means over scenes.
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "core/memory.h"
#include "eval/chart_front.h"
#include "eval/chart_internal.h"

// --- rows of one scene, or over all scenes ---

static void note_point(const struct orl_chart_point *points, size_t count, size_t i, json_t *row)
{
    const struct orl_chart_point *p = &points[i];
    char text[ORL_CHART_SENTENCE_MAX];
    json_object_set_new(row, "on_front", json_boolean(p->on_front));
    json_t *by = json_null();
    if (p->dominated_by >= 0) {
        const struct orl_chart_point *q = &points[p->dominated_by];
        by = json_pack("{s:s, s:s}", "method", q->method, "setting", q->setting);
    }
    json_object_set_new(row, "dominated_by", by);
    orl_chart_sentence(points, count, i, text);
    json_object_set_new(row, "sentence", json_string(text));
}

// Analyses the rows of `scene`, or with NULL all rows.
static enum orl_result analyse(const struct orl_log *log, json_t *rows, const char *scene)
{
    size_t all = json_array_size(rows), count = 0, i;
    struct orl_chart_point *points = orl_array(log, all, sizeof *points);
    json_t **of = orl_array(log, all, sizeof(json_t *)), *row;
    enum orl_result result = points && of ? ORL_OK : ORL_ERR_MEMORY;
    json_array_foreach(rows, i, row) {
        if (result != ORL_OK || (scene && strcmp(orl_row_text(row, "scene"), scene) != 0))
            continue;
        points[count] = (struct orl_chart_point){
            .method = orl_row_text(row, "method"), .setting = orl_row_text(row, "setting"),
            .ms = orl_row_number(row, "frame_ms"),
            .db = orl_row_number(json_object_get(row, "mean"), "psnr_db"),
            .covered_db = orl_row_number(json_object_get(row, "mean"), "psnr_covered_db")};
        of[count++] = row;
    }
    orl_chart_find_front(points, count);
    for (size_t k = 0; k < count; k++)
        note_point(points, count, k, of[k]);
    free(points);
    free(of);
    return result;
}

// --- all scenes ---

static bool same_dot(const json_t *a, const json_t *b)
{
    return strcmp(orl_row_text(a, "method"), orl_row_text(b, "method")) == 0 &&
           strcmp(orl_row_text(a, "setting"), orl_row_text(b, "setting")) == 0;
}

// Mean of a figure and its standard deviation over the scenes, from the rows like `like`.
static void gather(const json_t *rows, const json_t *like, const char *key, json_t *mean,
                   json_t *sd)
{
    double sum = 0, square = 0, n = 0;
    size_t i;
    const json_t *row;
    json_array_foreach((json_t *)(uintptr_t)rows, i, row) {
        double value = orl_row_number(json_object_get(row, "mean"), key);
        if (!same_dot(row, like))
            continue;
        sum += value;
        square += value * value;
        n++;
    }
    json_object_set_new(mean, key, orl_number_json(sum / n));
    json_object_set_new(sd, key, orl_number_json(sqrt(fmax(square / n - sum * sum / (n * n), 0))));
}

// Arithmetic mean, or geometric mean (for times), of the rows like `like`; null when a row lacks
// it.
static json_t *mean_of(const json_t *rows, const json_t *like, const char *key, bool geometric)
{
    double sum = 0, n = 0;
    size_t i;
    const json_t *row;
    json_array_foreach((json_t *)(uintptr_t)rows, i, row) {
        double value = orl_row_number(row, key);
        if (!same_dot(row, like))
            continue;
        sum += geometric ? log(value) : value;
        n++;
    }
    return orl_number_json(geometric ? exp(sum / n) : sum / n);
}

static json_t *overall_row(const json_t *rows, const json_t *like, size_t scenes)
{
    json_t *mean = json_object(), *sd = json_object();
    for (size_t k = 0; k < CHART_FIGURES; k++)
        gather(rows, like, orl_chart_figures[k], mean, sd);
    return json_pack("{s:s, s:s, s:b, s:I, s:o, s:o, s:o, s:o, s:o, s:o, s:o, s:o}", "method",
                     orl_row_text(like, "method"), "setting",
                     orl_row_text(like, "setting"), "peer",
                     json_is_true(json_object_get(like, "peer")), "scenes", (json_int_t)scenes,
                     "mean", mean, "sd", sd, "flicker", mean_of(rows, like, "flicker", false),
                     "frame_ms", mean_of(rows, like, "frame_ms", true), "p95_ms",
                     mean_of(rows, like, "p95_ms", true), "cpu_ms",
                     mean_of(rows, like, "cpu_ms", true), "device_bytes",
                     mean_of(rows, like, "device_bytes", false), "host_peak_bytes",
                     mean_of(rows, like, "host_peak_bytes", false));
}

// Makes one row for each dot that every scene has.
static json_t *make_overall(const json_t *rows, size_t scenes)
{
    json_t *overall = json_array();
    size_t i, k;
    const json_t *row, *other;
    json_array_foreach((json_t *)(uintptr_t)rows, i, row) {
        size_t alike = 0, first = i;
        json_array_foreach((json_t *)(uintptr_t)rows, k, other) {
            if (!same_dot(row, other))
                continue;
            alike++;
            first = k < first ? k : first;
        }
        if (first == i && alike == scenes)
            json_array_append_new(overall, overall_row(rows, row, scenes));
    }
    return overall;
}

enum orl_result orl_chart_analyse(const struct orl_log *log, json_t *root)
{
    json_t *scenes = json_object_get(root, "scenes"), *rows = json_object_get(root, "rows");
    size_t i;
    json_t *scene;
    enum orl_result result = ORL_OK;
    json_array_foreach(scenes, i, scene)
        if (result == ORL_OK)
            result = analyse(log, rows, orl_row_text(scene, "name"));
    json_t *overall = make_overall(rows, json_array_size(scenes));
    if (json_object_set_new(root, "overall", overall) != 0)
        return orl_fail(log, ORL_ERR_MEMORY, "no memory for the chart");
    return result == ORL_OK ? analyse(log, overall, NULL) : result;
}
