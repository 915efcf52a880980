// The graphics pipeline's own points, to compare compute splatting with.
#include "gpu/point_raster.h"

#include <stdlib.h>
#include <string.h>

#include "core/memory.h"
#include "gpu/internal.h"

struct vertex {
    float position[3];
    uint8_t color[4];
};

struct orl_point_raster {
    struct orl_gpu *gpu;
    GLuint program, array, frame;
    struct orl_buf *vertices, *matrix;
    struct orl_tex *color, *depth;
    GLsizei count;
};

static enum orl_result add_shader(struct orl_gpu *gpu, GLuint program, GLenum stage,
                                  const char *file)
{
    struct shader_source source;
    enum orl_result result = orl_shader_source_load(gpu, file, NULL, &source);
    if (result != ORL_OK)
        return result;
    char message[2048] = "";
    GLint ok = 0;
    GLuint shader = glCreateShader(stage);
    const GLchar *text = source.text;
    glShaderSource(shader, 1, &text, NULL);
    glCompileShader(shader);
    glGetShaderiv(shader, GL_COMPILE_STATUS, &ok);
    glGetShaderInfoLog(shader, sizeof message, NULL, message);
    if (ok)
        glAttachShader(program, shader);
    else
        result = orl_fail(gpu->log, ORL_ERR_GPU, "shaders/%s does not compile:\n%s", file, message);
    glDeleteShader(shader); // once the program lets go of it
    orl_shader_source_finish(&source);
    return result;
}

static enum orl_result make_program(struct orl_point_raster *r)
{
    struct orl_gpu *gpu = r->gpu;
    char message[2048] = "";
    GLint ok = 0;
    r->program = glCreateProgram();
    enum orl_result result = add_shader(gpu, r->program, GL_VERTEX_SHADER, "proxy/points.vert");
    if (result == ORL_OK)
        result = add_shader(gpu, r->program, GL_FRAGMENT_SHADER, "proxy/points.frag");
    if (result != ORL_OK)
        return result;
    glLinkProgram(r->program);
    glGetProgramiv(r->program, GL_LINK_STATUS, &ok);
    glGetProgramInfoLog(r->program, sizeof message, NULL, message);
    return ok ? ORL_OK
              : orl_fail(gpu->log, ORL_ERR_GPU, "shaders/points.* do not link:\n%s", message);
}

static enum orl_result make_vertices(struct orl_point_raster *r, const float (*positions)[3],
                                     const uint8_t (*colors)[3], size_t count)
{
    struct vertex *vertices = orl_array(r->gpu->log, count, sizeof *vertices);
    if (!vertices)
        return ORL_ERR_MEMORY;
    for (size_t i = 0; i < count; i++) {
        memcpy(vertices[i].position, positions[i], sizeof positions[i]);
        memcpy(vertices[i].color, colors[i], sizeof colors[i]);
        vertices[i].color[3] = 255;
    }
    enum orl_result result = orl_buf_create(r->gpu, "raster points", count * sizeof *vertices,
                                            vertices, &r->vertices);
    free(vertices);
    if (result == ORL_OK)
        result = orl_buf_create(r->gpu, "raster matrix", 16 * sizeof(float), NULL, &r->matrix);
    if (result != ORL_OK)
        return result;
    glCreateVertexArrays(1, &r->array);
    glVertexArrayVertexBuffer(r->array, 0, r->vertices->id, 0, sizeof *vertices);
    glVertexArrayAttribFormat(r->array, 0, 3, GL_FLOAT, GL_FALSE, 0);
    glVertexArrayAttribFormat(r->array, 1, 4, GL_UNSIGNED_BYTE, GL_TRUE,
                              offsetof(struct vertex, color));
    for (GLuint i = 0; i < 2; i++) {
        glVertexArrayAttribBinding(r->array, i, 0);
        glEnableVertexArrayAttrib(r->array, i);
    }
    return ORL_OK;
}

static enum orl_result make_frame(struct orl_point_raster *r, int width, int height)
{
    struct orl_tex_params params = {.width = width, .height = height, .format = GL_RGBA8,
                                    .tag = "raster colour"};
    enum orl_result result = orl_tex_create(r->gpu, &params, &r->color);
    params.format = GL_DEPTH_COMPONENT32F;
    params.tag = "raster depth";
    if (result == ORL_OK)
        result = orl_tex_create(r->gpu, &params, &r->depth);
    if (result != ORL_OK)
        return result;
    glCreateFramebuffers(1, &r->frame);
    glNamedFramebufferTexture(r->frame, GL_COLOR_ATTACHMENT0, r->color->id, 0);
    glNamedFramebufferTexture(r->frame, GL_DEPTH_ATTACHMENT, r->depth->id, 0);
    if (glCheckNamedFramebufferStatus(r->frame, GL_DRAW_FRAMEBUFFER) != GL_FRAMEBUFFER_COMPLETE)
        return orl_fail(r->gpu->log, ORL_ERR_GPU, "no framebuffer of %dx%d", width, height);
    return ORL_OK;
}

enum orl_result orl_point_raster_create(struct orl_gpu *gpu, const float (*positions)[3],
                                        const uint8_t (*colors)[3], size_t count, int width,
                                        int height, struct orl_point_raster **out)
{
    *out = NULL;
    if (count > INT32_MAX)
        return orl_fail(gpu->log, ORL_ERR_UNSUPPORTED, "%zu points are too many", count);
    struct orl_point_raster *r = orl_array(gpu->log, 1, sizeof *r);
    if (!r)
        return ORL_ERR_MEMORY;
    r->gpu = gpu;
    r->count = (GLsizei)count;
    enum orl_result result = make_program(r);
    if (result == ORL_OK)
        result = make_vertices(r, positions, colors, count);
    if (result == ORL_OK)
        result = make_frame(r, width, height);
    if (result == ORL_OK && !orl_gpu_check_errors(gpu, "point raster"))
        result = ORL_ERR_GPU;
    if (result != ORL_OK)
        orl_point_raster_destroy(&r);
    *out = r;
    return result;
}

void orl_point_raster_destroy(struct orl_point_raster **raster)
{
    struct orl_point_raster *r = *raster;
    if (!r)
        return;
    glDeleteFramebuffers(1, &r->frame);
    glDeleteVertexArrays(1, &r->array);
    glDeleteProgram(r->program);
    orl_buf_destroy(r->gpu, &r->vertices);
    orl_buf_destroy(r->gpu, &r->matrix);
    orl_tex_destroy(r->gpu, &r->color);
    orl_tex_destroy(r->gpu, &r->depth);
    free(r);
    *raster = NULL;
}

void orl_point_raster_draw(struct orl_point_raster *r, const float clip_from_world[16])
{
    static const float black[4] = {0};
    const float farthest = 1;
    orl_buf_write(r->matrix, 0, 16 * sizeof(float), clip_from_world);
    orl_pass_begin(r->gpu, "GL_POINTS");
    glBindFramebuffer(GL_DRAW_FRAMEBUFFER, r->frame);
    glViewport(0, 0, r->color->params.width, r->color->params.height);
    glEnable(GL_DEPTH_TEST);
    glClearNamedFramebufferfv(r->frame, GL_COLOR, 0, black);
    glClearNamedFramebufferfv(r->frame, GL_DEPTH, 0, &farthest);
    glUseProgram(r->program);
    glBindBufferBase(GL_UNIFORM_BUFFER, 0, r->matrix->id);
    glBindVertexArray(r->array);
    glDrawArrays(GL_POINTS, 0, r->count);
    glBindVertexArray(0);
    glDisable(GL_DEPTH_TEST);
    glBindFramebuffer(GL_DRAW_FRAMEBUFFER, 0);
    orl_pass_end(r->gpu);
}

const struct orl_tex *orl_point_raster_color(const struct orl_point_raster *r)
{
    return r->color;
}
