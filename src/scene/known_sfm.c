// Cameras in JSON of programs that calibrate: OpenSfM's reconstruction.json and Meshroom's cameras.sfm.
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "core/json.h"
#include "core/memory.h"
#include "core/text.h"
#include "scene/colmap_internal.h"
#include "scene/json_views.h"
#include "scene/known_internal.h"

static enum orl_result bad(const struct orl_known_source *source, const char *what, const char *name,
                           const char *why)
{
    return orl_fail(source->log, ORL_ERR_FORMAT, "%s: %s %.120s: %s", source->path, what, name, why);
}

// --- OpenSfM: lengths are in units of the picture's larger side, measured from its centre ---

static double term(const json_t *camera, const char *key)
{
    double value;
    return orl_known_json_number(camera, key, &value) ? value : 0;
}

static const char *read_opensfm_lens(const json_t *camera, struct orl_known_camera *out)
{
    const char *type = orl_json_text(camera, "projection_type");
    double side, f_c[4], single;
    bool opencv_fisheye = type && strcmp(type, "fisheye_opencv") == 0;
    bool fisheye = type && (opencv_fisheye || strcmp(type, "fisheye") == 0);
    static const char *const flat[] = {"perspective", "brown", "simple_radial", "radial", NULL};
    if (!fisheye && !(type && orl_text_is_one_of(type, flat)))
        return "its projection_type is none of perspective, brown, simple_radial, radial, fisheye and "
               "fisheye_opencv";
    out->width = orl_json_side(camera, "width");
    out->height = orl_json_side(camera, "height");
    side = out->width > out->height ? out->width : out->height;
    bool one = orl_known_json_number(camera, "focal", &single);
    f_c[0] = side * (one ? single : term(camera, "focal_x"));
    f_c[1] = side * (one ? single : term(camera, "focal_y"));
    f_c[2] = 0.5 * out->width + side * term(camera, "c_x");
    f_c[3] = 0.5 * out->height + side * term(camera, "c_y");
    const double terms[] = {term(camera, "k1"), term(camera, "k2"),
                            term(camera, fisheye ? "k3" : "p1"), term(camera, fisheye ? "k4" : "p2"),
                            term(camera, "k3")};
    size_t count = opencv_fisheye ? 4 : fisheye ? 2 : ORL_COUNT(terms);
    orl_known_set_lens(out, f_c, terms, count, fisheye);
    return NULL;
}

// Rodrigues' formula: a rotation by |v| about v.
static void rotation_about(const double v[3], double r[3][3])
{
    double angle = sqrt(v[0] * v[0] + v[1] * v[1] + v[2] * v[2]);
    double s = angle > 1e-12 ? sin(angle) / angle : 1;
    double c = angle > 1e-12 ? (1 - cos(angle)) / (angle * angle) : 0.5;
    const double cross[3][3] = {{0, -v[2], v[1]}, {v[2], 0, -v[0]}, {-v[1], v[0], 0}};
    for (int i = 0; i < 3; i++)
        for (int j = 0; j < 3; j++) {
            double square = 0;
            for (int k = 0; k < 3; k++)
                square += cross[i][k] * cross[k][j];
            r[i][j] = (i == j) + s * cross[i][j] + c * square;
        }
}

static enum orl_result read_shot(const struct orl_known_source *source, const json_t *cameras,
                                 const char *name, const json_t *shot,
                                 struct orl_known_cameras *known)
{
    struct orl_known_camera camera = {.path = name, .place = name};
    double axis[3];
    const char *lens = orl_json_text(shot, "camera");
    const json_t *found = lens ? json_object_get(cameras, lens) : NULL;
    if (!found)
        return bad(source, "shot", name, "its camera is not there");
    const char *problem = read_opensfm_lens(found, &camera);
    if (problem)
        return bad(source, "camera", lens, problem);
    if (!orl_json_read_numbers(json_object_get(shot, "rotation"), 3, axis) ||
        !orl_json_read_numbers(json_object_get(shot, "translation"), 3, camera.pose.t))
        return bad(source, "shot", name, "rotation or translation is not 3 numbers");
    rotation_about(axis, camera.pose.r);
    return orl_known_add(source, &camera, known);
}

static enum orl_result read_opensfm_points(const struct orl_known_source *source, json_t *points,
                                           struct orl_known_cameras *known)
{
    const char *id;
    json_t *entry;
    json_object_foreach(points, id, entry) {
        double at[3], rgb[3] = {128, 128, 128};
        if (!orl_json_read_numbers(json_object_get(entry, "coordinates"), 3, at))
            return bad(source, "point", id, "its coordinates are not 3 numbers");
        (void)orl_json_read_numbers(json_object_get(entry, "color"), 3, rgb);
        ORL_TRY(orl_known_add_point(source->log, at, rgb, &known->model));
    }
    return ORL_OK;
}

enum orl_result orl_known_read_opensfm(const struct orl_known_source *source,
                                       struct orl_known_cameras *known)
{
    static const char *const used[] = {
        "cameras", "shots", "points", "projection_type", "width", "height", "focal", "focal_x", "focal_y",
        "c_x", "c_y", "k1", "k2", "k3", "k4", "p1", "p2", "camera", "rotation", "translation", NULL};
    static const char *const lists[] = {"cameras", "shots", NULL};
    const json_t *all = source->root, *best = json_array_get(all, 0);
    for (size_t i = 1; i < json_array_size(all); i++) {
        const json_t *other = json_array_get(all, i);
        if (json_object_size(json_object_get(other, "shots")) >
            json_object_size(json_object_get(best, "shots")))
            best = other;
    }
    json_t *shots = json_object_get(best, "shots");
    if (json_array_size(all) > 1)
        orl_logf(source->log, ORL_LOG_WARNING, "%s: %zu reconstructions; taking the largest, with %zu "
                 "photographs", source->path, json_array_size(all), json_object_size(shots));
    const char *name;
    json_t *shot;
    json_object_foreach(shots, name, shot)
        ORL_TRY(read_shot(source, json_object_get(best, "cameras"), name, shot, known));
    orl_known_say_unused_of(source, best, used, lists);
    return read_opensfm_points(source, json_object_get(best, "points"), known);
}

// --- Meshroom ---

enum { ID_BYTES = 32 };

// An id, which some versions write as a number, for whose text there is room.
static const char *id_text(const json_t *entry, const char *key, char number[ID_BYTES])
{
    const json_t *id = json_object_get(entry, key);
    snprintf(number, ID_BYTES, "%lld", (long long)json_integer_value(id));
    return json_is_integer(id) ? number : json_is_string(id) ? json_string_value(id) : "";
}

// The entries of a list by their ids: a new reference, or NULL.
static json_t *index_by(const json_t *list, const char *key)
{
    json_t *index = json_object();
    for (size_t i = 0; index && i < json_array_size(list); i++) {
        json_t *entry = json_array_get(list, i);
        if (json_object_set(index, id_text(entry, key, (char[ID_BYTES]){""}), entry) != 0)
            json_decref(index), index = NULL;
    }
    return index;
}

// Sets f_c from the versions' different fields: a focal length in pixels up to 1.2.0, for x and y from
// 1.2.0, in millimetres of the sensor later. The principal point counts from the picture's corner before
// 1.2.1, and from its centre since.
static const char *read_meshroom_pinhole(const json_t *root, const json_t *lens,
                                         struct orl_known_camera *camera, double f_c[4])
{
    double version[3] = {0}, width, height, focal, sensor, ratio, centre[2];
    if (!orl_known_json_number(lens, "width", &width) || !orl_known_json_number(lens, "height", &height) ||
        width < 1 || height < 1 || width > ORL_IMAGE_MAX_SIDE || height > ORL_IMAGE_MAX_SIDE)
        return "its size is missing";
    camera->width = (int)width;
    camera->height = (int)height;
    (void)orl_known_json_numbers(json_object_get(root, "version"), 3, version);
    if (orl_known_json_numbers(json_object_get(lens, "pxFocalLength"), 2, f_c)) {
        // as it is
    } else if (orl_known_json_number(lens, "pxFocalLength", &f_c[0])) {
        f_c[1] = f_c[0];
    } else if (orl_known_json_number(lens, "focalLength", &focal) &&
               orl_known_json_number(lens, "sensorWidth", &sensor) && sensor > 0) {
        f_c[0] = focal / sensor * width;
        f_c[1] = orl_known_json_number(lens, "pixelRatio", &ratio) && ratio > 0 ? f_c[0] * ratio : f_c[0];
    } else {
        return "its focal length is missing";
    }
    bool of_centre = version[0] * 1e6 + version[1] * 1e3 + version[2] >= 1002001;
    bool told = orl_known_json_numbers(json_object_get(lens, "principalPoint"), 2, centre);
    f_c[2] = told ? centre[0] + (of_centre ? 0.5 * width : 0) : 0.5 * width;
    f_c[3] = told ? centre[1] + (of_centre ? 0.5 * height : 0) : 0.5 * height;
    return NULL;
}

static const char *read_meshroom_lens(const json_t *root, const json_t *lens,
                                      struct orl_known_camera *camera)
{
    static const struct {
        const char *type;
        size_t terms;
        int place[5]; // of each term among k1 k2 p1 p2 k3, or k1 k2 k3 k4 of a fisheye
        bool fisheye;
    } kinds[] = {{"pinhole", 0, {0}, false},        {"none", 0, {0}, false},
                 {"radial1", 1, {0}, false},        {"radialk1", 1, {0}, false},
                 {"radial3", 3, {0, 1, 4}, false},  {"radialk3", 3, {0, 1, 4}, false},
                 {"brown", 5, {0, 1, 4, 2, 3}, false},
                 {"fisheye", 4, {0, 1, 2, 3}, true}, {"fisheye4", 4, {0, 1, 2, 3}, true}};
    double f_c[4], given[5], terms[5] = {0};
    const char *type = orl_json_text(lens, "distortionType");
    const json_t *list = json_object_get(lens, "distortionParams");
    type = type ? type : orl_json_text(lens, "type");
    const char *problem = read_meshroom_pinhole(root, lens, camera, f_c);
    for (size_t i = 0; !problem && type && i < ORL_COUNT(kinds); i++) {
        if (strcmp(kinds[i].type, type) != 0)
            continue;
        size_t count = json_array_size(list) && kinds[i].terms ? kinds[i].terms : 0;
        if (!orl_known_json_numbers(list, count, given) && count)
            return "its distortionParams are not as many numbers as its type has";
        for (size_t k = 0; k < count; k++)
            terms[kinds[i].place[k]] = given[k];
        orl_known_set_lens(camera, f_c, terms, ORL_COUNT(terms), kinds[i].fisheye);
        return NULL;
    }
    return problem ? problem : "its type is none of pinhole, radial1, radial3, brown and fisheye4";
}

struct meshroom {
    const struct orl_known_source *source;
    json_t *lenses, *poses, *images; // by their ids; images: their indices in the model
    size_t without;                  // views that were not placed
};

static enum orl_result read_view(struct meshroom *m, const json_t *view,
                                 struct orl_known_cameras *known)
{
    double axes[3][3], centre[3];
    const struct orl_known_source *source = m->source;
    const char *id = id_text(view, "viewId", (char[ID_BYTES]){""});
    struct orl_known_camera camera = {.path = orl_json_text(view, "path"), .place = id};
    const char *pose_id = id_text(view, "poseId", (char[ID_BYTES]){""});
    const char *lens_id = id_text(view, "intrinsicId", (char[ID_BYTES]){""});
    const json_t *pose = json_object_get(m->poses, pose_id), *lens = json_object_get(m->lenses, lens_id);
    const json_t *transform = json_object_get(json_object_get(pose, "pose"), "transform");
    if (!pose || !lens) {
        m->without++;
        return ORL_OK;
    }
    const char *problem = read_meshroom_lens(source->root, lens, &camera);
    if (problem)
        return bad(source, "intrinsic", lens_id, problem);
    if (!camera.path)
        return bad(source, "view", id, "no path");
    if (json_object_get(view, "subPoseId"))
        return bad(source, "view", id, "rigs of cameras are not supported");
    // The rotation cam_from_world is written column by column: its rows are those of the inverse.
    if (!orl_known_json_numbers(json_object_get(transform, "rotation"), 9, &axes[0][0]) ||
        !orl_known_json_numbers(json_object_get(transform, "center"), 3, centre) ||
        !orl_pose_from_axes(axes, centre, &camera.pose))
        return bad(source, "pose", pose_id, "no rotation and center");
    ORL_TRY(orl_known_add(source, &camera, known));
    json_t *index = json_integer((json_int_t)known->model.image_count - 1);
    return json_object_set_new(m->images, id, index) == 0 ? ORL_OK : ORL_ERR_MEMORY;
}

static enum orl_result read_landmark(const struct meshroom *m, const json_t *landmark,
                                     struct orl_colmap_model *model)
{
    double at[3], rgb[3] = {128, 128, 128};
    const json_t *seen = json_object_get(landmark, "observations");
    size_t before = model->point_count;
    if (!orl_known_json_numbers(json_object_get(landmark, "X"), 3, at))
        return bad(m->source, "landmark", "", "no X of 3 numbers");
    (void)orl_known_json_numbers(json_object_get(landmark, "color"), 3, rgb);
    enum orl_result result = orl_known_add_point(m->source->log, at, rgb, model);
    for (size_t i = 0; result == ORL_OK && model->point_count > before && i < json_array_size(seen); i++) {
        const char *id = id_text(json_array_get(seen, i), "observationId", (char[ID_BYTES]){""});
        const json_t *image = json_object_get(m->images, id);
        if (image)
            result = orl_known_add_view(m->source->log, (size_t)json_integer_value(image),
                                        (uint32_t)before, model);
    }
    return result;
}

enum orl_result orl_known_read_meshroom(const struct orl_known_source *source,
                                        struct orl_known_cameras *known)
{
    static const char *const used[] = {
        "version", "views", "intrinsics", "poses", "structure", "viewId", "poseId", "intrinsicId",
        "subPoseId", "path", "width", "height", "pose", "type", "distortionType", "distortionParams",
        "pxFocalLength", "focalLength", "sensorWidth", "pixelRatio", "principalPoint", NULL};
    static const char *const lists[] = {"views", "intrinsics", "poses", NULL};
    const json_t *structure = json_object_get(source->root, "structure");
    const json_t *views = json_object_get(source->root, "views");
    struct meshroom m = {
        source, index_by(json_object_get(source->root, "intrinsics"), "intrinsicId"),
        index_by(json_object_get(source->root, "poses"), "poseId"), json_object(), 0};
    enum orl_result result = m.lenses && m.poses && m.images ? ORL_OK : ORL_ERR_MEMORY;
    for (size_t i = 0; result == ORL_OK && i < json_array_size(views); i++)
        result = read_view(&m, json_array_get(views, i), known);
    if (result == ORL_OK && m.without)
        orl_logf(source->log, ORL_LOG_WARNING, "%s: %zu of %zu photographs have no pose: left out",
                 source->path, m.without, json_array_size(views));
    if (result == ORL_OK)
        orl_known_say_unused_of(source, source->root, used, lists);
    for (size_t i = 0; result == ORL_OK && i < json_array_size(structure); i++)
        result = read_landmark(&m, json_array_get(structure, i), &known->model);
    json_decref(m.lenses);
    json_decref(m.poses);
    json_decref(m.images);
    return result;
}
