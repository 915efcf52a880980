// oriel densify: depth and normal maps for a COLMAP workspace, instead of colmap
// patch_match_stereo.

#include "cli/command.h"
#include "preprocess/densify/densify.h"
#include "scene/colmap.h"

#define DENSIFY_OPTIONS(ROW) \
    ROW(exclude, "exclude", LIST("A,B"), "photographs to leave out altogether") \
    ROW(photos, "photos", TEXT("FILE"), "the photographs to use, a name a line; default: all") \
    ORL_DENSIFY_OPTIONS(ROW) \
    ROW(pass, "pass", INT(0, 0, 8, "P"), "of --part; 0: photometric, then geometric ones") \
    ROW(part, "part", PART, "only the K-th of N parts of one pass (oriel plan)")
COMMAND_OPTIONS(densify_options, DENSIFY_OPTIONS)

// Lists the workspace's photographs that are not excluded.
static enum orl_result choose_photos(const struct orl_log *log, const char *workspace,
                                     const struct orl_colmap_model *model,
                                     const struct densify_options *o, struct orl_names *photos)
{
    const struct orl_names *exclude = &o->exclude;
    size_t excluded = 0;
    if (o->photos)
        return orl_file_read_names(log, o->photos, photos);
    for (size_t i = 0; i < model->image_count; i++) {
        if (orl_names_contain(exclude, model->images[i].name))
            excluded++;
        else
            ORL_TRY(orl_names_add(log, photos, model->images[i].name));
    }
    return excluded < exclude->count ? orl_fail(log, ORL_ERR_NOT_FOUND, "--exclude: %s has no photograph of some name",
                                                workspace)
                                     : ORL_OK;
}

static enum orl_result densify(struct call *call, const struct orl_densify_params *asked)
{
    const char *workspace = call->inputs[0];
    struct orl_colmap_model model = {0};
    struct orl_names photos = {0};
    enum orl_result result = orl_colmap_read(call->log, ORL_PATH(workspace, "sparse"), &model);
    struct orl_densify_params params = *asked;
    params.model = &model;
    ORL_THEN(result, choose_photos(call->log, workspace, &model, call->options, &photos));
    ORL_THEN(result, command_device(call));
    ORL_THEN(result, orl_densify(call->gpu, workspace, &photos, &params, call->progress));
    orl_names_finish(&photos);
    orl_colmap_finish(&model);
    return result;
}

static enum orl_result run_densify(struct call *call)
{
    const struct densify_options *o = call->options;
    const struct orl_densify_part part = {o->pass, o->part.index, o->part.count};
    struct orl_densify_params params = {ORL_DENSIFY_OPTIONS(ORL_OPTION_COPY)};
    if (o->photos && o->exclude.count)
        return orl_fail(call->log, ORL_ERR_ARGUMENT, "--photos and --exclude exclude each other");
    if (o->pass && !o->part.count)
        return orl_fail(call->log, ORL_ERR_ARGUMENT, "--pass %d: is of --part", o->pass);
    params.part = o->part.count ? &part : NULL;
    return params.part && command_is_whole(call) ? ORL_OK : densify(call, &params);
}

const struct command command_densify = {
    .name = "densify", .group = COMMAND_MAKE,
    .brief = "depth maps for a COLMAP workspace",
    .usage = "WORKSPACE [options]",
    .summary = "Writes stereo/depth_maps and stereo/normal_maps of a COLMAP undistorted workspace, as\n"
               "colmap patch_match_stereo does, without CUDA. Photographs that have maps of these\n"
               "settings are skipped, so that an interrupted run goes on. colmap stereo_fusion reads the\n"
               "result. stereo/confidence_maps says how sure each depth is.",
    COMMAND_TABLE(densify_options), .inputs_min = 1, .inputs_max = 1, .run = run_densify,
};
