#include "scene/known_cameras.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "core/file.h"
#include "core/memory.h"
#include "scene/colmap_internal.h"
#include "scene/known_internal.h"

void orl_known_cameras_finish(struct orl_known_cameras *known)
{
    if (!known)
        return;
    orl_colmap_finish(&known->model);
    free(known->gaps);
    for (size_t i = 0; known->paths && i < known->path_count; i++)
        free(known->paths[i]);
    free(known->paths);
    free(known->folder);
    memset(known, 0, sizeof *known);
}

// --- adding cameras ---

void orl_known_set_opencv(struct orl_known_camera *camera, const double f_c[4],
                          const double *distortion, size_t count)
{
    double d[8] = {0};
    bool full = false, any = false;
    for (size_t i = 0; i < count && i < ORL_COUNT(d); i++) {
        d[i] = distortion[i];
        any = any || d[i] != 0;
        full = full || (i >= 4 && d[i] != 0);
    }
    camera->model = full ? ORL_COLMAP_FULL_OPENCV : any ? ORL_COLMAP_OPENCV : ORL_COLMAP_PINHOLE;
    memcpy(camera->params, f_c, 4 * sizeof *f_c);
    memcpy(camera->params + 4, d, sizeof d);
}

static bool same_camera(const struct orl_colmap_camera *a, const struct orl_known_gap *gap,
                        const struct orl_known_camera *b)
{
    // Pictures of unstated size may differ in size.
    return !b->gap.size && !gap->size && a->model == b->model && a->pinhole.width == b->width &&
           a->pinhole.height == b->height && gap->centre == b->gap.centre &&
           gap->fov_x_rad <= b->gap.fov_x_rad && gap->fov_x_rad >= b->gap.fov_x_rad &&
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
    int count = orl_colmap_model_params(given->model);
    for (int i = 0; i < count; i++)
        if (!isfinite(given->params[i]) || fabs(given->params[i]) > 1e7)
            return "a camera parameter is absurd";
    if (!(given->gap.fov_x_rad > 0 ? given->gap.fov_x_rad < 3.1 : given->params[0] > 0))
        return "the focal length is absurd";
    return orl_colmap_name_problem(orl_path_name(given->path));
}

static enum orl_result add_camera(const struct orl_log *log, const char *file, const char *place,
                                  const struct orl_known_camera *given,
                                  struct orl_known_cameras *known)
{
    struct orl_colmap_model *model = &known->model;
    size_t count = model->camera_count;
    if (count && same_camera(&model->cameras[count - 1], &known->gaps[count - 1], given))
        return ORL_OK;
    // Files have at most some thousands of cameras, so growing by one at a time is fast enough.
    void *cameras = realloc(model->cameras, (count + 1) * sizeof *model->cameras);
    if (cameras)
        model->cameras = cameras;
    void *gaps = realloc(known->gaps, (count + 1) * sizeof *known->gaps);
    if (gaps)
        known->gaps = gaps;
    if (!cameras || !gaps)
        return orl_fail(log, ORL_ERR_MEMORY, "%s: no memory for its cameras", file);
    struct orl_colmap_camera *camera = &model->cameras[count];
    *camera = (struct orl_colmap_camera){.id = (uint32_t)count + 1, .model = given->model,
                                         .param_count = orl_colmap_model_params(given->model)};
    memcpy(camera->params, given->params, sizeof camera->params);
    known->gaps[count] = given->gap;
    model->camera_count++;
    if (given->gap.size || given->gap.centre || given->gap.fov_x_rad > 0) {
        camera->pinhole = (struct orl_camera){.width = given->width, .height = given->height};
        return ORL_OK;
    }
    const char *problem =
        orl_colmap_camera_set(camera, (uint64_t)given->width, (uint64_t)given->height);
    return problem ? orl_fail(log, ORL_ERR_FORMAT, "%s: %s: %s", file, place, problem) : ORL_OK;
}

enum orl_result orl_known_add(const struct orl_log *log, const char *file, const char *place,
                              const struct orl_known_camera *given,
                              struct orl_known_cameras *known)
{
    struct orl_colmap_model *model = &known->model;
    const char *problem = camera_problem(given);
    if (problem)
        return orl_fail(log, ORL_ERR_FORMAT, "%s: %s: %s", file, place, problem);
    enum orl_result result = add_camera(log, file, place, given, known);
    if (result != ORL_OK)
        return result;
    size_t count = model->image_count;
    void *images = realloc(model->images, (count + 1) * sizeof *model->images);
    if (images)
        model->images = images;
    void *paths = realloc(known->paths, (count + 1) * sizeof *known->paths);
    if (paths)
        known->paths = paths;
    char *name = orl_strdup(log, orl_path_name(given->path));
    char *path = orl_strdup(log, given->path);
    if (!images || !paths || !name || !path) {
        free(name);
        free(path);
        return orl_fail(log, ORL_ERR_MEMORY, "%s: no memory for its cameras", file);
    }
    model->images[count] = (struct orl_colmap_image){
        .id = (uint32_t)count + 1, .camera_id = (uint32_t)model->camera_count, .name = name,
        .cam_from_world = given->pose};
    known->paths[count] = path;
    known->path_count = ++model->image_count;
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
    int focals = orl_colmap_model_focal_lengths(camera->model);
    double *p = camera->params, sx = 1, sy = 1;
    if (!gap->size && (width != told_width || height != told_height)) {
        sx = (double)width / told_width;
        sy = (double)height / told_height;
        // Allows for rounding of either size by half a pixel.
        if (fabs(sx - sy) * told_height > 1 && fabs(sx - sy) * told_width > 1)
            return orl_fail(log, ORL_ERR_DATA, "%s: %dx%d pixels, but its camera has %dx%d", name,
                            width, height, told_width, told_height);
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

// --- file formats ---

static bool ends_with(const char *text, const char *end)
{
    size_t length = strlen(text), tail = strlen(end);
    return length >= tail && strcmp(text + length - tail, end) == 0;
}

static enum orl_result read_colmap(const struct orl_log *log, const char *dir,
                                   struct orl_known_cameras *known)
{
    enum orl_result result = orl_colmap_read(log, dir, &known->model);
    if (result == ORL_OK) {
        known->gaps = orl_array(log, known->model.camera_count, sizeof *known->gaps);
        result = known->gaps ? ORL_OK : ORL_ERR_MEMORY;
    }
    return result;
}

static enum orl_result read_file(const struct orl_log *log, const char *path, double pixel_centre,
                                 struct orl_known_cameras *known)
{
    const char *name = orl_path_name(path);
    bool colmap = strcmp(name, "cameras.bin") == 0 || strcmp(name, "images.bin") == 0 ||
                  strcmp(name, "cameras.txt") == 0 || strcmp(name, "images.txt") == 0;
    int length = (int)(name - path);
    known->folder = orl_format(log, "%.*s", length ? length : 1, length ? path : ".");
    if (!known->folder)
        return ORL_ERR_MEMORY;
    if (colmap)
        return read_colmap(log, known->folder, known);
    if (ends_with(name, ".json"))
        return orl_known_read_json(log, path, pixel_centre, known);
    if (ends_with(name, ".out"))
        return orl_known_read_bundler(log, path, pixel_centre, known);
    if (ends_with(name, ".txt"))
        return orl_known_read_middlebury(log, path, pixel_centre, known);
    return orl_fail(log, ORL_ERR_FORMAT, "%s: not a file of cameras that is known: .json, "
                    "bundle.out, NAME_par.txt or a COLMAP model", path);
}

// Sets *file to the path of the file of cameras in a folder, or to NULL when there is none.
// ORL_ERR_DATA: there are several.
static enum orl_result find_file(const struct orl_log *log, const char *dir, char **file)
{
    static const char *const known[] = {
        "sparse/0/cameras.bin", "sparse/0/cameras.txt", "sparse/cameras.bin",
        "sparse/cameras.txt", "cameras.bin", "cameras.txt", "cameras.json", "transforms.json",
        "bundle/bundle.out", "bundle.out"};
    struct orl_names names = {0};
    enum orl_result result = ORL_OK;
    *file = NULL;
    for (size_t i = 0; i < ORL_COUNT(known); i++) {
        char *path = orl_path_join(log, dir, known[i]);
        if (!path)
            return ORL_ERR_MEMORY;
        if (orl_path_is_file(path)) {
            *file = path;
            return ORL_OK;
        }
        free(path);
    }
    result = orl_dir_list(log, dir, &names);
    for (size_t i = 0; result == ORL_OK && i < names.count; i++) {
        if (!ends_with(names.items[i], "_par.txt"))
            continue;
        if (*file)
            result = orl_fail(log, ORL_ERR_DATA, "%s: several files of cameras, %s and %s: name "
                              "one", dir, orl_path_name(*file), names.items[i]);
        else if (!(*file = orl_path_join(log, dir, names.items[i])))
            result = ORL_ERR_MEMORY;
    }
    orl_names_finish(&names);
    if (result != ORL_OK) {
        free(*file);
        *file = NULL;
    }
    return result;
}

static enum orl_result read_folder(const struct orl_log *log, const char *dir,
                                   double pixel_centre, struct orl_known_cameras *known)
{
    char *file = NULL;
    enum orl_result result = find_file(log, dir, &file);
    if (result == ORL_OK && !file)
        result = orl_fail(log, ORL_ERR_NOT_FOUND, "%s: no cameras here: neither a COLMAP model, "
                          "nor cameras.json, transforms.json, bundle.out, or NAME_par.txt", dir);
    if (result == ORL_OK)
        result = read_file(log, file, pixel_centre, known);
    // Pictures are relative to the folder that the user named, not to sparse/.
    free(known->folder);
    known->folder = orl_strdup(log, dir);
    free(file);
    return result == ORL_OK && !known->folder ? ORL_ERR_MEMORY : result;
}

enum orl_result orl_known_cameras_read(const struct orl_log *log, const char *path,
                                       double pixel_centre, struct orl_known_cameras *known)
{
    memset(known, 0, sizeof *known);
    enum orl_result result = orl_path_is_dir(path)
                                 ? read_folder(log, path, pixel_centre, known)
                                 : read_file(log, path, pixel_centre, known);
    if (result == ORL_OK && !known->model.image_count)
        result = orl_fail(log, ORL_ERR_DATA, "%s: no camera in it", path);
    if (result == ORL_OK)
        result = orl_colmap_check(log, path, &known->model);
    if (result != ORL_OK)
        orl_known_cameras_finish(known);
    return result;
}
