// Runs with ORIEL_GPU_CHECK: reads the record of wrong indexes after every dispatch, and searches
// what was written for values that are not finite.
#include "gpu/check.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "core/memory.h"

enum {
    RECORD_BINDING = 7, // shaders/check/index.glsl
    MESSAGES_MAX = 32,  // of a device; faults beyond are counted only
};

struct record {
    uint32_t count, site;
    int32_t first, size;
};

struct orl_check {
    GLuint record;
    float *values; // what was read from a target
    size_t capacity;
    size_t runs, targets; // dispatches and draws; textures and arrays that were searched
    size_t faults;
};

enum orl_result orl_check_create(const struct orl_log *log, struct orl_check **out)
{
    struct orl_check *check = *out = orl_array(log, 1, sizeof *check);
    if (!check)
        return ORL_ERR_MEMORY;
    glCreateBuffers(1, &check->record);
    glNamedBufferStorage(check->record, sizeof(struct record), NULL, GL_DYNAMIC_STORAGE_BIT);
    return ORL_OK;
}

void orl_check_destroy(const struct orl_log *log, struct orl_check **handle)
{
    struct orl_check *check = *handle;
    if (!check)
        return;
    orl_logf(log, ORL_LOG_INFO, "checked on the device: %zu dispatches and draws, %zu targets; "
             "%zu faults", check->runs, check->targets, check->faults);
    glDeleteBuffers(1, &check->record);
    free(check->values);
    free(check);
    *handle = NULL;
}

void orl_check_begin(struct orl_check *check)
{
    static const struct record none;
    if (!check)
        return;
    glMemoryBarrier(GL_BUFFER_UPDATE_BARRIER_BIT);
    glNamedBufferSubData(check->record, 0, sizeof none, &none);
    glBindBufferBase(GL_SHADER_STORAGE_BUFFER, RECORD_BINDING, check->record);
}

// Counts a fault; true if there is still room for a message.
static bool count_fault(struct orl_gpu *gpu)
{
    gpu->failed = true;
    return ++gpu->check->faults <= MESSAGES_MAX;
}

// --- indexes ---

static void report_index(struct orl_gpu *gpu, const struct orl_prog *prog,
                         const struct record *record)
{
    struct orl_check_site site = orl_check_site_unpack(record->site);
    const char *file = orl_prog_file(prog, site.file), *text, *expression = NULL;
    uint8_t *owned = NULL;
    size_t length = 0;
    if (orl_shader_text(gpu, file, &file, &text, &owned) == ORL_OK)
        expression = orl_check_expression(text, &site, &length);
    orl_logf(gpu->log, ORL_LOG_ERROR, "shaders/%s:%u: %.*s: index %d, but the size is %d; %u wrong "
             "indexes in one dispatch of shaders/%s", file, site.line, (int)length,
             expression ? expression : "", (int)record->first, (int)record->size,
             (unsigned)record->count, orl_prog_file(prog, 0));
    free(owned);
}

static void check_indexes(struct orl_gpu *gpu, const struct orl_prog *prog)
{
    struct record record;
    glGetNamedBufferSubData(gpu->check->record, 0, sizeof record, &record);
    if (record.count && count_fault(gpu))
        report_index(gpu, prog, &record);
}

// --- values ---

// Room for `count` values; NULL, a sticky failure, if there is none.
static float *room(struct orl_gpu *gpu, size_t count)
{
    struct orl_check *check = gpu->check;
    if (orl_grow(gpu->log, (void **)&check->values, &check->capacity, count,
                 sizeof *check->values) == ORL_OK)
        return check->values;
    gpu->failed = true;
    return NULL;
}

struct finding {
    size_t nan, infinite, first; // first: index of the first of them
};

static bool find(const float *values, size_t count, struct finding *found)
{
    *found = (struct finding){0};
    for (size_t i = 0; i < count; i++) {
        if (isfinite(values[i]))
            continue;
        if (!found->nan && !found->infinite)
            found->first = i;
        *(isnan(values[i]) ? &found->nan : &found->infinite) += 1;
    }
    return found->nan || found->infinite;
}

static unsigned float_channels(GLenum format)
{
    switch (format) {
    case GL_R16F:
    case GL_R32F:
        return 1;
    case GL_RG16F:
    case GL_RG32F:
        return 2;
    case GL_RGBA16F:
    case GL_RGBA32F:
        return 4;
    default: // integers; formats that hold finite values alone
        return 0;
    }
}

// Searches one level of a texture; layer < 0: all layers.
static void check_texture(struct orl_gpu *gpu, const struct orl_prog *prog,
                          const struct orl_tex *tex, int level, int layer)
{
    static const GLenum formats[] = {0, GL_RED, GL_RG, 0, GL_RGBA};
    const struct orl_tex_params *p = &tex->params;
    unsigned channels = float_channels(p->format);
    int width = p->width >> level ? p->width >> level : 1;
    int height = p->height >> level ? p->height >> level : 1;
    int layers = layer < 0 && p->layers ? p->layers : 1;
    size_t count = (size_t)width * (size_t)height * (size_t)layers * channels;
    GLint kind = 0;
    glGetTextureParameteriv(tex->id, GL_TEXTURE_TARGET, &kind);
    float *values = channels && kind != GL_TEXTURE_BUFFER ? room(gpu, count) : NULL;
    if (!values)
        return;
    gpu->check->targets++;
    glGetTextureSubImage(tex->id, level, 0, 0, layer < 0 ? 0 : layer, width, height, layers,
                         formats[channels], GL_FLOAT, (GLsizei)(count * sizeof *values), values);
    struct finding found;
    if (!find(values, count, &found) || !count_fault(gpu))
        return;
    size_t pixel = found.first / channels;
    orl_logf(gpu->log, ORL_LOG_ERROR, "shaders/%s: texture \"%s\", level %d: %zu NaN and %zu "
             "infinite values, the first at pixel (%zu, %zu), channel %zu", orl_prog_file(prog, 0),
             p->tag, level, found.nan, found.infinite, pixel % (size_t)width,
             pixel / (size_t)width, found.first % channels);
}

// Searches an array of float or of vectors, which a program writes or reads at `binding`.
static void check_array(struct orl_gpu *gpu, const struct orl_prog *prog,
                        const struct orl_buf_binding *bound, const char *name, size_t offset)
{
    const struct orl_buf *buf = bound->buf;
    size_t size = bound->size ? bound->size : buf->size - bound->offset;
    size_t count = size > offset ? (size - offset) / sizeof(float) : 0;
    float *values = count ? room(gpu, count) : NULL;
    struct finding found;
    if (!values)
        return;
    gpu->check->targets++;
    glGetNamedBufferSubData(buf->id, (GLintptr)(bound->offset + offset),
                            (GLsizeiptr)(count * sizeof *values), values);
    if (find(values, count, &found) && count_fault(gpu))
        orl_logf(gpu->log, ORL_LOG_ERROR, "shaders/%s: %s of buffer \"%s\": %zu NaN and %zu "
                 "infinite values, the first is number %zu", orl_prog_file(prog, 0), name,
                 buf->tag, found.nan, found.infinite, found.first);
}

// The floating point arrays that end the buffers of a program, as the driver tells of them.
static void check_arrays(struct orl_gpu *gpu, const struct orl_dispatch *d)
{
    enum { TYPE, OFFSET, BLOCK };
    static const GLenum asked[] = {GL_TYPE, GL_OFFSET, GL_BLOCK_INDEX};
    static const GLenum binding_asked = GL_BUFFER_BINDING;
    GLuint id = orl_prog_id(d->prog);
    GLint count = 0, got[ORL_COUNT(asked)], binding = 0;
    glGetProgramInterfaceiv(id, GL_BUFFER_VARIABLE, GL_ACTIVE_RESOURCES, &count);
    for (GLuint i = 0; i < (GLuint)count; i++) {
        char name[64] = "";
        glGetProgramResourceiv(id, GL_BUFFER_VARIABLE, i, ORL_COUNT(asked), asked, ORL_COUNT(got),
                               NULL, got);
        bool floats = got[TYPE] == GL_FLOAT || got[TYPE] == GL_FLOAT_VEC2 ||
                      got[TYPE] == GL_FLOAT_VEC4;
        if (!floats)
            continue;
        glGetProgramResourceiv(id, GL_SHADER_STORAGE_BLOCK, (GLuint)got[BLOCK], 1, &binding_asked,
                               1, NULL, &binding);
        glGetProgramResourceName(id, GL_BUFFER_VARIABLE, i, sizeof name, NULL, name);
        if (binding < ORL_BINDINGS_MAX && d->bufs[binding].buf)
            check_array(gpu, d->prog, &d->bufs[binding], name, (size_t)got[OFFSET]);
    }
}

void orl_check_dispatch(struct orl_gpu *gpu, const struct orl_dispatch *d)
{
    if (!gpu->check)
        return;
    gpu->check->runs++;
    glMemoryBarrier(GL_BUFFER_UPDATE_BARRIER_BIT | GL_TEXTURE_UPDATE_BARRIER_BIT);
    check_indexes(gpu, d->prog);
    for (size_t i = 0; i < ORL_BINDINGS_MAX; i++)
        if (d->images[i].tex && d->images[i].access != GL_READ_ONLY)
            check_texture(gpu, d->prog, d->images[i].tex, d->images[i].level,
                          d->image_layers[i] - 1);
    check_arrays(gpu, d);
}

void orl_check_raster(struct orl_gpu *gpu, const struct orl_raster *r)
{
    if (!gpu->check)
        return;
    gpu->check->runs++;
    for (size_t i = 0; i < ORL_RASTER_TARGETS_MAX; i++)
        if (r->targets[i])
            check_texture(gpu, r->prog, r->targets[i], 0, -1);
}
