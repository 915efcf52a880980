// oriel densify: depth and normal maps for a COLMAP workspace, instead of colmap
// patch_match_stereo.
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "cli/commands.h"
#include "preprocess/densify/densify.h"
#include "scene/colmap.h"

struct options {
    struct orl_names exclude;
    const char *photos, *part;
    struct orl_densify_params params;
    int seed, max_vram_mib, pass;
};

// Reads names, one a line.
static enum orl_result read_names(const struct orl_log *log, const char *path,
                                  struct orl_names *names)
{
    uint8_t *data;
    size_t size;
    enum orl_result result = orl_file_read(log, path, (size_t)1 << 30, &data, &size);
    char *rest = NULL;
    for (char *line = result == ORL_OK ? strtok_r((char *)data, "\r\n", &rest) : NULL;
         result == ORL_OK && line; line = strtok_r(NULL, "\r\n", &rest))
        result = orl_names_add(log, names, line);
    free(data);
    return result;
}

// Lists the workspace's photographs that are not excluded.
static enum orl_result choose_photos(const struct orl_log *log, const char *workspace,
                                     const struct orl_colmap_model *model,
                                     const struct options *o, struct orl_names *photos)
{
    const struct orl_names *exclude = &o->exclude;
    size_t excluded = 0;
    if (o->photos)
        return read_names(log, o->photos, photos);
    enum orl_result result = ORL_OK;
    for (size_t i = 0; result == ORL_OK && i < model->image_count; i++) {
        if (orl_names_contain(exclude, model->images[i].name))
            excluded++;
        else
            result = orl_names_add(log, photos, model->images[i].name);
    }
    if (result == ORL_OK && excluded < exclude->count)
        result = orl_fail(log, ORL_ERR_NOT_FOUND, "--exclude: %s has no photograph of some name",
                          workspace);
    return result;
}

static enum orl_result densify(const struct terminal *terminal, const struct options *o,
                               const struct arg_common *common, const char *workspace,
                               const struct orl_densify_params *asked)
{
    const struct orl_log *log = &terminal->log;
    struct orl_colmap_model model = {0};
    struct orl_names photos = {0};
    struct orl_gpu *gpu = NULL;
    char *sparse = orl_path_join(log, workspace, "sparse");
    enum orl_result result = sparse ? orl_colmap_read(log, sparse, &model) : ORL_ERR_MEMORY;
    struct orl_densify_params params = *asked;
    params.model = &model;
    if (result == ORL_OK)
        result = choose_photos(log, workspace, &model, o, &photos);
    if (result == ORL_OK)
        result = orl_gpu_create(log, &(struct orl_gpu_params){.shader_dir = common->shader_dir,
                                                              .debug = common->verbose}, &gpu);
    if (result == ORL_OK)
        result = orl_densify(gpu, workspace, &photos, &params, &terminal->progress);
    orl_gpu_destroy(&gpu);
    orl_names_finish(&photos);
    orl_colmap_finish(&model);
    free(sparse);
    return result;
}

static enum orl_result run(const struct terminal *terminal, const void *options,
                           const struct arg_common *common, const char *workspace)
{
    const struct options *o = options;
    const struct orl_log *log = &terminal->log;
    struct orl_densify_params params = o->params;
    struct orl_densify_part part = {.pass = o->pass};
    bool whole = false;
    params.seed = (uint32_t)o->seed;
    params.max_vram_bytes = (size_t)o->max_vram_mib << 20;
    if (o->photos && o->exclude.count)
        return orl_fail(log, ORL_ERR_ARGUMENT, "--photos and --exclude exclude each other");
    enum orl_result result = o->part ? args_part(log, o->part, &part.index, &part.count)
                                     : ORL_OK;
    if (result == ORL_OK && o->part)
        result = command_is_whole(log, workspace, &whole);
    params.part = o->part ? &part : NULL;
    if (result != ORL_OK || !whole)
        return result == ORL_OK ? densify(terminal, o, common, workspace, &params) : result;
    orl_logf(log, ORL_LOG_INFO, "%s: a whole scene, so there is nothing left to do", workspace);
    return ORL_OK;
}

int cmd_densify(int argc, char **argv)
{
    struct options o = {.params = {ORL_DENSIFY_DEFAULTS}, .seed = 1};
    const struct arg_option table[] = {
        {"exclude", ARG_LIST, &o.exclude, "A,B", "photographs to leave out altogether", 0, 0},
        {"photos", ARG_STRING, &o.photos, "FILE",
         "the photographs to use, a name a line; default: all", 0, 0},
        {"part", ARG_STRING, &o.part, "K/N",
         "only the K-th of N parts of one pass (oriel plan)", 0, 0},
        {"pass", ARG_INT, &o.pass, "P", "of --part; 0: photometric, then geometric ones", 0, 8},
        {"masks", ARG_STRING, &o.params.masks_dir, "DIR",
         "DIR/NAME.png: no depth where it is 0", 0, 0},
        {"sources", ARG_INT, &o.params.sources, "N", "source photographs each; default 8", 1, 16},
        {"iterations", ARG_INT, &o.params.iterations, "N", "photometric sweeps; default 4", 1, 16},
        {"geometric-passes", ARG_INT, &o.params.geometric_passes, "N",
         "sweeps with geometric consistency; default 2", 0, 8},
        {"window-radius", ARG_INT, &o.params.window_radius, "PX", "patch radius; default 5", 1, 15},
        {"window-step", ARG_INT, &o.params.window_step, "PX", "patch sampling; default 2", 1, 4},
        {"seed", ARG_INT, &o.seed, "N", "of the random hypotheses; default 1", 0, 1 << 30},
        {"max-vram", ARG_INT, &o.max_vram_mib, "MIB", "device memory to plan for", 1, 1 << 20},
        {0},
    };
    const struct arg_command command = {
        "densify", "WORKSPACE [options]",
        "Writes stereo/depth_maps and stereo/normal_maps of a COLMAP undistorted workspace, as\n"
        "colmap patch_match_stereo does, without CUDA. Photographs that have maps of these\n"
        "settings are skipped, so that an interrupted run goes on. colmap stereo_fusion reads the\n"
        "result. stereo/confidence_maps says how sure each depth is.",
        table, 1, 1};
    int status = command_main(&command, argc, argv, run, &o);
    orl_names_finish(&o.exclude);
    return status;
}
