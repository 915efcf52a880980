// A frame as the mean of pictures that differ in the size of the splats and in their place by parts of a pixel.
//
// At silhouettes, in gaps and between surfaces that lie close together, the depth of a pixel depends
// on how large the splats are drawn and where they fall on the grid of pixels, and no choice is right
// everywhere. What the pictures agree on stays as it is, and what they differ in is averaged, as an
// accumulation buffer (Haeberli and Akeley 1990) does for what differs within a pixel.
#include <math.h>

#include "render/internal.h"

#include "render/proxy/proxy.h"
#include "shared/render_blocks.h"

// The largest splats are so many times as large as the scene's own, the smallest as much smaller.
static const float max_scale = 1.75f;
// So far to each side the pictures lie: enough for another grid, and too little to blur.
static const double shift_px = 0.17;

int orl_reconstruction_count(const struct frame *frame)
{
    bool splats = frame->proxy->kind == &orl_proxy_splats;
    return splats && !frame->radiance ? (int)lrintf(frame->params->reconstructions) : 1;
}

void orl_reconstruction_vary(int index, int count, struct orl_render_params *params,
                             struct orl_camera *camera)
{
    static const double corners[4][2] = {{1, 1}, {-1, -1}, {1, -1}, {-1, 1}};
    if (index == 0)
        return;
    // The exponents of 1 2 3 4 of 5 are -1/2 1/2 -1 1, so that the mean size is the frame's.
    int steps = (index + 1) / 2 * (index % 2 ? -1 : 1), most = count / 2;
    params->splat_scale *= powf(max_scale, (float)steps / (float)most);
    camera->cx += shift_px * corners[(index - 1) % 4][0];
    camera->cy += shift_px * corners[(index - 1) % 4][1];
}

void orl_reconstruction_add(const struct frame *frame, struct orl_tex *mean, int index, int count)
{
    const char *defines = frame->finishes ? "FINISHED" : NULL;
    struct image_block block = {.image_size = {frame->surface.width, frame->surface.height},
                                .pictures = {index, count}};
    orl_gpu_pass(frame->gpu, "mean", &(struct orl_dispatch){
        .prog = orl_prog_get(frame->gpu, "fill/mean.comp", NULL, defines), ORL_PARAMS(block),
        .images = {frame->picture, mean}, .size = {frame->surface.width, frame->surface.height}});
}
