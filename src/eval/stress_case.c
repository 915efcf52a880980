// Scenes in memory: copies, files, radii.
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "core/file.h"
#include "core/memory.h"
#include "core/vec3.h"
#include "eval/stress_internal.h"
#include "io/picture.h"
#include "scene/cones.h"
#include "scene/free_space.h"
#include "scene/radius_limits.h"

enum { HULL_SIDE = 128 }; // voxels

// --- copies ---

static enum orl_result copy_image(const struct orl_log *log, const struct orl_image *from,
                                  struct orl_image *to)
{
    if (!from->data)
        return ORL_OK;
    enum orl_result result =
        orl_image_init(log, to, from->width, from->height, from->channels, from->type);
    if (result == ORL_OK)
        memcpy(to->data, from->data, orl_image_bytes(from));
    return result;
}

static enum orl_result copy_images(const struct orl_log *log, const struct orl_image *from,
                                   size_t count, struct orl_image **to)
{
    *to = orl_array(log, count, sizeof **to);
    enum orl_result result = *to ? ORL_OK : ORL_ERR_MEMORY;
    for (size_t i = 0; result == ORL_OK && i < count; i++)
        result = copy_image(log, &from[i], &(*to)[i]);
    return result;
}

static enum orl_result copy_views(const struct orl_log *log, const struct stress_view *from,
                                  size_t count, struct stress_view **to)
{
    *to = orl_array(log, count, sizeof **to);
    enum orl_result result = *to ? ORL_OK : ORL_ERR_MEMORY;
    for (size_t i = 0; result == ORL_OK && i < count; i++) {
        struct stress_view *view = &(*to)[i];
        view->photo = from[i].photo;
        view->view = from[i].view;
        result = copy_image(log, &from[i].picture, &view->picture);
        if (result == ORL_OK)
            result = copy_image(log, &from[i].depth, &view->depth);
    }
    return result;
}

static enum orl_result copy_scene(const struct orl_log *log, const struct orl_scene *from,
                                  struct orl_scene *to)
{
    to->dir = orl_strdup(log, from->dir ? from->dir : "");
    to->photos = orl_array(log, from->photo_count, sizeof *to->photos);
    if (!to->dir || !to->photos)
        return ORL_ERR_MEMORY;
    for (; to->photo_count < from->photo_count; to->photo_count++) {
        struct orl_photo *photo = &to->photos[to->photo_count];
        *photo = from->photos[to->photo_count];
        photo->name = orl_strdup(log, from->photos[to->photo_count].name);
        if (!photo->name)
            return ORL_ERR_MEMORY;
    }
    to->frame = from->frame;
    to->photo_distance = from->photo_distance;
    to->near_distance = from->near_distance;
    to->ground = from->ground;
    enum orl_result result = orl_points_init(log, &to->points, from->points.count);
    for (size_t i = 0; result == ORL_OK && i < from->points.count; i++)
        orl_points_copy(&from->points, i, &to->points, i);
    return result;
}

enum orl_result orl_stress_copy(const struct stress_case *from, struct stress_case *to)
{
    const struct orl_log *log = orl_gpu_log(from->gpu);
    size_t photos = from->scene.photo_count;
    *to = (struct stress_case){.gpu = from->gpu, .view_count = from->view_count,
                               .walk_count = from->walk_count, .synth = from->synth,
                               .borrowed_synth = true, .jpeg_quality = from->jpeg_quality};
    enum orl_result result = copy_scene(log, &from->scene, &to->scene);
    if (result == ORL_OK)
        result = copy_images(log, from->photos, photos, &to->photos);
    if (result == ORL_OK)
        result = copy_images(log, from->masks, photos, &to->masks);
    if (result == ORL_OK)
        result = copy_views(log, from->views, from->view_count, &to->views);
    if (result == ORL_OK)
        result = copy_views(log, from->walk, from->walk_count, &to->walk);
    return result;
}

enum orl_result orl_stress_own_scene(const struct stress_case *c, struct stress_view *view)
{
    const struct orl_log *log = orl_gpu_log(c->gpu);
    view->scene = orl_array(log, 1, sizeof *view->scene);
    return view->scene ? copy_scene(log, &c->scene, view->scene) : ORL_ERR_MEMORY;
}

enum orl_result orl_stress_open(struct stress_case *c)
{
    enum orl_result result = orl_renderer_create(c->gpu, &c->scene, NULL, &c->renderer);
    for (size_t i = 0; result == ORL_OK && i < c->view_count + c->walk_count; i++) {
        struct stress_view *view = i < c->view_count ? &c->views[i] : &c->walk[i - c->view_count];
        if (view->scene)
            result = orl_renderer_create(c->gpu, view->scene, NULL, &view->renderer);
    }
    return result;
}

static void finish_scene(struct orl_scene *scene)
{
    for (size_t i = 0; i < scene->photo_count; i++)
        free(scene->photos[i].name);
    free(scene->photos);
    free(scene->dir);
    orl_points_finish(&scene->points);
}

static void finish_views(struct stress_view *views, size_t count)
{
    for (size_t i = 0; views && i < count; i++) {
        orl_image_finish(&views[i].picture);
        orl_image_finish(&views[i].depth);
        orl_renderer_destroy(&views[i].renderer);
        if (views[i].scene)
            finish_scene(views[i].scene);
        free(views[i].scene);
    }
    free(views);
}

void orl_stress_case_finish(struct stress_case *c)
{
    orl_renderer_destroy(&c->renderer);
    for (size_t i = 0; i < c->scene.photo_count; i++) {
        if (c->photos)
            orl_image_finish(&c->photos[i]);
        if (c->masks)
            orl_image_finish(&c->masks[i]);
    }
    free(c->photos);
    free(c->masks);
    finish_views(c->views, c->view_count);
    finish_views(c->walk, c->walk_count);
    finish_scene(&c->scene);
    if (!c->borrowed_synth)
        orl_synth_destroy(&c->synth);
    memset(c, 0, sizeof *c);
}

// --- points ---

enum orl_result orl_stress_set_radii(struct stress_case *c)
{
    const struct orl_log *log = orl_gpu_log(c->gpu);
    const struct orl_radii_params radii = {ORL_RADII_DEFAULTS};
    const struct orl_radii_limits limits = {ORL_RADII_LIMITS_DEFAULTS};
    size_t count = 0;
    struct orl_view *views = orl_array(log, c->scene.photo_count, sizeof *views);
    double(*eyes)[3] = orl_array(log, c->scene.photo_count, sizeof *eyes);
    enum orl_result result = views && eyes ? ORL_OK : ORL_ERR_MEMORY;
    for (size_t i = 0; result == ORL_OK && i < c->scene.photo_count; i++) {
        if (c->scene.photos[i].test)
            continue;
        views[count] = c->scene.photos[i].view;
        orl_pose_centre(&views[count].cam_from_world, eyes[count]);
        count++;
    }
    if (result == ORL_OK)
        result = orl_points_drop_in_free_space(log, views, count, &c->scene.points);
    if (result == ORL_OK && c->scene.points.count)
        result = orl_points_set_radii(log, NULL, &radii, (const double(*)[3])eyes, count,
                                      &c->scene.points);
    if (result == ORL_OK && c->scene.points.count)
        result = orl_points_limit_radii(log, &limits, views, count, &c->scene.points);
    free(views);
    free(eyes);
    return result;
}

// --- files ---

static enum orl_result write_hull(const struct stress_case *c)
{
    const struct orl_log *log = orl_gpu_log(c->gpu);
    struct orl_silhouette *silhouettes =
        orl_array(log, c->scene.photo_count, sizeof *silhouettes);
    struct orl_mesh mesh = {0};
    size_t count = 0;
    char *path = orl_scene_mesh_path(log, &c->scene);
    enum orl_result result = silhouettes && path ? ORL_OK : ORL_ERR_MEMORY;
    for (size_t i = 0; result == ORL_OK && i < c->scene.photo_count; i++)
        if (!c->scene.photos[i].test && c->masks[i].data)
            silhouettes[count++] =
                (struct orl_silhouette){c->scene.photos[i].view, c->masks[i]};
    // Silhouettes that are wrong enough have no place in common; that is no error of the program.
    if (result == ORL_OK)
        result = orl_cones_mesh(NULL, silhouettes, count, HULL_SIDE, 0, NULL, &mesh);
    if (result == ORL_ERR_DATA)
        result = ORL_ERR_NOT_FOUND;
    if (result == ORL_OK)
        result = orl_mesh_write(log, path, &mesh);
    orl_mesh_finish(&mesh);
    free(silhouettes);
    free(path);
    return result;
}

static enum orl_result write_file(const struct stress_case *c, char *path,
                                  const struct orl_image *image, int quality)
{
    const struct orl_log *log = orl_gpu_log(c->gpu);
    enum orl_result result = !path     ? ORL_ERR_MEMORY
                             : quality ? orl_jpeg_write(log, path, image, quality, NULL)
                                       : orl_png_write(log, path, image);
    free(path);
    return result;
}

static enum orl_result make_folder(const struct orl_log *log, const char *dir, const char *name)
{
    char *path = orl_path_join(log, dir, name);
    enum orl_result result = path ? orl_dir_make(log, path) : ORL_ERR_MEMORY;
    free(path);
    return result;
}

enum orl_result orl_stress_write_files(struct stress_case *c, const char *dir, bool hull)
{
    const struct orl_log *log = orl_gpu_log(c->gpu);
    free(c->scene.dir);
    c->scene.dir = orl_strdup(log, dir);
    enum orl_result result = c->scene.dir ? make_folder(log, dir, "images") : ORL_ERR_MEMORY;
    if (result == ORL_OK)
        result = make_folder(log, dir, "masks");
    for (size_t i = 0; result == ORL_OK && i < c->scene.photo_count; i++) {
        if (c->scene.photos[i].test)
            continue;
        result = write_file(c, orl_scene_photo_path(log, &c->scene, i), &c->photos[i],
                            c->jpeg_quality);
        if (result == ORL_OK && c->masks[i].data)
            result = write_file(c, orl_scene_mask_path(log, &c->scene, i), &c->masks[i], 0);
    }
    return result == ORL_OK && hull ? write_hull(c) : result;
}
