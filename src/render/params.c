// The parameters of a method: from text, as they suit a scene, and whether they go together.
#include <stdio.h>
#include <string.h>

#include "core/arguments.h"
#include "core/file.h"
#include "render/frame/method.h"
#include "render/proxy/proxy.h"

// --- choices that go together ---

enum orl_result orl_render_params_check(const struct orl_log *log,
                                        const struct orl_render_params *params)
{
    const struct orl_painter *painter = params->paint;
    const char *missing = orl_render_params_first(params, painter->needs, false);
    if (missing)
        return orl_fail(log, ORL_ERR_ARGUMENT, "paint=%s goes with %.*s alone", painter->name,
                        (int)strcspn(missing, " "), missing);
    if (painter == &orl_paint_points && !params->proxy->color)
        return orl_fail(log, ORL_ERR_ARGUMENT, "paint=points: proxy=%s has no colours",
                        params->proxy->name);
    if (orl_params_guess(params) &&
        (strcmp(params->weight, "normal") == 0 || strcmp(params->weight, "princ") == 0))
        return orl_fail(log, ORL_ERR_ARGUMENT, "fill=depth and fill=ground do not go with weight=%s, "
                        "which needs a normal: guessed depth has none", params->weight);
    if (painter == &orl_paint_gather && params->combine->sweeps == 0)
        return orl_fail(log, ORL_ERR_ARGUMENT, "combine=%s goes with paint=tiled alone",
                        params->combine->name);
    return ORL_OK;
}

// --- parameters from text ---

static void append(char *list, size_t size, const char *word)
{
    size_t used = strlen(list);
    snprintf(list + used, size - used, " %s", word);
}

static enum orl_result assign(const struct orl_log *log, const char *assignment, struct orl_render_params *params)
{
    const struct orl_option *option = orl_render_option_find(assignment);
    const char *equals = strchr(assignment, '=');
    char list[512] = "";
    if (!equals)
        return orl_fail(log, ORL_ERR_ARGUMENT, "%s: must be KEY=VALUE", assignment);
    if (option)
        return orl_option_set(log, option, equals + 1, params);
    for (option = orl_render_options(); option->name; option++)
        append(list, sizeof list, option->name);
    return orl_fail(log, ORL_ERR_ARGUMENT, "option %.*s is not known; there are:%s", (int)(equals - assignment),
                    assignment, list);
}

enum orl_result orl_render_params_assign(const struct orl_log *log,
                                         struct orl_render_params *params,
                                         const char *const *assignments, size_t count)
{
    struct orl_render_params changed = *params;
    for (size_t i = 0; i < count; i++)
        ORL_TRY(assign(log, assignments[i], &changed));
    // Checked after all assignments, since a later one may choose what reads an option.
    for (size_t i = 0; i < count; i++) {
        const struct orl_option *option = orl_render_option_find(assignments[i]);
        if (!orl_render_option_read(option, &changed))
            return orl_fail(log, ORL_ERR_ARGUMENT,
                            "%s: this method does not read it; it belongs to: %s", assignments[i],
                            option->readers);
    }
    ORL_TRY(orl_render_params_check(log, &changed));
    *params = changed;
    return ORL_OK;
}

enum orl_result orl_render_params_set(const struct orl_log *log, struct orl_render_params *params,
                                      const char *assignment)
{
    return orl_render_params_assign(log, params, &assignment, 1);
}

// --- parameters of a scene ---

static bool has_silhouettes(const struct orl_scene *scene)
{
    for (size_t i = 0; i < scene->photo_count; i++)
        if (scene->photos[i].masked && !scene->photos[i].test)
            return true;
    return false;
}

static bool has_mesh(const struct orl_scene *scene)
{
    return orl_path_is_file(orl_scene_mesh_path(scene).text);
}

// Takes another proxy where the scene lacks what the method's own is made of, and leaves out what does not suit it.
static void suit_scene(const struct orl_scene *scene, struct orl_render_params *params)
{
    const struct orl_proxy_kind *kind = params->proxy;
    // Silhouettes leave no points, but a mesh of their hull or the hull itself.
    if (kind == &orl_proxy_splats && !scene->points.count && params->paint != &orl_paint_points)
        params->proxy =
            !has_mesh(scene) && has_silhouettes(scene) ? &orl_proxy_hull : &orl_proxy_mesh;
    if (kind == &orl_proxy_hull && !has_silhouettes(scene))
        params->proxy =
            has_mesh(scene) || !scene->points.count ? &orl_proxy_mesh : &orl_proxy_splats;
    // Voxels of points have holes where a hull has none.
    if (kind == &orl_proxy_voxels && !has_silhouettes(scene))
        params->fill = ORL_FILL_COLOR;
}

bool orl_render_params_take_proxy(const struct orl_render_params *from,
                                  struct orl_render_params *params)
{
    const struct orl_proxy_kind *kind = from->proxy;
    if (params->paint != &orl_paint_gather)
        return false;
    for (const struct orl_option *o = orl_render_options(); o->name; o++)
        if (strcmp(o->name, "proxy") == 0 || orl_proxy_reads(o, kind))
            memcpy((char *)params + o->offset, (const char *)from + o->offset, o->size);
    enum orl_fill own = params->fill;
    params->fill = from->fill;
    if (orl_render_params_check(NULL, params) != ORL_OK)
        params->fill = own;
    return true;
}

static bool has_tuned(const struct orl_scene *scene, const struct orl_method *method)
{
    for (size_t i = 0; i < scene->tuned_count; i++)
        if (strcmp(scene->tuned[i].method, method->name) == 0)
            return true;
    return false;
}

// The method whose values in scene.json this one takes.
static const struct orl_method *tuned_method(const struct orl_scene *scene,
                                             const struct orl_method *method)
{
    return !method->variant_of || has_tuned(scene, method)
               ? method
               : orl_method_find(NULL, method->variant_of);
}

// True if a method has another value for the option than the method that it is a variant of.
static bool differs(const char *key, const struct orl_method *a, const struct orl_method *b)
{
    const struct orl_option *option = orl_render_option_find(key);
    return option && !orl_option_equal(option, &a->params, &b->params); // else setting it reports
}

void orl_render_params_tuned(const struct orl_log *log, const struct orl_method *method,
                             const struct orl_scene *scene, struct orl_render_params *params)
{
    const struct orl_method *source = tuned_method(scene, method);
    char ignored[256] = "";
    *params = method->params;
    suit_scene(scene, params);
    for (size_t i = 0; i < scene->tuned_count; i++) {
        const struct orl_tuned *tuned = &scene->tuned[i];
        char assignment[160];
        if (strcmp(tuned->method, source->name) != 0 || differs(tuned->key, method, source))
            continue;
        if (tuned->name)
            snprintf(assignment, sizeof assignment, "%s=%s", tuned->key, tuned->name);
        else
            snprintf(assignment, sizeof assignment, "%s=%.9g", tuned->key, tuned->value);
        if (orl_render_params_set(NULL, params, assignment) != ORL_OK)
            append(ignored, sizeof ignored, assignment);
    }
    if (*ignored)
        orl_logf(log, ORL_LOG_WARNING, "%s/scene.json: \"tuned\" of %s: ignored, since this program does not take "
                 "it:%s", scene->dir, source->name, ignored);
}
