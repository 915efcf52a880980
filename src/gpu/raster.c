#include "gpu/raster.h"

#include "gpu/internal.h"

// Vertex inputs and targets are set for every draw, since there are only a few draws a frame.
static void bind_inputs(GLuint array, const struct orl_raster *r)
{
    for (GLuint i = 0; i < ORL_RASTER_INPUTS_MAX; i++) {
        const struct orl_raster_input *input = &r->inputs[i];
        if (!input->buf) {
            glDisableVertexArrayAttrib(array, i);
            continue;
        }
        glVertexArrayVertexBuffer(array, i, input->buf->id, (GLintptr)input->offset,
                                  (GLsizei)input->stride);
        glVertexArrayBindingDivisor(array, i, input->per_instance);
        if (input->type == GL_UNSIGNED_INT)
            glVertexArrayAttribIFormat(array, i, input->components, input->type, 0);
        else
            glVertexArrayAttribFormat(array, i, input->components, input->type,
                                      input->type == GL_UNSIGNED_BYTE, 0);
        glVertexArrayAttribBinding(array, i, i);
        glEnableVertexArrayAttrib(array, i);
    }
    glVertexArrayElementBuffer(array, r->indices ? r->indices->id : 0);
}

static bool bind_targets(struct orl_gpu *gpu, const struct orl_raster *r,
                         const struct orl_tex **any)
{
    GLenum buffers[ORL_RASTER_TARGETS_MAX];
    *any = r->depth;
    for (GLuint i = 0; i < ORL_RASTER_TARGETS_MAX; i++) {
        const struct orl_tex *target = r->targets[i];
        glNamedFramebufferTexture(gpu->framebuffer, GL_COLOR_ATTACHMENT0 + i,
                                  target ? target->id : 0, 0);
        buffers[i] = target ? GL_COLOR_ATTACHMENT0 + i : GL_NONE;
        *any = target ? target : *any;
    }
    glNamedFramebufferTexture(gpu->framebuffer, GL_DEPTH_ATTACHMENT, r->depth ? r->depth->id : 0,
                              0);
    glNamedFramebufferDrawBuffers(gpu->framebuffer, ORL_RASTER_TARGETS_MAX, buffers);
    return *any && glCheckNamedFramebufferStatus(gpu->framebuffer, GL_DRAW_FRAMEBUFFER) ==
                       GL_FRAMEBUFFER_COMPLETE;
}

static void clear_targets(const struct orl_gpu *gpu, const struct orl_raster *r)
{
    static const float zero[4] = {0}, farthest = 1;
    for (GLint i = 0; i < ORL_RASTER_TARGETS_MAX; i++)
        if (r->targets[i])
            glClearNamedFramebufferfv(gpu->framebuffer, GL_COLOR, i, zero);
    if (r->depth)
        glClearNamedFramebufferfv(gpu->framebuffer, GL_DEPTH, 0, &farthest);
}

void orl_gpu_raster(struct orl_gpu *gpu, const struct orl_raster *r)
{
    const struct orl_tex *any;
    if (!orl_prog_use(gpu, r->prog, r->params, r->params_size))
        return;
    if (!bind_targets(gpu, r, &any)) {
        orl_logf(gpu->log, ORL_LOG_ERROR, "these targets make no framebuffer");
        gpu->failed = true;
        return;
    }
    glBindFramebuffer(GL_DRAW_FRAMEBUFFER, gpu->framebuffer);
    glViewport(0, 0, any->params.width, any->params.height);
    glMemoryBarrier(GL_FRAMEBUFFER_BARRIER_BIT); // after shader writes of earlier passes
    if (r->over) {
        glEnable(GL_BLEND);
        glBlendFunc(GL_ONE, GL_ONE_MINUS_SRC_ALPHA);
    } else {
        clear_targets(gpu, r);
    }
    if (r->depth)
        glEnable(GL_DEPTH_TEST);
    bind_inputs(gpu->vertex_array, r);
    orl_gpu_bind(r->textures, r->images, 0);
    glBindVertexArray(gpu->vertex_array);
    GLsizei count = (GLsizei)r->count, instances = r->instances ? (GLsizei)r->instances : 1;
    if (r->indices)
        glDrawElementsInstanced(GL_TRIANGLES, count, GL_UNSIGNED_INT, NULL, instances);
    else
        glDrawArraysInstanced(GL_TRIANGLES, 0, count, instances);
    glBindVertexArray(0);
    glDisable(GL_DEPTH_TEST);
    glDisable(GL_BLEND);
    glBindFramebuffer(GL_DRAW_FRAMEBUFFER, 0);
    orl_gpu_barrier();
    orl_gpu_check_errors(gpu, "raster");
}
