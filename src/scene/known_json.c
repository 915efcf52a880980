// Cameras in JSON: Oriel's cameras.json, Inria's, nerfstudio's transforms.json, and Blender's sets of
// such files.
#include <math.h>
#include <stdio.h>
#include <string.h>
#include <strings.h>

#include "core/file.h"
#include "core/json.h"
#include "scene/json_views.h"
#include "scene/known_internal.h"
#include "scene/manifest.h"

enum { PLACE_SIZE = 160 };

// "camera 3 (0003.jpg)"
static const char *place_of(size_t index, const char *name, char place[PLACE_SIZE])
{
    snprintf(place, PLACE_SIZE, "camera %zu%s%.120s%s", index, name ? " (" : "", name ? name : "", name ? ")" : "");
    return place;
}

// --- cameras.json ---

static enum orl_result read_own(const struct orl_known_source *source, const json_t *item,
                                struct orl_known_camera *camera)
{
    double k[3][3], dist[8];
    const json_t *distortion = json_object_get(item, "dist");
    size_t terms = json_array_size(distortion);
    if (!orl_json_rows(json_object_get(item, "K"), 3, 3, &k[0][0]))
        return orl_known_bad(source, camera->place, "\"K\" is not 3 rows of 3 numbers");
    if (!orl_json_rows(json_object_get(item, "R"), 3, 3, &camera->pose.r[0][0]))
        return orl_known_bad(source, camera->place, "\"R\" is not 3 rows of 3 numbers");
    if (!orl_json_read_numbers(json_object_get(item, "t"), 3, camera->pose.t))
        return orl_known_bad(source, camera->place, "\"t\" is not 3 numbers");
    if (distortion && (terms > ORL_COUNT(dist) || !orl_json_read_numbers(distortion, terms, dist)))
        return orl_known_bad(source, camera->place, "\"dist\" is not up to 8 numbers, k1 k2 p1 p2 k3 k4 k5 k6");
    camera->width = orl_json_side(item, "width");
    camera->height = orl_json_side(item, "height");
    // Only cameras without skew are supported: it may shift a pixel by at most half a pixel
    // within the picture's half height.
    if (!(fabs(k[0][1]) * camera->height <= fabs(k[1][1])))
        return orl_known_bad(source, camera->place, "\"K\" has a skew, which is not supported");
    const double f_c[4] = {k[0][0], k[1][1], k[0][2] + source->shift, k[1][2] + source->shift};
    orl_known_set_lens(camera, f_c, dist, terms, false);
    return ORL_OK;
}

// --- Inria's ---

static enum orl_result read_inria(const struct orl_known_source *source, const json_t *item,
                                  struct orl_known_camera *camera)
{
    struct orl_view view;
    if (!orl_json_inria_view(item, &view) || orl_view_problem(&view))
        return orl_known_bad(source, camera->place, "position, rotation, width, height, fx or fy is missing or not usable");
    const struct orl_camera *c = &view.camera;
    const double f_c[4] = {c->fx, c->fy, c->cx, c->cy};
    orl_known_set_lens(camera, f_c, NULL, 0, false);
    camera->width = c->width;
    camera->height = c->height;
    camera->pose = view.cam_from_world;
    return ORL_OK;
}

// --- nerfstudio's ---

// Reads a number from the frame, or else from the file. False when neither has it.
static bool number(const json_t *root, const json_t *frame, const char *key, double *value)
{
    const json_t *found = json_object_get(frame, key);
    found = found ? found : json_object_get(root, key);
    *value = json_number_value(found);
    return json_is_number(found) && isfinite(*value);
}

static const char *camera_model(const json_t *root, const json_t *frame)
{
    const char *of_frame = json_string_value(json_object_get(frame, "camera_model"));
    const char *of_all = json_string_value(json_object_get(root, "camera_model"));
    return of_frame ? of_frame : of_all ? of_all : "OPENCV";
}

static bool is_true(const json_t *value)
{
    const char *text = json_string_value(value);
    return json_is_true(value) || json_number_value(value) != 0 || (text && strcasecmp(text, "true") == 0);
}

// instant-ngp's scripts write "is_fisheye" instead of a model. False: the model is unknown.
static bool find_lens(const json_t *root, const json_t *frame, bool *is_fisheye)
{
    static const char *const brown[] = {"OPENCV", "SIMPLE_RADIAL", "RADIAL", "PINHOLE",
                                        "SIMPLE_PINHOLE", "PERSPECTIVE"};
    const char *model = camera_model(root, frame);
    const json_t *told = json_object_get(frame, "is_fisheye");
    told = told ? told : json_object_get(root, "is_fisheye");
    *is_fisheye = strcasecmp(model, "OPENCV_FISHEYE") == 0 ||
                  (strcasecmp(model, "OPENCV") == 0 && is_true(told));
    bool known = *is_fisheye;
    for (size_t i = 0; i < ORL_COUNT(brown); i++)
        known = known || strcasecmp(model, brown[i]) == 0;
    return known;
}

static enum orl_result read_nerfstudio(const struct orl_known_source *source, const json_t *frame,
                                       struct orl_known_camera *camera)
{
    const json_t *root = source->root;
    static const char *const brown[] = {"k1", "k2", "p1", "p2", "k3"};
    static const char *const fisheye[] = {"k1", "k2", "k3", "k4"};
    double rows[16], f_c[4], terms[5] = {0}, width = 0, height = 0, other;
    // Some programs leave out the last row, which is always 0 0 0 1.
    const json_t *matrix = json_object_get(frame, "transform_matrix");
    if (!orl_json_rows(matrix, json_array_size(matrix) == 3 ? 3 : 4, 4, rows) ||
        !orl_pose_from_opengl(rows, &camera->pose))
        return orl_known_bad(source, camera->place, "\"transform_matrix\" is not 4 rows of 4 numbers with a rotation");
    if (json_array_size(matrix) == 4 && (rows[12] != 0 || rows[13] != 0 || rows[14] != 0 || rows[15] != 1))
        return orl_known_bad(source, camera->place, "the last row of \"transform_matrix\" is not 0 0 0 1");
    bool is_fisheye;
    if (!find_lens(root, frame, &is_fisheye))
        return orl_fail(source->log, ORL_ERR_FORMAT, "%s: %s: its camera_model, %.60s, is not read: Oriel "
                        "reads PINHOLE, OPENCV, RADIAL and OPENCV_FISHEYE; panoramas must be cut into "
                        "flat views", source->path, camera->place, camera_model(root, frame));
    camera->gap.size = !number(root, frame, "w", &width) || !number(root, frame, "h", &height);
    if (!camera->gap.size) {
        camera->width = width >= 1 && width <= ORL_IMAGE_MAX_SIDE ? (int)width : 0;
        camera->height = height >= 1 && height <= ORL_IMAGE_MAX_SIDE ? (int)height : 0;
    }
    if (number(root, frame, "fl_x", &f_c[0])) {
        if (!number(root, frame, "fl_y", &f_c[1]))
            f_c[1] = f_c[0];
    } else if (number(root, frame, "camera_angle_x", &camera->gap.fov_x_rad)) {
        f_c[0] = f_c[1] = 0;
    } else {
        return orl_known_bad(source, camera->place, "neither fl_x nor camera_angle_x");
    }
    camera->gap.centre =
        !number(root, frame, "cx", &f_c[2]) || !number(root, frame, "cy", &f_c[3]);
    for (int i = 2; i < 4; i++)
        f_c[i] = camera->gap.centre ? 0 : f_c[i] + source->shift;
    for (size_t i = 0; is_fisheye ? i < ORL_COUNT(fisheye) : i < ORL_COUNT(brown); i++)
        if (!number(root, frame, is_fisheye ? fisheye[i] : brown[i], &terms[i]))
            terms[i] = 0;
    const char *const lost[2] = {is_fisheye ? "p1" : "k4", is_fisheye ? "p2" : "k4"};
    for (size_t i = 0; i < ORL_COUNT(lost); i++)
        if (number(root, frame, lost[i], &other) && other != 0)
            return orl_fail(source->log, ORL_ERR_FORMAT, "%s: %s: %s of its lens is not read: undistort the "
                            "pictures with the program that calibrated them", source->path, camera->place, lost[i]);
    orl_known_set_lens(camera, f_c, terms, is_fisheye ? ORL_COUNT(fisheye) : ORL_COUNT(brown), is_fisheye);
    return ORL_OK;
}

// --- lists of cameras ---

static enum orl_result read_list(const struct orl_known_source *source, const json_t *list, const char *name_key,
                                 enum orl_result (*read)(const struct orl_known_source *, const json_t *,
                                                         struct orl_known_camera *),
                                 struct orl_known_cameras *known)
{
    for (size_t i = 0; i < json_array_size(list); i++) {
        const json_t *item = json_array_get(list, i);
        const char *name = orl_json_text(item, name_key);
        char place[PLACE_SIZE];
        struct orl_known_camera camera = {.path = name, .place = place_of(i, name, place)};
        if (!name)
            return orl_fail(source->log, ORL_ERR_FORMAT, "%s: %s has no \"%s\"", source->path, place, name_key);
        ORL_TRY(read(source, item, &camera));
        ORL_TRY(orl_known_add(source, &camera, known));
    }
    return ORL_OK;
}

enum orl_result orl_known_read_own(const struct orl_known_source *source,
                                   struct orl_known_cameras *known)
{
    static const char *const used[] = {"pixel_centre", "room", "cameras", "name", "width", "height",
                                       "K", "R", "t", "dist", NULL};
    static const char *const lists[] = {"cameras", NULL};
    const json_t *list = json_object_get(source->root, "cameras");
    enum orl_result result = read_list(source, list, "name", read_own, known);
    ORL_THEN(result, orl_manifest_read_room(source->log, source->path, source->root, &known->room));
    orl_known_say_unused_of(source, source->root, used, lists);
    return result;
}

enum orl_result orl_known_read_inria(const struct orl_known_source *source,
                                     struct orl_known_cameras *known)
{
    static const char *const used[] = {"id", "img_name", "width", "height", "position", "rotation", "fx",
                                       "fy", NULL};
    enum orl_result result = read_list(source, source->root, "img_name", read_inria, known);
    orl_known_say_unused_of(source, source->root, used, NULL);
    return result;
}

// --- transforms.json ---

static bool is_separator(char c)
{
    return c == '/' || c == '\\';
}

// Length without the extension.
static size_t stem_length(const char *path)
{
    size_t length = strlen(path), at = length;
    while (at > 0 && path[at - 1] != '.' && !is_separator(path[at - 1]))
        at--;
    return at > 0 && path[at - 1] == '.' ? at - 1 : length;
}

// True when one of two paths ends with the other, whatever separates their parts and whether or not
// either has an extension.
static bool same_picture(const char *a, const char *b)
{
    bool extensions = a[stem_length(a)] && b[stem_length(b)];
    size_t i = extensions ? strlen(a) : stem_length(a), k = extensions ? strlen(b) : stem_length(b);
    while (i > 0 && k > 0 && (a[i - 1] == b[k - 1] || (is_separator(a[i - 1]) && is_separator(b[k - 1]))))
        i--, k--;
    return (i == 0 || k == 0) && (i == 0 || is_separator(a[i - 1]) || is_separator(a[i])) &&
           (k == 0 || is_separator(b[k - 1]) || is_separator(b[k]));
}

// True when a list of file names, as "train_filenames", has a frame's path.
static bool is_listed(const json_t *root, const char *key, const char *path)
{
    const json_t *list = json_object_get(root, key);
    for (size_t i = 0; i < json_array_size(list); i++) {
        const char *name = json_string_value(json_array_get(list, i));
        name = name && strncmp(name, "./", 2) == 0 ? name + 2 : name;
        if (name && *name && same_picture(name, strncmp(path, "./", 2) == 0 ? path + 2 : path))
            return true;
    }
    return false;
}

// Where the file has lists of photographs, those on none of them are not used. Photographs for
// validation are held out where there are none for testing.
static enum orl_known_split split_of(const json_t *root, const char *path)
{
    bool tests = json_array_size(json_object_get(root, "test_filenames")) > 0;
    if (is_listed(root, "test_filenames", path) ||
        (!tests && is_listed(root, "val_filenames", path)))
        return ORL_KNOWN_TEST;
    return !json_object_get(root, "train_filenames") || is_listed(root, "train_filenames", path)
               ? ORL_KNOWN_TRAIN : ORL_KNOWN_UNUSED;
}

// `split`: of all frames; ORL_KNOWN_TRAIN: as the file says.
static enum orl_result read_frames(const struct orl_known_source *source,
                                   enum orl_known_split split, struct orl_known_cameras *known)
{
    static const char *const used[] = {
        "frames", "file_path", "transform_matrix", "mask_path", "camera_model", "w", "h", "fl_x", "fl_y",
        "cx", "cy", "k1", "k2", "k3", "k4", "p1", "p2", "camera_angle_x", "camera_angle_y",
        "is_fisheye", "train_filenames", "val_filenames", "test_filenames", "ply_file_path", NULL};
    static const char *const lists[] = {"frames", NULL};
    const json_t *root = source->root, *frames = json_object_get(root, "frames");
    bool held_out = split != ORL_KNOWN_TRAIN, any = split == ORL_KNOWN_UNUSED || !json_array_size(frames);
    for (size_t i = 0; i < json_array_size(frames); i++) {
        const json_t *frame = json_array_get(frames, i);
        const char *path = orl_json_text(frame, "file_path");
        char place[PLACE_SIZE];
        struct orl_known_camera camera = {.path = path, .mask = orl_json_text(frame, "mask_path"),
                                          .place = place_of(i, path, place), .split = split};
        if (!path)
            return orl_known_bad(source, place, "no \"file_path\"");
        if (split == ORL_KNOWN_TRAIN)
            camera.split = split_of(root, path);
        known->splits = known->splits || camera.split != ORL_KNOWN_TRAIN;
        any = any || camera.split != ORL_KNOWN_UNUSED;
        held_out = held_out || camera.split == ORL_KNOWN_TEST;
        ORL_TRY(read_nerfstudio(source, frame, &camera));
        ORL_TRY(orl_known_add(source, &camera, known));
    }
    orl_known_say_unused_of(source, root, used, lists);
    if (!held_out && json_array_size(json_object_get(root, "test_filenames")))
        orl_logf(source->log, ORL_LOG_WARNING, "%s: test_filenames has none of the frames: none is held "
                 "out", source->path);
    return any ? ORL_OK
               : orl_fail(source->log, ORL_ERR_DATA, "%s: train_filenames has none of the frames",
                          source->path);
}

enum orl_result orl_known_read_transforms(const struct orl_known_source *source,
                                          struct orl_known_cameras *known)
{
    const char *points = orl_json_text(source->root, "ply_file_path");
    ORL_TRY(read_frames(source, ORL_KNOWN_TRAIN, known));
    if (points && !orl_known_find(known->folder, points, known->points_file))
        orl_path_print(known->points_file, "", "%s", points);
    return ORL_OK;
}

// --- Blender's sets: a folder with a transforms.json for each split ---

enum orl_result orl_known_read_splits(const struct orl_known_source *source,
                                      struct orl_known_cameras *known)
{
    // Photographs for validation are used where there are none for testing.
    static const struct {
        const char *name;
        enum orl_known_split split;
    } files[] = {{"transforms_train.json", ORL_KNOWN_TRAIN}, {"transforms_test.json", ORL_KNOWN_TEST},
                 {"transforms_val.json", ORL_KNOWN_UNUSED}};
    enum orl_result result = ORL_OK;
    bool tests = false;
    for (size_t i = 0; result == ORL_OK && i < ORL_COUNT(files); i++) {
        json_t *root = NULL;
        const char *path = ORL_PATH(source->path, "%s", files[i].name);
        struct orl_known_source part = *source;
        part.path = path;
        enum orl_known_split split = files[i].split == ORL_KNOWN_UNUSED && !tests ? ORL_KNOWN_TEST
                                                                                  : files[i].split;
        if (orl_path_is_file(path)) {
            result = orl_json_read(source->log, path, &root);
            part.root = root;
            ORL_THEN(result, orl_known_set_shift(&part, 0.5));
            ORL_THEN(result, read_frames(&part, split, known));
            tests = tests || split == ORL_KNOWN_TEST;
        }
        json_decref(root);
    }
    return result;
}
