// oriel chart: speed and memory against accuracy of all methods on held-out photographs.
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "cli/command.h"
#include "eval/chart.h"

enum { SCENES_MAX = 64, PEERS_MAX = 16 };

#define CHART_OPTIONS(ROW) \
    ORL_CHART_OPTIONS(ROW) \
    ROW(peers, "peer", LIST("NAME=DIR[,ms=..][,MIB=..]"), \
        "another program's pictures of the held-out views: DIR/SCENE/PHOTO.png")
COMMAND_OPTIONS(chart_options, CHART_OPTIONS)

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

static enum orl_result run_chart(struct terminal *terminal, const void *options,
                                 const struct common_options *common, const char *const *inputs)
{
    const struct chart_options *o = options;
    const struct orl_log *log = &terminal->log;
    struct orl_chart_peer peers[PEERS_MAX];
    struct orl_chart_params params = {
        ORL_CHART_OPTIONS(ORL_OPTION_COPY) .scenes = inputs, .peers = peers,
        .progress = &terminal->progress};
    struct orl_gpu *gpu = NULL;
    struct orl_chart chart = {0};
    while (inputs[params.scene_count])
        params.scene_count++;
    enum orl_result result = parse_peers(log, &o->peers, peers, &params.peer_count);
    if (result == ORL_OK)
        result = orl_gpu_create(log, &(struct orl_gpu_params){.shader_dir = common->shader_dir,
                                                              .debug = common->verbose}, &gpu);
    if (result == ORL_OK)
        result = orl_chart_run(gpu, &params, &chart);
    if (result == ORL_OK) {
        print_rows(&chart);
        printf("%s%zu rows measured, %zu used again, %zu left out: %s/%s\n", o->part.count ? "" : "\n",
               chart.measured, chart.reused, chart.left_out, o->out,
               o->part.count ? "rows" : "chart.html");
    }
    orl_chart_finish(&chart);
    orl_gpu_destroy(&gpu);
    return result;
}

const struct command command_chart = {
    .name = "chart", .group = COMMAND_MEASURE,
    .brief = "accuracy against time and memory, all methods",
    .usage = "SCENE... --out DIR [--quick] [options]",
    .summary = "Charts accuracy on held-out photographs against time and memory: every method and its\n"
               "settings, with the Pareto front. Goes on where an earlier run ended.",
    COMMAND_TABLE(chart_options), .inputs_min = 1, .inputs_max = SCENES_MAX, .run = run_chart,
};
