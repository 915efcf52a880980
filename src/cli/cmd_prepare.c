#include <stdio.h>
#include <string.h>

#include "cli/commands.h"
#include "cli/summary.h"
#include "oriel/prepare.h"

enum { INPUTS_MAX = 4096 };

struct options {
    const char *out, *masks, *exposures, *test_block;
    struct arg_enum quality, sharing, matching, mapper, densifier, keep, mesh, leave_out, until;
    struct arg_enum hull, occluders, adapt;
    double fps;
    int frames;
    int test_every, max_size, seed, max_vram_mib, max_ram_mib;
    struct orl_names test_list;
    double adapt_s, radius_overlap;
    int radius_neighbours, fuse_cluster;
    bool resume;
};

static enum orl_result prepare(const struct terminal *terminal, const struct options *o,
                               const struct arg_common *common, const char *const *inputs,
                               size_t input_count)
{
    struct orl_prepare_params params = {
        .inputs = inputs, .input_count = input_count, .out = o->out, .test_every = o->test_every,
        .test_list = &o->test_list, .max_size = o->max_size, .masks_dir = o->masks,
        .exposures = o->exposures, .quality = (enum orl_quality)o->quality.value,
        .sharing = (enum orl_camera_sharing)o->sharing.value,
        .matching = (enum orl_matching)o->matching.value,
        .mapper = (enum orl_mapper)o->mapper.value,
        .densifier = (enum orl_densifier)o->densifier.value,
        .keep = (enum orl_keep)o->keep.value, .mesh = (enum orl_prepare_mesh)o->mesh.value,
        .leave_out = (enum orl_leave_out)o->leave_out.value, .fps = o->fps, .frames = o->frames,
        .hull = (enum orl_hull_use)o->hull.value,
        .occluders = (enum orl_occluder_search)o->occluders.value,
        .adapt = (enum orl_adapt_effort)o->adapt.value, .adapt_budget_s = o->adapt_s,
        .radius_neighbours = o->radius_neighbours, .radius_overlap = o->radius_overlap,
        .fuse_cluster = o->fuse_cluster, .until = (enum orl_until)o->until.value,
        .resume = o->resume, .seed = (uint32_t)o->seed,
        .max_vram_bytes = (size_t)o->max_vram_mib << 20,
        .max_ram_bytes = (size_t)o->max_ram_mib << 20, .shader_dir = common->shader_dir};
    if (!o->out)
        return orl_fail(&terminal->log, ORL_ERR_ARGUMENT, "prepare: --out SCENE is missing");
    enum orl_result result = args_held_out(&terminal->log, o->test_every, &o->test_list,
                                           o->test_block, &params.test_block);
    if (result != ORL_OK)
        return result;
    if (o->fps > 0 && o->frames)
        return orl_fail(&terminal->log, ORL_ERR_ARGUMENT,
                        "prepare: --fps and --frames exclude each other");
    return orl_prepare(&terminal->log, &params, &terminal->progress);
}

int cmd_prepare(int argc, char **argv)
{
    struct options o = {.quality = {orl_quality_names, ORL_QUALITY_STANDARD},
                        .sharing = {orl_camera_sharing_names, ORL_SHARING_AUTO},
                        .matching = {orl_matching_names, ORL_MATCHING_AUTO},
                        .mapper = {orl_mapper_names, ORL_MAPPER_AUTO},
                        .densifier = {orl_densifier_names, ORL_DENSIFIER_AUTO},
                        .keep = {orl_keep_names, ORL_KEEP_MINIMAL},
                        .mesh = {orl_prepare_mesh_names, ORL_MESH_NONE},
                        .leave_out = {orl_leave_out_names, ORL_LEAVE_OUT_NONE},
                        .until = {orl_until_names, ORL_UNTIL_END}, .seed = 1,
                        .hull = {orl_hull_use_names, ORL_HULL_CLOSE},
                        .occluders = {orl_occluder_search_names, ORL_OCCLUDER_SEARCH_FIND},
                        .adapt = {orl_adapt_effort_names, ORL_ADAPT_SHORT}, .adapt_s = 120};
    const struct arg_option options[] = {
        {"out", ARG_STRING, &o.out, "SCENE", "the scene folder to make", 0, 0},
        {"fps", ARG_NUMBER, &o.fps, "N", "frames taken of a second of video; default 2", 0.001,
         1000},
        {"frames", ARG_INT, &o.frames, "N", "frames taken of each video instead", 1, 100000},
        {"leave-out", ARG_ENUM, &o.leave_out, "WHAT",
         "doubtful photographs, which are named in any case, are left out", 0, 0},
        {"test-every", ARG_INT, &o.test_every, "N", "hold out every N-th photograph by name",
         2, 100000},
        {"test-list", ARG_LIST, &o.test_list, "A,B,..", "hold out these photographs", 0, 0},
        {"test-block", ARG_STRING, &o.test_block, "A:B",
         "hold out photographs A to B - 1 in the order of names, from 0: the protocol beyond", 0, 0},
        {"max-size", ARG_INT, &o.max_size, "PX",
         "larger side of photographs in the scene (by quality: 800, 1600, 3200)", 64, 16384},
        {"quality", ARG_ENUM, &o.quality, "NAME", "sizes and effort", 0, 0},
        {"masks", ARG_STRING, &o.masks, "DIR", "NAME.png or NAME.EXT.png; black is ignored",
         0, 0},
        {"exposures", ARG_STRING, &o.exposures, "FILE",
         "exposures in place of EXIF's: lines NAME,TIME,APERTURE,ISO or NAME,EV", 0, 0},
        {"camera-sharing", ARG_ENUM, &o.sharing, "HOW",
         "which photographs are of one camera; auto: by size and EXIF", 0, 0},
        {"matching", ARG_ENUM, &o.matching, "HOW",
         "which pairs are matched; sequential: neighbours by name; retrieval: by look", 0, 0},
        {"mapper", ARG_ENUM, &o.mapper, "HOW",
         "which of COLMAP's mappers; auto: incremental up to 400 photographs", 0, 0},
        {"densifier", ARG_ENUM, &o.densifier, "NAME",
         "gl is built in, colmap needs CUDA", 0, 0},
        {"keep", ARG_ENUM, &o.keep, "WHAT",
         "minimal is what commands read; all has the stereo's maps, too", 0, 0},
        {"mesh", ARG_ENUM, &o.mesh, "HOW",
         "also make mesh.ply, for methods that draw a mesh", 0, 0},
        {"radius-neighbours", ARG_INT, &o.radius_neighbours, "K",
         "a splat reaches to its point's K-th neighbour; default 6", 1, 64},
        {"radius-overlap", ARG_NUMBER, &o.radius_overlap, "X",
         "splats are X times as large; default 1", 0.01, 8},
        {"max-vram", ARG_INT, &o.max_vram_mib, "MIB", "device memory that densify keeps to", 1,
         1 << 20},
        {"until", ARG_ENUM, &o.until, "STAGE",
         "stop before features or stereo, which oriel plan divides into jobs", 0, 0},
        {"hull", ARG_ENUM, &o.hull, "HOW",
         "close surfaces that stereo leaves open by the hull of silhouettes: masks, or what is before "
         "a dark backdrop", 0, 0},
        {"occluders", ARG_ENUM, &o.occluders, "HOW",
         "find what single photographs show before the scene, so that it is not painted onto what "
         "is behind", 0, 0},
        {"adapt", ARG_ENUM, &o.adapt, "EFFORT",
         "find what suits the scene, as its defaults: among a few changes, or all methods and "
         "options", 0, 0},
        {"adapt-budget", ARG_NUMBER, &o.adapt_s, "SECONDS", "of --adapt long; default 120", 0,
         1e6},
        {"max-ram", ARG_INT, &o.max_ram_mib, "MIB",
         "memory that fusion and points keep to; default: half of what is free", 1, 1 << 24},
        {"fuse-cluster", ARG_INT, &o.fuse_cluster, "N",
         "photographs fused together at most; default: what fits in memory, and 400", 2, 100000},
        {"resume", ARG_FLAG, &o.resume, NULL, "go on with what is in SCENE", 0, 0},
        {"seed", ARG_INT, &o.seed, "N", "of random choices", 0, 2147483647},
        {0},
    };
    const struct arg_command command = {
        .name = "prepare", .usage = "PHOTOS... --out SCENE [options]",
        .summary = "Makes a scene from photographs and videos (files and folders of them). Needs "
                   "COLMAP;\nORIEL_COLMAP names its program when it is not on PATH.",
        .options = options, .positionals_min = 1, .positionals_max = INPUTS_MAX};
    const char *inputs[INPUTS_MAX];
    struct arg_common common = {0};
    struct terminal terminal;
    size_t input_count;
    int status;
    if (command_begin(&command, argc, argv, &common, &terminal, inputs, &input_count, &status)) {
        enum orl_result result = prepare(&terminal, &o, &common, inputs, input_count);
        terminal_finish(&terminal);
        if (result == ORL_OK && o.until.value == ORL_UNTIL_END)
            result = summary_print(&terminal.log, o.out);
        else if (result == ORL_ERR_CANCELLED)
            orl_logf(&terminal.log, ORL_LOG_WARNING, "interrupted; go on with --resume");
        status = command_status(result);
    }
    orl_names_finish(&o.test_list);
    return status;
}
