// Depth for surfaces without texture, such as plain walls and signs, from the surfaces around them. As the planar
// prior of ACMP does (Xu and Tao 2020), it continues planes. They spread by a diffusion whose conductivity falls at
// the edges of the photograph (Perona and Malik 1990), so that they pass around print and stains, but not from a wall
// to the sky.
#include <math.h>
#include <stdlib.h>

#include "core/memory.h"
#include "preprocess/densify/densify_internal.h"

enum {
    MARGIN = 3,       // pixels by which reliable depth lies inside all depth: its rim may reach past outlines
    REACH_SHARE = 12, // how far a surface is continued, as a divisor of the photograph's longer side,
    REACH_MAX = 80,   // and at most, pixels, which bounds the time
};

// Least confidence of reliable depth: false matches in the sky, which is as plain, rarely reach it.
static const float CONFIDENCE_MIN = 0.6f;
static const float CONFIDENCE = 0.2f; // of a completed pixel
// Difference of luma between two pixels, of 255, at which conductivity has fallen to 1/e.
static const float EDGE = 6.0f;
// A pixel is completed if so large a share of what it could receive has not been lost on the way,
static const float SURE_MIN = 0.75f;
// if it has the luma of the surfaces around it up to this difference,
static const float LUMA_MAX = 10.0f;
// and if the depths of their planes, continued to it, have at most this standard deviation, as a fraction.
static const float SAME_PLANE = 0.02f;

// What a pixel receives, floats alone. All members but `sure` are multiplied by it.
struct received {
    float sure; // 1: all that it could
    float luma;
    float plane[3];   // p: p . (x, y, 1) is the inverse depth at the image position (x, y)
    float squares[6]; // of p: xx, yy, zz, xy, yz, zx
};
enum { MEMBERS = sizeof(struct received) / sizeof(float) };

// A pixel that receives.
struct receiver {
    struct received *own;
    float share[4]; // of what the pixels to its left, to its right, above and below it have
};

struct diffusion {
    struct densify_maps *maps;
    const struct orl_image *luma;
    struct orl_camera camera;
    float reach;                // pixels
    struct received *received;  // of width + 2 by height + 2 pixels: its border has nothing; owned
    struct receiver *receivers; // owned
    size_t receiver_count;
};

static size_t index_of(const struct diffusion *d, int x, int y)
{
    return (size_t)y * (size_t)d->luma->width + (size_t)x;
}

static struct received *received_at(const struct diffusion *d, int x, int y)
{
    return d->received + ((size_t)y + 1) * ((size_t)d->luma->width + 2) + (size_t)x + 1;
}

static bool inside(const struct diffusion *d, int x, int y)
{
    return x >= 0 && y >= 0 && x < d->luma->width && y < d->luma->height;
}

// Image position of a pixel's centre.
static void image_position(const struct diffusion *d, int x, int y, float out[3])
{
    out[0] = (float)((x + 0.5 - d->camera.cx) / d->camera.fx);
    out[1] = (float)((y + 0.5 - d->camera.cy) / d->camera.fy);
    out[2] = 1.0f;
}

static float dot(const float a[3], const float b[3])
{
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}

static bool deep_inside(const struct diffusion *d, int x, int y)
{
    for (int v = y - MARGIN; v <= y + MARGIN; v++)
        for (int u = x - MARGIN; u <= x + MARGIN; u++)
            if (inside(d, u, v) && !(d->maps->depth.f32[index_of(d, u, v)] > 0.0f))
                return false;
    return true;
}

// What reliable depth hands on; false where there is none.
static bool hand_on(const struct diffusion *d, int x, int y, struct received *out)
{
    static const float edge_on = 0.05f;
    size_t at = index_of(d, x, y);
    const float *normal = &d->maps->normal.f32[3 * at];
    float position[3], p[3];
    image_position(d, x, y, position);
    float facing = -dot(normal, position);
    if (!(d->maps->confidence.f32[at] > CONFIDENCE_MIN) || !(facing > edge_on) || !deep_inside(d, x, y))
        return false;
    for (int k = 0; k < 3; k++)
        p[k] = -normal[k] / (facing * d->maps->depth.f32[at]);
    *out = (struct received){1.0f, d->luma->u8[at], {p[0], p[1], p[2]},
                             {p[0] * p[0], p[1] * p[1], p[2] * p[2], p[0] * p[1], p[1] * p[2], p[2] * p[0]}};
    return true;
}

static float conductivity(const struct diffusion *d, int x, int y, int u, int v)
{
    if (!inside(d, u, v))
        return 0.0f;
    float off = ((float)d->luma->u8[index_of(d, x, y)] - (float)d->luma->u8[index_of(d, u, v)]) / EDGE;
    return expf(-off * off);
}

static struct receiver receiver_at(const struct diffusion *d, int x, int y)
{
    struct receiver r = {.own = received_at(d, x, y)};
    float sum = 1.0f / (d->reach * d->reach); // lost
    for (int k = 0; k < 4; k++) {
        r.share[k] = conductivity(d, x, y, x + (k == 1) - (k == 0), y + (k == 3) - (k == 2));
        sum += r.share[k];
    }
    for (int k = 0; k < 4; k++)
        r.share[k] /= sum;
    return r;
}

static void receive(const struct receiver *r, ptrdiff_t row, float relaxation)
{
    float *own = (float *)r->own;
    const float *from[4] = {own - MEMBERS, own + MEMBERS, own - row * MEMBERS, own + row * MEMBERS};
    for (int k = 0; k < MEMBERS; k++) {
        float next = r->share[0] * from[0][k] + r->share[1] * from[1][k] + r->share[2] * from[2][k] +
                     r->share[3] * from[3][k];
        own[k] += relaxation * (next - own[k]);
    }
}

// Successive over-relaxation (Young 1954). The best factor and the number of sweeps follow from the loss of
// 1 / reach^2 a pixel.
static void diffuse(const struct diffusion *d)
{
    int sweeps = (int)(2.5f * d->reach) + 1;
    float relaxation = 2.0f / (1.0f + 0.7f / d->reach);
    for (int sweep = 0; sweep < sweeps; sweep++)
        for (size_t i = 0; i < d->receiver_count; i++)
            receive(&d->receivers[i], d->luma->width + 2, relaxation);
}

// Sets the depth and the normal of an open pixel if what it receives agrees.
static void complete_pixel(const struct diffusion *d, int x, int y)
{
    size_t at = index_of(d, x, y);
    const struct received *r = received_at(d, x, y);
    const float *n = r->plane, *q = r->squares;
    float p[3];
    image_position(d, x, y, p);
    float inverse = dot(n, p) / r->sure, off = r->luma / r->sure - d->luma->u8[at];
    float square = (q[0] * p[0] * p[0] + q[1] * p[1] * p[1] + q[2] +
                    2.0f * (q[3] * p[0] * p[1] + q[4] * p[1] + q[5] * p[0])) / r->sure;
    bool agree = square - inverse * inverse < SAME_PLANE * SAME_PLANE * inverse * inverse;
    if (!(r->sure > SURE_MIN) || !(fabsf(off) < LUMA_MAX) || !(inverse > 0.0f) || !agree)
        return;
    float length = sqrtf(dot(n, n));
    d->maps->depth.f32[at] = 1.0f / inverse;
    d->maps->confidence.f32[at] = CONFIDENCE;
    for (int k = 0; k < 3; k++)
        d->maps->normal.f32[3 * at + (size_t)k] = -n[k] / length;
}

enum orl_result orl_densify_complete(const struct orl_log *log, const struct densify_job *job,
                                     struct densify_maps *maps)
{
    const struct orl_image *luma = &job->reference->levels[job->finest];
    int width = luma->width, height = luma->height;
    size_t pixels = (size_t)width * (size_t)height;
    struct diffusion d = {.maps = maps, .luma = luma,
                          .camera = orl_densify_level_camera(&job->reference->camera, job->finest),
                          .reach = fminf((float)(width > height ? width : height) / REACH_SHARE, REACH_MAX),
                          .received = orl_array(log, ((size_t)width + 2) * ((size_t)height + 2),
                                                sizeof *d.received),
                          .receivers = orl_array(log, pixels, sizeof *d.receivers)};
    enum orl_result result = d.received && d.receivers ? ORL_OK : ORL_ERR_MEMORY;
    for (int y = 0; result == ORL_OK && y < height; y++)
        for (int x = 0; x < width; x++)
            if (!hand_on(&d, x, y, received_at(&d, x, y)))
                d.receivers[d.receiver_count++] = receiver_at(&d, x, y);
    if (result == ORL_OK)
        diffuse(&d);
    for (int y = 0; result == ORL_OK && y < height; y++)
        for (int x = 0; x < width; x++)
            if (!(maps->depth.f32[index_of(&d, x, y)] > 0.0f) && orl_densify_mask_at(&job->mask, job->finest, x, y))
                complete_pixel(&d, x, y);
    free(d.received);
    free(d.receivers);
    return result;
}
