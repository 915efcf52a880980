// oriel lod: a cloud larger than memory, with levels of detail.
#include <stdio.h>
#include <stdlib.h>

#include "cli/command.h"
#include "core/file.h"
#include "oriel/scene.h"
#include "scene/point_lod.h"

#define LOD_OPTIONS(ROW) \
    ROW(points, "points", TEXT("FILE"), "a binary PLY in the scene's frame; default: SCENE/points.ply") \
    ROW(max_ram_bytes, "max-ram", MIB(1 << 24), \
        "memory to keep to, about; default: half of what is free")
COMMAND_OPTIONS(lod_options, LOD_OPTIONS)

static enum orl_result report(const struct orl_log *log, const char *path)
{
    struct orl_lod *lod;
    enum orl_result result = orl_lod_open(log, path, &lod);
    if (result == ORL_OK)
        printf("%s: %llu points in %zu pages of %d levels\n", path,
               (unsigned long long)lod->points, lod->page_count, lod->level_count);
    orl_lod_close(&lod);
    return result;
}

static enum orl_result run_lod(struct call *call)
{
    const struct lod_options *o = call->options;
    const struct orl_log *log = call->log;
    const char *dir = call->inputs[0];
    struct orl_view *views = NULL;
    const char *from = o->points ? o->points : ORL_PATH(dir, "points.ply"), *to = ORL_PATH(dir, ORL_LOD_NAME);
    struct orl_lod_params params = {ORL_LOD_DEFAULTS, .max_bytes = o->max_ram_bytes};
    enum orl_result result = orl_scene_open_photos(log, dir, &call->scene);
    ORL_THEN(result, orl_scene_training_views(log, call->scene, &views, &params.view_count));
    params.views = views;
    ORL_THEN(result, orl_lod_write(log, call->progress, &params, from, to));
    if (result == ORL_OK && !call->common->quiet)
        result = report(log, to);
    free(views);
    return result;
}

const struct command command_lod = {
    .name = "lod", .group = COMMAND_MAKE,
    .brief = "levels of detail for points that are more than memory holds",
    .usage = "SCENE [--points FILE] [--max-ram MIB]",
    .summary = "Writes SCENE/points.lod: all points in levels of detail, of which each frame reads what\n"
               "it shows. So a cloud may be larger than memory and than the device. Where there is such a\n"
               "file, points.ply is not read and may be removed.",
    COMMAND_TABLE(lod_options), .inputs_min = 1, .inputs_max = 1, .run = run_lod,
};
