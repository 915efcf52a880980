// The report: where each method loses how much, figures, the page.
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "core/file.h"
#include "core/json.h"
#include "core/memory.h"
#include "eval/report_page.h"
#include "eval/stress_internal.h"
#include "io/svg_plot.h"

const double orl_stress_losses_db[ORL_STRESS_LOSSES] = {1, 3, 6};

double orl_stress_loss_at(const double *levels, const double *psnr, size_t count, double loss_db)
{
    double limit = count ? psnr[0] - loss_db : 0, level = count ? levels[0] : 0;
    double last = count ? psnr[0] : 0;
    for (size_t i = 1; i < count; i++) {
        if (!isfinite(psnr[i]))
            continue;
        if (psnr[i] <= limit)
            return level + (levels[i] - level) * (last - limit) / (last - psnr[i]);
        level = levels[i];
        last = psnr[i];
    }
    return (double)NAN;
}

// --- the rows of a method on an axis ---

struct curve {
    double levels[ORL_STRESS_LEVELS], psnr[ORL_STRESS_LEVELS];
    size_t count;
};

static struct curve curve_of(const json_t *root, const json_t *axis, const char *method)
{
    struct curve curve = {.count = 0};
    const json_t *levels = json_object_get(axis, "levels"), *rows = json_object_get(root, "rows");
    const json_t *row;
    size_t i;
    for (; curve.count < json_array_size(levels); curve.count++) {
        curve.levels[curve.count] = json_number_value(json_array_get(levels, curve.count));
        curve.psnr[curve.count] = (double)NAN;
    }
    json_array_foreach((json_t *)(uintptr_t)rows, i, row) {
        if (strcmp(orl_row_text(row, "axis"), orl_row_text(axis, "name")) != 0 ||
            strcmp(orl_row_text(row, "method"), method) != 0)
            continue;
        for (size_t k = 0; k < curve.count; k++)
            if (fabs(curve.levels[k] - orl_row_number(row, "level")) < 1e-9)
                curve.psnr[k] = orl_row_number(json_object_get(row, "mean"), "psnr_db");
    }
    return curve;
}

static json_t *loss_json(const json_t *axis, const char *method, const struct curve *curve)
{
    double worst = curve->psnr[0];
    json_t *at = json_array();
    for (size_t k = 1; k < curve->count; k++)
        worst = isfinite(curve->psnr[k]) ? fmin(worst, curve->psnr[k]) : worst;
    for (size_t k = 0; k < ORL_STRESS_LOSSES; k++)
        json_array_append_new(at, orl_number_json(orl_stress_loss_at(
            curve->levels, curve->psnr, curve->count, orl_stress_losses_db[k])));
    return json_pack("{s:s, s:s, s:s, s:f, s:f, s:f, s:o}", "axis", orl_row_text(axis, "name"),
                     "unit", orl_row_text(axis, "unit"), "method", method, "start_db",
                     curve->psnr[0], "worst_db", worst, "lost_db", curve->psnr[0] - worst, "at",
                     at);
}

enum orl_result orl_stress_analyse(const struct orl_log *log, json_t *root)
{
    const json_t *axes = json_object_get(root, "axes"), *methods = json_object_get(root, "methods");
    json_t *losses = json_array();
    for (size_t a = 0; a < json_array_size(axes); a++)
        for (size_t m = 0; m < json_array_size(methods); m++) {
            const char *method = json_string_value(json_array_get(methods, m));
            struct curve curve = curve_of(root, json_array_get(axes, a), method);
            if (curve.count && isfinite(curve.psnr[0]))
                json_array_append_new(losses,
                                      loss_json(json_array_get(axes, a), method, &curve));
        }
    return json_object_set_new(root, "losses", losses) == 0
               ? ORL_OK : orl_fail(log, ORL_ERR_MEMORY, "no memory for the report");
}

// --- figures ---

static enum orl_result write_figure(const struct orl_log *log, const char *out, const json_t *root,
                                    const json_t *axis)
{
    const json_t *methods = json_object_get(root, "methods");
    size_t count = json_array_size(methods);
    struct curve *curves = orl_array(log, count, sizeof *curves);
    struct orl_plot_series *series = orl_array(log, count, sizeof *series);
    const char *unit = orl_row_text(axis, "unit");
    char label[160], subtitle[320], file[96];
    char *path = NULL, *svg = NULL;
    snprintf(label, sizeof label, "%s%s%s", orl_row_text(axis, "title"), unit[0] ? ", " : "", unit);
    snprintf(subtitle, sizeof subtitle, "%.100s; %.100s",
             orl_row_text(json_object_get(root, "scene"), "name"), orl_row_text(root, "device"));
    snprintf(file, sizeof file, "stress.%.60s.svg", orl_row_text(axis, "name"));
    enum orl_result result = curves && series ? ORL_OK : ORL_ERR_MEMORY;
    for (size_t m = 0; result == ORL_OK && m < count; m++) {
        const char *method = json_string_value(json_array_get(methods, m));
        curves[m] = curve_of(root, axis, method);
        series[m] = (struct orl_plot_series){.name = method, .x = curves[m].levels,
                                             .y = curves[m].psnr, .count = curves[m].count,
                                             .line = true};
    }
    if (result == ORL_OK) {
        path = orl_path_join(log, out, file);
        svg = orl_plot_svg(log, &(struct orl_plot){
            .title = "Accuracy as one thing gets worse", .subtitle = subtitle, .x_label = label,
            .y_label = "PSNR of whole pictures, dB", .y_fit = true, .series = series,
            .series_count = count});
        result = svg && path ? orl_file_write(log, path, svg, strlen(svg)) : ORL_ERR_MEMORY;
    }
    free(path);
    free(svg);
    free(curves);
    free(series);
    return result;
}

// --- the page ---

static enum orl_result write_page(const struct orl_log *log, const char *out, const json_t *root)
{
    struct orl_names pictures = {0};
    const json_t *rows = json_object_get(root, "rows");
    enum orl_result result = ORL_OK;
    for (size_t i = 0; result == ORL_OK && i < json_array_size(rows); i++) {
        static const char *const keys[] = {"picture", "truth"};
        for (size_t k = 0; result == ORL_OK && k < ORL_COUNT(keys); k++) {
            const char *name = orl_row_text(json_array_get(rows, i), keys[k]);
            if (!orl_names_contain(&pictures, name))
                result = orl_names_add(log, &pictures, name);
        }
    }
    if (result == ORL_OK)
        result = orl_page_write(log, &(struct orl_page){.dir = out, .file = "stress.html",
                                                        .html = orl_stress_page, .data = root,
                                                        .pictures = &pictures});
    orl_names_finish(&pictures);
    return result;
}

enum orl_result orl_stress_write(const struct orl_log *log, const char *out, const json_t *root)
{
    char *path = orl_path_join(log, out, "stress.json");
    const json_t *axes = json_object_get(root, "axes");
    enum orl_result result = path ? orl_json_write(log, path, root) : ORL_ERR_MEMORY;
    for (size_t i = 0; result == ORL_OK && i < json_array_size(axes); i++)
        result = write_figure(log, out, root, json_array_get(axes, i));
    if (result == ORL_OK)
        result = write_page(log, out, root);
    free(path);
    return result;
}
