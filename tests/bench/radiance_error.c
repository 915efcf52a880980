// radiance_error SCENE TRUTH [--bound] [--divide N] [--samples N] [--images DIR] [--set K=V]...:
// log2 error of radiance views of a synthetic scene (truth_scene.c), near edges of light and away
// from them. With --bound also the error that the truth itself has against the truth, over the
// same pixels, once it is shifted by part of a pixel, or photographed half a pixel off and
// resampled. An edge is a step of more than a stop between neighbouring pixels; near it is within
// EDGE_PX pixels. Dark: below 1/64 of white, away from edges. --divide: views at 1/N of the photographs' size.
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "core/file.h"
#include "core/json.h"
#include "core/memory.h"
#include "core/order.h"
#include "datasets/synth.h"
#include "eval/truth.h"
#include "oriel/hdr.h"
#include "io/picture.h"

enum { EDGE_PX = 2 };
static const double DARK = 1.0 / 64; // of white at the scene's middle exposure

struct job {
    struct orl_log log;
    struct orl_gpu *gpu;
    struct orl_scene *scene;
    struct orl_truth truth;
    struct orl_synth_params synth;
    const char *truth_dir, *images;
    bool bound;
    int samples, divide;
    struct orl_render_params render;
};

// One held-out photograph.
struct view {
    const char *name;
    struct orl_view view;
    struct orl_image truth;
    uint8_t *use;   // per pixel: covered
    uint8_t *edge;  // per pixel: near a step of light
    size_t pixels;
};

// --- figures ---

static double luminance(const float *p)
{
    return 0.2126 * (double)p[0] + 0.7152 * (double)p[1] + 0.0722 * (double)p[2];
}

static double stops(double light)
{
    return log2(fmax(light, 1e-7));
}

static bool is_step(const struct orl_image *truth, int x, int y)
{
    size_t w = (size_t)truth->width, at = (size_t)y * w + (size_t)x;
    double here = stops(luminance(truth->f32 + 3 * at));
    return (x + 1 < truth->width &&
            fabs(stops(luminance(truth->f32 + 3 * (at + 1))) - here) > 1) ||
           (y + 1 < truth->height &&
            fabs(stops(luminance(truth->f32 + 3 * (at + w))) - here) > 1);
}

static void find_edges(struct view *v)
{
    int w = v->truth.width, h = v->truth.height;
    for (int y = 0; y < h; y++)
        for (int x = 0; x < w; x++) {
            if (!is_step(&v->truth, x, y))
                continue;
            for (int j = y - EDGE_PX; j <= y + EDGE_PX + 1; j++)
                for (int i = x - EDGE_PX; i <= x + EDGE_PX + 1; i++)
                    if (i >= 0 && j >= 0 && i < w && j < h)
                        v->edge[(size_t)j * (size_t)w + (size_t)i] = 1;
        }
}

static enum orl_result report(const struct job *job, const struct view *v, const char *what,
                              const struct orl_image *image)
{
    double squares[2] = {0}, *all = orl_array(&job->log, v->pixels, 3 * sizeof *all);
    double dark_squares = 0, dark_sum = 0;
    size_t count[2] = {0}, n = 0, dark = 0;
    if (!all)
        return ORL_ERR_MEMORY;
    for (size_t i = 0; i < 3 * v->pixels; i++) {
        if (!v->use[i / 3])
            continue;
        double e = stops((double)image->f32[i]) - stops((double)v->truth.f32[i]);
        squares[v->edge[i / 3]] += e * e;
        count[v->edge[i / 3]]++;
        if ((double)v->truth.f32[i] < DARK && !v->edge[i / 3]) {
            dark_squares += e * e;
            dark_sum += e;
            dark++;
        }
        all[n++] = fabs(e);
    }
    if (n) {
        qsort(all, n, sizeof *all, orl_order_doubles);
        printf("%s %-26s %6.3f  median %.3f  90%% %.3f  99%% %.2f  away from edges %.3f  "
               "near %.3f (%.1f %%)  dark %.3f, bias %+.3f (%.1f %%)\n", v->name, what,
               sqrt((squares[0] + squares[1]) / (double)n), all[n / 2], all[n * 9 / 10],
               all[n * 99 / 100], sqrt(squares[0] / fmax((double)count[0], 1)),
               sqrt(squares[1] / fmax((double)count[1], 1)),
               100 * (double)count[1] / (double)n, sqrt(dark_squares / fmax((double)dark, 1)),
               dark_sum / fmax((double)dark, 1), 100 * (double)dark / (double)n);
    }
    free(all);
    return fflush(stdout) == 0 ? ORL_OK : orl_fail(&job->log, ORL_ERR_IO, "cannot write figures");
}

// Red: too bright, green: too dark, full at four stops; blue: not covered.
static enum orl_result write_error(const struct job *job, const struct view *v, const char *what,
                                   const struct orl_image *image)
{
    struct orl_image map;
    if (!job->images)
        return ORL_OK;
    enum orl_result result = orl_image_init(&job->log, &map, v->truth.width, v->truth.height, 3,
                                            ORL_PIXEL_U8);
    for (size_t i = 0; result == ORL_OK && i < v->pixels; i++) {
        double e = stops(luminance(image->f32 + 3 * i)) - stops(luminance(v->truth.f32 + 3 * i));
        uint8_t value = (uint8_t)fmin(255, 255 * sqrt(fabs(e) / 4));
        if (v->use[i])
            map.u8[3 * i + (e < 0)] = value;
        else
            map.u8[3 * i + 2] = 90;
    }
    char *path = orl_format(&job->log, "%s/%s.%s.png", job->images, v->name, what);
    if (result == ORL_OK)
        result = path ? orl_png_write(&job->log, path, &map) : ORL_ERR_MEMORY;
    free(path);
    orl_image_finish(&map);
    return result;
}

// --- what the truth makes of itself ---

// Means of factor x factor pixels.
static enum orl_result shrink(const struct job *job, const struct orl_image *from, int factor,
                              struct orl_image *out)
{
    enum orl_result result = orl_image_init(&job->log, out, from->width / factor,
                                            from->height / factor, 3, ORL_PIXEL_F32);
    size_t w = result == ORL_OK ? (size_t)out->width : 1, f = (size_t)factor;
    size_t values = result == ORL_OK ? 3 * w * (size_t)out->height : 0;
    for (size_t i = 0; i < values; i++) {
        size_t x = i / 3 % w, y = i / 3 / w;
        for (size_t k = 0; k < f * f; k++)
            out->f32[i] += from->f32[3 * ((f * y + k / f) * (size_t)from->width + f * x + k % f) +
                                     i % 3] / (float)(f * f);
    }
    return result;
}

// The truth seen by a camera shifted by (dx, dy) pixels.
static enum orl_result draw_truth(const struct job *job, const struct view *v, double dx,
                                  double dy, struct orl_image *out)
{
    int factor = job->divide;
    struct orl_synth *synth = NULL;
    struct orl_synth_frame frame = {0};
    struct orl_synth_params params = job->synth;
    struct orl_view view = v->view;
    view.camera = orl_camera_resized(&v->view.camera, factor * v->truth.width,
                                     factor * v->truth.height);
    view.camera.cx += factor * dx;
    view.camera.cy += factor * dy;
    params.width = view.camera.width;
    params.height = view.camera.height;
    memset(out, 0, sizeof *out);
    enum orl_result result = orl_synth_create(job->gpu, &params, &synth);
    if (result == ORL_OK)
        result = orl_synth_draw(synth, NULL, &view, &frame);
    if (result == ORL_OK)
        result = shrink(job, &frame.radiance, factor, out);
    orl_synth_frame_finish(&frame);
    orl_synth_destroy(&synth);
    return result;
}

// What lies (0.5, 0.5) pixels right and down, bilinear.
static enum orl_result half_back(const struct job *job, const struct orl_image *from,
                                 struct orl_image *out)
{
    enum orl_result result = orl_image_init(&job->log, out, from->width, from->height, 3,
                                            ORL_PIXEL_F32);
    for (int y = 0; result == ORL_OK && y < from->height; y++)
        for (int x = 0; x < from->width; x++)
            for (int c = 0; c < 3; c++)
                for (int k = 0; k < 4; k++) {
                    int i = x + k % 2 < from->width ? x + k % 2 : x;
                    int j = y + k / 2 < from->height ? y + k / 2 : y;
                    out->f32[3 * (y * from->width + x) + c] +=
                        0.25f * from->f32[3 * (j * from->width + i) + c];
                }
    return result;
}

static enum orl_result report_truth(const struct job *job, const struct view *v)
{
    static const struct { const char *what; double shift; } trials[] = {
        {"truth, shifted 0.1 px", 0.1}, {"truth, shifted 0.25 px", 0.25},
        {"truth, shifted 0.5 px", 0.5},
    };
    enum orl_result result = ORL_OK;
    struct orl_image image, back = {0};
    for (size_t i = 0; result == ORL_OK && i < ORL_COUNT(trials); i++) {
        result = draw_truth(job, v, trials[i].shift, 0, &image);
        if (result == ORL_OK)
            result = report(job, v, trials[i].what, &image);
        orl_image_finish(&image);
    }
    if (result == ORL_OK)
        result = draw_truth(job, v, 0.5, 0.5, &image);
    if (result == ORL_OK)
        result = half_back(job, &image, &back);
    if (result == ORL_OK)
        result = report(job, v, "truth, resampled", &back);
    if (result == ORL_OK)
        result = write_error(job, v, "resampled", &back);
    orl_image_finish(&back);
    orl_image_finish(&image);
    return result;
}

// --- views ---

static const char *const names[2] = {"fused", "series"};

static enum orl_result report_all(const struct job *job, struct view *v,
                                  const struct orl_frame frames[2])
{
    enum orl_result result = ORL_OK;
    find_edges(v);
    for (size_t i = 0; i < v->pixels; i++)
        v->use[i] = frames[0].coverage.f32[i] > 0.5f;
    for (int m = 0; m < 2 && result == ORL_OK; m++) {
        result = report(job, v, names[m], &frames[m].color);
        if (result == ORL_OK)
            result = write_error(job, v, names[m], &frames[m].color);
    }
    return result == ORL_OK && job->bound ? report_truth(job, v) : result;
}

static enum orl_result report_view(const struct job *job, struct orl_hdr *hdr[2], size_t index)
{
    const struct orl_photo *photo = &job->scene->photos[index];
    struct view v = {.name = photo->name, .view = photo->view};
    struct orl_frame frames[2] = {0};
    struct orl_image full = {0};
    enum orl_result result = orl_truth_read(&job->log, &job->truth, index, &full);
    if (result == ORL_OK)
        result = shrink(job, &full, job->divide, &v.truth);
    orl_image_finish(&full);
    v.view.camera = orl_camera_resized(&photo->view.camera, photo->view.camera.width / job->divide,
                                       photo->view.camera.height / job->divide);
    v.pixels = (size_t)v.view.camera.width * (size_t)v.view.camera.height;
    v.use = orl_array(&job->log, v.pixels, 1);
    v.edge = orl_array(&job->log, v.pixels, 1);
    if (result == ORL_OK && (!v.use || !v.edge))
        result = ORL_ERR_MEMORY;
    for (int m = 0; result == ORL_OK && m < 2; m++)
        result = orl_hdr_draw(hdr[m], &v.view, NULL, &frames[m]);
    if (result == ORL_OK)
        result = report_all(job, &v, frames);
    orl_frame_finish(&frames[0]);
    orl_frame_finish(&frames[1]);
    orl_image_finish(&v.truth);
    free(v.use);
    free(v.edge);
    return result;
}

static enum orl_result run(struct job *job)
{
    struct orl_hdr *hdr[2] = {0};
    json_t *root = NULL;
    char *path = orl_path_join(&job->log, job->truth_dir, "synth.json");
    enum orl_result result = path ? orl_json_read(&job->log, path, &root) : ORL_ERR_MEMORY;
    if (result == ORL_OK)
        result = orl_truth_open(&job->log, job->scene, job->truth_dir, &job->truth);
    const json_t *contrast = json_object_get(root, "contrast");
    if (result == ORL_OK && job->bound && !contrast)
        result = orl_fail(&job->log, ORL_ERR_DATA,
                          "%s: contrast is missing: made by an older oriel", path);
    job->synth.seed = (uint32_t)json_integer_value(json_object_get(root, "seed"));
    job->synth.contrast_ev = json_number_value(contrast);
    for (int m = 0; m < 2 && result == ORL_OK; m++) {
        struct orl_hdr_params params = {ORL_HDR_DEFAULTS};
        params.merge = (enum orl_hdr_merge)m;
        params.render = job->render;
        params.samples = job->samples;
        result = orl_hdr_create(job->gpu, job->scene, &params, &hdr[m]);
    }
    for (size_t i = 0; result == ORL_OK && i < job->scene->photo_count; i++)
        if (job->scene->photos[i].test)
            result = report_view(job, hdr, i);
    orl_hdr_destroy(&hdr[0]);
    orl_hdr_destroy(&hdr[1]);
    orl_truth_finish(&job->truth);
    json_decref(root);
    free(path);
    return result;
}

int main(int argc, char **argv)
{
    struct job job = {.log = orl_log_stderr(ORL_LOG_WARNING), .synth = {ORL_SYNTH_DEFAULTS},
                      .samples = 1, .divide = 1};
    enum orl_result result = argc >= 3 ? ORL_OK : ORL_ERR_ARGUMENT;
    job.render = orl_method_find(&job.log, "oriel")->params;
    for (int i = 3; result == ORL_OK && i < argc; i++) {
        if (strcmp(argv[i], "--bound") == 0)
            job.bound = true;
        else if (i + 1 == argc)
            result = ORL_ERR_ARGUMENT;
        else if (strcmp(argv[i], "--images") == 0)
            job.images = argv[++i];
        else if (strcmp(argv[i], "--samples") == 0)
            job.samples = atoi(argv[++i]);
        else if (strcmp(argv[i], "--divide") == 0)
            job.divide = atoi(argv[++i]);
        else if (strcmp(argv[i], "--set") == 0)
            result = orl_render_params_set(&job.log, &job.render, argv[++i]);
        else
            result = ORL_ERR_ARGUMENT;
    }
    if (result != ORL_OK || job.divide < 1) {
        fprintf(stderr, "usage: radiance_error SCENE TRUTH [--bound] [--divide N] [--samples N] "
                        "[--images DIR] [--set KEY=VALUE]...\n");
        return 2;
    }
    job.truth_dir = argv[2];
    result = orl_scene_open(&job.log, argv[1], &job.scene);
    if (result == ORL_OK)
        result = orl_gpu_create(&job.log, NULL, &job.gpu);
    if (result == ORL_OK)
        result = run(&job);
    orl_gpu_destroy(&job.gpu);
    orl_scene_destroy(&job.scene);
    return result == ORL_OK ? 0 : 1;
}
