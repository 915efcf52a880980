// Pass timers: GL timestamps resolved late on a GPU, drained wall time on a
// software renderer.
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
        glGetQueryObjectui64v(gpu->queries[i].begin, GL_QUERY_RESULT, &begin);
        glGetQueryObjectui64v(gpu->queries[i].end, GL_QUERY_RESULT, &end);
        gpu->passes[gpu->queries[i].pass].ms += 1e-6 * (double)(end - begin);
    }
    gpu->query_count = 0;
}

void orl_pass_begin(struct orl_gpu *gpu, const char *name)
{
    glPushDebugGroup(GL_DEBUG_SOURCE_APPLICATION, 0, -1, name);
    gpu->pass = gpu->timing ? find_pass(gpu, name) : -1;
    if (gpu->pass < 0)
        return;
    if (gpu->caps.software) {
        glFinish();
        gpu->pass_start_s = orl_time_s();
        return;
    }
    if (gpu->query_count == ORL_QUERIES_MAX)
        resolve_queries(gpu);
    struct pass_query *query = &gpu->queries[gpu->query_count];
    if (!query->begin)
        glCreateQueries(GL_TIMESTAMP, 1, &query->begin);
    if (!query->end)
        glCreateQueries(GL_TIMESTAMP, 1, &query->end);
    query->pass = gpu->pass;
    glQueryCounter(query->begin, GL_TIMESTAMP);
}

void orl_pass_end(struct orl_gpu *gpu)
{
    glPopDebugGroup();
    if (gpu->pass < 0)
        return;
    struct orl_pass_time *pass = &gpu->passes[gpu->pass];
    pass->count++;
    if (gpu->caps.software) {
        glFinish();
        pass->ms += 1e3 * (orl_time_s() - gpu->pass_start_s);
    } else {
        glQueryCounter(gpu->queries[gpu->query_count++].end, GL_TIMESTAMP);
    }
    gpu->pass = -1;
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
    for (size_t i = 0; i < ORL_QUERIES_MAX; i++) {
        glDeleteQueries(1, &gpu->queries[i].begin);
        glDeleteQueries(1, &gpu->queries[i].end);
    }
}
