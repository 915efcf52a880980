// A finished frame from the device to host memory.
#include <string.h>

#include "render/internal.h"

// r->staging with this many channels, allocated once for frames of the same kind.
static enum orl_result stage(struct orl_renderer *r, int channels)
{
    struct orl_image *s = &r->staging;
    if (s->width == r->target.width && s->height == r->target.height && s->channels == channels)
        return ORL_OK;
    orl_image_finish(s);
    return orl_image_init(orl_gpu_log(r->gpu), s, r->target.width, r->target.height, channels,
                          ORL_PIXEL_F32);
}

static enum orl_result make(struct orl_renderer *r, int channels, struct orl_image *image)
{
    return orl_image_init(orl_gpu_log(r->gpu), image, r->target.width, r->target.height, channels,
                          ORL_PIXEL_F32);
}

static size_t pixel_count(const struct orl_renderer *r)
{
    return (size_t)r->target.width * (size_t)r->target.height;
}

static enum orl_result read_color(struct orl_renderer *r, bool coverage, struct orl_frame *frame)
{
    enum orl_result result = make(r, 3, &frame->color);
    if (result == ORL_OK && coverage)
        result = make(r, 1, &frame->coverage);
    if (result == ORL_OK)
        result = stage(r, 4);
    if (result != ORL_OK)
        return result;
    const float *rgba = r->staging.f32;
    orl_tex_read(r->accumulated, 0, GL_RGBA, GL_FLOAT, orl_image_bytes(&r->staging),
                 r->staging.f32);
    for (size_t i = 0; i < pixel_count(r); i++) {
        memcpy(&frame->color.f32[3 * i], &rgba[4 * i], 3 * sizeof(float));
        if (coverage)
            frame->coverage.f32[i] = rgba[4 * i + 3];
    }
    return ORL_OK;
}

static enum orl_result read_depth(struct orl_renderer *r, struct orl_frame *frame)
{
    enum orl_result result = make(r, 1, &frame->depth);
    if (result != ORL_OK)
        return result;
    float *depth = frame->depth.f32;
    orl_tex_read(r->target.depth, 0, GL_RED, GL_FLOAT, orl_image_bytes(&frame->depth), depth);
    for (size_t i = 0; i < pixel_count(r); i++)
        if (depth[i] < 0) // a guess, not a surface
            depth[i] = 0;
    return ORL_OK;
}

static enum orl_result read_normal(struct orl_renderer *r, struct orl_frame *frame)
{
    enum orl_result result = make(r, 3, &frame->normal);
    if (result == ORL_OK)
        orl_tex_read(r->target.normal, 0, GL_RGB, GL_FLOAT, orl_image_bytes(&frame->normal),
                     frame->normal.f32);
    return result;
}

static enum orl_result read_confidence(struct orl_renderer *r, struct orl_frame *frame)
{
    enum orl_result result = make(r, 1, &frame->confidence);
    if (result == ORL_OK)
        result = stage(r, 2);
    if (result != ORL_OK)
        return result;
    const float *sums = r->staging.f32;
    orl_tex_read(r->trusted, 0, GL_RG, GL_FLOAT, orl_image_bytes(&r->staging), r->staging.f32);
    for (size_t i = 0; i < pixel_count(r); i++)
        frame->confidence.f32[i] = sums[2 * i + 1] > 0 ? sums[2 * i] / sums[2 * i + 1] : 0;
    return ORL_OK;
}

enum orl_result orl_read_back(struct orl_renderer *r, unsigned leave_out, struct orl_frame *frame)
{
    enum orl_result result = read_color(r, !(leave_out & ORL_LAYER_COVERAGE), frame);
    if (result == ORL_OK && !(leave_out & ORL_LAYER_DEPTH))
        result = read_depth(r, frame);
    if (result == ORL_OK && !(leave_out & ORL_LAYER_NORMAL))
        result = read_normal(r, frame);
    if (result == ORL_OK && r->trusted && !(leave_out & ORL_LAYER_CONFIDENCE))
        result = read_confidence(r, frame);
    return result;
}
