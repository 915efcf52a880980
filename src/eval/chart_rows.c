// The chart's rows: what they depend on besides the scene, and the pictures that belong to them.
#include <stdlib.h>

#include "core/file.h"
#include "eval/chart_internal.h"

json_t *orl_chart_provenance(const struct chart_scene *scene)
{
    json_t *own = orl_row_provenance(scene->gpu, scene->checksum);
    json_t *more = json_pack("{s:b, s:I, s:f, s:I}", "quick", scene->params->quick, "views",
                             (json_int_t)scene->view_count, "seconds", scene->params->seconds,
                             "max_vram_bytes", (json_int_t)scene->params->max_vram_bytes);
    json_object_update(own, more);
    json_decref(more);
    return own;
}

static struct orl_row_store store_of(const struct chart_scene *scene)
{
    return (struct orl_row_store){orl_gpu_log(scene->gpu), scene->params->out, scene->name};
}

static bool has_pictures(const struct chart_scene *scene, const json_t *row)
{
    const json_t *views = json_object_get(row, "views");
    static const char *const keys[] = {"picture", "error_map"};
    bool there = json_array_size(views) == scene->view_count;
    for (size_t i = 0; there && i < json_array_size(views); i++)
        for (size_t k = 0; there && k < ORL_COUNT(keys); k++) {
            const char *name = json_string_value(json_object_get(json_array_get(views, i),
                                                                 keys[k]));
            char *path = name ? orl_path_join(NULL, scene->params->out, name) : NULL;
            there = path && orl_path_is_file(path);
            free(path);
        }
    return there;
}

json_t *orl_chart_load_row(const struct chart_scene *scene, const char *id)
{
    const struct orl_row_store store = store_of(scene);
    json_t *wanted = orl_chart_provenance(scene), *row = orl_row_load(&store, id, wanted);
    if (row && !has_pictures(scene, row)) {
        json_decref(row);
        row = NULL;
    }
    json_decref(wanted);
    return row;
}

enum orl_result orl_chart_keep_row(const struct chart_scene *scene, const char *id,
                                   json_t **row)
{
    const struct orl_row_store store = store_of(scene);
    return orl_row_keep(&store, id, row);
}
