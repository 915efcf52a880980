// The parameters of a method: from text, as they suit a scene, and whether they go together.
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "core/file.h"
#include "render/frame/method.h"
#include "render/proxy/proxy.h"

// --- names ---

// Name of the `index`-th shader file of a slot, without folder and extension; false past the last.
static bool file_at(const char *key, size_t index, char name[ORL_OPTION_NAME_BYTES])
{
    char folder[64];
    snprintf(folder, sizeof folder, "gather/%s", key);
    const char *file = orl_shader_file(folder, index);
    if (!file)
        return false;
    file += strlen(folder) + 1;
    memset(name, 0, ORL_OPTION_NAME_BYTES);
    snprintf(name, ORL_OPTION_NAME_BYTES, "%.*s", (int)strcspn(file, "."), file);
    return true;
}

bool orl_render_option_name(const struct orl_render_option *option, size_t index,
                            char name[ORL_OPTION_NAME_BYTES])
{
    const void *found;
    switch (option->kind) {
    case ORL_OPTION_CHOICE:
        return orl_option_word(option->names, index, name);
    case ORL_OPTION_SLOT:
        found = orl_slot_at(option->key, index);
        snprintf(name, ORL_OPTION_NAME_BYTES, "%s", found ? orl_slot_name(found) : "");
        return found;
    case ORL_OPTION_FILE:
        return file_at(option->key, index, name);
    default:
        return false;
    }
}

// --- choices that go together ---

static bool guesses(const struct orl_render_params *params)
{
    return params->fill == ORL_FILL_DEPTH || params->fill == ORL_FILL_GROUND;
}

enum orl_result orl_render_params_check(const struct orl_log *log,
                                        const struct orl_render_params *params)
{
    const struct orl_painter *painter = params->paint;
    char needed[ORL_OPTION_NAME_BYTES];
    for (size_t i = 0; orl_option_word(painter->needs, i, needed); i++)
        if (!orl_render_params_equal(params, needed))
            return orl_fail(log, ORL_ERR_ARGUMENT, "paint=%s goes with %s alone", painter->name,
                            needed);
    if (painter == &orl_paint_points && !params->proxy->color)
        return orl_fail(log, ORL_ERR_ARGUMENT, "paint=points: proxy=%s has no colours",
                        params->proxy->name);
    if (guesses(params) &&
        (strcmp(params->weight, "normal") == 0 || strcmp(params->weight, "princ") == 0))
        return orl_fail(log, ORL_ERR_ARGUMENT, "fill=depth and fill=ground do not go with weight=%s, "
                        "which needs a normal: guessed depth has none", params->weight);
    if (painter == &orl_paint_gather && params->combine->sweeps == 0)
        return orl_fail(log, ORL_ERR_ARGUMENT, "combine=%s goes with paint=tiled alone",
                        params->combine->name);
    return ORL_OK;
}

// --- parameters from text ---

static size_t field_size(const struct orl_render_option *option)
{
    return option->kind == ORL_OPTION_FILE     ? (size_t)ORL_OPTION_NAME_BYTES
           : option->kind == ORL_OPTION_SLOT   ? sizeof(void *)
           : option->kind == ORL_OPTION_NUMBER ? sizeof(float)
                                               : sizeof(int); // enums of this struct are ints
}

static void append(char *list, size_t size, const char *word)
{
    size_t used = strlen(list);
    snprintf(list + used, size - used, " %s", word);
}

static enum orl_result set_name(const struct orl_log *log, const struct orl_render_option *option,
                                const char *text, void *field)
{
    char list[256] = "", name[ORL_OPTION_NAME_BYTES];
    for (int i = 0; orl_render_option_name(option, (size_t)i, name); i++) {
        append(list, sizeof list, name);
        if (strcmp(name, text) != 0)
            continue;
        const void *slot = orl_slot_at(option->key, (size_t)i);
        const void *value = option->kind == ORL_OPTION_FILE   ? (const void *)name
                            : option->kind == ORL_OPTION_SLOT ? (const void *)&slot
                                                              : &i;
        memcpy(field, value, field_size(option));
        return ORL_OK;
    }
    return orl_fail(log, ORL_ERR_ARGUMENT, "%s=%s: must be one of%s", option->key, text, list);
}

static enum orl_result set_value(const struct orl_log *log,
                                 const struct orl_render_option *option, const char *text,
                                 struct orl_render_params *params)
{
    void *field = (char *)params + option->offset;
    if (option->kind != ORL_OPTION_NUMBER)
        return set_name(log, option, text, field);
    char *end;
    double value = strtod(text, &end);
    if (end == text || *end || !(value >= option->least && value <= option->most))
        return orl_fail(log, ORL_ERR_ARGUMENT, "%s=%s: must be a number from %g to %g",
                        option->key, text, option->least, option->most);
    *(float *)field = (float)value;
    return ORL_OK;
}

static enum orl_result find_key(const struct orl_log *log, const char *assignment,
                                const struct orl_render_option **option)
{
    char list[512] = "";
    size_t length = strcspn(assignment, "=");
    if (assignment[length] != '=')
        return orl_fail(log, ORL_ERR_ARGUMENT, "%s: must be KEY=VALUE", assignment);
    for (*option = orl_render_options; (*option)->key; (*option)++) {
        if (strlen((*option)->key) == length && strncmp((*option)->key, assignment, length) == 0)
            return ORL_OK;
        append(list, sizeof list, (*option)->key);
    }
    return orl_fail(log, ORL_ERR_ARGUMENT, "option %.*s is not known; there are:%s", (int)length,
                    assignment, list);
}

enum orl_result orl_render_params_assign(const struct orl_log *log,
                                         struct orl_render_params *params,
                                         const char *const *assignments, size_t count)
{
    const struct orl_render_option *option;
    struct orl_render_params changed = *params;
    for (size_t i = 0; i < count; i++) {
        ORL_TRY(find_key(log, assignments[i], &option));
        ORL_TRY(set_value(log, option, assignments[i] + strlen(option->key) + 1, &changed));
    }
    // Checked after all assignments, since a later one may choose what reads an option.
    for (size_t i = 0; i < count; i++) {
        ORL_TRY(find_key(log, assignments[i], &option));
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
    for (const struct orl_render_option *o = orl_render_options; o->key; o++)
        if (strcmp(o->key, "proxy") == 0 || orl_proxy_reads(o, kind))
            memcpy((char *)params + o->offset, (const char *)from + o->offset, field_size(o));
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
    char own[ORL_OPTION_NAME_BYTES], other[ORL_OPTION_NAME_BYTES];
    const struct orl_render_option *option = orl_render_option_find(key);
    if (!option)
        return false; // which setting it reports
    orl_render_option_print(option, &a->params, own, sizeof own);
    orl_render_option_print(option, &b->params, other, sizeof other);
    return strcmp(own, other) != 0;
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
