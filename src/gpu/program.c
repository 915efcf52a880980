// Compute programs and their dispatch.
#include <stdlib.h>

#include "core/memory.h"
#include "core/process.h"
#include "gpu/internal.h"

struct orl_prog {
    GLuint id, params_buf;
    size_t params_size;
    const char *file; // string of the shader table
};

static void log_sources(struct orl_gpu *gpu, const struct shader_source *source)
{
    for (size_t i = 0; i < source->file_count; i++)
        orl_logf(gpu->log, ORL_LOG_ERROR, "  source %zu is shaders/%s", i, source->files[i]);
}

static enum orl_result compile(struct orl_gpu *gpu, const char *file,
                               const struct shader_source *source, GLuint program)
{
    char message[2048] = "";
    GLint ok = 0;
    GLuint shader = glCreateShader(GL_COMPUTE_SHADER);
    const GLchar *text = source->text;
    glShaderSource(shader, 1, &text, NULL);
    glCompileShader(shader);
    glGetShaderiv(shader, GL_COMPILE_STATUS, &ok);
    if (!ok) {
        glGetShaderInfoLog(shader, sizeof message, NULL, message);
    } else {
        glAttachShader(program, shader);
        glProgramParameteri(program, GL_PROGRAM_BINARY_RETRIEVABLE_HINT,
                            gpu->program_cache != NULL);
        glLinkProgram(program);
        glGetProgramiv(program, GL_LINK_STATUS, &ok);
        if (!ok)
            glGetProgramInfoLog(program, sizeof message, NULL, message);
        glDetachShader(program, shader);
    }
    glDeleteShader(shader);
    if (ok)
        return ORL_OK;
    orl_logf(gpu->log, ORL_LOG_ERROR, "shaders/%s does not compile:\n%s", file, message);
    log_sources(gpu, source);
    return ORL_ERR_GPU;
}

enum orl_result orl_prog_create(struct orl_gpu *gpu, const char *file, const char *defines,
                                size_t params_size, struct orl_prog **out)
{
    *out = NULL;
    struct shader_source source;
    enum orl_result result = orl_shader_source_load(gpu, file, defines, &source);
    if (result != ORL_OK)
        return result;
    double start = orl_time_s();
    struct orl_prog *prog = orl_array(gpu->log, 1, sizeof *prog);
    if (!prog) {
        result = ORL_ERR_MEMORY;
        goto end;
    }
    gpu->live_progs++;
    prog->file = source.files[0];
    prog->params_size = params_size;
    prog->id = glCreateProgram();
    bool cached = orl_program_cache_load(gpu, &source, prog->id);
    if (!cached) {
        result = compile(gpu, file, &source, prog->id);
        if (result != ORL_OK)
            goto end;
        orl_program_cache_store(gpu, &source, prog->id);
    }
    glObjectLabel(GL_PROGRAM, prog->id, -1, prog->file);
    if (params_size) {
        glCreateBuffers(1, &prog->params_buf);
        glNamedBufferStorage(prog->params_buf, (GLsizeiptr)params_size, NULL,
                             GL_DYNAMIC_STORAGE_BIT);
    }
    if (!orl_gpu_check_errors(gpu, file)) {
        result = ORL_ERR_GPU;
        goto end;
    }
    orl_logf(gpu->log, ORL_LOG_DEBUG, "shaders/%s %s in %.0f ms", file,
             cached ? "loaded" : "compiled", 1e3 * (orl_time_s() - start));
    *out = prog;
    prog = NULL;
end:
    orl_prog_destroy(gpu, &prog);
    orl_shader_source_finish(&source);
    return result;
}

size_t orl_gpu_cached_programs(const struct orl_gpu *gpu)
{
    return gpu->cached_progs;
}

void orl_prog_destroy(struct orl_gpu *gpu, struct orl_prog **handle)
{
    struct orl_prog *prog = *handle;
    if (!prog)
        return;
    glDeleteProgram(prog->id);
    if (prog->params_buf)
        glDeleteBuffers(1, &prog->params_buf);
    gpu->live_progs--;
    free(prog);
    *handle = NULL;
}

void orl_gpu_dispatch(struct orl_gpu *gpu, const struct orl_dispatch *d)
{
    glUseProgram(d->prog->id);
    if (d->prog->params_size) {
        glNamedBufferSubData(d->prog->params_buf, 0, (GLsizeiptr)d->prog->params_size, d->params);
        glBindBufferBase(GL_UNIFORM_BUFFER, 0, d->prog->params_buf);
    }
    for (GLuint i = 0; i < ORL_BINDINGS_MAX; i++) {
        const struct orl_buf_binding *b = &d->bufs[i];
        if (b->buf)
            glBindBufferRange(GL_SHADER_STORAGE_BUFFER, i, b->buf->id, (GLintptr)b->offset,
                              (GLsizeiptr)(b->size ? b->size : b->buf->size - b->offset));
        if (d->textures[i])
            glBindTextureUnit(i, d->textures[i]->id);
        const struct orl_image_binding *image = &d->images[i];
        if (image->tex)
            glBindImageTexture(i, image->tex->id, image->level, image->tex->params.layers > 0, 0,
                               image->access, image->tex->params.format);
    }
    if (d->indirect) {
        glBindBuffer(GL_DISPATCH_INDIRECT_BUFFER, d->indirect->id);
        glDispatchComputeIndirect(0);
    } else {
        glDispatchCompute(d->groups[0] ? d->groups[0] : 1, d->groups[1] ? d->groups[1] : 1,
                          d->groups[2] ? d->groups[2] : 1);
    }
    if (d->barrier)
        glMemoryBarrier(d->barrier);
    if (glGetError() != GL_NO_ERROR) {
        orl_logf(gpu->log, ORL_LOG_ERROR, "shaders/%s: dispatch failed", d->prog->file);
        gpu->failed = true;
    }
}
