// oriel walk: shows a scene in the browser, rendered by this machine.
#include <stdio.h>

#include "cli/command.h"
#include "cli/command_output.h"
#include "eval/choice.h"
#include "walk/server.h"

#define WALK_OPTIONS(ROW) \
    ROW(port, "port", INT(8765, 0, 65535, "N"), "to listen on; 0: any that is free") \
    ROW(host, "host", TEXT("ADDRESS"), "to listen on; default 127.0.0.1; others ask for the token in " \
        "the printed address") \
    ROW(title, "title", TEXT("TEXT"), "of the page; default: that of walk.json, else the scene's name") \
    ROW(embed_in, "embed-in", TEXT("ORIGINS"), "sites whose pages may frame the walk; default: none") \
    ROW(live, "live", TEXT("DIR"), "show what cameras write into the folders or pipes DIR/NAME, as it comes") \
    ROW(edits, "edit", FLAG, "other machines may change annotations, title and start view, too") \
    METHOD_OPTIONS(ROW) \
    LIGHT_OPTION(ROW) \
    RADIANCE_OPTION(ROW) \
    ROW(max_vram_bytes, "max-vram", MIB(1 << 20), "device memory to plan for")
COMMAND_OPTIONS(walk_options, WALK_OPTIONS)

static void print_address(void *priv, const char *address)
{
    (void)priv;
    printf("%s\n", address);
    fflush(stdout);
}

static enum orl_result run_walk(struct call *call)
{
    const struct walk_options *o = call->options;
    struct orl_choice choice;
    ORL_TRY(command_scene(call, o->light));
    const bool radiance = radiance_chosen(call->log, call->scene, o->wish);
    ORL_TRY(orl_choice_make(call->log, call->scene, radiance ? ORL_SAMPLE_RADIANCE : ORL_SAMPLE_SRGB,
                            o->method, &o->settings, &choice));
    const struct orl_renderer_params limits = {.radiance = radiance,
                                               .max_vram_bytes = o->max_vram_bytes};
    ORL_TRY(command_renderer(call, &limits));
    const struct orl_walk_params params = {
        .host = o->host ? o->host : "127.0.0.1", .port = o->port, .title = o->title, .edits = o->edits,
        .radiance = radiance,
        .embed_in = o->embed_in, .live = o->live,
        .choice = &choice, .progress = call->progress, .ready = print_address};
    return orl_walk_serve(call->gpu, call->renderer, call->scene, &params);
}

const struct command command_walk = {
    .name = "walk", .group = COMMAND_LOOK,
    .brief = "walk through a scene in the browser, drawn by this machine",
    .usage = "SCENE [options]",
    .summary = "Serves the scene to browsers, drawn by this machine, until it is interrupted (ctrl-C).\n"
               "Prints the address to open.",
    COMMAND_TABLE(walk_options), .inputs_min = 1, .inputs_max = 1, .run = run_walk,
};
