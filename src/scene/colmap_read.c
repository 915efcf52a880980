// COLMAP's models (src/base/reconstruction.cc) in both of their forms, which have the same values in one
// order. In binary files, little-endian and packed, counts go ahead of records; in text files a record
// is a line, and '#' starts a comment line.
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "core/file.h"
#include "core/memory.h"
#include "scene/colmap_internal.h"
#include "scene/text_lines.h"

// Smallest possible sizes of binary records in bytes, to check counts against the file's size. A panorama's
// camera has two parameters.
enum { CAMERA_MIN = 40, IMAGE_MIN = 73, POINT_MIN = 51, POINT2D_SIZE = 24, TRACK_SIZE = 8 };

struct reader {
    const struct orl_log *log;
    const char *path;
    bool is_text;
    struct orl_text_lines l; // of a text file
    // Of a binary one: its bytes, the next of them, and how many records are still to come.
    uint8_t *data; // owned
    size_t size, at;
    uint64_t left;
};

static enum orl_result bad(const struct reader *r, const char *what)
{
    return r->is_text ? orl_text_bad(&r->l, what)
                      : orl_fail(r->log, ORL_ERR_FORMAT, "%s: byte %zu: %s", r->path, r->at, what);
}

// --- values: false where one is missing ---

static bool take(struct reader *r, void *out, size_t size)
{
    if (size > r->size - r->at)
        return false;
    memcpy(out, r->data + r->at, size);
    r->at += size;
    return true;
}

// `size`: bytes of the number in a binary file.
static bool take_whole(struct reader *r, size_t size, uint64_t *value)
{
    *value = 0;
    return r->is_text ? orl_text_id(&r->l, size < sizeof *value ? UINT32_MAX : UINT64_MAX, value)
                      : take(r, value, size);
}

static bool take_id(struct reader *r, uint32_t *id)
{
    uint64_t value;
    bool there = take_whole(r, sizeof *id, &value);
    *id = (uint32_t)value;
    return there;
}

static bool take_numbers(struct reader *r, double *values, size_t count)
{
    return r->is_text ? orl_text_numbers(&r->l, values, count) : take(r, values, count * sizeof *values);
}

static bool take_color(struct reader *r, uint8_t rgb[3])
{
    double values[3];
    if (!r->is_text)
        return take(r, rgb, 3);
    bool there = take_numbers(r, values, 3);
    for (int i = 0; there && i < 3; i++)
        rgb[i] = (uint8_t)(values[i] >= 0 && values[i] <= 255 ? values[i] : 0);
    return there;
}

// --- records ---

// Of a binary file: a count of records, each of which takes at least `record_min` bytes.
static enum orl_result take_count(struct reader *r, size_t record_min, const char *what, uint64_t *count)
{
    if (!take(r, count, sizeof *count))
        return bad(r, "the file ends ahead of a count");
    if (*count > (r->size - r->at) / record_min) {
        r->at -= sizeof *count;
        return orl_fail(r->log, ORL_ERR_FORMAT,
                        "%s: byte %zu: the header claims %llu %s, but only %zu bytes follow", r->path,
                        r->at, (unsigned long long)*count, what, r->size - r->at - sizeof *count);
    }
    return ORL_OK;
}

static enum orl_result begin(struct reader *r, size_t record_min, const char *what)
{
    return r->is_text ? ORL_OK : take_count(r, record_min, what, &r->left);
}

static bool next(struct reader *r)
{
    return r->is_text ? orl_text_next(&r->l) : r->left && r->left--;
}

// --- cameras ---

enum { EQUIRECTANGULAR = 17 }; // COLMAP's id of the model of panoramas

static enum orl_result read_camera_model(struct reader *r, struct orl_colmap_camera *camera)
{
    char name[64] = "", what[192];
    uint32_t number;
    if (r->is_text) {
        r->l.at += strspn(r->l.at, " \t");
        size_t length = strcspn(r->l.at, " \t");
        if (length < sizeof name)
            memcpy(name, r->l.at, length);
        r->l.at += length;
        camera->model = orl_colmap_model_id(name);
    } else {
        if (!take_id(r, &number))
            return bad(r, "a camera's model is missing");
        camera->model = (int32_t)number;
        snprintf(name, sizeof name, "%d", camera->model);
    }
    camera->param_count = orl_colmap_model_lens(camera->model).params;
    if (camera->param_count)
        return ORL_OK;
    snprintf(what, sizeof what, "unknown camera model %s; %s", name,
             camera->model == EQUIRECTANGULAR || strcmp(name, "EQUIRECTANGULAR") == 0
                 ? "panoramas are not read: cut flat views out of them"
                 : "undistort the pictures with the program that made it");
    return bad(r, what);
}

static enum orl_result read_camera(struct reader *r, struct orl_colmap_camera *camera)
{
    uint64_t width, height;
    if (!take_id(r, &camera->id))
        return bad(r, "a camera's id is missing");
    ORL_TRY(read_camera_model(r, camera));
    if (!take_whole(r, 8, &width) || !take_whole(r, 8, &height) ||
        !take_numbers(r, camera->params, (size_t)camera->param_count))
        return bad(r, "a camera's size or parameters are missing");
    const char *problem = orl_colmap_camera_set(camera, width, height);
    return problem ? bad(r, problem) : ORL_OK;
}

static enum orl_result read_cameras(struct reader *r, struct orl_colmap_model *model)
{
    ORL_TRY(begin(r, CAMERA_MIN, "cameras"));
    while (next(r)) {
        ORL_TRY(ORL_GROW(r->log, model->cameras, model->camera_capacity, model->camera_count));
        struct orl_colmap_camera *camera = &model->cameras[model->camera_count++];
        memset(camera, 0, sizeof *camera);
        ORL_TRY(read_camera(r, camera));
    }
    return ORL_OK;
}

// --- points ---

static int compare_points(const void *a, const void *b)
{
    uint64_t x = ((const struct orl_colmap_point *)a)->id;
    uint64_t y = ((const struct orl_colmap_point *)b)->id;
    return (x > y) - (x < y);
}

// Index of the point of this id; -1 when it was dropped or is missing.
static int64_t point_index(const struct orl_colmap_model *model, uint64_t id)
{
    struct orl_colmap_point key = {.id = id};
    const struct orl_colmap_point *found =
        model->point_count ? bsearch(&key, model->points, model->point_count,
                                     sizeof *model->points, compare_points)
                           : NULL;
    return found ? found - model->points : -1;
}

// Drops points that are not finite and sorts by id.
static enum orl_result clean_points(const struct orl_log *log, const char *path,
                                    struct orl_colmap_model *model)
{
    size_t kept = 0;
    for (size_t i = 0; i < model->point_count; i++) {
        const double *p = model->points[i].position;
        if (fabs(p[0]) <= ORL_WORLD_MAX && fabs(p[1]) <= ORL_WORLD_MAX &&
            fabs(p[2]) <= ORL_WORLD_MAX)
            model->points[kept++] = model->points[i];
    }
    if (kept < model->point_count)
        orl_logf(log, ORL_LOG_WARNING, "%s: %zu of %zu points are not finite or absurdly far: "
                 "dropped", path,
                 model->point_count - kept, model->point_count);
    model->point_count = kept;
    if (kept)
        qsort(model->points, kept, sizeof *model->points, compare_points);
    for (size_t i = 1; i < kept; i++)
        if (model->points[i].id == model->points[i - 1].id)
            return orl_fail(log, ORL_ERR_FORMAT, "%s: two points have the id %llu", path,
                            (unsigned long long)model->points[i].id);
    return ORL_OK;
}

// Of the photographs that see a point, only their number counts.
static enum orl_result read_track(struct reader *r, struct orl_colmap_point *point)
{
    uint64_t count = 0;
    double pair[2];
    if (r->is_text) {
        while (orl_text_numbers(&r->l, pair, 2))
            count++;
    } else {
        ORL_TRY(take_count(r, TRACK_SIZE, "track elements", &count));
        r->at += (size_t)count * TRACK_SIZE;
    }
    point->track_length = count > UINT32_MAX ? UINT32_MAX : (uint32_t)count;
    return r->is_text && *r->l.at ? bad(r, "not a number") : ORL_OK;
}

static enum orl_result read_points(struct reader *r, struct orl_colmap_model *model)
{
    ORL_TRY(begin(r, POINT_MIN, "points"));
    while (next(r)) {
        if (model->point_count == UINT32_MAX)
            return bad(r, "more than 2^32 points");
        ORL_TRY(ORL_GROW(r->log, model->points, model->point_capacity, model->point_count));
        struct orl_colmap_point *point = &model->points[model->point_count++];
        memset(point, 0, sizeof *point);
        if (!take_whole(r, 8, &point->id) || !take_numbers(r, point->position, 3) ||
            !take_color(r, point->rgb) || !take_numbers(r, &point->error_px, 1))
            return bad(r, "a point needs id, x y z, r g b and error");
        ORL_TRY(read_track(r, point));
    }
    return clean_points(r->log, r->path, model);
}

// --- pictures ---

static enum orl_result read_name(struct reader *r, char **name)
{
    const char *text = r->is_text ? r->l.at + strspn(r->l.at, " \t") : (const char *)r->data + r->at;
    size_t end = r->at + strlen(text); // a zero byte follows the data
    if (!r->is_text && end == r->size)
        return bad(r, "a picture's name does not end");
    const char *problem = orl_colmap_name_problem(text);
    if (problem)
        return bad(r, problem);
    *name = orl_strdup(r->log, text);
    r->at = end + 1;
    return *name ? ORL_OK : ORL_ERR_MEMORY;
}

// An observation is x, y and a point's id, which is all ones, or -1, of no point.
static enum orl_result read_observations(struct reader *r, const struct orl_colmap_model *model,
                                         struct orl_colmap_image *image)
{
    uint64_t count = 0, id = UINT64_MAX;
    double xy[2], number;
    if (!r->is_text)
        ORL_TRY(take_count(r, POINT2D_SIZE, "observations", &count));
    while (r->is_text ? take_numbers(r, xy, 2) : count-- > 0) {
        if (!r->is_text) {
            memcpy(&id, r->data + r->at + sizeof xy, sizeof id);
            r->at += POINT2D_SIZE;
        } else if (!take_numbers(r, &number, 1)) {
            return bad(r, "an observation needs x, y and a point's id");
        } else { // false for NaN, too
            id = number >= 0 && number <= 9e15 ? (uint64_t)number : UINT64_MAX;
        }
        int64_t index = id == UINT64_MAX ? -1 : point_index(model, id);
        if (index < 0)
            continue;
        ORL_TRY(ORL_GROW(r->log, image->points, image->point_capacity, image->point_count));
        image->points[image->point_count++] = (uint32_t)index;
    }
    return r->is_text && *r->l.at ? bad(r, "not a number") : ORL_OK;
}

// True when a line is that of a picture rather than of observations, which are numbers by threes.
static bool is_picture(const struct orl_text_lines *at)
{
    struct orl_text_lines l = *at;
    uint64_t id;
    double numbers[7];
    size_t count = 0;
    if (!orl_text_id(&l, UINT32_MAX, &id) || !orl_text_numbers(&l, numbers, 7) ||
        !orl_text_id(&l, UINT32_MAX, &id) || !*(l.at += strspn(l.at, " \t")))
        return false;
    for (l = *at; orl_text_number(&l, numbers); count++)
        ;
    return *l.at || count % 3 != 0;
}

static enum orl_result read_image(struct reader *r, const struct orl_colmap_model *model,
                                  struct orl_colmap_image *image)
{
    double quat[4], t[3];
    if (!take_id(r, &image->id) || !take_numbers(r, quat, 4) || !take_numbers(r, t, 3) ||
        !take_id(r, &image->camera_id))
        return bad(r, "a picture needs id, qw qx qy qz, tx ty tz, camera and name");
    if (!orl_pose_from_quat(quat, t, &image->cam_from_world))
        return bad(r, "a picture's pose is zero, not finite or absurdly far");
    ORL_TRY(read_name(r, &image->name));
    // Some programs write no lines of observations.
    if (r->is_text && !orl_text_next_raw(&r->l))
        return ORL_OK;
    if (r->is_text && is_picture(&r->l)) {
        orl_text_back(&r->l);
        return ORL_OK;
    }
    return read_observations(r, model, image);
}

static enum orl_result read_images(struct reader *r, struct orl_colmap_model *model)
{
    ORL_TRY(begin(r, IMAGE_MIN, "pictures"));
    while (next(r)) {
        ORL_TRY(ORL_GROW(r->log, model->images, model->image_capacity, model->image_count));
        struct orl_colmap_image *image = &model->images[model->image_count++];
        memset(image, 0, sizeof *image);
        ORL_TRY(read_image(r, model, image));
    }
    return ORL_OK;
}

// --- files ---

static enum orl_result read_file(const struct orl_log *log, const char *path, bool is_text,
                                 enum orl_result (*read)(struct reader *r, struct orl_colmap_model *model),
                                 struct orl_colmap_model *model)
{
    struct reader r = {.log = log, .path = path, .is_text = is_text};
    enum orl_result result = is_text ? orl_text_open(log, path, &r.l)
                                     : orl_file_read(log, path, SIZE_MAX / 2, &r.data, &r.size);
    ORL_THEN(result, read(&r, model));
    if (result == ORL_OK && !is_text && r.at != r.size)
        result = bad(&r, "bytes after the end of the model");
    orl_text_close(&r.l);
    free(r.data);
    return result;
}

// Points before images, since images refer to points. A model without the file of points has none.
static enum orl_result read_model(const struct orl_log *log, const char *dir, bool is_text,
                                  struct orl_colmap_model *model)
{
    const char *ending = is_text ? "txt" : "bin", *points = ORL_PATH(dir, "points3D.%s", ending);
    ORL_TRY(read_file(log, ORL_PATH(dir, "cameras.%s", ending), is_text, read_cameras, model));
    if (orl_path_is_file(points))
        ORL_TRY(read_file(log, points, is_text, read_points, model));
    return read_file(log, ORL_PATH(dir, "images.%s", ending), is_text, read_images, model);
}

bool orl_colmap_has(const char *dir, const char *name)
{
    return orl_path_is_file(ORL_PATH(dir, "%s", name));
}

enum orl_result orl_colmap_read(const struct orl_log *log, const char *dir,
                                struct orl_colmap_model *model)
{
    memset(model, 0, sizeof *model);
    bool binary = orl_colmap_has(dir, "cameras.bin");
    if (!binary && !orl_colmap_has(dir, "cameras.txt"))
        return orl_fail(log, ORL_ERR_NOT_FOUND,
                        "%s: no COLMAP model here (neither cameras.bin nor cameras.txt)", dir);
    enum orl_result result = read_model(log, dir, !binary, model);
    ORL_THEN(result, orl_colmap_check(log, dir, model));
    if (result != ORL_OK)
        orl_colmap_finish(model);
    return result;
}

enum orl_result orl_colmap_read_poses(const struct orl_log *log, const char *path,
                                      struct orl_colmap_model *model)
{
    memset(model, 0, sizeof *model);
    const char *beside = ORL_PATH("", "%.*scameras.txt", (int)(orl_path_name(path) - path), path);
    enum orl_result result = orl_path_is_file(beside) ? read_file(log, beside, true, read_cameras, model)
                                                      : ORL_OK;
    ORL_THEN(result, orl_colmap_sort_cameras(log, beside, model));
    ORL_THEN(result, read_file(log, path, true, read_images, model));
    if (result != ORL_OK)
        orl_colmap_finish(model);
    return result;
}
