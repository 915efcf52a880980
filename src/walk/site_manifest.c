// manifest.json of a site: all that the page must know before it loads other files.
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "core/file.h"
#include "core/json.h"
#include "core/memory.h"
#include "scene/manifest.h"
#include "scene/upright.h"
#include "walk/internal.h"

enum { ASKED = 1000 }; // photographs, about, that the start must be near to

// The method's numeric options by their keys.
static json_t *options_json(const struct orl_render_params *params)
{
    json_t *options = json_object();
    for (const struct orl_option *o = orl_render_options(); o->name; o++)
        if (o->kind == ORL_VALUE_FLOAT)
            json_object_set_new(options, o->name, json_real(orl_option_number(o, params)));
    return options;
}

// The ground's normal, or the photographs' mean upward direction.
static json_t *up_json(const struct orl_scene *scene)
{
    double up[3];
    orl_scene_mean_up(scene, up);
    if (scene->ground.height > 0)
        memcpy(up, scene->ground.plane, sizeof up);
    return json_pack("[f,f,f]", up[0], up[1], up[2]);
}

enum orl_result orl_walk_start(const struct orl_log *log, const struct orl_scene *scene,
                               size_t *start)
{
    double least = INFINITY;
    size_t step = 1 + scene->photo_count / ASKED; // of thousands, some tell as much as all, held out or not
    for (size_t i = 0; i < scene->photo_count; i++) {
        double a[3], sum = 0;
        orl_pose_centre(&scene->photos[i].view.cam_from_world, a);
        for (size_t j = 0; j < scene->photo_count; j += step) {
            double b[3];
            orl_pose_centre(&scene->photos[j].view.cam_from_world, b);
            if (!scene->photos[j].test || step > 1)
                sum += hypot(hypot(a[0] - b[0], a[1] - b[1]), a[2] - b[2]);
        }
        if (!scene->photos[i].test && sum < least) {
            least = sum;
            *start = i;
        }
    }
    return isfinite(least) ? ORL_OK
                           : orl_fail(log, ORL_ERR_DATA, "the scene has no photographs that "
                                      "may be shown");
}

char *orl_walk_title(const struct orl_log *log, const struct orl_scene *scene, const char *asked,
                     const json_t *settings)
{
    const char *own = orl_json_text(settings, "title");
    if (asked || (own && *own))
        return orl_strdup(log, asked ? asked : own);
    return orl_strdup(log, orl_path_name(ORL_PATH("", "%.*s", orl_path_bare(scene->dir), scene->dir)));
}

// A photograph's index among those that are not held out.
static json_int_t number_of(const struct orl_scene *scene, size_t photo)
{
    json_int_t number = 0;
    for (size_t i = 0; i < photo; i++)
        number += !scene->photos[i].test;
    return number;
}

// The rows of cam_from_world: rotation and translation.
static json_t *pose_json(const struct orl_pose *pose)
{
    json_t *rows = json_array();
    for (int i = 0; i < 3; i++)
        json_array_append_new(rows, json_pack("[f,f,f,f]", pose->r[i][0], pose->r[i][1],
                                              pose->r[i][2], pose->t[i]));
    return rows;
}

json_t *orl_walk_photo(const struct orl_photo *photo, const struct orl_camera *c)
{
    return json_pack("{s:o, s:i, s:i, s:f, s:f, s:f, s:f, s:o, s:i}", "name", orl_json_string(photo->name), "width",
                     c->width, "height", c->height, "fx", c->fx, "fy", c->fy, "cx", c->cx, "cy",
                     c->cy, "cam_from_world", pose_json(&photo->view.cam_from_world),
                     "orientation", photo->orientation);
}

json_t *orl_walk_manifest(const struct orl_scene *scene, const json_t *settings, const char *title,
                          size_t start)
{
    return json_pack("{s:s, s:i, s:s, s:o, s:o, s:f, s:f, s:o, s:o, s:I, s:O, s:I}", "format", "oriel site",
                     "version", 1, "made_by", "oriel " ORL_VERSION, "title", orl_json_string(title), "up",
                     up_json(scene), "distance",
                     scene->photo_distance > 0 ? scene->photo_distance : 1.0, "near",
                     scene->near_distance, "ground", orl_manifest_ground(&scene->ground), "backdrop",
                     orl_manifest_backdrop(scene->backdrop_rests), "start",
                     number_of(scene, start), "walk", settings, "time_steps",
                     (json_int_t)scene->frame_count);
}

enum orl_result orl_site_manifest(struct site *site, json_t *points, json_t *photos, json_t *steps, json_t *soft)
{
    json_t *root = orl_walk_manifest(site->scene, site->settings, site->params->title,
                                     site->start);
    json_t *more = json_pack("{s:o, s:o, s:O, s:O, s:O*, s:O*}", "poster", orl_site_file(site, "poster.jpg"),
                             "options", options_json(&site->render), "points", points, "photos",
                             photos, "steps", steps, "soft", soft);
    if (json_object_update_new(root, more) != 0) {
        json_decref(root);
        return ORL_ERR_MEMORY;
    }
    if (site->params->radiance)
        json_object_set_new(root, "radiance", json_pack("{s:f, s:f}", "peak", site->range.peak,
                                                        "mu", site->range.mu));
    enum orl_result result = orl_json_write(site->log, ORL_PATH(site->dir, "manifest.json"), root);
    json_decref(root);
    return result;
}
