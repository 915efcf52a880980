#include "preprocess/cloud/backdrop.h"

#include <math.h>
#include <stdlib.h>

#include "bridge/bridge.h"
#include "core/memory.h"
#include "core/vec3.h"
#include "io/picture.h"
#include "scene/colmap.h"
#include "scene/manifest.h"

enum {
    SIDE = 256,        // longer side of the reduced photographs, pixels
    SHOTS_LEAST = 5,   // fewer photographs may agree by chance
    SHOTS_MAX = 24,
    POINT_REACH = 2,   // a point covers the pixels around it as far as this
    STEP = 2,          // every STEP-th row and column is compared
    SAMPLES_LEAST = 500, // of a photograph, on average, or else nothing is known
    BLUR_TAPS = 121,
};
static const double BLUR_SIGMA = 30;  // pixels; skies and vignetting vary more slowly than this
// Correlation of a backdrop that rests, and how much greater it must be than that of one that is far
// away. In handheld series it is at most 0.15, on a turntable 0.5.
static const double RESTS = 0.35, RESTS_BY = 0.2;

// A training photograph at reduced size.
struct shot {
    struct orl_view view;
    struct orl_image detail; // luma minus its local mean over open pixels, as a fraction of white
    bool *open;              // pixels without points
};

// --- what a photograph shows beside the points ---

static void cover(struct shot *shot, const struct orl_points *points)
{
    int width = shot->detail.width, height = shot->detail.height;
    for (size_t i = 0; i < points->count; i++) {
        const float *p = points->position[i];
        const double at[3] = {(double)p[0], (double)p[1], (double)p[2]};
        double pixel[2], depth;
        if (!orl_view_project(&shot->view, at, pixel, &depth) || !(pixel[0] >= 0) ||
            !(pixel[1] >= 0) || !(pixel[0] < width) || !(pixel[1] < height))
            continue;
        int left = (int)fmax(pixel[0] - POINT_REACH, 0);
        int right = (int)fmin(pixel[0] + POINT_REACH, width - 1);
        int top = (int)fmax(pixel[1] - POINT_REACH, 0);
        int bottom = (int)fmin(pixel[1] + POINT_REACH, height - 1);
        for (int y = top; y <= bottom; y++)
            for (int x = left; x <= right; x++)
                shot->open[y * width + x] = false;
    }
}

// Two channels: luma where the pixel is open, else 0; 1 where it is open.
static enum orl_result open_luma(const struct orl_log *log, const struct orl_image *small,
                                 const bool *open, struct orl_image *luma)
{
    enum orl_result result = orl_image_init(log, luma, small->width, small->height, 2,
                                            ORL_PIXEL_F32);
    for (int i = 0; result == ORL_OK && i < small->width * small->height; i++) {
        const uint8_t *rgb = &small->u8[3 * i];
        float value = (0.299f * rgb[0] + 0.587f * rgb[1] + 0.114f * rgb[2]) / 255;
        luma->f32[2 * i] = open[i] ? value : 0;
        luma->f32[2 * i + 1] = open[i];
    }
    return result;
}

static enum orl_result find_detail(const struct orl_log *log, const struct orl_image *small,
                                   const struct orl_points *points, struct shot *shot)
{
    struct orl_image luma = {0}, mean = {0};
    size_t count = (size_t)small->width * (size_t)small->height;
    enum orl_result result = orl_image_init(log, &shot->detail, small->width, small->height, 1,
                                            ORL_PIXEL_F32);
    shot->open = result == ORL_OK ? orl_array(log, count, sizeof *shot->open) : NULL;
    if (result == ORL_OK && !shot->open)
        result = ORL_ERR_MEMORY;
    if (result != ORL_OK)
        return result;
    for (size_t i = 0; i < count; i++)
        shot->open[i] = true;
    cover(shot, points);
    result = open_luma(log, small, shot->open, &luma);
    if (result == ORL_OK)
        result = orl_bridge_blur(log, &luma, BLUR_TAPS, BLUR_SIGMA, &mean);
    for (size_t i = 0; result == ORL_OK && i < count; i++)
        shot->detail.f32[i] = luma.f32[2 * i] - mean.f32[2 * i] / fmaxf(mean.f32[2 * i + 1], 1e-6f);
    orl_image_finish(&luma);
    orl_image_finish(&mean);
    return result;
}

static enum orl_result read_shot(const struct orl_log *log, const struct orl_scene *scene, size_t i,
                                 struct shot *shot)
{
    struct orl_image picture = {0}, small = {0};
    const struct orl_camera *c = &scene->photos[i].view.camera;
    double scale = fmin(1, (double)SIDE / (c->width > c->height ? c->width : c->height));
    int width = (int)fmax(1, round(c->width * scale));
    int height = (int)fmax(1, round(c->height * scale));
    shot->view = scene->photos[i].view;
    shot->view.camera = orl_camera_resized(c, width, height);
    char *path = orl_scene_photo_path(log, scene, i);
    enum orl_result result = path ? orl_picture_read(log, path, 3, &picture) : ORL_ERR_MEMORY;
    if (result == ORL_OK)
        result = orl_bridge_resize(log, &picture, width, height, &small);
    if (result == ORL_OK)
        result = find_detail(log, &small, &scene->points, shot);
    orl_image_finish(&picture);
    orl_image_finish(&small);
    free(path);
    return result;
}

// At most SHOTS_MAX of the training photographs, evenly chosen.
static enum orl_result read_shots(const struct orl_log *log, const struct orl_scene *scene,
                                  struct shot *shots, int *count)
{
    size_t train = 0, seen = 0;
    for (size_t i = 0; i < scene->photo_count; i++)
        train += !scene->photos[i].test;
    size_t step = (train + SHOTS_MAX - 1) / SHOTS_MAX;
    enum orl_result result = ORL_OK;
    for (size_t i = 0; train >= SHOTS_LEAST && result == ORL_OK && i < scene->photo_count; i++)
        if (!scene->photos[i].test && seen++ % step == 0)
            result = read_shot(log, scene, i, &shots[(*count)++]);
    return result;
}

// --- whether it rests ---

struct tally {
    double off, sum;
    long samples;
};

// Turns a direction of one camera frame into that of another.
static void turn(const struct orl_pose *from, const struct orl_pose *to, double ray[3])
{
    double world[3];
    for (int k = 0; k < 3; k++)
        world[k] = from->r[0][k] * ray[0] + from->r[1][k] * ray[1] + from->r[2][k] * ray[2];
    for (int k = 0; k < 3; k++)
        ray[k] = orl_dot3(to->r[k], world);
}

// Compares what `a` shows with what `b` shows at the same place of its camera frame, or with `far` in
// the same direction of the world.
static void compare(const struct shot *a, const struct shot *b, bool far, struct tally *tally)
{
    const struct orl_camera *from = &a->view.camera, *to = &b->view.camera;
    int width = a->detail.width, height = a->detail.height;
    for (int y = STEP / 2; y < height; y += STEP)
        for (int x = STEP / 2; x < width; x += STEP) {
            double ray[3] = {(x + 0.5 - from->cx) / from->fx, (y + 0.5 - from->cy) / from->fy, 1};
            if (far)
                turn(&a->view.cam_from_world, &b->view.cam_from_world, ray);
            if (!a->open[y * width + x] || !(ray[2] > 0))
                continue;
            double u = to->fx * ray[0] / ray[2] + to->cx, v = to->fy * ray[1] / ray[2] + to->cy;
            if (!(u >= 0 && v >= 0 && u < b->detail.width && v < b->detail.height))
                continue;
            int there = (int)v * b->detail.width + (int)u;
            if (!b->open[there])
                continue;
            double one = (double)a->detail.f32[y * width + x];
            double other = (double)b->detail.f32[there];
            tally->off += (one - other) * (one - other);
            tally->sum += one * one + other * other;
            tally->samples++;
        }
}

// Correlation of what photographs show beside the points; 0 if too little of it is in two of them.
static double correlation(const struct shot *shots, int count, bool far)
{
    struct tally tally = {0};
    for (int a = 0; a < count; a++)
        for (int b = 0; b < count; b++)
            if (a != b)
                compare(&shots[a], &shots[b], far, &tally);
    return tally.samples < (long)SAMPLES_LEAST * count || !(tally.sum > 0)
               ? 0
               : 1 - tally.off / tally.sum;
}

enum orl_result orl_backdrop_find(const struct orl_log *log, struct orl_scene *scene)
{
    struct shot *shots = orl_array(log, SHOTS_MAX, sizeof *shots);
    int count = 0;
    scene->backdrop_rests = false;
    if (!shots)
        return ORL_ERR_MEMORY;
    enum orl_result result = read_shots(log, scene, shots, &count);
    if (result == ORL_OK && count > 0) {
        double rests = correlation(shots, count, false), far = correlation(shots, count, true);
        scene->backdrop_rests = rests >= RESTS && rests >= far + RESTS_BY;
        orl_logf(log, ORL_LOG_INFO, "backdrop: %s; photographs correlate by %.2f at the same place "
                 "of the picture, by %.2f in the same direction",
                 scene->backdrop_rests ? "rests in the pictures" : "moves with the view", rests, far);
    }
    for (int i = 0; i < count; i++) {
        orl_image_finish(&shots[i].detail);
        free(shots[i].open);
    }
    free(shots);
    return result;
}

enum orl_result orl_stage_backdrop(struct orl_job *job, json_t *record)
{
    struct orl_scene *scene = NULL;
    enum orl_result result = orl_job_open_scene(job, &scene);
    if (result == ORL_OK)
        result = orl_backdrop_find(job->log, scene);
    if (result == ORL_OK &&
        json_object_set_new(record, "backdrop", orl_manifest_backdrop(scene->backdrop_rests)) != 0)
        result = orl_fail(job->log, ORL_ERR_MEMORY, "no memory for the backdrop");
    orl_scene_destroy(&scene);
    return result;
}
