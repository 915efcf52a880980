// Draws the figure and its room: rays against spheres, cylinders and planes, by formula.
#include <math.h>
#include <string.h>

#include "core/color.h"
#include "core/vec3.h"
#include "datasets/figures.h"

static const double LIGHT[3] = {1.1, 2.8, 0.7}; // a small lamp below the ceiling
static const double LAMP = 11.0, AMBIENT = 0.40; // W m^2 and share: white at 2 m is about 1
static const double CLEAR = 1e-6;               // metres that a shadow ray starts off the surface

const struct orl_room orl_figures_room = {{-4, 0, -4}, {4, 3, 4}, true};

struct hit {
    double t; // along the ray; INFINITY: none
    int part; // of the figure, -1: the room
    int wall; // axis of the room's wall
};

// Where the ray enters the ball around `centre`; INFINITY: it does not.
static double meet_ball(const double eye[3], const double ray[3], const double centre[3],
                        double radius)
{
    const double to[3] = {eye[0] - centre[0], eye[1] - centre[1], eye[2] - centre[2]};
    double a = orl_dot3(ray, ray), b = orl_dot3(ray, to), c = orl_dot3(to, to) - radius * radius;
    double h = b * b - a * c;
    double t = h < 0 ? INFINITY : (-b - sqrt(h)) / a;
    return t > 0 ? t : INFINITY;
}

// The side of a cylinder around the segment, without its ends.
static double meet_side(const double eye[3], const double ray[3],
                        const struct orl_figure_part *p)
{
    double axis[3], to[3];
    for (int k = 0; k < 3; k++) {
        axis[k] = p->b[k] - p->a[k];
        to[k] = eye[k] - p->a[k];
    }
    double aa = orl_dot3(axis, axis), ar = orl_dot3(axis, ray), at = orl_dot3(axis, to);
    double a = aa * orl_dot3(ray, ray) - ar * ar, b = aa * orl_dot3(to, ray) - at * ar;
    double c = aa * orl_dot3(to, to) - at * at - p->radius * p->radius * aa;
    double h = b * b - a * c;
    if (!(aa > 0) || !(a > 0) || h < 0)
        return INFINITY;
    double t = (-b - sqrt(h)) / a, along = at + t * ar;
    return t > 0 && along > 0 && along < aa ? t : INFINITY;
}

static double meet_part(const double eye[3], const double ray[3],
                        const struct orl_figure_part *p)
{
    double t = meet_side(eye, ray, p);
    t = fmin(t, meet_ball(eye, ray, p->a, p->radius));
    return fmin(t, meet_ball(eye, ray, p->b, p->radius));
}

static void meet_figure(const struct orl_figure *figure, const double eye[3], const double ray[3],
                        struct hit *hit)
{
    for (int i = 0; figure && i < ORL_FIGURE_PARTS; i++) {
        double t = meet_part(eye, ray, &figure->parts[i]);
        if (t < hit->t) {
            hit->t = t;
            hit->part = i;
        }
    }
}

// From inside: the nearest of the walls ahead.
static void meet_room(const double eye[3], const double ray[3], struct hit *hit)
{
    for (int k = 0; k < 3; k++) {
        double t = ray[k] > 0   ? (orl_figures_room.high[k] - eye[k]) / ray[k]
                   : ray[k] < 0 ? (orl_figures_room.low[k] - eye[k]) / ray[k]
                                : INFINITY;
        if (t < hit->t) {
            hit->t = t;
            hit->part = -1;
            hit->wall = k;
        }
    }
}

// --- colours ---

static uint32_t hash(int x, int y, int z)
{
    uint32_t h = (uint32_t)x * 0x8da6b343u ^ (uint32_t)y * 0xd8163841u ^ (uint32_t)z * 0xcb1ab31fu;
    h = (h ^ (h >> 15)) * 0x2c1b3c6du;
    h = (h ^ (h >> 12)) * 0x297a2d39u;
    return h ^ (h >> 15);
}

void orl_figure_part_color(const struct orl_figure_part *part, const double at[3], double color[3])
{
    // Stripes around the limb, and cells of cloth 3 cm wide, fixed to its upper end.
    double off[3], axis[3];
    for (int k = 0; k < 3; k++) {
        off[k] = at[k] - part->a[k];
        axis[k] = part->b[k] - part->a[k];
    }
    if (!(orl_normalize3(axis) > 0))
        axis[1] = 1;
    double along = orl_dot3(off, axis);
    int stripe = (int)floor(along / 0.05);
    double across[3];
    for (int k = 0; k < 3; k++)
        across[k] = off[k] - along * axis[k];
    int turn = (int)floor(atan2(across[0], across[2]) * part->radius / 0.03);
    double cloth = 0.75 + 0.5 * (hash(stripe, turn, 7) & 255) / 255.0;
    for (int k = 0; k < 3; k++)
        color[k] = part->color[stripe & 1][k] * cloth;
}

static void room_color(int wall, const double at[3], double color[3])
{
    static const double tints[4][3] = {
        {0.34, 0.40, 0.40}, {0.24, 0.36, 0.46}, {0.40, 0.44, 0.36}, {0.26, 0.42, 0.30}};
    int u = (wall + 1) % 3, v = (wall + 2) % 3, side = at[wall] > (wall == 1 ? 1.0 : 0.0);
    double size = wall == 1 ? 0.5 : 0.4;
    uint32_t h = hash((int)floor(at[u] / size), (int)floor(at[v] / size), 10 * wall + side);
    // Smaller marks within each tile.
    uint32_t mark = hash((int)floor(at[u] / (size / 5)), (int)floor(at[v] / (size / 5)),
                         10 * wall + side + 100);
    double shade = 0.8 + 0.3 * (h >> 8 & 255) / 255.0 - 0.25 * ((mark & 7) == 0);
    for (int k = 0; k < 3; k++)
        color[k] = tints[h & 3][k] * shade;
}

static double lit(const struct orl_figure *figure, const double at[3], const double normal[3])
{
    double to[3], start[3];
    for (int k = 0; k < 3; k++) {
        start[k] = at[k] + CLEAR * normal[k];
        to[k] = LIGHT[k] - start[k];
    }
    struct hit shade = {.t = 1};
    meet_figure(figure, start, to, &shade);
    double distance = orl_normalize3(to), facing = orl_dot3(normal, to);
    double lamp = shade.t < 1 || facing < 0 ? 0 : LAMP * facing / (distance * distance + 1);
    return AMBIENT * (0.8 + 0.2 * normal[1]) + lamp / 3;
}

static void shade(const struct orl_figure *figure, const double eye[3], const double ray[3],
                  const struct hit *hit, double color[3])
{
    double at[3], normal[3] = {0, 0, 0};
    for (int k = 0; k < 3; k++)
        at[k] = eye[k] + hit->t * ray[k];
    if (hit->part >= 0) {
        const struct orl_figure_part *p = &figure->parts[hit->part];
        orl_figure_part_offset(p, at, normal);
        for (int k = 0; k < 3; k++)
            normal[k] /= p->radius;
        orl_figure_part_color(p, at, color);
    } else {
        normal[hit->wall] = ray[hit->wall] > 0 ? -1 : 1;
        room_color(hit->wall, at, color);
    }
    double light = lit(figure, at, normal);
    for (int k = 0; k < 3; k++)
        color[k] *= light;
}

// --- a picture ---

enum { RAYS = 4 }; // a pixel, each way

// World direction through pixel coordinates, of unit z in camera space: t is depth.
static void ray_through(const struct orl_view *view, double u, double v, double ray[3])
{
    const struct orl_camera *c = &view->camera;
    const double cam[3] = {(u - c->cx) / c->fx, (v - c->cy) / c->fy, 1};
    for (int k = 0; k < 3; k++)
        ray[k] = cam[0] * view->cam_from_world.r[0][k] + cam[1] * view->cam_from_world.r[1][k] +
                 cam[2] * view->cam_from_world.r[2][k];
}

static struct hit look(const struct orl_figure *figure, const double eye[3], const double ray[3])
{
    struct hit hit = {.t = INFINITY, .part = -1};
    meet_figure(figure, eye, ray, &hit);
    meet_room(eye, ray, &hit);
    return hit;
}

static void draw_pixel(const struct orl_figure *figure, const struct orl_view *view,
                       const double eye[3], int x, int y, struct orl_figures_picture *picture)
{
    size_t i = (size_t)y * (size_t)view->camera.width + (size_t)x;
    double ray[3], sum[3] = {0};
    ray_through(view, x + 0.5, y + 0.5, ray);
    struct hit hit = look(figure, eye, ray);
    picture->depth.f32[i] = (float)hit.t;
    if (figure)
        picture->mask.u8[i] = hit.part >= 0 ? 255 : 0;
    for (int s = 0; s < RAYS * RAYS; s++) {
        double color[3];
        ray_through(view, x + (s % RAYS + 0.5) / RAYS, y + (s / RAYS + 0.5) / RAYS, ray);
        hit = look(figure, eye, ray);
        shade(figure, eye, ray, &hit, color);
        for (int k = 0; k < 3; k++)
            sum[k] += color[k];
    }
    for (size_t k = 0; k < 3; k++)
        picture->photo.u8[3 * i + k] =
            (uint8_t)lrintf(255 * orl_srgb_encode((float)(sum[k] / (RAYS * RAYS))));
}

enum orl_result orl_figures_draw(const struct orl_log *log, const struct orl_figure *figure,
                                 const struct orl_view *view, struct orl_figures_picture *picture)
{
    memset(picture, 0, sizeof *picture);
    ORL_REQUIRE(log, orl_camera_valid(&view->camera));
    int w = view->camera.width, h = view->camera.height;
    double eye[3];
    orl_pose_centre(&view->cam_from_world, eye);
    enum orl_result result = orl_image_init(log, &picture->photo, w, h, 3, ORL_PIXEL_U8);
    ORL_THEN(result, orl_image_init(log, &picture->depth, w, h, 1, ORL_PIXEL_F32));
    if (result == ORL_OK && figure)
        result = orl_image_init(log, &picture->mask, w, h, 1, ORL_PIXEL_U8);
    for (int y = 0; result == ORL_OK && y < h; y++)
        for (int x = 0; x < w; x++)
            draw_pixel(figure, view, eye, x, y, picture);
    if (result != ORL_OK)
        orl_figures_picture_finish(picture);
    return result;
}

void orl_figures_picture_finish(struct orl_figures_picture *picture)
{
    orl_image_finish(&picture->photo);
    orl_image_finish(&picture->mask);
    orl_image_finish(&picture->depth);
}
