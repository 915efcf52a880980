// COLMAP's binary model: little-endian, packed (src/base/reconstruction.cc).
#include <stdlib.h>
#include <string.h>

#include "core/file.h"
#include "core/memory.h"
#include "scene/colmap_internal.h"

// Smallest possible sizes of records in bytes, to check counts against the file's size.
enum { CAMERA_MIN = 48, IMAGE_MIN = 73, POINT_MIN = 51, POINT2D_SIZE = 24, TRACK_SIZE = 8 };

struct reader {
    const struct orl_log *log;
    const char *path;
    uint8_t *data;
    size_t size, at;
};

static enum orl_result bad(const struct reader *r, const char *what)
{
    return orl_fail(r->log, ORL_ERR_FORMAT, "%s: byte %zu: %s", r->path, r->at, what);
}

static enum orl_result take(struct reader *r, void *out, size_t size, const char *what)
{
    if (size > r->size - r->at)
        return orl_fail(r->log, ORL_ERR_FORMAT, "%s: byte %zu: the file ends inside %s", r->path,
                        r->at, what);
    memcpy(out, r->data + r->at, size);
    r->at += size;
    return ORL_OK;
}

// Reads a count of records, each of which takes at least `record_min` bytes.
static enum orl_result take_count(struct reader *r, size_t record_min, const char *what,
                                  uint64_t *count)
{
    ORL_TRY(take(r, count, sizeof *count, what));
    if (*count > (r->size - r->at) / record_min) {
        r->at -= sizeof *count;
        return orl_fail(r->log, ORL_ERR_FORMAT,
                        "%s: byte %zu: the header claims %llu %s, but only %zu bytes follow", r->path,
                        r->at, (unsigned long long)*count, what, r->size - r->at - sizeof *count);
    }
    return ORL_OK;
}

static enum orl_result read_camera(struct reader *r, struct orl_colmap_camera *camera)
{
    struct {
        uint32_t id;
        int32_t model;
        uint64_t width, height;
    } head;
    _Static_assert(sizeof head == 24, "packed as in the file");
    size_t start = r->at;
    ORL_TRY(take(r, &head, sizeof head, "a camera"));
    camera->id = head.id;
    camera->model = head.model;
    camera->param_count = orl_colmap_model_lens(head.model).params;
    if (!camera->param_count)
        return orl_fail(r->log, ORL_ERR_FORMAT, "%s: byte %zu: unknown camera model %d; undistort "
                        "the pictures with the program that made it", r->path, start, head.model);
    ORL_TRY(take(r, camera->params, sizeof(double) * (size_t)camera->param_count, "a camera"));
    const char *problem = orl_colmap_camera_set(camera, head.width, head.height);
    r->at = problem ? start : r->at;
    return problem ? bad(r, problem) : ORL_OK;
}

static enum orl_result read_cameras(struct reader *r, struct orl_colmap_model *model)
{
    uint64_t count = 0;
    ORL_TRY(take_count(r, CAMERA_MIN, "cameras", &count));
    model->cameras = orl_array(r->log, count, sizeof *model->cameras);
    ORL_TRY_MEMORY(model->cameras);
    for (uint64_t i = 0; i < count; i++, model->camera_count++)
        ORL_TRY(read_camera(r, &model->cameras[i]));
    return ORL_OK;
}

static enum orl_result read_point(struct reader *r, struct orl_colmap_point *point)
{
    uint64_t track = 0;
    ORL_TRY(take(r, &point->id, 8, "a point"));
    ORL_TRY(take(r, point->position, 24, "a point"));
    ORL_TRY(take(r, point->rgb, 3, "a point"));
    ORL_TRY(take(r, &point->error_px, 8, "a point"));
    ORL_TRY(take_count(r, TRACK_SIZE, "track elements", &track));
    r->at += (size_t)track * TRACK_SIZE;
    point->track_length = track > UINT32_MAX ? UINT32_MAX : (uint32_t)track;
    return ORL_OK;
}

static enum orl_result read_points(struct reader *r, struct orl_colmap_model *model)
{
    uint64_t count = 0;
    ORL_TRY(take_count(r, POINT_MIN, "points", &count));
    if (count > UINT32_MAX)
        return bad(r, "more than 2^32 points");
    model->points = orl_array(r->log, count, sizeof *model->points);
    ORL_TRY_MEMORY(model->points);
    for (uint64_t i = 0; i < count; i++, model->point_count++)
        ORL_TRY(read_point(r, &model->points[i]));
    return orl_colmap_clean_points(r->log, r->path, model);
}

static enum orl_result read_name(struct reader *r, char **name)
{
    const uint8_t *end = memchr(r->data + r->at, 0, r->size - r->at);
    if (!end)
        return bad(r, "a picture's name does not end");
    const char *text = (const char *)(r->data + r->at);
    const char *problem = orl_colmap_name_problem(text);
    if (problem)
        return bad(r, problem);
    *name = orl_strdup(r->log, text);
    r->at = (size_t)(end - r->data) + 1;
    return *name ? ORL_OK : ORL_ERR_MEMORY;
}

static enum orl_result read_observations(struct reader *r, const struct orl_colmap_model *model,
                                         struct orl_colmap_image *image)
{
    uint64_t count = 0;
    ORL_TRY(take_count(r, POINT2D_SIZE, "observations", &count));
    image->points = orl_array(r->log, count, sizeof *image->points);
    ORL_TRY_MEMORY(image->points);
    for (uint64_t i = 0; i < count; i++, r->at += POINT2D_SIZE) {
        uint64_t id;
        memcpy(&id, r->data + r->at + 16, sizeof id);
        int64_t index = id == UINT64_MAX ? -1 : orl_colmap_point_index(model, id);
        if (index >= 0)
            image->points[image->point_count++] = (uint32_t)index;
    }
    return ORL_OK;
}

static enum orl_result read_image(struct reader *r, const struct orl_colmap_model *model,
                                  struct orl_colmap_image *image)
{
    double quat[4], t[3];
    size_t start = r->at;
    ORL_TRY(take(r, &image->id, 4, "a picture"));
    ORL_TRY(take(r, quat, sizeof quat, "a picture"));
    ORL_TRY(take(r, t, sizeof t, "a picture"));
    ORL_TRY(take(r, &image->camera_id, 4, "a picture"));
    if (!orl_pose_from_quat(quat, t, &image->cam_from_world)) {
        r->at = start;
        return bad(r, "a picture's pose is zero, not finite or absurdly far");
    }
    ORL_TRY(read_name(r, &image->name));
    return read_observations(r, model, image);
}

static enum orl_result read_images(struct reader *r, struct orl_colmap_model *model)
{
    uint64_t count = 0;
    ORL_TRY(take_count(r, IMAGE_MIN, "pictures", &count));
    model->images = orl_array(r->log, count, sizeof *model->images);
    ORL_TRY_MEMORY(model->images);
    for (uint64_t i = 0; i < count; i++) {
        model->image_count = i + 1; // counted first, so that a half-read image is released
        ORL_TRY(read_image(r, model, &model->images[i]));
    }
    return ORL_OK;
}

enum orl_result orl_colmap_read_binary(const struct orl_log *log, const char *dir,
                                       struct orl_colmap_model *model)
{
    static const struct {
        const char *name;
        enum orl_result (*read)(struct reader *, struct orl_colmap_model *);
        bool optional;
    } files[] = {{"cameras.bin", read_cameras, false}, {"points3D.bin", read_points, true},
                 {"images.bin", read_images, false}};
    enum orl_result result = ORL_OK;
    for (size_t i = 0; i < ORL_COUNT(files) && result == ORL_OK; i++) {
        struct reader r = {.log = log, .path = ORL_PATH(dir, "%s", files[i].name)};
        if (files[i].optional && !orl_path_is_file(r.path))
            continue;
        result = orl_file_read(log, r.path, SIZE_MAX / 2, &r.data, &r.size);
        ORL_THEN(result, files[i].read(&r, model));
        if (result == ORL_OK && r.at != r.size)
            result = bad(&r, "bytes after the end of the model");
        free(r.data);
    }
    return result;
}
