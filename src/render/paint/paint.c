#include "render/paint/paint.h"

#include <string.h>

#include "render/frame/method.h"

enum orl_result orl_paint_init(struct orl_gpu *gpu, size_t photo_count, struct paint *paint)
{
    memset(paint, 0, sizeof *paint);
    return orl_gather_init(gpu, photo_count, &paint->gather);
}

void orl_paint_finish(struct orl_gpu *gpu, struct paint *paint)
{
    orl_gather_finish(gpu, &paint->gather);
    orl_fill_finish(gpu, &paint->fill);
    orl_soft_layer_finish(gpu, &paint->soft);
    orl_edges_finish(gpu, &paint->edges);
    orl_guess_finish(gpu, &paint->guess);
    orl_tex_destroy(gpu, &paint->trusted);
    orl_tex_destroy(gpu, &paint->states[0]);
    orl_tex_destroy(gpu, &paint->states[1]);
}

static int state_count(const struct frame *frame)
{
    int count = frame->radiance || frame->finishes ? 0 : frame->params->combine->states;
    return frame->params->median != ORL_MEDIAN_OFF && count < 1 ? 1 : count;
}

enum orl_result orl_paint_resize(const struct frame *frame)
{
    struct paint *paint = frame->paint;
    int width = frame->view->camera.width, height = frame->view->camera.height, states = state_count(frame);
    enum orl_result result = orl_fill_resize(frame->gpu, &paint->fill, width, height);
    if (result == ORL_OK && !frame->radiance)
        result = orl_edges_resize(frame->gpu, &paint->edges, width, height);
    ORL_THEN(result, orl_frame_target(frame, "what may be specks", orl_edges_find_specks(frame), GL_RG8,
                                      &paint->edges.painted));
    if (result == ORL_OK && frame->finishes)
        result = orl_guess_resize(frame, &paint->guess);
    ORL_THEN(result, orl_frame_target(frame, "accumulated trust", frame->radiance, GL_RGBA32F,
                                      &paint->trusted));
    for (int i = 0; i < 2; i++)
        ORL_THEN(result, orl_frame_target(frame, "combination", states > i, GL_RGBA32F,
                                          &paint->states[i]));
    return result;
}
