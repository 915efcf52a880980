#include "render/internal.h"

#include <string.h>

#include "render/paint/paint.h"

// Creates an image of the frame's size.
static enum orl_result make(const struct frame *frame, int channels, struct orl_image *image)
{
    return orl_image_init(orl_gpu_log(frame->gpu), image, frame->surface.width,
                          frame->surface.height, channels, ORL_PIXEL_F32);
}

// Makes the staging image fit; it is allocated once for frames of the same kind.
static enum orl_result stage(const struct frame *frame, int channels, struct orl_image *s)
{
    if (s->width == frame->surface.width && s->height == frame->surface.height &&
        s->channels == channels)
        return ORL_OK;
    orl_image_finish(s);
    return make(frame, channels, s);
}

static size_t pixel_count(const struct frame *frame)
{
    return (size_t)frame->surface.width * (size_t)frame->surface.height;
}

static enum orl_result read_color(const struct frame *frame, bool coverage,
                                  struct orl_image *staging, struct orl_frame *out)
{
    ORL_TRY(make(frame, 3, &out->color));
    if (coverage)
        ORL_TRY(make(frame, 1, &out->coverage));
    ORL_TRY(stage(frame, 4, staging));
    const float *rgba = staging->f32;
    orl_tex_read(frame->picture, 0, GL_RGBA, GL_FLOAT, orl_image_bytes(staging), staging->f32);
    for (size_t i = 0; i < pixel_count(frame); i++) {
        memcpy(&out->color.f32[3 * i], &rgba[4 * i], 3 * sizeof(float));
        if (coverage)
            out->coverage.f32[i] = rgba[4 * i + 3];
    }
    return ORL_OK;
}

static enum orl_result read_depth(const struct frame *frame, struct orl_frame *out)
{
    ORL_TRY(make(frame, 1, &out->depth));
    float *depth = out->depth.f32;
    orl_tex_read(frame->surface.depth, 0, GL_RED, GL_FLOAT, orl_image_bytes(&out->depth), depth);
    for (size_t i = 0; i < pixel_count(frame); i++)
        if (depth[i] < 0) // an estimate, not a surface
            depth[i] = 0;
    return ORL_OK;
}

static enum orl_result read_normal(const struct frame *frame, struct orl_frame *out)
{
    ORL_TRY(make(frame, 3, &out->normal));
    orl_tex_read(frame->surface.normal, 0, GL_RGB, GL_FLOAT, orl_image_bytes(&out->normal),
                 out->normal.f32);
    return ORL_OK;
}

static enum orl_result read_confidence(const struct frame *frame, struct orl_image *staging,
                                       struct orl_frame *out)
{
    ORL_TRY(make(frame, 1, &out->confidence));
    ORL_TRY(stage(frame, 2, staging));
    const float *sums = staging->f32;
    orl_tex_read(frame->paint->trusted, 0, GL_RG, GL_FLOAT, orl_image_bytes(staging), staging->f32);
    for (size_t i = 0; i < pixel_count(frame); i++)
        out->confidence.f32[i] = sums[2 * i + 1] > 0 ? sums[2 * i] / sums[2 * i + 1] : 0;
    return ORL_OK;
}

enum orl_result orl_read_back(const struct frame *frame, struct orl_image *staging,
                              struct orl_frame *out)
{
    unsigned leave_out = frame->params->leave_out;
    ORL_TRY(read_color(frame, !(leave_out & ORL_LAYER_COVERAGE), staging, out));
    if (!(leave_out & ORL_LAYER_DEPTH))
        ORL_TRY(read_depth(frame, out));
    if (!(leave_out & ORL_LAYER_NORMAL))
        ORL_TRY(read_normal(frame, out));
    if (frame->paint->trusted && !(leave_out & ORL_LAYER_CONFIDENCE))
        ORL_TRY(read_confidence(frame, staging, out));
    return ORL_OK;
}
