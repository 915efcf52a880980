// COLMAP's text model: one record a line, '#' starts a comment line.
#include <errno.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "core/file.h"
#include "core/memory.h"
#include "scene/colmap_internal.h"

struct lines {
    const struct orl_log *log;
    char *path;
    uint8_t *data;
    char *next, *end;   // what is left
    char *at;           // in the current line
    size_t number;      // of the current line, from 1
};

static enum orl_result bad(const struct lines *l, const char *what)
{
    return orl_fail(l->log, ORL_ERR_FORMAT, "%s: line %zu (byte %zu): %s", l->path, l->number,
                    (size_t)(l->at - (char *)l->data), what);
}

// Takes over `path`.
static enum orl_result lines_open(const struct orl_log *log, char *path, struct lines *l)
{
    *l = (struct lines){.log = log, .path = path};
    if (!l->path)
        return ORL_ERR_MEMORY;
    size_t size;
    enum orl_result result = orl_file_read(log, l->path, SIZE_MAX / 2, &l->data, &size);
    l->next = l->at = (char *)l->data;
    l->end = l->next ? l->next + size : NULL;
    return result;
}

static void lines_close(struct lines *l)
{
    free(l->path);
    free(l->data);
}

// The next line, cut off at its end, also when it is empty. False at the end.
static bool next_raw_line(struct lines *l)
{
    if (l->next >= l->end)
        return false;
    char *line = l->next;
    char *stop = memchr(line, '\n', (size_t)(l->end - line));
    l->next = stop ? stop + 1 : l->end;
    stop = stop ? stop : l->end;
    while (stop > line && (stop[-1] == '\r' || stop[-1] == ' ' || stop[-1] == '\t'))
        stop--;
    *stop = '\0'; // orl_file_read leaves room after the last byte
    l->at = line;
    l->number++;
    return true;
}

// Skips comments and empty lines.
static bool next_line(struct lines *l)
{
    while (next_raw_line(l)) {
        l->at += strspn(l->at, " \t");
        if (*l->at && *l->at != '#')
            return true;
    }
    return false;
}

static bool take_number(struct lines *l, double *value)
{
    char *end;
    *value = strtod(l->at, &end);
    if (end == l->at)
        return false;
    l->at = end;
    return true;
}

static bool take_id(struct lines *l, uint64_t max, uint64_t *value)
{
    char *end;
    errno = 0;
    l->at += strspn(l->at, " \t");
    if (*l->at < '0' || *l->at > '9')
        return false;
    *value = strtoull(l->at, &end, 10);
    if (errno || *value > max)
        return false;
    l->at = end;
    return true;
}

static bool take_numbers(struct lines *l, double *values, size_t count)
{
    for (size_t i = 0; i < count; i++)
        if (!take_number(l, &values[i]))
            return false;
    return true;
}

static enum orl_result read_camera(struct lines *l, struct orl_colmap_camera *camera)
{
    uint64_t id, width, height;
    if (!take_id(l, UINT32_MAX, &id))
        return bad(l, "a camera's id is missing");
    camera->id = (uint32_t)id;
    l->at += strspn(l->at, " \t");
    size_t length = strcspn(l->at, " \t");
    char name[64] = "";
    if (length < sizeof name)
        memcpy(name, l->at, length);
    camera->model = orl_colmap_model_id(name);
    camera->param_count = orl_colmap_model_params(camera->model);
    if (!camera->param_count)
        return bad(l, "unknown camera model");
    l->at += length;
    if (!take_id(l, UINT64_MAX, &width) || !take_id(l, UINT64_MAX, &height) ||
        !take_numbers(l, camera->params, (size_t)camera->param_count))
        return bad(l, "a camera's size or parameters are missing");
    const char *problem = orl_colmap_camera_set(camera, width, height);
    return problem ? bad(l, problem) : ORL_OK;
}

static enum orl_result read_cameras(struct lines *l, struct orl_colmap_model *model)
{
    enum orl_result result = ORL_OK;
    size_t capacity = 0;
    while (result == ORL_OK && next_line(l)) {
        result = orl_grow(l->log, (void **)&model->cameras, &capacity, model->camera_count + 1,
                          sizeof *model->cameras);
        if (result != ORL_OK)
            break;
        struct orl_colmap_camera *camera = &model->cameras[model->camera_count++];
        memset(camera, 0, sizeof *camera);
        result = read_camera(l, camera);
    }
    return result;
}

static enum orl_result read_point(struct lines *l, struct orl_colmap_point *point)
{
    double rgb[3];
    if (!take_id(l, UINT64_MAX, &point->id) || !take_numbers(l, point->position, 3) ||
        !take_numbers(l, rgb, 3) || !take_number(l, &point->error_px))
        return bad(l, "a point needs id, x y z, r g b and error");
    for (int i = 0; i < 3; i++)
        point->rgb[i] = (uint8_t)(rgb[i] >= 0 && rgb[i] <= 255 ? rgb[i] : 0);
    double pair[2];
    while (take_numbers(l, pair, 2))
        point->track_length++;
    return *l->at ? bad(l, "not a number") : ORL_OK;
}

static enum orl_result read_points(struct lines *l, struct orl_colmap_model *model)
{
    enum orl_result result = ORL_OK;
    size_t capacity = 0;
    while (result == ORL_OK && next_line(l)) {
        if (model->point_count == UINT32_MAX)
            return bad(l, "more than 2^32 points");
        result = orl_grow(l->log, (void **)&model->points, &capacity, model->point_count + 1,
                          sizeof *model->points);
        if (result != ORL_OK)
            break;
        struct orl_colmap_point *point = &model->points[model->point_count++];
        memset(point, 0, sizeof *point);
        result = read_point(l, point);
    }
    return result == ORL_OK ? orl_colmap_clean_points(l->log, l->path, model) : result;
}

static enum orl_result read_observations(struct lines *l, const struct orl_colmap_model *model,
                                         struct orl_colmap_image *image)
{
    size_t capacity = 0;
    double xy[2];
    while (take_numbers(l, xy, 2)) {
        double id;
        if (!take_number(l, &id))
            return bad(l, "an observation needs x, y and a point's id");
        int64_t index = id < 0 || id > 9e15 ? -1 : orl_colmap_point_index(model, (uint64_t)id);
        if (index < 0)
            continue;
        enum orl_result result = orl_grow(l->log, (void **)&image->points, &capacity,
                                          image->point_count + 1, sizeof *image->points);
        if (result != ORL_OK)
            return result;
        image->points[image->point_count++] = (uint32_t)index;
    }
    return *l->at ? bad(l, "not a number") : ORL_OK;
}

static enum orl_result read_image(struct lines *l, const struct orl_colmap_model *model,
                                  struct orl_colmap_image *image)
{
    uint64_t id, camera_id;
    double quat[4], t[3];
    if (!take_id(l, UINT32_MAX, &id) || !take_numbers(l, quat, 4) || !take_numbers(l, t, 3) ||
        !take_id(l, UINT32_MAX, &camera_id))
        return bad(l, "a picture needs id, qw qx qy qz, tx ty tz, camera and name");
    image->id = (uint32_t)id;
    image->camera_id = (uint32_t)camera_id;
    if (!orl_pose_from_quat(quat, t, &image->cam_from_world))
        return bad(l, "a picture's pose is zero, not finite or absurdly far");
    l->at += strspn(l->at, " \t");
    const char *problem = orl_colmap_name_problem(l->at);
    if (problem)
        return bad(l, problem);
    image->name = orl_strdup(l->log, l->at);
    if (!image->name)
        return ORL_ERR_MEMORY;
    return next_raw_line(l) ? read_observations(l, model, image) : ORL_OK;
}

static enum orl_result read_images(struct lines *l, struct orl_colmap_model *model)
{
    enum orl_result result = ORL_OK;
    size_t capacity = 0;
    while (result == ORL_OK && next_line(l)) {
        result = orl_grow(l->log, (void **)&model->images, &capacity, model->image_count + 1,
                          sizeof *model->images);
        if (result != ORL_OK)
            break;
        struct orl_colmap_image *image = &model->images[model->image_count++];
        memset(image, 0, sizeof *image);
        result = read_image(l, model, image);
    }
    return result;
}

enum orl_result orl_colmap_read_text(const struct orl_log *log, const char *dir,
                                     struct orl_colmap_model *model)
{
    static const struct {
        const char *name;
        enum orl_result (*read)(struct lines *, struct orl_colmap_model *);
    } files[] = {
        {"cameras.txt", read_cameras}, {"points3D.txt", read_points}, {"images.txt", read_images}};
    enum orl_result result = ORL_OK;
    for (size_t i = 0; i < ORL_COUNT(files) && result == ORL_OK; i++) {
        struct lines l;
        result = lines_open(log, orl_path_join(log, dir, files[i].name), &l);
        if (result == ORL_OK)
            result = files[i].read(&l, model);
        lines_close(&l);
    }
    return result;
}

enum orl_result orl_colmap_read_poses(const struct orl_log *log, const char *path,
                                      struct orl_colmap_model *model)
{
    memset(model, 0, sizeof *model);
    struct lines l = {0};
    int dir = (int)(orl_path_name(path) - path);
    char *beside = orl_format(log, "%.*scameras.txt", dir, path), *images = orl_strdup(log, path);
    enum orl_result result = beside && images ? ORL_OK : ORL_ERR_MEMORY;
    if (result == ORL_OK && orl_path_is_file(beside)) {
        result = lines_open(log, beside, &l);
        beside = NULL;
        if (result == ORL_OK)
            result = read_cameras(&l, model);
        if (result == ORL_OK)
            result = orl_colmap_sort_cameras(log, l.path, model);
        lines_close(&l);
    }
    if (result == ORL_OK) {
        result = lines_open(log, images, &l);
        images = NULL;
        if (result == ORL_OK)
            result = read_images(&l, model);
        lines_close(&l);
    }
    free(beside);
    free(images);
    if (result != ORL_OK)
        orl_colmap_finish(model);
    return result;
}
