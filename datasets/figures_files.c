// The figures as files.
#include <stdlib.h>
#include <time.h>

#include "core/file.h"
#include "core/json.h"
#include "core/memory.h"
#include "core/new_dir.h"
#include "core/process.h"
#include "datasets/figures.h"
#include "io/exr.h"
#include "io/picture.h"
#include "scene/manifest.h"

// Of the grid that meshes are found on, metres.
static const double MESH_SPACING = 0.015;

struct job {
    const struct orl_log *log;
    const struct orl_progress *progress;
    const struct orl_figures_params *params;
    const struct orl_view *views; // params->cameras
    const char *dir;              // being filled
};

// "DIR/<folder>/camNN<ending>", or of a sequence "DIR/<folder>/camNN/NNNNN<ending>".
#define VIEW_PATH(...) view_path((char[ORL_PATH_SIZE]){""}, __VA_ARGS__)
static const char *view_path(char path[ORL_PATH_SIZE], const struct job *job, const char *folder, int camera, int frame,
                             const char *ending)
{
    return job->params->frames == 1 || frame < 0
               ? orl_path_print(path, job->dir, "%s/cam%02d%s", folder, camera, ending)
               : orl_path_print(path, job->dir, "%s/cam%02d/%05d%s", folder, camera, frame, ending);
}

static enum orl_result write_png(const struct job *job, const char *folder, int camera, int frame,
                                 const struct orl_image *image)
{
    return orl_png_write(job->log, VIEW_PATH(job, folder, camera, frame, ".png"), image);
}

static enum orl_result write_depth(const struct job *job, int camera, int frame,
                                   const struct orl_image *depth)
{
    struct orl_exr_params exr = {
        .width = depth->width, .height = depth->height, .channel_count = 1,
        .channels = {{.name = "depth.Z", .data = depth->f32, .stride = 1}},
        .attributes = {.view = &job->views[camera]}};
    return orl_exr_write(job->log, VIEW_PATH(job, "depth", camera, frame, ".exr"), &exr);
}

static enum orl_result write_cameras(const struct job *job)
{
    json_t *list = json_array();
    for (int i = 0; i < job->params->cameras; i++) {
        const struct orl_camera *c = &job->views[i].camera;
        const double *t = job->views[i].cam_from_world.t, (*r)[3] = job->views[i].cam_from_world.r;
        json_array_append_new(
            list, json_pack("{s:o, s:i, s:i, s:[[fff],[fff],[fff]], s:[[fff],[fff],[fff]], s:[fff], s:[]}", "name",
                            json_sprintf("cam%02d", i), "width", c->width, "height", c->height,
                            "K", c->fx, 0.0, c->cx, 0.0, c->fy, c->cy, 0.0, 0.0, 1.0,
                            "R", r[0][0], r[0][1], r[0][2], r[1][0], r[1][1], r[1][2], r[2][0], r[2][1], r[2][2],
                            "t", t[0], t[1], t[2], "dist"));
    }
    json_t *root = json_pack("{s:f, s:o, s:o}", "pixel_centre", 0.5, "room",
                             orl_manifest_room(&orl_figures_room), "cameras", list);
    enum orl_result result = orl_json_write_digits(job->log, ORL_PATH(job->dir, "cameras.json"), root,
                                                   ORL_JSON_ALL_DIGITS);
    json_decref(root);
    return result;
}

static enum orl_result make_folders(const struct job *job)
{
    static const char *const folders[] = {"images", "masks", "depth", "background", "mesh"};
    bool sequence = job->params->frames > 1;
    for (size_t i = 0; i < ORL_COUNT(folders); i++) {
        // Backgrounds are one a camera, meshes one a time step.
        bool per_camera = sequence && i < 3;
        for (int c = 0; c < (per_camera ? job->params->cameras : 1); c++)
            ORL_TRY(orl_dir_make(job->log, per_camera ? VIEW_PATH(job, folders[i], c, -1, "")
                                                      : ORL_PATH(job->dir, "%s", folders[i])));
    }
    return ORL_OK;
}

static enum orl_result write_backgrounds(const struct job *job)
{
    enum orl_result result = ORL_OK;
    for (int c = 0; result == ORL_OK && c < job->params->cameras; c++) {
        struct orl_figures_picture picture;
        result = orl_figures_draw(job->log, NULL, &job->views[c], &picture);
        ORL_THEN(result, write_png(job, "background", c, -1, &picture.photo));
        orl_figures_picture_finish(&picture);
    }
    return result;
}

static enum orl_result write_mesh(const struct job *job, const struct orl_figure *figure,
                                  int frame)
{
    struct orl_mesh mesh;
    ORL_TRY(orl_figure_mesh(job->log, figure, MESH_SPACING, &mesh));
    enum orl_result result = orl_mesh_write(job->log, ORL_PATH(job->dir, "mesh/%05d.ply", frame), &mesh);
    orl_mesh_finish(&mesh);
    return result;
}

static enum orl_result write_time_step(const struct job *job, int frame)
{
    struct orl_figure figure;
    orl_figure_pose(frame, &figure);
    enum orl_result result = write_mesh(job, &figure, frame);
    for (int c = 0; result == ORL_OK && c < job->params->cameras; c++) {
        struct orl_figures_picture picture;
        if (orl_progress_cancelled(job->progress))
            return ORL_ERR_CANCELLED;
        result = orl_figures_draw(job->log, &figure, &job->views[c], &picture);
        ORL_THEN(result, write_png(job, "images", c, frame, &picture.photo));
        ORL_THEN(result, write_png(job, "masks", c, frame, &picture.mask));
        ORL_THEN(result, write_depth(job, c, frame, &picture.depth));
        orl_figures_picture_finish(&picture);
    }
    return result;
}

static enum orl_result write_all(const struct job *job)
{
    ORL_TRY(make_folders(job));
    ORL_TRY(write_cameras(job));
    ORL_TRY(write_backgrounds(job));
    for (int f = 0; f < job->params->frames; f++) {
        orl_progress_report(job->progress, "figures", f, job->params->frames, NULL);
        ORL_TRY(write_time_step(job, f));
    }
    orl_progress_report(job->progress, "figures", 1, 1, NULL);
    return ORL_OK;
}

enum orl_result orl_figures_run(const struct orl_log *log, const struct orl_progress *progress,
                                const struct orl_figures_params *params, const char *out)
{
    struct job job = {.log = log, .progress = progress, .params = params};
    struct orl_new_dir dir = {.fd = -1};
    ORL_TRY(orl_figures_check(log, params));
    struct orl_view *views = orl_array(log, (size_t)params->cameras, sizeof *views);
    ORL_TRY_MEMORY(views);
    orl_figures_views(params, views);
    job.views = views;
    enum orl_result result = orl_new_dir_begin(log, out, false, &dir);
    job.dir = dir.path;
    ORL_THEN(result, write_all(&job));
    ORL_THEN(result, orl_new_dir_finish(log, &dir));
    orl_new_dir_abort(log, &dir);
    free(views);
    return result;
}

static void wait_until(double time_s)
{
    double left = time_s - orl_time_s();
    if (left > 0)
        nanosleep(&(struct timespec){(time_t)left, (long)(1e9 * (left - (double)(time_t)left))}, NULL);
}

enum orl_result orl_figures_play(const struct orl_log *log, const struct orl_progress *progress,
                                 const struct orl_figures_params *params, const char *out,
                                 const char *dir)
{
    static const double rate = 25;
    const struct job from = {.log = log, .params = params, .dir = out};
    double start = orl_time_s();
    for (int f = 0; f < params->frames; f++) {
        wait_until(start + f / rate);
        orl_progress_report(progress, "live", f, params->frames, NULL);
        for (int c = 0; c < params->cameras; c++) {
            const char *pipe = ORL_PATH(dir, "cam%02d", c), *there = ORL_PATH(pipe, "%05d.png", f);
            ORL_TRY(orl_file_copy(log, VIEW_PATH(&from, "images", c, f, ".png"),
                                  orl_path_is_pipe(pipe) ? pipe : there));
        }
        if (orl_progress_cancelled(progress))
            return ORL_ERR_CANCELLED;
    }
    return ORL_OK;
}
