#include "preprocess/cloud/fuse_maps.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "bridge/bridge.h"
#include "core/memory.h"
#include "core/vec3.h"

// A map shows a point's surface if its depth there differs by less than this fraction, and sees past
// it if its depth is farther by more than twice that.
static const float TOLERANCE = 0.01f;
// A map that shows it agrees on the point if its own point would be seen within so many pixels of it.
// Where photographs stand far apart, depths that agree by chance do not.
static const double SHIFT_MAX = 1.5;
// A point stays if at least so many photographs agree on it, its own included, for each that sees
// past it.
enum { AGREE_MIN = 2, AGREE_FOR_EACH_PAST = 3 };
// Of photographs that see a surface in nearly the same detail, each may keep its points: with no
// margin, places are lost where each leaves a point to the other.
static const float FINER = 1.05f;
// Depths of neighbouring pixels with at least this ratio form a step. All pixels within STEP_REACH of
// one are kept: discs reach past an outline by as much as points on it lie apart.
static const float STEP_RATIO = 1.03f;
enum { STEP_REACH = 4, SMOOTH_SPACING = 2 };

// --- steps of depth ---

static bool is_step(float a, float b)
{
    return a > 0 || b > 0 ? !(fmaxf(a, b) < STEP_RATIO * fminf(a, b)) : false;
}

// Marks the pixels near a step of depth.
static enum orl_result find_steps(const struct orl_log *log, const struct orl_image *depth, struct orl_image *near)
{
    struct orl_image marks;
    size_t width = (size_t)depth->width, height = (size_t)depth->height;
    ORL_TRY(orl_image_init(log, &marks, depth->width, depth->height, 1, ORL_PIXEL_U8));
    for (size_t y = 0; y < height; y++)
        for (size_t x = 0; x < width; x++) {
            const float *z = depth->f32 + y * width + x;
            uint8_t *mark = marks.u8 + y * width + x;
            if (x + 1 < width && is_step(z[0], z[1]))
                mark[0] = mark[1] = 255;
            if (y + 1 < height && is_step(z[0], z[width]))
                mark[0] = mark[width] = 255;
        }
    enum orl_result result = orl_bridge_widen(log, &marks, STEP_REACH, near);
    orl_image_finish(&marks);
    return result;
}

// --- what other photographs say ---

// From the camera frame of one map to that of another: r * q + shift.
struct passage {
    const struct orl_depth_map *to;
    double r[3][3], shift[3];
    double eye[3]; // of the other camera, in the frame of the first
    double focal;  // of the first, pixels
};

static struct passage passage_between(const struct orl_depth_map *from,
                                      const struct orl_depth_map *to)
{
    const struct orl_pose *a = &from->view.cam_from_world, *b = &to->view.cam_from_world;
    struct passage p = {.to = to, .focal = from->view.camera.fx};
    double eye[3];
    orl_pose_centre(b, eye);
    for (int i = 0; i < 3; i++) {
        p.eye[i] = orl_dot3(a->r[i], eye) + a->t[i];
        p.shift[i] = b->t[i];
        for (int j = 0; j < 3; j++) {
            for (int k = 0; k < 3; k++)
                p.r[i][j] += b->r[i][k] * a->r[j][k];
            p.shift[i] -= p.r[i][j] * a->t[j];
        }
    }
    return p;
}

struct votes {
    int agree, past;
    float finest; // least size of a pixel on the surface among those that show it, scene units
};

// How far from the pixel of q, in pixels, the other map's point lies, whose depth there is greater by
// the fraction `farther`: it lies on the ray from the other eye, by that fraction farther along.
static double shift_in_pixels(const struct passage *p, const double q[3], float farther)
{
    double x = p->eye[0] - p->eye[2] * q[0] / q[2], y = p->eye[1] - p->eye[2] * q[1] / q[2];
    return fabs((double)farther) * p->focal / q[2] * sqrt(x * x + y * y);
}

// Asks one map about a point of the other camera's frame.
static void ask(const struct passage *p, const double q[3], struct votes *v)
{
    const struct orl_camera *c = &p->to->view.camera;
    const struct orl_image *depth = &p->to->depth;
    double z = p->r[2][0] * q[0] + p->r[2][1] * q[1] + p->r[2][2] * q[2] + p->shift[2];
    if (!(z > 0))
        return;
    double x = p->r[0][0] * q[0] + p->r[0][1] * q[1] + p->r[0][2] * q[2] + p->shift[0];
    double y = p->r[1][0] * q[0] + p->r[1][1] * q[1] + p->r[1][2] * q[2] + p->shift[1];
    x = c->fx * x / z + c->cx;
    y = c->fy * y / z + c->cy;
    if (!(x >= 0 && y >= 0 && x < depth->width && y < depth->height))
        return;
    float seen = depth->f32[(size_t)y * (size_t)depth->width + (size_t)x];
    float farther = seen / (float)z - 1; // -1: it has no depth there
    v->past += farther > 2 * TOLERANCE;
    if (fabsf(farther) < TOLERANCE) {
        v->agree += shift_in_pixels(p, q, farther) < SHIFT_MAX;
        v->finest = fminf(v->finest, (float)(z / c->fx));
    }
}

static bool keeps(const struct votes *v, float own_size)
{
    return v->agree >= AGREE_MIN && AGREE_FOR_EACH_PAST * v->past <= v->agree &&
           own_size <= FINER * v->finest;
}

// --- one map ---

static void find(const struct orl_depth_map *map, const struct orl_image *near,
                 const struct passage *passages, size_t count, struct orl_fused_pixels *found)
{
    const struct orl_camera *c = &map->view.camera;
    for (int y = 0; y < map->depth.height; y++)
        for (int x = 0; x < map->depth.width; x++) {
            size_t at = (size_t)y * (size_t)map->depth.width + (size_t)x;
            double z = (double)map->depth.f32[at];
            bool on_grid = x % SMOOTH_SPACING == 1 && y % SMOOTH_SPACING == 1;
            if (!(z > 0) || !(near->u8[at] || on_grid))
                continue;
            const double q[3] = {(x + 0.5 - c->cx) / c->fx * z, (y + 0.5 - c->cy) / c->fy * z, z};
            float size = (float)(z / c->fx);
            struct votes v = {.agree = 1, .finest = size};
            for (size_t i = 0; i < count; i++)
                ask(&passages[i], q, &v);
            if (!keeps(&v, size))
                continue;
            found->agree[found->count] = (uint8_t)(v.agree < UINT8_MAX ? v.agree : UINT8_MAX);
            found->pixel[found->count++] = (uint32_t)at;
        }
}

enum orl_result orl_fuse_pixels_find(const struct orl_log *log, const struct orl_depth_map *maps,
                                     size_t which, const uint32_t *others, size_t other_count,
                                     struct orl_fused_pixels *found)
{
    const struct orl_depth_map *map = &maps[which];
    size_t pixels = (size_t)map->depth.width * (size_t)map->depth.height, count = 0;
    struct passage *passages = orl_array(log, other_count + 1, sizeof *passages);
    struct orl_image near = {0};
    *found = (struct orl_fused_pixels){.pixel = orl_array(log, pixels + 1, sizeof *found->pixel),
                                       .agree = orl_array(log, pixels + 1, 1)};
    enum orl_result result = passages && found->pixel && found->agree ? find_steps(log, &map->depth, &near)
                                                                      : ORL_ERR_MEMORY;
    for (size_t i = 0; result == ORL_OK && i < other_count; i++)
        if (maps[others[i]].depth.f32)
            passages[count++] = passage_between(map, &maps[others[i]]);
    if (result == ORL_OK)
        find(map, &near, passages, count, found);
    else
        orl_fused_pixels_finish(found);
    free(passages);
    orl_image_finish(&near);
    return result;
}

void orl_fused_pixels_finish(struct orl_fused_pixels *found)
{
    free(found->pixel);
    free(found->agree);
    *found = (struct orl_fused_pixels){0};
}

void orl_fuse_pixels_write(const struct orl_depth_map *map, const struct orl_fused_pixels *found,
                           const struct orl_image *normal, const struct orl_image *picture,
                           size_t first, struct orl_points *points)
{
    const double (*r)[3] = map->view.cam_from_world.r;
    for (size_t i = 0; i < found->count; i++) {
        size_t at = found->pixel[i], to = first + i, width = (size_t)map->depth.width;
        double world[3];
        orl_view_unproject(&map->view, (double)(at % width) + 0.5, (double)(at / width) + 0.5,
                           (double)map->depth.f32[at], world);
        const float *n = normal->f32 + 3 * at;
        for (int k = 0; k < 3; k++) {
            points->position[to][k] = (float)world[k];
            points->normal[to][k] = (float)(r[0][k] * (double)n[0] + r[1][k] * (double)n[1] +
                                            r[2][k] * (double)n[2]);
            points->color[to][k] = picture->u8[3 * at + (size_t)k];
        }
        points->photographs[to] = found->agree[i];
    }
}
