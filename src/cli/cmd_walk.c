// oriel walk: shows a scene in the browser, rendered by this machine.
#include <stdio.h>

#include "cli/commands.h"
#include "cli/command_output.h"
#include "eval/choice.h"
#include "scene/light.h"
#include "walk/server.h"

struct options {
    const char *method, *host, *title, *light, *embed_in;
    struct orl_names settings;
    int port, max_vram_mib;
    bool edits;
    struct arg_enum radiance;
};

static void print_address(void *priv, const char *address)
{
    (void)priv;
    printf("%s\n", address);
    fflush(stdout);
}

static enum orl_result run(const struct terminal *terminal, const void *options,
                           const struct arg_common *common, const char *dir)
{
    const struct options *o = options;
    const struct orl_log *log = &terminal->log;
    struct orl_scene *scene = NULL;
    struct orl_gpu *gpu = NULL;
    struct orl_renderer *renderer = NULL;
    struct orl_choice choice;
    bool radiance = false;
    enum orl_result result = orl_scene_open(log, dir, &scene);
    if (result == ORL_OK)
        result = orl_scene_set_light(log, scene, o->light);
    if (result == ORL_OK)
        radiance = radiance_chosen(log, scene, &o->radiance);
    if (result == ORL_OK)
        result = orl_choice_make(log, scene, radiance ? ORL_SAMPLE_RADIANCE : ORL_SAMPLE_SRGB,
                                 o->method, &o->settings, &choice);
    if (result == ORL_OK)
        result = orl_gpu_create(log, &(struct orl_gpu_params){.shader_dir = common->shader_dir,
                                                              .debug = common->verbose}, &gpu);
    const struct orl_renderer_params limits = {.radiance = radiance,
                                               .max_vram_bytes = (size_t)o->max_vram_mib << 20};
    if (result == ORL_OK)
        result = orl_renderer_create(gpu, scene, &limits, &renderer);
    const struct orl_walk_params params = {
        .host = o->host, .port = o->port, .title = o->title, .edits = o->edits,
        .radiance = radiance,
        .embed_in = o->embed_in,
        .choice = &choice, .progress = &terminal->progress, .ready = print_address};
    if (result == ORL_OK)
        result = orl_walk_serve(gpu, renderer, scene, &params);
    orl_renderer_destroy(&renderer);
    orl_gpu_destroy(&gpu);
    orl_scene_destroy(&scene);
    return result;
}

int cmd_walk(int argc, char **argv)
{
    struct options o = {.host = "127.0.0.1", .port = 8765, .radiance = {radiance_names, RADIANCE_AUTO}};
    const struct arg_option table[] = {
        {"port", ARG_INT, &o.port, "N", "to listen on; default 8765, 0: any that is free", 0, 65535},
        {"host", ARG_STRING, &o.host, "ADDRESS",
         "to listen on; default 127.0.0.1; others ask for the token in the printed address", 0, 0},
        {"title", ARG_STRING, &o.title, "TEXT",
         "of the page; default: that of walk.json, else the scene's name", 0, 0},
        {"embed-in", ARG_STRING, &o.embed_in, "ORIGINS",
         "sites whose pages may frame the walk; default: none", 0, 0},
        {"edit", ARG_FLAG, &o.edits, NULL,
         "other machines may change annotations, title and start view, too", 0, 0},
        {"method", ARG_STRING, &o.method, "NAME",
         "default: the scene's, or else the first of oriel methods", 0, 0},
        {"set", ARG_LIST, &o.settings, "KEY=VALUE", "change an option of the method", 0, 0},
        LIGHT_OPTION_ROW(&o.light),
        RADIANCE_OPTION_ROW(&o.radiance),
        {"max-vram", ARG_INT, &o.max_vram_mib, "MIB", "device memory to plan for", 1, 1 << 20},
        {0},
    };
    const struct arg_command command = {
        "walk", "SCENE [options]",
        "Serves the scene to browsers, drawn by this machine, until it is interrupted (ctrl-C).\n"
        "Prints the address to open.", table, 1, 1};
    int status = command_main(&command, argc, argv, run, &o);
    orl_names_finish(&o.settings);
    return status;
}
