// oriel chart: speed and memory against accuracy of all methods on held-out photographs.
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "cli/commands.h"
#include "eval/chart.h"

enum { SCENES_MAX = 64, PEERS_MAX = 16 };

struct options {
    struct orl_names methods, peers;
    const char *out, *vary, *part;
    double seconds;
    int views, max_vram_mib;
    bool quick;
};

// Parses NAME=DIR, optionally followed by ms=.. and MIB=.. of the same peer.
static enum orl_result parse_peers(const struct orl_log *log, const struct orl_names *words,
                                   struct orl_chart_peer peers[PEERS_MAX], size_t *count)
{
    for (size_t i = 0; i < words->count; i++) {
        char *word = words->items[i], *equals = strchr(word, '='), *end;
        bool ms = strncmp(word, "ms=", 3) == 0, mib = strncmp(word, "MIB=", 4) == 0;
        double value = equals ? strtod(equals + 1, &end) : 0;
        if (!equals || equals == word || !equals[1])
            return orl_fail(log, ORL_ERR_ARGUMENT, "--peer %s: must be NAME=DIR", word);
        if ((ms || mib) && (!*count || *end || !(value > 0 && value < 1e9)))
            return orl_fail(log, ORL_ERR_ARGUMENT,
                            "--peer %s: must be a number above 0, after NAME=DIR", word);
        if (ms) {
            peers[*count - 1].ms = value;
        } else if (mib) {
            peers[*count - 1].mib = value;
        } else if (*count == PEERS_MAX) {
            return orl_fail(log, ORL_ERR_ARGUMENT, "--peer: at most %d", PEERS_MAX);
        } else {
            *equals = '\0';
            peers[(*count)++] = (struct orl_chart_peer){.name = word, .dir = equals + 1};
        }
    }
    return ORL_OK;
}

static void print_number(double value, int width, int digits)
{
    if (isfinite(value))
        printf(" %*.*f", width, digits, value);
    else
        printf(" %*s", width, "-");
}

static void print_rows(const struct orl_chart *chart)
{
    const char *scene = "";
    for (size_t i = 0; i < chart->row_count; i++) {
        const struct orl_chart_row *row = &chart->rows[i];
        const char *name = row->scene ? row->scene : "all scenes";
        if (strcmp(name, scene) != 0)
            printf("%s%-14s %-22s %9s %9s %7s %7s %7s %9s  (%s)\n", i ? "\n" : "", "method",
                   "setting", "frame ms", "PSNR dB", "SSIM", "FLIP", "crumbs", "MiB", name);
        scene = name;
        printf("%-14s %-22s", row->method, row->setting);
        print_number(row->frame_ms, 9, 2);
        print_number(row->psnr_db, 9, 2);
        print_number(row->ssim, 7, 4);
        print_number(row->flip, 7, 4);
        print_number(row->crumbs, 7, 1);
        print_number(row->device_mib, 9, 1);
        printf("%s\n", row->on_front ? "  front" : "");
    }
}

static enum orl_result run(const struct terminal *terminal, const struct options *o,
                           const struct arg_common *common, const char *const *scenes,
                           size_t scene_count)
{
    const struct orl_log *log = &terminal->log;
    struct orl_chart_peer peers[PEERS_MAX];
    struct orl_chart_params params = {
        .scenes = scenes, .scene_count = scene_count, .out = o->out, .methods = &o->methods,
        .varied = o->vary,
        .peers = peers, .views = (size_t)o->views, .seconds = o->seconds, .quick = o->quick,
        .max_vram_bytes = (size_t)o->max_vram_mib << 20, .progress = &terminal->progress};
    struct orl_gpu *gpu = NULL;
    struct orl_chart chart = {0};
    if (!o->out)
        return orl_fail(log, ORL_ERR_ARGUMENT, "chart: --out DIR is needed");
    enum orl_result result = parse_peers(log, &o->peers, peers, &params.peer_count);
    if (result == ORL_OK && o->part)
        result = args_part(log, o->part, &params.part.part, &params.part.parts);
    if (result == ORL_OK)
        result = orl_gpu_create(log, &(struct orl_gpu_params){.shader_dir = common->shader_dir,
                                                              .debug = common->verbose}, &gpu);
    if (result == ORL_OK)
        result = orl_chart_run(gpu, &params, &chart);
    if (result == ORL_OK) {
        print_rows(&chart);
        printf("%s%zu rows measured, %zu used again, %zu left out: %s/%s\n", o->part ? "" : "\n",
               chart.measured, chart.reused, chart.left_out, o->out,
               o->part ? "rows" : "chart.html");
    }
    orl_chart_finish(&chart);
    orl_gpu_destroy(&gpu);
    return result;
}

int cmd_chart(int argc, char **argv)
{
    struct options o = {.seconds = 1, .views = 8};
    const struct arg_option table[] = {
        {"out", ARG_STRING, &o.out, "DIR",
         "the report: chart.html, chart.json, figures; rows in it are used again", 0, 0},
        {"method", ARG_LIST, &o.methods, "NAME", "methods; default: all", 0, 0},
        {"vary", ARG_STRING, &o.vary, "KEY=A,B,..",
         "each method that reads this option with each of these values, too", 0, 0},
        {"quick", ARG_FLAG, &o.quick, NULL,
         "an overview: methods as they are, two photographs a scene at half their size", 0, 0},
        {"views", ARG_INT, &o.views, "N", "held-out photographs of a scene, at most; default 8",
         1, 100000},
        {"seconds", ARG_NUMBER, &o.seconds, "S", "of timed frames for each row; default 1", 0,
         3600},
        {"peer", ARG_LIST, &o.peers, "NAME=DIR[,ms=..][,MIB=..]",
         "another program's pictures of the held-out views: DIR/SCENE/PHOTO.png", 0, 0},
        {"part", ARG_STRING, &o.part, "K/N",
         "only the K-th of N parts of the rows, kept for a run of all (oriel plan)", 0, 0},
        {"max-vram", ARG_INT, &o.max_vram_mib, "MIB", "device memory to plan for", 1, 1 << 20},
        {0},
    };
    const struct arg_command command = {
        .name = "chart", .usage = "SCENE... --out DIR [--quick] [options]",
        .summary = "Charts accuracy on held-out photographs against time and memory: every method "
                   "and its\nsettings, with the Pareto front. Goes on where an earlier run "
                   "ended.",
        .options = table, .positionals_min = 1, .positionals_max = SCENES_MAX};
    const char *scenes[SCENES_MAX];
    struct arg_common common = {0};
    struct terminal terminal;
    size_t count;
    int status;
    if (command_begin(&command, argc, argv, &common, &terminal, scenes, &count, &status)) {
        enum orl_result result = run(&terminal, &o, &common, scenes, count);
        if (fflush(stdout) != 0 && result == ORL_OK)
            result = orl_fail(&terminal.log, ORL_ERR_IO, "standard output: cannot write");
        status = command_status(result);
        terminal_finish(&terminal);
    }
    orl_names_finish(&o.methods);
    orl_names_finish(&o.peers);
    return status;
}
