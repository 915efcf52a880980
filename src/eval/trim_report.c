// The report of oriel trim as JSON and as figures.
#include <jansson.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "core/file.h"
#include "core/json.h"
#include "core/memory.h"
#include "eval/trim.h"
#include "io/svg_plot.h"

enum { MIB = 1 << 20 };

static json_t *figures_json(const struct orl_trim_figures *f)
{
    return json_pack("{s:I, s:I, s:I, s:I, s:I, s:I, s:f, s:f, s:f, s:f, s:f, s:f}", "points",
                     (json_int_t)f->points, "photographs", (json_int_t)f->photographs,
                     "point_bytes", (json_int_t)f->point_bytes, "photo_bytes",
                     (json_int_t)f->photo_bytes, "device_bytes", (json_int_t)f->device_bytes,
                     "file_bytes", (json_int_t)f->file_bytes, "frame_ms", f->frame_ms, "psnr_db",
                     f->psnr_db, "ssim", f->ssim, "worst_loss_db", f->worst_loss_db,
                     "held_psnr_db", f->held_psnr_db, "held_ssim", f->held_ssim);
}

static json_t *step_json(const struct orl_trim_step *s)
{
    return json_pack("{s:s, s:o, s:f, s:f, s:f, s:f, s:b, s:b, s:f, s:f, s:f, s:f, s:f}", "part",
                     orl_trim_part_names[s->part], "what", orl_json_string(s->what), "loss_db",
                     s->loss_db, "saved_bytes", s->saved_bytes, "saved_ms", s->saved_ms,
                     "saved_file_bytes", s->saved_file_bytes, "first", s->first, "taken", s->taken,
                     "bytes", s->bytes, "ms", s->ms, "total_loss_db", s->total_loss_db, "loss_ssim",
                     s->loss_ssim, "total_loss_ssim", s->total_loss_ssim);
}

enum orl_result orl_trim_write_json(const struct orl_log *log, const char *path,
                                    const struct orl_scene *scene, const char *device,
                                    const struct orl_trim *trim)
{
    json_t *steps = json_array(), *random = json_array();
    for (size_t i = 0; i < trim->step_count; i++)
        json_array_append_new(steps, step_json(&trim->steps[i]));
    for (size_t i = 0; i < trim->random_count; i++)
        json_array_append_new(random, json_pack("{s:f, s:f}", "bytes", trim->random[i].bytes,
                                                "loss_db", trim->random[i].loss_db));
    json_t *root = json_pack(
        "{s:o, s:s, s:s, s:o, s:o, s:o, s:b, s:I, s:o, s:o}", "scene", orl_json_string(scene->dir),
        "device", device, "method", trim->choice.method->name, "settings",
        orl_choice_settings(trim->choice.method, &trim->choice.params), "before",
        figures_json(&trim->before), "after", figures_json(&trim->after), "complete",
        trim->complete, "undone", (json_int_t)trim->undone, "steps", steps, "random", random);
    enum orl_result result = root ? orl_json_write(log, path, root)
                                  : orl_fail(log, ORL_ERR_MEMORY, "%s: no memory for it", path);
    json_decref(root);
    return result;
}

static enum orl_result save(const struct orl_log *log, const char *dir, const char *name,
                            char *svg)
{
    char *path = svg ? orl_path_join(log, dir, name) : NULL;
    enum orl_result result =
        path ? orl_file_write(log, path, svg, strlen(svg)) : ORL_ERR_MEMORY;
    free(path);
    free(svg);
    return result;
}

// A row for the whole scene and one for each step that was taken: what is left, and what it saved.
static enum orl_result write_waterfall(const struct orl_log *log, const char *dir,
                                       const char *title, const struct orl_trim *trim)
{
    static const char *const parts[] = {"left", "saved by this step"};
    size_t count = 0;
    const char **rows = orl_array(log, trim->step_count + 1, sizeof *rows);
    char (*labels)[128] = orl_array(log, trim->step_count + 1, sizeof *labels);
    double *values = orl_array(log, 2 * (trim->step_count + 1), sizeof *values);
    enum orl_result result = rows && labels && values ? ORL_OK : ORL_ERR_MEMORY;
    double bytes = (double)(trim->before.point_bytes + trim->before.photo_bytes);
    if (result == ORL_OK) {
        snprintf(labels[0], sizeof labels[0], "whole scene");
        values[0] = bytes / MIB;
        rows[count++] = labels[0];
    }
    for (size_t i = 0; result == ORL_OK && i < trim->step_count; i++) {
        const struct orl_trim_step *s = &trim->steps[i];
        if (!s->taken || s->saved_bytes <= 0)
            continue;
        // The figure has room for so much beside a bar.
        snprintf(labels[count], sizeof labels[count], "%.19s %+.2f dB", s->what, -s->loss_db);
        values[2 * count] = s->bytes / MIB;
        values[2 * count + 1] = s->saved_bytes / MIB;
        rows[count] = labels[count];
        count++;
    }
    const struct orl_bars bars = {.title = title,
                                  .subtitle = "the model on the device, step by step",
                                  .x_label = "MiB", .parts = parts, .part_count = 2, .rows = rows,
                                  .values = values, .row_count = count};
    if (result == ORL_OK)
        result = save(log, dir, "waterfall.svg", orl_bars_svg(log, &bars));
    free(rows);
    free(labels);
    free(values);
    return result;
}

static enum orl_result write_curve(const struct orl_log *log, const char *dir, const char *title,
                                   const struct orl_trim *trim)
{
    size_t n = 1;
    double whole = (double)(trim->before.point_bytes + trim->before.photo_bytes);
    double *x = orl_array(log, trim->step_count + 1, sizeof *x);
    double *y = orl_array(log, trim->step_count + 1, sizeof *y);
    double rx[ORL_TRIM_RANDOM_ROWS + 1] = {whole / MIB}, ry[ORL_TRIM_RANDOM_ROWS + 1] = {0};
    enum orl_result result = x && y ? ORL_OK : ORL_ERR_MEMORY;
    if (result == ORL_OK)
        x[0] = whole / MIB;
    for (size_t i = 0; result == ORL_OK && i < trim->step_count; i++) {
        if (!trim->steps[i].taken)
            continue;
        x[n] = trim->steps[i].bytes / MIB;
        y[n++] = -trim->steps[i].total_loss_db;
    }
    for (size_t i = 0; i < trim->random_count; i++) {
        rx[i + 1] = trim->random[i].bytes / MIB;
        ry[i + 1] = -trim->random[i].loss_db;
    }
    const struct orl_plot_series series[] = {
        {.name = "trim", .x = x, .y = y, .count = n, .line = true},
        {.name = "points and photographs removed at random", .x = rx, .y = ry,
         .count = trim->random_count + 1, .line = true}};
    const struct orl_plot plot = {.title = title, .subtitle = "training photographs, each left out",
                                  .x_label = "model on the device, MiB",
                                  .y_label = "PSNR against the whole scene, dB", .y_fit = true,
                                  .series = series, .series_count = trim->random_count ? 2 : 1};
    if (result == ORL_OK)
        result = save(log, dir, "curve.svg", orl_plot_svg(log, &plot));
    free(x);
    free(y);
    return result;
}

enum orl_result orl_trim_write_plots(const struct orl_log *log, const char *dir,
                                     const struct orl_scene *scene, const struct orl_trim *trim)
{
    const char *title = orl_path_name(scene->dir);
    enum orl_result result = orl_dir_make(log, dir);
    if (result == ORL_OK)
        result = write_waterfall(log, dir, title, trim);
    return result == ORL_OK ? write_curve(log, dir, title, trim) : result;
}
