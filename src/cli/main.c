#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "cli/commands.h"
#include "core/file.h"

static const struct command commands[] = {
    {"bench", "time and memory of frames, pass by pass", cmd_bench},
    {"calibrate", "features or matches of a part of the photographs", cmd_calibrate},
    {"chart", "accuracy against time and memory, all methods", cmd_chart},
    {"densify", "depth maps for a COLMAP workspace", cmd_densify},
    {"eval", "compare renderings with held-out photographs", cmd_eval},
    {"export", "the scene in the formats of other programs", cmd_export},
    {"fuse", "points of one cluster of a scene's photographs", cmd_fuse},
    {"hdr", "radiance views from photographs of several exposures", cmd_hdr},
    {"import", "make a scene from known cameras, silhouettes, sequences", cmd_import},
    {"info", "say what is in a scene", cmd_info},
    {"lod", "levels of detail for points that are more than memory holds", cmd_lod},
    {"methods", "list the methods of rendering and their options", cmd_methods},
    {"plan", "the work left for a scene as jobs for several machines", cmd_plan},
    {"prepare", "make a scene from photographs", cmd_prepare},
    {"publish", "a walk through the scene as static files for any web server", cmd_publish},
    {"render", "render new views", cmd_render},
    {"stress", "accuracy as one thing at a time gets worse, all methods", cmd_stress},
    {"synth", "synthetic photographs with ground truth", cmd_synth},
    {"trim", "make the least scene that serves as well", cmd_trim},
    {"tune", "fit a method's options to a scene", cmd_tune},
    {"walk", "walk through a scene in the browser, drawn by this machine", cmd_walk},
    {0},
};

enum orl_result command_is_whole(const struct orl_log *log, const char *scene, bool *whole)
{
    char *path = orl_path_join(log, scene, "scene.json");
    *whole = path && orl_path_is_file(path);
    free(path);
    return path ? ORL_OK : ORL_ERR_MEMORY;
}

bool command_begin(const struct arg_command *command, int argc, char **argv,
                   struct arg_common *common, struct terminal *terminal,
                   const char **positionals, size_t *positional_count, int *status)
{
    struct orl_log log = orl_log_stderr(ORL_LOG_INFO);
    enum orl_result result =
        args_parse(&log, command, argc, argv, common, positionals, positional_count);
    *status = command_status(result);
    if (result != ORL_OK || common->help)
        return false;
    terminal_init(terminal, common->verbose ? ORL_LOG_DEBUG : ORL_LOG_INFO, common->quiet);
    return true;
}

int command_status(enum orl_result result)
{
    switch (result) {
    case ORL_OK:
        return 0;
    case ORL_ERR_ARGUMENT:
    case ORL_ERR_FORMAT:
    case ORL_ERR_DATA:
    case ORL_ERR_NOT_FOUND:
        return 2;
    case ORL_ERR_CANCELLED:
        return 130;
    default:
        return 1;
    }
}

int command_main(const struct arg_command *command, int argc, char **argv, command_run *run,
                 const void *options)
{
    struct arg_common common = {0};
    struct terminal terminal;
    const char *positional = NULL;
    size_t count;
    int status;
    if (command_begin(command, argc, argv, &common, &terminal, &positional, &count, &status)) {
        status = command_status(run(&terminal, options, &common, positional));
        terminal_finish(&terminal);
    }
    return status;
}

static void print_usage(FILE *out)
{
    fprintf(out, "usage: oriel COMMAND ...    (oriel COMMAND --help says more)\n\n");
    for (const struct command *c = commands; c->name; c++)
        fprintf(out, "  %-10s %s\n", c->name, c->summary);
    fprintf(out, "  %-10s %s\n", "version", "print the version");
}

static int run_command(int argc, char **argv)
{
    const char *name = argc > 1 ? argv[1] : "";
    for (const struct command *c = commands; c->name; c++)
        if (strcmp(c->name, name) == 0)
            return c->run(argc - 2, argv + 2);
    if (strcmp(name, "version") == 0 || strcmp(name, "--version") == 0) {
        printf("oriel %s\n", ORL_VERSION);
        return 0;
    }
    bool help = strcmp(name, "help") == 0 || strcmp(name, "--help") == 0;
    print_usage(help ? stdout : stderr);
    if (!help && *name)
        fprintf(stderr, "\noriel: error: unknown command %s\n", name);
    return help ? 0 : 2;
}

int main(int argc, char **argv)
{
    int status = run_command(argc, argv);
    // ferror remembers an earlier failed write, which fflush does not.
    if ((fflush(stdout) != 0 || ferror(stdout)) && status == 0) {
        fprintf(stderr, "oriel: error: standard output: cannot write all of it\n");
        status = command_status(ORL_ERR_IO);
    }
    return status;
}
