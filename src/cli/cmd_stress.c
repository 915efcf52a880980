// oriel stress: accuracy of all methods as one thing at a time gets worse.
#include <math.h>
#include <stdio.h>
#include <string.h>

#include "cli/commands.h"
#include "eval/stress.h"

static void print_losses(const struct orl_stress *stress)
{
    const char *axis = "";
    for (size_t i = 0; i < stress->loss_count; i++) {
        const struct orl_stress_loss *loss = &stress->losses[i];
        if (strcmp(axis, loss->axis) != 0)
            printf("%s%-14s %9s %9s %9s %9s %9s  (%s%s%s)\n", i ? "\n" : "", "method", "first dB",
                   "worst dB", "-1 dB at", "-3 dB at", "-6 dB at", loss->axis,
                   loss->unit[0] ? ", " : "", loss->unit);
        axis = loss->axis;
        printf("%-14s %9.2f %9.2f", loss->method, loss->start_db, loss->worst_db);
        for (size_t k = 0; k < ORL_STRESS_LOSSES; k++)
            if (isfinite(loss->at[k]))
                printf(" %9.2f", loss->at[k]);
            else
                printf(" %9s", "-");
        printf("\n");
    }
}

static enum orl_result run(const struct terminal *terminal, const struct orl_stress_params *given,
                           const char *part, const struct arg_common *common)
{
    const struct orl_log *log = &terminal->log;
    struct orl_stress_params params = *given;
    struct orl_gpu *gpu = NULL;
    struct orl_stress stress = {0};
    if (!params.out)
        return orl_fail(log, ORL_ERR_ARGUMENT, "stress: --out DIR is needed");
    params.progress = &terminal->progress;
    enum orl_result result =
        part ? args_part(log, part, &params.part.part, &params.part.parts) : ORL_OK;
    if (result == ORL_OK)
        result = orl_gpu_create(log, &(struct orl_gpu_params){.shader_dir = common->shader_dir,
                                                              .debug = common->verbose}, &gpu);
    if (result == ORL_OK)
        result = orl_stress_run(gpu, &params, &stress);
    if (result == ORL_OK) {
        print_losses(&stress);
        printf("%s%zu rows measured, %zu used again, %zu left out, %zu break an invariant: "
               "%s/%s\n", part ? "" : "\n", stress.measured, stress.reused, stress.left_out,
               stress.broken, params.out, part ? "rows" : "stress.html");
    }
    orl_stress_finish(&stress);
    orl_gpu_destroy(&gpu);
    return result;
}

static void list_axes(char *summary, size_t size)
{
    const char *name, *title;
    for (size_t i = 0; orl_stress_axis_name(i, &name, &title); i++) {
        size_t length = strlen(summary);
        snprintf(summary + length, size - length, "\n  %-17s %s", name, title);
    }
}

int cmd_stress(int argc, char **argv)
{
    struct orl_names methods = {0}, axes = {0};
    struct orl_stress_params params = {ORL_STRESS_DEFAULTS, .methods = &methods, .axes = &axes};
    const char *part = NULL;
    int views = (int)params.views, seed = (int)params.seed;
    const struct arg_option table[] = {
        {"out", ARG_STRING, &params.out, "DIR",
         "the report: stress.html, stress.json, figures; rows in it are used again", 0, 0},
        {"axes", ARG_LIST, &axes, "NAME,..", "what gets worse; default: all that the scene serves",
         0, 0},
        {"method", ARG_LIST, &methods, "NAME", "methods; default: all", 0, 0},
        {"quick", ARG_FLAG, &params.quick, NULL,
         "an overview: one view, three of the six severities", 0, 0},
        {"size", ARG_INT, &params.side, "PX", "longer side of photographs and pictures; default 192",
         ORL_STRESS_SIDE_MIN, ORL_STRESS_SIDE_MAX},
        {"photographs", ARG_INT, &params.photographs, "N", "of the synthetic monument; default 16",
         ORL_STRESS_PHOTOGRAPHS_MIN, 500},
        {"views", ARG_INT, &views, "N", "held-out photographs, at most; default 2", 1, 100},
        {"part", ARG_STRING, &part, "K/N",
         "only the K-th of N parts of the rows, kept for a run of all (oriel plan)", 0, 0},
        {"seed", ARG_INT, &seed, "N", "of everything random; default 1", 0, INT32_MAX},
        {0},
    };
    char summary[2048] = "Measures every method as one thing at a time gets worse, in six "
                         "severities, on a scene's\nheld-out photographs or on the synthetic "
                         "monument (synth), whose truth is known. Goes on\nwhere an earlier run "
                         "ended. What gets worse:";
    list_axes(summary, sizeof summary);
    const struct arg_command command = {
        .name = "stress", .usage = "SCENE|synth --out DIR [--quick] [options]",
        .summary = summary, .options = table, .positionals_min = 1, .positionals_max = 1};
    struct arg_common common = {0};
    struct terminal terminal;
    size_t count;
    int status;
    if (command_begin(&command, argc, argv, &common, &terminal, &params.scene, &count, &status)) {
        params.views = (size_t)views;
        params.seed = (uint32_t)seed;
        enum orl_result result = run(&terminal, &params, part, &common);
        if (fflush(stdout) != 0 && result == ORL_OK)
            result = orl_fail(&terminal.log, ORL_ERR_IO, "standard output: cannot write");
        status = command_status(result);
        terminal_finish(&terminal);
    }
    orl_names_finish(&methods);
    orl_names_finish(&axes);
    return status;
}
