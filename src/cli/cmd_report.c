// oriel chart, stress and plot: reports that scripts make of what other commands measure. The
// commands check the options and pass them on.
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include "cli/command.h"
#include "core/file.h"
#include "core/memory.h"
#include "oriel/render.h"

enum { SCENES_MAX = 64 };

#define CHART_OPTIONS(ROW) \
    ROW(out, "out", NEEDED("DIR"), \
        "the report: chart.html, chart.json, chart.svg; rows in it are used again") \
    ROW(methods, "method", LIST("NAME"), "methods; default: all") \
    ROW(vary, "vary", TEXT("KEY=A,B,.."), \
        "each method that reads this option with each of these values, too") \
    ROW(quick, "quick", FLAG, \
        "an overview: methods as they are, two photographs a scene at half their size") \
    ROW(views, "views", INT(8, 1, 100000, "N"), "held-out photographs of a scene, at most") \
    ROW(peers, "peer", LIST("NAME=DIR[,ms=..][,MIB=..]"), \
        "another program's pictures of the held-out views: DIR/SCENE/PHOTO.png") \
    ROW(part, "part", PART, "only the K-th of N parts of the rows, kept for a run of all") \
    ROW(max_vram_bytes, "max-vram", MIB(1 << 20), "device memory to plan for")
COMMAND_OPTIONS(chart_options, CHART_OPTIONS)

#define STRESS_OPTIONS(ROW) \
    ROW(out, "out", NEEDED("DIR"), \
        "the report: stress.html, stress.json, figures; rows in it are used again") \
    ROW(axes, "axes", LIST("NAME,.."), "what gets worse; default: all that the scene serves") \
    ROW(methods, "method", LIST("NAME"), "methods, or with paired also those of papers again on the proxy of oriel, " \
        "with refined also oriel with soft splats; default: all") \
    ROW(quick, "quick", FLAG, "an overview: one view, three of the six severities") \
    ROW(side, "size", INT(192, 96, 2048, "PX"), "longer side of photographs and pictures") \
    ROW(photographs, "photographs", INT(16, 4, 500, "N"), "of the synthetic monument") \
    ROW(views, "views", INT(2, 1, 100, "N"), "held-out photographs, at most") \
    ROW(part, "part", PART, "only the K-th of N parts of the rows, kept for a run of all") \
    ROW(seed, "seed", SEED, "of everything random")
COMMAND_OPTIONS(stress_options, STRESS_OPTIONS)

#define PLOT_OPTIONS(ROW) ROW(out, "out", NEEDED("DIR"), "the figures, as SVG")
COMMAND_OPTIONS(plot_options, PLOT_OPTIONS)

// --- the script ---

// The script beside the program as it is built, or where it is installed.
static const char *find_script(const struct orl_log *log, const char *program, const char *name,
                               char path[ORL_PATH_SIZE])
{
    static const char *const folders[] = {"reports", ORL_REPORTS_FROM_BINDIR};
    int length = (int)(strrchr(program, '/') - program);
    for (size_t i = 0; i < ORL_COUNT(folders); i++)
        if (orl_path_is_file(orl_path_print(path, "", "%.*s/%s/%s.py", length, program, folders[i], name)))
            return path;
    orl_logf(log, ORL_LOG_ERROR, "%s.py is missing beside %s and in its %s", name, program,
             ORL_REPORTS_FROM_BINDIR);
    return NULL;
}

// Becomes python3 SCRIPT PROGRAM OPTION... -- INPUT...
static enum orl_result become(const struct orl_log *log, const char *script, const char *program,
                              const json_t *words, const char *const *inputs)
{
    size_t count = json_array_size(words), at = 0, input_count = 0;
    while (inputs[input_count])
        input_count++;
    const char **argv = orl_array(log, count + input_count + 5, sizeof *argv);
    ORL_TRY_MEMORY(argv);
    argv[at++] = "python3";
    argv[at++] = script;
    argv[at++] = program;
    for (size_t i = 0; i < count; i++)
        argv[at++] = json_string_value(json_array_get(words, i));
    argv[at++] = "--";
    for (size_t i = 0; i < input_count; i++)
        argv[at++] = inputs[i];
    execvp(argv[0], (char *const *)(uintptr_t)argv);
    free(argv);
    return orl_fail(log, ORL_ERR_EXTERNAL, "python3 is missing, which makes this report");
}

// What else may stand among the methods of a report.
static bool is_more(const struct call *call, const char *name)
{
    return strcmp(name, "paired") == 0 || (strcmp(name, "refined") == 0 && call->command == &command_stress);
}

// ORL_ERR_ARGUMENT, logged: a report of methods is asked for one that there is not.
static enum orl_result check_methods(const struct call *call)
{
    for (const struct orl_option *row = call->command->rows(); row->name; row++) {
        const struct orl_names *names = (const void *)((const char *)call->options + row->offset);
        for (size_t i = 0; strcmp(row->name, "method") == 0 && i < names->count; i++)
            if (!is_more(call, names->items[i]) && !orl_method_find(call->log, names->items[i]))
                return ORL_ERR_ARGUMENT;
    }
    return ORL_OK;
}

static enum orl_result run_report(struct call *call)
{
    ORL_TRY(check_methods(call));
    json_t *words = json_array();
    char program[ORL_PATH_SIZE], path[ORL_PATH_SIZE];
    const char *script = realpath("/proc/self/exe", program)
                             ? find_script(call->log, program, call->command->name, path) : NULL;
    orl_arguments_record(words, call->command->rows(), call->options);
    orl_arguments_record(words, common_option_rows(), call->common);
    terminal_finish(call->terminal);
    enum orl_result result = script ? become(call->log, script, program, words, call->inputs)
                                    : ORL_ERR_NOT_FOUND;
    json_decref(words);
    return result;
}

// --- the commands ---

const struct command command_chart = {
    .name = "chart", .group = COMMAND_MEASURE,
    .brief = "accuracy against time and memory, all methods",
    .usage = "SCENE... --out DIR [--quick] [options]",
    .summary = "Charts accuracy on held-out photographs against time and memory: every method and its\n"
               "settings, with the Pareto front. Goes on where an earlier run ended.",
    COMMAND_TABLE(chart_options), .inputs_min = 1, .inputs_max = SCENES_MAX, .run = run_report,
};

const struct command command_stress = {
    .name = "stress", .group = COMMAND_MEASURE,
    .brief = "accuracy as one thing at a time gets worse, all methods",
    .usage = "SCENE|synth --out DIR [--quick] [options]",
    .summary = "Measures every method as one thing at a time gets worse, in six severities, on a scene's\n"
               "held-out photographs or on the synthetic monument (synth), whose truth is known. Goes on\n"
               "where an earlier run ended. docs/reference/stress.md lists the axes.",
    COMMAND_TABLE(stress_options), .inputs_min = 1, .inputs_max = 1, .run = run_report,
};

const struct command command_plot = {
    .name = "plot", .group = COMMAND_MEASURE,
    .brief = "figures of what bench or trim has measured",
    .usage = "FILE.json --out DIR",
    .summary = "Draws figures of what oriel bench --json has written (time by pass, memory by owner),\n"
               "or oriel trim --json (bytes after each step, loss against bytes).",
    COMMAND_TABLE(plot_options), .inputs_min = 1, .inputs_max = 1, .run = run_report,
};
