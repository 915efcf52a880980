#include "oriel/path.h"

#include <jansson.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "core/file.h"
#include "core/json.h"
#include "core/memory.h"
#include "core/vec3.h"
#include "scene/colmap.h"
#include "scene/upright.h"

enum { PATH_VIEWS_MAX = 1000000 };

static const double SECONDS_MIN = 0.01, SECONDS_MAX = 3600; // from a keyframe to the next

struct orl_camera orl_camera_reframed(const struct orl_camera *camera, int width, int height)
{
    double scale = (double)height / camera->height;
    return (struct orl_camera){
        .width = width, .height = height, .fx = camera->fx * scale, .fy = camera->fy * scale,
        .cx = 0.5 * width + (camera->cx - 0.5 * camera->width) * scale,
        .cy = 0.5 * height + (camera->cy - 0.5 * camera->height) * scale};
}

static void set_fov_y(struct orl_camera *camera, double fov_y_rad)
{
    camera->fy = 0.5 * camera->height / tan(0.5 * fov_y_rad);
    camera->fx = camera->fy;
}

static enum orl_result allocate(const struct orl_log *log, size_t count, struct orl_path *path)
{
    memset(path, 0, sizeof *path);
    if (count < 1 || count > PATH_VIEWS_MAX)
        return orl_fail(log, ORL_ERR_DATA, "a camera path of %zu views", count);
    path->views = orl_array(log, count, sizeof *path->views);
    ORL_TRY_MEMORY(path->views);
    path->count = count;
    return ORL_OK;
}

void orl_path_finish(struct orl_path *path)
{
    free(path->views);
    memset(path, 0, sizeof *path);
}

// Views that are computed may lie beyond all bounds though those they come from do not: the path is
// released then.
static enum orl_result check_made(const struct orl_log *log, struct orl_path *path)
{
    for (size_t i = 0; i < path->count; i++) {
        const char *problem = orl_view_problem(&path->views[i]);
        if (problem) {
            orl_path_finish(path);
            return orl_fail(log, ORL_ERR_DATA, "view %zu of a path between these cameras is not "
                            "usable: %s", i, problem);
        }
    }
    return ORL_OK;
}

// --- interpolation ---

// Keyframes, and the seconds from each to the next one; NULL: all alike.
struct keys {
    const struct orl_path *path;
    const double *seconds;
};

static double seconds_from(const struct keys *keys, size_t key)
{
    return keys->seconds ? keys->seconds[key] : 1;
}

// A cubic Hermite spline through the centres, whose tangent at a keyframe is that of the chord
// between its neighbours: Catmull-Rom's where all keyframes are as far apart in time. t: of the
// segment, from 0 to 1.
static void spline_centre(const struct keys *keys, size_t segment, double t, double out[3])
{
    double c[4][3], own = seconds_from(keys, segment);
    size_t last = keys->path->count - 1;
    double before = segment > 0 ? seconds_from(keys, segment - 1) : own;
    double after = segment + 1 < last ? seconds_from(keys, segment + 1) : own;
    for (int k = 0; k < 4; k++) {
        size_t i = segment + (size_t)k;
        i = i == 0 ? 0 : i - 1;
        orl_pose_centre(&keys->path->views[i > last ? last : i].cam_from_world, c[k]);
    }
    for (int i = 0; i < 3; i++) {
        double leave = (c[2][i] - c[0][i]) * own / (before + own);
        double arrive = (c[3][i] - c[1][i]) * own / (own + after), way = c[2][i] - c[1][i];
        out[i] = c[1][i] + t * (leave + t * (3 * way - 2 * leave - arrive +
                                             t * (leave + arrive - 2 * way)));
    }
}

// Goes on from a segment, which begins at *begin, to the one that a time lies in. Returns the place in it, from 0 to 1.
static double advance(const struct keys *keys, double time, size_t *segment, double *begin)
{
    size_t last = keys->path->count - 2;
    while (*segment < last && time - *begin >= seconds_from(keys, *segment)) {
        *begin += seconds_from(keys, *segment);
        ++*segment;
    }
    return fmin(fmax((time - *begin) / seconds_from(keys, *segment), 0), 1);
}

static enum orl_result spread_frames(const struct orl_log *log, const struct keys *keys,
                                     size_t frames, struct orl_path *path)
{
    const struct orl_view *first = keys->path->views;
    size_t segment = 0;
    double all = 0, begin = 0;
    ORL_TRY(allocate(log, frames, path));
    for (size_t i = 0; i + 1 < keys->path->count; i++)
        all += seconds_from(keys, i);
    for (size_t i = 0; i < frames; i++) {
        double centre[3], share = frames > 1 ? (double)i / (double)(frames - 1) : 0;
        double t = advance(keys, share * all, &segment, &begin);
        struct orl_view *view = &path->views[i];
        *view = orl_view_interpolate(&first[segment], &first[segment + 1], t);
        view->camera = orl_camera_reframed(&view->camera, first->camera.width,
                                           first->camera.height);
        spline_centre(keys, segment, t, centre);
        orl_pose_set_centre(&view->cam_from_world, centre);
    }
    return check_made(log, path);
}

enum orl_result orl_path_through_photos(const struct orl_log *log, const struct orl_scene *scene,
                                        size_t frames, struct orl_path *path)
{
    struct orl_path keys;
    memset(path, 0, sizeof *path);
    if (scene->photo_count < 2 || frames < 2)
        return orl_fail(log, ORL_ERR_ARGUMENT, "a walk needs two photographs and two frames");
    ORL_TRY(allocate(log, scene->photo_count, &keys));
    for (size_t i = 0; i < scene->photo_count; i++)
        keys.views[i] = orl_photo_upright(&scene->photos[i]);
    enum orl_result result = spread_frames(log, &(struct keys){&keys, NULL}, frames, path);
    orl_path_finish(&keys);
    return result;
}

// --- a circle ---

struct circle {
    double middle[3]; // what its cameras look at
    double up[3], ahead[3], aside[3]; // unit vectors; ahead: from the middle to the first photograph
    double radius, height;
};

static bool find_circle(const struct orl_scene *scene, struct circle *circle)
{
    size_t before = 0;
    memset(circle, 0, sizeof *circle);
    if (!orl_scene_middle(scene, circle->middle) || !orl_scene_mean_up(scene, circle->up))
        return false;
    for (size_t n = 0; n < scene->photo_count; n++) {
        const struct orl_pose *pose = &scene->photos[n].view.cam_from_world;
        double from[3];
        orl_pose_centre(pose, from);
        for (int k = 0; k < 3; k++)
            from[k] -= circle->middle[k];
        double height = orl_dot3(from, circle->up);
        before += orl_dot3(from, pose->r[2]) < 0;
        circle->height += height / (double)scene->photo_count;
        circle->radius += sqrt(fmax(orl_dot3(from, from) - height * height, 0)) /
                          (double)scene->photo_count;
        for (int k = 0; n == 0 && k < 3; k++)
            circle->ahead[k] = from[k] - height * circle->up[k];
    }
    orl_cross3(circle->up, circle->ahead, circle->aside);
    return orl_normalize3(circle->ahead) > 0 && orl_normalize3(circle->aside) > 0 &&
           before == scene->photo_count;
}

enum orl_result orl_path_around(const struct orl_log *log, const struct orl_scene *scene,
                                size_t frames, struct orl_path *path)
{
    struct circle circle;
    memset(path, 0, sizeof *path);
    if (scene->photo_count < 2 || !find_circle(scene, &circle))
        return orl_fail(log, ORL_ERR_DATA, "the photographs do not look at one place that a path "
                        "could circle");
    ORL_TRY(allocate(log, frames, path));
    for (size_t i = 0; i < frames; i++) {
        double angle = 2 * M_PI * (double)i / (double)frames, eye[3];
        for (int k = 0; k < 3; k++)
            eye[k] = circle.middle[k] + circle.height * circle.up[k] +
                     circle.radius * (cos(angle) * circle.ahead[k] + sin(angle) * circle.aside[k]);
        path->views[i].camera = orl_photo_upright(&scene->photos[0]).camera;
        path->views[i].cam_from_world = orl_pose_look_at(eye, circle.middle, circle.up);
    }
    return check_made(log, path);
}

static enum orl_result check_view(const struct orl_log *log, const char *file, const char *what,
                                  size_t index, bool whole, const struct orl_view *view)
{
    const char *problem = whole ? orl_view_problem(view)
                                : "a value is missing, not known or out of range";
    return problem ? orl_fail(log, ORL_ERR_FORMAT, "%s: %s %zu is not usable: %s", file, what,
                              index, problem)
                   : ORL_OK;
}

// --- Oriel keyframes ---

// A photograph that it names must be in the scene.
static bool read_key(const struct orl_scene *scene, const json_t *key, struct orl_view *view,
                     double *seconds)
{
    const json_t *time = json_object_get(key, "seconds");
    double eye[3], target[3], up[3] = {0, -1, 0};
    const json_t *fov = json_object_get(key, "fov_y_deg");
    const char *photo = json_string_value(json_object_get(key, "photo"));
    const json_t *matrix = json_object_get(key, "cam_from_world");
    if (photo) {
        *view = scene->photos[orl_scene_find_photo(scene, photo)].view;
    } else if (matrix) {
        if (!orl_json_pose(matrix, &view->cam_from_world))
            return false;
    } else {
        const json_t *up_json = json_object_get(key, "up");
        if (!orl_json_read_numbers(json_object_get(key, "position"), 3, eye) ||
            !orl_json_read_numbers(json_object_get(key, "target"), 3, target) ||
            (up_json && !orl_json_read_numbers(up_json, 3, up)))
            return false;
        view->cam_from_world = orl_pose_look_at(eye, target, up);
    }
    if (fov) {
        double degrees = json_number_value(fov);
        if (!(degrees > 0.1 && degrees < 170))
            return false;
        set_fov_y(&view->camera, degrees * M_PI / 180);
    }
    *seconds = time ? json_number_value(time) : 1;
    return *seconds >= SECONDS_MIN && *seconds <= SECONDS_MAX;
}

static enum orl_result read_keyframes(const struct orl_log *log, const struct orl_scene *scene,
                                      const char *file, const json_t *root, struct orl_path *path)
{
    const json_t *keys = json_object_get(root, "keyframes");
    const json_t *frames = json_object_get(root, "frames");
    struct orl_path read;
    ORL_TRY(allocate(log, json_array_size(keys), &read));
    double *seconds = orl_array(log, read.count, sizeof *seconds);
    enum orl_result result = seconds ? ORL_OK : ORL_ERR_MEMORY;
    for (size_t i = 0; result == ORL_OK && i < read.count; i++) {
        const json_t *key = json_array_get(keys, i);
        const char *photo = json_string_value(json_object_get(key, "photo"));
        if (photo && orl_scene_find_photo(scene, photo) < 0) {
            result = orl_fail(log, ORL_ERR_FORMAT, "%s: keyframe %zu is not usable: the scene has no photograph %s",
                              file, i, photo);
            break;
        }
        read.views[i].camera = scene->photos[0].view.camera;
        bool ok = read_key(scene, key, &read.views[i], &seconds[i]);
        result = check_view(log, file, "keyframe", i, ok, &read.views[i]);
    }
    if (result == ORL_OK && frames) {
        json_int_t count = json_integer_value(frames);
        if (count < 2 || count > PATH_VIEWS_MAX || read.count < 2)
            result = orl_fail(log, ORL_ERR_FORMAT,
                              "%s: \"frames\" must be from 2 to %d, between two keyframes", file,
                              PATH_VIEWS_MAX);
        else
            result = spread_frames(log, &(struct keys){&read, seconds}, (size_t)count, path);
    } else if (result == ORL_OK) {
        *path = read;
        read = (struct orl_path){0};
    }
    free(seconds);
    orl_path_finish(&read);
    return result;
}

// --- other programs' formats ---

// nerfstudio: camera_to_world is row-major, fov is vertical.
static bool read_nerfstudio_view(const json_t *entry, int width, int height, struct orl_view *view)
{
    double m[16];
    double fov = json_number_value(json_object_get(entry, "fov"));
    if (!orl_json_read_numbers(json_object_get(entry, "camera_to_world"), 16, m) ||
        !(fov > 0.1 && fov < 170))
        return false;
    view->camera = (struct orl_camera){.width = width, .height = height,
                                       .cx = 0.5 * width, .cy = 0.5 * height};
    set_fov_y(&view->camera, fov * M_PI / 180);
    (void)orl_pose_from_opengl(m, &view->cam_from_world); // check_view reports problems
    return true;
}

// Inria's cameras.json: position is the camera centre, the columns of rotation are the camera's axes,
// and the principal point is the picture's centre.
static bool read_inria_view(const json_t *entry, struct orl_view *view)
{
    double axes[3][3], centre[3];
    int width = orl_json_side(entry, "width"), height = orl_json_side(entry, "height");
    view->camera = (struct orl_camera){
        .width = width, .height = height, .cx = 0.5 * width, .cy = 0.5 * height,
        .fx = orl_json_value(entry, "fx"), .fy = orl_json_value(entry, "fy")};
    if (!orl_json_rows(json_object_get(entry, "rotation"), 3, 3, &axes[0][0]) ||
        !orl_json_read_numbers(json_object_get(entry, "position"), 3, centre))
        return false;
    (void)orl_pose_from_axes(axes, centre, &view->cam_from_world); // check_view reports problems
    return true;
}

static enum orl_result read_json(const struct orl_log *log, const struct orl_scene *scene,
                                 const char *file, const json_t *root, struct orl_path *path)
{
    const json_t *nerfstudio = json_object_get(root, "camera_path"); // it has keyframes of its own
    if (!nerfstudio && json_is_array(json_object_get(root, "keyframes")))
        return read_keyframes(log, scene, file, root, path);
    const json_t *entries = json_is_array(root) ? root : nerfstudio;
    if (!json_is_array(entries))
        return orl_fail(log, ORL_ERR_FORMAT,
                        "%s: neither keyframes, nor nerfstudio's camera_path, nor Inria's cameras",
                        file);
    int width = orl_json_side(root, "render_width");
    int height = orl_json_side(root, "render_height");
    if (nerfstudio && (!width || !height))
        return orl_fail(log, ORL_ERR_FORMAT, "%s: render_width and render_height are not usable",
                        file);
    enum orl_result result = allocate(log, json_array_size(entries), path);
    for (size_t i = 0; result == ORL_OK && i < path->count; i++) {
        const json_t *entry = json_array_get(entries, i);
        bool ok = nerfstudio ? read_nerfstudio_view(entry, width, height, &path->views[i])
                             : read_inria_view(entry, &path->views[i]);
        result = check_view(log, file, "camera", i, ok, &path->views[i]);
        orl_pose_move(&path->views[i].cam_from_world, scene->origin);
    }
    return result;
}

static enum orl_result read_colmap_text(const struct orl_log *log, const struct orl_scene *scene,
                                        const char *file, struct orl_path *path)
{
    struct orl_colmap_model model;
    enum orl_result result = orl_colmap_read_poses(log, file, &model);
    if (result == ORL_OK && !model.image_count)
        result = orl_fail(log, ORL_ERR_FORMAT, "%s: no camera in it", file);
    ORL_THEN(result, allocate(log, model.image_count, path));
    for (size_t i = 0; result == ORL_OK && i < model.image_count; i++) {
        const struct orl_colmap_image *image = &model.images[i];
        const struct orl_colmap_camera *camera = orl_colmap_camera_by_id(&model, image->camera_id);
        path->views[i] = (struct orl_view){scene->photos[0].view.camera, image->cam_from_world};
        orl_pose_move(&path->views[i].cam_from_world, scene->origin);
        if (camera && camera->model <= 1)
            path->views[i].camera = camera->pinhole;
        else if (model.camera_count)
            result = orl_fail(log, ORL_ERR_FORMAT,
                              "%s: image %zu: its camera is not in cameras.txt or not PINHOLE",
                              file, i);
    }
    orl_colmap_finish(&model);
    return result;
}

enum orl_result orl_path_read(const struct orl_log *log, const struct orl_scene *scene,
                              const char *file, struct orl_path *path)
{
    json_t *root = NULL;
    memset(path, 0, sizeof *path);
    if (scene->photo_count < 1)
        return orl_fail(log, ORL_ERR_DATA, "%s: the scene has no photographs", scene->dir);
    enum orl_result result = ORL_OK;
    const char *extension = strrchr(file, '.');
    if (extension && strcmp(extension, ".txt") == 0) {
        result = read_colmap_text(log, scene, file, path);
    } else {
        result = orl_json_load(log, file, ORL_JSON_MAX_BYTES, &root);
        ORL_THEN(result, read_json(log, scene, file, root, path));
    }
    if (result != ORL_OK)
        orl_path_finish(path);
    json_decref(root);
    return result;
}
