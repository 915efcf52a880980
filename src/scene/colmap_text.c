// COLMAP's text model: one record per line; '#' starts a comment line.
#include <stdio.h>
#include <string.h>

#include "core/file.h"
#include "core/memory.h"
#include "scene/colmap_internal.h"
#include "scene/text_lines.h"

static enum orl_result unknown_model(struct orl_text_lines *l, const char *name)
{
    char what[192];
    snprintf(what, sizeof what, "unknown camera model %s; %s", name,
             strcmp(name, "EQUIRECTANGULAR") == 0
                 ? "panoramas are not read: cut flat views out of them"
                 : "undistort the pictures with the program that made it");
    return orl_text_bad(l, what);
}

static enum orl_result read_camera(struct orl_text_lines *l, struct orl_colmap_camera *camera)
{
    uint64_t id, width, height;
    if (!orl_text_id(l, UINT32_MAX, &id))
        return orl_text_bad(l, "a camera's id is missing");
    camera->id = (uint32_t)id;
    l->at += strspn(l->at, " \t");
    size_t length = strcspn(l->at, " \t");
    char name[64] = "";
    if (length < sizeof name)
        memcpy(name, l->at, length);
    camera->model = orl_colmap_model_id(name);
    camera->param_count = orl_colmap_model_lens(camera->model).params;
    if (!camera->param_count)
        return unknown_model(l, name);
    l->at += length;
    if (!orl_text_id(l, UINT64_MAX, &width) || !orl_text_id(l, UINT64_MAX, &height) ||
        !orl_text_numbers(l, camera->params, (size_t)camera->param_count))
        return orl_text_bad(l, "a camera's size or parameters are missing");
    const char *problem = orl_colmap_camera_set(camera, width, height);
    return problem ? orl_text_bad(l, problem) : ORL_OK;
}

static enum orl_result read_cameras(struct orl_text_lines *l, struct orl_colmap_model *model)
{
    while (orl_text_next(l)) {
        ORL_TRY(ORL_GROW(l->log, model->cameras, model->camera_capacity, model->camera_count));
        struct orl_colmap_camera *camera = &model->cameras[model->camera_count++];
        memset(camera, 0, sizeof *camera);
        ORL_TRY(read_camera(l, camera));
    }
    return ORL_OK;
}

static enum orl_result read_point(struct orl_text_lines *l, struct orl_colmap_point *point)
{
    double rgb[3];
    if (!orl_text_id(l, UINT64_MAX, &point->id) || !orl_text_numbers(l, point->position, 3) ||
        !orl_text_numbers(l, rgb, 3) || !orl_text_number(l, &point->error_px))
        return orl_text_bad(l, "a point needs id, x y z, r g b and error");
    for (int i = 0; i < 3; i++)
        point->rgb[i] = (uint8_t)(rgb[i] >= 0 && rgb[i] <= 255 ? rgb[i] : 0);
    double pair[2];
    while (orl_text_numbers(l, pair, 2))
        point->track_length++;
    return *l->at ? orl_text_bad(l, "not a number") : ORL_OK;
}

static enum orl_result read_points(struct orl_text_lines *l, struct orl_colmap_model *model)
{
    while (orl_text_next(l)) {
        if (model->point_count == UINT32_MAX)
            return orl_text_bad(l, "more than 2^32 points");
        ORL_TRY(ORL_GROW(l->log, model->points, model->point_capacity, model->point_count));
        struct orl_colmap_point *point = &model->points[model->point_count++];
        memset(point, 0, sizeof *point);
        ORL_TRY(read_point(l, point));
    }
    return orl_colmap_clean_points(l->log, l->path, model);
}

static enum orl_result read_observations(struct orl_text_lines *l, const struct orl_colmap_model *model,
                                         struct orl_colmap_image *image)
{
    double xy[2];
    while (orl_text_numbers(l, xy, 2)) {
        double id;
        if (!orl_text_number(l, &id))
            return orl_text_bad(l, "an observation needs x, y and a point's id");
        bool whole = id >= 0 && id <= 9e15; // -1: of no point; false for NaN, too
        int64_t index = whole ? orl_colmap_point_index(model, (uint64_t)id) : -1;
        if (index < 0)
            continue;
        ORL_TRY(ORL_GROW(l->log, image->points, image->point_capacity, image->point_count));
        image->points[image->point_count++] = (uint32_t)index;
    }
    return *l->at ? orl_text_bad(l, "not a number") : ORL_OK;
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

static enum orl_result read_image(struct orl_text_lines *l, const struct orl_colmap_model *model,
                                  struct orl_colmap_image *image)
{
    uint64_t id, camera_id;
    double quat[4], t[3];
    if (!orl_text_id(l, UINT32_MAX, &id) || !orl_text_numbers(l, quat, 4) || !orl_text_numbers(l, t, 3) ||
        !orl_text_id(l, UINT32_MAX, &camera_id))
        return orl_text_bad(l, "a picture needs id, qw qx qy qz, tx ty tz, camera and name");
    image->id = (uint32_t)id;
    image->camera_id = (uint32_t)camera_id;
    if (!orl_pose_from_quat(quat, t, &image->cam_from_world))
        return orl_text_bad(l, "a picture's pose is zero, not finite or absurdly far");
    l->at += strspn(l->at, " \t");
    const char *problem = orl_colmap_name_problem(l->at);
    if (problem)
        return orl_text_bad(l, problem);
    image->name = orl_strdup(l->log, l->at);
    ORL_TRY_MEMORY(image->name);
    // Some programs write no lines of observations.
    if (!orl_text_next_raw(l))
        return ORL_OK;
    if (is_picture(l)) {
        orl_text_back(l);
        return ORL_OK;
    }
    return read_observations(l, model, image);
}

static enum orl_result read_images(struct orl_text_lines *l, struct orl_colmap_model *model)
{
    while (orl_text_next(l)) {
        ORL_TRY(ORL_GROW(l->log, model->images, model->image_capacity, model->image_count));
        struct orl_colmap_image *image = &model->images[model->image_count++];
        memset(image, 0, sizeof *image);
        ORL_TRY(read_image(l, model, image));
    }
    return ORL_OK;
}

enum orl_result orl_colmap_read_text(const struct orl_log *log, const char *dir,
                                     struct orl_colmap_model *model)
{
    static const struct {
        const char *name;
        enum orl_result (*read)(struct orl_text_lines *, struct orl_colmap_model *);
        bool optional;
    } files[] = {{"cameras.txt", read_cameras, false}, {"points3D.txt", read_points, true},
                 {"images.txt", read_images, false}};
    enum orl_result result = ORL_OK;
    for (size_t i = 0; i < ORL_COUNT(files) && result == ORL_OK; i++) {
        struct orl_text_lines l;
        const char *path = ORL_PATH(dir, "%s", files[i].name);
        if (files[i].optional && !orl_path_is_file(path))
            continue;
        result = orl_text_open(log, path, &l);
        ORL_THEN(result, files[i].read(&l, model));
        orl_text_close(&l);
    }
    return result;
}

enum orl_result orl_colmap_read_poses(const struct orl_log *log, const char *path,
                                      struct orl_colmap_model *model)
{
    memset(model, 0, sizeof *model);
    struct orl_text_lines l;
    int dir = (int)(orl_path_name(path) - path);
    const char *beside = ORL_PATH("", "%.*scameras.txt", dir, path);
    enum orl_result result = ORL_OK;
    if (orl_path_is_file(beside) && (result = orl_text_open(log, beside, &l)) == ORL_OK) {
        result = read_cameras(&l, model);
        ORL_THEN(result, orl_colmap_sort_cameras(log, beside, model));
        orl_text_close(&l);
    }
    if (result == ORL_OK && (result = orl_text_open(log, path, &l)) == ORL_OK) {
        result = read_images(&l, model);
        orl_text_close(&l);
    }
    if (result != ORL_OK)
        orl_colmap_finish(model);
    return result;
}
