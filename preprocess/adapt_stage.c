#include "preprocess/adapt_stage.h"

#include "eval/adapt.h"
#include "preprocess/drawing.h"
#include "preprocess/scene_json.h"
#include "scene/tuned_settings.h"

json_t *orl_stage_adapt_settings(const struct orl_job *job)
{
    const struct orl_prepare_params *p = job->params;
    return json_pack("{s:o*}", "budget_s",
                     p->adapt == ORL_ADAPT_LONG ? json_real(p->adapt_budget_s) : NULL);
}

static void log_rows(const struct orl_log *log, const struct orl_adapt *adapt)
{
    for (size_t i = 0; i < adapt->row_count; i++)
        orl_logf(log, ORL_LOG_INFO, "adapt: %-14s %7.2f dB %7.4f%s", adapt->rows[i].method->name,
                 adapt->rows[i].psnr_db, adapt->rows[i].ssim,
                 i == adapt->chosen ? "  chosen" : "");
}

static enum orl_result note(const struct orl_log *log, const struct orl_adapt *adapt,
                            json_t *record)
{
    json_t *found = orl_adapt_json(adapt);
    json_t *figures = json_pack("{s:I, s:f, s:f, s:f, s:f, s:b}", "views",
                                (json_int_t)adapt->views, "plain_psnr_db", adapt->plain_db,
                                "plain_ssim", adapt->plain_ssim, "psnr_db", adapt->tuned_db, "ssim",
                                adapt->tuned_ssim, "complete", adapt->complete);
    bool noted = found && figures && json_object_update(record, found) == 0 &&
                 json_object_update(record, figures) == 0;
    json_decref(figures);
    json_decref(found);
    return noted ? ORL_OK : orl_fail(log, ORL_ERR_MEMORY, "no memory for what adapt found");
}

static enum orl_result adapt(struct orl_job *job, struct orl_gpu *gpu,
                             const struct orl_scene *scene, json_t *record)
{
    struct orl_adapt adapt = {0};
    const struct orl_adapt_params params = {.search = job->params->adapt == ORL_ADAPT_LONG,
                                            .views = ORL_ADAPT_VIEWS, .size_divide = 1,
                                            .budget_s = job->params->adapt_budget_s,
                                            .progress = job->progress};
    enum orl_result result = orl_adapt_run(gpu, scene, &params, &adapt);
    if (result != ORL_OK)
        return result;
    json_object_set_new(record, "device", json_string(orl_gpu_caps(gpu)->renderer));
    log_rows(job->log, &adapt);
    return note(job->log, &adapt, record);
}

enum orl_result orl_stage_adapt(struct orl_job *job, json_t *record)
{
    struct orl_scene *scene = NULL;
    struct orl_drawing drawing;
    enum orl_result result = orl_scene_json_open(job, &scene);
    if (result != ORL_OK)
        return result;
    orl_drawing_begin(job, scene, "adapt: the usual method stays", &drawing);
    if (drawing.gpu)
        result = adapt(job, drawing.gpu, scene, record);
    else
        json_object_set_new(record, "render", orl_defaults_json(&scene->defaults));
    orl_drawing_end(&drawing);
    orl_scene_destroy(&scene);
    return result;
}
