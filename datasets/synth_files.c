// Writes a synthetic set as files: the photographs and their ground truth.
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "core/file.h"
#include "core/json.h"
#include "core/memory.h"
#include "core/new_dir.h"
#include "datasets/synth.h"
#include "io/exr.h"
#include "io/picture.h"
#include "scene/colmap.h"

enum { JPEG_QUALITY = 97 };

// At 0 EV the camera is set to 1/250 s, f/8, ISO 100; an exposure of n EV takes 2^n as long.
static const double BASE_EXPOSURE_S = 1.0 / 250, APERTURE = 8, ISO = 100;

struct job {
    const struct orl_log *log;
    const struct orl_synth_params *params;
    const struct orl_view *views; // params->count
    const char *photos, *truth;   // folders that are being filled
};

// --- photographs ---

static enum orl_result write_photo(const struct job *job, int index,
                                   const struct orl_image *radiance)
{
    const struct orl_synth_sensor sensor = orl_synth_sensor(job->params, index);
    double ev = sensor.exposure_ev;
    struct orl_image photo = {0};
    struct orl_exif exif = {.make = "Oriel", .model = "synthetic pinhole",
                            .exposure_s = BASE_EXPOSURE_S * exp2(ev), .aperture = APERTURE,
                            .iso = ISO, .bias_ev = ev, .focal_mm = ORL_SYNTH_FOCAL_35MM,
                            .focal_35mm = ORL_SYNTH_FOCAL_35MM, .orientation = 1};
    enum orl_result result = orl_synth_expose(job->log, radiance, &sensor, &photo);
    ORL_THEN(result, orl_jpeg_write(job->log, ORL_PATH(job->photos, "%04d.jpg", index + 1), &photo, JPEG_QUALITY,
                                    &exif));
    orl_image_finish(&photo);
    return result;
}

// --- ground truth of one view ---

static enum orl_result write_layers(const struct job *job, int index, const char *folder,
                                    const struct orl_image *image, const char *const *names,
                                    bool half)
{
    struct orl_exr_params exr = {.width = image->width, .height = image->height,
                                 .attributes = {
                                     .view = &job->views[index],
                                     .srgb_primaries = strcmp(folder, "radiance") == 0}};
    for (int c = 0; c < image->channels; c++)
        ORL_REQUIRE(job->log, orl_exr_add_channel(&exr, names[c], half, image, c));
    return orl_exr_write(job->log, ORL_PATH(job->truth, "%s/%04d.exr", folder, index + 1), &exr);
}

static enum orl_result write_map(const struct job *job, int index, const char *folder,
                                 const struct orl_image *image)
{
    return orl_colmap_map_write(job->log, ORL_PATH(job->truth, "%s/%04d.jpg.geometric.bin", folder, index + 1), image);
}

static enum orl_result write_truth(const struct job *job, int index,
                                   const struct orl_synth_frame *frame)
{
    static const char *const colour[] = {"R", "G", "B"};
    static const char *const depth[] = {"depth.Z"};
    static const char *const normal[] = {"normal.X", "normal.Y", "normal.Z"};
    ORL_TRY(write_layers(job, index, "radiance", &frame->radiance, colour, true));
    ORL_TRY(write_layers(job, index, "depth", &frame->depth, depth, false));
    ORL_TRY(write_layers(job, index, "normal", &frame->normal, normal, true));
    ORL_TRY(write_map(job, index, "stereo/depth_maps", &frame->depth));
    ORL_TRY(write_map(job, index, "stereo/normal_maps", &frame->normal));
    if (frame->textured.data)
        ORL_TRY(write_map(job, index, "stereo/texture_maps", &frame->textured));
    if (frame->vehicle.data)
        ORL_TRY(orl_png_write(job->log, ORL_PATH(job->truth, "vehicle/%04d.png", index + 1), &frame->vehicle));
    return ORL_OK;
}

// --- cameras ---

static enum orl_result write_colmap_cameras(const struct job *job)
{
    const struct orl_camera *c = &job->views[0].camera;
    struct orl_atomic_file file;
    ORL_TRY(orl_atomic_open(job->log, ORL_PATH(job->truth, "sparse/cameras.txt"), &file));
    fprintf(file.stream, "1 PINHOLE %d %d %.17g %.17g %.17g %.17g\n", c->width, c->height, c->fx, c->fy, c->cx, c->cy);
    return orl_atomic_commit(job->log, &file);
}

static enum orl_result write_colmap_images(const struct job *job)
{
    struct orl_atomic_file file;
    ORL_TRY(orl_atomic_open(job->log, ORL_PATH(job->truth, "sparse/images.txt"), &file));
    for (int i = 0; i < job->params->count; i++) {
        double q[4];
        const double *t = job->views[i].cam_from_world.t;
        orl_pose_to_quat(&job->views[i].cam_from_world, q);
        // The second line of an image lists its sparse points. There are none.
        fprintf(file.stream, "%d %.17g %.17g %.17g %.17g %.17g %.17g %.17g 1 %04d.jpg\n\n",
                i + 1, q[0], q[1], q[2], q[3], t[0], t[1], t[2], i + 1);
    }
    ORL_TRY(orl_atomic_commit(job->log, &file));
    return orl_file_write(job->log, ORL_PATH(job->truth, "sparse/points3D.txt"), "", 0);
}

// Takes ownership of `root`.
static enum orl_result write_json(const struct job *job, const char *name, json_t *root)
{
    enum orl_result result = orl_json_write_digits(job->log, ORL_PATH(job->truth, "%s", name), root,
                                                   ORL_JSON_ALL_DIGITS);
    json_decref(root);
    return result;
}

// The format of Inria's 3D Gaussian splatting: rotation is world_from_cam, row by row.
static enum orl_result write_inria_cameras(const struct job *job)
{
    json_t *list = json_array();
    for (int i = 0; i < job->params->count; i++) {
        const struct orl_view *view = &job->views[i];
        const double (*r)[3] = view->cam_from_world.r;
        double at[3];
        orl_pose_centre(&view->cam_from_world, at);
        json_array_append_new(
            list, json_pack("{s:i, s:o, s:i, s:i, s:[fff], s:[[fff],[fff],[fff]], s:f, s:f}", "id", i, "img_name",
                            json_sprintf("%04d", i + 1), "width", view->camera.width, "height", view->camera.height,
                            "position", at[0], at[1], at[2], "rotation", r[0][0], r[1][0], r[2][0],
                            r[0][1], r[1][1], r[2][1], r[0][2], r[1][2], r[2][2], "fy",
                            view->camera.fy, "fx", view->camera.fx));
    }
    return write_json(job, "cameras.json", list);
}

static enum orl_result write_summary(const struct job *job)
{
    const struct orl_synth_params *p = job->params;
    json_t *photos = json_array();
    for (int i = 0; i < p->count; i++) {
        const struct orl_synth_sensor sensor = orl_synth_sensor(p, i);
        json_array_append_new(
            photos, json_pack("{s:o, s:f, s:f, s:[f,f,f]}", "photo", json_sprintf("%04d.jpg", i + 1),
                              "exposure_ev", sensor.exposure_ev, "exposure_s",
                              BASE_EXPOSURE_S * exp2(sensor.exposure_ev), "drift_ev",
                              sensor.drift_ev[0], sensor.drift_ev[1], sensor.drift_ev[2]));
    }
    json_t *curve = json_array();
    for (int v = 0; v < 256; v++)
        json_array_append_new(curve, json_real(orl_synth_decode(p->response, v / 255.0)));
    return write_json(job, "synth.json",
                      json_pack("{s:s, s:[ii], s:i, s:I, s:f, s:f, s:f, s:f, s:f, s:f, s:f, s:b, "
                                "s:s, s:o, s:s, s:o}",
                                "name", p->name, "size", p->width, p->height, "count", p->count,
                                "seed", (json_int_t)p->seed, "contrast", p->contrast_ev, "noise",
                                p->noise, "vignette", p->vignette, "drift", p->drift_ev, "gloss",
                                p->gloss, "bars", p->bars_m, "plain", p->plain, "vehicle", p->vehicle, "response",
                                orl_synth_response_name(p->response), "linear", curve,
                                "oriel", ORL_VERSION, "photographs", photos));
}

static enum orl_result write_cameras(const struct job *job)
{
    ORL_TRY(write_colmap_cameras(job));
    ORL_TRY(write_colmap_images(job));
    ORL_TRY(write_inria_cameras(job));
    return write_summary(job);
}

// --- folders ---

static enum orl_result make_folders(const struct job *job)
{
    const char *const folders[] = {"sparse", "depth", "normal", "radiance", "stereo/depth_maps",
                                   "stereo/normal_maps",
                                   job->params->plain > 0 ? "stereo/texture_maps" : NULL,
                                   job->params->vehicle ? "vehicle" : NULL};
    for (size_t i = 0; i < ORL_COUNT(folders); i++)
        if (folders[i])
            ORL_TRY(orl_dir_make(job->log, ORL_PATH(job->truth, "%s", folders[i])));
    return ORL_OK;
}

static enum orl_result draw_all(struct orl_gpu *gpu, const struct orl_progress *progress,
                                const struct job *job)
{
    struct orl_synth *synth;
    orl_progress_report(progress, "synth", 0, job->params->count, "compiling shaders");
    enum orl_result result = orl_synth_create(gpu, job->params, &synth);
    for (int i = 0; result == ORL_OK && i < job->params->count; i++) {
        struct orl_synth_frame frame;
        result = orl_synth_draw(synth, progress, &job->views[i], &frame);
        ORL_THEN(result, write_truth(job, i, &frame));
        ORL_THEN(result, write_photo(job, i, &frame.radiance));
        orl_synth_frame_finish(&frame);
        orl_progress_report(progress, "synth", i + 1, job->params->count, NULL);
    }
    orl_synth_destroy(&synth);
    return result;
}

enum orl_result orl_synth_run(struct orl_gpu *gpu, const struct orl_progress *progress,
                              const struct orl_synth_params *params, const char *photos,
                              const char *truth)
{
    struct job job = {.log = orl_gpu_log(gpu), .params = params};
    struct orl_new_dir photos_dir = {.fd = -1}, truth_dir = {.fd = -1};
    ORL_TRY(orl_synth_check(job.log, params));
    struct orl_view *views = orl_array(job.log, (size_t)params->count, sizeof *views);
    ORL_TRY_MEMORY(views);
    enum orl_result result = orl_new_dir_begin(job.log, photos, false, &photos_dir);
    ORL_THEN(result, orl_new_dir_begin(job.log, truth, false, &truth_dir));
    job.photos = photos_dir.path;
    job.truth = truth_dir.path;
    if (!params->views)
        orl_synth_views(params, views);
    job.views = params->views ? params->views : views;
    ORL_THEN(result, make_folders(&job));
    ORL_THEN(result, write_cameras(&job));
    ORL_THEN(result, draw_all(gpu, progress, &job));
    ORL_THEN(result, orl_new_dir_finish(job.log, &truth_dir));
    ORL_THEN(result, orl_new_dir_finish(job.log, &photos_dir));
    orl_new_dir_abort(job.log, &photos_dir);
    orl_new_dir_abort(job.log, &truth_dir);
    free(views);
    return result;
}
