// Airieau 2012, section 4: renders a picture from each series of photographs and merges the
// pictures into radiance.
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "core/color.h"
#include "core/memory.h"
#include "hdr/internal.h"

// Relative weight of a picture without a surface at a pixel where another picture has one.
static const float UNCOVERED_SHARE = 1e-3f;

static double photo_ev(const struct orl_photo *photo)
{
    double ev = 0;
    for (int c = 0; c < 3; c++)
        ev -= log2((double)photo->gain[c]) / 3;
    return ev;
}

static bool in_use(const struct orl_hdr_params *params, const struct orl_scene *scene, size_t i)
{
    return params->use ? params->use[i] : !scene->photos[i].test;
}

// Photographs of two response curves are two series: a picture is linearised by the curve of all that it shows.
static bool belongs(const struct series *s, const struct orl_photo *photo)
{
    return photo->series == s->number && photo->response == s->response;
}

static struct series *find_series(struct series_set *set, const struct orl_photo *photo)
{
    for (size_t k = 0; k < set->count; k++)
        if (belongs(&set->items[k], photo))
            return &set->items[k];
    return NULL;
}

static enum orl_result add_photo(const struct orl_log *log, struct series_set *set, size_t index)
{
    const struct orl_photo *photo = &set->scene.photos[index];
    struct series *s = find_series(set, photo);
    if (!s) {
        s = &set->items[set->count++];
        s->number = photo->series;
        s->response = photo->response;
        s->skip = orl_array(log, set->scene.photo_count, sizeof *s->skip);
        ORL_TRY_MEMORY(s->skip);
    }
    s->ev += (float)photo_ev(photo);
    s->count++;
    return ORL_OK;
}

enum orl_result orl_series_init(struct orl_gpu *gpu, const struct orl_scene *scene,
                                const struct orl_hdr_params *params, struct series_set *set)
{
    const struct orl_log *log = orl_gpu_log(gpu);
    set->scene = *scene;
    set->scene.photos = orl_array(log, scene->photo_count, sizeof *scene->photos);
    set->items = orl_array(log, scene->photo_count, sizeof *set->items);
    ORL_TRY_MEMORY(set->scene.photos && set->items);
    memcpy(set->scene.photos, scene->photos, scene->photo_count * sizeof *scene->photos);
    for (size_t i = 0; i < scene->photo_count; i++)
        if (in_use(params, scene, i))
            ORL_TRY(add_photo(log, set, i));
    set->least_ev = INFINITY;
    set->most_ev = -INFINITY;
    for (size_t k = 0; k < set->count; k++) {
        float ev = set->items[k].ev /= (float)set->items[k].count;
        set->least_ev = fminf(set->least_ev, ev);
        set->most_ev = fmaxf(set->most_ev, ev);
    }
    // Pictures keep the exposure of their series, so that they clip where its photographs clip.
    for (size_t i = 0; i < scene->photo_count; i++) {
        const struct series *s = find_series(set, &scene->photos[i]);
        for (int c = 0; s && c < 3; c++)
            set->scene.photos[i].gain[c] *= exp2f(s->ev);
    }
    struct orl_renderer_params renderer = {.use = params->use,
                                           .max_vram_bytes = params->max_vram_bytes};
    return orl_renderer_create(gpu, &set->scene, &renderer, &set->renderer);
}

void orl_series_finish(struct series_set *set)
{
    orl_renderer_destroy(&set->renderer);
    for (size_t k = 0; k < set->count; k++)
        free(set->items[k].skip);
    free(set->items);
    free(set->scene.photos);
    memset(set, 0, sizeof *set);
}

// --- merging ---

// response: of the photographs that a colour was painted from; NULL: sRGB
static float linearise(const struct orl_response *response, int channel, float color)
{
    if (!response)
        return color;
    const float *curve = response->linear[channel];
    float value = 255 * orl_srgb_encode(color);
    int below = (int)value < 254 ? (int)value : 254;
    return curve[below] + (value - (float)below) * (curve[below + 1] - curve[below]);
}

// A series' sample of a pixel.
struct estimate {
    float color[3]; // radiance
    float clip;     // confidence with respect to clipping, less without a surface; 0: nothing is painted
};

static void form_opinions(const struct orl_sensor *sensor, const struct series_set *set, const struct series *s,
                          const struct orl_frame *picture, struct estimate *estimates, size_t stride)
{
    const struct orl_response *response = s->response >= 0 ? &set->scene.responses[s->response] : NULL;
    float ev_above = s->ev - set->least_ev;
    size_t pixels = (size_t)picture->color.width * (size_t)picture->color.height;
    for (size_t i = 0; i < pixels; i++) {
        struct estimate *estimate = &estimates[i * stride];
        const float *color = picture->color.f32 + 3 * i;
        float peak = 0, scale = exp2f(-s->ev);
        for (int c = 0; c < 3; c++) {
            float x = linearise(response, c, color[c]);
            estimate->color[c] = scale * x;
            peak = fmaxf(peak, x);
        }
        bool covered = picture->coverage.f32[i] > 0.5f;
        bool painted = covered || color[0] > 0 || color[1] > 0 || color[2] > 0;
        estimate->clip = !painted ? 0
                         : orl_clip_trust(sensor, peak, ev_above) * (covered ? 1 : UNCOVERED_SHARE);
    }
}

static float trust_at(const struct orl_sensor *sensor, const struct series *s,
                      const struct estimate *estimate, const float level[3])
{
    float scale = exp2f(s->ev), model = (float)(sensor->model * sensor->model);
    const float exposure[3] = {scale * level[0], scale * level[1], scale * level[2]};
    return estimate->clip * model / (model + orl_relative_variance(sensor, exposure, true));
}

// Merges twice, since the confidence depends on the amount of light. In the first round each series
// uses its own estimate of it, in the second the merged one.
static void merge_pixel(const struct orl_sensor *sensor, const struct series_set *set, float least,
                        const struct estimate *estimates, float color[3], float *confidence)
{
    float level[3];
    for (int round = 0; round < 2; round++) {
        float sum[3] = {0}, total = 0, trusted = 0;
        for (size_t k = 0; k < set->count; k++) {
            const struct estimate *o = &estimates[k];
            float trust = trust_at(sensor, &set->items[k], o, round ? level : o->color);
            for (int c = 0; c < 3; c++)
                sum[c] += trust * o->color[c];
            total += trust;
            trusted += trust * trust;
        }
        for (int c = 0; c < 3; c++) {
            color[c] = total > 0 ? sum[c] / total : 0;
            level[c] = fmaxf(color[c], least);
        }
        *confidence = total > 0 ? trusted / total : 0;
    }
}

// Depth and normals come from the points alone, so those of the first picture serve for all.
static void merge_layers(const struct orl_frame *picture, struct orl_frame *frame)
{
    size_t pixels = (size_t)frame->coverage.width * (size_t)frame->coverage.height;
    for (size_t i = 0; i < pixels; i++)
        frame->coverage.f32[i] = fmaxf(frame->coverage.f32[i], picture->coverage.f32[i]);
}

static enum orl_result draw_series(struct series_set *set, size_t k,
                                   const struct orl_hdr_params *params,
                                   const struct orl_view *view, const bool *skip,
                                   struct estimate *estimates, struct orl_frame *frame)
{
    struct series *s = &set->items[k];
    struct orl_frame picture;
    for (size_t i = 0; i < set->scene.photo_count; i++)
        s->skip[i] = !belongs(s, &set->scene.photos[i]) || (skip && skip[i]);
    // Antialiasing is off: all series need the same depth edges.
    struct orl_render_params render = params->render;
    render.antialias = ORL_ANTIALIAS_OFF;
    ORL_TRY(orl_renderer_draw(set->renderer, view, &render, s->skip, &picture));
    form_opinions(&params->sensor, set, s, &picture, estimates + k, set->count);
    if (k == 0) {
        *frame = picture;
    } else {
        merge_layers(&picture, frame);
        orl_frame_finish(&picture);
    }
    return ORL_OK;
}

enum orl_result orl_series_draw(const struct orl_log *log, struct series_set *set,
                                const struct orl_hdr_params *params, const struct orl_view *view,
                                const bool *skip, struct orl_frame *frame)
{
    size_t pixels = (size_t)view->camera.width * (size_t)view->camera.height;
    memset(frame, 0, sizeof *frame);
    struct estimate *estimates = orl_array(log, pixels, set->count * sizeof *estimates);
    enum orl_result result = estimates ? ORL_OK : ORL_ERR_MEMORY;
    for (size_t k = 0; result == ORL_OK && k < set->count; k++)
        result = draw_series(set, k, params, view, skip, estimates, frame);
    ORL_THEN(result, orl_image_init(log, &frame->confidence, view->camera.width, view->camera.height, 1,
                                    ORL_PIXEL_F32));
    float least = orl_least_radiance(&params->sensor, set->most_ev, true);
    for (size_t i = 0; result == ORL_OK && i < pixels; i++)
        merge_pixel(&params->sensor, set, least, estimates + i * set->count,
                    frame->color.f32 + 3 * i, &frame->confidence.f32[i]);
    if (result != ORL_OK)
        orl_frame_finish(frame);
    free(estimates);
    return result;
}
