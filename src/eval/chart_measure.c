// Measures one row: frame times, memory, accuracy, flicker along a walk.
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#ifdef __GLIBC__
#include <malloc.h>
#endif

#include "bridge/bridge.h"
#include "core/json.h"
#include "core/memory.h"
#include "core/process.h"
#include "eval/chart_internal.h"
#include "eval/flip.h"
#include "eval/internal.h"
#include "eval/stability.h"
#include "eval/timing.h"
#include "io/picture.h"

// Longer side of the page's pictures in pixels, and their JPEG quality.
enum { PAGE_SIDE = 480, PAGE_QUALITY = 82 };
enum { FRAMES_MAX = 200, WARM_UP = 1, WALK_FRAMES = 12, WALK_DIVIDE = 2, QUICK_FRAMES = 6,
       QUICK_DIVIDE = 4 };

// --- pictures for the page ---

static enum orl_result write_jpeg(const struct chart_scene *scene, const char *path,
                                  const struct orl_image *image)
{
    const struct orl_log *log = orl_gpu_log(scene->gpu);
    int longer = image->width > image->height ? image->width : image->height;
    struct orl_image small = {0};
    char *file = orl_path_join(log, scene->params->out, path);
    enum orl_result result = file ? ORL_OK : ORL_ERR_MEMORY;
    if (result == ORL_OK && longer > PAGE_SIDE) {
        result = orl_bridge_resize(log, image, (image->width * PAGE_SIDE + longer / 2) / longer,
                                   (image->height * PAGE_SIDE + longer / 2) / longer, &small);
        image = &small;
    }
    if (result == ORL_OK)
        result = orl_jpeg_write(log, file, image, PAGE_QUALITY, NULL);
    orl_image_finish(&small);
    free(file);
    return result;
}

// The path "pictures/SCENE/[ID/]STEM.END.jpg"; makes its folder.
static char *picture_name(const struct chart_scene *scene, const char *id, size_t view,
                          const char *end)
{
    const struct orl_log *log = orl_gpu_log(scene->gpu);
    char *stem = orl_eval_file_stem(log, scene->scene, scene->views[view].photo);
    char *dir = orl_format(log, "%s/pictures/%s/%s", scene->params->out, scene->name, id);
    char *name = NULL;
    if (stem && dir && orl_dir_make(log, dir) == ORL_OK)
        name = orl_format(log, "pictures/%s/%s%s%s.%s.jpg", scene->name, id, id[0] ? "/" : "",
                          stem, end);
    free(stem);
    free(dir);
    return name;
}

static enum orl_result write_picture(const struct chart_scene *scene, const char *id, size_t view,
                                     const char *end, const struct orl_image *image,
                                     const char *key, json_t *object)
{
    char *name = picture_name(scene, id, view, end);
    enum orl_result result = name ? write_jpeg(scene, name, image) : ORL_ERR_MEMORY;
    if (result == ORL_OK)
        json_object_set_new(object, key, orl_json_string(name));
    free(name);
    return result;
}

enum orl_result orl_chart_write_photographs(struct chart_scene *scene)
{
    json_t *list = json_array();
    enum orl_result result = ORL_OK;
    json_object_set_new(scene->json, "views", list);
    for (size_t i = 0; result == ORL_OK && i < scene->view_count; i++) {
        const struct orl_heldout *view = &scene->views[i];
        json_t *object = json_pack("{s:s, s:[i,i]}", "photo",
                                   scene->scene->photos[view->photo].name, "size",
                                   view->picture.width, view->picture.height);
        json_array_append_new(list, object);
        result = write_picture(scene, "", i, "photo", &view->picture, "picture", object);
    }
    return result;
}

// --- accuracy ---

const char *const orl_chart_figures[CHART_FIGURES] = {
    "psnr_db", "psnr_cc_db", "psnr_covered_db", "ssim", "flip", "crumbs", "coverage",
    "completeness"};

static enum orl_result compare_view(const struct chart_scene *scene, const char *id, size_t view,
                                    const struct orl_image *rendered,
                                    const struct orl_image *coverage,
                                    double figures[CHART_FIGURES], json_t *views)
{
    const struct orl_log *log = orl_gpu_log(scene->gpu);
    const struct orl_heldout *heldout = &scene->views[view];
    struct orl_image map = {0}, painted = {0};
    struct orl_metrics m;
    double flip = 0;
    json_t *object = json_pack("{s:s}", "photo", scene->scene->photos[heldout->photo].name);
    json_array_append_new(views, object);
    enum orl_result result = orl_metrics_compare(log, rendered, &heldout->picture, coverage, &m);
    if (result == ORL_OK)
        result = orl_flip_compare(log, rendered, &heldout->picture, &map, &flip);
    if (result == ORL_OK)
        result = orl_flip_paint(log, &map, &painted);
    if (result == ORL_OK)
        result = write_picture(scene, id, view, "rendered", rendered, "picture", object);
    if (result == ORL_OK)
        result = write_picture(scene, id, view, "flip", &painted, "error_map", object);
    if (result == ORL_OK) {
        const double values[CHART_FIGURES] = {m.psnr_db, m.psnr_cc_db, m.psnr_covered_db, m.ssim,
                                              flip, m.crumbs, m.coverage, m.completeness};
        memcpy(figures, values, sizeof values);
        for (size_t k = 0; k < CHART_FIGURES; k++)
            json_object_set_new(object, orl_chart_figures[k], json_real(values[k]));
    }
    orl_image_finish(&map);
    orl_image_finish(&painted);
    return result;
}

enum orl_result orl_chart_compare(const struct chart_scene *scene, const char *id,
                                  const struct chart_pictures *pictures, json_t *row)
{
    double mean[CHART_FIGURES] = {0}, square[CHART_FIGURES] = {0};
    double n = (double)scene->view_count;
    json_t *views = json_array(), *means = json_object(), *spread = json_object();
    enum orl_result result = ORL_OK;
    for (size_t i = 0; result == ORL_OK && i < scene->view_count; i++) {
        struct orl_image rendered = {0}, coverage = {0};
        double figures[CHART_FIGURES];
        if (orl_progress_cancelled(scene->params->progress)) {
            result = ORL_ERR_CANCELLED;
            break;
        }
        result = pictures->picture(pictures->priv, i, &rendered, &coverage);
        if (result == ORL_OK)
            result = compare_view(scene, id, i, &rendered, &coverage, figures, views);
        for (size_t k = 0; result == ORL_OK && k < CHART_FIGURES; k++) {
            mean[k] += figures[k] / n;
            square[k] += figures[k] * figures[k] / n;
        }
        orl_image_finish(&rendered);
        orl_image_finish(&coverage);
    }
    for (size_t k = 0; k < CHART_FIGURES; k++) {
        json_object_set_new(means, orl_chart_figures[k], json_real(mean[k]));
        json_object_set_new(spread, orl_chart_figures[k],
                            json_real(sqrt(fmax(square[k] - mean[k] * mean[k], 0))));
    }
    json_object_set_new(row, "mean", means);
    json_object_set_new(row, "sd", spread);
    json_object_set_new(row, "views", views);
    return result;
}

// --- frames ---

struct job {
    const struct chart_scene *scene;
    const struct chart_config *config;
    struct orl_renderer *renderer;
};

// The photograph's view, smaller where the setting says so.
static struct orl_view view_of(const struct job *job, size_t number)
{
    struct orl_view view = job->scene->views[number % job->scene->view_count].view;
    int n = job->config->size_divide, width = view.camera.width / n;
    int height = view.camera.height / n;
    if (n > 1)
        view.camera = orl_camera_resized(&view.camera, width ? width : 1, height ? height : 1);
    return view;
}

static enum orl_result draw_frame(void *priv, size_t number)
{
    const struct job *job = priv;
    const struct orl_view view = view_of(job, number);
    enum orl_result result = orl_timing_show_time_step(job->scene->gpu, job->scene->scene, job->renderer, number);
    return result != ORL_OK ? result
                            : orl_renderer_draw(job->renderer, &view, &job->config->render, NULL, NULL);
}

static enum orl_result enlarge(const struct orl_log *log, const struct orl_camera *camera,
                               struct orl_image *image)
{
    struct orl_image large = {0};
    if (image->width == camera->width && image->height == camera->height)
        return ORL_OK;
    enum orl_result result = orl_bridge_resize(log, image, camera->width, camera->height, &large);
    if (result != ORL_OK)
        return result;
    orl_image_finish(image);
    *image = large;
    return ORL_OK;
}

static enum orl_result draw_picture(void *priv, size_t number, struct orl_image *rendered,
                                    struct orl_image *coverage)
{
    const struct job *job = priv;
    const struct orl_log *log = orl_gpu_log(job->scene->gpu);
    const struct orl_heldout *heldout = &job->scene->views[number];
    const struct orl_view view = view_of(job, number);
    struct orl_render_params render = job->config->render;
    render.leave_out |= ORL_LAYER_NORMAL | ORL_LAYER_DEPTH;
    struct orl_frame frame;
    enum orl_result result = orl_renderer_draw(job->renderer, &view, &render, NULL, &frame);
    if (result != ORL_OK)
        return result;
    result = orl_heldout_expose(log, job->scene->scene, heldout->photo, &render, &frame.color,
                                rendered);
    if (result == ORL_OK)
        result = enlarge(log, &heldout->view.camera, rendered);
    if (result == ORL_OK)
        result = enlarge(log, &heldout->view.camera, &frame.coverage);
    if (result == ORL_OK) {
        *coverage = frame.coverage;
        memset(&frame.coverage, 0, sizeof frame.coverage);
    }
    orl_frame_finish(&frame);
    return result;
}

static enum orl_result time_frames(struct job *job, json_t *row)
{
    const struct chart_scene *scene = job->scene;
    const struct orl_timing_params params = {
        .draw = draw_frame, .priv = job, .views = scene->view_count, .warm_up = WARM_UP,
        .seconds = scene->params->seconds, .frames_max = FRAMES_MAX,
        .progress = scene->params->progress};
    struct orl_timing timing;
    enum orl_result result = orl_timing_take(scene->gpu, &params, &timing);
    if (result == ORL_OK && scene->scene->frame_count) // the held-out photographs are of the scene itself
        result = orl_scene_set_frame(orl_gpu_log(scene->gpu), scene->scene, -1);
    if (result != ORL_OK)
        return result;
    const struct orl_view view = view_of(job, 0);
    json_object_set_new(row, "frame_ms", json_real(timing.median_ms));
    json_object_set_new(row, "p95_ms", json_real(timing.p95_ms));
    json_object_set_new(row, "cpu_ms", json_real(timing.cpu_ms));
    json_object_set_new(row, "frames", json_integer((json_int_t)timing.frames));
    json_object_set_new(row, "size", json_pack("[i,i]", view.camera.width, view.camera.height));
    return ORL_OK;
}

// --- memory ---

// Resets the kernel's record of this process's peak memory, so that it excludes earlier rows.
// Returns false where the kernel cannot do so.
static bool reset_host_peak(void)
{
#ifdef __GLIBC__
    malloc_trim(0);
#endif
    FILE *file = fopen("/proc/self/clear_refs", "w");
    bool ok = file && fputs("5", file) >= 0;
    return file && fclose(file) == 0 && ok;
}

static json_t *host_peak(bool was_reset)
{
    long long kib = -1;
    char line[128];
    FILE *file = was_reset ? fopen("/proc/self/status", "r") : NULL;
    while (file && kib < 0 && fgets(line, sizeof line, file))
        if (sscanf(line, "VmHWM: %lld", &kib) != 1)
            kib = -1;
    if (file)
        fclose(file);
    return kib < 0 ? json_null() : json_integer(kib << 10);
}

static void note_memory(const struct chart_scene *scene, bool was_reset, json_t *row)
{
    json_t *owners = json_object();
    for (int owner = 0; owner < ORL_OWNER_COUNT; owner++)
        json_object_set_new(owners, orl_owner_names[owner], json_integer((json_int_t)
            orl_gpu_owner_bytes(scene->gpu, (enum orl_owner)owner)));
    json_object_set_new(row, "device_bytes", json_integer((json_int_t)orl_gpu_bytes(scene->gpu)));
    json_object_set_new(row, "device_bytes_by_owner", owners);
    json_object_set_new(row, "host_peak_bytes", host_peak(was_reset));
}

// --- flicker ---

static enum orl_result walk(struct job *job, json_t *row)
{
    const struct chart_scene *scene = job->scene;
    struct orl_path path = {0};
    struct orl_stability stability;
    bool quick = scene->params->quick;
    enum orl_result result =
        orl_stability_walk(orl_gpu_log(scene->gpu), scene->scene,
                           quick ? QUICK_FRAMES : WALK_FRAMES,
                           (quick ? QUICK_DIVIDE : WALK_DIVIDE) * job->config->size_divide, &path);
    if (result == ORL_OK) {
        const struct orl_stability_params params = {
            .method = job->config->method->name, .render = &job->config->render,
            .views = path.views, .view_count = path.count};
        result = orl_stability_run(scene->gpu, job->renderer, &params, &stability);
    }
    if (result == ORL_OK) {
        json_object_set_new(row, "flicker", json_real(stability.all.block_mean));
        orl_stability_finish(&stability);
    }
    orl_path_finish(&path);
    return result;
}

enum orl_result orl_chart_measure(const struct chart_scene *scene,
                                  const struct chart_config *config, json_t **out)
{
    struct job job = {.scene = scene, .config = config};
    const struct orl_renderer_params params = {
        .max_vram_bytes = scene->params->max_vram_bytes, .textures = config->textures,
        .photo_divide = config->photo_divide};
    const struct chart_pictures pictures = {draw_picture, &job};
    char id[ORL_ROW_ID_MAX];
    json_t *row = json_pack("{s:s, s:s, s:s, s:b, s:o}", "scene", scene->name, "method",
                            config->method->name, "setting", config->setting, "peer", false,
                            "provenance", orl_chart_provenance(scene));
    orl_row_id(config->method->name, config->setting, id);
    bool was_reset = reset_host_peak();
    double start = orl_time_s();
    enum orl_result result = row ? orl_renderer_create(scene->gpu, scene->scene, &params,
                                                       &job.renderer) : ORL_ERR_MEMORY;
    if (result == ORL_OK)
        result = draw_frame(&job, 0); // includes all work that happens once
    if (result == ORL_OK)
        json_object_set_new(row, "open_s", json_real(orl_time_s() - start));
    if (result == ORL_OK)
        result = time_frames(&job, row);
    if (result == ORL_OK)
        note_memory(scene, was_reset, row);
    if (result == ORL_OK)
        result = orl_chart_compare(scene, id, &pictures, row);
    if (result == ORL_OK)
        result = walk(&job, row);
    orl_renderer_destroy(&job.renderer);
    if (result != ORL_OK) {
        json_decref(row);
        row = NULL;
    }
    *out = row;
    return result;
}
