// Writing COLMAP's binary model (src/base/reconstruction.cc).
#include <stdlib.h>
#include <string.h>

#include "core/file.h"
#include "core/memory.h"
#include "scene/colmap_internal.h"

struct buffer {
    const struct orl_log *log;
    uint8_t *data;
    size_t size, capacity;
    bool failed;
};

static void put(struct buffer *b, const void *data, size_t size)
{
    if (b->failed || orl_grow(b->log, (void **)&b->data, &b->capacity, b->size + size, 1) != ORL_OK) {
        b->failed = true;
        return;
    }
    memcpy(b->data + b->size, data, size);
    b->size += size;
}

static void put_u32(struct buffer *b, uint32_t value)
{
    put(b, &value, sizeof value);
}

static void put_u64(struct buffer *b, uint64_t value)
{
    put(b, &value, sizeof value);
}

static void put_f64(struct buffer *b, const double *values, size_t count)
{
    put(b, values, count * sizeof *values);
}

static void put_cameras(struct buffer *b, const struct orl_colmap_model *model)
{
    put_u64(b, model->camera_count);
    for (size_t i = 0; i < model->camera_count; i++) {
        const struct orl_colmap_camera *camera = &model->cameras[i];
        put_u32(b, camera->id);
        put_u32(b, (uint32_t)camera->model);
        put_u64(b, (uint64_t)camera->pinhole.width);
        put_u64(b, (uint64_t)camera->pinhole.height);
        put_f64(b, camera->params, (size_t)camera->param_count);
    }
}

static void put_images(struct buffer *b, const struct orl_colmap_model *model)
{
    put_u64(b, model->image_count);
    for (size_t i = 0; i < model->image_count; i++) {
        const struct orl_colmap_image *image = &model->images[i];
        const struct orl_colmap_camera *camera = orl_colmap_camera_by_id(model, image->camera_id);
        double quat[4];
        orl_pose_to_quat(&image->cam_from_world, quat);
        put_u32(b, image->id);
        put_f64(b, quat, 4);
        put_f64(b, image->cam_from_world.t, 3);
        put_u32(b, image->camera_id);
        put(b, image->name, strlen(image->name) + 1);
        put_u64(b, image->point_count);
        for (size_t k = 0; k < image->point_count; k++) {
            const struct orl_colmap_point *point = &model->points[image->points[k]];
            double cam[3], pixel[2] = {0, 0};
            orl_pose_apply(&image->cam_from_world, point->position, cam);
            if (cam[2] > 0)
                orl_colmap_camera_project(camera,
                                          (double[2]){cam[0] / cam[2], cam[1] / cam[2]}, pixel);
            put_f64(b, pixel, 2);
            put_u64(b, point->id);
        }
    }
}

// One observation of a point: an image and the index among the image's observations.
struct track {
    uint32_t point, image_id, index;
};

static int compare_tracks(const void *a, const void *b)
{
    const struct track *x = a, *y = b;
    if (x->point != y->point)
        return x->point < y->point ? -1 : 1;
    return (x->image_id > y->image_id) - (x->image_id < y->image_id);
}

static void put_points(struct buffer *b, const struct orl_colmap_model *model)
{
    size_t total = 0, count = 0, at = 0;
    for (size_t i = 0; i < model->image_count; i++)
        total += model->images[i].point_count;
    struct track *tracks = orl_array(b->log, total, sizeof *tracks);
    if (!tracks) {
        b->failed = true;
        return;
    }
    for (size_t i = 0; i < model->image_count; i++)
        for (size_t k = 0; k < model->images[i].point_count; k++)
            tracks[count++] = (struct track){model->images[i].points[k], model->images[i].id,
                                             (uint32_t)k};
    qsort(tracks, count, sizeof *tracks, compare_tracks);
    put_u64(b, model->point_count);
    for (size_t p = 0; p < model->point_count; p++) {
        const struct orl_colmap_point *point = &model->points[p];
        size_t end = at;
        while (end < count && tracks[end].point == p)
            end++;
        put_u64(b, point->id);
        put_f64(b, point->position, 3);
        put(b, point->rgb, 3);
        put_f64(b, &point->error_px, 1);
        put_u64(b, end - at);
        for (; at < end; at++) {
            put_u32(b, tracks[at].image_id);
            put_u32(b, tracks[at].index);
        }
    }
    free(tracks);
}

enum orl_result orl_colmap_write(const struct orl_log *log, const char *dir,
                                 const struct orl_colmap_model *model)
{
    static const struct {
        const char *name;
        void (*write)(struct buffer *, const struct orl_colmap_model *);
    } files[] = {{"cameras.bin", put_cameras}, {"images.bin", put_images},
                 {"points3D.bin", put_points}};
    enum orl_result result = ORL_OK;
    for (size_t i = 0; result == ORL_OK && i < ORL_COUNT(files); i++) {
        struct buffer b = {.log = log};
        files[i].write(&b, model);
        result = b.failed ? ORL_ERR_MEMORY : orl_file_write(log, ORL_PATH(dir, "%s", files[i].name), b.data, b.size);
        free(b.data);
    }
    return result;
}
