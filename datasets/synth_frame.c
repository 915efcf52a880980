// Draws one view of a synthetic monument.
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "core/memory.h"
#include "datasets/synth.h"

enum {
    KIND_PLAIN = 1, KIND_VEHICLE = 2, // of a pixel, as synth/frame.comp writes it
    TILE = 8,        // side of a work group, and of a tile of synth/cone.comp, pixels
    BAND_PIXELS = 65536, // pixels of one dispatch, short enough for the watchdog of a desktop GPU
};

// Matches shaders/synth/view.glsl.
struct frame_params {
    float right[4], down[4], forward[4], eye[4];
    float camera[4];
    int32_t size[4];
    uint32_t seed[4];
    float light[4];
};
_Static_assert(sizeof(struct frame_params) == 128, "std140");

struct orl_synth {
    struct orl_gpu *gpu;
    struct orl_synth_params params; // its name, exposures and views are not used
    char variant[80]; // defines of the programs
    struct orl_tex *start, *radiance, *truth;
};

enum orl_result orl_synth_create(struct orl_gpu *gpu, const struct orl_synth_params *params,
                                 struct orl_synth **out)
{
    *out = NULL;
    const struct orl_log *log = orl_gpu_log(gpu);
    ORL_TRY(orl_synth_check(log, params));
    struct orl_synth *synth = orl_array(log, 1, sizeof *synth);
    ORL_TRY_MEMORY(synth);
    *synth = (struct orl_synth){.gpu = gpu, .params = *params};
    snprintf(synth->variant, sizeof synth->variant, "%s%s%s%s%s",
             params->contrast_ev > 0 ? "HIGH_CONTRAST 1\n" : "",
             params->gloss > 0 ? "GLOSS 1\n" : "", params->bars_m > 0 ? "BARS 1\n" : "",
             params->plain > 0 ? "PLAIN 1\n" : "", params->vehicle ? "VEHICLE 1\n" : "");
    const int width = params->width, height = params->height;
    const struct orl_tex_params start = {.width = (width + TILE - 1) / TILE, .height = (height + TILE - 1) / TILE,
                                         .format = GL_R32F, .tag = "synth start"};
    const struct orl_tex_params pixels = {.width = width, .height = height, .format = GL_RGBA32F, .tag = "synth pixels"};
    enum orl_result result = orl_tex_create(gpu, &start, &synth->start);
    ORL_THEN(result, orl_tex_create(gpu, &pixels, &synth->radiance));
    ORL_THEN(result, orl_tex_create(gpu, &pixels, &synth->truth));
    if (result == ORL_OK)
        *out = synth;
    else
        orl_synth_destroy(&synth);
    return result;
}

void orl_synth_destroy(struct orl_synth **handle)
{
    struct orl_synth *synth = *handle;
    if (!synth)
        return;
    orl_tex_destroy(synth->gpu, &synth->truth);
    orl_tex_destroy(synth->gpu, &synth->radiance);
    orl_tex_destroy(synth->gpu, &synth->start);
    free(synth);
    *handle = NULL;
}

static struct frame_params params_of(const struct orl_synth *synth, const struct orl_view *view)
{
    struct frame_params params = {
        .camera = {(float)view->camera.fx, (float)view->camera.fy, (float)view->camera.cx,
                   (float)view->camera.cy},
        .size = {synth->params.width, synth->params.height, 0, synth->params.height},
        .seed = {synth->params.seed * 0x9e3779b9u},
        .light = {(float)synth->params.contrast_ev, (float)synth->params.gloss, (float)(0.5 * synth->params.bars_m),
                  (float)synth->params.plain},
    };
    double eye[3];
    orl_pose_centre(&view->cam_from_world, eye);
    for (int i = 0; i < 3; i++) {
        params.right[i] = (float)view->cam_from_world.r[0][i];
        params.down[i] = (float)view->cam_from_world.r[1][i];
        params.forward[i] = (float)view->cam_from_world.r[2][i];
        params.eye[i] = (float)eye[i];
    }
    return params;
}

static const char *variant_of(const struct orl_synth *synth)
{
    return synth->variant[0] ? synth->variant : NULL;
}

static enum orl_result dispatch_bands(struct orl_synth *synth,
                                      const struct orl_progress *progress,
                                      struct frame_params *params)
{
    int band = BAND_PIXELS / synth->params.width / TILE * TILE;
    if (band < TILE)
        band = TILE;
    for (int row = 0; row < synth->params.height; row += band) {
        if (orl_progress_cancelled(progress))
            return ORL_ERR_CANCELLED;
        int rows = synth->params.height - row < band ? synth->params.height - row : band;
        params->size[2] = row;
        params->size[3] = row + rows;
        orl_gpu_dispatch(synth->gpu, &(struct orl_dispatch){
            .prog = orl_prog_get(synth->gpu, "synth/frame.comp", NULL, variant_of(synth)),
            ORL_PARAMS(*params), .images = {synth->start, synth->radiance, synth->truth},
            .size = {synth->params.width, rows}});
        ORL_TRY(orl_gpu_finish(synth->gpu));
    }
    return ORL_OK;
}

static enum orl_result read_frame(const struct orl_synth *synth, struct orl_synth_frame *frame)
{
    const struct orl_log *log = orl_gpu_log(synth->gpu);
    const struct orl_synth_params *p = &synth->params;
    int w = p->width, h = p->height;
    size_t pixels = (size_t)w * (size_t)h;
    float *texels = orl_array(log, pixels, 4 * sizeof *texels);
    enum orl_result result = texels ? ORL_OK : ORL_ERR_MEMORY;
    ORL_THEN(result, orl_image_init(log, &frame->radiance, w, h, 3, ORL_PIXEL_F32));
    ORL_THEN(result, orl_image_init(log, &frame->depth, w, h, 1, ORL_PIXEL_F32));
    ORL_THEN(result, orl_image_init(log, &frame->normal, w, h, 3, ORL_PIXEL_F32));
    if (result == ORL_OK && p->plain > 0)
        result = orl_image_init(log, &frame->textured, w, h, 1, ORL_PIXEL_F32);
    if (result == ORL_OK && p->vehicle)
        result = orl_image_init(log, &frame->vehicle, w, h, 1, ORL_PIXEL_U8);
    if (result != ORL_OK)
        goto end;
    orl_tex_read(synth->radiance, 0, GL_RGBA, GL_FLOAT, pixels * 4 * sizeof *texels, texels);
    for (size_t i = 0; i < pixels; i++) {
        memcpy(frame->radiance.f32 + 3 * i, texels + 4 * i, 3 * sizeof *texels);
        if (p->plain > 0)
            frame->textured.f32[i] = texels[4 * i + 3] != KIND_PLAIN;
        if (p->vehicle)
            frame->vehicle.u8[i] = texels[4 * i + 3] == KIND_VEHICLE ? 255 : 0;
    }
    orl_tex_read(synth->truth, 0, GL_RGBA, GL_FLOAT, pixels * 4 * sizeof *texels, texels);
    for (size_t i = 0; i < pixels; i++) {
        memcpy(frame->normal.f32 + 3 * i, texels + 4 * i, 3 * sizeof *texels);
        frame->depth.f32[i] = texels[4 * i + 3];
    }
    result = orl_gpu_finish(synth->gpu);
end:
    free(texels);
    return result;
}

enum orl_result orl_synth_draw(struct orl_synth *synth, const struct orl_progress *progress,
                               const struct orl_view *view, struct orl_synth_frame *frame)
{
    memset(frame, 0, sizeof *frame);
    ORL_REQUIRE(orl_gpu_log(synth->gpu), view->camera.width == synth->params.width &&
                                             view->camera.height == synth->params.height &&
                                             orl_camera_valid(&view->camera));
    struct frame_params params = params_of(synth, view);
    orl_gpu_dispatch(synth->gpu, &(struct orl_dispatch){
        .prog = orl_prog_get(synth->gpu, "synth/cone.comp", NULL, variant_of(synth)),
        ORL_PARAMS(params), .images = {synth->start},
        .size = {synth->start->params.width, synth->start->params.height}});
    enum orl_result result = dispatch_bands(synth, progress, &params);
    ORL_THEN(result, read_frame(synth, frame));
    if (result != ORL_OK)
        orl_synth_frame_finish(frame);
    return result;
}

void orl_synth_frame_finish(struct orl_synth_frame *frame)
{
    orl_image_finish(&frame->radiance);
    orl_image_finish(&frame->depth);
    orl_image_finish(&frame->normal);
    orl_image_finish(&frame->textured);
    orl_image_finish(&frame->vehicle);
}
