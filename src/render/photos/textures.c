// How photographs are kept on the device.
#include "render/photos/photos.h"

#include <string.h>

const char *const orl_textures_names[ORL_TEXTURES_COUNT + 1] = {
    ORL_TEXTURES(ORL_ENUM_NAME)};

enum orl_result orl_textures_choose(const struct orl_log *log, const struct orl_scene *scene,
                                    const struct orl_renderer_params *params,
                                    enum orl_textures *textures)
{
    const char *told = scene->defaults.textures;
    *textures = params->textures;
    // Radiance has a format of its own.
    if (*textures != ORL_TEXTURES_AUTO || params->radiance || !told)
        return ORL_OK;
    for (int i = 0; i < ORL_TEXTURES_COUNT; i++)
        if (strcmp(orl_textures_names[i], told) == 0) {
            *textures = (enum orl_textures)i;
            return ORL_OK;
        }
    return orl_fail(log, ORL_ERR_FORMAT, "%s/scene.json: this program has no textures %s",
                    scene->dir, told);
}

// 0: not compressed. Of ycc, the format of luma.
static GLenum compressed_format(enum orl_textures textures)
{
    return textures == ORL_TEXTURES_YCC   ? GL_COMPRESSED_RED_RGTC1
           : textures == ORL_TEXTURES_BC1 ? GL_COMPRESSED_RGB_S3TC_DXT1_EXT
                                          : 0;
}

bool orl_textures_available(const struct orl_gpu *gpu, enum orl_textures textures)
{
    GLenum format = compressed_format(textures);
    return !format || orl_gpu_has_compressed(gpu, format);
}

GLenum orl_textures_format(const struct orl_gpu *gpu, bool radiance, enum orl_textures textures)
{
    const struct orl_log *log = orl_gpu_log(gpu);
    if (textures == ORL_TEXTURES_AUTO || textures == ORL_TEXTURES_FULL)
        return radiance ? GL_RGBA16F : GL_RGBA8;
    GLenum format = compressed_format(textures);
    if (radiance)
        orl_logf(log, ORL_LOG_WARNING, "photographs as radiance are kept uncompressed");
    else if (orl_gpu_has_compressed(gpu, format))
        return format;
    else
        orl_logf(log, ORL_LOG_WARNING, "this device has no %s textures: photographs are kept "
                 "uncompressed", orl_textures_names[textures]);
    return radiance ? GL_RGBA16F : GL_RGBA8;
}
