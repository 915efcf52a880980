// oriel publish: writes a scene as static files, which a browser renders.
#include <stdio.h>

#include "cli/commands.h"
#include "cli/command_output.h"
#include "scene/light.h"
#include "walk/publish.h"

struct options {
    struct orl_publish_params params;
    const char *light;
    int max_points;
    struct arg_enum radiance;
};

static void print_report(const struct options *o, const struct orl_publish_report *report)
{
    printf("%s: %zu photographs, %zu points, %.1f MB; %.2f MB until it shows the scene\n",
           o->params.out, report->photos, report->points, (double)report->bytes / 1e6,
           (double)report->first_bytes / 1e6);
    if (!o->params.single_file)
        printf("to look at it here: python3 -m http.server --directory '%s'\n", o->params.out);
}

static enum orl_result run(const struct terminal *terminal, const void *options,
                           const struct arg_common *common, const char *dir)
{
    const struct options *o = options;
    const struct orl_log *log = &terminal->log;
    struct orl_publish_params params = o->params;
    struct orl_publish_report report;
    struct orl_scene *scene = NULL;
    struct orl_gpu *gpu = NULL;
    if (!params.out)
        return orl_fail(log, ORL_ERR_ARGUMENT, "publish: --out SITE is needed");
    params.max_points = (size_t)o->max_points;
    params.progress = &terminal->progress;
    enum orl_result result = orl_scene_open(log, dir, &scene);
    if (result == ORL_OK)
        result = orl_scene_set_light(log, scene, o->light);
    if (result == ORL_OK)
        params.radiance = radiance_chosen(log, scene, &o->radiance);
    if (result == ORL_OK)
        result = orl_gpu_create(log, &(struct orl_gpu_params){.shader_dir = common->shader_dir,
                                                              .debug = common->verbose}, &gpu);
    if (result == ORL_OK)
        result = orl_publish(gpu, scene, &params, &report);
    if (result == ORL_OK && !common->quiet)
        print_report(o, &report);
    orl_gpu_destroy(&gpu);
    orl_scene_destroy(&scene);
    return result;
}

int cmd_publish(int argc, char **argv)
{
    struct options o = {.params = {ORL_PUBLISH_DEFAULTS},
                        .radiance = {radiance_names, RADIANCE_AUTO}};
    o.max_points = (int)o.params.max_points;
    const struct arg_option table[] = {
        {"out", ARG_STRING, &o.params.out, "SITE", "folder to write; an earlier site is replaced",
         0, 0},
        {"title", ARG_STRING, &o.params.title, "TEXT",
         "of the page; default: that of walk.json, else the scene's name", 0, 0},
        LIGHT_OPTION_ROW(&o.light),
        RADIANCE_OPTION_ROW(&o.radiance),
        {"single-file", ARG_FLAG, &o.params.single_file, NULL,
         "everything in one HTML file SITE, which also opens from disk", 0, 0},
        {"max-size", ARG_INT, &o.params.photo_side, "PX",
         "longer side of photographs at most; default 1024", 64, 8192},
        {"quality", ARG_INT, &o.params.jpeg_quality, "N", "of JPEG; default 88", 1, 100},
        {"max-points", ARG_INT, &o.max_points, "N",
         "the cloud is thinned to so many; default 3000000", 1, 100000000},
        {0},
    };
    const struct arg_command command = {
        "publish", "SCENE --out SITE [options]",
        "Writes an interactive walk through the scene: static files for any web server, rendered\n"
        "on the visitor's own graphics chip. Held-out photographs are left out.", table, 1, 1};
    return command_main(&command, argc, argv, run, &o);
}
