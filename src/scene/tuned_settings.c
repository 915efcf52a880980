#include "scene/tuned_settings.h"

#include <math.h>
#include <string.h>

#include "core/file.h"
#include "core/json.h"
#include "core/memory.h"

enum { SETTINGS_MAX = 256, NAME_BYTES_MAX = 64, DEPTH_DIVIDE_MAX = 16 };

static enum orl_result add(const struct orl_log *log, const char *path, const char *method,
                           const char *key, const json_t *value, struct orl_scene *scene)
{
    double number = json_number_value(value);
    const char *name = json_string_value(value);
    bool fits = name ? strlen(name) <= NAME_BYTES_MAX
                     : json_is_number(value) && isfinite(number);
    if (!fits || strlen(key) > NAME_BYTES_MAX || strlen(method) > NAME_BYTES_MAX ||
        strchr(key, '='))
        return orl_fail(log, ORL_ERR_FORMAT,
                        "%s: \"tuned\" of %.64s: %.64s is not a number or a name", path, method,
                        key);
    struct orl_tuned *tuned = &scene->tuned[scene->tuned_count];
    tuned->method = orl_strdup(log, method);
    tuned->key = orl_strdup(log, key);
    tuned->value = number;
    tuned->name = name ? orl_strdup(log, name) : NULL;
    scene->tuned_count++; // even if incomplete, so that it is released
    return tuned->method && tuned->key && (tuned->name || !name) ? ORL_OK : ORL_ERR_MEMORY;
}

static enum orl_result read_name(const struct orl_json_place *place, const json_t *render,
                                 const char *key, char **name)
{
    const json_t *value = json_object_get(render, key);
    if (!value)
        return ORL_OK;
    if (!json_is_string(value) || json_string_length(value) > NAME_BYTES_MAX)
        return orl_json_refuse(place, key, "a name");
    *name = orl_strdup(place->log, json_string_value(value));
    return *name ? ORL_OK : ORL_ERR_MEMORY;
}

static enum orl_result read_defaults(const struct orl_log *log, const char *path,
                                     const json_t *root, struct orl_scene_defaults *defaults)
{
    const struct orl_json_place place = {log, path, "\"render\""};
    const json_t *render = json_object_get(root, "render");
    int bits = 32;
    enum orl_result result = read_name(&place, render, "method", &defaults->method);
    ORL_THEN(result, read_name(&place, render, "textures", &defaults->textures));
    ORL_THEN(result, orl_json_integer(&place, render, "depth_divide", 1, DEPTH_DIVIDE_MAX,
                                      &defaults->depth_divide));
    ORL_THEN(result, orl_json_integer(&place, render, "depth_bits", 16, 32, &bits));
    defaults->depth_half = bits < 32;
    return result;
}

enum orl_result orl_tuned_read(const struct orl_log *log, const char *path, const json_t *root,
                               struct orl_scene *scene)
{
    json_t *all = json_object_get(root, "tuned"), *record, *value;
    const char *method, *key;
    size_t count = 0;
    json_object_foreach(all, method, record)
        count += json_object_size(json_object_get(record, "settings"));
    if (count > SETTINGS_MAX)
        return orl_fail(log, ORL_ERR_FORMAT, "%s: \"tuned\" has more than %d settings", path,
                        SETTINGS_MAX);
    scene->tuned = count ? orl_array(log, count, sizeof *scene->tuned) : NULL;
    ORL_TRY_MEMORY(scene->tuned || !count);
    enum orl_result result = read_defaults(log, path, root, &scene->defaults);
    json_object_foreach(all, method, record)
        json_object_foreach(json_object_get(record, "settings"), key, value)
            ORL_THEN(result, add(log, path, method, key, value, scene));
    return result;
}

enum orl_result orl_tuned_can_write(const struct orl_log *log, const char *dir)
{
    const char *path = ORL_PATH(dir, "scene.json");
    struct orl_atomic_file file;
    if (!orl_path_is_file(path))
        return orl_fail(log, ORL_ERR_NOT_FOUND, "%s: not there; settings can be kept in prepared scenes only", path);
    ORL_TRY(orl_atomic_begin(log, path, &file));
    orl_atomic_abort(&file);
    return ORL_OK;
}

enum orl_result orl_tuned_write(const struct orl_log *log, const char *dir, const char *method,
                                json_t *record)
{
    json_t *root = NULL, *all;
    const char *path = ORL_PATH(dir, "scene.json");
    enum orl_result result = orl_tuned_can_write(log, dir);
    ORL_THEN(result, orl_json_read(log, path, &root));
    if (result == ORL_OK) {
        all = json_object_get(root, "tuned");
        if (!json_is_object(all)) {
            all = json_object();
            json_object_set_new(root, "tuned", all);
        }
        result = json_object_set(all, method, record) == 0
                     ? orl_json_write(log, path, root)
                     : orl_fail(log, ORL_ERR_MEMORY, "%s: no memory for it", path);
    }
    json_decref(record);
    json_decref(root);
    return result;
}

json_t *orl_defaults_json(const struct orl_scene_defaults *defaults)
{
    return json_pack("{s:s*, s:s*, s:i, s:i}", "method", defaults->method, "textures",
                     defaults->textures, "depth_divide",
                     defaults->depth_divide > 1 ? defaults->depth_divide : 1, "depth_bits",
                     defaults->depth_half ? 16 : 32);
}
