#include "scene/linear.h"

#include <stdlib.h>
#include <string.h>

#include "io/exr.h"

static const char *const rgb[] = {"R", "G", "B"};

enum orl_result orl_linear_write(const struct orl_log *log, const char *path,
                                 const struct orl_image *image)
{
    ORL_REQUIRE(log, image->data && image->type == ORL_PIXEL_F32 && image->channels == 3);
    struct orl_exr_params exr = {
        .width = image->width, .height = image->height, .compression = ORL_EXR_PIZ,
        .attributes = {.srgb_primaries = true,
                       .comments = "linear light; 1 is white of the 8-bit picture"}};
    for (int c = 0; c < 3; c++)
        ORL_REQUIRE(log, orl_exr_add_channel(&exr, rgb[c], true, image, c));
    return orl_exr_write(log, path, &exr);
}

enum orl_result orl_scene_read_linear(const struct orl_log *log, const struct orl_scene *scene,
                                      size_t photo, struct orl_image *image, bool *clips)
{
    memset(image, 0, sizeof *image);
    *clips = true;
    ORL_REQUIRE(log, photo < scene->photo_count);
    const struct orl_camera *camera = &scene->photos[photo].view.camera;
    if (!scene->photos[photo].linear)
        return ORL_OK;
    char *path = orl_scene_linear_path(log, scene, photo);
    enum orl_result result = path ? orl_exr_read(log, path, rgb, 3, image) : ORL_ERR_MEMORY;
    if (result == ORL_OK && (image->width != camera->width || image->height != camera->height))
        result = orl_fail(log, ORL_ERR_FORMAT, "%s: %dx%d pixels, but its camera has %dx%d", path,
                          image->width, image->height, camera->width, camera->height);
    if (result != ORL_OK)
        orl_image_finish(image);
    size_t count = result == ORL_OK ? orl_image_bytes(image) / sizeof(float) : 0;
    for (size_t i = 0; i < count && *clips; i++)
        *clips = !(image->f32[i] > 1);
    free(path);
    return result;
}
