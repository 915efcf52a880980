// oriel export: the scene in the formats of other programs.
#include <stdio.h>

#include "cli/command.h"
#include "exchange/export.h"
#include "scene/point_lod.h"

static const char *kind_name(size_t index)
{
    return orl_export_kinds[index].name;
}

#define EXPORT_OPTIONS(ROW) \
    ROW(kind, "as", NAMED(kind_name, -1, "KIND"), "what to write") \
    ORL_EXPORT_OPTIONS(ROW)
COMMAND_OPTIONS(export_options, EXPORT_OPTIONS)

static void say_origin(const struct orl_log *log, const struct orl_scene *scene)
{
    const double *o = scene->origin;
    if (o[0] != 0 || o[1] != 0 || o[2] != 0)
        orl_logf(log, ORL_LOG_WARNING, "this kind holds floats: add %.9g %.9g %.9g to its coordinates "
                 "for those that were imported", o[0], o[1], o[2]);
}

// Of levels of detail, the finest that memory holds.
static enum orl_result take_points(const struct orl_log *log, struct orl_scene *scene)
{
    orl_points_finish(&scene->points);
    ORL_TRY(orl_lod_sample(scene->lod, (size_t)orl_lod_most_in_memory(0), &scene->points));
    if (scene->points.count < orl_scene_point_count(scene))
        orl_logf(log, ORL_LOG_WARNING, "%s has %zu points, which memory does not hold: a level of "
                 "detail of %zu is exported", scene->dir, orl_scene_point_count(scene),
                 scene->points.count);
    return ORL_OK;
}

// Refuses what the kind does not read.
static enum orl_result check(const struct orl_log *log, const struct export_options *o,
                             const struct orl_export_kind *kind)
{
    const struct {
        bool given;
        int reads;
        const char *option;
    } all[] = {{o->degree >= 0, ORL_EXPORT_DEGREE, "sh"}, {o->thin, ORL_EXPORT_THIN, "thin"},
               {o->at, ORL_EXPORT_PLACE, "at"}, {o->width, ORL_EXPORT_PLACE, "width"}};
    for (size_t i = 0; i < ORL_COUNT(all); i++)
        if (all[i].given && !(kind->reads & all[i].reads))
            return orl_fail(log, ORL_ERR_ARGUMENT, "export: --as %s has no --%s", kind->name,
                            all[i].option);
    if (kind->write && !o->out)
        return orl_fail(log, ORL_ERR_ARGUMENT, "export: --out is needed");
    if (!kind->write && o->out)
        return orl_fail(log, ORL_ERR_ARGUMENT, "export: --as %s writes nothing, without --out: %s",
                        kind->name, kind->what);
    return ORL_OK;
}

static enum orl_result run_export(struct call *call)
{
    const struct export_options *o = call->options;
    const struct orl_log *log = call->log;
    const struct orl_export_params params = {ORL_EXPORT_OPTIONS(ORL_OPTION_COPY)
                                             .shader_dir = call->common->shader_dir};
    if (o->kind < 0)
        return orl_fail(log, ORL_ERR_ARGUMENT, "export: --as KIND is needed");
    const struct orl_export_kind *kind = &orl_export_kinds[o->kind];
    ORL_TRY(check(log, o, kind));
    ORL_TRY(command_scene(call, NULL));
    if (call->scene->lod && kind->points)
        ORL_TRY(take_points(log, call->scene));
    if (!kind->placed)
        say_origin(log, call->scene);
    if (!kind->write) {
        printf("%s is a COLMAP workspace: open its sparse/ with its images/\n", call->inputs[0]);
        return ORL_OK;
    }
    ORL_TRY(kind->write(log, call->progress, call->scene, &params));
    if (!call->common->quiet)
        printf("%s: %s\n", params.out, kind->what);
    return ORL_OK;
}

const struct command command_export = {
    .name = "export", .group = COMMAND_LOOK,
    .brief = "the scene in the formats of other programs",
    .usage = "SCENE --as KIND --out FILE|DIR [options]",
    .summary = "Writes the scene for other programs: splats, glb, ply, nerfstudio, blender, hdri.\n"
               "Colours of splats and glb are fitted to all training photographs that see a point.",
    COMMAND_TABLE(export_options), .inputs_min = 1, .inputs_max = 1, .run = run_export,
};
