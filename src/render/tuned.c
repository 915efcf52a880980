// A method's parameters as they suit a scene.
#include <stdio.h>
#include <string.h>

#include "render/render.h"

enum orl_result orl_render_params_tuned(const struct orl_log *log, const struct orl_method *method,
                                        const struct orl_scene *scene,
                                        struct orl_render_params *params)
{
    enum orl_result result = ORL_OK;
    *params = method->params;
    for (size_t i = 0; result == ORL_OK && i < scene->tuned_count; i++) {
        const struct orl_tuned *tuned = &scene->tuned[i];
        char assignment[128];
        if (strcmp(tuned->method, method->name) != 0)
            continue;
        snprintf(assignment, sizeof assignment, "%s=%.9g", tuned->key, tuned->value);
        result = orl_render_params_set(log, params, assignment);
        if (result != ORL_OK)
            result = orl_fail(log, ORL_ERR_FORMAT,
                              "%s/scene.json: \"tuned\" of %s does not fit this program; run "
                              "oriel tune again", scene->dir, method->name);
    }
    return result;
}
