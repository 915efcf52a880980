// Densify: depth maps of every photograph by photometric matching, then refined one or more times
// with the depth maps of its sources.
#include "preprocess/densify/densify.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>

#include "core/arguments.h"
#include "core/lock.h"
#include "core/memory.h"
#include "io/mask.h"
#include "io/picture.h"
#include "preprocess/densify/densify_internal.h"

ORL_OPTION_ROWS(orl_densify_options, orl_densify_params, ORL_DENSIFY_OPTIONS)

enum {
    LEVELS_MAX = 9, // pyramid levels of the reference; sources that show the scene finer have more
    COARSEST_SIDE = 100, // the shorter side of the coarsest level is at least this
    SPECKLE_SHARE = 2000, // connected pieces smaller than pixels / SPECKLE_SHARE are dropped
};

struct densifier {
    const struct orl_log *log;
    struct orl_gpu *gpu;
    struct orl_densify_params params; // params.sources: as many as fit
    int shrink;                       // number of times that the photographs are halved
    const struct orl_progress *progress;
    const char *workspace;
    const struct orl_colmap_model *model;
    struct orl_colmap_model own_model; // read here when the caller gives none
    struct densify_photos photos;
    size_t first, end; // photographs of this run: all, or those of its part
    struct densify_plan *plans;
    struct densify_cache cache;
    double done, total;
    int lock_fd;
};

static enum orl_result check_params(const struct orl_log *log, const struct orl_densify_params *p)
{
    for (const struct orl_option *row = orl_densify_options(); row->name; row++) {
        double value = row->kind == ORL_VALUE_INT ? orl_option_number(row, p) : row->low;
        if (value < row->low || value > row->high)
            return orl_fail(log, ORL_ERR_ARGUMENT, "densify: %s is %.0f, not within [%.0f, %.0f]",
                            row->name, value, row->low, row->high);
    }
    const struct orl_densify_part *part = p->part;
    if (part && (part->count < 1 || part->index < 0 || part->index >= part->count ||
                 part->pass < 0 || part->pass > p->geometric_passes))
        return orl_fail(log, ORL_ERR_ARGUMENT, "densify: no part %d of %d in pass %d of %d",
                        part->index, part->count, part->pass, p->geometric_passes + 1);
    return ORL_OK;
}

// --- passes ---

// A pass over the photographs, from 0 on, reads the maps of the previous pass and writes its own, both in
// stereo/*_maps/NAME.KIND.bin. All but the first are geometric: they use the sources' depths from the previous pass.

const char *orl_densify_pass_kind(int pass, int geometric_passes, char kind[ORL_DENSIFY_KIND_SIZE])
{
    if (pass > 0 && pass < geometric_passes)
        snprintf(kind, ORL_DENSIFY_KIND_SIZE, "agreed-%d", pass);
    else
        snprintf(kind, ORL_DENSIFY_KIND_SIZE, "%s", pass ? "geometric" : "photometric");
    return kind;
}

static bool is_last(const struct densifier *d, int pass)
{
    return pass == d->params.geometric_passes;
}

// --- files ---

#define PHOTO_PATH(d, photo) ORL_PATH((d)->workspace, "images/%s", densify_photo_name(&(d)->photos, photo))
// maps: depth, normal or confidence
#define MAP_PATH(d, maps, photo, pass) \
    ORL_PATH((d)->workspace, "stereo/%s_maps/%s.%s.bin", maps, densify_photo_name(&(d)->photos, photo), \
             orl_densify_pass_kind(pass, (d)->params.geometric_passes, (char[ORL_DENSIFY_KIND_SIZE]){""}))

static enum orl_result write_map(const struct densifier *d, const char *maps, size_t photo, int pass,
                                 const struct orl_image *map)
{
    const char *path = MAP_PATH(d, maps, photo, pass);
    // A photograph's name may contain folders.
    ORL_TRY(orl_file_make_folder(d->log, path));
    return orl_colmap_map_write(d->log, path, map);
}

static enum orl_result read_map(const struct densifier *d, const char *maps, size_t photo, int pass, int channels,
                                struct orl_image *map)
{
    const char *path = MAP_PATH(d, maps, photo, pass);
    enum orl_result result = orl_colmap_map_read(d->log, path, map);
    if (result == ORL_OK && map->channels != channels) {
        result = orl_fail(d->log, ORL_ERR_FORMAT, "%s: %d channels where %d are needed", path,
                          map->channels, channels);
        orl_image_finish(map);
    }
    return result;
}

// The depth map is written last: a photograph with a depth map has all of its maps.
static enum orl_result write_maps(const struct densifier *d, size_t photo, int pass,
                                  const struct densify_maps *maps)
{
    ORL_TRY(write_map(d, "normal", photo, pass, &maps->normal));
    if (is_last(d, pass))
        ORL_TRY(write_map(d, "confidence", photo, pass, &maps->confidence));
    return write_map(d, "depth", photo, pass, &maps->depth);
}

static bool has_maps(const struct densifier *d, size_t photo, int pass)
{
    return orl_path_is_file(MAP_PATH(d, "depth", photo, pass)) && orl_path_is_file(MAP_PATH(d, "normal", photo, pass));
}

static enum orl_result read_mask(const struct densifier *d, struct densify_job *job)
{
    const struct orl_image *picture = &job->reference->levels[0];
    if (!d->params.masks_dir)
        return ORL_OK;
    const char *path = ORL_PATH(d->params.masks_dir, "%s.png", job->name);
    if (!orl_path_is_file(path)) {
        orl_logf(d->log, ORL_LOG_WARNING, "%s: no mask; the whole photograph is used", path);
        return ORL_OK;
    }
    ORL_TRY(orl_mask_read(d->log, path, false, &job->mask));
    if (orl_densify_side(job->mask.width, d->shrink) != picture->width ||
        orl_densify_side(job->mask.height, d->shrink) != picture->height)
        return orl_fail(d->log, ORL_ERR_DATA, "%s: %dx%d, but its photograph is %dx%d", path,
                        job->mask.width, job->mask.height, picture->width, picture->height);
    return ORL_OK;
}

// --- one photograph ---

// FNV-1a hash of the name: a photograph's result is independent of the other photographs.
static uint32_t name_seed(uint32_t seed, const char *name)
{
    uint32_t hash = 2166136261u ^ seed;
    for (; *name; name++)
        hash = (hash ^ (uint8_t)*name) * 16777619u;
    return hash;
}

// Inverse depths of the photograph's sparse points at the coarsest level, spread to the pixels
// nearest to them.
static enum orl_result make_seeds(const struct densifier *d, size_t photo, struct densify_job *job)
{
    const struct orl_image *luma = &job->reference->levels[job->levels - 1];
    const struct orl_colmap_image *image = &d->model->images[d->photos.images[photo]];
    struct orl_view view = {.camera = orl_densify_level_camera(&job->reference->camera,
                                                               job->levels - 1),
                            .cam_from_world = job->view.cam_from_world};
    ORL_TRY(orl_image_init(d->log, &job->seeds, luma->width, luma->height, 1, ORL_PIXEL_F32));
    size_t pixels = (size_t)luma->width * (size_t)luma->height, filled = 0;
    size_t width = (size_t)luma->width, height = (size_t)luma->height;
    float *seeds = job->seeds.f32;
    size_t *queue = orl_array(d->log, pixels, sizeof *queue);
    ORL_TRY_MEMORY(queue);
    for (size_t k = 0; k < image->point_count; k++) {
        double pixel[2], depth;
        if (!orl_view_project(&view, d->model->points[image->points[k]].position, pixel, &depth) ||
            !(pixel[0] >= 0.0 && pixel[1] >= 0.0 && pixel[0] < (double)width &&
              pixel[1] < (double)height))
            continue;
        size_t at = (size_t)pixel[1] * width + (size_t)pixel[0];
        if (!(seeds[at] > 0.0f))
            queue[filled++] = at;
        seeds[at] = fmaxf(seeds[at], (float)(1.0 / depth));
    }
    for (size_t i = 0; i < filled; i++) {
        size_t at = queue[i], x = at % width, y = at / width;
        size_t near[4] = {at - 1, at + 1, at - width, at + width};
        bool there[4] = {x > 0, x + 1 < width, y > 0, y + 1 < height};
        for (int k = 0; k < 4; k++)
            if (there[k] && !(seeds[near[k]] > 0.0f)) {
                seeds[near[k]] = seeds[at];
                queue[filled++] = near[k];
            }
    }
    free(queue);
    return ORL_OK;
}

static void job_finish(struct densify_job *job)
{
    orl_image_finish(&job->mask);
    orl_image_finish(&job->seeds);
    for (int k = 0; k < ORL_DENSIFY_SOURCES_MAX; k++)
        orl_image_finish(&job->source_depths[k]);
}

static int level_count(int width, int height)
{
    int side = width < height ? width : height, levels = 1;
    while (levels < LEVELS_MAX && side >> levels >= COARSEST_SIDE)
        levels++;
    return levels;
}

static enum orl_result check_size(const struct densifier *d, const char *name,
                                  const struct densify_pyramid *pyramid,
                                  const struct orl_image *map)
{
    const struct orl_image *picture = &pyramid->levels[d->shrink];
    if (map->width == picture->width && map->height == picture->height)
        return ORL_OK;
    return orl_fail(d->log, ORL_ERR_DATA,
                    "%s: its maps are of another size; remove them to have them made again", name);
}

static enum orl_result read_source_depth(const struct densifier *d, int before, size_t photo, int slot,
                                         struct densify_job *job)
{
    struct orl_image *depth = &job->source_depths[slot];
    ORL_TRY(read_map(d, "depth", photo, before, 1, depth));
    return check_size(d, densify_photo_name(&d->photos, photo), job->sources[slot], depth);
}

static enum orl_result job_open(struct densifier *d, size_t photo, int pass, struct densify_job *job)
{
    const struct densify_plan *plan = &d->plans[photo];
    *job = (struct densify_job){
        .gpu = d->gpu,
        .params = &d->params,
        .name = densify_photo_name(&d->photos, photo),
        .seed = name_seed(d->params.seed, densify_photo_name(&d->photos, photo)),
        .view = d->photos.views[photo],
        .plan = plan,
        .finest = d->shrink,
        .draw = pass,
        .last = is_last(d, pass),
        .progress = d->progress,
        .done = d->done,
        .total = d->total,
    };
    d->cache.turn++;
    ORL_TRY(orl_densify_cache_get(&d->cache, photo, &job->reference));
    job->levels = level_count(job->reference->levels[0].width, job->reference->levels[0].height);
    if (pass || job->levels <= d->shrink)
        job->levels = d->shrink + 1;
    for (int k = 0; k < plan->count; k++) {
        size_t source = plan->sources[k].photo;
        job->source_views[k] = d->photos.views[source];
        ORL_TRY(orl_densify_cache_get(&d->cache, source, &job->sources[k]));
        if (pass)
            ORL_TRY(read_source_depth(d, pass - 1, source, k, job));
    }
    ORL_TRY(read_mask(d, job));
    if (!pass)
        ORL_TRY(make_seeds(d, photo, job));
    return ORL_OK;
}

// Writes maps without depth for a photograph that has no sources.
static enum orl_result write_empty(const struct densifier *d, size_t photo, int pass)
{
    struct densify_maps maps = {0};
    int width, height;
    ORL_TRY(orl_picture_size(d->log, PHOTO_PATH(d, photo), &width, &height));
    enum orl_result result =
        orl_densify_maps_init(d->log, width >> d->shrink, height >> d->shrink, &maps);
    ORL_THEN(result, write_maps(d, photo, pass, &maps));
    orl_densify_maps_finish(&maps);
    return result;
}

static enum orl_result read_start(const struct densifier *d, size_t photo, int before,
                                  const struct densify_job *job, struct densify_maps *start)
{
    ORL_TRY(read_map(d, "depth", photo, before, 1, &start->depth));
    ORL_TRY(read_map(d, "normal", photo, before, 3, &start->normal));
    ORL_TRY(check_size(d, job->name, job->reference, &start->depth));
    return check_size(d, job->name, job->reference, &start->normal);
}

// What is done to the maps of the last pass.
static enum orl_result clean(const struct densifier *d, const struct densify_job *job,
                             struct densify_maps *maps)
{
    size_t pixels = (size_t)maps->depth.width * (size_t)maps->depth.height;
    struct orl_camera camera = orl_densify_level_camera(&job->reference->camera, job->finest);
    ORL_TRY(orl_densify_remove_speckles(d->log, &camera, maps, pixels / SPECKLE_SHARE));
    ORL_TRY(orl_densify_trim_outlines(d->log, &camera, &job->reference->levels[job->finest], maps));
    return orl_densify_complete(d->log, job, maps);
}

static enum orl_result process(struct densifier *d, size_t photo, int pass)
{
    struct densify_maps start = {0}, maps = {0};
    struct densify_job job;
    enum orl_result result = job_open(d, photo, pass, &job);
    job.start = &start;
    if (pass)
        ORL_THEN(result, read_start(d, photo, pass - 1, &job, &start));
    ORL_THEN(result, pass ? orl_densify_geometric(&job, &maps) : orl_densify_photometric(&job, &maps));
    if (job.last)
        ORL_THEN(result, clean(d, &job, &maps));
    ORL_THEN(result, write_maps(d, photo, pass, &maps));
    orl_densify_maps_finish(&start);
    orl_densify_maps_finish(&maps);
    job_finish(&job);
    return result;
}

static enum orl_result process_all(struct densifier *d, int pass)
{
    for (size_t i = d->first; i < d->end; i++) {
        const char *name = densify_photo_name(&d->photos, i);
        bool has = has_maps(d, i, pass);
        if (orl_progress_cancelled(d->progress))
            return ORL_ERR_CANCELLED;
        orl_progress_report(d->progress, "densify", d->done, d->total, name);
        if (!has && !d->plans[i].count) {
            if (!pass)
                orl_logf(d->log, ORL_LOG_WARNING,
                         "%s: too little in common with the other photographs; no depth", name);
            ORL_TRY(write_empty(d, i, pass));
        } else if (!has) {
            ORL_TRY(process(d, i, pass));
        }
        d->done += 1.0;
        orl_progress_report(d->progress, "densify", d->done, d->total, name);
    }
    return ORL_OK;
}

// --- all of it ---

// Removes the maps between the first and the last pass, which are not needed after the run.
static void remove_intermediate(const struct densifier *d)
{
    for (size_t i = 0; i < d->photos.count; i++)
        for (int p = 1; p < d->params.geometric_passes; p++) {
            remove(MAP_PATH(d, "depth", i, p));
            remove(MAP_PATH(d, "normal", i, p));
        }
}

static enum orl_result process_passes(struct densifier *d)
{
    const struct orl_densify_part *part = d->params.part;
    const int passes = d->params.geometric_passes + 1;
    bool all = true;
    for (size_t i = d->first; i < d->end && all; i++)
        all = has_maps(d, i, passes - 1);
    d->total = (double)(d->end - d->first) * (part ? 1 : passes);
    for (int p = 0; p < passes && !all; p++)
        if (!part || p == part->pass)
            ORL_TRY(process_all(d, p));
    // Other parts may still read the maps between the passes.
    if (!part)
        remove_intermediate(d);
    return ORL_OK;
}

static enum orl_result check_plans(const struct densifier *d)
{
    for (size_t i = 0; i < d->photos.count; i++)
        if (d->plans[i].count)
            return ORL_OK;
    return orl_fail(d->log, ORL_ERR_DATA,
                    "none of the %zu photographs shares enough with another from a different "
                    "place: take more photographs, walking sideways between them so that "
                    "neighbours overlap by two thirds or more", d->photos.count);
}

// Chooses the number of sources and the size that the device's memory allows, and logs both.
static enum orl_result plan_memory(struct densifier *d)
{
    struct densify_need need = {.padding = orl_densify_padding(&d->params),
                                .geometric = d->params.geometric_passes > 0};
    struct densify_budget budget;
    int width, height, asked = d->params.sources;
    for (size_t i = 0; i < d->photos.count; i++) {
        ORL_TRY(orl_picture_size(d->log, PHOTO_PATH(d, i), &width, &height));
        need.width = width > need.width ? width : need.width;
        need.height = height > need.height ? height : need.height;
        int side = width < height ? width : height;
        need.min_side = i == 0 || side < need.min_side ? side : need.min_side;
    }
    const size_t most = d->params.max_vram_bytes;
    bool fits = orl_densify_fit(&need, asked, most, &budget);
    if (!fits && (!most || budget.bytes <= most))
        return orl_fail(d->log, ORL_ERR_GPU,
                        "densify: a photograph of %dx%d is larger than textures of the device can be, and one with "
                        "a side of %d cannot be halved with it", need.width, need.height, need.min_side);
    if (!fits)
        return orl_fail(d->log, ORL_ERR_GPU,
                        "densify: %zu MiB of device memory are not enough for a photograph of "
                        "%dx%d: the least is %.1f MiB", most >> 20, need.width, need.height,
                        (double)budget.bytes / (1 << 20));
    d->params.sources = budget.sources;
    d->shrink = d->cache.shrink = budget.shrink;
    bool less = budget.sources < asked || budget.shrink > 0;
    if (less)
        orl_logf(d->log, ORL_LOG_WARNING,
                 "densify: %d sources at %dx%d need larger textures than every device has, or %.0f MiB of device "
                 "memory; using less", asked, need.width, need.height,
                 (double)orl_densify_bytes(&need, asked, 0) / (1 << 20));
    orl_logf(d->log, ORL_LOG_INFO, "densify: up to %.0f MiB on the device: %d sources, %dx%d",
             (double)budget.bytes / (1 << 20), budget.sources, need.width >> budget.shrink,
             need.height >> budget.shrink);
    return ORL_OK;
}

// What COLMAP's fusion reads, unless prepare, COLMAP or the user has listed photographs already.
static enum orl_result write_fusion_list(const struct densifier *d)
{
    const char *path = ORL_PATH(d->workspace, "stereo/fusion.cfg");
    struct orl_atomic_file file;
    if (orl_path_is_file(path))
        return ORL_OK;
    ORL_TRY(orl_atomic_open(d->log, path, &file));
    for (size_t i = 0; i < d->photos.count; i++)
        fprintf(file.stream, "%s\n", densify_photo_name(&d->photos, i));
    return orl_atomic_commit(d->log, &file);
}

static enum orl_result open_workspace(struct densifier *d, const struct orl_names *names)
{
    d->model = d->params.model ? d->params.model : &d->own_model;
    if (!d->params.model)
        ORL_TRY(orl_colmap_read(d->log, ORL_PATH(d->workspace, "sparse"), &d->own_model));
    ORL_TRY(orl_densify_photos_init(d->log, d->model, names, &d->photos));
    const struct orl_densify_part all = {.count = 1}, *part = d->params.part ? d->params.part : &all;
    d->first = d->photos.count * (size_t)part->index / (size_t)part->count;
    d->end = d->photos.count * ((size_t)part->index + 1) / (size_t)part->count;
    ORL_TRY(plan_memory(d));
    ORL_TRY(orl_densify_plans_make(d->log, &d->photos, d->params.sources, &d->plans));
    ORL_TRY(check_plans(d));
    if (d->params.part)
        return orl_densify_check_maps(d->log, d->workspace, &d->params, d->shrink);
    ORL_TRY(orl_densify_claim_maps(d->log, d->workspace, &d->photos, &d->params, d->shrink));
    ORL_TRY(orl_dir_make(d->log, ORL_PATH(d->workspace, "stereo/depth_maps")));
    ORL_TRY(orl_dir_make(d->log, ORL_PATH(d->workspace, "stereo/normal_maps")));
    ORL_TRY(orl_dir_make(d->log, ORL_PATH(d->workspace, "stereo/confidence_maps")));
    return write_fusion_list(d);
}

// Two densifiers in one workspace would overwrite each other's maps, but for parts.
static enum orl_result lock_workspace(struct densifier *d)
{
    bool taken;
    ORL_TRY(orl_lock(d->log, d->workspace, d->params.part, &d->lock_fd, &taken));
    return taken ? orl_fail(d->log, ORL_ERR_ARGUMENT, "%s: another oriel densify is at work here", d->workspace)
                 : ORL_OK;
}

static void close_densifier(struct densifier *d)
{
    orl_densify_cache_finish(&d->cache);
    free(d->plans);
    orl_densify_photos_finish(&d->photos);
    orl_colmap_finish(&d->own_model);
    orl_unlock(&d->lock_fd);
}

static enum orl_result open_densifier(struct densifier *d, const struct orl_names *photos)
{
    ORL_TRY(check_params(d->log, &d->params));
    ORL_TRY(lock_workspace(d));
    return open_workspace(d, photos);
}

enum orl_result orl_densify(struct orl_gpu *gpu, const char *workspace,
                            const struct orl_names *photos,
                            const struct orl_densify_params *params,
                            const struct orl_progress *progress)
{
    struct densifier d = {.log = orl_gpu_log(gpu), .gpu = gpu, .params = *params,
                          .progress = progress, .workspace = workspace, .lock_fd = -1};
    d.cache = (struct densify_cache){.log = d.log, .photos = &d.photos, .images_dir = ORL_PATH(workspace, "images")};
    enum orl_result result = open_densifier(&d, photos);
    ORL_THEN(result, process_passes(&d));
    close_densifier(&d);
    return result;
}

enum orl_result orl_densify_begin(const struct orl_log *log, const char *workspace,
                                  const struct orl_names *photos,
                                  const struct orl_densify_params *params)
{
    struct densifier d = {.log = log, .params = *params, .workspace = workspace, .lock_fd = -1};
    enum orl_result result = open_densifier(&d, photos);
    close_densifier(&d);
    return result;
}
