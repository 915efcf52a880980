// Writing points.lod: parts of the Morton curve, one after the other, are given radii, limited and
// sorted into blocks.
#include <stdlib.h>
#include <sys/statvfs.h>

#include "core/file.h"
#include "scene/point_lod_internal.h"
#include "scene/point_parts.h"
#include "scene/point_stream.h"

struct writer {
    const struct orl_log *log;
    const struct orl_progress *progress;
    const struct orl_lod_params *params;
    const char *path;
    struct point_parts parts;
    struct orl_disc_sizes sizes;
    struct orl_radii_limits limits;
    struct orl_atomic_file out;
    struct lod_levels *levels;
};

static enum orl_result for_parts(struct writer *w, const char *step,
                                 enum orl_result (*use)(struct writer *w, size_t part))
{
    enum orl_result result = ORL_OK;
    uint64_t done = 0;
    for (size_t i = 0; result == ORL_OK && i < w->parts.count; i++) {
        orl_progress_report(w->progress, step, (double)done, (double)w->parts.total, NULL);
        result = orl_progress_cancelled(w->progress) ? ORL_ERR_CANCELLED : use(w, i);
        done += orl_point_parts_own(&w->parts, i);
    }
    orl_progress_report(w->progress, step, (double)w->parts.total, (double)w->parts.total, NULL);
    return result;
}

// --- radii ---

static enum orl_result set_radii(struct writer *w, size_t part)
{
    const struct orl_lod_params *params = w->params;
    struct orl_points points = {0};
    float *scales = NULL;
    enum orl_result result = orl_point_parts_read(&w->parts, part, true, &points, &scales);
    size_t own = orl_point_parts_own(&w->parts, part);
    ORL_THEN(result, orl_points_set_some_radii(w->log, NULL, &params->radii, params->views,
                                               params->view_count, own, &points));
    if (result == ORL_OK) {
        points.count = own;
        orl_disc_sizes_add(&w->sizes, params->views, params->view_count, &points, scales);
        result = orl_point_parts_write(&w->parts, part, &points, scales);
    }
    orl_points_finish(&points);
    free(scales);
    return result;
}

static enum orl_result find_radii(struct writer *w)
{
    const struct orl_lod_params *params = w->params;
    const struct orl_radii_limits limits = orl_radii_limits_of(&params->radii);
    if (!w->parts.flat)
        return ORL_OK;
    ORL_TRY(orl_disc_sizes_init(w->log, &w->sizes));
    ORL_TRY(for_parts(w, "radii", set_radii));
    w->limits = orl_radii_limits_widened(&limits, &w->sizes);
    return ORL_OK;
}

// --- blocks ---

static enum orl_result add_blocks(struct writer *w, size_t part)
{
    struct orl_points points = {0};
    float *scales = NULL;
    uint32_t *order = NULL;
    size_t count = 0;
    enum orl_result result = orl_point_parts_read(&w->parts, part, false, &points, &scales);
    if (result == ORL_OK && w->parts.flat)
        orl_points_apply_limits(&w->limits, scales, &points);
    if (result == ORL_OK) {
        orl_points_drop_flat(&points);
        result = orl_point_order(w->log, &points, &w->parts.cube, &order, &count);
    }
    for (size_t i = 0; result == ORL_OK && i < count; i += ORL_BLOCK_POINTS) {
        struct point_block block;
        orl_point_block_make(&points, order + i, &block);
        result = orl_lod_levels_add(w->levels, &block);
    }
    free(order);
    free(scales);
    orl_points_finish(&points);
    return result;
}

// --- the whole ---

uint64_t orl_lod_most_in_memory(size_t max_bytes)
{
    return orl_point_parts_max(max_bytes);
}

// Says how much disk is needed before any of it is taken.
static enum orl_result check_disk(const struct writer *w, const char *ply)
{
    static const double page_bytes = 12.5, coarser = 2.0 / 7; // of a point; the coarser levels twice
    struct orl_point_stream *stream = NULL;
    struct statvfs disk;
    uint64_t total = 0;
    enum orl_result result = orl_point_stream_open(w->log, ply, &stream, &total);
    orl_point_stream_close(&stream);
    if (result != ORL_OK || fstatvfs(w->out.fd, &disk) != 0)
        return result; // the size of some file systems is unknown
    double have = (double)disk.f_bavail * (double)disk.f_frsize;
    double pages = (double)total * page_bytes * (1 + coarser);
    double need = orl_point_parts_bytes((double)total) + pages;
    if (need > have)
        return orl_fail(w->log, ORL_ERR_IO, "%s: sorting %llu points takes about %.0f MiB and the "
                        "disk has %.0f MiB left", w->path, (unsigned long long)total,
                        need / (1 << 20), have / (1 << 20));
    orl_logf(w->log, ORL_LOG_INFO, "%s: sorting %llu points takes about %.0f MiB of disk; %.0f MiB "
             "are free", w->path, (unsigned long long)total, need / (1 << 20), have / (1 << 20));
    return ORL_OK;
}

static enum orl_result begin(struct writer *w)
{
    ORL_TRY(orl_atomic_open(w->log, w->path, &w->out));
    if (fseeko(w->out.stream, LOD_PAGES_AT, SEEK_SET) != 0)
        return orl_file_failed(w->log, w->path);
    return orl_lod_levels_begin(w->log, w->path, w->out.stream, &w->levels);
}

static void finish(struct writer *w)
{
    orl_lod_levels_destroy(&w->levels);
    orl_atomic_abort(&w->out);
    orl_point_parts_finish(&w->parts);
    orl_disc_sizes_finish(&w->sizes);
}

enum orl_result orl_lod_write(const struct orl_log *log, const struct orl_progress *progress,
                              const struct orl_lod_params *params, const char *ply,
                              const char *path)
{
    struct writer w = {.log = log, .progress = progress, .params = params, .path = path,
                       .parts = {.fd = -1}};
    enum orl_result result = begin(&w);
    if (result == ORL_OK && (result = check_disk(&w, ply)) == ORL_OK &&
        (result = orl_point_parts_make(log, progress, ply, path, params->max_bytes,
                                       &w.parts)) == ORL_OK &&
        (result = find_radii(&w)) == ORL_OK &&
        (result = for_parts(&w, "blocks", add_blocks)) == ORL_OK)
        result = orl_lod_levels_end(w.levels);
    ORL_THEN(result, orl_atomic_commit(log, &w.out));
    finish(&w);
    return result;
}
