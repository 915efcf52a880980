#include "preprocess/cloud/ground.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "bridge/bridge.h"
#include "core/file.h"
#include "core/memory.h"
#include "core/vec3.h"
#include "io/picture.h"
#include "scene/colmap.h"
#include "scene/ground_plane.h"
#include "scene/manifest.h"

enum {
    SIDE = 256,         // longer side of the reduced photographs, pixels
    PHOTOS_MAX = 24,
    NEAR_MAX = 6,       // photographs that each one is compared with
    SPOTS = 12000,      // approximate number of pixels compared in a photograph
    SAMPLES_MIN = 1000,
    BLUR_TAPS = 31,
    STEPS = 5, ROUNDS_MAX = 4, // of the search: number of halvings, and moves of each length
};
static const double BLUR_SIGMA = 6.2;  // pixels; exposure and vignetting vary more slowly than this
static const double REACH = 15;        // in camera heights; farther ground covers only a few rows
                                       // of pixels
static const double QUIET = 0.005;     // contrast that carries no information, as a fraction of
                                       // white
static const double NEAR_PLANE = 0.03; // greatest difference of depths on the plane, as a fraction
// First steps of the search and its bounds: shifts as fractions of the height, tilts in radians.
static const double SHIFT = 0.15, TILT = 0.02, SHIFT_MAX = 0.5, TILT_MAX = 0.08;
// A move by one sigma costs COST of disagreement, so that the plane stays near the points.
static const double SHIFT_SIGMA = 0.2, TILT_SIGMA = 0.03, COST = 0.01;

// A training photograph at reduced size.
struct photo {
    struct orl_view view;
    int width, height;
    float *detail; // luma minus its local mean, as a fraction of white
    float *depth;  // by stereo, scene units; 0: none
    double eye[3];
    int near[NEAR_MAX], near_count;
};

// Height and tilt of a plane relative to the ground that was found first.
struct move {
    double log_height, tilt[2];
};

struct search {
    const struct orl_ground *found;
    struct photo photos[PHOTOS_MAX];
    int photo_count;
    double axes[2][3]; // the plane tilts about these
    double eye[3];     // mean camera centre of the photographs
};

static enum orl_result find_detail(const struct orl_log *log, const struct orl_image *small,
                                   struct photo *photo)
{
    struct orl_image luma = {0}, blurred = {0};
    size_t count = (size_t)photo->width * (size_t)photo->height;
    enum orl_result result =
        orl_image_init(log, &luma, photo->width, photo->height, 1, ORL_PIXEL_F32);
    for (size_t i = 0; result == ORL_OK && i < count; i++) {
        const uint8_t *rgb = &small->u8[3 * i];
        luma.f32[i] = (0.299f * rgb[0] + 0.587f * rgb[1] + 0.114f * rgb[2]) / 255;
    }
    if (result == ORL_OK)
        result = orl_bridge_blur(log, &luma, BLUR_TAPS, BLUR_SIGMA, &blurred);
    photo->detail = result == ORL_OK ? orl_array(log, count, sizeof *photo->detail) : NULL;
    if (result == ORL_OK && !photo->detail)
        result = ORL_ERR_MEMORY;
    for (size_t i = 0; result == ORL_OK && i < count; i++)
        photo->detail[i] = luma.f32[i] - blurred.f32[i];
    orl_image_finish(&luma);
    orl_image_finish(&blurred);
    return result;
}

static enum orl_result reduce_depth(const struct orl_log *log, const struct orl_image *depth,
                                    struct photo *photo)
{
    size_t pixels = (size_t)photo->width * (size_t)photo->height;
    photo->depth = orl_array(log, pixels, sizeof *photo->depth);
    if (!photo->depth)
        return ORL_ERR_MEMORY;
    for (int y = 0; y < photo->height; y++)
        for (int x = 0; x < photo->width; x++) {
            int u = (2 * x + 1) * depth->width / (2 * photo->width);
            int v = (2 * y + 1) * depth->height / (2 * photo->height);
            photo->depth[y * photo->width + x] = fmaxf(depth->f32[v * depth->width + u], 0);
        }
    return ORL_OK;
}

static enum orl_result read_photo(const struct orl_log *log, const struct orl_scene *scene,
                                  size_t i, const char *depth_path, struct photo *photo)
{
    struct orl_image picture = {0}, small = {0}, depth = {0};
    photo->view = scene->photos[i].view;
    const struct orl_camera *c = &photo->view.camera;
    double scale = fmin(1, (double)SIDE / (c->width > c->height ? c->width : c->height));
    photo->width = (int)fmax(1, round(c->width * scale));
    photo->height = (int)fmax(1, round(c->height * scale));
    char *path = orl_scene_photo_path(log, scene, i);
    enum orl_result result = path ? orl_picture_read(log, path, 3, &picture) : ORL_ERR_MEMORY;
    if (result == ORL_OK)
        result = orl_bridge_resize(log, &picture, photo->width, photo->height, &small);
    if (result == ORL_OK)
        result = find_detail(log, &small, photo);
    if (result == ORL_OK)
        result = orl_colmap_map_read(log, depth_path, &depth);
    if (result == ORL_OK)
        result = reduce_depth(log, &depth, photo);
    photo->view.camera = orl_camera_resized(c, photo->width, photo->height);
    orl_pose_centre(&photo->view.cam_from_world, photo->eye);
    orl_image_finish(&picture);
    orl_image_finish(&small);
    orl_image_finish(&depth);
    free(path);
    return result;
}

// Reads at most PHOTOS_MAX of the training photographs with depth maps, evenly chosen.
static enum orl_result read_photos(const struct orl_log *log, const struct orl_scene *scene,
                                   struct search *s)
{
    size_t train = 0, seen = 0;
    for (size_t i = 0; i < scene->photo_count; i++)
        train += !scene->photos[i].test;
    size_t step = (train + PHOTOS_MAX - 1) / PHOTOS_MAX;
    enum orl_result result = ORL_OK;
    for (size_t i = 0; result == ORL_OK && i < scene->photo_count; i++) {
        if (scene->photos[i].test || seen++ % step != 0)
            continue;
        char *path = orl_format(log, "%s/stereo/depth_maps/%s.geometric.bin", scene->dir,
                                scene->photos[i].name);
        if (!path)
            result = ORL_ERR_MEMORY;
        else if (orl_path_is_file(path)) // depth maps may have been deleted
            result = read_photo(log, scene, i, path, &s->photos[s->photo_count++]);
        free(path);
    }
    return result;
}

static void find_near(struct search *s)
{
    for (int a = 0; a < s->photo_count; a++) {
        struct photo *photo = &s->photos[a];
        double away[PHOTOS_MAX];
        for (int b = 0; b < s->photo_count; b++) {
            const double to[3] = {s->photos[b].eye[0] - photo->eye[0],
                                  s->photos[b].eye[1] - photo->eye[1],
                                  s->photos[b].eye[2] - photo->eye[2]};
            away[b] = a == b ? INFINITY : orl_dot3(to, to);
        }
        while (photo->near_count < NEAR_MAX && photo->near_count < s->photo_count - 1) {
            int nearest = 0;
            for (int b = 1; b < s->photo_count; b++)
                nearest = away[b] < away[nearest] ? b : nearest;
            away[nearest] = INFINITY;
            photo->near[photo->near_count++] = nearest;
        }
    }
}

static void find_axes(struct search *s)
{
    const double *n = s->found->plane;
    int least = fabs(n[0]) < fabs(n[1]) ? 0 : 1;
    least = fabs(n[2]) < fabs(n[least]) ? 2 : least;
    double *u = s->axes[0];
    for (int k = 0; k < 3; k++)
        u[k] = (k == least) - n[least] * n[k];
    orl_normalize3(u);
    orl_cross3(n, u, s->axes[1]);
    for (int i = 0; i < s->photo_count; i++)
        for (int k = 0; k < 3; k++)
            s->eye[k] += s->photos[i].eye[k] / s->photo_count;
}

static struct orl_ground moved(const struct search *s, const struct move *move)
{
    struct orl_ground ground = {.known = true,
                                .height = s->found->height * exp(move->log_height)};
    double *n = ground.plane;
    for (int k = 0; k < 3; k++)
        n[k] = s->found->plane[k] + move->tilt[0] * s->axes[0][k] + move->tilt[1] * s->axes[1][k];
    orl_normalize3(n);
    // The plane's distance below the photographs' mean centre is scaled by exp(log_height).
    double was = orl_plane_height(s->found->plane, s->eye);
    n[3] = was * exp(move->log_height) - orl_dot3(n, s->eye);
    return ground;
}

// Reads the detail that a photograph shows at a point of the ground. Returns false where the
// photograph does not show the point or has stereo depth.
static bool look_up(const struct photo *photo, const double at[3], double *detail)
{
    double pixel[2], depth;
    if (!orl_view_project(&photo->view, at, pixel, &depth))
        return false;
    double u = pixel[0] - 0.5, v = pixel[1] - 0.5;
    if (!(u >= 2 && v >= 2 && u < photo->width - 3 && v < photo->height - 3))
        return false;
    int x = (int)u, y = (int)v;
    if (photo->depth[y * photo->width + x] > 0)
        return false;
    const float *d = &photo->detail[y * photo->width + x];
    u -= x;
    v -= y;
    *detail = (1 - v) * ((1 - u) * (double)d[0] + u * (double)d[1]) +
              v * ((1 - u) * (double)d[photo->width] + u * (double)d[photo->width + 1]);
    return true;
}

struct tally {
    double off, contrast;
    long samples;
    long covered; // pixels whose stereo depth is that of the plane
};

// Compares one photograph's ground pixels without depth with what its neighbours show there.
static void compare(const struct search *s, const struct photo *photo,
                    const struct orl_ground *ground, struct tally *tally)
{
    const struct orl_camera *c = &photo->view.camera;
    double down[3];
    if (!orl_ground_along_rays(ground, &photo->view, down))
        return;
    int step = 1 + (int)sqrt((double)photo->width * photo->height / SPOTS);
    for (int y = step / 2; y < photo->height; y += step)
        for (int x = step / 2; x < photo->width; x += step) {
            const double ray[3] = {(x + 0.5 - c->cx) / c->fx, (y + 0.5 - c->cy) / c->fy, 1};
            double inverse = orl_dot3(down, ray), at[3];
            float depth = photo->depth[y * photo->width + x];
            if (inverse * REACH * ground->height < 1)
                continue;
            tally->covered += fabs((double)depth * inverse - 1) < NEAR_PLANE;
            if (depth > 0)
                continue;
            orl_view_unproject(&photo->view, x + 0.5, y + 0.5, 1 / inverse, at);
            double here = (double)photo->detail[y * photo->width + x], there;
            for (int k = 0; k < photo->near_count; k++) {
                if (!look_up(&s->photos[photo->near[k]], at, &there))
                    continue;
                tally->off += fabs(here - there);
                tally->contrast += fabs(here) + fabs(there) + QUIET;
                tally->samples++;
            }
        }
}

// The disagreement is relative to the contrast: an absolute one would be least where the ground has
// no texture.
static double disagreement(const struct search *s, const struct move *move, long samples_min)
{
    struct orl_ground ground = moved(s, move);
    struct tally tally = {0};
    for (int i = 0; i < s->photo_count; i++)
        compare(s, &s->photos[i], &ground, &tally);
    if (tally.samples < samples_min)
        return INFINITY;
    double shift = move->log_height / SHIFT_SIGMA, tilt = hypot(move->tilt[0], move->tilt[1]);
    return tally.off / tally.contrast +
           COST * (shift * shift + tilt * tilt / (TILT_SIGMA * TILT_SIGMA));
}

// Finds the best of a move's 26 neighbours, if one is better than the move. Height and tilt vary
// together because they depend on each other.
static bool improve(const struct search *s, double length, long samples_min, struct move *best,
                    double *least)
{
    struct move from = *best;
    bool better = false;
    for (int i = 0; i < 27; i++) {
        struct move to = {from.log_height + (i % 3 - 1) * length * SHIFT,
                          {from.tilt[0] + (i / 3 % 3 - 1) * length * TILT,
                           from.tilt[1] + (i / 9 - 1) * length * TILT}};
        if (fabs(to.log_height) > SHIFT_MAX || fabs(to.tilt[0]) > TILT_MAX ||
            fabs(to.tilt[1]) > TILT_MAX)
            continue;
        double here = disagreement(s, &to, samples_min);
        if (here >= *least)
            continue;
        *least = here;
        *best = to;
        better = true;
    }
    return better;
}

// Refines the ground. A plane that photographs hardly show is none: points of an object alone may
// fit one, too.
static void search(const struct orl_log *log, const struct search *s, struct orl_ground *ground)
{
    struct move best = {0};
    struct tally tally = {0};
    for (int i = 0; i < s->photo_count; i++)
        compare(s, &s->photos[i], s->found, &tally);
    if (tally.samples + tally.covered < SAMPLES_MIN) {
        orl_logf(log, ORL_LOG_INFO,
                 "ground: not known: photographs hardly show the plane that points tell");
        ground->height = 0;
    }
    if (tally.samples < SAMPLES_MIN)
        return;
    // A plane with fewer samples is a different plane, which the photographs see less of.
    long samples_min = tally.samples / 2;
    double before = disagreement(s, &best, samples_min), least = before, length = 1;
    for (int i = 0; i < STEPS; i++, length /= 2)
        for (int k = 0; k < ROUNDS_MAX && improve(s, length, samples_min, &best, &least); k++)
            ;
    *ground = moved(s, &best);
    orl_logf(log, ORL_LOG_INFO, "ground: %.2f times as far below as points tell, tilted by %.1f "
             "degrees; photographs differ by %.0f %% of contrast on it, before by %.0f %%",
             exp(best.log_height), hypot(best.tilt[0], best.tilt[1]) * 57.29578, 100 * least,
             100 * before);
}

enum orl_result orl_ground_refine(const struct orl_log *log, struct orl_scene *scene)
{
    if (!(scene->ground.height > 0))
        return ORL_OK;
    struct search *s = orl_array(log, 1, sizeof *s);
    if (!s)
        return ORL_ERR_MEMORY;
    struct orl_ground found = scene->ground;
    s->found = &found;
    enum orl_result result = read_photos(log, scene, s);
    if (result == ORL_OK && s->photo_count > 1) {
        find_near(s);
        find_axes(s);
        search(log, s, &scene->ground);
    }
    for (int i = 0; i < s->photo_count; i++) {
        free(s->photos[i].detail);
        free(s->photos[i].depth);
    }
    free(s);
    return result;
}

enum orl_result orl_stage_ground(struct orl_job *job, json_t *record)
{
    struct orl_scene *scene = NULL;
    enum orl_result result = orl_job_open_scene(job, &scene);
    if (result == ORL_OK)
        result = orl_ground_refine(job->log, scene);
    if (result == ORL_OK &&
        json_object_set_new(record, "ground", orl_manifest_ground(&scene->ground)) != 0)
        result = orl_fail(job->log, ORL_ERR_MEMORY, "no memory for the ground");
    orl_scene_destroy(&scene);
    return result;
}
