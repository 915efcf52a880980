#include "eval/tune_json.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "core/json.h"
#include "eval/choice.h"
#include "scene/tuned_settings.h"

static json_t *record(const struct orl_method *method, int size_divide,
                      const struct orl_tune *tune)
{
    return json_pack("{s:o, s:f, s:f, s:I, s:i, s:b}", "settings",
                     orl_choice_settings(method, &tune->best), "before_psnr_db",
                     tune->start_db, "psnr_db", tune->best_db, "photographs",
                     (json_int_t)tune->views, "size_divide", size_divide, "complete",
                     tune->complete);
}

enum orl_result orl_tune_write_json(const struct orl_log *log, const char *path,
                                    const struct orl_scene *scene,
                                    const struct orl_method *method, const char *device,
                                    int size_divide, const struct orl_tune *tune)
{
    json_t *root = record(method, size_divide, tune), *trials = json_array();
    for (size_t i = 0; i < tune->trial_count; i++) {
        const struct orl_tune_trial *t = &tune->trials[i];
        json_array_append_new(trials, json_pack("{s:o, s:o, s:f, s:f, s:b}", "key",
                                                t->key ? json_string(t->key) : json_null(),
                                                "value", t->key ? json_real(t->value)
                                                                : json_null(),
                                                "psnr_db", t->psnr_db, "ssim", t->ssim, "kept",
                                                t->kept));
    }
    json_object_set_new(root, "scene", orl_json_string(scene->dir));
    json_object_set_new(root, "method", json_string(method->name));
    json_object_set_new(root, "device", json_string(device));
    enum orl_result result = json_object_set_new(root, "trials", trials) == 0
                                 ? orl_json_write(log, path, root)
                                 : orl_fail(log, ORL_ERR_MEMORY, "%s: no memory for it", path);
    json_decref(root);
    return result;
}

enum orl_result orl_tune_apply(const struct orl_log *log, const struct orl_scene *scene,
                               const struct orl_method *method, int size_divide,
                               const struct orl_tune *tune)
{
    return orl_tuned_write(log, scene->dir, method->name,
                                    record(method, size_divide, tune));
}
