// oriel bench: what a frame costs, in time by pass and in memory by owner.
#include <stdio.h>

#include "cli/command.h"
#include "cli/command_output.h"
#include "eval/bench.h"

#define BENCH_OPTIONS(ROW) \
    ROW(methods, "method", LIST("NAME"), "methods, or all; default: the scene's, or the first") \
    ROW(settings, "set", LIST("KEY=VALUE"), "change an option of the methods") \
    ORL_BENCH_OPTIONS(ROW) \
    ROW(json, "json", TEXT("FILE"), "write the figures as JSON; - for stdout")
COMMAND_OPTIONS(bench_options, BENCH_OPTIONS)

// --- tables on stdout ---

static double mib(size_t bytes)
{
    return (double)bytes / (1 << 20);
}

static void print_memory(const struct orl_bench *bench)
{
    size_t all = 0;
    printf("\n%-14s %10s   %s\n", "memory", "MiB", "of");
    for (int owner = 0; owner < ORL_OWNER_COUNT; owner++) {
        size_t sum = 0;
        for (size_t i = 0; i < bench->memory_count; i++)
            sum += (int)bench->memory[i].owner == owner ? bench->memory[i].bytes : 0;
        printf("%-14s %10.1f  ", orl_owner_names[owner], mib(sum));
        for (size_t i = 0, first = 1; i < bench->memory_count; i++)
            if ((int)bench->memory[i].owner == owner && bench->memory[i].bytes > 1 << 16) {
                printf("%s %s %.1f", first ? "" : ",", bench->memory[i].tag,
                       mib(bench->memory[i].bytes));
                first = 0;
            }
        printf("\n");
        all += sum;
    }
    printf("%-14s %10.1f\n%-14s %10.1f   at most\n", "device", mib(all), "host",
           mib(bench->host_peak_bytes));
}

static void print_runs(const struct orl_bench *bench)
{
    printf("\n%-12s %-22s %9s %9s %8s %7s %9s  %s\n", "method", "picture", "frame ms", "slowest", "fps",
           "frames", "MiB", "ms by pass");
    for (size_t i = 0; i < bench->run_count; i++) {
        const struct orl_bench_run *run = &bench->runs[i];
        const struct orl_timing *timing = &run->timing;
        char size[32];
        snprintf(size, sizeof size, "%dx%d", run->size.width, run->size.height);
        printf("%-12s %-22s %9.2f %9.2f %8.1f %7zu %9.1f ", run->method, size, timing->median_ms,
               timing->slowest_ms, timing->median_ms > 0 ? 1e3 / timing->median_ms : 0.0,
               timing->frames, mib(run->device_bytes));
        for (size_t k = 0; k < timing->pass_count; k++)
            printf("%s %s %.2f", k ? "," : "", timing->passes[k].name, timing->passes[k].ms);
        printf("\n");
    }
}

static void print_tables(const struct orl_bench *bench)
{
    printf("scene        %s\npoints       %zu\nphotographs  %zu of up to %dx%d\n"
           "device       %s%s, OpenGL %s\n", bench->scene->dir, orl_scene_point_count(bench->scene),
           bench->photographs, bench->photo_width, bench->photo_height, bench->device,
           bench->software ? " (software)" : "", bench->driver);
    if (bench->scene->frame_count)
        printf("time steps   %zu, another one in each frame\n", bench->scene->frame_count);
    print_memory(bench);
    print_runs(bench);
}

// --- the command ---

static enum orl_result report(const struct orl_log *log, const struct bench_options *o,
                              const struct orl_bench *bench)
{
    if (!report_on_stdout(o->json))
        print_tables(bench);
    return o->json ? report_write(log, o->json, orl_bench_report(bench)) : ORL_OK;
}

static enum orl_result run_bench(struct call *call)
{
    const struct bench_options *o = call->options;
    struct orl_choices choices = {0};
    struct orl_bench bench = {0};
    const struct orl_bench_params params = {ORL_BENCH_OPTIONS(ORL_OPTION_COPY) .choices = &choices,
                                            .progress = call->progress};
    enum orl_result result = command_scene(call, NULL);
    ORL_THEN(result, orl_choices_make(call->log, call->scene, ORL_SAMPLE_SRGB, &o->methods, &o->settings, NULL,
                                      &choices));
    ORL_THEN(result, command_device(call));
    ORL_THEN(result, orl_bench_run(call->gpu, call->scene, &params, &bench));
    ORL_THEN(result, report(call->log, o, &bench));
    orl_bench_finish(&bench);
    orl_choices_finish(&choices);
    return result;
}

const struct command command_bench = {
    .name = "bench", .group = COMMAND_MEASURE,
    .brief = "time and memory of frames, pass by pass",
    .usage = "SCENE [options]",
    .summary = "Measures frames: time pass by pass and memory by owner. Medians; the device is named.",
    COMMAND_TABLE(bench_options), .inputs_min = 1, .inputs_max = 1, .run = run_bench,
};
