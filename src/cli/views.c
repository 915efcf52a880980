#include "cli/views.h"

#include <stdlib.h>
#include <string.h>

#include "core/memory.h"

static enum orl_result single_view(const struct orl_log *log, const struct orl_view *view,
                                   struct orl_path *path)
{
    path->views = orl_array(log, 1, sizeof *path->views);
    if (!path->views)
        return ORL_ERR_MEMORY;
    path->views[0] = *view;
    path->count = 1;
    return ORL_OK;
}

static enum orl_result find_photo(const struct orl_log *log, const struct orl_scene *scene,
                                  const char *name, size_t *photo)
{
    int index = orl_scene_find_photo(scene, name);
    *photo = index < 0 ? 0 : (size_t)index;
    return index < 0 ? orl_fail(log, ORL_ERR_NOT_FOUND, "%s has no photograph %s", scene->dir, name)
                     : ORL_OK;
}

enum orl_result views_choose(const struct orl_log *log, const struct orl_scene *scene,
                             const struct view_options *options, struct orl_path *path)
{
    enum orl_result result;
    if (options->at) {
        size_t photo;
        result = find_photo(log, scene, options->at, &photo);
        if (result == ORL_OK)
            result = single_view(log, &scene->photos[photo].view, path);
    } else if (options->path && strcmp(options->path, "photos") == 0) {
        result = orl_path_through_photos(log, scene, (size_t)options->frames, path);
    } else {
        const char *file = options->camera ? options->camera : options->path;
        result = orl_path_read(log, scene, file, path);
        if (result == ORL_OK && options->camera && path->count != 1)
            result = orl_fail(log, ORL_ERR_ARGUMENT,
                              "%s holds %zu cameras; use --path to render them all", file,
                              path->count);
    }
    for (size_t i = 0; result == ORL_OK && options->size.width && i < path->count; i++) {
        struct orl_camera *camera = &path->views[i].camera;
        *camera = orl_camera_reframed(camera, options->size.width, options->size.height);
    }
    return result;
}

enum orl_result views_exclude(const struct orl_log *log, const struct orl_scene *scene,
                              const struct orl_names *names, bool **skip)
{
    *skip = orl_array(log, scene->photo_count, sizeof **skip);
    enum orl_result result = *skip ? ORL_OK : ORL_ERR_MEMORY;
    for (size_t i = 0; result == ORL_OK && i < names->count; i++) {
        size_t photo;
        result = find_photo(log, scene, names->items[i], &photo);
        if (result == ORL_OK)
            (*skip)[photo] = true;
    }
    return result;
}

static enum orl_result choose_layers(const struct orl_log *log, const struct orl_names *names,
                                     bool confidence, struct orl_frame_layers *layers)
{
    for (size_t i = 0; i < names->count; i++) {
        const char *name = names->items[i];
        if (strcmp(name, "depth") == 0)
            layers->depth = true;
        else if (strcmp(name, "normal") == 0)
            layers->normal = true;
        else if (strcmp(name, "coverage") == 0)
            layers->coverage = true;
        else if (confidence && strcmp(name, "confidence") == 0)
            layers->confidence = true;
        else
            return orl_fail(log, ORL_ERR_ARGUMENT,
                            "--layers %s: must be of depth, normal, coverage%s", name,
                            confidence ? ", confidence" : "");
    }
    return ORL_OK;
}

enum orl_result output_choose(const struct orl_log *log, const struct output_options *options,
                              bool confidence, struct orl_frame_output *output)
{
    output->float_color = options->float_color;
    output->tone.exposure_ev = options->exposure_ev;
    output->tone.white = options->white;
    if (strcmp(options->compression, "piz") == 0)
        output->compression = ORL_EXR_PIZ;
    else if (strcmp(options->compression, "zip") != 0)
        return orl_fail(log, ORL_ERR_ARGUMENT, "--compression %s: must be zip or piz",
                        options->compression);
    enum orl_result result = choose_layers(log, &options->layers, confidence, &output->layers);
    return result == ORL_OK ? orl_tone_find(log, options->tone, &output->tone.curve) : result;
}

enum orl_result method_choose(const struct orl_log *log, const struct orl_scene *scene,
                              const char *name, const struct orl_names *settings,
                              struct orl_render_params *params)
{
    const struct orl_method *method = orl_method_find(log, name);
    enum orl_result result = method ? ORL_OK : ORL_ERR_ARGUMENT;
    if (method && scene)
        result = orl_render_params_tuned(log, method, scene, params);
    else if (method)
        *params = method->params;
    for (size_t i = 0; result == ORL_OK && i < settings->count; i++)
        result = orl_render_params_set(log, params, settings->items[i]);
    return result;
}
