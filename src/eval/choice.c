#include "eval/choice.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "core/arguments.h"
#include "core/memory.h"

// The setting of a paper's method on the proxy and background of the first method, oriel.
static const char paired_setting[] = "on the proxy of oriel";

// What all choices of a command have in common.
struct wish {
    const struct orl_log *log;
    const struct orl_scene *scene; // NULL: tuned values are not used
    enum orl_sample sample;
    const struct orl_names *settings;
    const char *varied; // "KEY=A,B,.."; NULL: none
};

static enum orl_result make(const struct wish *wish, const struct orl_method *method,
                            struct orl_choice *choice)
{
    *choice = (struct orl_choice){.method = method, .params = method->params};
    if (wish->scene)
        orl_render_params_tuned(wish->log, method, wish->scene, &choice->params);
    choice->params.sample = wish->sample;
    return orl_render_params_assign(wish->log, &choice->params, (const char *const *)wish->settings->items,
                                    wish->settings->count);
}

enum orl_result orl_choice_make(const struct orl_log *log, const struct orl_scene *scene,
                                enum orl_sample sample, const char *name,
                                const struct orl_names *settings, struct orl_choice *choice)
{
    const struct wish wish = {log, scene, sample, settings, NULL};
    const struct orl_method *method =
        orl_method_find(log, name ? name : orl_method_default(scene));
    return method ? make(&wish, method, choice) : ORL_ERR_ARGUMENT;
}

json_t *orl_choice_settings(const struct orl_choice *choice)
{
    json_t *settings = json_object();
    for (const struct orl_option *o = orl_render_options(); o->name; o++)
        if (!orl_option_equal(o, &choice->method->params, &choice->params))
            json_object_set_new(settings, o->name, orl_option_json(o, &choice->params));
    return settings;
}

json_t *orl_choice_record(const struct orl_choice *choice, double before_psnr_db, double psnr_db, size_t photographs,
                          int size_divide, bool complete)
{
    return json_pack("{s:o, s:f, s:f, s:I, s:i, s:b}", "settings",
                     orl_choice_settings(choice), "before_psnr_db", before_psnr_db, "psnr_db",
                     psnr_db, "photographs", (json_int_t)photographs, "size_divide", size_divide, "complete", complete);
}

static enum orl_result add(const struct orl_log *log, const struct orl_choice *choice,
                           struct orl_choices *choices)
{
    ORL_TRY(ORL_GROW(log, choices->items, choices->capacity, choices->count));
    choices->items[choices->count++] = *choice;
    return ORL_OK;
}

// Adds the choice once with each value of "KEY=A,B,..".
static enum orl_result add_varied(const struct orl_log *log, const struct orl_choice *choice,
                                  const char *varied, struct orl_choices *choices)
{
    const char *equals = strchr(varied, '=');
    if (!equals)
        return orl_fail(log, ORL_ERR_ARGUMENT, "--vary %s: must be KEY=VALUE,VALUE,..", varied);
    const char *value = equals + 1;
    for (;;) {
        int length = (int)strcspn(value, ",");
        struct orl_choice one = *choice;
        int size = snprintf(one.setting, sizeof one.setting, "%.*s=%.*s", (int)(equals - varied),
                            varied, length, value);
        if (size >= (int)sizeof one.setting)
            return orl_fail(log, ORL_ERR_ARGUMENT, "--vary %s: a value is too long", varied);
        ORL_TRY(orl_render_params_set(log, &one.params, one.setting));
        ORL_TRY(add(log, &one, choices));
        if (value[length] == '\0')
            return ORL_OK;
        value += length + 1;
    }
}

static enum orl_result add_paired(const struct orl_log *log, const struct orl_choice *base,
                                  struct orl_choice choice, struct orl_choices *choices)
{
    if (!orl_render_params_take_proxy(&base->params, &choice.params))
        return ORL_OK;
    snprintf(choice.setting, sizeof choice.setting, "%s", paired_setting);
    return add(log, &choice, choices);
}

static enum orl_result add_method(const struct wish *wish, const struct orl_method *method,
                                  struct orl_choices *choices)
{
    struct orl_choice choice;
    ORL_TRY(make(wish, method, &choice));
    return wish->varied ? add_varied(wish->log, &choice, wish->varied, choices)
                        : add(wish->log, &choice, choices);
}

enum orl_result orl_choices_make(const struct orl_log *log, const struct orl_scene *scene,
                                 enum orl_sample sample, const struct orl_names *methods,
                                 const struct orl_names *settings, const char *varied,
                                 struct orl_choices *choices)
{
    const struct wish wish = {log, scene, sample, settings, varied};
    bool paired = !varied && orl_names_contain(methods, "paired");
    bool all = orl_names_contain(methods, "all") || (paired && methods->count == 1);
    enum orl_result result = ORL_OK;
    struct orl_choice base;
    memset(choices, 0, sizeof *choices);
    for (const struct orl_method *m = orl_methods; result == ORL_OK && all && m->name; m++)
        result = add_method(&wish, m, choices);
    const size_t named = all ? 0 : methods->count ? methods->count : 1;
    for (size_t i = 0; result == ORL_OK && i < named; i++) {
        const char *name = methods->count ? methods->items[i] : orl_method_default(scene);
        if (paired && strcmp(name, "paired") == 0)
            continue;
        const struct orl_method *method = orl_method_find(log, name);
        result = method ? add_method(&wish, method, choices) : methods->count ? ORL_ERR_ARGUMENT : ORL_ERR_FORMAT;
    }
    if (result == ORL_OK && paired)
        result = make(&wish, &orl_methods[0], &base);
    for (size_t i = 0, count = choices->count; result == ORL_OK && paired && i < count; i++)
        result = add_paired(log, &base, choices->items[i], choices);
    if (result != ORL_OK)
        orl_choices_finish(choices);
    return result;
}

void orl_choices_finish(struct orl_choices *choices)
{
    free(choices->items);
    memset(choices, 0, sizeof *choices);
}
