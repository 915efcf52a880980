// Depth for surfaces without texture, such as plain walls and doors, from the surfaces around them:
// the planar prior of Xu and Tao 2020 (ACMP) in its simplest form. It applies only where the
// photograph shows no edge between a pixel and the surface whose plane the pixel takes.
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "core/memory.h"
#include "preprocess/densify/densify_internal.h"

enum {
    DIRECTIONS = 8,
    REACH_SHARE = 12, // longest search, as a divisor of the photograph's longer side
    STRIDE = 2,       // pixels between samples of the search
    BEYOND = 4,       // pixels by which the surface must continue behind its first sample: the rim
                      // of depth around an object before the sky is narrower
    AGREEING_MIN = 3, // least number of agreeing directions
    LUMA_MAX = 10,    // greatest change of luma along the way, of 255
};

static const float SAME_PLANE = 0.01f; // as a fraction of depth
static const float CONFIDENCE = 0.2f;  // of a completed pixel
// Least confidence of the surface: false matches in the sky, which is as plain, rarely reach it.
static const float CONFIDENCE_MIN = 0.6f;

// A surface found in some direction, extended to the pixel that is completed.
struct met {
    float depth; // of its plane at that pixel; 0: none
    const float *normal;
    float nearness;
};

struct completion {
    const struct densify_job *job;
    const struct densify_maps *maps; // before completion: completed pixels are no evidence
    const struct orl_image *luma;
    struct orl_camera camera;
    int reach; // longest search, pixels
};

// Depth of the plane of pixel `from` at pixel `to`; 0 when the plane is seen edge on or lies behind
// the camera.
static float depth_at(const struct completion *c, size_t from, size_t to)
{
    const float *n = &c->maps->normal.f32[3 * from];
    size_t width = (size_t)c->luma->width;
    float along[2];
    for (int k = 0; k < 2; k++) {
        size_t at = k ? to : from;
        float x = (float)(((double)(at % width) + 0.5 - c->camera.cx) / c->camera.fx);
        float y = (float)(((double)(at / width) + 0.5 - c->camera.cy) / c->camera.fy);
        along[k] = n[0] * x + n[1] * y + n[2];
    }
    // Normals towards the camera have along < 0.
    return along[0] < 0.0f && along[1] < 0.2f * along[0]
               ? c->maps->depth.f32[from] * along[0] / along[1] : 0.0f;
}

static bool inside(const struct completion *c, int x, int y)
{
    return x >= 0 && y >= 0 && x < c->luma->width && y < c->luma->height;
}

static struct met look(const struct completion *c, int x, int y, int dx, int dy)
{
    const struct met none = {0};
    const float *depth = c->maps->depth.f32;
    size_t width = (size_t)c->luma->width, at = (size_t)y * width + (size_t)x;
    for (int r = STRIDE; r <= c->reach; r += STRIDE) {
        int u = x + r * dx, v = y + r * dy;
        if (!inside(c, u, v))
            return none;
        size_t there = (size_t)v * width + (size_t)u;
        if (abs(c->luma->u8[there] - c->luma->u8[at]) > LUMA_MAX)
            return none;
        if (!(depth[there] > 0.0f))
            continue;
        u += BEYOND * dx;
        v += BEYOND * dy;
        if (!inside(c, u, v))
            return none;
        size_t beyond = (size_t)v * width + (size_t)u;
        float expected = depth_at(c, there, beyond);
        if (abs(c->luma->u8[beyond] - c->luma->u8[at]) > LUMA_MAX ||
            !(fabsf(depth[beyond] - expected) < SAME_PLANE * expected) ||
            !(c->maps->confidence.f32[beyond] > CONFIDENCE_MIN))
            return none;
        return (struct met){depth_at(c, beyond, at), &c->maps->normal.f32[3 * beyond],
                            1.0f / (float)r};
    }
    return none;
}

// True when a source sees through the point to something clearly farther.
static bool seen_through(const struct completion *c, int x, int y, float depth)
{
    const struct orl_view own = {c->camera, c->job->view.cam_from_world};
    double world[3], pixel[2], expected;
    orl_view_unproject(&own, x + 0.5, y + 0.5, depth, world);
    for (int s = 0; s < c->job->plan->count; s++) {
        const struct orl_image *map = &c->job->source_depths[s];
        struct orl_view view = c->job->source_views[s];
        if (!map->data)
            continue;
        view.camera = orl_densify_level_camera(&c->job->sources[s]->camera, c->job->finest);
        if (!orl_view_project(&view, world, pixel, &expected) || !(pixel[0] >= 0.0) ||
            !(pixel[1] >= 0.0) || pixel[0] >= map->width || pixel[1] >= map->height)
            continue;
        float seen = map->f32[(size_t)pixel[1] * (size_t)map->width + (size_t)pixel[0]];
        if (seen > 1.05 * expected)
            return true;
    }
    return false;
}

// Surfaces seen on one side only would grow into the sky, so every half of the directions must hold
// one that agrees.
static bool surrounded(const bool agrees[DIRECTIONS])
{
    int run = 0;
    for (int k = 0; k < 2 * DIRECTIONS; k++) {
        run = agrees[k % DIRECTIONS] ? 0 : run + 1;
        if (run >= DIRECTIONS / 2)
            return false;
    }
    return true;
}

// Finds the plane on which most directions agree. Returns its depth, 0 when too few agree.
static float agreed_plane(const struct met met[DIRECTIONS], float normal[3])
{
    int best = 0, most = 0;
    for (int i = 0; i < DIRECTIONS; i++) {
        int count = 0;
        for (int k = 0; k < DIRECTIONS; k++)
            count += met[k].depth > 0.0f &&
                     fabsf(met[k].depth - met[i].depth) < SAME_PLANE * met[i].depth;
        if (count > most) {
            most = count;
            best = i;
        }
    }
    bool agrees[DIRECTIONS];
    for (int k = 0; k < DIRECTIONS; k++)
        agrees[k] = met[k].depth > 0.0f &&
                    fabsf(met[k].depth - met[best].depth) < SAME_PLANE * met[best].depth;
    if (most < AGREEING_MIN || !surrounded(agrees))
        return 0.0f;
    float sum = 0.0f, total = 0.0f, direction[3] = {0}, square = 0.0f;
    for (int k = 0; k < DIRECTIONS; k++) {
        if (!agrees[k])
            continue;
        sum += met[k].nearness * met[k].depth;
        total += met[k].nearness;
        for (int i = 0; i < 3; i++)
            direction[i] += met[k].nearness * met[k].normal[i];
    }
    for (int i = 0; i < 3; i++)
        square += direction[i] * direction[i];
    for (int i = 0; i < 3; i++)
        normal[i] = direction[i] / sqrtf(fmaxf(square, 1e-20f));
    return sum / total;
}

static float complete_pixel(const struct completion *c, int x, int y, float normal[3])
{
    static const int dx[DIRECTIONS] = {1, 1, 0, -1, -1, -1, 0, 1};
    static const int dy[DIRECTIONS] = {0, 1, 1, 1, 0, -1, -1, -1};
    struct met met[DIRECTIONS];
    int count = 0;
    for (int k = 0; k < DIRECTIONS && count + DIRECTIONS - k >= AGREEING_MIN; k++) {
        met[k] = look(c, x, y, dx[k], dy[k]);
        count += met[k].depth > 0.0f;
    }
    if (count < AGREEING_MIN)
        return 0.0f;
    float depth = agreed_plane(met, normal);
    return depth > 0.0f && !seen_through(c, x, y, depth) ? depth : 0.0f;
}

enum orl_result orl_densify_complete(const struct orl_log *log, const struct densify_job *job,
                                     struct densify_maps *maps)
{
    struct completion c = {.job = job, .maps = maps,
                           .luma = &job->reference->levels[job->finest],
                           .camera = orl_densify_level_camera(&job->reference->camera,
                                                              job->finest)};
    int width = c.luma->width, height = c.luma->height;
    c.reach = (width > height ? width : height) / REACH_SHARE;
    size_t count = (size_t)width * (size_t)height;
    float *found = orl_array(log, count, 4 * sizeof *found); // normal, depth
    ORL_TRY_MEMORY(found);
    for (int y = 0; y < height; y++)
        for (int x = 0; x < width; x++) {
            size_t at = (size_t)y * (size_t)width + (size_t)x;
            if (!(maps->depth.f32[at] > 0.0f) && orl_densify_mask_at(&job->mask, job->finest, x, y))
                found[4 * at + 3] = complete_pixel(&c, x, y, &found[4 * at]);
        }
    for (size_t at = 0; at < count; at++) {
        if (!(found[4 * at + 3] > 0.0f))
            continue;
        memcpy(&maps->normal.f32[3 * at], &found[4 * at], 3 * sizeof *found);
        maps->depth.f32[at] = found[4 * at + 3];
        maps->confidence.f32[at] = CONFIDENCE;
    }
    free(found);
    return ORL_OK;
}
