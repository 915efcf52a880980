// oriel plan: what is left of a scene's work, as a graph of commands.
#include <math.h>
#include <stdio.h>
#include <string.h>

#include "cli/command.h"
#include "cli/command_output.h"
#include "core/json.h"
#include "preprocess/plan.h"

#define PLAN_OPTIONS(ROW) \
    ROW(photographs, "photographs", INT(16, 1, 100000, "N"), "of a job, at most") \
    ROW(json, "json", FLAG, "the graph, with each job's command, costs and files")
COMMAND_OPTIONS(plan_options, PLAN_OPTIONS)

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
        cpu += orl_json_value(job, "cpu_s");
        written += orl_json_value(job, "written_bytes");
        memory = fmax(memory, orl_json_value(job, "memory_bytes"));
    }
    if (count)
        printf("%-9s %5zu job%s  %9.0f s of CPU  up to %6.0f MiB of memory  %9.1f MiB written\n",
               kind, count, count == 1 ? " " : "s", cpu, memory / (1 << 20), written / (1 << 20));
}

static enum orl_result run_plan(struct call *call)
{
    static const char *const kinds[] = {"features", "pairs", "matches", "calibrate",
                                        "densify",  "fuse",  "finish"};
    const struct plan_options *o = call->options;
    const struct orl_log *log = call->log;
    json_t *plan;
    enum orl_result result = ORL_OK;
    ORL_TRY(orl_plan(log, call->inputs[0], o->photographs, &plan));
    const json_t *jobs = json_object_get(plan, "jobs");
    if (o->json)
        result = report_write(log, "-", json_incref(plan));
    else if (!json_array_size(jobs))
        printf("%s is whole: there is nothing left to do\n", call->inputs[0]);
    for (size_t i = 0; !o->json && i < ORL_COUNT(kinds); i++)
        print_kind(jobs, kinds[i]);
    json_decref(plan);
    return result;
}

const struct command command_plan = {
    .name = "plan", .group = COMMAND_JOB,
    .brief = "the work left for a scene as jobs for several machines",
    .usage = "SCENE [options]",
    .summary = "Says what is left to do for a scene that oriel prepare --until collect or undistort has\n"
               "begun, as jobs that may run on several machines. cluster/Snakefile runs them.",
    COMMAND_TABLE(plan_options), .inputs_min = 1, .inputs_max = 1, .run = run_plan,
};
