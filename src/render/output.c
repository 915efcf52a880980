#include "render/output.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "core/memory.h"
#include "io/exr.h"
#include "io/picture.h"

static bool has_extension(const char *path, const char *extension)
{
    const char *dot = strrchr(path, '.');
    return dot && strcmp(dot, extension) == 0;
}

bool orl_frame_can_write(const char *path)
{
    return has_extension(path, ".png") || has_extension(path, ".exr");
}

static void add_channel(struct orl_exr_params *exr, const char *name, bool half,
                        const struct orl_image *image, int channel)
{
    struct orl_exr_channel *c = &exr->channels[exr->channel_count++];
    snprintf(c->name, sizeof c->name, "%s", name);
    c->half = half;
    c->data = image->f32 + channel;
    c->stride = (size_t)image->channels;
}

static enum orl_result write_exr(const struct orl_log *log, const char *path,
                                 const struct orl_view *view, const struct orl_frame *frame,
                                 const struct orl_frame_layers *layers)
{
    struct orl_exr_params exr = {.width = frame->color.width, .height = frame->color.height,
                                 .view = view, .srgb_primaries = true};
    static const char *const rgb[] = {"R", "G", "B"};
    static const char *const xyz[] = {"normal.X", "normal.Y", "normal.Z"};
    for (int i = 0; i < 3; i++)
        add_channel(&exr, rgb[i], true, &frame->color, i);
    if (layers->depth)
        add_channel(&exr, "depth.Z", false, &frame->depth, 0);
    for (int i = 0; layers->normal && i < 3; i++)
        add_channel(&exr, xyz[i], true, &frame->normal, i);
    if (layers->coverage)
        add_channel(&exr, "coverage", true, &frame->coverage, 0);
    return orl_exr_write(log, path, &exr);
}

// Inverse depth between the nearest and farthest surface, near white.
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
            out->u8[i] = (uint8_t)lrintf(255 * layer->f32[i]);
    } else {
        // Normals: x right red, y up green, towards the viewer blue.
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
    char *layer_path = orl_format(log, "%.*s.%s.png", stem, path, name);
    enum orl_result result =
        layer_path ? orl_image_init(log, &picture, layer->width, layer->height, layer->channels,
                                    ORL_PIXEL_U8)
                   : ORL_ERR_MEMORY;
    if (result == ORL_OK) {
        layer_picture(layer, is_depth, &picture);
        result = orl_png_write(log, layer_path, &picture);
    }
    orl_image_finish(&picture);
    free(layer_path);
    return result;
}

enum orl_result orl_frame_write(const struct orl_log *log, const char *path,
                                const struct orl_view *view, const struct orl_frame *frame,
                                const struct orl_frame_layers *layers)
{
    if (has_extension(path, ".exr"))
        return write_exr(log, path, view, frame, layers);
    if (!has_extension(path, ".png"))
        return orl_fail(log, ORL_ERR_ARGUMENT, "%s: must end in .png or .exr", path);
    struct orl_image srgb = {0};
    enum orl_result result = orl_tone_srgb(log, &frame->color, &srgb);
    if (result == ORL_OK)
        result = orl_png_write(log, path, &srgb);
    if (result == ORL_OK && layers->depth)
        result = write_layer(log, path, "depth", &frame->depth, true);
    if (result == ORL_OK && layers->normal)
        result = write_layer(log, path, "normal", &frame->normal, false);
    if (result == ORL_OK && layers->coverage)
        result = write_layer(log, path, "coverage", &frame->coverage, false);
    orl_image_finish(&srgb);
    return result;
}
