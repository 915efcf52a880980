// oriel publish: writes a scene as static files, which a browser renders.
#include <stdio.h>

#include "cli/command.h"
#include "cli/command_output.h"
#include "walk/publish.h"

#define PUBLISH_OPTIONS(ROW) \
    ORL_PUBLISH_OPTIONS(ROW) \
    LIGHT_OPTION(ROW) \
    RADIANCE_OPTION(ROW)
COMMAND_OPTIONS(publish_options, PUBLISH_OPTIONS)

static void print_report(const struct publish_options *o, const struct orl_publish_report *report)
{
    printf("%s: %zu photographs, %zu points, %.1f MB; %.2f MB until it shows the scene\n",
           o->out, report->photos, report->points, (double)report->bytes / 1e6,
           (double)report->first_bytes / 1e6);
    if (!o->single_file)
        printf("to look at it here: python3 -m http.server --directory '%s'\n", o->out);
}

static enum orl_result run_publish(struct call *call)
{
    const struct publish_options *o = call->options;
    struct orl_publish_params params = {ORL_PUBLISH_OPTIONS(ORL_OPTION_COPY)};
    struct orl_publish_report report;
    params.progress = call->progress;
    ORL_TRY(command_scene(call, o->light));
    params.radiance = radiance_chosen(call->log, call->scene, o->wish);
    ORL_TRY(command_device(call));
    ORL_TRY(orl_publish(call->gpu, call->scene, &params, &report));
    if (!call->common->quiet)
        print_report(o, &report);
    return ORL_OK;
}

const struct command command_publish = {
    .name = "publish", .group = COMMAND_LOOK,
    .brief = "a walk through the scene as static files for any web server",
    .usage = "SCENE --out SITE [options]",
    .summary = "Writes an interactive walk through the scene: static files for any web server, rendered\n"
               "on the visitor's own graphics chip. Held-out photographs are left out.",
    COMMAND_TABLE(publish_options), .inputs_min = 1, .inputs_max = 1, .run = run_publish,
};
