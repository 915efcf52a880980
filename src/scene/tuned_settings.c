#include "scene/tuned_settings.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "core/file.h"
#include "core/json.h"
#include "core/memory.h"

enum { SETTINGS_MAX = 256, NAME_BYTES_MAX = 64 };

static enum orl_result add(const struct orl_log *log, const char *path, const char *method,
                           const char *key, const json_t *value, struct orl_scene *scene)
{
    double number = json_number_value(value);
    if (!json_is_number(value) || !isfinite(number) || strlen(key) > NAME_BYTES_MAX ||
        strlen(method) > NAME_BYTES_MAX || strchr(key, '='))
        return orl_fail(log, ORL_ERR_FORMAT, "%s: \"tuned\" of %.64s: %.64s is not a number", path,
                        method, key);
    struct orl_tuned *tuned = &scene->tuned[scene->tuned_count];
    tuned->method = orl_strdup(log, method);
    tuned->key = orl_strdup(log, key);
    tuned->value = number;
    scene->tuned_count++; // even if incomplete, so that it is released
    return tuned->method && tuned->key ? ORL_OK : ORL_ERR_MEMORY;
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
    if (count && !scene->tuned)
        return ORL_ERR_MEMORY;
    enum orl_result result = ORL_OK;
    json_object_foreach(all, method, record)
        json_object_foreach(json_object_get(record, "settings"), key, value)
            if (result == ORL_OK)
                result = add(log, path, method, key, value, scene);
    return result;
}

enum orl_result orl_tuned_write(const struct orl_log *log, const char *dir, const char *method,
                                json_t *record)
{
    json_t *root = NULL, *all;
    char *path = orl_path_join(log, dir, "scene.json");
    enum orl_result result = path ? ORL_OK : ORL_ERR_MEMORY;
    if (result == ORL_OK && !orl_path_is_file(path))
        result = orl_fail(log, ORL_ERR_NOT_FOUND,
                          "%s: not there; settings can be kept in prepared scenes only", path);
    if (result == ORL_OK)
        result = orl_json_read(log, path, &root);
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
    free(path);
    return result;
}
