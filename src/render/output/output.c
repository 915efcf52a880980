#include "render/output/output.h"

#include <math.h>
#include <string.h>

#include "core/file.h"
#include "io/picture.h"

bool orl_frame_can_write(const char *path)
{
    return orl_path_has_extension(path, "png") || orl_path_has_extension(path, "exr");
}

static enum orl_result write_exr(const struct orl_log *log, const char *path,
                                 const struct orl_view *view, const struct orl_frame *frame,
                                 const struct orl_frame_output *output)
{
    struct orl_exr_params exr = {.width = frame->color.width, .height = frame->color.height,
                                 .compression = output->compression,
                                 .attributes = output->attributes};
    exr.attributes.view = view;
    exr.attributes.srgb_primaries = true;
    const struct orl_frame_layers *layers = &output->layers;
    bool half = !output->float_color;
    const struct {
        bool wanted;
        const char *names[3];
        bool half;
        const struct orl_image *image;
    } all[] = {
        {true, {"R", "G", "B"}, half, &frame->color},
        {layers->depth, {"depth.Z"}, false, &frame->depth},
        {layers->normal, {"normal.X", "normal.Y", "normal.Z"}, half, &frame->normal},
        {layers->coverage, {"coverage.Y"}, true, &frame->coverage},
        {layers->confidence, {"confidence.Y"}, true, &frame->confidence},
    };
    for (size_t i = 0; i < ORL_COUNT(all); i++)
        for (int c = 0; all[i].wanted && c < all[i].image->channels; c++)
            ORL_REQUIRE(log, orl_exr_add_channel(&exr, all[i].names[c], all[i].half,
                                                 all[i].image, c));
    return orl_exr_write(log, path, &exr);
}

// Maps inverse depth linearly between the farthest and the nearest surface; near is white.
static void depth_picture(const struct orl_image *depth, struct orl_image *out)
{
    size_t count = (size_t)depth->width * (size_t)depth->height;
    float near_inverse = 0, far_inverse = INFINITY;
    for (size_t i = 0; i < count; i++) {
        float z = depth->f32[i];
        if (z > 0) {
            near_inverse = fmaxf(near_inverse, 1 / z);
            far_inverse = fminf(far_inverse, 1 / z);
        }
    }
    float range = fmaxf(near_inverse - far_inverse, 1e-20f);
    for (size_t i = 0; i < count; i++) {
        float z = depth->f32[i];
        out->u8[i] = z > 0 ? (uint8_t)lrintf(32 + 223 * (1 / z - far_inverse) / range) : 0;
    }
}

static void layer_picture(const struct orl_image *layer, bool is_depth, struct orl_image *out)
{
    size_t count = (size_t)layer->width * (size_t)layer->height;
    if (is_depth) {
        depth_picture(layer, out);
    } else if (layer->channels == 1) {
        for (size_t i = 0; i < count; i++)
            out->u8[i] = (uint8_t)lrintf(255 * fminf(fmaxf(layer->f32[i], 0), 1));
    } else {
        // Normals: red is x (right), green is y (up), blue points towards the viewer.
        for (size_t i = 0; i < count; i++) {
            const float *n = &layer->f32[3 * i];
            bool none = n[0] == 0 && n[1] == 0 && n[2] == 0;
            for (int k = 0; k < 3; k++)
                out->u8[3 * i + (size_t)k] =
                    none ? 0 : (uint8_t)lrintf(127.5f + 127.5f * (k == 0 ? n[k] : -n[k]));
        }
    }
}

static enum orl_result write_layer(const struct orl_log *log, const char *path, const char *name,
                                   const struct orl_image *layer, bool is_depth)
{
    struct orl_image picture = {0};
    int stem = (int)(strlen(path) - strlen(".png"));
    ORL_TRY(orl_image_init(log, &picture, layer->width, layer->height, layer->channels, ORL_PIXEL_U8));
    layer_picture(layer, is_depth, &picture);
    enum orl_result result = orl_png_write(log, ORL_PATH("", "%.*s.%s.png", stem, path, name), &picture);
    orl_image_finish(&picture);
    return result;
}

enum orl_result orl_frame_write(const struct orl_log *log, const char *path,
                                const struct orl_view *view, const struct orl_frame *frame,
                                const struct orl_frame_output *output)
{
    const struct orl_frame_layers *layers = &output->layers;
    ORL_REQUIRE(log, !layers->confidence || frame->confidence.data);
    if (orl_path_has_extension(path, "exr"))
        return write_exr(log, path, view, frame, output);
    if (!orl_path_has_extension(path, "png"))
        return orl_fail(log, ORL_ERR_ARGUMENT, "%s: must end in .png or .exr", path);
    struct orl_image srgb = {0};
    enum orl_result result = orl_tone_apply(log, &frame->color, &output->tone, &srgb);
    ORL_THEN(result, orl_png_write(log, path, &srgb));
    if (result == ORL_OK && layers->depth)
        result = write_layer(log, path, "depth", &frame->depth, true);
    if (result == ORL_OK && layers->normal)
        result = write_layer(log, path, "normal", &frame->normal, false);
    if (result == ORL_OK && layers->coverage)
        result = write_layer(log, path, "coverage", &frame->coverage, false);
    if (result == ORL_OK && layers->confidence)
        result = write_layer(log, path, "confidence", &frame->confidence, false);
    orl_image_finish(&srgb);
    return result;
}
