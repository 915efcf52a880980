#include "eval/chart.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "core/json.h"
#include "core/memory.h"
#include "eval/chart_internal.h"
#include "eval/commit.h"
#include "eval/eval.h"

enum { QUICK_VIEWS = 2, QUICK_DIVIDE = 2 };

struct job {
    const struct orl_log *log;
    struct orl_gpu *gpu;
    const struct orl_chart_params *params;
    struct orl_chart *chart;
    json_t *scenes, *rows; // of chart->json
    double done, total;    // number of rows, for the progress report
};

// --- one scene ---

static void finish_scene(struct chart_scene *scene)
{
    for (size_t i = 0; i < scene->view_count; i++)
        orl_heldout_finish(&scene->views[i]);
    free(scene->views);
    json_decref(scene->json);
    orl_scene_destroy(&scene->scene);
}

// Seconds that all stages of prepare took; null when scene.json lacks them.
static json_t *prepare_time(const struct orl_log *log, const struct orl_scene *scene)
{
    json_t *root = NULL, *stages, *stage;
    const char *name;
    double sum = 0;
    char *path = orl_path_join(log, scene->dir, "scene.json");
    if (path && orl_path_is_file(path) && orl_json_read(log, path, &root) == ORL_OK) {
        stages = json_object_get(root, "stages");
        json_object_foreach(stages, name, stage)
            sum += json_number_value(json_object_get(stage, "wall_s"));
    }
    json_decref(root);
    free(path);
    return sum > 0 ? json_real(sum) : json_null();
}

static enum orl_result open_scene(struct job *job, const char *dir, struct chart_scene *scene)
{
    char *whole = realpath(dir, NULL); // "." and "scene/" do not end in the folder's name
    *scene = (struct chart_scene){.gpu = job->gpu, .params = job->params};
    enum orl_result result = orl_scene_open(job->log, whole ? whole : dir, &scene->scene);
    free(whole);
    if (result == ORL_OK)
        result = orl_eval_check(job->log, scene->scene);
    if (result == ORL_OK)
        result = orl_row_checksum(job->log, scene->scene, scene->checksum);
    if (result == ORL_OK)
        result = orl_heldout_load_some(job->log, scene->scene,
                                       job->params->quick ? QUICK_VIEWS : job->params->views,
                                       job->params->quick ? QUICK_DIVIDE : 1, &scene->views,
                                       &scene->view_count);
    if (result != ORL_OK)
        return result;
    const struct orl_scene *s = scene->scene;
    size_t held = orl_heldout_count(s);
    scene->json = json_pack("{s:s, s:s, s:s, s:I, s:I, s:I, s:o}", "name", orl_path_name(s->dir),
                            "dir", s->dir, "checksum", scene->checksum, "photographs",
                            (json_int_t)(s->photo_count - held), "held_out", (json_int_t)held,
                            "points", (json_int_t)s->points.count, "prepare_s",
                            prepare_time(job->log, s));
    if (!scene->json)
        return orl_fail(job->log, ORL_ERR_MEMORY, "%s: no memory, or a name that is not UTF-8",
                        dir);
    scene->name = json_string_value(json_object_get(scene->json, "name"));
    for (size_t i = 0; i < json_array_size(job->scenes); i++)
        if (strcmp(scene->name, json_string_value(json_object_get(
                                    json_array_get(job->scenes, i), "name"))) == 0)
            return orl_fail(job->log, ORL_ERR_ARGUMENT, "chart: two scenes are named %s",
                            scene->name);
    json_array_append(job->scenes, scene->json);
    return orl_chart_write_photographs(scene);
}

static void report(struct job *job, const char *scene, const char *id)
{
    char text[256];
    snprintf(text, sizeof text, "%s %s", scene, id);
    orl_progress_report(job->params->progress, "chart", job->done, job->total, text);
}

// A row that cannot be measured is left out, and the others are still measured.
static enum orl_result add_config(struct job *job, const struct chart_scene *scene,
                                  const struct chart_config *config)
{
    char id[ORL_ROW_ID_MAX];
    enum orl_result result = ORL_OK;
    orl_row_id(config->method->name, config->setting, id);
    report(job, scene->name, id);
    json_t *row = orl_chart_load_row(scene, id);
    if (row) {
        job->chart->reused++;
    } else {
        result = orl_progress_cancelled(job->params->progress)
                     ? ORL_ERR_CANCELLED
                     : orl_chart_measure(scene, config, &row);
        if (result == ORL_OK)
            result = orl_chart_keep_row(scene, id, &row);
        job->chart->measured += result == ORL_OK;
    }
    job->done++;
    if (result != ORL_OK && result != ORL_ERR_CANCELLED && result != ORL_ERR_MEMORY &&
        result != ORL_ERR_IO) {
        orl_logf(job->log, ORL_LOG_WARNING, "%s: %s is left out of the chart", scene->name, id);
        job->chart->left_out++;
        result = ORL_OK;
    }
    if (row)
        json_array_append_new(job->rows, row);
    return result;
}

static enum orl_result add_peer(struct job *job, const struct chart_scene *scene,
                                const struct orl_chart_peer *peer)
{
    json_t *row = NULL;
    report(job, scene->name, peer->name);
    enum orl_result result = orl_chart_peer_row(scene, peer, &row);
    if (result == ORL_OK && !row)
        orl_logf(job->log, ORL_LOG_WARNING, "%s: no picture of %s in %s", peer->name,
                 scene->name, peer->dir);
    if (row)
        json_array_append_new(job->rows, row);
    return result;
}

static enum orl_result chart_scene(struct job *job, const char *dir)
{
    struct chart_scene scene;
    struct chart_plan plan = {0};
    enum orl_result result = open_scene(job, dir, &scene);
    if (result == ORL_OK)
        result = orl_chart_make_plan(job->gpu, scene.scene, job->params, &plan);
    if (job->total == 0)
        job->total = (double)(plan.count * job->params->scene_count) /
                     (job->params->part.count ? job->params->part.count : 1);
    for (size_t i = 0; result == ORL_OK && i < plan.count; i++)
        if (orl_row_part_has(&job->params->part, i))
            result = add_config(job, &scene, &plan.items[i]);
    // Rows of peers are not kept.
    for (size_t i = 0; result == ORL_OK && !job->params->part.count &&
                       i < job->params->peer_count; i++)
        result = add_peer(job, &scene, &job->params->peers[i]);
    free(plan.items);
    finish_scene(&scene);
    return result;
}

// --- the rows for the command's table ---

static void list_rows(struct orl_chart *chart, const json_t *list)
{
    for (size_t i = 0; i < json_array_size(list); i++) {
        const json_t *row = json_array_get(list, i), *mean = json_object_get(row, "mean");
        chart->rows[chart->row_count++] = (struct orl_chart_row){
            .scene = json_string_value(json_object_get(row, "scene")),
            .method = json_string_value(json_object_get(row, "method")),
            .setting = json_string_value(json_object_get(row, "setting")),
            .psnr_db = orl_row_number(mean, "psnr_db"), .ssim = orl_row_number(mean, "ssim"),
            .flip = orl_row_number(mean, "flip"), .crumbs = orl_row_number(mean, "crumbs"),
            .frame_ms = orl_row_number(row, "frame_ms"),
            .device_mib = orl_row_number(row, "device_bytes") / (1 << 20),
            .on_front = json_is_true(json_object_get(row, "on_front"))};
    }
}

static enum orl_result finish_chart(struct job *job, json_t *root)
{
    enum orl_result result = orl_chart_analyse(job->log, root);
    if (result == ORL_OK)
        result = orl_chart_write(job->log, job->params->out, root);
    const json_t *overall = json_object_get(root, "overall");
    job->chart->rows = orl_array(job->log, json_array_size(job->rows) + json_array_size(overall),
                                 sizeof *job->chart->rows);
    if (!job->chart->rows)
        return ORL_ERR_MEMORY;
    list_rows(job->chart, job->rows);
    if (json_array_size(job->scenes) > 1)
        list_rows(job->chart, overall);
    return result;
}

enum orl_result orl_chart_run(struct orl_gpu *gpu, const struct orl_chart_params *params,
                              struct orl_chart *chart)
{
    struct job job = {.log = orl_gpu_log(gpu), .gpu = gpu, .params = params, .chart = chart};
    const struct orl_gpu_caps *caps = orl_gpu_caps(gpu);
    memset(chart, 0, sizeof *chart);
    enum orl_result result = orl_dir_make(job.log, params->out);
    if (result != ORL_OK)
        return result;
    json_t *root = json_pack("{s:i, s:s, s:s, s:s, s:b, s:b, s:[], s:[]}", "version", 1, "commit",
                             orl_commit(), "device", caps->renderer, "driver", caps->version,
                             "software", caps->software, "quick", params->quick, "scenes",
                             "rows");
    chart->json = root;
    job.scenes = json_object_get(root, "scenes");
    job.rows = json_object_get(root, "rows");
    if (!root)
        return orl_fail(job.log, ORL_ERR_MEMORY, "no memory for the chart");
    for (size_t i = 0; result == ORL_OK && i < params->scene_count; i++)
        result = chart_scene(&job, params->scenes[i]);
    if (result == ORL_OK && !params->part.count)
        result = finish_chart(&job, root);
    if (result == ORL_OK)
        orl_progress_report(params->progress, "chart", 1, 1, NULL);
    else
        orl_chart_finish(chart);
    return result;
}

void orl_chart_finish(struct orl_chart *chart)
{
    json_decref(chart->json);
    free(chart->rows);
    memset(chart, 0, sizeof *chart);
}
