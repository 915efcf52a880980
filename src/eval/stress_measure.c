// Measures a method on one scene in memory: accuracy, flicker, invariants.
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "core/color.h"
#include "core/memory.h"
#include "eval/flip.h"
#include "eval/heldout.h"
#include "eval/metrics.h"
#include "eval/stability.h"
#include "eval/stress_internal.h"

const char *const orl_stress_figures[STRESS_FIGURES] = {"psnr_db", "ssim", "flip", "crumbs",
                                                        "completeness", "coverage"};
static const double small_move = 1e-4; // of the scene's distance
static const float sky_depth = 1e4f;   // scene units, for sky in true depth

struct job {
    const struct stress_case *c;
    const struct orl_log *log;
    const struct orl_render_params *render;
    struct stress_result *result;
    float low[3], high[3]; // of everything that pictures are made of, linear
};

// --- what colours there are ---

static void widen(struct job *job, size_t channel, float value)
{
    job->low[channel] = fminf(job->low[channel], value);
    job->high[channel] = fmaxf(job->high[channel], value);
}

// Light of photographs, with their gains if the method uses them, and of points.
static void find_range(struct job *job)
{
    const struct orl_scene *scene = &job->c->scene;
    bool aligned = job->render->alignment == ORL_ALIGNMENT_ON;
    for (size_t k = 0; k < 3; k++) {
        job->low[k] = INFINITY;
        job->high[k] = 0;
    }
    for (size_t i = 0; i < scene->photo_count; i++) {
        const struct orl_image *image = &job->c->photos[i];
        uint8_t low[3] = {255, 255, 255}, high[3] = {0, 0, 0};
        float corner = 1;
        if (scene->photos[i].test)
            continue;
        for (size_t p = 0; p < 3 * (size_t)image->width * (size_t)image->height; p++) {
            low[p % 3] = image->u8[p] < low[p % 3] ? image->u8[p] : low[p % 3];
            high[p % 3] = image->u8[p] > high[p % 3] ? image->u8[p] : high[p % 3];
        }
        for (int v = 0; v < 3; v++)
            corner += fminf(scene->photos[i].vignette[v], 0);
        for (size_t k = 0; k < 3; k++) {
            float gain = aligned ? scene->photos[i].gain[k] / fmaxf(corner, 0.1f) : 1;
            widen(job, k, gain * orl_srgb_decode((float)low[k] / 255));
            widen(job, k, gain * orl_srgb_decode((float)high[k] / 255));
        }
    }
    float linear[256];
    for (int v = 0; v < 256; v++)
        linear[v] = orl_srgb_decode((float)v / 255);
    for (size_t i = 0; i < scene->points.count; i++)
        for (size_t k = 0; k < 3; k++)
            widen(job, k, linear[scene->points.color[i][k]]);
}

static void check_values(struct job *job, const struct orl_image *color)
{
    struct stress_invariants *found = &job->result->invariants;
    size_t values = 3 * (size_t)color->width * (size_t)color->height;
    for (size_t p = 0; p < values; p++) {
        float value = color->f32[p];
        if (!isfinite(value)) {
            found->not_finite++;
            continue;
        }
        // Black is what stands for nothing.
        float beyond = fmaxf(value - job->high[p % 3],
                             value > 0 ? job->low[p % 3] - value : -value);
        found->overshoot = fmax(found->overshoot, (double)beyond);
    }
}

static double mean_of(const struct orl_image *image)
{
    double sum = 0;
    size_t values = (size_t)image->channels * (size_t)image->width * (size_t)image->height;
    for (size_t p = 0; p < values; p++)
        sum += image->u8[p];
    return sum / (double)values;
}

// --- frames ---

static enum orl_result draw(struct job *job, const struct stress_view *view,
                            const struct orl_view *at, unsigned leave_out, struct orl_frame *frame)
{
    struct orl_render_params render = *job->render;
    render.leave_out |= leave_out;
    return orl_renderer_draw(view->renderer ? view->renderer : job->c->renderer, at, &render, NULL,
                             frame);
}

static enum orl_result compare(struct job *job, const struct stress_view *view,
                               const struct orl_image *picture, const struct orl_image *coverage)
{
    struct orl_metrics m;
    double flip = 0, n = (double)job->c->view_count;
    enum orl_result result =
        orl_metrics_compare(job->log, picture, &view->picture, coverage, &m);
    if (result == ORL_OK)
        result = orl_flip_compare(job->log, picture, &view->picture, NULL, &flip);
    if (result != ORL_OK)
        return result;
    const double values[STRESS_FIGURES] = {m.psnr_db, m.ssim, flip, m.crumbs,
                                           m.completeness, m.coverage};
    for (size_t k = 0; k < STRESS_FIGURES; k++)
        job->result->figures[k] += values[k] / n;
    double brightness = mean_of(picture) / fmax(mean_of(&view->picture), 1);
    job->result->invariants.brightness = fmin(job->result->invariants.brightness, brightness);
    return ORL_OK;
}

// --- a view that hardly moves ---

static void compare_moved(struct job *job, const struct orl_image *a, const struct orl_image *b)
{
    struct stress_invariants *found = &job->result->invariants;
    size_t pixels = (size_t)a->width * (size_t)a->height, many = 0;
    double sum = 0;
    for (size_t p = 0; p < pixels; p++) {
        int most = 0;
        for (size_t k = 0; k < 3; k++) {
            int change = abs(a->u8[3 * p + k] - b->u8[3 * p + k]);
            sum += change;
            most = change > most ? change : most;
        }
        many += most > STRESS_MOVED_STEP;
    }
    found->moved_mean = sum / (3 * (double)pixels);
    found->moved_share = (double)many / (double)pixels;
}

static enum orl_result move_a_little(struct job *job, const struct stress_view *view,
                                     const struct orl_image *before)
{
    struct orl_view moved = view->view;
    struct orl_frame frame = {0};
    struct orl_image after = {0};
    moved.cam_from_world.t[0] -= small_move * job->c->scene.photo_distance;
    enum orl_result result = draw(job, view, &moved, ORL_LAYER_NORMAL | ORL_LAYER_DEPTH, &frame);
    if (result == ORL_OK)
        result = orl_tone_srgb(job->log, &frame.color, &after);
    if (result == ORL_OK)
        compare_moved(job, before, &after);
    orl_image_finish(&after);
    orl_frame_finish(&frame);
    return result;
}

static enum orl_result measure_view(struct job *job, size_t index)
{
    const struct stress_view *view = &job->c->views[index];
    struct orl_frame frame = {0};
    struct orl_image picture = {0}, plain = {0};
    enum orl_result result =
        draw(job, view, &view->view, ORL_LAYER_NORMAL | ORL_LAYER_DEPTH, &frame);
    if (result == ORL_OK) {
        check_values(job, &frame.color);
        result = orl_tone_srgb(job->log, &frame.color, &plain);
    }
    if (result == ORL_OK)
        result = orl_heldout_expose(job->log, view->scene ? view->scene : &job->c->scene, view->photo, job->render,
                                    &frame.color, &picture);
    if (result == ORL_OK)
        result = compare(job, view, &picture, &frame.coverage);
    if (result == ORL_OK && index == 0)
        result = move_a_little(job, view, &plain);
    if (result == ORL_OK && index == 0) {
        job->result->picture = picture;
        memset(&picture, 0, sizeof picture);
    }
    orl_image_finish(&plain);
    orl_image_finish(&picture);
    orl_frame_finish(&frame);
    return result;
}

// --- flicker ---

// With true depth all pixels are compared that both frames see, sky and guessed ones included.
static enum orl_result take_true_depth(const struct orl_log *log, const struct orl_image *truth,
                                       struct orl_stability_frame *to)
{
    enum orl_result result =
        orl_image_init(log, &to->depth, truth->width, truth->height, 1, ORL_PIXEL_F32);
    if (result == ORL_OK)
        result = orl_image_init(log, &to->coverage, truth->width, truth->height, 1,
                                ORL_PIXEL_F32);
    for (int p = 0; result == ORL_OK && p < truth->width * truth->height; p++) {
        to->depth.f32[p] = truth->f32[p] > 0 ? truth->f32[p] : sky_depth;
        to->coverage.f32[p] = 1;
    }
    return result;
}

static enum orl_result draw_walk(struct job *job, const struct stress_view *view,
                                 struct orl_stability_frame *to)
{
    struct orl_frame frame = {0};
    enum orl_result result = draw(job, view, &view->view, ORL_LAYER_NORMAL, &frame);
    to->view = view->view;
    if (result == ORL_OK)
        result = orl_tone_srgb(job->log, &frame.color, &to->srgb);
    if (result == ORL_OK && view->depth.data) {
        result = take_true_depth(job->log, &view->depth, to);
    } else if (result == ORL_OK) {
        to->depth = frame.depth;
        to->coverage = frame.coverage;
        memset(&frame.depth, 0, sizeof frame.depth);
        memset(&frame.coverage, 0, sizeof frame.coverage);
    }
    orl_frame_finish(&frame);
    return result;
}

static enum orl_result walk(struct job *job)
{
    struct orl_stability_frame frames[2] = {0}; // frame i is in frames[i % 2]
    struct orl_stability_counts counts = {0};
    struct orl_stability_step step;
    size_t count = job->c->walk_count;
    enum orl_result result = ORL_OK;
    for (size_t i = 0; result == ORL_OK && i < count; i++) {
        orl_stability_frame_finish(&frames[i % 2]);
        result = draw_walk(job, &job->c->walk[i], &frames[i % 2]);
        if (result == ORL_OK && i > 0)
            result = orl_stability_compare(job->log, &frames[(i - 1) % 2], &frames[i % 2],
                                           &counts, &step);
        if (result == ORL_OK && i > 0)
            job->result->flicker += step.block_mean / (double)(count - 1);
    }
    orl_stability_frame_finish(&frames[0]);
    orl_stability_frame_finish(&frames[1]);
    return result;
}

enum orl_result orl_stress_measure(const struct stress_case *c,
                                   const struct orl_render_params *render,
                                   struct stress_result *out)
{
    struct job job = {.c = c, .log = orl_gpu_log(c->gpu), .render = render, .result = out};
    *out = (struct stress_result){.invariants = {.brightness = INFINITY}};
    find_range(&job);
    enum orl_result result = ORL_OK;
    for (size_t i = 0; result == ORL_OK && i < c->view_count; i++)
        result = measure_view(&job, i);
    return result == ORL_OK ? walk(&job) : result;
}

bool orl_stress_invariants_hold(const struct stress_invariants *i)
{
    return i->not_finite == 0 && i->brightness >= STRESS_BRIGHTNESS_MIN &&
           i->overshoot <= STRESS_OVERSHOOT_MAX && i->moved_mean <= STRESS_MOVED_MEAN_MAX &&
           i->moved_share <= STRESS_MOVED_SHARE_MAX;
}
