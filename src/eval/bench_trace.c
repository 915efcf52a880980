// The trace format of Chrome and Perfetto: complete events ("X") in microseconds, with one thread
// for the CPU and one for the device.
#include <jansson.h>

#include "eval/bench_internal.h"
#include "core/json.h"

enum { THREAD_FRAMES = 1, THREAD_CPU, THREAD_DEVICE };

static json_t *span(const char *name, int thread, double start_s, double end_s, double origin_s)
{
    return json_pack("{s:s, s:s, s:i, s:i, s:f, s:f}", "name", name, "ph", "X", "pid", 1, "tid",
                     thread, "ts", 1e6 * (start_s - origin_s), "dur", 1e6 * (end_s - start_s));
}

static json_t *thread_name(int thread, const char *name)
{
    return json_pack("{s:s, s:s, s:i, s:i, s:{s:s}}", "name", "thread_name", "ph", "M", "pid", 1,
                     "tid", thread, "args", "name", name);
}

enum orl_result orl_bench_write_trace(const struct orl_log *log, const char *path,
                                      const char *device, const struct orl_pass_trace *trace,
                                      const struct bench_frame_span *frames, size_t frame_count)
{
    double origin = frame_count ? frames[0].start_s : 0;
    json_t *events = json_array();
    json_array_append_new(events, thread_name(THREAD_FRAMES, "frames"));
    json_array_append_new(events, thread_name(THREAD_CPU, "CPU: passes asked for"));
    json_array_append_new(events, thread_name(THREAD_DEVICE, device));
    for (size_t i = 0; i < frame_count; i++)
        json_array_append_new(events, span("frame", THREAD_FRAMES, frames[i].start_s,
                                           frames[i].end_s, origin));
    for (size_t i = 0; i < trace->count; i++) {
        const struct orl_pass_span *s = &trace->spans[i];
        json_array_append_new(events,
                              span(s->name, THREAD_CPU, s->cpu_start_s, s->cpu_end_s, origin));
        json_array_append_new(events,
                              span(s->name, THREAD_DEVICE, s->gpu_start_s, s->gpu_end_s, origin));
    }
    if (trace->dropped)
        orl_logf(log, ORL_LOG_WARNING, "%s: %zu passes left out", path, trace->dropped);
    json_t *root = json_pack("{s:s, s:o}", "displayTimeUnit", "ms", "traceEvents", events);
    enum orl_result result = root ? orl_json_write(log, path, root)
                                  : orl_fail(log, ORL_ERR_MEMORY, "%s: no memory for it", path);
    json_decref(root);
    return result;
}
