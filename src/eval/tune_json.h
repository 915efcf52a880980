// The result of oriel tune as JSON: a report, and the record in the scene.
#ifndef ORL_EVAL_TUNE_JSON_H
#define ORL_EVAL_TUNE_JSON_H

#include <jansson.h>

#include "eval/tune.h"

enum orl_result orl_tune_write_json(const struct orl_log *log, const char *path,
                                    const struct orl_scene *scene,
                                    const struct orl_method *method, const char *device,
                                    int size_divide, const struct orl_tune *tune) ORL_CHECK_RESULT;
// Records the result in scene.json, where every command that renders the scene uses it.
enum orl_result orl_tune_apply(const struct orl_log *log, const struct orl_scene *scene,
                               const struct orl_method *method, int size_divide,
                               const struct orl_tune *tune) ORL_CHECK_RESULT;

#endif
