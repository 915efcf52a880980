// What oriel tune found, as JSON: a report, and the scene's own record.
#ifndef ORL_EVAL_TUNE_JSON_H
#define ORL_EVAL_TUNE_JSON_H

#include <jansson.h>

#include "eval/tune.h"

// Keys and numbers of `best` that differ from the method's own, of all that may be tuned. New.
json_t *orl_tune_settings(const struct orl_render_params *best,
                          const struct orl_render_params *method);
enum orl_result orl_tune_write_json(const struct orl_log *log, const char *path,
                                    const struct orl_scene *scene,
                                    const struct orl_method *method, const char *device,
                                    int size_divide, const struct orl_tune *tune) ORL_CHECK_RESULT;
// Keeps the result in scene.json, for all that render the scene.
enum orl_result orl_tune_apply(const struct orl_log *log, const struct orl_scene *scene,
                               const struct orl_method *method, int size_divide,
                               const struct orl_tune *tune) ORL_CHECK_RESULT;

#endif
