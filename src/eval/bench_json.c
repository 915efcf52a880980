// The benchmark's report (docs/reference/json.md). Field names are fixed.
#include "core/json.h"
#include "eval/bench.h"

static json_t *passes_json(const struct orl_bench_run *run)
{
    json_t *passes = json_object();
    for (size_t i = 0; i < run->timing.pass_count; i++) {
        const struct orl_timing_pass *pass = &run->timing.passes[i];
        json_object_set_new(passes, pass->name, json_real(pass->ms));
    }
    return passes;
}

static json_t *run_json(const struct orl_bench_run *run)
{
    json_t *object = json_pack(
        "{s:s, s:[i,i], s:I, s:I, s:i, s:I, s:f, s:f, s:f, s:f, s:I, s:I, s:o}", "method", run->method,
        "size", run->size.width, run->size.height, "photographs", (json_int_t)run->photographs, "points",
        (json_int_t)run->points, "photo_divide", run->photo_divide, "frames",
        (json_int_t)run->timing.frames, "frame_ms", run->timing.median_ms, "slowest_ms",
        run->timing.slowest_ms, "cpu_ms", run->timing.cpu_ms, "fps",
        run->timing.median_ms > 0 ? 1e3 / run->timing.median_ms : 0.0, "device_bytes",
        (json_int_t)run->device_bytes, "uploaded_bytes", (json_int_t)run->uploaded_bytes,
        "passes_ms", passes_json(run));
    if (run->psnr_db > 0)
        json_object_set_new(object, "psnr_db", json_real(run->psnr_db));
    return object;
}

static json_t *runs_json(const struct orl_bench *bench, enum orl_bench_kind kind)
{
    json_t *array = json_array();
    for (size_t i = 0; i < bench->run_count; i++)
        if (bench->runs[i].kind == kind)
            json_array_append_new(array, run_json(&bench->runs[i]));
    return array;
}

static json_t *rasters_json(const struct orl_bench *bench)
{
    json_t *array = json_array();
    for (size_t i = 0; i < bench->run_count; i++) {
        const struct orl_bench_run *r = &bench->runs[i];
        if (r->gl_points_frames)
            json_array_append_new(array, json_pack(
                "{s:I, s:[i,i], s:I, s:f, s:f}", "points", (json_int_t)r->points, "size",
                r->size.width, r->size.height, "frames", (json_int_t)r->gl_points_frames,
                "splat_ms", orl_bench_splat_ms(r), "gl_points_ms", r->gl_points_ms));
    }
    return array;
}

static json_t *memory_json(const struct orl_bench *bench)
{
    json_t *array = json_array();
    for (size_t i = 0; i < bench->memory_count; i++)
        json_array_append_new(array, json_pack(
            "{s:s, s:s, s:I, s:I}", "owner", orl_owner_names[bench->memory[i].owner],
            "tag", bench->memory[i].tag, "bytes", (json_int_t)bench->memory[i].bytes, "objects",
            (json_int_t)bench->memory[i].objects));
    return array;
}

json_t *orl_bench_report(const struct orl_bench *bench)
{
    return json_pack(
        "{s:o, s:s, s:s, s:b, s:I, s:I, s:I, s:[i,i], s:I, s:o, s:o, s:o, s:o, s:o, s:o}", "scene",
        orl_json_string(bench->scene->dir), "device", bench->device, "driver", bench->driver, "software",
        bench->software, "points", (json_int_t)orl_scene_point_count(bench->scene),
        "time_steps", (json_int_t)bench->scene->frame_count, "photographs", (json_int_t)bench->photographs,
        "photo_size", bench->photo_width, bench->photo_height,
        "host_peak_bytes", (json_int_t)bench->host_peak_bytes, "memory", memory_json(bench),
        "sizes", runs_json(bench, ORL_BENCH_SIZES), "by_photographs",
        runs_json(bench, ORL_BENCH_PHOTOGRAPHS), "by_points", runs_json(bench, ORL_BENCH_POINTS),
        "by_resolution", runs_json(bench, ORL_BENCH_RESOLUTION), "gl_points",
        rasters_json(bench));
}
