#include "render/plain_sky.h"

#include <math.h>
#include <string.h>

#include "core/vec3.h"
#include "render/gather.h"
#include "scene/sky.h"

// The least difference from its mean that a sky is taken to have, so that it is above 0.
static const float SPREAD_LEAST = 0.001f;

static size_t mean_sky(const struct frame *frame, float root[3])
{
    return orl_skies_mean(frame->scene, frame->skip,
                          frame->params->alignment == ORL_ALIGNMENT_ON, root);
}

bool orl_sky_applies(const struct frame *frame)
{
    float root[3];
    return frame->params->plain_sky > 0 && frame->finishes && orl_frame_guesses(frame) &&
           mean_sky(frame, root) > 0;
}

void orl_sky_describe(const struct frame *frame, struct gather_block *block)
{
    double up[3];
    float root[3];
    mean_sky(frame, root);
    for (int c = 0; c < 3; c++)
        block->plain_sky[c] = root[c] * root[c];
    orl_scene_upwards(frame->scene, up);
    for (int k = 0; k < 3; k++)
        block->up[k] = (float)orl_dot3(frame->view->cam_from_world.r[k], up);
}

void orl_sky_describe_photo(const struct frame *frame, const struct orl_photo *photo,
                            struct photo_data *data)
{
    float root[3];
    if (frame->radiance || !photo->has_sky)
        return;
    orl_sky_of_photo(photo, data->gain, root);
    memcpy(data->noise, root, sizeof root);
    data->offset[3] = fmaxf(photo->sky_spread, SPREAD_LEAST);
}

enum orl_result orl_sky_find(const struct frame *frame, struct orl_dispatch *d)
{
    struct gather *g = frame->gather;
    const struct orl_camera *camera = &frame->view->camera;
    size_t columns = (size_t)(camera->width > camera->height ? camera->width : camera->height);
    enum orl_result result = orl_make_room(frame->gpu, "columns of sky", columns * sizeof(int),
                                           &g->sky_columns);
    if (result != ORL_OK)
        return result;
    d->bufs[SKY_COLUMNS].buf = g->sky_columns;
    struct orl_dispatch find = *d;
    find.prog = orl_gather_prog(frame, "gather/sky.comp", NULL, NULL);
    find.groups[0] = orl_groups(columns, 64);
    find.groups[1] = 1;
    orl_pass_begin(frame->gpu, "sky");
    orl_gpu_dispatch(frame->gpu, &find);
    orl_pass_end(frame->gpu);
    return ORL_OK;
}
