#include "scene/view_choice.h"

#include <string.h>

#include "core/memory.h"

static enum orl_result single_view(const struct orl_log *log, const struct orl_view *view,
                                   struct orl_path *path)
{
    path->views = orl_array(log, 1, sizeof *path->views);
    ORL_TRY_MEMORY(path->views);
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

static enum orl_result read_file(const struct orl_log *log, const struct orl_scene *scene,
                                 const struct orl_view_choice *choice, struct orl_path *path)
{
    const char *file = choice->camera ? choice->camera : choice->path;
    enum orl_result result = orl_path_read(log, scene, file, path);
    if (result == ORL_OK && choice->camera && path->count != 1)
        result = orl_fail(log, ORL_ERR_ARGUMENT,
                          "%s holds %zu cameras; use --path to render them all", file,
                          path->count);
    return result;
}

enum orl_result orl_views_choose(const struct orl_log *log, const struct orl_scene *scene,
                                 const struct orl_view_choice *choice, struct orl_path *path)
{
    enum orl_result result;
    size_t photo;
    if (choice->at) {
        result = find_photo(log, scene, choice->at, &photo);
        ORL_THEN(result, single_view(log, &scene->photos[photo].view, path));
    } else if (choice->path && strcmp(choice->path, "photos") == 0) {
        result = orl_path_through_photos(log, scene, (size_t)choice->frames, path);
    } else if (choice->path && strcmp(choice->path, "circle") == 0) {
        result = orl_path_around(log, scene, (size_t)choice->frames, path);
    } else {
        result = read_file(log, scene, choice, path);
    }
    for (size_t i = 0; result == ORL_OK && choice->width && i < path->count; i++) {
        struct orl_camera *camera = &path->views[i].camera;
        *camera = orl_camera_reframed(camera, choice->width, choice->height);
    }
    return result;
}

enum orl_result orl_photos_named(const struct orl_log *log, const struct orl_scene *scene,
                                 const struct orl_names *names, bool **named)
{
    *named = orl_array(log, scene->photo_count, sizeof **named);
    ORL_TRY_MEMORY(*named);
    for (size_t i = 0; i < names->count; i++) {
        size_t photo;
        ORL_TRY(find_photo(log, scene, names->items[i], &photo));
        (*named)[photo] = true;
    }
    return ORL_OK;
}
