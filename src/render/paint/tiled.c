// The painter of method oriel. It lists the best photographs of each tile of the screen, so that the cost of a pixel
// does not grow with the number of photographs.
#include <stdio.h>

#include "render/frame/method.h"
#include "render/paint/paint.h"
#include "render/photos/photos.h"
#include "shared/constants.h"

// For the passes that ask photographs. Without a backdrop that rests they lose no time.
static const char *rest_define(const struct frame *frame)
{
    return orl_params_guess(frame->params) && frame->scene->backdrop_rests ? "RESTS 1\n" : "";
}

// Paints from the photographs of each tile. `d`: the dispatch that has listed them.
static void gather_tiles(const struct frame *frame, struct orl_dispatch d)
{
    char defines[64];
    // The number of photographs is part of the program, so that none is sampled in vain.
    bool specks = orl_edges_find_specks(frame);
    snprintf(defines, sizeof defines, "%s%s%sKEPT %d", rest_define(frame), specks ? "SPECKS 1\n" : "",
             frame->paint->soft.shows ? "SOFT 1\n" : "", (int)(frame->params->photos_per_pixel + 0.5f));
    d.prog = orl_gather_prog(frame, "gather/tiled.comp", defines);
    d.images[1] = frame->picture;
    d.images[2] = frame->paint->fill.level[0];
    d.images[3] = frame->paint->fill.guesses;
    d.images[4] = frame->paint->soft.gathered;
    d.images[5] = frame->paint->edges.painted;
    d.textures[ORL_PHOTO_SOFT] = frame->photos->soft;
    // One invocation handles 2x2 pixels.
    d.size[0] = (frame->surface.width + 1) / 2;
    d.size[1] = (frame->surface.height + 1) / 2;
    orl_tex_clear(frame->paint->fill.guesses, 0);
    orl_gpu_pass(frame->gpu, "gather", &d);
}

static enum orl_result paint_chosen(const struct frame *frame)
{
    struct gather *g = &frame->paint->gather;
    size_t across = orl_groups((size_t)frame->surface.width, orl_tile_side(frame));
    size_t down = orl_groups((size_t)frame->surface.height, orl_tile_side(frame));
    ORL_TRY(orl_buf_fit(frame->gpu, ORL_OWNER_FRAME, "photographs of tiles",
                        across * down * ORL_CANDIDATES * sizeof(int), 0, &g->tile_lists));
    if (frame->chosen_count == 0 && !frame->progressive) {
        orl_tex_clear(frame->picture, 0);
        if (orl_edges_find_specks(frame))
            orl_tex_clear(frame->paint->edges.painted, 0);
        return ORL_OK;
    }
    struct gather_block block = orl_gather_prepare(frame, 0, frame->chosen_count);
    struct orl_dispatch d = {.prog = orl_gather_prog(frame, "gather/choose.comp", rest_define(frame)),
                             ORL_PARAMS(block),
                             .bufs = {[1] = g->tile_lists},
                             .textures = {frame->photos->color, frame->photos->depth,
                                          [ORL_PHOTO_CHROMA] = frame->photos->chroma},
                             .images = {frame->surface.depth, [PHOTO_ROWS] = &g->photos->texels},
                             .size = {(int)across, (int)down}};
    orl_gpu_pass(frame->gpu, "choose", &d);
    if (orl_guess_applies(frame))
        orl_guess_depth(frame, &d, &block);
    gather_tiles(frame, d);
    return ORL_OK;
}

static enum orl_result paint(struct frame *frame)
{
    if (frame->radiance)
        return orl_paint_gather.paint(frame);
    // Depth is always needed: the selection per tile tests occlusion even if the pixels do not.
    ORL_TRY(frame->params->select->choose(frame));
    if (frame->progressive)
        ORL_TRY(orl_progressive_admit(frame, true));
    for (size_t i = 0; !frame->progressive && i < frame->chosen_count; i++)
        ORL_TRY(orl_photos_require(frame, frame->chosen[i], true));
    if (frame->paint->soft.shows)
        ORL_TRY(orl_soft_layer_ready(frame));
    ORL_TRY(paint_chosen(frame));
    return orl_gather_underpaint(frame);
}

const struct orl_painter orl_paint_tiled = {
    .name = "tiled", .needs = "select=preselect weight=lumigraph combine=robust",
    .finishes = true, .paint = paint,
};
