#include "preprocess/cloud/fuse_photographs.h"

#include <stdlib.h>

#include "bridge/bridge.h"
#include "core/file.h"
#include "core/memory.h"
#include "core/order.h"
#include "io/picture.h"
#include "preprocess/cloud/fuse_maps.h"
#include "preprocess/cloud/fuse_memory.h"
#include "preprocess/job/threads.h"

// A photograph of the fusion.
struct source {
    const struct orl_colmap_image *image; // of the model
    uint32_t *others;                     // the sources that it is compared with; owned
    size_t other_count;
    struct orl_fused_pixels found;
    size_t first; // of its points
};

struct fusion {
    const struct orl_job *job;
    const struct orl_colmap_model *model;
    struct source *sources;     // owned
    struct orl_depth_map *maps; // owned; of each source
    size_t count;
    struct orl_points *points;
    size_t at_once; // whose normals and colours are read
    double done, total; // of the progress; done grows to what follows this fusion
};

// --- what is compared with what ---

static enum orl_result find_others(struct fusion *f)
{
    const struct orl_log *log = f->job->log;
    size_t *shared = orl_array(log, f->model->image_count, sizeof *shared);
    struct orl_ranked *overlaps = orl_array(log, f->count, sizeof *overlaps);
    enum orl_result result = shared && overlaps ? ORL_OK : ORL_ERR_MEMORY;
    for (size_t i = 0; result == ORL_OK && i < f->count; i++) {
        struct source *s = &f->sources[i];
        if ((result = orl_colmap_count_shared(log, f->model, s->image, shared)) != ORL_OK)
            break;
        for (size_t k = 0; k < f->count; k++)
            overlaps[k] = (struct orl_ranked){-(double)shared[f->sources[k].image - f->model->images], k};
        qsort(overlaps, f->count, sizeof *overlaps, orl_order_ranked);
        s->others = orl_array(log, ORL_FUSE_OTHERS, sizeof *s->others);
        if (!s->others)
            result = ORL_ERR_MEMORY;
        // Those without a point in common may still show the same surface where points are few.
        for (size_t k = 0; result == ORL_OK && k < f->count && s->other_count < ORL_FUSE_OTHERS; k++)
            if (overlaps[k].index != i)
                s->others[s->other_count++] = (uint32_t)overlaps[k].index;
    }
    free(shared);
    free(overlaps);
    return result;
}

// --- steps, each for one source ---

// Takes the depth where the photograph's mask is 0: the subject is not there.
static enum orl_result apply_mask(const struct orl_job *job, const char *name,
                                  struct orl_image *depth)
{
    struct orl_image mask = {0};
    const char *path = ORL_PATH(job->dir, "masks/%s.png", name);
    enum orl_result result = orl_path_is_file(path) ? orl_picture_read(job->log, path, 1, &mask) : ORL_OK;
    for (int y = 0; mask.u8 && y < depth->height; y++)
        for (int x = 0; x < depth->width; x++) {
            // At the middle of the depth map's pixel, which may be several wide in the mask.
            size_t u = (2 * (size_t)x + 1) * (size_t)mask.width / (2 * (size_t)depth->width);
            size_t v = (2 * (size_t)y + 1) * (size_t)mask.height / (2 * (size_t)depth->height);
            if (mask.u8[v * (size_t)mask.width + u] == 0)
                depth->f32[(size_t)y * (size_t)depth->width + (size_t)x] = 0;
        }
    orl_image_finish(&mask);
    return result;
}

enum orl_result orl_fuse_read_map(const struct orl_job *job, const struct orl_colmap_model *model,
                                  const struct orl_colmap_image *image, struct orl_depth_map *map)
{
    const char *path = ORL_PATH(job->dir, "stereo/depth_maps/%s.geometric.bin", image->name);
    if (orl_path_is_file(path)) // COLMAP writes no map without sources
        ORL_TRY(orl_colmap_map_read(job->log, path, &map->depth));
    if (!map->depth.f32)
        return ORL_OK;
    map->view = orl_colmap_image_view(model, image);
    map->view.camera = orl_camera_resized(&map->view.camera, map->depth.width, map->depth.height);
    return job->params->masks_dir ? apply_mask(job, image->name, &map->depth) : ORL_OK;
}

static enum orl_result read_depth(void *priv, size_t i)
{
    const struct fusion *f = priv;
    return orl_fuse_read_map(f->job, f->model, f->sources[i].image, &f->maps[i]);
}

static enum orl_result find_pixels(void *priv, size_t i)
{
    const struct fusion *f = priv;
    const struct source *s = &f->sources[i];
    if (!f->maps[i].depth.f32)
        return ORL_OK;
    return orl_fuse_pixels_find(f->job->log, f->maps, i, s->others, s->other_count,
                                &f->sources[i].found);
}

static enum orl_result write_pixels(void *priv, size_t i)
{
    const struct fusion *f = priv;
    const struct orl_job *job = f->job;
    const struct source *s = &f->sources[i];
    const struct orl_image *depth = &f->maps[i].depth;
    struct orl_image normal = {0}, whole = {0}, picture = {0};
    if (s->found.count == 0)
        return ORL_OK;
    const char *normals = ORL_PATH(job->dir, "stereo/normal_maps/%s.geometric.bin", s->image->name);
    enum orl_result result = orl_colmap_map_read(job->log, normals, &normal);
    if (result == ORL_OK && (normal.width != depth->width || normal.height != depth->height ||
                             normal.channels != 3))
        result = orl_fail(job->log, ORL_ERR_FORMAT, "%s: not of the size of the depth map, %dx%d",
                          normals, depth->width, depth->height);
    ORL_THEN(result, orl_picture_read(job->log, ORL_PATH(job->dir, "images/%s", s->image->name), 3, &whole));
    ORL_THEN(result, orl_bridge_resize(job->log, &whole, depth->width, depth->height, &picture));
    if (result == ORL_OK)
        orl_fuse_pixels_write(&f->maps[i], &s->found, &normal, &picture, s->first, f->points);
    orl_image_finish(&normal);
    orl_image_finish(&whole);
    orl_image_finish(&picture);
    return result;
}

// Runs a third of the work, one source after the other or side by side (in `threads`, 0: on all processors): the
// points are the same.
static enum orl_result run(struct fusion *f, enum orl_result (*step)(void *priv, size_t source), size_t threads)
{
    enum orl_result result = orl_threads_each(&(struct orl_each){
        .work = step, .priv = f, .count = f->count, .threads = threads, .progress = f->job->progress, .step = "fuse",
        .done = f->done, .share = 1 / 3.0, .total = f->total});
    f->done += 1 / 3.0;
    return result;
}

// --- all of it ---

static enum orl_result make_points(struct fusion *f, struct orl_points *points)
{
    size_t count = 0;
    for (size_t i = 0; i < f->count; i++) {
        f->sources[i].first = count;
        count += f->sources[i].found.count;
    }
    if (count == 0)
        return orl_fail(f->job->log, ORL_ERR_DATA,
                        "no surface was found that two photographs agree on: take photographs "
                        "closer together, of textured and matt surfaces, or with --quality high");
    f->points = points;
    return orl_points_init(f->job->log, points, count);
}

// Decides how many photographs are read at once, and warns where the fusion takes more than it may.
static void plan_memory(struct fusion *f, const struct orl_names *names)
{
    const struct orl_job *job = f->job;
    double pixels = orl_fuse_pixels(f->model, names), needs = orl_fuse_bytes(pixels);
    double budget = orl_fuse_budget(job->params->max_ram_bytes);
    f->at_once = orl_fuse_at_once(pixels, names->count, budget);
    if (needs > budget)
        orl_logf(job->log, ORL_LOG_WARNING, "fuse: %.0f MiB are not enough for %zu photographs; it "
                 "takes about %.0f MiB; --fuse-cluster fuses fewer photographs at a time",
                 budget / (1 << 20), names->count, needs / (1 << 20));
}

enum orl_result orl_fuse_photographs(struct orl_job *job, const struct orl_colmap_model *model,
                                     const struct orl_names *names, double done, double total,
                                     struct orl_points *points)
{
    struct fusion f = {.job = job, .model = model, .done = done, .total = total};
    *points = (struct orl_points){0};
    plan_memory(&f, names);
    f.sources = orl_array(job->log, model->image_count + 1, sizeof *f.sources);
    f.maps = orl_array(job->log, model->image_count + 1, sizeof *f.maps);
    enum orl_result result = f.sources && f.maps ? ORL_OK : ORL_ERR_MEMORY;
    for (size_t i = 0; result == ORL_OK && i < model->image_count; i++)
        if (orl_names_contain(names, model->images[i].name))
            f.sources[f.count++].image = &model->images[i];
    ORL_THEN(result, find_others(&f));
    ORL_THEN(result, run(&f, read_depth, 0));
    ORL_THEN(result, run(&f, find_pixels, 0));
    ORL_THEN(result, make_points(&f, points));
    ORL_THEN(result, run(&f, write_pixels, f.at_once));
    for (size_t i = 0; i < f.count; i++) {
        free(f.sources[i].others);
        orl_fused_pixels_finish(&f.sources[i].found);
        orl_image_finish(&f.maps[i].depth);
    }
    free(f.sources);
    free(f.maps);
    if (result != ORL_OK)
        orl_points_finish(points);
    return result;
}
