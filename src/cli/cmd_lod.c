// oriel lod: a cloud larger than memory, with levels of detail.
#include <stdio.h>
#include <stdlib.h>

#include "cli/commands.h"
#include "core/file.h"
#include "core/memory.h"
#include "oriel/scene.h"
#include "scene/point_lod.h"

struct options {
    const char *points;
    int max_ram_mib;
};

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

static enum orl_result run(const struct terminal *terminal, const void *options,
                           const struct arg_common *common, const char *dir)
{
    const struct options *o = options;
    const struct orl_log *log = &terminal->log;
    struct orl_scene *scene = NULL;
    struct orl_view *views = NULL;
    char *from = NULL, *to = orl_path_join(log, dir, ORL_LOD_NAME);
    struct orl_lod_params params = {ORL_LOD_DEFAULTS, .max_bytes = (size_t)o->max_ram_mib << 20};
    enum orl_result result = to ? orl_scene_open_photos(log, dir, &scene) : ORL_ERR_MEMORY;
    if (result == ORL_OK)
        result = orl_scene_training_views(log, scene, &views, &params.view_count);
    params.views = views;
    if (result == ORL_OK) {
        from = o->points ? orl_strdup(log, o->points) : orl_path_join(log, dir, "points.ply");
        result = from ? ORL_OK : ORL_ERR_MEMORY;
    }
    if (result == ORL_OK)
        result = orl_lod_write(log, &terminal->progress, &params, from, to);
    if (result == ORL_OK && !common->quiet)
        result = report(log, to);
    free(from);
    free(to);
    free(views);
    orl_scene_destroy(&scene);
    return result;
}

int cmd_lod(int argc, char **argv)
{
    struct options o = {0};
    const struct arg_option table[] = {
        {"points", ARG_STRING, &o.points, "FILE",
         "a binary PLY in the scene's frame; default: SCENE/points.ply", 0, 0},
        {"max-ram", ARG_INT, &o.max_ram_mib, "MIB",
         "memory to keep to, about; default: half of what is free", 1, 1 << 24},
        {0},
    };
    const struct arg_command command = {
        "lod", "SCENE [--points FILE] [--max-ram MIB]",
        "Writes SCENE/points.lod: all points in levels of detail, of which each frame reads what\n"
        "it shows. So a cloud may be larger than memory and than the device. Where there is such a\n"
        "file, points.ply is not read and may be removed.",
        table, 1, 1};
    return command_main(&command, argc, argv, run, &o);
}
