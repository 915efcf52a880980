// The evaluation's report. Field names are fixed; others may be added.
#include <jansson.h>

#include "core/json.h"
#include "eval/view_figures.h"
#include "eval/internal.h"

// Takes over `value`, also on failure: `object` or `value` is NULL, or memory ran out.
static bool set(json_t *object, const char *key, json_t *value)
{
    return json_object_set_new(object, key, value) == 0;
}

static bool set_figures(json_t *object, const struct orl_eval *eval,
                        const struct orl_eval_view *view)
{
    bool ok = true;
    for (const struct orl_figure *f = orl_figures; ok && f->name; f++)
        if (orl_figures_known(f->group, eval))
            ok = set(object, f->name, json_real(orl_figure_value(f, view)));
    return ok;
}

static json_t *size_json(const struct orl_eval_view *view)
{
    return json_pack("[ii]", view->width, view->height);
}

static bool add_views(json_t *views, const struct orl_eval *eval)
{
    for (size_t i = 0; views && i < eval->view_count; i++) {
        const struct orl_eval_view *view = &eval->views[i];
        json_t *object = json_object();
        bool ok = set(object, "photo", orl_json_string(eval->scene->photos[view->photo].name)) &&
                  set(object, "size", size_json(view)) && set_figures(object, eval, view);
        if (json_array_append_new(views, object) != 0 || !ok)
            return false;
    }
    return views != NULL;
}

static bool set_passes(json_t *object, const struct orl_eval *eval)
{
    json_t *passes = json_object();
    bool ok = true;
    for (size_t i = 0; i < eval->pass_count; i++)
        ok = set(passes, eval->passes[i].name, json_real(eval->passes[i].ms)) && ok;
    return set(object, "passes_ms", passes) && ok;
}

static bool set_bytes(json_t *object, const struct orl_eval *eval)
{
    json_t *owners = json_object();
    bool ok = true;
    for (int owner = 0; owner < ORL_OWNER_COUNT; owner++)
        ok = set(owners, orl_owner_names[owner],
                 json_integer((json_int_t)eval->device_bytes[owner])) && ok;
    return set(object, "device_bytes", owners) && ok;
}

static bool add_eval(json_t *array, const struct orl_eval *eval)
{
    json_t *object = json_object(), *views = json_array(), *mean = json_object();
    bool ok = set(object, "scene", orl_json_string(eval->scene->dir)) &&
              set(object, "method", json_string(eval->method)) &&
              (!eval->setting[0] || set(object, "setting", json_string(eval->setting))) &&
              set(object, "device", json_string(eval->device)) &&
              set(object, "size", size_json(&eval->views[0])) && add_views(views, eval) &&
              set_figures(mean, eval, &eval->mean);
    ok = set(object, "views", views) && ok;
    ok = set(object, "mean", mean) && ok;
    ok = set_passes(object, eval) && set_bytes(object, eval) && ok;
    return json_array_append_new(array, object) == 0 && ok;
}

char *orl_reports_to_text(const struct orl_log *log, json_t *all, bool whole, bool array,
                          int digits)
{
    char *text = NULL;
    if (whole)
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
    bool ok = all != NULL;
    for (size_t i = 0; i < count && ok; i++)
        ok = add_eval(all, &evals[i]);
    return orl_reports_to_text(log, all, ok, array, 8);
}
