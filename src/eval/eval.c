#include "eval/eval.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "bridge/bridge.h"
#include "core/file.h"
#include "core/memory.h"
#include "eval/heldout.h"
#include "io/picture.h"

// Duration of the timed frames of each view.
static const double seconds = 0.2;
enum { FRAMES_MAX = 30, PASS_FRAMES = 1 };

struct job {
    const struct orl_log *log;
    struct orl_gpu *gpu;
    struct orl_renderer *renderer;
    const struct orl_scene *scene;
    const struct orl_eval_params *params;
    struct orl_eval *eval;
};

// --- drawing and timing ---

// One view's frames.
struct view_frames {
    struct job *job;
    const struct orl_view *view;
    struct orl_render_params render;
};

static enum orl_result draw(const struct view_frames *f, struct orl_frame *frame)
{
    const struct orl_eval_params *params = f->job->params;
    return params->hdr ? orl_hdr_draw(params->hdr, f->view, NULL, frame)
                       : orl_renderer_draw(f->job->renderer, f->view, &f->render, NULL, frame);
}

static enum orl_result draw_again(void *priv, size_t number)
{
    const struct view_frames *f = priv;
    struct orl_scene *sequence = f->job->params->sequence;
    if (!f->job->params->hdr) {
        if (sequence)
            ORL_TRY(orl_timing_show_time_step(f->job->gpu, sequence, f->job->renderer, number));
        return draw(f, NULL);
    }
    struct orl_frame frame = {0}; // merging several pictures needs their pixels on the host, so
                                  // reading back is part of the time
    enum orl_result result = draw(f, &frame);
    orl_frame_finish(&frame);
    return result;
}

static void add_pass_times(struct orl_eval *eval, const struct orl_timing *timing)
{
    for (size_t i = 0; i < timing->pass_count; i++) {
        struct orl_timing_pass *sum =
            orl_timing_pass(eval->passes, &eval->pass_count, timing->passes[i].name);
        if (sum)
            sum->ms += timing->passes[i].ms / (double)eval->view_count;
    }
}

// Draws the picture before the timed frames, which need no other warm-up.
static enum orl_result draw_and_time(struct job *job, const struct orl_view *view,
                                     struct orl_frame *frame, struct orl_eval_view *measured)
{
    struct view_frames frames = {job, view, job->params->choice->params};
    frames.render.leave_out |= ORL_LAYER_NORMAL;
    const struct orl_timing_params params = {
        .draw = draw_again, .priv = &frames, .views = 1, .seconds = seconds,
        .frames_max = FRAMES_MAX, .pass_frames = PASS_FRAMES, .progress = job->params->progress};
    struct orl_timing timing;
    ORL_TRY(draw(&frames, frame));
    ORL_TRY(orl_timing_take(job->gpu, &params, &timing));
    if (job->params->sequence) // the photographs are those of the scene itself
        ORL_TRY(orl_scene_set_frame(job->log, job->params->sequence, -1));
    add_pass_times(job->eval, &timing);
    measured->render_ms = timing.median_ms;
    measured->cpu_ms = timing.cpu_ms;
    return ORL_OK;
}

// --- pictures that accompany figures ---

enum { AMPLIFY = 4 };

// The photograph's name as a file name, without folders, and without its extension unless another
// photograph differs by that alone.
static void print_stem(const struct orl_scene *scene, size_t photo, char stem[ORL_PATH_SIZE])
{
    orl_path_print(stem, "", "%s", scene->photos[photo].name);
    const size_t length = orl_path_stem(stem);
    size_t alike = 0;
    for (size_t i = 0; i < scene->photo_count; i++) {
        const char *other = scene->photos[i].name;
        alike += orl_path_stem(other) == length && strncmp(other, stem, length) == 0;
    }
    if (alike == 1 && length > 0)
        stem[length] = '\0';
    for (char *slash = stem; (slash = strchr(slash, '/'));)
        *slash = '_';
}

// Photograph, rendering and their difference times AMPLIFY, from left to right.
static enum orl_result beside(const struct orl_log *log, const struct orl_image *rendered,
                              const struct orl_image *photograph, struct orl_image *panels)
{
    ORL_TRY(orl_image_init(log, panels, rendered->width * 3, rendered->height, 3, ORL_PIXEL_U8));
    size_t row = (size_t)rendered->width * 3;
    for (size_t y = 0; y < (size_t)rendered->height; y++) {
        const uint8_t *a = rendered->u8 + y * row, *b = photograph->u8 + y * row;
        uint8_t *to = panels->u8 + y * row * 3;
        memcpy(to, b, row);
        memcpy(to + row, a, row);
        for (size_t i = 0; i < row; i++) {
            int difference = AMPLIFY * abs(a[i] - b[i]);
            to[2 * row + i] = (uint8_t)(difference > 255 ? 255 : difference);
        }
    }
    return ORL_OK;
}

// Writes one view's pictures into an existing folder.
static enum orl_result write_images(const struct job *job, size_t photo, const struct orl_image *rendered,
                                    const struct orl_image *photograph)
{
    const struct orl_log *log = job->log;
    const char *dir = job->params->image_dir, *method = job->eval->method;
    struct orl_image panels = {0};
    char stem[ORL_PATH_SIZE];
    print_stem(job->scene, photo, stem);
    enum orl_result result = beside(log, rendered, photograph, &panels);
    ORL_THEN(result, orl_png_write(log, ORL_PATH(dir, "%s.photo.png", stem), photograph));
    ORL_THEN(result, orl_png_write(log, ORL_PATH(dir, "%s.%s.png", stem, method), rendered));
    ORL_THEN(result, orl_png_write(log, ORL_PATH(dir, "%s.%s.diff.png", stem, method), &panels));
    orl_image_finish(&panels);
    return result;
}

// --- pictures of other programs ---

// False: there is none.
static bool find_picture(const struct orl_scene *scene, const char *dir, size_t photo, char path[ORL_PATH_SIZE])
{
    static const char *const extensions[] = {"png", "jpg", "jpeg", "JPG"};
    char stem[ORL_PATH_SIZE];
    bool found = false;
    print_stem(scene, photo, stem);
    for (size_t i = 0; !found && i < ORL_COUNT(extensions); i++)
        found = orl_path_is_file(orl_path_print(path, dir, "%s.%s", stem, extensions[i]));
    return found;
}

// Reads another program's picture of the view at the photograph's size. All of it counts as covered,
// F32 x1. ORL_ERR_NOT_FOUND, logged: there is none.
static enum orl_result read_picture(const struct job *job, const struct orl_heldout *heldout, struct orl_image *picture,
                                    struct orl_image *coverage)
{
    const struct orl_log *log = job->log;
    const struct orl_scene *scene = job->scene;
    const char *dir = job->params->pictures;
    int width = heldout->picture.width, height = heldout->picture.height, n = heldout->divide;
    struct orl_image other = {0};
    char path[ORL_PATH_SIZE];
    if (!find_picture(scene, dir, heldout->photo, path))
        return orl_fail(log, ORL_ERR_NOT_FOUND, "%s: no picture of %s", dir,
                        scene->photos[heldout->photo].name);
    enum orl_result result = orl_picture_read(log, path, 3, &other);
    // The size may differ, but the shape must agree within a pixel or two.
    double skew = fabs((double)other.width * height - (double)other.height * width);
    if (result == ORL_OK && skew > 2 * fmax(other.width, other.height))
        result = orl_fail(log, ORL_ERR_DATA, "%s has %dx%d pixels, the photograph %dx%d", path,
                          other.width, other.height, width, height);
    bool as_photograph = other.width / n == width && other.height / n == height;
    ORL_THEN(result, as_photograph ? orl_heldout_shrink(log, &other, n, picture)
                                   : orl_bridge_resize(log, &other, width, height, picture));
    ORL_THEN(result, orl_image_init(log, coverage, width, height, 1, ORL_PIXEL_F32));
    for (int i = 0; result == ORL_OK && i < width * height; i++)
        coverage->f32[i] = 1;
    orl_image_finish(&other);
    return result;
}

// --- one view ---

static enum orl_result compare_radiance(const struct job *job, struct orl_eval_view *view,
                                        const struct orl_frame *frame)
{
    struct orl_image truth;
    enum orl_result result = orl_truth_read(job->log, job->params->truth, view->photo, &truth);
    ORL_THEN(result, orl_radiance_compare(job->log, &frame->color, &truth, &frame->coverage, &view->radiance));
    orl_image_finish(&truth);
    return result;
}

static enum orl_result render(struct job *job, const struct orl_heldout *heldout,
                              struct orl_eval_view *view, struct orl_image *rendered,
                              struct orl_image *coverage)
{
    const struct orl_render_params *render = job->params->hdr ? NULL : &job->params->choice->params;
    struct orl_frame frame = {0};
    enum orl_result result = draw_and_time(job, &heldout->view, &frame, view);
    if (result == ORL_OK && job->params->truth)
        result = compare_radiance(job, view, &frame);
    ORL_THEN(result, orl_heldout_expose(job->log, job->scene, view->photo, render, &frame.color, rendered));
    *coverage = frame.coverage;
    frame.coverage = (struct orl_image){0};
    orl_frame_finish(&frame);
    return result;
}

static enum orl_result compare_vehicle(const struct job *job, struct orl_eval_view *view,
                                       const struct orl_image *rendered,
                                       const struct orl_image *photograph,
                                       const struct orl_image *coverage)
{
    struct orl_image vehicle;
    enum orl_result result = orl_truth_vehicle(job->log, job->params->truth, view->photo, &vehicle);
    ORL_THEN(result, orl_metrics_of_part(job->log, rendered, photograph, coverage, &vehicle, &view->vehicle));
    orl_image_finish(&vehicle);
    return result;
}

static enum orl_result measure(struct job *job, struct orl_eval_view *view)
{
    const struct orl_eval_params *params = job->params;
    struct orl_heldout heldout;
    struct orl_image rendered = {0}, coverage = {0};
    enum orl_result result = orl_heldout_load(job->log, job->scene, view->photo,
                                              params->divide > 1 ? params->divide : 1, &heldout);
    view->width = heldout.picture.width;
    view->height = heldout.picture.height;
    ORL_THEN(result, params->pictures ? read_picture(job, &heldout, &rendered, &coverage)
                                      : render(job, &heldout, view, &rendered, &coverage));
    ORL_THEN(result, orl_metrics_compare(job->log, &rendered, &heldout.picture, &coverage, &view->metrics));
    ORL_THEN(result, orl_flip_compare(job->log, &rendered, &heldout.picture, &view->flip));
    if (result == ORL_OK && job->eval->has_vehicle)
        result = compare_vehicle(job, view, &rendered, &heldout.picture, &coverage);
    if (result == ORL_OK && params->image_dir)
        result = write_images(job, view->photo, &rendered, &heldout.picture);
    orl_image_finish(&coverage);
    orl_image_finish(&rendered);
    orl_heldout_finish(&heldout);
    return result;
}

// --- all views ---

static void take_means(struct orl_eval *eval)
{
    for (const struct orl_figure *f = orl_figures; f->name; f++) {
        double *mean = (void *)((char *)&eval->mean + f->offset);
        for (size_t i = 0; i < eval->view_count; i++)
            *mean += orl_figure_value(f, &eval->views[i]) / (double)eval->view_count;
    }
}

static enum orl_result list_views(const struct job *job, struct orl_eval *eval)
{
    const struct orl_scene *scene = job->scene;
    eval->views = orl_array(job->log, orl_heldout_count(scene), sizeof *eval->views);
    ORL_TRY_MEMORY(eval->views);
    for (size_t i = 0; i < scene->photo_count; i++)
        if (orl_heldout_chosen(scene, true, (size_t)job->params->views, i))
            eval->views[eval->view_count++].photo = i;
    return ORL_OK;
}

enum orl_result orl_eval_check(const struct orl_log *log, const struct orl_scene *scene)
{
    return orl_heldout_count(scene) ? ORL_OK : orl_fail(log, ORL_ERR_DATA,
                    "%s: no photograph is held out to compare with; prepare the scene with "
                    "--test-every N, --test-list A,B or --test-block A:B", scene->dir);
}

static enum orl_result measure_all(struct job *job)
{
    struct orl_eval *eval = job->eval;
    const struct orl_progress *progress = job->params->progress;
    enum orl_result result = ORL_OK;
    if (job->params->image_dir)
        result = orl_dir_make(job->log, job->params->image_dir);
    for (size_t i = 0; i < eval->view_count && result == ORL_OK; i++) {
        const char *name = job->scene->photos[eval->views[i].photo].name;
        orl_progress_report(progress, eval->method, (double)i, (double)eval->view_count, name);
        if (orl_progress_cancelled(progress))
            return ORL_ERR_CANCELLED;
        result = measure(job, &eval->views[i]);
        if (result != ORL_OK && result != ORL_ERR_CANCELLED)
            orl_logf(job->log, ORL_LOG_ERROR, "%s: could not be measured", name);
    }
    if (result == ORL_OK)
        orl_progress_report(progress, eval->method, (double)eval->view_count, (double)eval->view_count, NULL);
    return result;
}

enum orl_result orl_eval_run(struct orl_gpu *gpu, struct orl_renderer *renderer,
                             const struct orl_scene *scene, const struct orl_eval_params *params,
                             struct orl_eval *eval)
{
    struct job job = {.log = orl_gpu_log(gpu), .gpu = gpu, .renderer = renderer, .scene = scene,
                      .params = params, .eval = eval};
    *eval = (struct orl_eval){.scene = scene,
                              .method = params->pictures ? "pictures" : params->choice->method->name,
                              .has_truth = params->truth, .has_vehicle = params->truth && params->truth->vehicle};
    snprintf(eval->setting, sizeof eval->setting, "%s", params->choice->setting);
    snprintf(eval->device, sizeof eval->device, "%s", orl_gpu_caps(gpu)->renderer);
    enum orl_result result = orl_eval_check(job.log, scene);
    ORL_THEN(result, list_views(&job, eval));
    ORL_THEN(result, measure_all(&job));
    if (result != ORL_OK) {
        orl_eval_finish(eval);
        return result;
    }
    take_means(eval);
    for (int owner = 0; owner < ORL_OWNER_COUNT; owner++)
        eval->device_bytes[owner] = orl_gpu_owner_bytes(gpu, (enum orl_owner)owner);
    return ORL_OK;
}

void orl_eval_finish(struct orl_eval *eval)
{
    if (!eval)
        return;
    free(eval->views);
    memset(eval, 0, sizeof *eval);
}
