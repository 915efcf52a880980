#include "walk/choices.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>

#include "core/json.h"

enum { SETTINGS_MAX = 64, SETTING_BYTES_MAX = 160 };

// --- what there is ---

static json_t *names_json(const struct orl_option *option)
{
    json_t *names = json_array();
    char name[ORL_OPTION_TEXT];
    for (size_t i = 0; orl_option_name(option, i, name); i++)
        json_array_append_new(names, json_string(name));
    return names;
}

static json_t *option_json(const struct orl_option *option)
{
    json_t *json = json_pack("{s:s, s:s}", "key", option->name, "help", option->help);
    json_t *more = option->kind == ORL_VALUE_FLOAT
                       ? json_pack("{s:f, s:f, s:s}", "least", option->low, "most", option->high,
                                   "unit", option->meta)
                       : json_pack("{s:o}", "names", names_json(option));
    json_object_update_new(json, more);
    return json;
}

json_t *orl_walk_methods_json(const struct orl_choice *chosen)
{
    json_t *list = json_array(), *options = json_array();
    for (const struct orl_method *m = orl_methods; m->name; m++)
        json_array_append_new(list, json_pack("{s:s, s:s}", "name", m->name, "description",
                                              m->description));
    for (const struct orl_option *o = orl_render_options(); o->name; o++)
        json_array_append_new(options, option_json(o));
    return json_pack("{s:o, s:o, s:o}", "list", list, "options", options, "chosen",
                     orl_walk_choice_json(chosen));
}

json_t *orl_walk_choice_json(const struct orl_choice *choice)
{
    json_t *values = json_object();
    for (const struct orl_option *o = orl_render_options(); o->name; o++) {
        char text[ORL_OPTION_TEXT];
        if (orl_render_option_read(o, &choice->params) && orl_option_print(o, &choice->params, text))
            json_object_set_new(values, o->name, json_string(text));
    }
    return json_pack("{s:s, s:o}", "name", choice->method->name, "values", values);
}

// --- what a client chooses ---

bool orl_walk_choice_asked(const json_t *message)
{
    const json_t *set = json_object_get(message, "set");
    size_t i;
    json_t *one;
    if (!orl_json_text(message, "method") || !json_is_array(set) ||
        json_array_size(set) > SETTINGS_MAX)
        return false;
    json_array_foreach(set, i, one)
        if (!json_is_string(one) || json_string_length(one) > SETTING_BYTES_MAX)
            return false;
    return true;
}

// Keeps the first message of a log.
static void keep(void *priv, enum orl_log_level level, const char *message)
{
    char *problem = priv;
    (void)level;
    if (!*problem)
        snprintf(problem, WALK_PROBLEM_BYTES, "%s", message);
}

enum orl_result orl_walk_choice_read(const struct orl_scene *scene, const json_t *message,
                                     struct orl_choice *choice, char problem[WALK_PROBLEM_BYTES])
{
    const struct orl_log log = {.level = ORL_LOG_ERROR, .print = keep, .priv = problem};
    struct orl_names settings = {0};
    struct orl_choice made;
    enum orl_result result = ORL_OK;
    size_t i;
    json_t *one;
    *problem = '\0';
    json_array_foreach(json_object_get(message, "set"), i, one)
        if (result == ORL_OK)
            result = orl_names_add(&log, &settings, json_string_value(one));
    if (result == ORL_OK)
        result = orl_choice_make(&log, scene, choice->params.sample,
                                 orl_json_text(message, "method"), &settings, &made);
    if (result == ORL_OK)
        *choice = made;
    else if (!*problem)
        snprintf(problem, WALK_PROBLEM_BYTES, "%s", orl_result_message(result));
    orl_names_finish(&settings);
    return result;
}

struct orl_render_params orl_walk_moving_params(const struct orl_render_params *params)
{
    const struct orl_render_params *fast = &orl_method_find(NULL, "oriel-fast")->params;
    struct orl_render_params moving = *params;
    moving.sampling = fast->sampling;
    moving.antialias = fast->antialias;
    moving.guess_depths = fminf(params->guess_depths, fast->guess_depths);
    moving.reconstructions = 1;
    moving.photos_per_pixel = fminf(params->photos_per_pixel, fast->photos_per_pixel);
    moving.soft = 0;
    return moving;
}
