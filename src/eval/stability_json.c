// The report of a walk.
#include <jansson.h>

#include "core/json.h"
#include "eval/internal.h"
#include "eval/stability.h"

static json_t *step_json(const struct orl_stability_step *s)
{
    return json_pack("{s:f,s:f,s:f,s:f,s:f,s:f,s:[ii],s:f}", "compared", s->compared, "mean",
                     s->mean, "p99", s->p99, "floor", s->floor, "block_mean", s->block_mean,
                     "block_worst", s->block_worst, "block_at", s->block_x, s->block_y, "jump",
                     s->jump);
}

static json_t *stability_json(const struct orl_scene *scene, const struct orl_stability *s)
{
    json_t *steps = json_array();
    for (size_t i = 0; steps && i < s->step_count; i++)
        if (json_array_append_new(steps, step_json(&s->steps[i])) != 0) {
            json_decref(steps);
            steps = NULL;
        }
    return json_pack("{s:o,s:s,s:s,s:[ii],s:I,s:f,s:I,s:I,s:o,s:o}", "scene", orl_json_string(scene->dir), "method",
                     s->method, "device", s->device, "size", s->width, s->height, "frames",
                     (json_int_t)(s->step_count + 1), "render_ms", s->render_ms, "worst_block_step",
                     (json_int_t)s->worst_block_step, "worst_jump_step",
                     (json_int_t)s->worst_jump_step, "all", step_json(&s->all), "steps", steps);
}

char *orl_stability_to_json(const struct orl_log *log, const struct orl_scene *scene,
                            const struct orl_stability *all, size_t count, bool array)
{
    json_t *root = json_array();
    for (size_t i = 0; i < count; i++)
        json_array_append_new(root, stability_json(scene, &all[i]));
    return orl_reports_to_text(log, root, count, array, 6);
}
