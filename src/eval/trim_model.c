// Scenes in which something is left out, ready to render.
#include <stdlib.h>
#include <string.h>

#include "core/memory.h"
#include "eval/trim_internal.h"

const double orl_trim_point_shares[TRIM_POINT_LEVELS] = {
    1,    0.9,  0.8, 0.72, 0.65,  0.57, 0.5, 0.45, 0.4,  0.36, 0.32, 0.28, 0.25,
    0.22, 0.2, 0.18, 0.16, 0.14, 0.125, 0.11, 0.1, 0.09, 0.08, 0.07, 0.0625};

enum orl_result orl_trim_state_copy(const struct orl_log *log, const struct trim_state *from,
                                    size_t photo_count, struct trim_state *to)
{
    *to = *from;
    to->removed = orl_array(log, photo_count, sizeof *to->removed);
    ORL_TRY_MEMORY(to->removed);
    memcpy(to->removed, from->removed, photo_count * sizeof *to->removed);
    return ORL_OK;
}

// --- models ---

struct orl_scene_defaults orl_trim_defaults(const struct trim_source *source,
                                            const struct trim_state *state)
{
    struct orl_scene_defaults defaults = source->scene->defaults;
    if (state->level[ORL_TRIM_TEXTURES] != ORL_TEXTURES_AUTO)
        defaults.textures = (char *)orl_textures_names[state->level[ORL_TRIM_TEXTURES]];
    int divide = (int)state->level[ORL_TRIM_DEPTH];
    if (divide > 0) {
        defaults.depth_half = true;
        defaults.depth_divide = defaults.depth_divide > divide ? defaults.depth_divide : divide;
    }
    return defaults;
}

void orl_trim_count_bytes(const struct orl_gpu *gpu, size_t *points, size_t *photos)
{
    struct orl_gpu_memory rows[64];
    size_t count = orl_gpu_memory(gpu, rows, ORL_COUNT(rows));
    *points = *photos = 0;
    for (size_t i = 0; i < count && i < ORL_COUNT(rows); i++) {
        if (rows[i].owner == ORL_OWNER_POINTS)
            *points += rows[i].bytes;
        else if (rows[i].owner == ORL_OWNER_PHOTOGRAPHS &&
                 strcmp(rows[i].tag, "photograph being loaded") != 0)
            *photos += rows[i].bytes;
    }
}

// Draws a small frame, since depth maps and masks of photographs take memory only once a method has
// asked for them.
static enum orl_result draw_first_frame(const struct trim_source *source,
                                        const struct trim_state *state,
                                        const struct trim_model *model)
{
    enum { SIDE = 64 };
    size_t photo = 0;
    while (photo + 1 < model->scene.photo_count &&
           (model->scene.photos[photo].test || state->removed[photo]))
        photo++;
    struct orl_view view = model->scene.photos[photo].view;
    struct orl_render_params render = state->render;
    render.leave_out = ~0u;
    view.camera = orl_camera_resized(&view.camera, SIDE, SIDE);
    enum orl_result result =
        orl_renderer_draw(model->renderer, &view, &render, state->removed, NULL);
    return result == ORL_OK ? orl_gpu_finish(source->gpu) : result;
}

enum orl_result orl_trim_model_open(const struct trim_source *source,
                                    const struct trim_state *state, struct trim_model **out)
{
    size_t points = 0, photos = 0, all = source->scene->points.count;
    size_t count = (size_t)(orl_trim_point_shares[state->level[ORL_TRIM_POINTS]] * (double)all + 0.5);
    struct trim_model *model = orl_array(source->log, 1, sizeof *model);
    *out = model;
    ORL_TRY_MEMORY(model);
    model->scene = *source->scene;
    model->scene.defaults = orl_trim_defaults(source, state);
    enum orl_result result = ORL_OK;
    if (count < all) {
        result = orl_points_thin_out(source->log, &source->scene->points, source->ranking.order,
                                     count, &model->points);
        model->scene.points = model->points;
    }
    orl_trim_count_bytes(source->gpu, &points, &photos);
    ORL_THEN(result, orl_renderer_create(source->gpu, &model->scene, NULL, &model->renderer));
    ORL_THEN(result, draw_first_frame(source, state, model));
    orl_trim_count_bytes(source->gpu, &model->point_bytes, &model->photo_bytes);
    model->point_bytes -= points;
    model->photo_bytes -= photos;
    if (result != ORL_OK)
        orl_trim_model_close(out);
    return result;
}

void orl_trim_model_close(struct trim_model **handle)
{
    struct trim_model *model = *handle;
    if (!model)
        return;
    orl_renderer_destroy(&model->renderer);
    orl_points_finish(&model->points);
    free(model);
    *handle = NULL;
}
