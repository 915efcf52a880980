// How photographs are kept on the device.
#include "render/photos.h"

#include <string.h>

const char *const orl_textures_names[ORL_TEXTURES_COUNT + 1] = {"auto", "full", "bc7", "bc1"};

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

GLenum orl_textures_format(const struct orl_gpu *gpu, bool radiance, enum orl_textures textures)
{
    const struct orl_log *log = orl_gpu_log(gpu);
    if (textures == ORL_TEXTURES_AUTO || textures == ORL_TEXTURES_FULL)
        return radiance ? GL_RGBA16F : GL_SRGB8_ALPHA8;
    GLenum format = textures == ORL_TEXTURES_BC7 ? GL_COMPRESSED_SRGB_ALPHA_BPTC_UNORM
                                                 : GL_COMPRESSED_SRGB_S3TC_DXT1_EXT;
    if (radiance)
        orl_logf(log, ORL_LOG_WARNING, "photographs as radiance are kept uncompressed");
    else if (orl_gpu_has_compressed(gpu, format))
        return format;
    else
        orl_logf(log, ORL_LOG_WARNING, "this device has no %s textures: photographs are kept "
                 "uncompressed", textures == ORL_TEXTURES_BC7 ? "BC7" : "BC1");
    return radiance ? GL_RGBA16F : GL_SRGB8_ALPHA8;
}
