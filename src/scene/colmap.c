#include "scene/colmap.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "core/file.h"
#include "core/memory.h"
#include "scene/colmap_internal.h"

// From COLMAP's src/colmap/sensor/models.h, in the order of its ids.
static const struct {
    const char *name;
    struct orl_colmap_lens lens;
} models[] = {
    {"SIMPLE_PINHOLE", {3, 1, ORL_LENS_FLAT}},      {"PINHOLE", {4, 2, ORL_LENS_FLAT}},
    {"SIMPLE_RADIAL", {4, 1, ORL_LENS_FLAT}},       {"RADIAL", {5, 1, ORL_LENS_FLAT}},
    {"OPENCV", {8, 2, ORL_LENS_FLAT}},              {"OPENCV_FISHEYE", {8, 2, ORL_LENS_FISHEYE}},
    {"FULL_OPENCV", {12, 2, ORL_LENS_FLAT}},        {"FOV", {5, 2, ORL_LENS_FOV}},
    {"SIMPLE_RADIAL_FISHEYE", {4, 1, ORL_LENS_FISHEYE}}, {"RADIAL_FISHEYE", {5, 1, ORL_LENS_FISHEYE}},
    {"THIN_PRISM_FISHEYE", {12, 2, ORL_LENS_THIN_PRISM}},
    {"RAD_TAN_THIN_PRISM_FISHEYE", {16, 2, ORL_LENS_RAD_TAN_THIN_PRISM}},
    {"SIMPLE_DIVISION", {4, 1, ORL_LENS_DIVISION}}, {"DIVISION", {5, 2, ORL_LENS_DIVISION}},
    {"SIMPLE_FISHEYE", {3, 1, ORL_LENS_FISHEYE}},   {"FISHEYE", {4, 2, ORL_LENS_FISHEYE}},
    {"EUCM", {6, 2, ORL_LENS_EUCM}},
};

struct orl_colmap_lens orl_colmap_model_lens(int model)
{
    return model >= 0 && model < (int)ORL_COUNT(models) ? models[model].lens : (struct orl_colmap_lens){0};
}

int orl_colmap_model_id(const char *name)
{
    for (size_t i = 0; i < ORL_COUNT(models); i++)
        if (strcmp(models[i].name, name) == 0)
            return (int)i;
    return -1;
}

const char *orl_colmap_camera_set(struct orl_colmap_camera *camera, uint64_t width,
                                  uint64_t height)
{
    if (width == 0 || height == 0 || width > ORL_IMAGE_MAX_SIDE || height > ORL_IMAGE_MAX_SIDE)
        return "the picture size is absurd";
    for (int i = 0; i < camera->param_count; i++)
        if (!isfinite(camera->params[i]))
            return "a camera parameter is not finite";
    const double *p = camera->params;
    bool one = orl_colmap_model_lens(camera->model).focal_lengths == 1;
    camera->pinhole = (struct orl_camera){
        .width = (int)width, .height = (int)height, .fx = p[0], .fy = one ? p[0] : p[1],
        .cx = one ? p[1] : p[2], .cy = one ? p[2] : p[3]};
    return orl_camera_valid(&camera->pinhole) ? NULL
                                              : "the focal length or principal point is absurd";
}

const char *orl_colmap_name_problem(const char *name)
{
    if (!*name)
        return "the picture's name is empty";
    if (*name == '/')
        return "the picture's name is an absolute path";
    for (const char *part = name; part; part = strchr(part, '/')) {
        part += *part == '/';
        if (strncmp(part, "..", 2) == 0 && (part[2] == '/' || part[2] == '\0'))
            return "the picture's name leads out of its folder";
    }
    return NULL;
}

static int compare_cameras(const void *a, const void *b)
{
    uint32_t x = ((const struct orl_colmap_camera *)a)->id;
    uint32_t y = ((const struct orl_colmap_camera *)b)->id;
    return (x > y) - (x < y);
}

enum orl_result orl_colmap_sort_cameras(const struct orl_log *log, const char *path,
                                        struct orl_colmap_model *model)
{
    if (model->camera_count)
        qsort(model->cameras, model->camera_count, sizeof *model->cameras, compare_cameras);
    for (size_t i = 1; i < model->camera_count; i++)
        if (model->cameras[i].id == model->cameras[i - 1].id)
            return orl_fail(log, ORL_ERR_FORMAT, "%s: two cameras have the id %u", path,
                            model->cameras[i].id);
    return ORL_OK;
}

static int compare_images(const void *a, const void *b)
{
    return strcmp(((const struct orl_colmap_image *)a)->name,
                  ((const struct orl_colmap_image *)b)->name);
}

enum orl_result orl_colmap_check(const struct orl_log *log, const char *dir,
                                 struct orl_colmap_model *model)
{
    ORL_TRY(orl_colmap_sort_cameras(log, dir, model));
    if (model->image_count)
        qsort(model->images, model->image_count, sizeof *model->images, compare_images);
    for (size_t i = 0; i < model->image_count; i++) {
        const struct orl_colmap_image *image = &model->images[i];
        if (!orl_colmap_camera_by_id(model, image->camera_id))
            return orl_fail(log, ORL_ERR_FORMAT,
                            "%s: picture %s uses camera %u, which is not there", dir, image->name,
                            image->camera_id);
        if (i && strcmp(image->name, image[-1].name) == 0)
            return orl_fail(log, ORL_ERR_FORMAT, "%s: picture %s is listed twice", dir,
                            image->name);
    }
    return ORL_OK;
}

void orl_colmap_finish(struct orl_colmap_model *model)
{
    if (!model)
        return;
    for (size_t i = 0; i < model->image_count; i++) {
        free(model->images[i].name);
        free(model->images[i].points);
    }
    free(model->cameras);
    free(model->images);
    free(model->points);
    memset(model, 0, sizeof *model);
}

const struct orl_colmap_camera *orl_colmap_camera_by_id(const struct orl_colmap_model *model,
                                                        uint32_t id)
{
    struct orl_colmap_camera key = {.id = id};
    return model->camera_count ? bsearch(&key, model->cameras, model->camera_count,
                                         sizeof *model->cameras, compare_cameras)
                               : NULL;
}

const struct orl_colmap_image *orl_colmap_image_by_name(const struct orl_colmap_model *model,
                                                        const char *name)
{
    const struct orl_colmap_image key = {.name = (char *)name};
    return model->image_count ? bsearch(&key, model->images, model->image_count,
                                        sizeof *model->images, compare_images)
                              : NULL;
}

struct orl_colmap_camera orl_colmap_pinhole(uint32_t id, const struct orl_camera *c)
{
    return (struct orl_colmap_camera){.id = id, .model = 1, .pinhole = *c,
                                      .params = {c->fx, c->fy, c->cx, c->cy}, .param_count = 4};
}

enum orl_result orl_colmap_count_shared(const struct orl_log *log, const struct orl_colmap_model *model,
                                        const struct orl_colmap_image *image, size_t *shared)
{
    bool *seen = orl_array(log, model->point_count, sizeof *seen);
    ORL_TRY_MEMORY(seen);
    for (size_t k = 0; k < image->point_count; k++)
        seen[image->points[k]] = true;
    for (size_t i = 0; i < model->image_count; i++) {
        shared[i] = 0;
        for (size_t k = 0; k < model->images[i].point_count; k++)
            shared[i] += seen[model->images[i].points[k]];
    }
    free(seen);
    return ORL_OK;
}

struct orl_view orl_colmap_image_view(const struct orl_colmap_model *model,
                                      const struct orl_colmap_image *image)
{
    const struct orl_colmap_camera *camera = orl_colmap_camera_by_id(model, image->camera_id);
    struct orl_view view = {.cam_from_world = image->cam_from_world};
    if (camera) // as in every model that was read
        view.camera = camera->pinhole;
    return view;
}
