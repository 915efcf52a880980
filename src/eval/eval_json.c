// The evaluation's report. Field names are fixed; others may be added.
#include <jansson.h>

#include "core/json.h"
#include "eval/view_figures.h"
#include "eval/internal.h"

// Adds a view's figures to the object; NULL, which releases the object: one is no number.
static json_t *add_figures(const struct orl_eval *eval, const struct orl_eval_view *view, json_t *object)
{
    for (const struct orl_figure *f = orl_figures; f->name; f++) {
        if (!orl_figures_known(f->group, eval) ||
            json_object_set_new(object, f->name, json_real(orl_figure_value(f, view))) == 0)
            continue;
        json_decref(object);
        return NULL;
    }
    return object;
}

// NULL: a figure is no number.
static json_t *views_json(const struct orl_eval *eval)
{
    json_t *views = json_array();
    for (size_t i = 0; views && i < eval->view_count; i++) {
        const struct orl_eval_view *view = &eval->views[i];
        json_t *object = json_pack("{s:o, s:[ii]}", "photo",
                                   orl_json_string(eval->scene->photos[view->photo].name), "size",
                                   view->width, view->height);
        if (json_array_append_new(views, add_figures(eval, view, object)) != 0) {
            json_decref(views);
            views = NULL;
        }
    }
    return views;
}

static json_t *eval_json(const struct orl_eval *eval)
{
    const struct orl_eval_view *first = &eval->views[0];
    json_t *passes = json_object(), *owners = json_object();
    for (size_t i = 0; i < eval->pass_count; i++)
        json_object_set_new(passes, eval->passes[i].name, json_real(eval->passes[i].ms));
    for (int owner = 0; owner < ORL_OWNER_COUNT; owner++)
        json_object_set_new(owners, orl_owner_names[owner],
                            json_integer((json_int_t)eval->device_bytes[owner]));
    return json_pack("{s:o, s:s, s:s*, s:s, s:[ii], s:o, s:o, s:o, s:o}", "scene",
                     orl_json_string(eval->scene->dir), "method", eval->method, "setting",
                     eval->setting[0] ? eval->setting : NULL, "device", eval->device, "size",
                     first->width, first->height, "views", views_json(eval), "mean",
                     add_figures(eval, &eval->mean, json_object()), "passes_ms", passes,
                     "device_bytes", owners);
}

char *orl_reports_to_text(const struct orl_log *log, json_t *all, size_t count, bool array, int digits)
{
    char *text = NULL;
    if (json_array_size(all) == count)
        text = json_dumps(array ? all : json_array_get(all, 0),
                          JSON_INDENT(1) | JSON_ENSURE_ASCII | JSON_REAL_PRECISION(digits));
    if (!text)
        orl_logf(log, ORL_LOG_ERROR, "the report cannot be made: out of memory or a name that is "
                                     "not UTF-8");
    json_decref(all);
    return text;
}

char *orl_eval_to_json(const struct orl_log *log, const struct orl_eval *evals, size_t count,
                       bool array)
{
    json_t *all = json_array();
    for (size_t i = 0; i < count; i++)
        json_array_append_new(all, eval_json(&evals[i]));
    return orl_reports_to_text(log, all, count, array, 8);
}
