// What a site shows of a scene of silhouettes: the subject's hull at each time step, as points, and the
// walls of the room around it, which stay.
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "bridge/bridge.h"
#include "core/memory.h"
#include "core/vec3.h"
#include "io/picture.h"
#include "render/photos/photos.h"
#include "render/proxy/proxy.h"
#include "scene/cones.h"
#include "scene/point_radii.h"
#include "scene/upright.h"
#include "walk/internal.h"

enum {
    HULL_SIDE = 96,         // voxels: the page loads so many points for each time step
    HULL_POINTS = 35000,    // at most, which fit into one file (COARSE_BYTES of cells.c)
    WALL_POINTS = 200000,   // about, of all photographs
};

// --- photographs and silhouettes of the time step ---

struct step {
    size_t count, masks;
    const struct orl_photo **photos; // that are not held out
    struct orl_image *pictures;      // of these, of their cameras' size
    struct orl_silhouette *silhouettes;
};

static void finish_step(struct step *step)
{
    for (size_t i = 0; i < step->count; i++)
        orl_image_finish(&step->pictures[i]);
    for (size_t i = 0; i < step->masks; i++)
        orl_image_finish(&step->silhouettes[i].mask);
    free(step->photos);
    free(step->pictures);
    free(step->silhouettes);
}

static enum orl_result read_step(const struct orl_log *log, const struct orl_scene *scene, struct step *step)
{
    *step = (struct step){.photos = orl_array(log, scene->photo_count, sizeof *step->photos),
                          .pictures = orl_array(log, scene->photo_count, sizeof *step->pictures),
                          .silhouettes = orl_array(log, scene->photo_count, sizeof *step->silhouettes)};
    enum orl_result result = step->photos && step->pictures && step->silhouettes ? ORL_OK : ORL_ERR_MEMORY;
    for (size_t i = 0; result == ORL_OK && i < scene->photo_count; i++) {
        const struct orl_photo *photo = &scene->photos[i];
        if (photo->test)
            continue;
        step->photos[step->count] = photo;
        result = orl_photo_read(log, scene, i, false, &step->pictures[step->count++]);
        if (result != ORL_OK || !photo->masked)
            continue;
        step->silhouettes[step->masks].view = photo->view;
        result = orl_photo_mask_read(log, scene, i, &step->silhouettes[step->masks++].mask);
    }
    return result;
}

// --- the hull ---

// The colour that the photograph shows which looks at the point most directly, whatever is before it:
// photographs paint the point where they see it.
static void color_point(const struct step *step, struct orl_points *points, size_t i)
{
    double best = -2, at[3], normal[3];
    for (int k = 0; k < 3; k++) {
        at[k] = (double)points->position[i][k];
        normal[k] = (double)points->normal[i][k];
    }
    for (size_t n = 0; n < step->count; n++) {
        double eye[3], to[3], pixel[2], depth;
        const struct orl_image *picture = &step->pictures[n];
        if (!orl_view_project(&step->photos[n]->view, at, pixel, &depth) || !(pixel[0] >= 0) || !(pixel[1] >= 0) ||
            !(pixel[0] < picture->width) || !(pixel[1] < picture->height))
            continue;
        orl_pose_centre(&step->photos[n]->view.cam_from_world, eye);
        for (int k = 0; k < 3; k++)
            to[k] = eye[k] - at[k];
        orl_normalize3(to);
        if (!(orl_dot3(to, normal) > best))
            continue;
        best = orl_dot3(to, normal);
        memcpy(points->color[i], picture->u8 + 3 * ((size_t)pixel[1] * (size_t)picture->width + (size_t)pixel[0]),
               sizeof points->color[i]);
    }
}

static enum orl_result hull_points(const struct orl_log *log, const struct step *step, bool *said_endless,
                                   struct orl_points *points)
{
    const struct orl_radii_params radii = {ORL_RADII_DEFAULTS};
    struct orl_mesh mesh = {0};
    enum orl_result result =
        orl_cones_mesh(log, step->silhouettes, step->masks, HULL_SIDE, 0, said_endless, &mesh);
    ORL_THEN(result, orl_points_init(log, points, mesh.vertex_count));
    for (size_t i = 0; result == ORL_OK && i < mesh.vertex_count; i++) {
        memcpy(points->position[i], mesh.position[i], sizeof mesh.position[i]);
        memcpy(points->normal[i], mesh.normal[i], sizeof mesh.normal[i]);
        color_point(step, points, i);
    }
    ORL_THEN(result, orl_points_set_radii(log, NULL, &radii, NULL, 0, points));
    orl_mesh_finish(&mesh);
    return result;
}

// --- the room ---

// How far a ray from `eye` goes until it leaves the room, in lengths of the ray. 0: it begins outside.
static double ray_end(const struct orl_room *room, const double eye[3], const double ray[3])
{
    double from[3], along[3], end = INFINITY, a, b, c, root;
    for (int k = 0; k < 3; k++) { // into a room from -1 to 1
        double half = 0.5 * (room->high[k] - room->low[k]);
        from[k] = (eye[k] - 0.5 * (room->high[k] + room->low[k])) / half;
        along[k] = ray[k] / half;
        if (fabs(along[k]) > 0)
            end = fmin(end, (copysign(1, along[k]) - from[k]) / along[k]);
    }
    if (room->known)
        return fmax(end, 0);
    a = orl_dot3(along, along);
    b = orl_dot3(along, from);
    c = orl_dot3(from, from) - 1;
    root = b * b - a * c;
    return root > 0 ? fmax((sqrt(root) - b) / a, 0) : 0;
}

// The depth of the wall behind a pixel; 0: none.
static double wall_depth(const struct site *site, const struct orl_view *view, double x, double y)
{
    double eye[3], ray[3];
    orl_pose_centre(&view->cam_from_world, eye);
    orl_view_unproject(view, x, y, 1, ray);
    for (int k = 0; k < 3; k++)
        ray[k] -= eye[k];
    return ray_end(&site->room, eye, ray);
}

void orl_site_room_depth(const struct site *site, const struct orl_view *view, struct orl_image *depth)
{
    for (int y = 0; y < depth->height; y++)
        for (int x = 0; x < depth->width; x++) {
            float *z = &depth->f32[(size_t)y * (size_t)depth->width + (size_t)x];
            if (!(*z > 0))
                *z = (float)wall_depth(site, view, x + 0.5, y + 0.5);
        }
}

static enum orl_result find_room(struct site *site, const struct orl_points *hull)
{
    double middle[3], half[3], low[3] = {0}, high[3] = {0};
    site->room = site->scene->room;
    if (site->room.known)
        return ORL_OK;
    ORL_TRY(orl_vertices_range(site->log, (const float (*)[3])hull->position, hull->count, 0.02, low, high));
    orl_room_measure(site->scene, low, high, middle, half);
    for (int k = 0; k < 3; k++) {
        site->room.low[k] = middle[k] - half[k];
        site->room.high[k] = middle[k] + half[k];
    }
    return ORL_OK;
}

// Reads a picture of the empty place, which may be of any size, as large as its photograph.
static enum orl_result read_background(const struct orl_log *log, const char *path, const struct orl_camera *camera,
                                       struct orl_image *image)
{
    struct orl_image whole = {0};
    enum orl_result result = orl_picture_read(log, path, 3, &whole);
    ORL_THEN(result, orl_bridge_resize(log, &whole, camera->width, camera->height, image));
    orl_image_finish(&whole);
    return result;
}

// Points where a photograph shows the room: its picture of the empty place, else what is beside the
// silhouette.
static enum orl_result wall_of(const struct site *site, size_t photo, size_t most, struct orl_points *walls)
{
    const struct orl_log *log = site->log;
    const struct orl_view *view = &site->scene->photos[photo].view;
    const struct orl_camera *c = &view->camera;
    struct orl_image picture = {0}, mask = {0};
    const struct orl_file_path path = orl_scene_file(site->scene, photo, ORL_FILE_BACKGROUND);
    bool empty = orl_path_is_file(path.text);
    enum orl_result result = empty ? read_background(log, path.text, c, &picture)
                                   : orl_photo_read(log, site->scene, photo, false, &picture);
    if (result == ORL_OK && !empty && site->scene->photos[photo].masked)
        result = orl_photo_mask_read(log, site->scene, photo, &mask);
    int step = 1 + (int)sqrt((double)c->width * c->height / (double)most);
    for (int y = step / 2; result == ORL_OK && y < picture.height; y += step)
        for (int x = step / 2; x < picture.width; x += step) {
            size_t at = (size_t)y * (size_t)picture.width + (size_t)x, i = walls->count;
            double z = wall_depth(site, view, x + 0.5, y + 0.5), world[3], eye[3];
            if (!(z > 0) || (mask.u8 && mask.u8[at]))
                continue;
            orl_view_unproject(view, x + 0.5, y + 0.5, z, world);
            orl_pose_centre(&view->cam_from_world, eye);
            for (int k = 0; k < 3; k++)
                eye[k] -= world[k];
            orl_normalize3(eye);
            for (int k = 0; k < 3; k++) {
                walls->position[i][k] = (float)world[k];
                walls->normal[i][k] = (float)eye[k];
            }
            walls->radius[i] = (float)(step * z / fmin(c->fx, c->fy));
            memcpy(walls->color[i], picture.u8 + 3 * at, sizeof walls->color[i]);
            walls->count++;
        }
    orl_image_finish(&picture);
    orl_image_finish(&mask);
    return result;
}

enum orl_result orl_site_room(struct site *site, struct orl_points *walls)
{
    struct orl_points hull = {0};
    struct step step;
    const struct orl_scene *scene = site->scene;
    enum orl_result result = read_step(site->log, scene, &step);
    ORL_THEN(result, hull_points(site->log, &step, NULL, &hull));
    ORL_THEN(result, find_room(site, &hull));
    size_t each = step.count ? WALL_POINTS / step.count : 0;
    if (result == ORL_OK) // rows and columns of a picture are rounded up
        result = orl_points_init(site->log, walls, 2 * WALL_POINTS + step.count * 20000);
    walls->count = 0;
    for (size_t i = 0; result == ORL_OK && i < scene->photo_count; i++)
        if (!scene->photos[i].test)
            result = wall_of(site, i, each, walls);
    finish_step(&step);
    orl_points_finish(&hull);
    return result;
}

// --- all time steps ---

// Of a photograph what another time step shows.
static json_t *shown_json(json_t *photos)
{
    json_t *shown = json_array(), *photo;
    size_t i;
    json_array_foreach(photos, i, photo)
        json_array_append_new(shown, json_pack("{s:O, s:O}", "picture", json_object_get(photo, "picture"),
                                               "depth", json_object_get(photo, "depth")));
    return shown;
}

static enum orl_result write_step(struct site *site, bool *said_endless, json_t *steps)
{
    json_t *points = NULL, *photos = NULL;
    struct orl_points hull = {0};
    struct step step;
    static const char *const parts[] = {"points", "photos", "depth"};
    enum orl_result result = read_step(site->log, site->scene, &step);
    ORL_THEN(result, hull_points(site->log, &step, said_endless, &hull));
    finish_step(&step);
    bool first = json_array_size(steps) == 0; // whose photographs are the site's
    for (size_t i = 0; result == ORL_OK && i < (first ? 1 : ORL_COUNT(parts)); i++)
        result = orl_dir_make(site->log, ORL_PATH(site->dir, "%s%s", site->folder, parts[i]));
    ORL_THEN(result, orl_site_points(site, &hull, HULL_POINTS, &points));
    if (result == ORL_OK && !first)
        result = orl_site_photos(site, &photos);
    if (result == ORL_OK)
        json_array_append_new(steps, json_pack("{s:O, s:o*}", "points", json_object_get(points, "coarse"),
                                               "photos", photos ? shown_json(photos) : NULL));
    json_decref(points);
    json_decref(photos);
    orl_points_finish(&hull);
    return result;
}

enum orl_result orl_site_steps(struct site *site, json_t **out)
{
    struct orl_scene *scene = site->scene;
    size_t count = scene->frame_count ? scene->frame_count : 1;
    int before = scene->frame;
    bool said_endless = false;
    char folder[32];
    enum orl_result result = ORL_OK;
    json_t *steps = *out = json_array();
    site->folder = folder;
    for (size_t t = 0; result == ORL_OK && t < count; t++) {
        snprintf(folder, sizeof folder, "steps/%05zu/", t);
        if (orl_progress_cancelled(site->params->progress))
            result = ORL_ERR_CANCELLED;
        if (result == ORL_OK && scene->frame_count)
            result = orl_scene_set_frame(site->log, scene, (int)t);
        ORL_THEN(result, write_step(site, &said_endless, steps));
        orl_progress_report(site->params->progress, "time steps", (double)(t + 1), (double)count, NULL);
    }
    site->folder = "";
    if (scene->frame_count && orl_scene_set_frame(site->log, scene, before) != ORL_OK && result == ORL_OK)
        result = ORL_ERR_IO;
    return result;
}
