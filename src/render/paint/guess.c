#include "render/paint/paint.h"

#include <stdio.h>

#include "shared/constants.h"

enum {
    COSTS = 3, SUMS = 4, // storage bindings of shaders/guess
};

static int plane_count(const struct frame *frame)
{
    return (int)(frame->params->guess_depths + 0.5f);
}

// Pixels of a cell's side: cells are about as large a part of pictures of any size.
static int cell_side(const struct frame *frame)
{
    const struct orl_camera *camera = &frame->view->camera;
    int longer = camera->width > camera->height ? camera->width : camera->height, side = 2;
    while (2 * ORL_GUESS_CELLS * side <= longer)
        side *= 2;
    return side;
}

static int cells(const struct frame *frame, int pixels)
{
    int side = cell_side(frame);
    return (pixels + side - 1) / side;
}

static size_t cost_bytes(const struct frame *frame)
{
    const struct orl_camera *camera = &frame->view->camera;
    return (size_t)cells(frame, camera->width) * (size_t)cells(frame, camera->height) *
           (size_t)plane_count(frame) * sizeof(float);
}

bool orl_guess_applies(const struct frame *frame)
{
    return orl_params_guess(frame->params) && plane_count(frame) > 1 &&
           cost_bytes(frame) <= orl_gpu_caps(frame->gpu)->max_storage_block;
}

void orl_guess_finish(struct orl_gpu *gpu, struct guess *guess)
{
    orl_buf_destroy(gpu, &guess->costs);
    orl_buf_destroy(gpu, &guess->sums);
    orl_tex_destroy(gpu, &guess->estimated);
    orl_tex_destroy(gpu, &guess->picked);
}

enum orl_result orl_guess_resize(const struct frame *frame, struct guess *guess)
{
    struct orl_gpu *gpu = frame->gpu;
    struct orl_tex_params params = {.width = cells(frame, frame->view->camera.width),
                                    .height = cells(frame, frame->view->camera.height),
                                    .format = GL_R32F, .tag = "estimated depth"};
    size_t bytes = cost_bytes(frame);
    if (!orl_guess_applies(frame))
        return ORL_OK;
    ORL_TRY(orl_buf_fit(gpu, ORL_OWNER_FRAME, "costs of depths", bytes, 0, &guess->costs));
    ORL_TRY(orl_buf_fit(gpu, ORL_OWNER_FRAME, "costs of paths", bytes, 0, &guess->sums));
    ORL_TRY(orl_tex_fit(gpu, &params, &guess->estimated));
    params.tag = "picked depth";
    return orl_tex_fit(gpu, &params, &guess->picked);
}

static struct orl_prog *program(const struct frame *frame, const char *file, const char *along)
{
    char defines[48];
    snprintf(defines, sizeof defines, "CELL %d\nPLANES %d\n%s", cell_side(frame), plane_count(frame), along);
    return orl_gather_prog(frame, file, defines);
}

static void run(const struct frame *frame, const char *file, int width, int height, struct orl_dispatch *d)
{
    d->prog = program(frame, file, "");
    d->size[0] = width;
    d->size[1] = height;
    orl_gpu_dispatch(frame->gpu, d);
}

// Semi-global matching: each line of cells is one invocation.
static void smooth(const struct frame *frame, int width, int height, struct orl_dispatch *d)
{
    static const char *const along[] = {"ALONG 0", "ALONG 1", "ALONG 2", "ALONG 3"};
    for (int k = 0; k < 4; k++) {
        d->prog = program(frame, "guess/smooth.comp", along[k]);
        d->size[0] = k < 2 ? height : width;
        d->size[1] = 1;
        orl_gpu_dispatch(frame->gpu, d);
    }
}

void orl_guess_depth(const struct frame *frame, const struct orl_dispatch *choice,
                     const struct gather_block *block)
{
    const struct guess *guess = &frame->paint->guess;
    double distance = frame->scene->photo_distance > 0 ? frame->scene->photo_distance : 1;
    struct gather_block planes = *block;
    planes.min_inverse = (float)(1 / (ORL_GUESS_FARTHEST * distance));
    int width = guess->picked->params.width, height = guess->picked->params.height;
    struct orl_dispatch d = *choice;
    d.params = &planes;
    d.bufs[COSTS] = guess->costs;
    d.bufs[SUMS] = guess->sums;
    d.images[1] = guess->estimated;
    d.images[2] = guess->picked;
    orl_pass_begin(frame->gpu, "guess");
    run(frame, "guess/cost.comp", width, height, &d);
    smooth(frame, width, height, &d);
    run(frame, "guess/pick.comp", width, height, &d);
    run(frame, "guess/apply.comp", width, height, &d);
    orl_pass_end(frame->gpu);
}
