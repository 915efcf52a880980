// manifest.json of a site: all that the page must know before it loads anything else.
#include <string.h>

#include "core/vec3.h"
#include "scene/manifest.h"
#include "walk/internal.h"

// Numbers of the method, by their keys.
static json_t *options_json(const struct orl_render_params *params)
{
    json_t *options = json_object();
    for (const struct orl_render_option *o = orl_render_options; o->key; o++) {
        float value;
        if (o->kind != ORL_OPTION_NUMBER)
            continue;
        memcpy(&value, (const char *)params + o->offset, sizeof value);
        json_object_set_new(options, o->key, json_real((double)value));
    }
    return options;
}

// The ground's normal, or what the photographers held upwards.
static json_t *up_json(const struct orl_scene *scene)
{
    double up[3] = {0};
    for (size_t i = 0; i < scene->photo_count; i++)
        for (int k = 0; k < 3; k++)
            up[k] -= scene->photos[i].view.cam_from_world.r[1][k];
    if (scene->ground.height > 0)
        memcpy(up, scene->ground.plane, sizeof up);
    if (!(orl_normalize3(up) > 0))
        up[1] = -1;
    return json_pack("[f,f,f]", up[0], up[1], up[2]);
}

// Number of the start photograph among those of the site.
static json_int_t start_number(const struct site *site)
{
    json_int_t number = 0;
    for (size_t i = 0; i < site->start; i++)
        number += !site->scene->photos[i].test;
    return number;
}

enum orl_result orl_site_manifest(struct site *site, json_t *points, json_t *photos)
{
    const struct orl_scene *scene = site->scene;
    json_t *root = json_pack(
        "{s:s, s:i, s:s, s:s, s:o, s:f, s:o, s:I, s:o, s:o, s:o, s:o}", "format", "oriel site",
        "version", 1, "made_by", "oriel " ORL_VERSION, "title", site->params->title, "up",
        up_json(scene), "distance", scene->photo_distance > 0 ? scene->photo_distance : 1.0,
        "ground", orl_manifest_ground(&scene->ground), "start", start_number(site), "poster",
        orl_site_file(site, "poster.jpg"), "options", options_json(&site->render), "points",
        points, "photos", photos);
    if (!root)
        return ORL_ERR_MEMORY;
    char *path = orl_site_path(site, "manifest.json");
    enum orl_result result = path ? orl_json_write(site->log, path, root) : ORL_ERR_MEMORY;
    json_t *file = result == ORL_OK ? orl_site_file(site, "manifest.json") : NULL;
    site->report->first_bytes += (size_t)json_integer_value(json_object_get(file, "bytes"));
    json_decref(file);
    json_decref(root);
    free(path);
    return result;
}
