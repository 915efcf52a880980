// oriel export: the scene in the formats of other programs.
#include <stdio.h>

#include "cli/commands.h"
#include "exchange/export.h"

enum { KINDS_MAX = 16 };

struct options {
    struct arg_enum kind;
    struct orl_export_params params;
    int size;
};

// Refuses what the kind does not read.
static enum orl_result check(const struct orl_log *log, const struct options *o,
                             const struct orl_export_kind *kind)
{
    const struct orl_export_params *p = &o->params;
    const struct {
        bool given;
        int reads;
        const char *option;
    } all[] = {{p->degree >= 0, ORL_EXPORT_DEGREE, "sh"}, {p->thin, ORL_EXPORT_THIN, "thin"},
               {p->at, ORL_EXPORT_PLACE, "at"}, {p->width, ORL_EXPORT_PLACE, "width"}};
    for (size_t i = 0; i < ORL_COUNT(all); i++)
        if (all[i].given && !(kind->reads & all[i].reads))
            return orl_fail(log, ORL_ERR_ARGUMENT, "export: --as %s has no --%s", kind->name,
                            all[i].option);
    if (kind->write && !p->out)
        return orl_fail(log, ORL_ERR_ARGUMENT, "export: --out is needed");
    if (!kind->write && p->out)
        return orl_fail(log, ORL_ERR_ARGUMENT, "export: --as %s writes nothing, without --out: %s",
                        kind->name, kind->what);
    return ORL_OK;
}

static enum orl_result run(const struct terminal *terminal, const void *given,
                           const struct arg_common *common, const char *dir)
{
    const struct options *o = given;
    const struct orl_log *log = &terminal->log;
    struct orl_export_params params = o->params;
    struct orl_scene *scene = NULL;
    params.shader_dir = common->shader_dir;
    if (o->kind.value < 0)
        return orl_fail(log, ORL_ERR_ARGUMENT, "export: --as KIND is needed");
    const struct orl_export_kind *kind = &orl_export_kinds[o->kind.value];
    enum orl_result result = check(log, o, kind);
    if (result == ORL_OK)
        result = orl_scene_open(log, dir, &scene);
    if (result == ORL_OK && scene->lod)
        orl_logf(log, ORL_LOG_WARNING, "%s has %zu points in levels of detail: a sample of %zu is "
                 "exported", dir, orl_scene_point_count(scene), scene->points.count);
    if (result == ORL_OK && !kind->write)
        printf("%s is a COLMAP workspace: open its sparse/ with its images/\n", dir);
    else if (result == ORL_OK)
        result = kind->write(log, &terminal->progress, scene, &params);
    if (result == ORL_OK && kind->write && !common->quiet)
        printf("%s: %s\n", params.out, kind->what);
    orl_scene_destroy(&scene);
    return result;
}

int cmd_export(int argc, char **argv)
{
    const char *names[KINDS_MAX + 1] = {0};
    for (int i = 0; i < KINDS_MAX && orl_export_kinds[i].name; i++)
        names[i] = orl_export_kinds[i].name;
    struct options o = {.kind = {names, -1}, .params = {.degree = -1}};
    const struct arg_option table[] = {
        {"as", ARG_ENUM, &o.kind, "KIND", "what to write", 0, 0},
        {"out", ARG_STRING, &o.params.out, "FILE|DIR", "where; nerfstudio and blender make a folder",
         0, 0},
        {"sh", ARG_INT, &o.params.degree, "N",
         "of splats and glb: degree of spherical harmonics; default 1", 0, 2},
        {"thin", ARG_FLAG, &o.params.thin, NULL,
         "of splats: a third scale, for programs that know no discs", 0, 0},
        {"at", ARG_STRING, &o.params.at, "PHOTO",
         "of hdri: the photograph whose place it is; default: the middlemost", 0, 0},
        {"width", ARG_INT, &o.params.width, "PX", "of hdri; default 2048", 16, 32768},
        {0},
    };
    const struct arg_command command = {
        "export", "SCENE --as KIND --out FILE|DIR [options]",
        "Writes the scene for other programs: splats, glb, ply, nerfstudio, blender, hdri.\n"
        "Colours of splats and glb are fitted to all training photographs that see a point.",
        table, 1, 1};
    return command_main(&command, argc, argv, run, &o);
}
