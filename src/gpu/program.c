// Programs, looked up by a key, and compute dispatch.
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "core/memory.h"
#include "core/process.h"
#include "gpu/internal.h"

struct orl_prog {
    char *key;         // owned: files, slots and defines
    GLuint id;         // 0: it does not compile, which was logged once
    GLuint params_buf; // created by the first dispatch
    size_t params_size; // size of the program's block at binding 0; 0: no block
    GLint group[3];     // invocations of a work group; of compute programs
};

// The shader files of a program's stages: of compute programs files[1] is NULL.
enum { STAGES = 2 };

static void log_failure(struct orl_gpu *gpu, const struct shader_source *source,
                        const char *what, const char *message)
{
    orl_logf(gpu->log, ORL_LOG_ERROR, "shaders/%s does not %s:\n%s", source->files[0], what,
             message);
    for (size_t i = 0; i < source->file_count; i++)
        orl_logf(gpu->log, ORL_LOG_ERROR, "  source %zu is shaders/%s", i, source->files[i]);
}

static bool attach(struct orl_gpu *gpu, GLenum type, const struct shader_source *source,
                   GLuint program)
{
    char message[2048] = "";
    GLint ok = 0;
    GLuint shader = glCreateShader(type);
    const GLchar *text = source->text.data;
    glShaderSource(shader, 1, &text, NULL);
    glCompileShader(shader);
    glGetShaderiv(shader, GL_COMPILE_STATUS, &ok);
    if (ok) {
        glAttachShader(program, shader);
    } else {
        glGetShaderInfoLog(shader, sizeof message, NULL, message);
        log_failure(gpu, source, "compile", message);
    }
    glDeleteShader(shader); // takes effect when the program is done with it
    return ok;
}

static bool link(struct orl_gpu *gpu, const struct shader_source *source, GLuint program)
{
    char message[2048] = "";
    GLint ok = 0;
    glProgramParameteri(program, GL_PROGRAM_BINARY_RETRIEVABLE_HINT, *gpu->program_cache != '\0');
    glLinkProgram(program);
    glGetProgramiv(program, GL_LINK_STATUS, &ok);
    if (!ok) {
        glGetProgramInfoLog(program, sizeof message, NULL, message);
        log_failure(gpu, source, "link", message);
    }
    return ok;
}

// Size of the uniform block at binding 0, bytes; 0: none.
static size_t find_params_size(GLuint program)
{
    GLint count = 0, binding = 0, size = 0;
    glGetProgramiv(program, GL_ACTIVE_UNIFORM_BLOCKS, &count);
    for (GLuint i = 0; i < (GLuint)count; i++) {
        glGetActiveUniformBlockiv(program, i, GL_UNIFORM_BLOCK_BINDING, &binding);
        glGetActiveUniformBlockiv(program, i, GL_UNIFORM_BLOCK_DATA_SIZE, &size);
        if (binding == 0)
            return (size_t)size;
    }
    return 0;
}

static bool make(struct orl_gpu *gpu, const char *const files[STAGES], const struct orl_slot *slots,
                 const char *defines, struct orl_prog *prog)
{
    static const GLenum raster[STAGES] = {GL_VERTEX_SHADER, GL_FRAGMENT_SHADER};
    struct shader_source sources[STAGES] = {0};
    double start = orl_time_s();
    bool ok = true, cached = false;
    bool cacheable = !files[1]; // only compute programs take long to compile
    const size_t count = cacheable ? 1 : STAGES;
    for (size_t i = 0; ok && i < count; i++)
        ok = orl_shader_source_load(gpu, files[i], slots, defines, &sources[i]) == ORL_OK;
    prog->id = glCreateProgram();
    if (ok && cacheable)
        cached = orl_program_cache_load(gpu, &sources[0], prog->id);
    for (size_t i = 0; ok && !cached && i < count; i++)
        ok = attach(gpu, cacheable ? GL_COMPUTE_SHADER : raster[i], &sources[i], prog->id);
    if (ok && !cached)
        ok = link(gpu, &sources[0], prog->id);
    if (ok && !cached && cacheable)
        orl_program_cache_store(gpu, &sources[0], prog->id);
    if (ok) {
        glObjectLabel(GL_PROGRAM, prog->id, -1, files[0]);
        prog->params_size = find_params_size(prog->id);
        if (!files[1])
            glGetProgramiv(prog->id, GL_COMPUTE_WORK_GROUP_SIZE, prog->group);
        orl_logf(gpu->log, ORL_LOG_DEBUG, "shaders/%s %s in %.0f ms", files[0],
                 cached ? "loaded" : "compiled", 1e3 * (orl_time_s() - start));
    } else {
        glDeleteProgram(prog->id);
        prog->id = 0;
    }
    for (size_t i = 0; i < count; i++)
        orl_shader_source_finish(&sources[i]);
    return orl_gpu_check_errors(gpu, files[0]) && ok;
}

// Everything that determines a program, as one string.
static char *make_key(const struct orl_log *log, const char *const files[STAGES],
                      const struct orl_slot *slots, const char *defines)
{
    char *key = orl_format(log, "%s\n%s\n%s", files[0], files[1] ? files[1] : "", defines ? defines : "");
    for (const struct orl_slot *s = slots; key && s && s->name; s++) {
        char *longer = orl_format(log, "%s\n%s=%s", key, s->name, s->file);
        free(key);
        key = longer;
    }
    return key;
}

static struct orl_prog *get(struct orl_gpu *gpu, const char *const files[STAGES],
                            const struct orl_slot *slots, const char *defines)
{
    struct orl_prog *prog = NULL;
    char *key = make_key(gpu->log, files, slots, defines);
    for (size_t i = 0; key && i < gpu->prog_count; i++)
        if (strcmp(gpu->progs[i]->key, key) == 0) {
            free(key);
            return gpu->progs[i];
        }
    if (key && ORL_GROW(gpu->log, gpu->progs, gpu->prog_capacity, gpu->prog_count) == ORL_OK)
        prog = orl_array(gpu->log, 1, sizeof *prog);
    if (!prog) {
        free(key);
        gpu->failed = true;
        return NULL;
    }
    prog->key = key;
    gpu->progs[gpu->prog_count++] = prog;
    if (!make(gpu, files, slots, defines, prog))
        gpu->failed = true;
    return prog;
}

struct orl_prog *orl_prog_get(struct orl_gpu *gpu, const char *file, const struct orl_slot *slots,
                              const char *defines)
{
    return get(gpu, (const char *const[STAGES]){file}, slots, defines);
}

struct orl_prog *orl_prog_get_raster(struct orl_gpu *gpu, const char *vertex_file,
                                     const char *fragment_file, const char *defines)
{
    return get(gpu, (const char *const[STAGES]){vertex_file, fragment_file}, NULL, defines);
}

bool orl_prog_reads(const struct orl_prog *prog, const char *name)
{
    return prog && prog->id &&
           glGetProgramResourceIndex(prog->id, GL_UNIFORM, name) != GL_INVALID_INDEX;
}

void orl_gpu_free_programs(struct orl_gpu *gpu)
{
    for (size_t i = 0; i < gpu->prog_count; i++) {
        struct orl_prog *prog = gpu->progs[i];
        glDeleteProgram(prog->id);
        glDeleteBuffers(1, &prog->params_buf);
        free(prog->key);
        free(prog);
    }
    free(gpu->progs);
    gpu->progs = NULL;
    gpu->prog_count = gpu->prog_capacity = 0;
}

bool orl_prog_use(struct orl_gpu *gpu, struct orl_prog *prog, const void *params, size_t size)
{
    if (!prog || !prog->id) {
        gpu->failed = true;
        return false;
    }
    if (prog->params_size > size) {
        orl_logf(gpu->log, ORL_LOG_ERROR, "shaders/%.*s: its block has %zu bytes, not %zu",
                 (int)strcspn(prog->key, "\n"), prog->key, prog->params_size, size);
        gpu->failed = true;
        return false;
    }
    glUseProgram(prog->id);
    if (!prog->params_size)
        return true;
    if (!prog->params_buf) {
        glCreateBuffers(1, &prog->params_buf);
        glNamedBufferStorage(prog->params_buf, (GLsizeiptr)prog->params_size, NULL,
                             GL_DYNAMIC_STORAGE_BIT);
    }
    glNamedBufferSubData(prog->params_buf, 0, (GLsizeiptr)prog->params_size, params);
    glBindBufferBase(GL_UNIFORM_BUFFER, 0, prog->params_buf);
    return true;
}

void orl_gpu_bind(const struct orl_tex *const *textures, const struct orl_tex *const *images, int layer)
{
    for (GLuint i = 0; i < ORL_BINDINGS_MAX; i++) {
        if (textures[i])
            glBindTextureUnit(i, textures[i]->id);
        if (images[i])
            glBindImageTexture(i, images[i]->id, 0, GL_FALSE, layer, GL_READ_WRITE, images[i]->params.format);
    }
}

void orl_gpu_barrier(void)
{
    glMemoryBarrier(GL_SHADER_IMAGE_ACCESS_BARRIER_BIT | GL_SHADER_STORAGE_BARRIER_BIT |
                    GL_TEXTURE_FETCH_BARRIER_BIT | GL_COMMAND_BARRIER_BIT);
}

static GLuint groups(int size, GLint group)
{
    return size > 0 ? orl_groups((size_t)size, (unsigned)group) : 1;
}

void orl_gpu_dispatch(struct orl_gpu *gpu, const struct orl_dispatch *d)
{
    if (!orl_prog_use(gpu, d->prog, d->params, d->params_size))
        return;
    for (GLuint i = 0; i < ORL_BINDINGS_MAX; i++)
        if (d->bufs[i])
            glBindBufferBase(GL_SHADER_STORAGE_BUFFER, i, d->bufs[i]->id);
    orl_gpu_bind(d->textures, d->images, d->layer);
    if (d->indirect) {
        glBindBuffer(GL_DISPATCH_INDIRECT_BUFFER, d->indirect->id);
        glDispatchComputeIndirect(0);
    } else {
        glDispatchCompute(groups(d->size[0], d->prog->group[0]), groups(d->size[1], d->prog->group[1]), 1);
    }
    orl_gpu_barrier();
    char file[96]; // that the key begins with
    snprintf(file, sizeof file, "%.*s", (int)strcspn(d->prog->key, "\n"), d->prog->key);
    orl_gpu_check_errors(gpu, file);
}
