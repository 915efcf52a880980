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

static void print_run(const struct orl_bench_run *run)
{
    char varied[32];
    orl_bench_run_print(run, varied);
    printf("%-12s %-22s %9.2f %9.2f %8.1f %7zu %9.1f ", run->method, varied,
           run->timing.median_ms, run->timing.slowest_ms,
           run->timing.median_ms > 0 ? 1e3 / run->timing.median_ms : 0.0, run->timing.frames,
           mib(run->device_bytes));
    for (size_t i = 0; i < run->timing.pass_count; i++)
        printf("%s %s %.2f", i ? "," : "", run->timing.passes[i].name, run->timing.passes[i].ms);
    if (run->psnr_db > 0)
        printf("; %.1f dB to full size", run->psnr_db);
    printf("\n");
}

static void print_runs(const struct orl_bench *bench)
{
    for (size_t i = 0; i < bench->run_count; i++) {
        const struct orl_bench_run *run = &bench->runs[i];
        if (i == 0 || run->kind != run[-1].kind)
            printf("\n%-12s %-22s %9s %9s %8s %7s %9s  %s\n", "method",
                   orl_bench_kind_names[run->kind], "frame ms", "slowest", "fps", "frames", "MiB",
                   "ms by pass");
        print_run(run);
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
    .summary = "Measures frames: time pass by pass, memory by owner, and how both grow with points,\n"
               "photographs and their resolution. Medians; the device is named.",
    COMMAND_TABLE(bench_options), .inputs_min = 1, .inputs_max = 1, .run = run_bench,
};
