// oriel stress: accuracy of all methods as one thing at a time gets worse.
#include <math.h>
#include <stdio.h>
#include <string.h>

#include "cli/command.h"
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

#define STRESS_OPTIONS(ROW) \
    ORL_STRESS_OPTIONS(ROW)
COMMAND_OPTIONS(stress_options, STRESS_OPTIONS)

static enum orl_result run_stress(struct terminal *terminal, const void *options,
                                  const struct common_options *common, const char *const *inputs)
{
    const struct stress_options *o = options;
    const struct orl_log *log = &terminal->log;
    const struct orl_stress_params params = {ORL_STRESS_OPTIONS(ORL_OPTION_COPY)
                                             .scene = inputs[0],
                                             .progress = &terminal->progress};
    struct orl_gpu *gpu = NULL;
    struct orl_stress stress = {0};
    enum orl_result result =
        orl_gpu_create(log, &(struct orl_gpu_params){.shader_dir = common->shader_dir,
                                                     .debug = common->verbose}, &gpu);
    if (result == ORL_OK)
        result = orl_stress_run(gpu, &params, &stress);
    if (result == ORL_OK) {
        print_losses(&stress);
        printf("%s%zu rows measured, %zu used again, %zu left out, %zu break an invariant: "
               "%s/%s\n", o->part.count ? "" : "\n", stress.measured, stress.reused, stress.left_out,
               stress.broken, params.out, o->part.count ? "rows" : "stress.html");
    }
    orl_stress_finish(&stress);
    orl_gpu_destroy(&gpu);
    return result;
}

static void print_axes(FILE *out)
{
    const char *name, *title;
    for (size_t i = 0; orl_stress_axis_name(i, &name, &title); i++)
        fprintf(out, "  %-17s %s\n", name, title);
}

const struct command command_stress = {
    .name = "stress", .group = COMMAND_MEASURE,
    .brief = "accuracy as one thing at a time gets worse, all methods",
    .usage = "SCENE|synth --out DIR [--quick] [options]",
    .summary = "Measures every method as one thing at a time gets worse, in six severities, on a scene's\n"
               "held-out photographs or on the synthetic monument (synth), whose truth is known. Goes on\n"
               "where an earlier run ended. What gets worse:",
    .print_more = print_axes,
    COMMAND_TABLE(stress_options), .inputs_min = 1, .inputs_max = 1, .run = run_stress,
};
