// Airieau 2012: a picture from each series of photographs, merged into radiance.
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "core/memory.h"
#include "hdr/internal.h"

// How much less a picture counts where it has no surface than where another has one.
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

static struct series *find_series(struct series_set *set, int number)
{
    for (size_t k = 0; k < set->count; k++)
        if (set->items[k].number == number)
            return &set->items[k];
    return NULL;
}

static enum orl_result add_photo(const struct orl_log *log, struct series_set *set, size_t index)
{
    const struct orl_photo *photo = &set->scene.photos[index];
    struct series *s = find_series(set, photo->series);
    if (!s) {
        s = &set->items[set->count++];
        s->number = photo->series;
        s->skip = orl_array(log, set->scene.photo_count, sizeof *s->skip);
        if (!s->skip)
            return ORL_ERR_MEMORY;
        if (photo->response >= 0) {
            s->response = orl_array(log, 3, sizeof *s->response);
            if (!s->response)
                return ORL_ERR_MEMORY;
            memcpy(s->response, set->scene.responses[photo->response].linear,
                   3 * sizeof *s->response);
        }
    }
    s->ev += (float)photo_ev(photo);
    s->count++;
    return ORL_OK;
}

enum orl_result orl_series_init(struct orl_gpu *gpu, const struct orl_scene *scene,
                                const struct orl_hdr_params *params, struct series_set *set)
{
    const struct orl_log *log = orl_gpu_log(gpu);
    enum orl_result result = ORL_OK;
    set->scene = *scene;
    set->scene.photos = orl_array(log, scene->photo_count, sizeof *scene->photos);
    set->items = orl_array(log, scene->photo_count, sizeof *set->items);
    if (!set->scene.photos || !set->items)
        return ORL_ERR_MEMORY;
    memcpy(set->scene.photos, scene->photos, scene->photo_count * sizeof *scene->photos);
    for (size_t i = 0; result == ORL_OK && i < scene->photo_count; i++)
        if (in_use(params, scene, i))
            result = add_photo(log, set, i);
    if (result != ORL_OK)
        return result;
    for (size_t k = 0; k < set->count; k++)
        set->items[k].ev /= (float)set->items[k].count;
    // Pictures keep the exposure of their series, so that they clip where it does.
    for (size_t i = 0; i < scene->photo_count; i++) {
        const struct series *s = find_series(set, scene->photos[i].series);
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
    for (size_t k = 0; k < set->count; k++) {
        free(set->items[k].skip);
        free(set->items[k].response);
    }
    free(set->items);
    free(set->scene.photos);
    memset(set, 0, sizeof *set);
}

// --- merging ---

// IEC 61966-2-1, as an 8-bit value with its fraction.
static float encoded(float c)
{
    c = c > 0 ? c < 1 ? c : 1 : 0;
    return 255 * (c <= 0.0031308f ? 12.92f * c : 1.055f * powf(c, 1 / 2.4f) - 0.055f);
}

// Linear exposure of one channel, and the step between 8-bit values there.
static float linearise(const struct series *s, int channel, float color, float *slope)
{
    float value = encoded(color);
    int below = (int)value < 254 ? (int)value : 254;
    if (s->response) {
        const float *curve = s->response[channel];
        *slope = curve[below + 1] - curve[below];
        return curve[below] + (value - (float)below) * *slope;
    }
    // Derivative of the sRGB curve, per 8-bit value.
    *slope = color <= 0.0031308f ? 1 / (12.92f * 255)
                                 : 2.4f / (1.055f * 255) * powf(color, 1 - 1 / 2.4f);
    return color;
}

struct sums {
    float color[3], weight, trust;
};

static void add_pixel(const struct orl_photo_response *response, const struct series *s,
                      const float color[3], float coverage, struct sums *sums)
{
    float x[3], slope[3], peak = 0;
    for (int c = 0; c < 3; c++) {
        x[c] = linearise(s, c, color[c], &slope[c]);
        peak = fmaxf(peak, x[c]);
    }
    float trust = orl_trust(response, x, slope, peak);
    float weight = trust * (coverage > 0.5f ? 1 : UNCOVERED_SHARE);
    float scale = exp2f(-s->ev);
    for (int c = 0; c < 3; c++)
        sums->color[c] += weight * scale * x[c];
    sums->weight += weight;
    sums->trust += weight * trust;
}

static void add_picture(const struct orl_photo_response *response, const struct series *s,
                        const struct orl_frame *picture, struct sums *sums)
{
    size_t pixels = (size_t)picture->color.width * (size_t)picture->color.height;
    for (size_t i = 0; i < pixels; i++)
        add_pixel(response, s, picture->color.f32 + 3 * i, picture->coverage.f32[i], &sums[i]);
}

// The first picture's depth and normals, which come from the points alone, are everyone's.
static void merge_layers(const struct orl_frame *picture, struct orl_frame *frame)
{
    size_t pixels = (size_t)frame->coverage.width * (size_t)frame->coverage.height;
    for (size_t i = 0; i < pixels; i++)
        frame->coverage.f32[i] = fmaxf(frame->coverage.f32[i], picture->coverage.f32[i]);
}

static void divide(const struct sums *sums, struct orl_frame *frame)
{
    size_t pixels = (size_t)frame->color.width * (size_t)frame->color.height;
    for (size_t i = 0; i < pixels; i++) {
        float weight = sums[i].weight;
        for (size_t c = 0; c < 3; c++)
            frame->color.f32[3 * i + c] = weight > 0 ? sums[i].color[c] / weight : 0;
        frame->confidence.f32[i] = weight > 0 ? sums[i].trust / weight : 0;
    }
}

enum orl_result orl_series_draw(const struct orl_log *log, struct series_set *set,
                                const struct orl_hdr_params *params, const struct orl_view *view,
                                const bool *skip, struct orl_frame *frame)
{
    int width = view->camera.width, height = view->camera.height;
    struct orl_photo_response response = {.sensor = &params->sensor, .clips = true,
                                          .ev_darkest = INFINITY, .ev_brightest = -INFINITY};
    memset(frame, 0, sizeof *frame);
    struct sums *sums = orl_array(log, (size_t)width * (size_t)height, sizeof *sums);
    enum orl_result result = sums ? ORL_OK : ORL_ERR_MEMORY;
    for (size_t k = 0; k < set->count; k++) {
        response.ev_darkest = fminf(response.ev_darkest, set->items[k].ev);
        response.ev_brightest = fmaxf(response.ev_brightest, set->items[k].ev);
    }
    for (size_t k = 0; result == ORL_OK && k < set->count; k++) {
        struct series *s = &set->items[k];
        struct orl_frame picture;
        for (size_t i = 0; i < set->scene.photo_count; i++)
            s->skip[i] = set->scene.photos[i].series != s->number || (skip && skip[i]);
        result = orl_renderer_draw(set->renderer, view, &params->render, s->skip, &picture);
        if (result != ORL_OK)
            break;
        response.ev = s->ev;
        add_picture(&response, s, &picture, sums);
        if (k == 0) {
            *frame = picture;
            continue;
        }
        merge_layers(&picture, frame);
        orl_frame_finish(&picture);
    }
    if (result == ORL_OK)
        result = orl_image_init(log, &frame->confidence, width, height, 1, ORL_PIXEL_F32);
    if (result == ORL_OK)
        divide(sums, frame);
    else
        orl_frame_finish(frame);
    free(sums);
    return result;
}
