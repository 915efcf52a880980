#include "scene/linear.h"

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
