// oriel plan: what is left of a scene's work, as a graph of commands.
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "cli/commands.h"
#include "core/json.h"
#include "eval/stress.h"
#include "preprocess/plan.h"

struct options {
    int photographs, parts;
    const char *chart, *stress, *methods, *vary, *peers, *axes;
    int views, side, seed, max_vram_mib; // -1: not given
    double seconds;
    bool json, quick;
};

enum { WORDS_MAX = 12 };

// What is passed on to the commands of a report.
struct words {
    const char *items[WORDS_MAX];
    size_t count;
    char numbers[WORDS_MAX][24]; // their texts
};

static void add_text(struct words *words, const char *option, const char *value)
{
    if (!value)
        return;
    words->items[words->count++] = option;
    words->items[words->count++] = value;
}

static void add_number(struct words *words, const char *option, double value)
{
    char *text = words->numbers[words->count];
    if (value < 0)
        return;
    snprintf(text, sizeof words->numbers[0], "%.10g", value);
    add_text(words, option, text);
}

static void add_common(const struct options *o, struct words *words)
{
    add_text(words, "--method", o->methods);
    add_number(words, "--views", o->views);
}

static double number(const json_t *job, const char *key)
{
    return json_number_value(json_object_get(job, key));
}

// One line for the jobs of a kind.
static void print_kind(const json_t *jobs, const char *kind)
{
    size_t i, count = 0;
    double cpu = 0, memory = 0, written = 0;
    const json_t *job;
    json_array_foreach(jobs, i, job) {
        if (strcmp(orl_json_text(job, "kind"), kind) != 0)
            continue;
        count++;
        cpu += number(job, "cpu_s");
        written += number(job, "written_bytes");
        memory = number(job, "memory_bytes") > memory ? number(job, "memory_bytes") : memory;
    }
    if (count)
        printf("%-9s %5zu job%s  %9.0f s of CPU  up to %6.0f MiB of memory  %9.1f MiB written\n",
               kind, count, count == 1 ? " " : "s", cpu, memory / (1 << 20), written / (1 << 20));
}

static enum orl_result run(const struct terminal *terminal, const void *options,
                           const struct arg_common *common, const char *scene)
{
    static const char *const kinds[] = {"features", "pairs", "matches", "calibrate",
                                        "densify",  "fuse",  "finish", "chart", "stress"};
    const struct options *o = options;
    json_t *plan;
    (void)common;
    struct words chart = {0}, stress = {0};
    add_common(o, &chart);
    add_text(&chart, "--vary", o->vary);
    add_number(&chart, "--seconds", o->seconds);
    add_text(&chart, "--peer", o->peers);
    add_number(&chart, "--max-vram", o->max_vram_mib);
    add_common(o, &stress);
    add_text(&stress, "--axes", o->axes);
    add_number(&stress, "--size", o->side);
    add_number(&stress, "--seed", o->seed);
    const struct orl_plan_report reports[] = {
        {"chart", o->chart, chart.items, chart.count, o->quick, o->parts},
        {"stress", o->stress, stress.items, stress.count, o->quick, o->parts}};
    enum orl_result result = orl_plan(&terminal->log, scene, o->photographs, &plan);
    for (size_t i = 0; result == ORL_OK && i < ORL_COUNT(reports); i++)
        if (reports[i].out)
            result = orl_plan_add_report(&terminal->log, plan, &reports[i]);
    if (result != ORL_OK) {
        json_decref(plan);
        return result;
    }
    const json_t *jobs = json_object_get(plan, "jobs");
    char *text = o->json ? json_dumps(plan, JSON_INDENT(1) | JSON_ENSURE_ASCII) : NULL;
    if (o->json && !text)
        result = ORL_ERR_MEMORY;
    else if (text)
        printf("%s\n", text);
    else if (!json_array_size(jobs))
        printf("%s is whole: there is nothing left to do\n", scene);
    for (size_t i = 0; !o->json && i < ORL_COUNT(kinds); i++)
        print_kind(jobs, kinds[i]);
    free(text);
    json_decref(plan);
    return result;
}

int cmd_plan(int argc, char **argv)
{
    struct options o = {.photographs = 16, .parts = 8, .views = -1, .side = -1, .seed = -1,
                        .max_vram_mib = -1, .seconds = -1};
    const struct arg_option table[] = {
        {"photographs", ARG_INT, &o.photographs, "N", "of a job, at most; default 16", 1, 100000},
        {"chart", ARG_STRING, &o.chart, "DIR", "also the rows of oriel chart, into DIR", 0, 0},
        {"stress", ARG_STRING, &o.stress, "DIR", "also the rows of oriel stress, into DIR", 0, 0},
        {"parts", ARG_INT, &o.parts, "N", "jobs that make the rows of a report; default 8", 1, 1000},
        {"method", ARG_STRING, &o.methods, "NAME,..", "of a report; default: all", 0, 0},
        {"quick", ARG_FLAG, &o.quick, NULL, "an overview, of a report", 0, 0},
        {"views", ARG_INT, &o.views, "N", "held-out photographs, of a report", 1, 100},
        {"vary", ARG_STRING, &o.vary, "KEY=A,B,..", "of oriel chart", 0, 0},
        {"seconds", ARG_NUMBER, &o.seconds, "S", "of timed frames, of oriel chart", 0, 3600},
        {"peer", ARG_STRING, &o.peers, "NAME=DIR[,ms=..][,MIB=..]", "of oriel chart", 0, 0},
        {"max-vram", ARG_INT, &o.max_vram_mib, "MIB", "of oriel chart", 1, 1 << 20},
        {"axes", ARG_STRING, &o.axes, "NAME,..", "of oriel stress", 0, 0},
        {"size", ARG_INT, &o.side, "PX", "of oriel stress", ORL_STRESS_SIDE_MIN,
         ORL_STRESS_SIDE_MAX},
        {"seed", ARG_INT, &o.seed, "N", "of oriel stress", 0, INT32_MAX},
        {"json", ARG_FLAG, &o.json, NULL, "the graph, with each job's command, costs and files",
         0, 0},
        {0},
    };
    const struct arg_command command = {
        "plan", "SCENE [options]",
        "Says what is left to do for a scene that oriel prepare --until collect or undistort has\n"
        "begun, as jobs that may run on several machines. cluster/Snakefile runs them.",
        table, 1, 1};
    return command_main(&command, argc, argv, run, &o);
}
