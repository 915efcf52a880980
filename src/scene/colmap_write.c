// Writing COLMAP's binary model (src/base/reconstruction.cc).
#include <stdlib.h>
#include <string.h>

#include "core/file.h"
#include "core/memory.h"
#include "core/order.h"
#include "scene/colmap_internal.h"

static void put_u32(FILE *out, uint32_t value)
{
    fwrite(&value, sizeof value, 1, out);
}

static void put_u64(FILE *out, uint64_t value)
{
    fwrite(&value, sizeof value, 1, out);
}

static void put_f64(FILE *out, const double *values, int count)
{
    fwrite(values, sizeof *values, (size_t)count, out);
}

// One observation of a point: an image and the index among the image's observations.
struct track {
    uint32_t point, image_id, index;
};

// What is written.
struct writing {
    const struct orl_colmap_model *model;
    const bool *keep;     // see orl_colmap_write
    struct track *tracks; // owned; by points, and one of no point behind them
};

static bool is_kept(const struct writing *w, size_t image)
{
    return !w->keep || w->keep[image];
}

static void put_cameras(FILE *out, const struct writing *w)
{
    const struct orl_colmap_model *model = w->model;
    put_u64(out, model->camera_count);
    for (size_t i = 0; i < model->camera_count; i++) {
        const struct orl_colmap_camera *camera = &model->cameras[i];
        put_u32(out, camera->id);
        put_u32(out, (uint32_t)camera->model);
        put_u64(out, (uint64_t)camera->pinhole.width);
        put_u64(out, (uint64_t)camera->pinhole.height);
        put_f64(out, camera->params, camera->param_count);
    }
}

static void put_images(FILE *out, const struct writing *w)
{
    const struct orl_colmap_model *model = w->model;
    uint64_t count = 0;
    for (size_t i = 0; i < model->image_count; i++)
        count += is_kept(w, i);
    put_u64(out, count);
    for (size_t i = 0; i < model->image_count; i++) {
        if (!is_kept(w, i))
            continue;
        const struct orl_colmap_image *image = &model->images[i];
        const struct orl_colmap_camera *camera = orl_colmap_camera_by_id(model, image->camera_id);
        double quat[4];
        orl_pose_to_quat(&image->cam_from_world, quat);
        put_u32(out, image->id);
        put_f64(out, quat, 4);
        put_f64(out, image->cam_from_world.t, 3);
        put_u32(out, image->camera_id);
        fwrite(image->name, strlen(image->name) + 1, 1, out);
        put_u64(out, image->point_count);
        for (size_t k = 0; k < image->point_count; k++) {
            const struct orl_colmap_point *point = &model->points[image->points[k]];
            double cam[3], pixel[2] = {0, 0};
            orl_pose_apply(&image->cam_from_world, point->position, cam);
            if (cam[2] > 0)
                orl_colmap_camera_project(camera,
                                          (double[2]){cam[0] / cam[2], cam[1] / cam[2]}, pixel);
            put_f64(out, pixel, 2);
            put_u64(out, point->id);
        }
    }
}

static enum orl_result list_tracks(const struct orl_log *log, struct writing *w)
{
    const struct orl_colmap_model *model = w->model;
    size_t total = 0, count = 0;
    for (size_t i = 0; i < model->image_count; i++)
        total += model->images[i].point_count;
    w->tracks = orl_array(log, total + 1, sizeof *w->tracks);
    ORL_TRY_MEMORY(w->tracks);
    for (size_t i = 0; i < model->image_count; i++)
        for (size_t k = 0; is_kept(w, i) && k < model->images[i].point_count; k++)
            w->tracks[count++] = (struct track){model->images[i].points[k], model->images[i].id, (uint32_t)k};
    qsort(w->tracks, count, sizeof *w->tracks, orl_order_pairs);
    w->tracks[count].point = UINT32_MAX;
    return ORL_OK;
}

static void put_points(FILE *out, const struct writing *w)
{
    const struct orl_colmap_model *model = w->model;
    const struct track *at = w->tracks;
    put_u64(out, model->point_count);
    for (uint32_t p = 0; p < model->point_count; p++) {
        const struct orl_colmap_point *point = &model->points[p];
        const struct track *end = at;
        while (end->point == p)
            end++;
        put_u64(out, point->id);
        put_f64(out, point->position, 3);
        fwrite(point->rgb, 3, 1, out);
        put_f64(out, &point->error_px, 1);
        put_u64(out, (uint64_t)(end - at));
        for (; at < end; at++) {
            put_u32(out, at->image_id);
            put_u32(out, at->index);
        }
    }
}

enum orl_result orl_colmap_write(const struct orl_log *log, const char *dir,
                                 const struct orl_colmap_model *model, const bool *keep)
{
    static const struct {
        const char *name;
        void (*put)(FILE *out, const struct writing *w);
    } files[] = {{"cameras.bin", put_cameras}, {"images.bin", put_images},
                 {"points3D.bin", put_points}};
    struct writing w = {model, keep, NULL};
    enum orl_result result = list_tracks(log, &w);
    for (size_t i = 0; result == ORL_OK && i < ORL_COUNT(files); i++) {
        struct orl_atomic_file file;
        result = orl_atomic_open(log, ORL_PATH(dir, "%s", files[i].name), &file);
        if (result == ORL_OK) {
            files[i].put(file.stream, &w);
            result = orl_atomic_commit(log, &file);
        }
    }
    free(w.tracks);
    return result;
}
