// Buffers and textures.
#include <stdlib.h>

#include "core/memory.h"
#include "gpu/compress.h"
#include "gpu/internal.h"

// What the texels of a format take: blocks of side x side texels have so many bytes. zeros: the client format
// in which it is cleared; 0: it cannot be cleared.
struct texel_format {
    GLenum format;
    unsigned char bytes, side;
    GLenum zeros;
};

static const struct texel_format *texel_format(GLenum format)
{
    static const struct texel_format all[] = {
        {GL_R8, 1, 1, GL_RED}, {GL_RG8, 2, 1, GL_RED}, {GL_RGBA8, 4, 1, GL_RED}, {GL_SRGB8_ALPHA8, 4, 1, GL_RED},
        {GL_R16F, 2, 1, GL_RED}, {GL_RGBA16F, 8, 1, GL_RED}, {GL_R32F, 4, 1, GL_RED}, {GL_RGBA32F, 16, 1, GL_RED},
        {GL_DEPTH_COMPONENT32F, 4, 1, GL_DEPTH_COMPONENT}, {GL_R8UI, 1, 1, GL_RED_INTEGER},
        {GL_R32I, 4, 1, GL_RED_INTEGER}, {GL_R32UI, 4, 1, GL_RED_INTEGER}, {GL_RG32UI, 8, 1, GL_RED_INTEGER},
        {GL_RGBA32UI, 16, 1, GL_RED_INTEGER},
        {GL_COMPRESSED_RED_RGTC1, 8, 4, 0}, {GL_COMPRESSED_RG_RGTC2, 16, 4, 0},
        {GL_COMPRESSED_RGB_S3TC_DXT1_EXT, 8, 4, 0},
    };
    static const struct texel_format other = {.bytes = 16, .side = 1}; // an upper bound, used for accounting only
    for (size_t i = 0; i < ORL_COUNT(all); i++)
        if (all[i].format == format)
            return &all[i];
    return &other;
}

// Makes buf->texels. False: the device has no such view, which the caller says.
static bool view_texels(struct orl_gpu *gpu, struct orl_buf *buf, GLenum format)
{
    size_t texels = buf->size / texel_format(format)->bytes;
    buf->texels.params = (struct orl_tex_params){.width = (int)texels, .height = 1, .levels = 1, .format = format,
                                                 .owner = buf->owner, .tag = buf->tag};
    glCreateTextures(GL_TEXTURE_BUFFER, 1, &buf->texels.id);
    glTextureBuffer(buf->texels.id, format, buf->id);
    glObjectLabel(GL_TEXTURE, buf->texels.id, -1, buf->tag);
    return texels <= (size_t)gpu->caps.max_buffer_texels;
}

enum orl_result orl_buf_create(struct orl_gpu *gpu, enum orl_owner owner, const char *tag, size_t size,
                               const void *data, GLenum format, struct orl_buf **out)
{
    *out = NULL;
    struct orl_buf *buf = orl_array(gpu->log, 1, sizeof *buf);
    ORL_TRY_MEMORY(buf);
    *buf = (struct orl_buf){.size = size ? size : 4, .owner = owner, .tag = tag};
    glCreateBuffers(1, &buf->id);
    glNamedBufferStorage(buf->id, (GLsizeiptr)buf->size, size ? data : NULL, 0);
    glObjectLabel(GL_BUFFER, buf->id, -1, tag);
    orl_gpu_count(gpu, owner, tag, (ptrdiff_t)buf->size, 1);
    bool fits = !format || view_texels(gpu, buf, format);
    if (!orl_gpu_check_errors(gpu, tag) || !fits) {
        orl_logf(gpu->log, ORL_LOG_ERROR, "%s: no buffer of %zu bytes on the device%s", tag, size,
                 fits ? "" : " may have so many texels");
        orl_buf_destroy(gpu, &buf);
        return ORL_ERR_GPU;
    }
    if (!data)
        orl_buf_fill(buf, 0);
    *out = buf;
    return ORL_OK;
}

void orl_buf_destroy(struct orl_gpu *gpu, struct orl_buf **handle)
{
    struct orl_buf *buf = *handle;
    if (!buf)
        return;
    glDeleteTextures(1, &buf->texels.id);
    glDeleteBuffers(1, &buf->id);
    orl_gpu_count(gpu, buf->owner, buf->tag, -(ptrdiff_t)buf->size, -1);
    free(buf);
    *handle = NULL;
}

enum orl_result orl_buf_fit(struct orl_gpu *gpu, enum orl_owner owner, const char *tag, size_t size, GLenum format,
                            struct orl_buf **buf)
{
    size_t more = (size + size / 2 + 15) / 16 * 16; // what has grown once will grow again
    if (*buf && (*buf)->size >= size)
        return ORL_OK;
    if (*buf && more <= gpu->caps.max_storage_block)
        size = more;
    orl_buf_destroy(gpu, buf);
    return orl_buf_create(gpu, owner, tag, size, NULL, format, buf);
}

// Drivers write at once, or into new memory, where they believe that no command uses the buffer: NVIDIA's 580 does while
// shaders do, and Zink of Mesa 22.3 while textures show it. A copy on the device comes in its turn.
void orl_buf_write(struct orl_buf *buf, size_t offset, size_t size, const void *data)
{
    GLuint staging;
    if (!size)
        return;
    glCreateBuffers(1, &staging);
    glNamedBufferStorage(staging, (GLsizeiptr)size, data, 0);
    glMemoryBarrier(GL_BUFFER_UPDATE_BARRIER_BIT); // after shader writes of earlier passes
    glCopyNamedBufferSubData(staging, buf->id, 0, (GLintptr)offset, (GLsizeiptr)size);
    glDeleteBuffers(1, &staging);
}

void orl_buf_read(const struct orl_buf *buf, size_t size, void *data)
{
    glMemoryBarrier(GL_BUFFER_UPDATE_BARRIER_BIT);
    glFinish(); // for the same reason
    glGetNamedBufferSubData(buf->id, 0, (GLsizeiptr)size, data);
}

void orl_buf_fill(struct orl_buf *buf, uint32_t word)
{
    glMemoryBarrier(GL_BUFFER_UPDATE_BARRIER_BIT); // after shader writes of earlier passes
    glClearNamedBufferData(buf->id, GL_R32UI, GL_RED_INTEGER, GL_UNSIGNED_INT, &word);
}

static int level_side(int side, int level)
{
    return side >> level ? side >> level : 1;
}

bool orl_gpu_has_compressed(const struct orl_gpu *gpu, GLenum format)
{
    GLint supported = GL_FALSE;
    (void)gpu;
    // RGTC is part of GL 4.5, S3TC is an extension.
    if (format == GL_COMPRESSED_RGB_S3TC_DXT1_EXT && !epoxy_has_gl_extension("GL_EXT_texture_compression_s3tc"))
        return false;
    glGetInternalformativ(GL_TEXTURE_2D_ARRAY, format, GL_INTERNALFORMAT_SUPPORTED, 1, &supported);
    return supported == GL_TRUE;
}

int orl_mip_levels(int width, int height)
{
    int levels = 1;
    while ((width > height ? width : height) >> levels > 0)
        levels++;
    return levels;
}

size_t orl_tex_layer_bytes(const struct orl_tex_params *params)
{
    const struct texel_format *format = texel_format(params->format);
    size_t bytes = 0, side = format->side;
    for (int level = 0; level == 0 || level < params->levels; level++) {
        size_t width = (size_t)level_side(params->width, level);
        size_t height = (size_t)level_side(params->height, level);
        bytes += (width + side - 1) / side * ((height + side - 1) / side) * format->bytes;
    }
    return bytes;
}

static void set_sampling(GLuint id, bool linear, int levels)
{
    GLint mag = linear ? GL_LINEAR : GL_NEAREST;
    GLint min = levels > 1 ? (linear ? GL_LINEAR_MIPMAP_LINEAR : GL_NEAREST_MIPMAP_NEAREST) : mag;
    glTextureParameteri(id, GL_TEXTURE_MIN_FILTER, min);
    glTextureParameteri(id, GL_TEXTURE_MAG_FILTER, mag);
    glTextureParameteri(id, GL_TEXTURE_WRAP_S, GL_CLAMP_TO_EDGE);
    glTextureParameteri(id, GL_TEXTURE_WRAP_T, GL_CLAMP_TO_EDGE);
}

// Storage that a driver gives anew may hold what other textures, or programs, have left there.
static void fill_zeros(const struct orl_tex *tex, int level, int layer, int layers)
{
    const struct orl_tex_params *p = &tex->params;
    const GLenum format = texel_format(p->format)->zeros;
    const GLenum type = format == GL_RED_INTEGER ? GL_UNSIGNED_INT : GL_FLOAT;
    if (format)
        glClearTexSubImage(tex->id, level, 0, 0, layer, level_side(p->width, level), level_side(p->height, level), layers,
                           format, type, NULL);
}

enum orl_result orl_tex_create(struct orl_gpu *gpu, const struct orl_tex_params *params,
                               struct orl_tex **out)
{
    *out = NULL;
    if (params->width < 1 || params->height < 1 || params->width > gpu->caps.max_texture_size ||
        params->height > gpu->caps.max_texture_size ||
        params->layers > gpu->caps.max_texture_layers)
        return orl_fail(gpu->log, ORL_ERR_GPU, "%s: this device has no textures of %dx%d, "
                        "%d layers", params->tag, params->width, params->height, params->layers);
    struct orl_tex *tex = orl_array(gpu->log, 1, sizeof *tex);
    ORL_TRY_MEMORY(tex);
    tex->params = *params;
    if (tex->params.levels < 1)
        tex->params.levels = 1;
    const struct orl_tex_params *p = &tex->params;
    tex->bytes = orl_tex_layer_bytes(p) * (p->layers ? (size_t)p->layers : 1);
    if (p->layers) {
        glCreateTextures(GL_TEXTURE_2D_ARRAY, 1, &tex->id);
        glTextureStorage3D(tex->id, p->levels, p->format, p->width, p->height, p->layers);
    } else {
        glCreateTextures(GL_TEXTURE_2D, 1, &tex->id);
        glTextureStorage2D(tex->id, p->levels, p->format, p->width, p->height);
    }
    set_sampling(tex->id, p->linear, p->levels);
    glObjectLabel(GL_TEXTURE, tex->id, -1, p->tag);
    for (int level = 0; level < p->levels; level++)
        fill_zeros(tex, level, 0, p->layers ? p->layers : 1);
    orl_gpu_count(gpu, tex->params.owner, tex->params.tag, (ptrdiff_t)tex->bytes, 1);
    if (!orl_gpu_check_errors(gpu, p->tag)) {
        orl_logf(gpu->log, ORL_LOG_ERROR, "%s: no texture of %dx%d, %zu bytes on the device",
                 p->tag, p->width, p->height, tex->bytes);
        orl_tex_destroy(gpu, &tex);
        return ORL_ERR_GPU;
    }
    *out = tex;
    return ORL_OK;
}

enum orl_result orl_tex_create_rows(struct orl_gpu *gpu, int width, int height, const struct orl_tex_row *rows,
                                    size_t count)
{
    for (size_t i = 0; i < count; i++) {
        const struct orl_tex_params params = {.width = width, .height = height,
                                              .format = rows[i].format, .tag = rows[i].tag};
        ORL_TRY(orl_tex_create(gpu, &params, rows[i].tex));
    }
    return ORL_OK;
}

enum orl_result orl_tex_fit(struct orl_gpu *gpu, const struct orl_tex_params *params,
                            struct orl_tex **tex)
{
    const struct orl_tex_params *old = *tex ? &(*tex)->params : NULL;
    int levels = params->levels > 1 ? params->levels : 1;
    if (old && old->width == params->width && old->height == params->height && old->levels == levels &&
        old->format == params->format)
        return ORL_OK;
    orl_tex_destroy(gpu, tex);
    return orl_tex_create(gpu, params, tex);
}

void orl_tex_destroy(struct orl_gpu *gpu, struct orl_tex **handle)
{
    struct orl_tex *tex = *handle;
    if (!tex)
        return;
    glDeleteTextures(1, &tex->id);
    orl_gpu_count(gpu, tex->params.owner, tex->params.tag, -(ptrdiff_t)tex->bytes, -1);
    free(tex);
    *handle = NULL;
}

void orl_tex_write_layer(struct orl_tex *tex, int layer, int width, int height, GLenum format, GLenum type,
                         const void *pixels)
{
    glMemoryBarrier(GL_TEXTURE_UPDATE_BARRIER_BIT); // after shader writes of earlier passes
    if (tex->params.layers)
        glTextureSubImage3D(tex->id, 0, 0, 0, layer, width, height, 1, format, type, pixels);
    else
        glTextureSubImage2D(tex->id, 0, 0, 0, width, height, format, type, pixels);
}

void orl_tex_write(struct orl_tex *tex, GLenum format, GLenum type, const void *pixels)
{
    orl_tex_write_layer(tex, 0, tex->params.width, tex->params.height, format, type, pixels);
}

void orl_tex_read(const struct orl_tex *tex, int level, GLenum format, GLenum type, size_t size,
                  void *pixels)
{
    glMemoryBarrier(GL_TEXTURE_UPDATE_BARRIER_BIT);
    glGetTextureImage(tex->id, level, format, type, (GLsizei)size, pixels);
}

void orl_tex_clear(struct orl_tex *tex, int layer)
{
    glMemoryBarrier(GL_TEXTURE_UPDATE_BARRIER_BIT); // after shader writes of earlier passes
    fill_zeros(tex, 0, layer, 1);
}

void orl_tex_fill(struct orl_tex *tex, uint32_t word)
{
    glMemoryBarrier(GL_TEXTURE_UPDATE_BARRIER_BIT); // after shader writes of earlier passes
    glClearTexImage(tex->id, 0, GL_RED_INTEGER, GL_UNSIGNED_INT, &word);
}

void orl_tex_copy_layer(const struct orl_tex *from, int level, int width, int height,
                        struct orl_tex *to, int layer)
{
    glMemoryBarrier(GL_TEXTURE_UPDATE_BARRIER_BIT); // after shader writes of earlier passes
    glCopyImageSubData(from->id, GL_TEXTURE_2D, level, 0, 0, 0, to->id,
                       to->params.layers ? GL_TEXTURE_2D_ARRAY : GL_TEXTURE_2D, 0, 0, 0, layer,
                       width, height, 1);
}

enum orl_result orl_tex_compress_layer(struct orl_gpu *gpu, const struct orl_tex *from,
                                       struct orl_tex *to, int layer)
{
    const struct orl_tex_params *p = &to->params, *source = &from->params;
    size_t room = (size_t)source->width * (size_t)source->height * 4;
    size_t block_room = ((size_t)p->width + 3) * ((size_t)p->height + 3);
    uint8_t *pixels = orl_array(gpu->log, room, 1);
    uint8_t *blocks = orl_array(gpu->log, block_room, 1);
    enum orl_result result = pixels && blocks ? ORL_OK : ORL_ERR_MEMORY;
    for (int level = 0; result == ORL_OK && level < p->levels; level++) {
        int width = level_side(p->width, level), height = level_side(p->height, level);
        int from_width = level_side(source->width, level);
        int from_height = level_side(source->height, level);
        orl_tex_read(from, level, GL_RGBA, GL_UNSIGNED_BYTE, room, pixels);
        if (p->format == GL_COMPRESSED_RGB_S3TC_DXT1_EXT)
            orl_bc1_encode(pixels, width, height, blocks);
        else if (p->format == GL_COMPRESSED_RED_RGTC1)
            orl_rgtc_encode_luma(pixels, width, height, blocks);
        else
            orl_rgtc_encode_chroma(pixels, from_width, from_height, width, height, blocks);
        struct orl_tex_params one = {.width = width, .height = height, .format = p->format};
        glCompressedTextureSubImage3D(to->id, level, 0, 0, layer, width, height, 1, p->format,
                                      (GLsizei)orl_tex_layer_bytes(&one), blocks);
    }
    free(pixels);
    free(blocks);
    return result;
}

void orl_tex_mix_levels(struct orl_tex *tex, bool mix)
{
    if (tex->params.linear && tex->params.levels > 1)
        glTextureParameteri(tex->id, GL_TEXTURE_MIN_FILTER,
                            mix ? GL_LINEAR_MIPMAP_LINEAR : GL_LINEAR_MIPMAP_NEAREST);
}

void orl_tex_make_mipmaps(struct orl_tex *tex, int layer)
{
    // A shader may have written level 0. Drivers read it as a texture, by drawing or by copying.
    glMemoryBarrier(GL_TEXTURE_FETCH_BARRIER_BIT | GL_FRAMEBUFFER_BARRIER_BIT |
                    GL_TEXTURE_UPDATE_BARRIER_BIT);
    if (tex->params.levels <= 1)
        return;
    const struct orl_tex_params *p = &tex->params;
    bool colors = p->format == GL_RGBA8;
    if (!p->layers && !colors) {
        glGenerateTextureMipmap(tex->id);
        return;
    }
    // glGenerateTextureMipmap would redo every layer; with Mesa even on a view of one layer. Of a format of sRGB it
    // takes the means in linear light.
    GLenum target = p->layers ? GL_TEXTURE_2D_ARRAY : GL_TEXTURE_2D;
    GLuint one;
    glCreateTextures(GL_TEXTURE_2D, 1, &one);
    glTextureStorage2D(one, p->levels, colors ? GL_SRGB8_ALPHA8 : p->format, p->width, p->height);
    glCopyImageSubData(tex->id, target, 0, 0, 0, layer, one, GL_TEXTURE_2D, 0, 0, 0, 0, p->width, p->height, 1);
    glGenerateTextureMipmap(one);
    for (int level = 1; level < p->levels; level++)
        glCopyImageSubData(one, GL_TEXTURE_2D, level, 0, 0, 0, tex->id, target, level, 0, 0, layer,
                           level_side(p->width, level), level_side(p->height, level), 1);
    glDeleteTextures(1, &one);
}
