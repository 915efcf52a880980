#include "eval/stability.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "core/file.h"
#include "core/json.h"
#include "core/memory.h"
#include "core/process.h"
#include "io/picture.h"

// Relative difference of depths on one surface: more than a pixel's slope on walls seen at a slant,
// less than the distance between neighbouring objects.
static const double same_surface = 0.01;

enum { TAPS = 4, THERE_AND_BACK = 2 * TAPS - 1 };

// --- interpolation ---

// Catmull-Rom weights at `t` in [0, 1) between the second and third sample. Bilinear weights blur
// so much that the interpolation floor hides the differences between methods.
static void weights_at(double t, double w[TAPS])
{
    w[0] = t * (-0.5 + t * (1 - 0.5 * t));
    w[1] = 1 + t * t * (-2.5 + 1.5 * t);
    w[2] = t * (0.5 + t * (2 - 1.5 * t));
    w[3] = t * t * (-0.5 + 0.5 * t);
}

// Moved by t and then by -t: the weights at t convolved with their mirror image.
static void weights_there_and_back(double t, double w[THERE_AND_BACK])
{
    double there[TAPS];
    weights_at(t, there);
    memset(w, 0, THERE_AND_BACK * sizeof *w);
    for (int i = 0; i < TAPS; i++)
        for (int j = 0; j < TAPS; j++)
            w[i + TAPS - 1 - j] += there[i] * there[j];
}

// Weighted sum of taps x taps pixels from (x, y), which must all lie in the picture.
static void weigh(const struct orl_image *image, int x, int y, int taps, const double *wx,
                  const double *wy, double rgb[3])
{
    rgb[0] = rgb[1] = rgb[2] = 0;
    for (int j = 0; j < taps; j++) {
        const uint8_t *row = image->u8 + 3 * ((size_t)(y + j) * (size_t)image->width + (size_t)x);
        for (int i = 0; i < taps; i++)
            for (int c = 0; c < 3; c++)
                rgb[c] += wx[i] * wy[j] * row[3 * i + c];
    }
    for (int c = 0; c < 3; c++)
        rgb[c] = rgb[c] < 0 ? 0 : rgb[c] > 255 ? 255 : rgb[c];
}

static bool holds(const struct orl_image *image, int x, int y, int taps)
{
    return x >= 0 && y >= 0 && x + taps <= image->width && y + taps <= image->height;
}

// --- one pixel ---

struct sample {
    double rgb[3];
    double tx, ty; // fractions of a pixel at which it was interpolated
};

static double depth_at(const struct orl_stability_frame *frame, int x, int y)
{
    size_t at = (size_t)y * (size_t)frame->depth.width + (size_t)x;
    return frame->coverage.f32[at] > 0 ? frame->depth.f32[at] : 0;
}

// The colour in `before` for a pixel of `after`. Returns false unless the pixel and the four pixels
// around its place in `before` show one surface, since other surfaces would be blended in.
static bool warp(const struct orl_stability_frame *before,
                 const struct orl_stability_frame *after, int x, int y, struct sample *out)
{
    double z = depth_at(after, x, y), world[3], pixel[2], expected, wx[TAPS], wy[TAPS];
    if (!(z > 0))
        return false;
    orl_view_unproject(&after->view, x + 0.5, y + 0.5, z, world);
    if (!orl_view_project(&before->view, world, pixel, &expected))
        return false;
    // An unchanged view gives exactly the same pixel, without rounding errors.
    for (int k = 0; k < 2; k++) {
        double centre = floor(pixel[k]) + 0.5;
        if (fabs(pixel[k] - centre) < 1e-6)
            pixel[k] = centre;
    }
    if (!(fabs(pixel[0]) < 1e6 && fabs(pixel[1]) < 1e6))
        return false;
    int left = (int)floor(pixel[0] - 0.5), top = (int)floor(pixel[1] - 0.5);
    if (!holds(&before->srgb, left - 1, top - 1, TAPS))
        return false;
    for (int i = 0; i < 4; i++) {
        double found = depth_at(before, left + i % 2, top + i / 2);
        if (!(found > 0) || fabs(found - expected) > same_surface * expected)
            return false;
    }
    out->tx = pixel[0] - 0.5 - left;
    out->ty = pixel[1] - 0.5 - top;
    weights_at(out->tx, wx);
    weights_at(out->ty, wy);
    weigh(&before->srgb, left - 1, top - 1, TAPS, wx, wy, out->rgb);
    return true;
}

// The difference that interpolation makes to a pixel when its picture is moved as the sample was,
// and back.
static double lost(const struct orl_image *image, int x, int y, const struct sample *sample)
{
    double wx[THERE_AND_BACK], wy[THERE_AND_BACK], rgb[3], sum = 0;
    int left = x - TAPS + 1, top = y - TAPS + 1;
    if (!holds(image, left, top, THERE_AND_BACK))
        return 0;
    weights_there_and_back(sample->tx, wx);
    weights_there_and_back(sample->ty, wy);
    weigh(image, left, top, THERE_AND_BACK, wx, wy, rgb);
    const uint8_t *own = image->u8 + 3 * ((size_t)y * (size_t)image->width + (size_t)x);
    for (int c = 0; c < 3; c++)
        sum += fabs(rgb[c] - own[c]) / 3;
    return sum;
}

// --- two frames ---

struct block {
    double change[3]; // signed, summed
    size_t pixels;
};

struct sums {
    struct block all;
    double absolute, lost;
    struct orl_stability_counts counts;
};

static void add_pixel(const struct orl_stability_frame *before,
                      const struct orl_stability_frame *after, int x, int y, struct sums *sums,
                      struct block *block)
{
    struct sample sample;
    if (!warp(before, after, x, y, &sample))
        return;
    const uint8_t *own =
        after->srgb.u8 + 3 * ((size_t)y * (size_t)after->srgb.width + (size_t)x);
    double off = 0;
    for (int c = 0; c < 3; c++) {
        double change = own[c] - sample.rgb[c];
        off += fabs(change);
        block->change[c] += change;
        sums->all.change[c] += change;
    }
    block->pixels++;
    sums->all.pixels++;
    sums->absolute += off / 3;
    sums->counts.of[lround(off)]++;
    sums->lost += lost(&after->srgb, x, y, &sample);
}

static double mean_change(const struct block *block)
{
    double sum = 0;
    for (int c = 0; c < 3; c++)
        sum += fabs(block->change[c]) / 3;
    return block->pixels ? sum / (double)block->pixels : 0;
}

static double percentile_99(const struct orl_stability_counts *counts)
{
    size_t all = 0, below = 0;
    for (size_t i = 0; i < ORL_COUNT(counts->of); i++)
        all += counts->of[i];
    for (size_t i = 0; i < ORL_COUNT(counts->of); i++) {
        below += counts->of[i];
        if (below > 0 && (double)below >= 0.99 * (double)all)
            return (double)i / 3;
    }
    return 0;
}

static void compare_block(const struct orl_stability_frame *before,
                          const struct orl_stability_frame *after, int left, int top,
                          struct sums *sums, struct block *block)
{
    memset(block, 0, sizeof *block);
    for (int y = top; y < top + ORL_STABILITY_BLOCK && y < after->srgb.height; y++)
        for (int x = left; x < left + ORL_STABILITY_BLOCK && x < after->srgb.width; x++)
            add_pixel(before, after, x, y, sums, block);
}

void orl_stability_compare(const struct orl_stability_frame *before,
                           const struct orl_stability_frame *after,
                           struct orl_stability_counts *counts, struct orl_stability_step *step)
{
    memset(step, 0, sizeof *step);
    struct sums sums = {0};
    for (int y = 0; y < after->srgb.height; y += ORL_STABILITY_BLOCK)
        for (int x = 0; x < after->srgb.width; x += ORL_STABILITY_BLOCK) {
            struct block block;
            compare_block(before, after, x, y, &sums, &block);
            if (block.pixels < ORL_STABILITY_BLOCK * ORL_STABILITY_BLOCK / 2)
                continue;
            double change = mean_change(&block);
            step->block_mean += change;
            step->blocks++;
            if (change > step->block_worst) {
                step->block_worst = change;
                step->block_x = x;
                step->block_y = y;
            }
        }
    double pixels = (double)sums.all.pixels;
    step->pixels = sums.all.pixels;
    step->compared = pixels / ((double)after->srgb.width * after->srgb.height);
    step->mean = pixels > 0 ? sums.absolute / pixels : 0;
    step->floor = pixels > 0 ? 0.5 * sums.lost / pixels : 0;
    step->p99 = percentile_99(&sums.counts);
    step->block_mean /= step->blocks ? (double)step->blocks : 1;
    step->jump = mean_change(&sums.all);
    for (size_t i = 0; i < ORL_COUNT(counts->of); i++)
        counts->of[i] += sums.counts.of[i];
}

// --- a walk ---

static enum orl_result walk_past_photographs(const struct orl_log *log, const struct orl_scene *scene,
                                             size_t frames, int divide, struct orl_path *path)
{
    struct orl_scene training = *scene; // only its photographs are replaced; their names and
                                        // the points belong to the scene
    training.photos = orl_array(log, scene->photo_count, sizeof *training.photos);
    ORL_TRY_MEMORY(training.photos);
    training.photo_count = 0;
    for (size_t i = 0; i < scene->photo_count; i++)
        if (!scene->photos[i].test)
            training.photos[training.photo_count++] = scene->photos[i];
    enum orl_result result = orl_path_through_photos(log, &training, frames, path);
    for (size_t i = 0; result == ORL_OK && i < path->count; i++) {
        const struct orl_camera *first = &training.photos[0].view.camera;
        int width = first->width / divide, height = first->height / divide;
        path->views[i].camera = orl_camera_reframed(&path->views[i].camera, width > 0 ? width : 1,
                                                    height > 0 ? height : 1);
    }
    free(training.photos);
    return result;
}

enum orl_result orl_stability_walk(const struct orl_log *log, const struct orl_scene *scene, const char *file,
                                   size_t frames, int divide, struct orl_path *path)
{
    memset(path, 0, sizeof *path);
    if (!file)
        return walk_past_photographs(log, scene, frames, divide, path);
    ORL_TRY(orl_path_read(log, scene, file, path));
    for (size_t i = 0; i < path->count; i++) {
        struct orl_camera *camera = &path->views[i].camera;
        *camera = orl_camera_resized(camera, camera->width / divide, camera->height / divide);
    }
    return ORL_OK;
}

static void frame_finish(struct orl_stability_frame *frame)
{
    orl_image_finish(&frame->srgb);
    orl_image_finish(&frame->depth);
    orl_image_finish(&frame->coverage);
}

static enum orl_result draw(struct orl_gpu *gpu, struct orl_renderer *renderer,
                            const struct orl_stability_params *params, size_t index,
                            struct orl_stability_frame *out, double *ms)
{
    const struct orl_log *log = orl_gpu_log(gpu);
    struct orl_frame frame = {0};
    *out = (struct orl_stability_frame){.view = params->path->views[index]};
    const bool *skip = params->skip ? params->skip(params->skip_priv, index) : NULL;
    double start = orl_time_s();
    enum orl_result result = orl_renderer_draw(renderer, &out->view, &params->choice->params, skip, &frame);
    *ms += 1e3 * (orl_time_s() - start);
    ORL_THEN(result, orl_tone_srgb(log, &frame.color, &out->srgb));
    if (result == ORL_OK && params->image_dir)
        result = orl_png_write(log, ORL_PATH(params->image_dir, "%s.%05zu.png", params->choice->method->name, index),
                               &out->srgb);
    out->depth = frame.depth;
    out->coverage = frame.coverage;
    frame.depth = frame.coverage = (struct orl_image){0};
    orl_frame_finish(&frame);
    return result;
}

static void summarise(struct orl_stability *s, const struct orl_stability_counts *counts)
{
    struct orl_stability_step *all = &s->all;
    for (size_t i = 0; i < s->step_count; i++) {
        const struct orl_stability_step *step = &s->steps[i];
        all->pixels += step->pixels; // frames of a file's views may differ in size
        all->compared += step->compared;
        all->mean += step->mean * (double)step->pixels;
        all->floor += step->floor * (double)step->pixels;
        all->blocks += step->blocks;
        all->block_mean += step->block_mean * (double)step->blocks;
        if (step->block_worst > all->block_worst) {
            all->block_worst = step->block_worst;
            all->block_x = step->block_x;
            all->block_y = step->block_y;
            s->worst_block_step = i;
        }
        if (step->jump > all->jump) {
            all->jump = step->jump;
            s->worst_jump_step = i;
        }
    }
    if (all->pixels > 0) {
        all->mean /= (double)all->pixels;
        all->floor /= (double)all->pixels;
    }
    if (all->blocks > 0)
        all->block_mean /= (double)all->blocks;
    all->compared /= (double)s->step_count;
    all->p99 = percentile_99(counts);
}

static enum orl_result run(struct orl_gpu *gpu, struct orl_renderer *renderer,
                           const struct orl_stability_params *params, struct orl_stability *out)
{
    const struct orl_log *log = orl_gpu_log(gpu);
    const size_t count = params->path->count;
    struct orl_stability_frame frames[2] = {0}; // frame i is in frames[i % 2]
    struct orl_stability_counts counts = {0};
    enum orl_result result = params->image_dir ? orl_dir_make(log, params->image_dir) : ORL_OK;
    out->steps = orl_array(log, count - 1, sizeof *out->steps);
    if (!out->steps)
        result = ORL_ERR_MEMORY;
    for (size_t i = 0; result == ORL_OK && i < count; i++) {
        orl_progress_report(params->progress, out->method, (double)i, (double)count, NULL);
        frame_finish(&frames[i % 2]);
        result = orl_progress_cancelled(params->progress)
                     ? ORL_ERR_CANCELLED
                     : draw(gpu, renderer, params, i, &frames[i % 2], &out->render_ms);
        if (result == ORL_OK && i > 0)
            orl_stability_compare(&frames[(i - 1) % 2], &frames[i % 2], &counts, &out->steps[out->step_count++]);
    }
    frame_finish(&frames[0]);
    frame_finish(&frames[1]);
    ORL_TRY(result);
    orl_progress_report(params->progress, out->method, (double)count, (double)count, NULL);
    out->render_ms /= (double)count;
    summarise(out, &counts);
    return ORL_OK;
}

enum orl_result orl_stability_run(struct orl_gpu *gpu, struct orl_renderer *renderer,
                                  const struct orl_stability_params *params,
                                  struct orl_stability *out)
{
    *out = (struct orl_stability){.method = params->choice->method->name};
    if (params->path->count < 2)
        return orl_fail(orl_gpu_log(gpu), ORL_ERR_ARGUMENT, "a walk needs two frames");
    out->width = params->path->views[0].camera.width;
    out->height = params->path->views[0].camera.height;
    snprintf(out->device, sizeof out->device, "%s", orl_gpu_caps(gpu)->renderer);
    enum orl_result result = run(gpu, renderer, params, out);
    if (result != ORL_OK)
        orl_stability_finish(out);
    return result;
}

void orl_stability_finish(struct orl_stability *stability)
{
    free(stability->steps);
    memset(stability, 0, sizeof *stability);
}

// --- the report ---

static json_t *step_json(const struct orl_stability_step *s)
{
    return json_pack("{s:f,s:f,s:f,s:f,s:I,s:f,s:f,s:[ii],s:f}", "compared", s->compared, "mean",
                     s->mean, "p99", s->p99, "floor", s->floor, "blocks", (json_int_t)s->blocks, "block_mean",
                     s->block_mean, "block_worst", s->block_worst, "block_at", s->block_x, s->block_y, "jump", s->jump);
}

json_t *orl_stability_report(const struct orl_scene *scene, const struct orl_stability *s)
{
    json_t *steps = json_array();
    for (size_t i = 0; steps && i < s->step_count; i++)
        if (json_array_append_new(steps, step_json(&s->steps[i])) != 0) {
            json_decref(steps);
            steps = NULL;
        }
    return json_pack("{s:o,s:s,s:s,s:[ii],s:I,s:f,s:I,s:I,s:o,s:o}", "scene", orl_json_string(scene->dir), "method",
                     s->method, "device", s->device, "size", s->width, s->height, "frames",
                     (json_int_t)(s->step_count + 1), "render_ms", s->render_ms, "worst_block_step",
                     (json_int_t)s->worst_block_step, "worst_jump_step",
                     (json_int_t)s->worst_jump_step, "all", step_json(&s->all), "steps", steps);
}
