// Pass timers: GL timestamps that are read late on a GPU, and wall time with the pipeline drained
// on a software renderer.
#include <string.h>

#include "core/process.h"
#include "gpu/internal.h"

void orl_gpu_time_passes(struct orl_gpu *gpu, bool enabled)
{
    gpu->timing = enabled;
}

static int find_pass(struct orl_gpu *gpu, const char *name)
{
    for (size_t i = 0; i < gpu->pass_count; i++)
        if (strcmp(gpu->passes[i].name, name) == 0)
            return (int)i;
    if (gpu->pass_count == ORL_PASSES_MAX)
        return -1;
    gpu->passes[gpu->pass_count] = (struct orl_pass_time){.name = name};
    return (int)gpu->pass_count++;
}

static void resolve_queries(struct orl_gpu *gpu)
{
    for (size_t i = 0; i < gpu->query_count; i++) {
        GLuint64 begin = 0, end = 0;
        glGetQueryObjectui64v(gpu->queries[i].ids[0], GL_QUERY_RESULT, &begin);
        glGetQueryObjectui64v(gpu->queries[i].ids[1], GL_QUERY_RESULT, &end);
        gpu->passes[gpu->queries[i].pass].ms += 1e-6 * (double)(end - begin);
        if (gpu->queries[i].span) {
            gpu->queries[i].span->gpu_start_s = 1e-9 * (double)begin + gpu->clock_offset_s;
            gpu->queries[i].span->gpu_end_s = 1e-9 * (double)end + gpu->clock_offset_s;
        }
    }
    gpu->query_count = 0;
}

void orl_pass_begin(struct orl_gpu *gpu, const char *name)
{
    glPushDebugGroup(GL_DEBUG_SOURCE_APPLICATION, 0, -1, name);
    gpu->pass = gpu->timing ? find_pass(gpu, name) : -1;
    if (gpu->pass < 0)
        return;
    if (gpu->caps.software)
        glFinish();
    gpu->pass_start_s = orl_time_s();
    if (gpu->caps.software)
        return;
    if (gpu->query_count == ORL_QUERIES_MAX)
        resolve_queries(gpu);
    struct pass_query *query = &gpu->queries[gpu->query_count];
    if (!query->ids[0])
        glCreateQueries(GL_TIMESTAMP, 2, query->ids);
    query->pass = gpu->pass;
    glQueryCounter(query->ids[0], GL_TIMESTAMP);
}

// Appends a span to the trace and sets its CPU start. NULL without a trace or room in it.
static struct orl_pass_span *add_span(struct orl_gpu *gpu, const char *name)
{
    struct orl_pass_trace *trace = gpu->trace;
    if (!trace)
        return NULL;
    if (trace->count == trace->capacity) {
        trace->dropped++;
        return NULL;
    }
    struct orl_pass_span *span = &trace->spans[trace->count++];
    *span = (struct orl_pass_span){.name = name, .cpu_start_s = gpu->pass_start_s,
                                   .cpu_end_s = orl_time_s()};
    return span;
}

void orl_pass_end(struct orl_gpu *gpu)
{
    glPopDebugGroup();
    if (gpu->pass < 0)
        return;
    struct orl_pass_time *pass = &gpu->passes[gpu->pass];
    struct orl_pass_span *span = add_span(gpu, pass->name);
    pass->count++;
    if (gpu->caps.software) {
        glFinish();
        double end_s = orl_time_s();
        pass->ms += 1e3 * (end_s - gpu->pass_start_s);
        if (span) {
            span->gpu_start_s = gpu->pass_start_s;
            span->gpu_end_s = end_s;
        }
    } else {
        gpu->queries[gpu->query_count].span = span;
        glQueryCounter(gpu->queries[gpu->query_count++].ids[1], GL_TIMESTAMP);
    }
    gpu->pass = -1;
}

void orl_gpu_pass(struct orl_gpu *gpu, const char *name, const struct orl_dispatch *dispatch)
{
    orl_pass_begin(gpu, name);
    orl_gpu_dispatch(gpu, dispatch);
    orl_pass_end(gpu);
}

void orl_gpu_trace_passes(struct orl_gpu *gpu, struct orl_pass_trace *trace)
{
    resolve_queries(gpu);
    gpu->trace = trace;
    if (!trace)
        return;
    GLint64 now = 0;
    glGetInteger64v(GL_TIMESTAMP, &now);
    gpu->clock_offset_s = orl_time_s() - 1e-9 * (double)now;
}

size_t orl_gpu_take_times(struct orl_gpu *gpu, struct orl_pass_time *times, size_t capacity)
{
    resolve_queries(gpu);
    size_t count = gpu->pass_count;
    for (size_t i = 0; i < count && i < capacity; i++)
        times[i] = gpu->passes[i];
    gpu->pass_count = 0;
    return count;
}

void orl_gpu_free_queries(struct orl_gpu *gpu)
{
    for (size_t i = 0; i < ORL_QUERIES_MAX; i++)
        glDeleteQueries(2, gpu->queries[i].ids);
}
