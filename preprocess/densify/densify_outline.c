// Depth that reaches past outlines is taken away. A patch that lies half on an object and half on
// what is behind matches at the object's depth, so that depth maps reach past outlines by up to half
// a patch. The photograph itself shows where the object ends.
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "bridge/bridge.h"
#include "core/memory.h"
#include "preprocess/densify/densify_internal.h"

enum {
    WINDOW = 9,        // pixels around one that are compared with it, each way
    FARTHER_MIN = 8, // pixels of the background, and of the surface, that a decision needs
    INSIDE_MIN = 4,
    OPEN_SHARE = 1000, // holes of at least this share of the picture show the background
    PROBES = 16,
};

static const float STEP = 0.03f;     // difference of inverse depth between two surfaces
static const float FACING = 0.1f;    // least cosine at which a plane's slope is known
static const float SURE = 0.7f;      // confidence from which a depth is not doubted
static const float LIKENESS = 0.05f; // standard deviation of luma between pixels that are alike
static const float DISTINCT = 0.1f;  // least difference of luma between surface and background
static const float CLEARLY = 2, DOUBT = 0.05f; // how much more a pixel is like the background

struct outline {
    const struct orl_image *luma;
    const struct densify_maps *maps;
    float *plane;     // for each pixel: inverse depth and its slope per pixel; 0: no depth
    uint8_t *open;    // 1: in a large hole
    uint8_t *inside;  // 1: nothing near is farther
    float alike[256]; // by difference of luma
};

// Inverse depth that the plane of pixel `from` has `dx`, `dy` pixels away.
static float expected(const struct outline *o, size_t from, int dx, int dy)
{
    const float *plane = o->plane + 3 * from;
    return fmaxf(plane[0] + plane[1] * (float)dx + plane[2] * (float)dy, 0.2f * plane[0]);
}

static bool is_farther(const struct outline *o, size_t at, float inverse)
{
    float there = o->plane[3 * at];
    return there > 0 ? there < inverse * (1 - STEP) : o->open[at];
}

// The pixel dx, dy from `at`. False outside the picture, of which nothing is known: a pixel at its border
// in place of one beyond it would lie off a slanting plane.
static bool find_beside(const struct outline *o, size_t at, int dx, int dy, size_t *there)
{
    int width = o->luma->width, height = o->luma->height;
    int x = (int)(at % (size_t)width) + dx, y = (int)(at / (size_t)width) + dy;
    *there = at;
    if (x < 0 || y < 0 || x >= width || y >= height)
        return false;
    *there = (size_t)y * (size_t)width + (size_t)x;
    return true;
}

static bool is_inside(const struct outline *o, size_t at)
{
    // Depth reaches past outlines by up to about five pixels.
    static const int probes[PROBES][2] = {
        {5, 0}, {4, 4}, {0, 5}, {-4, 4}, {-5, 0}, {-4, -4}, {0, -5}, {4, -4},
        {2, 0}, {2, 2}, {0, 2}, {-2, 2}, {-2, 0}, {-2, -2}, {0, -2}, {2, -2}};
    for (int k = 0; k < PROBES; k++) {
        int dx = probes[k][0], dy = probes[k][1];
        size_t there;
        if (find_beside(o, at, dx, dy, &there) && is_farther(o, there, expected(o, at, dx, dy)))
            return false;
    }
    return true;
}

// What a pixel is compared with.
struct side {
    float count, luma, alike; // pixels, and sums over them
};

static void add(struct side *side, float luma, float alike)
{
    side->count++;
    side->luma += luma;
    side->alike += alike;
}

// True if the pixel, near a step to something farther, looks like that rather than like its own
// surface.
static bool is_beyond_outline(const struct outline *o, size_t at)
{
    struct side farther = {0}, surface = {0};
    int own = o->luma->u8[at];
    for (int dy = -WINDOW; dy <= WINDOW; dy++)
        for (int dx = -WINDOW; dx <= WINDOW; dx++) {
            size_t there;
            if (!find_beside(o, at, dx, dy, &there))
                continue;
            float inverse = expected(o, at, dx, dy), luma = (float)o->luma->u8[there] / 255;
            float alike = o->alike[abs(o->luma->u8[there] - own)];
            if (is_farther(o, there, inverse))
                add(&farther, luma, alike);
            else if (o->inside[there] &&
                     fabsf(o->plane[3 * there] - inverse) <= STEP * inverse)
                add(&surface, luma, alike);
        }
    return farther.count >= FARTHER_MIN && surface.count >= INSIDE_MIN &&
           farther.alike / farther.count > CLEARLY * surface.alike / surface.count + DOUBT &&
           fabsf(farther.luma / farther.count - surface.luma / surface.count) > DISTINCT;
}

static void find_planes(struct outline *o, const struct orl_camera *camera)
{
    size_t width = (size_t)o->luma->width, count = width * (size_t)o->luma->height;
    for (size_t at = 0; at < count; at++) {
        float z = o->maps->depth.f32[at], *plane = o->plane + 3 * at;
        if (!(z > 0))
            continue;
        const float *n = o->maps->normal.f32 + 3 * at;
        float x = (float)(((double)(at % width) + 0.5 - camera->cx) / camera->fx);
        float y = (float)(((double)(at / width) + 0.5 - camera->cy) / camera->fy);
        float along = n[0] * x + n[1] * y + n[2];
        plane[0] = 1 / z;
        if (fabsf(along) > FACING * sqrtf(x * x + y * y + 1)) {
            plane[1] = n[0] / ((float)camera->fx * z * along);
            plane[2] = n[1] / ((float)camera->fy * z * along);
        }
    }
}

// Marks large holes. What small ones hide is not known: it may be the surface itself.
static enum orl_result find_open(const struct orl_log *log, struct outline *o)
{
    struct orl_image surface = {0}, closed = {0};
    size_t count = (size_t)o->luma->width * (size_t)o->luma->height;
    const struct orl_mask_cleaning small = {.hole_px = (int)((count + OPEN_SHARE - 1) / OPEN_SHARE)};
    enum orl_result result = orl_image_init(log, &surface, o->luma->width, o->luma->height, 1, ORL_PIXEL_U8);
    for (size_t at = 0; result == ORL_OK && at < count; at++)
        surface.u8[at] = o->plane[3 * at] > 0 ? 255 : 0;
    ORL_THEN(result, orl_bridge_clean_mask(log, &surface, &small, &closed));
    for (size_t at = 0; result == ORL_OK && at < count; at++)
        o->open[at] = !closed.u8[at];
    orl_image_finish(&surface);
    orl_image_finish(&closed);
    return result;
}

enum orl_result orl_densify_trim_outlines(const struct orl_log *log,
                                          const struct orl_camera *camera,
                                          const struct orl_image *luma, struct densify_maps *maps)
{
    size_t count = (size_t)luma->width * (size_t)luma->height;
    struct outline o = {.luma = luma, .maps = maps};
    uint8_t *beyond = orl_array(log, count, 1);
    o.plane = orl_array(log, count, 3 * sizeof *o.plane);
    o.open = orl_array(log, count, 1);
    o.inside = orl_array(log, count, 1);
    enum orl_result result = beyond && o.plane && o.open && o.inside ? ORL_OK : ORL_ERR_MEMORY;
    if (result != ORL_OK)
        goto end;
    for (int i = 0; i < 256; i++) {
        float off = (float)i / 255 / LIKENESS;
        o.alike[i] = expf(-0.5f * off * off);
    }
    find_planes(&o, camera);
    result = find_open(log, &o);
    for (size_t at = 0; result == ORL_OK && at < count; at++)
        o.inside[at] = o.plane[3 * at] > 0 && is_inside(&o, at);
    // Pixels are judged by the map as it was, so that their order does not matter.
    for (size_t at = 0; result == ORL_OK && at < count; at++)
        beyond[at] = o.plane[3 * at] > 0 && !o.inside[at] &&
                     maps->confidence.f32[at] < SURE && is_beyond_outline(&o, at);
    for (size_t at = 0; result == ORL_OK && at < count; at++)
        if (beyond[at]) {
            maps->depth.f32[at] = maps->confidence.f32[at] = 0;
            memset(&maps->normal.f32[3 * at], 0, 3 * sizeof(float));
        }
end:
    free(beyond);
    free(o.plane);
    free(o.open);
    free(o.inside);
    return result;
}
