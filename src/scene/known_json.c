// Oriel's cameras.json, and other programs' cameras, which known_cameras.py converts to that form.
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "core/file.h"
#include "core/json.h"
#include "core/memory.h"
#include "core/process.h"
#include "core/text.h"
#include "scene/known_internal.h"
#include "scene/manifest.h"
#include "scene/text_lines.h"

enum { PLACE_SIZE = 160 };

// COLMAP's ids of the camera models that are made.
enum { PINHOLE = 1, OPENCV = 4, OPENCV_FISHEYE = 5, FULL_OPENCV = 6, THIN_PRISM_FISHEYE = 10 };

struct source {
    const struct orl_log *log;
    const char *path; // for messages
    double shift;     // added to the file's pixel coordinates, gives COLMAP's
    bool converted;   // by the script: cameras may have keys that Oriel's own form lacks
};

static enum orl_result bad(const struct source *source, const char *place, const char *what)
{
    return orl_known_bad(source->log, source->path, place, what);
}

// --- cameras ---

// Takes K and OpenCV's distortion, k1 k2 p1 p2 k3 k4 k5 k6 or of a fisheye k1 k2 k3 k4, as the simplest model; or
// that of a thin prism, k1 k2 p1 p2 k3 k4.
static enum orl_result read_lens(const struct source *source, const json_t *item, struct orl_known_camera *camera)
{
    double k[3][3], d[8] = {0};
    const json_t *distortion = json_object_get(item, "dist");
    size_t terms = json_array_size(distortion);
    if (!orl_json_rows(json_object_get(item, "K"), 3, 3, &k[0][0]))
        return bad(source, camera->place, "\"K\" is not 3 rows of 3 numbers");
    if (distortion && (terms > ORL_COUNT(d) || !orl_json_read_numbers(distortion, terms, d)))
        return bad(source, camera->place, "\"dist\" is not up to 8 numbers, k1 k2 p1 p2 k3 k4 k5 k6");
    // Only cameras without skew are supported: it may shift a pixel by at most half a pixel
    // within the picture's half height.
    if (!(fabs(k[0][1]) * camera->height <= fabs(k[1][1])))
        return bad(source, camera->place, "\"K\" has a skew, which is not supported");
    bool full = false, any = false;
    for (size_t i = 0; i < terms; i++) {
        any = any || d[i] != 0;
        full = full || (i >= 4 && d[i] != 0);
    }
    bool fisheye = source->converted && json_is_true(json_object_get(item, "fisheye"));
    bool prism = source->converted && json_is_true(json_object_get(item, "thin_prism"));
    camera->model = prism ? THIN_PRISM_FISHEYE : fisheye ? OPENCV_FISHEYE : full ? FULL_OPENCV : any ? OPENCV : PINHOLE;
    const double f_c[4] = {k[0][0], k[1][1], k[0][2] + source->shift, k[1][2] + source->shift};
    memcpy(camera->params, f_c, sizeof f_c);
    memcpy(camera->params + ORL_COUNT(f_c), d, sizeof d);
    return ORL_OK;
}

static enum orl_result read_camera(const struct source *source, const json_t *item,
                                   struct orl_known_camera *camera)
{
    camera->width = orl_json_side(item, "width");
    camera->height = orl_json_side(item, "height");
    ORL_TRY(read_lens(source, item, camera));
    if (!orl_json_rows(json_object_get(item, "R"), 3, 3, &camera->pose.r[0][0]))
        return bad(source, camera->place, "\"R\" is not 3 rows of 3 numbers");
    if (!orl_json_read_numbers(json_object_get(item, "t"), 3, camera->pose.t))
        return bad(source, camera->place, "\"t\" is not 3 numbers");
    return ORL_OK;
}

static enum orl_result add_own(const struct source *source, size_t index, const json_t *item,
                               struct orl_known_cameras *known)
{
    const char *name = orl_json_text(item, "name");
    char place[PLACE_SIZE]; // "camera 3 (0003.jpg)"
    snprintf(place, sizeof place, "camera %zu%s%.120s%s", index, name ? " (" : "", name ? name : "", name ? ")" : "");
    struct orl_known_camera camera = {.path = name, .place = place};
    if (!name)
        return orl_fail(source->log, ORL_ERR_FORMAT, "%s: %s has no \"name\"", source->path, place);
    ORL_TRY(read_camera(source, item, &camera));
    return orl_known_add(source->log, source->path, &camera, known);
}

// --- Oriel's own file ---

// Names, in one line, the keys of the file and its cameras that are not used.
static void say_unused(const struct source *source, const json_t *root)
{
    enum { MOST = 20 };
    static const char *const used[] = {"pixel_centre", "room", "cameras", "name", "width", "height",
                                       "K", "R", "t", "dist", NULL};
    const json_t *list = json_object_get(root, "cameras");
    struct orl_names names = {0};
    enum orl_result result = ORL_OK; // without memory the line is shorter, no more
    for (size_t i = 0; i <= json_array_size(list); i++) {
        const char *key;
        json_t *value, *object = i ? json_array_get(list, i - 1) : (json_t *)root;
        json_object_foreach(object, key, value)
            if (names.count < MOST && !orl_text_is_one_of(key, used) && !orl_names_contain(&names, key))
                ORL_THEN(result, orl_names_add(NULL, &names, key));
    }
    char text[512] = "";
    size_t at = 0;
    orl_names_sort(&names);
    for (size_t i = 0; i < names.count && at < sizeof text; i++)
        at += (size_t)snprintf(text + at, sizeof text - at, "%s%.64s", i ? ", " : "", names.items[i]);
    if (names.count)
        orl_logf(source->log, ORL_LOG_INFO, "%s: not used: %s", source->path, text);
    orl_names_finish(&names);
}

bool orl_known_is_own(const json_t *root)
{
    return json_is_array(json_object_get(root, "cameras"));
}

enum orl_result orl_known_read_own(const struct orl_log *log, const char *path, double pixel_centre,
                                   const json_t *root, struct orl_known_cameras *known)
{
    const json_t *list = json_object_get(root, "cameras");
    // OpenCV's pixel centres are whole numbers.
    double centre = pixel_centre >= 0 ? pixel_centre : orl_json_value(root, "pixel_centre");
    const struct source source = {log, path, 0.5 - centre, false};
    if (!(centre >= 0 && centre <= 0.5))
        return orl_fail(log, ORL_ERR_FORMAT, "%s: \"pixel_centre\" is not from 0 to 0.5", path);
    for (size_t i = 0; i < json_array_size(list); i++)
        ORL_TRY(add_own(&source, i, json_array_get(list, i), known));
    ORL_TRY(orl_manifest_read_room(log, path, root, &known->room));
    say_unused(&source, root);
    orl_known_say_read(log, path, "Oriel's cameras.json", known);
    return ORL_OK;
}

// --- converted files ---

// A text of the script's, which writes a byte as one character, since names of files need not be UTF-8.
static const char *bytes_of(const json_t *entry, const char *key, char bytes[ORL_PATH_SIZE])
{
    const char *at = orl_json_text(entry, key);
    size_t length = 0;
    if (!at)
        return NULL;
    for (; *at && length < ORL_PATH_SIZE - 1; at++) {
        bytes[length] = *at;
        if ((*at & 0xe0) == 0xc0) { // the first of a character's two bytes
            bytes[length] = (char)((*at & 3) << 6 | (at[1] & 0x3f));
            at++;
        }
        length++;
    }
    bytes[length] = '\0';
    return bytes;
}

// Logs the script's messages. Fails as it says.
static enum orl_result say(const struct orl_log *log, const json_t *root)
{
    const json_t *list = json_object_get(root, "said"), *error = json_object_get(root, "error");
    char text[ORL_PATH_SIZE] = "";
    for (size_t i = 0; i < json_array_size(list); i++) {
        const json_t *entry = json_array_get(list, i);
        bool warns = json_is_true(json_object_get(entry, "warns"));
        orl_logf(log, warns ? ORL_LOG_WARNING : ORL_LOG_INFO, "%s", bytes_of(entry, "text", text));
    }
    if (!error)
        return ORL_OK;
    const char *name = orl_json_text(error, "result");
    int result = 0;
    while (result < ORL_RESULT_COUNT && strcmp(orl_result_name(result), name) != 0)
        result++;
    return orl_fail(log, result, "%s", bytes_of(error, "text", text));
}

static enum orl_result add_converted(const struct source *source, const json_t *item,
                                     struct orl_known_cameras *known)
{
    char path[ORL_PATH_SIZE], mask[ORL_PATH_SIZE], place[ORL_PATH_SIZE];
    const char *split = orl_json_text(item, "split");
    struct orl_known_camera camera = {
        .path = bytes_of(item, "name", path), .mask = bytes_of(item, "mask", mask),
        .place = bytes_of(item, "place", place),
        .split = !split || strcmp(split, "train") == 0 ? ORL_KNOWN_TRAIN
                 : strcmp(split, "test") == 0          ? ORL_KNOWN_TEST
                                                       : ORL_KNOWN_UNUSED,
        .gap = {.size = json_is_true(json_object_get(item, "no_size")),
                .centre = json_is_true(json_object_get(item, "no_centre")),
                .side = orl_json_value(item, "side"), .fov_x_rad = orl_json_value(item, "fov_x")}};
    known->splits = known->splits || camera.split != ORL_KNOWN_TRAIN;
    ORL_TRY(read_camera(source, item, &camera));
    return orl_known_add(source->log, source->path, &camera, known);
}

// Appends a point, unless it is not finite or absurdly far.
static enum orl_result add_point(const struct orl_log *log, const double position[3], const double rgb[3],
                                 struct orl_colmap_model *model)
{
    struct orl_colmap_point point = {.id = model->point_count + 1};
    for (int k = 0; k < 3; k++) {
        if (!(fabs(position[k]) <= ORL_WORLD_MAX) || model->point_count == UINT32_MAX)
            return ORL_OK;
        point.position[k] = position[k];
        point.rgb[k] = (uint8_t)(rgb[k] >= 255 ? 255 : rgb[k] > 0 ? rgb[k] : 0);
    }
    ORL_TRY(ORL_GROW(log, model->points, model->point_capacity, model->point_count));
    model->points[model->point_count++] = point;
    return ORL_OK;
}

// Notes that an image sees a point.
static enum orl_result add_view(const struct orl_log *log, size_t image, uint32_t point,
                                struct orl_colmap_model *model)
{
    struct orl_colmap_image *seen_by = &model->images[image];
    ORL_TRY(ORL_GROW(log, seen_by->points, seen_by->point_capacity, seen_by->point_count));
    seen_by->points[seen_by->point_count++] = point;
    model->points[point].track_length++;
    return ORL_OK;
}

// Reads lines x y z r g b and the indices of the cameras that see the point.
static enum orl_result read_points(const struct orl_log *log, const char *path,
                                   struct orl_colmap_model *model)
{
    struct orl_text_lines l;
    enum orl_result result = orl_text_open(log, path, &l);
    while (result == ORL_OK && orl_text_next(&l)) {
        double at_rgb[6];
        uint64_t image;
        size_t before = model->point_count;
        result = orl_text_numbers(&l, at_rgb, 6) ? add_point(log, at_rgb, at_rgb + 3, model)
                                                 : orl_text_bad(&l, "not a point");
        while (result == ORL_OK && model->point_count > before && orl_text_id(&l, model->image_count - 1, &image))
            result = add_view(log, (size_t)image, (uint32_t)before, model);
    }
    orl_text_close(&l);
    return result;
}

// Reads what the script wrote into `dir` of the cameras at `path`.
static enum orl_result take(const struct orl_log *log, const char *path, const char *dir, const json_t *root,
                            struct orl_known_cameras *known)
{
    char file[ORL_PATH_SIZE], found[ORL_PATH_SIZE], stated[ORL_PATH_SIZE];
    const json_t *list = json_object_get(root, "cameras");
    const char *points = ORL_PATH(dir, "points.txt");
    ORL_TRY(say(log, root));
    const struct source source = {log, bytes_of(root, "path", file), 0, true};
    orl_known_set_folder(path, bytes_of(root, "found", found), known);
    for (size_t i = 0; i < json_array_size(list); i++)
        ORL_TRY(add_converted(&source, json_array_get(list, i), known));
    if (orl_path_is_file(points))
        ORL_TRY(read_points(log, points, &known->model));
    if (bytes_of(root, "points_file", stated) && !orl_known_find(known->folder, stated, known->points_file))
        orl_path_print(known->points_file, "", "%s", stated);
    orl_known_say_read(log, file, orl_json_text(root, "format"), known);
    return ORL_OK;
}

static enum orl_result run_script(const struct orl_log *log, const char *dir, const char *path, double pixel_centre,
                                  json_t **root)
{
    const char *script = ORL_PATH(dir, "known_cameras.py"), *made = ORL_PATH(dir, "cameras.json");
    char centre[32];
    snprintf(centre, sizeof centre, "%.17g", pixel_centre);
    // Isolated from the user's modules, with UTF-8 whatever the locale.
    const char *const argv[] = {"python3", "-I", "-S", "-X", "utf8", script, path, centre, dir, NULL};
    const struct orl_process_params params = {.argv = argv};
    ORL_TRY(orl_file_write(log, script, orl_known_script, strlen(orl_known_script)));
    ORL_TRY(orl_process_run(log, &params, NULL));
    return orl_json_load(log, made, ORL_KNOWN_FILE_MAX, root);
}

enum orl_result orl_known_read_converted(const struct orl_log *log, const char *path, double pixel_centre,
                                         struct orl_known_cameras *known)
{
    char *dir = NULL;
    json_t *root = NULL;
    ORL_TRY(orl_dir_make_temporary(log, "cameras", &dir));
    enum orl_result result = run_script(log, dir, path, pixel_centre, &root);
    ORL_THEN(result, take(log, path, dir, root, known));
    if (orl_dir_remove(log, dir) != ORL_OK)
        orl_logf(log, ORL_LOG_WARNING, "%s is left over", dir);
    json_decref(root);
    free(dir);
    return result;
}
