// Cameras in JSON: Oriel's cameras.json, Inria's, and nerfstudio's transforms.json.
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "core/file.h"
#include "core/json.h"
#include "scene/json_views.h"
#include "scene/known_internal.h"
#include "scene/manifest.h"

// The entry being read.
struct entry {
    const struct orl_log *log;
    const char *file;
    char place[160]; // "camera 3 (0003.jpg)"
    double shift;    // added to the file's pixel coordinates, gives COLMAP's
};

static enum orl_result bad(const struct entry *e, const char *what)
{
    return orl_fail(e->log, ORL_ERR_FORMAT, "%s: %s: %s", e->file, e->place, what);
}

static void set_place(struct entry *e, size_t index, const char *name)
{
    snprintf(e->place, sizeof e->place, "camera %zu%s%.120s%s", index, name ? " (" : "",
             name ? name : "", name ? ")" : "");
}

// --- cameras.json ---

static enum orl_result read_own(const struct entry *e, const json_t *item,
                                struct orl_known_camera *camera)
{
    double k[3][3], dist[8];
    const json_t *distortion = json_object_get(item, "dist");
    size_t terms = json_array_size(distortion);
    if (!orl_json_rows(json_object_get(item, "K"), 3, 3, &k[0][0]))
        return bad(e, "\"K\" is not 3 rows of 3 numbers");
    if (!orl_json_rows(json_object_get(item, "R"), 3, 3, &camera->pose.r[0][0]))
        return bad(e, "\"R\" is not 3 rows of 3 numbers");
    if (!orl_json_read_numbers(json_object_get(item, "t"), 3, camera->pose.t))
        return bad(e, "\"t\" is not 3 numbers");
    if (distortion && (terms > ORL_COUNT(dist) || !orl_json_read_numbers(distortion, terms, dist)))
        return bad(e, "\"dist\" is not up to 8 numbers, k1 k2 p1 p2 k3 k4 k5 k6");
    camera->width = orl_json_side(item, "width");
    camera->height = orl_json_side(item, "height");
    // Only cameras without skew are supported: it may shift a pixel by at most half a pixel
    // within the picture's half height.
    if (!(fabs(k[0][1]) * camera->height <= fabs(k[1][1])))
        return bad(e, "\"K\" has a skew, which is not supported");
    const double f_c[4] = {k[0][0], k[1][1], k[0][2] + e->shift, k[1][2] + e->shift};
    orl_known_set_opencv(camera, f_c, dist, terms);
    return ORL_OK;
}

// --- Inria's ---

static enum orl_result read_inria(const struct entry *e, const json_t *item,
                                  struct orl_known_camera *camera)
{
    struct orl_view view;
    if (!orl_json_inria_view(item, &view) || orl_view_problem(&view))
        return bad(e, "position, rotation, width, height, fx or fy is missing or not usable");
    const struct orl_camera *c = &view.camera;
    const double f_c[4] = {c->fx, c->fy, c->cx, c->cy};
    orl_known_set_opencv(camera, f_c, NULL, 0);
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

static enum orl_result read_nerfstudio(const struct entry *e, const json_t *root,
                                       const json_t *frame, struct orl_known_camera *camera)
{
    static const char *const brown[] = {"k1", "k2", "p1", "p2", "k3"};
    static const char *const fisheye[] = {"k1", "k2", "k3", "k4"};
    double rows[16], f_c[4], terms[5] = {0}, width = 0, height = 0;
    if (!orl_json_rows(json_object_get(frame, "transform_matrix"), 4, 4, rows) ||
        !orl_pose_from_opengl(rows, &camera->pose))
        return bad(e, "\"transform_matrix\" is not 4 rows of 4 numbers with a rotation");
    const char *model = camera_model(root, frame);
    bool is_fisheye = strcmp(model, "OPENCV_FISHEYE") == 0;
    if (!is_fisheye && strcmp(model, "OPENCV") != 0 && strcmp(model, "PINHOLE") != 0 &&
        strcmp(model, "SIMPLE_PINHOLE") != 0 && strcmp(model, "perspective") != 0)
        return bad(e, "its camera_model is neither OPENCV, PINHOLE nor OPENCV_FISHEYE");
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
        return bad(e, "neither fl_x nor camera_angle_x");
    }
    camera->gap.centre =
        !number(root, frame, "cx", &f_c[2]) || !number(root, frame, "cy", &f_c[3]);
    for (int i = 2; i < 4; i++)
        f_c[i] = camera->gap.centre ? 0 : f_c[i] + e->shift;
    for (size_t i = 0; is_fisheye ? i < ORL_COUNT(fisheye) : i < ORL_COUNT(brown); i++)
        if (!number(root, frame, is_fisheye ? fisheye[i] : brown[i], &terms[i]))
            terms[i] = 0;
    orl_known_set_opencv(camera, f_c, terms, is_fisheye ? 0 : ORL_COUNT(brown));
    if (is_fisheye) {
        camera->model = ORL_COLMAP_OPENCV_FISHEYE;
        memcpy(camera->params + 4, terms, ORL_COUNT(fisheye) * sizeof *terms);
    }
    return ORL_OK;
}

// --- the file ---

enum schema { OWN, INRIA, NERFSTUDIO };
static const struct {
    const char *name_key;
    double pixel_centre; // the format's convention
} schemas[] = {[OWN] = {"name", 0}, [INRIA] = {"img_name", 0.5}, [NERFSTUDIO] = {"file_path", 0.5}};

static enum orl_result read_items(struct entry *e, enum schema schema, const json_t *root,
                                  const json_t *list, struct orl_known_cameras *known)
{
    enum orl_result result = ORL_OK;
    for (size_t i = 0; result == ORL_OK && i < json_array_size(list); i++) {
        const json_t *item = json_array_get(list, i);
        struct orl_known_camera camera = {
            .path = json_string_value(json_object_get(item, schemas[schema].name_key))};
        set_place(e, i, camera.path);
        if (!camera.path)
            return orl_fail(e->log, ORL_ERR_FORMAT, "%s: %s has no \"%s\"", e->file, e->place,
                            schemas[schema].name_key);
        result = schema == OWN     ? read_own(e, item, &camera)
                 : schema == INRIA ? read_inria(e, item, &camera)
                                   : read_nerfstudio(e, root, item, &camera);
        if (result == ORL_OK)
            result = orl_known_add(e->log, e->file, e->place, &camera, known);
    }
    return result;
}

enum orl_result orl_known_read_json(const struct orl_log *log, const char *path,
                                    double pixel_centre, struct orl_known_cameras *known)
{
    struct entry e = {.log = log, .file = path};
    uint8_t *data = NULL;
    size_t size;
    enum orl_result result = orl_file_read(log, path, ORL_KNOWN_FILE_MAX, &data, &size);
    if (result != ORL_OK)
        return result;
    json_t *root;
    result = orl_json_parse(log, path, data, size, &root);
    free(data);
    if (result != ORL_OK)
        return result;
    const json_t *own = json_object_get(root, "cameras"), *frames = json_object_get(root, "frames");
    const json_t *told = json_object_get(root, "pixel_centre");
    enum schema schema = json_is_array(root) ? INRIA : frames ? NERFSTUDIO : OWN;
    const json_t *list = json_is_array(root) ? root : frames ? frames : own;
    double centre = pixel_centre >= 0   ? pixel_centre
                    : json_is_number(told) ? json_number_value(told)
                                           : schemas[schema].pixel_centre;
    e.shift = 0.5 - centre;
    if (!json_is_array(list))
        result = orl_fail(log, ORL_ERR_FORMAT, "%s: neither cameras.json (\"cameras\"), nor "
                          "Inria's (an array), nor nerfstudio's (\"frames\")", path);
    else if (!(centre >= 0 && centre <= 0.5))
        result = orl_fail(log, ORL_ERR_FORMAT, "%s: \"pixel_centre\" is not from 0 to 0.5", path);
    else
        result = read_items(&e, schema, root, list, known);
    if (result == ORL_OK)
        result = orl_manifest_read_room(log, path, root, &known->room);
    json_decref(root);
    return result;
}
