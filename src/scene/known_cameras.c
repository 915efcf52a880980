#include "scene/known_cameras.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "core/file.h"
#include "core/json.h"
#include "core/memory.h"
#include "core/order.h"
#include "core/text.h"
#include "scene/colmap_internal.h"
#include "scene/known_internal.h"

void orl_known_cameras_finish(struct orl_known_cameras *known)
{
    orl_colmap_finish(&known->model);
    free(known->gaps);
    for (size_t i = 0; i < known->picture_count; i++) {
        free(known->pictures[i].path);
        free(known->pictures[i].mask);
    }
    free(known->pictures);
    memset(known, 0, sizeof *known);
}

// --- adding cameras ---

static bool same_camera(const struct orl_colmap_camera *a, const struct orl_known_gap *gap,
                        const struct orl_known_camera *b)
{
    // Pictures of unstated size may differ in size.
    return !b->gap.size && !gap->size && a->model == b->model && a->pinhole.width == b->width &&
           a->pinhole.height == b->height && gap->centre == b->gap.centre &&
           gap->fov_x_rad <= b->gap.fov_x_rad && gap->fov_x_rad >= b->gap.fov_x_rad &&
           gap->side <= 0 && b->gap.side <= 0 &&
           memcmp(a->params, b->params, sizeof a->params) == 0;
}

static const char *camera_problem(const struct orl_known_camera *given)
{
    if (!orl_pose_valid(&given->pose))
        return "its R is not a rotation, or t is not finite";
    if (given->gap.size ? given->width != 0 || given->height != 0
                        : given->width < 1 || given->height < 1 ||
                              given->width > ORL_IMAGE_MAX_SIDE ||
                              given->height > ORL_IMAGE_MAX_SIDE)
        return "the picture size is absurd";
    int count = orl_colmap_model_lens(given->model).params;
    for (int i = 0; i < count; i++)
        if (!isfinite(given->params[i]) || fabs(given->params[i]) > 1e7)
            return "a camera parameter is absurd";
    if (!(given->gap.fov_x_rad > 0 ? given->gap.fov_x_rad < 3.1 : given->params[0] > 0))
        return "the focal length is absurd";
    return *given->path ? NULL : "its picture has no name";
}

enum orl_result orl_known_bad(const struct orl_log *log, const char *file, const char *place, const char *what)
{
    return orl_fail(log, ORL_ERR_FORMAT, "%s: %s: %s", file, place, what);
}

static enum orl_result add_camera(const struct orl_log *log, const char *file, const struct orl_known_camera *given,
                                  struct orl_known_cameras *known)
{
    struct orl_colmap_model *model = &known->model;
    size_t count = model->camera_count;
    if (count && same_camera(&model->cameras[count - 1], &known->gaps[count - 1], given))
        return ORL_OK;
    ORL_TRY(ORL_GROW(log, model->cameras, model->camera_capacity, count));
    ORL_TRY(ORL_GROW(log, known->gaps, known->gap_capacity, count));
    struct orl_colmap_camera *camera = &model->cameras[count];
    *camera = (struct orl_colmap_camera){.id = (uint32_t)count + 1, .model = given->model,
                                         .param_count = orl_colmap_model_lens(given->model).params};
    memcpy(camera->params, given->params, sizeof camera->params);
    known->gaps[count] = given->gap;
    model->camera_count++;
    if (given->gap.size || given->gap.centre || given->gap.fov_x_rad > 0) {
        camera->pinhole = (struct orl_camera){.width = given->width, .height = given->height};
        return ORL_OK;
    }
    const char *problem =
        orl_colmap_camera_set(camera, (uint64_t)given->width, (uint64_t)given->height);
    return problem ? orl_known_bad(log, file, given->place, problem) : ORL_OK;
}

// A stated path, as other systems write them, too: '/' between its parts, no "./" ahead of them.
static const char *plain_path(const char *stated, char path[ORL_PATH_SIZE])
{
    while (strncmp(stated, "./", 2) == 0 || strncmp(stated, ".\\", 2) == 0)
        stated += 2;
    orl_path_print(path, "", "%s", stated);
    for (char *at = path; (at = strchr(at, '\\')) != NULL;)
        *at = '/';
    return path;
}

bool orl_known_find(const char *folder, const char *stated, char path[ORL_PATH_SIZE])
{
    char plain[ORL_PATH_SIZE];
    orl_path_print(path, "", "%s", plain_path(stated, plain));
    if (*plain == '/' && orl_path_is_file(path))
        return true;
    for (const char *at = plain; at; at = strchr(at, '/')) {
        at += strspn(at, "/");
        if (orl_path_is_file(orl_path_print(path, folder, "%s", at)))
            return true;
    }
    return false;
}

enum orl_result orl_known_add(const struct orl_log *log, const char *file, const struct orl_known_camera *given,
                              struct orl_known_cameras *known)
{
    struct orl_colmap_model *model = &known->model;
    const char *problem = camera_problem(given);
    if (problem)
        return orl_known_bad(log, file, given->place, problem);
    ORL_TRY(add_camera(log, file, given, known));
    size_t count = model->image_count;
    ORL_TRY(ORL_GROW(log, model->images, model->image_capacity, count));
    ORL_TRY(ORL_GROW(log, known->pictures, known->picture_capacity, count));
    char plain[ORL_PATH_SIZE], *path = orl_strdup(log, plain_path(given->path, plain));
    char *mask = given->mask ? orl_strdup(log, plain_path(given->mask, plain)) : NULL;
    if (!path || (given->mask && !mask)) {
        free(path);
        free(mask);
        return ORL_ERR_MEMORY;
    }
    model->images[count] = (struct orl_colmap_image){
        .id = (uint32_t)count + 1, .camera_id = (uint32_t)model->camera_count,
        .cam_from_world = given->pose};
    known->pictures[count] = (struct orl_known_picture){path, mask, given->split};
    known->picture_count = ++model->image_count;
    return ORL_OK;
}

// --- names ---

// Length of the folders, with the last '/', that all pictures' paths have in common.
static size_t common_folders(const struct orl_known_cameras *known)
{
    const char *first = known->pictures[0].path;
    size_t length = (size_t)(orl_path_name(first) - first);
    for (size_t i = 1; i < known->picture_count; i++) {
        size_t same = 0;
        for (size_t k = 0; k < length && known->pictures[i].path[k] == first[k]; k++)
            if (first[k] == '/')
                same = k + 1;
        length = same;
    }
    return length;
}

static enum orl_result any_alike(const struct orl_log *log, const struct orl_known_cameras *known,
                                 bool *alike)
{
    const char **names = orl_array(log, known->picture_count, sizeof *names);
    ORL_TRY_MEMORY(names);
    for (size_t i = 0; i < known->picture_count; i++)
        names[i] = orl_path_name(known->pictures[i].path);
    qsort(names, known->picture_count, sizeof *names, orl_order_texts);
    *alike = false;
    for (size_t i = 1; i < known->picture_count && !*alike; i++)
        *alike = strcmp(names[i], names[i - 1]) == 0;
    free(names);
    return ORL_OK;
}

enum orl_result orl_known_name_images(const struct orl_log *log, const char *file,
                                      struct orl_known_cameras *known)
{
    struct orl_colmap_model *model = &known->model;
    bool alike = false;
    ORL_TRY(any_alike(log, known, &alike));
    size_t common = alike ? common_folders(known) : 0;
    for (size_t i = 0; i < known->picture_count; i++) {
        const char *path = known->pictures[i].path;
        char *name = model->images[i].name = orl_strdup(log, alike ? path + common : orl_path_name(path));
        ORL_TRY_MEMORY(name);
        const char *problem = orl_colmap_name_problem(name);
        if (problem)
            return orl_fail(log, ORL_ERR_FORMAT, "%s: camera %zu (%s): %s", file, i, path, problem);
    }
    return ORL_OK;
}

// --- their place in the world ---

static double median(double *values, size_t count)
{
    qsort(values, count, sizeof *values, orl_order_doubles);
    return values[count / 2];
}

// Scenes are drawn with 32-bit floats, which have some seven digits. Survey coordinates spend most of
// them on the distance from 0, so the median of the cameras' places is taken off where it is more than
// FAR times as far away as the cameras are from each other. It is rounded to a few digits, so that
// scene.json states it exactly.
static enum orl_result choose_origin(const struct orl_log *log, struct orl_known_cameras *known)
{
    enum { FAR = 100 };
    size_t count = known->model.image_count;
    double *values = orl_array(log, count, sizeof *values), spread = 0, far = 0, middle[3];
    ORL_TRY_MEMORY(values);
    for (int k = 0; k < 3; k++) {
        for (size_t i = 0; i < count; i++) {
            double centre[3];
            orl_pose_centre(&known->model.images[i].cam_from_world, centre);
            values[i] = centre[k];
        }
        middle[k] = median(values, count);
        far = fmax(far, fabs(middle[k]));
        for (size_t i = 0; i < count; i++)
            values[i] = fabs(values[i] - middle[k]);
        spread = fmax(spread, median(values, count));
    }
    free(values);
    // Cameras at one place differ by rounding alone.
    if (spread <= 1e-9 * far || far < FAR * spread)
        return ORL_OK;
    double step = pow(10, fmax(floor(log10(spread)), floor(log10(far)) - ORL_JSON_DIGITS + 2));
    for (int k = 0; k < 3; k++)
        known->origin[k] = rint(middle[k] / step) * step;
    orl_logf(log, ORL_LOG_INFO, "the cameras are far from 0: the scene's origin is at %.9g %.9g %.9g of "
             "their coordinates", known->origin[0], known->origin[1], known->origin[2]);
    return ORL_OK;
}

enum orl_result orl_known_place(const struct orl_log *log, struct orl_known_cameras *known)
{
    struct orl_colmap_model *model = &known->model;
    const double *o = known->origin;
    ORL_TRY(choose_origin(log, known));
    for (size_t i = 0; i < model->image_count; i++)
        orl_pose_move(&model->images[i].cam_from_world, o);
    for (size_t i = 0; i < model->point_count; i++)
        for (int k = 0; k < 3; k++)
            model->points[i].position[k] -= o[k];
    for (int k = 0; k < 3 && known->room.known; k++) {
        known->room.low[k] -= o[k];
        known->room.high[k] -= o[k];
    }
    return ORL_OK;
}

// --- completing them ---

enum orl_result orl_known_camera_settle(const struct orl_log *log,
                                        struct orl_known_cameras *known, size_t index,
                                        const char *name, int width, int height)
{
    struct orl_colmap_camera *camera = &known->model.cameras[index];
    struct orl_known_gap *gap = &known->gaps[index];
    int told_width = camera->pinhole.width, told_height = camera->pinhole.height;
    int focals = orl_colmap_model_lens(camera->model).focal_lengths;
    double *p = camera->params, sx = 1, sy = 1;
    if (!gap->size && (width != told_width || height != told_height)) {
        sx = (double)width / told_width;
        sy = (double)height / told_height;
        // Allows for rounding of either size by half a pixel.
        if (fabs(sx - sy) * told_height > 1 && fabs(sx - sy) * told_width > 1)
            return orl_fail(log, ORL_ERR_DATA, "%s: %dx%d pixels, but its camera has %dx%d", name,
                            width, height, told_width, told_height);
    }
    if (gap->side > 0) {
        double unit = (width > height ? width : height) / gap->side;
        for (int i = 0; i < focals + 2; i++)
            p[i] *= unit;
        p[focals] += 0.5 * width;
        p[focals + 1] += 0.5 * height;
    }
    if (gap->fov_x_rad > 0)
        p[0] = p[focals - 1] = 0.5 * width / tan(0.5 * gap->fov_x_rad);
    else
        p[0] *= sx, p[focals - 1] *= focals == 2 ? sy : 1;
    p[focals] = gap->centre ? 0.5 * width : p[focals] * sx;
    p[focals + 1] = gap->centre ? 0.5 * height : p[focals + 1] * sy;
    *gap = (struct orl_known_gap){0};
    const char *problem = orl_colmap_camera_set(camera, (uint64_t)width, (uint64_t)height);
    return problem ? orl_fail(log, ORL_ERR_DATA, "%s: %s", name, problem) : ORL_OK;
}
