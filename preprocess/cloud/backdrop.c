#include "preprocess/cloud/backdrop.h"

#include <math.h>
#include <stdlib.h>

#include "bridge/bridge.h"
#include "core/memory.h"
#include "core/vec3.h"
#include "preprocess/cloud/reduced.h"
#include "scene/manifest.h"

enum {
    SIDE = 256,        // longer side of the reduced photographs, pixels
    SHOTS_MIN = 5,   // fewer photographs may agree by chance
    PHOTOS_MAX = 24,
    STEP = 2,          // every STEP-th row and column is compared
    SAMPLES_MIN = 500, // of a photograph, on average, or else nothing is known
    BLUR_TAPS = 121,
};
static const double BLUR_SIGMA = 30;  // pixels; skies and vignetting vary more slowly than this
// Correlation of a backdrop that rests, and how much greater it must be than that of one that is far
// away. In handheld series it is at most 0.15, on a turntable 0.5.
static const double RESTS = 0.35, RESTS_BY = 0.2;

// A training photograph at reduced size.
struct photo {
    struct orl_reduced reduced;
    struct orl_image detail; // luma minus its local mean over open pixels, as a fraction of white
};

// --- what a photograph shows beside the points ---

// Two channels: luma where the pixel is open, else 0; 1 where it is open.
static enum orl_result open_luma(const struct orl_log *log, const struct orl_image *small,
                                 const bool *open, struct orl_image *luma)
{
    ORL_TRY(orl_image_init(log, luma, small->width, small->height, 2, ORL_PIXEL_F32));
    for (int i = 0; i < small->width * small->height; i++) {
        const uint8_t *rgb = &small->u8[3 * i];
        float value = (0.299f * rgb[0] + 0.587f * rgb[1] + 0.114f * rgb[2]) / 255;
        luma->f32[2 * i] = open[i] ? value : 0;
        luma->f32[2 * i + 1] = open[i];
    }
    return ORL_OK;
}

static enum orl_result read_photo(const struct orl_log *log, const struct orl_scene *scene,
                                  size_t i, struct photo *photo)
{
    struct orl_image luma = {0}, mean = {0}, *detail = &photo->detail;
    enum orl_result result = orl_reduced_read(log, scene, i, SIDE, &photo->reduced);
    const struct orl_image *small = &photo->reduced.picture;
    ORL_THEN(result, orl_image_init(log, detail, small->width, small->height, 1, ORL_PIXEL_F32));
    ORL_THEN(result, open_luma(log, small, photo->reduced.open, &luma));
    ORL_THEN(result, orl_bridge_blur(log, &luma, BLUR_TAPS, BLUR_SIGMA, &mean));
    for (int k = 0; result == ORL_OK && k < small->width * small->height; k++)
        detail->f32[k] = luma.f32[2 * k] - mean.f32[2 * k] / fmaxf(mean.f32[2 * k + 1], 1e-6f);
    orl_image_finish(&luma);
    orl_image_finish(&mean);
    return result;
}

// At most PHOTOS_MAX of the training photographs, evenly chosen.
static enum orl_result read_photos(const struct orl_log *log, const struct orl_scene *scene,
                                   struct photo *photos, int *count)
{
    size_t train = 0, seen = 0;
    for (size_t i = 0; i < scene->photo_count; i++)
        train += !scene->photos[i].test;
    size_t step = (train + PHOTOS_MAX - 1) / PHOTOS_MAX;
    for (size_t i = 0; train >= SHOTS_MIN && i < scene->photo_count; i++)
        if (!scene->photos[i].test && seen++ % step == 0)
            ORL_TRY(read_photo(log, scene, i, &photos[(*count)++]));
    return ORL_OK;
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
static void compare(const struct photo *a, const struct photo *b, bool far, struct tally *tally)
{
    const struct orl_camera *from = &a->reduced.view.camera, *to = &b->reduced.view.camera;
    int width = a->detail.width, height = a->detail.height;
    for (int y = STEP / 2; y < height; y += STEP)
        for (int x = STEP / 2; x < width; x += STEP) {
            double ray[3] = {(x + 0.5 - from->cx) / from->fx, (y + 0.5 - from->cy) / from->fy, 1};
            if (far)
                turn(&a->reduced.view.cam_from_world, &b->reduced.view.cam_from_world, ray);
            if (!a->reduced.open[y * width + x] || !(ray[2] > 0))
                continue;
            double u = to->fx * ray[0] / ray[2] + to->cx, v = to->fy * ray[1] / ray[2] + to->cy;
            if (!(u >= 0 && v >= 0 && u < b->detail.width && v < b->detail.height))
                continue;
            int there = (int)v * b->detail.width + (int)u;
            if (!b->reduced.open[there])
                continue;
            double one = (double)a->detail.f32[y * width + x];
            double other = (double)b->detail.f32[there];
            tally->off += (one - other) * (one - other);
            tally->sum += one * one + other * other;
            tally->samples++;
        }
}

// Correlation of what photographs show beside the points; 0 if too little of it is in two of them.
static double correlation(const struct photo *photos, int count, bool far)
{
    struct tally tally = {0};
    for (int a = 0; a < count; a++)
        for (int b = 0; b < count; b++)
            if (a != b)
                compare(&photos[a], &photos[b], far, &tally);
    return tally.samples < (long)SAMPLES_MIN * count || !(tally.sum > 0)
               ? 0
               : 1 - tally.off / tally.sum;
}

enum orl_result orl_backdrop_find(const struct orl_log *log, struct orl_scene *scene)
{
    struct photo *photos = orl_array(log, PHOTOS_MAX, sizeof *photos);
    int count = 0;
    scene->backdrop_rests = false;
    ORL_TRY_MEMORY(photos);
    enum orl_result result = read_photos(log, scene, photos, &count);
    if (result == ORL_OK && count > 0) {
        double rests = correlation(photos, count, false), far = correlation(photos, count, true);
        scene->backdrop_rests = rests >= RESTS && rests >= far + RESTS_BY;
        orl_logf(log, ORL_LOG_INFO, "backdrop: %s; photographs correlate by %.2f at the same place "
                 "of the picture, by %.2f in the same direction",
                 scene->backdrop_rests ? "rests in the pictures" : "moves with the view", rests, far);
    }
    for (int i = 0; i < count; i++) {
        orl_image_finish(&photos[i].detail);
        orl_reduced_finish(&photos[i].reduced);
    }
    free(photos);
    return result;
}

enum orl_result orl_stage_backdrop(struct orl_job *job, json_t *record)
{
    struct orl_scene *scene = NULL;
    enum orl_result result = orl_job_open_scene(job, &scene);
    ORL_THEN(result, orl_backdrop_find(job->log, scene));
    if (result == ORL_OK &&
        json_object_set_new(record, "backdrop", orl_manifest_backdrop(scene->backdrop_rests)) != 0)
        result = orl_fail(job->log, ORL_ERR_MEMORY, "no memory for the backdrop");
    orl_scene_destroy(&scene);
    return result;
}
