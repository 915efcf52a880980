// The figure's shape, its walk, and the cameras around it.
#include "datasets/figures.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "core/color.h"
#include "core/memory.h"
#include "core/vec3.h"
#include "scene/isosurface.h"

enum orl_result orl_figures_check(const struct orl_log *log, const struct orl_figures_params *p)
{
    if (p->width < ORL_FIGURES_SIDE_MIN || p->width > ORL_FIGURES_SIDE_MAX ||
        p->height < ORL_FIGURES_SIDE_MIN || p->height > ORL_FIGURES_SIDE_MAX)
        return orl_fail(log, ORL_ERR_ARGUMENT, "size %dx%d: each side must be from %d to %d",
                        p->width, p->height, ORL_FIGURES_SIDE_MIN, ORL_FIGURES_SIDE_MAX);
    return ORL_OK;
}

void orl_figures_views(const struct orl_figures_params *p, struct orl_view *views)
{
    // The figure stays within 1.2 m of the middle, so it is whole in every picture.
    double least = p->width < p->height ? p->width : p->height, focal = 1.25 * least;
    for (int i = 0; i < p->cameras; i++) {
        double angle = 2 * M_PI * i / p->cameras + 0.3, height = i % 2 ? 2.1 : 1.1;
        const double eye[3] = {3.1 * sin(angle), height, 3.1 * cos(angle)};
        const double target[3] = {0, 0.92, 0}, up[3] = {0, 1, 0};
        views[i] = (struct orl_view){
            .camera = {.width = p->width, .height = p->height, .fx = focal, .fy = focal,
                       .cx = 0.5 * p->width, .cy = 0.5 * p->height},
            .cam_from_world = orl_pose_look_at(eye, target, up)};
    }
}

// --- the figure ---

// Where a limb ends: `length` from `from`, swung by `swing` forward (z) from straight down and by
// `spread` aside (x), radians.
static void limb(const double from[3], double length, double swing, double spread, double to[3])
{
    to[0] = from[0] + length * sin(spread);
    to[1] = from[1] - length * cos(spread) * cos(swing);
    to[2] = from[2] + length * cos(spread) * sin(swing);
}

static struct orl_figure_part part(const double a[3], const double b[3], double radius,
                                   const double color[2][3])
{
    struct orl_figure_part p = {.radius = radius};
    memcpy(p.a, a, sizeof p.a);
    memcpy(p.b, b, sizeof p.b);
    memcpy(p.color, color, sizeof p.color);
    return p;
}

// From the body's frame (facing z) to the world's: turned around y, then moved.
static void place(struct orl_figure *figure, double turn, const double at[3])
{
    for (int i = 0; i < ORL_FIGURE_PARTS; i++)
        for (int end = 0; end < 2; end++) {
            double *p = end ? figure->parts[i].b : figure->parts[i].a;
            const double body[3] = {p[0], p[1], p[2]};
            p[0] = cos(turn) * body[0] + sin(turn) * body[2] + at[0];
            p[1] = body[1] + at[1];
            p[2] = -sin(turn) * body[0] + cos(turn) * body[2] + at[2];
        }
}

void orl_figure_pose(int frame, struct orl_figure *figure)
{
    static const double skin[2][3] = {{0.55, 0.33, 0.23}, {0.47, 0.27, 0.18}};
    static const double shirt[2][3] = {{0.45, 0.05, 0.04}, {0.62, 0.52, 0.35}};
    static const double trousers[2][3] = {{0.04, 0.07, 0.22}, {0.09, 0.13, 0.33}};
    static const double hair[2][3] = {{0.05, 0.03, 0.02}, {0.10, 0.06, 0.03}};
    struct orl_figure_part *p = figure->parts;
    double time = frame / 25.0, step = 2 * M_PI * 0.9 * time, along = 2 * M_PI * 0.1 * time;
    const double hip[3] = {0, 0.90, 0}, chest[3] = {0, 1.30, 0}, neck[3] = {0, 1.48, 0};
    const double head[3] = {0, 1.64, 0.02}, crown[3] = {0, 1.68, -0.01};
    *p++ = part(hip, chest, 0.15, shirt);
    *p++ = part(chest, neck, 0.06, skin);
    *p++ = part(head, head, 0.105, skin);
    *p++ = part(crown, crown, 0.104, hair);
    for (int side = -1; side <= 1; side += 2) {
        // Arms swing against the legs; the left one is lifted, so that no two sides are alike.
        double swing = side * 0.55 * sin(step), lift = side < 0 ? 0.9 : 0.15;
        const double shoulder[3] = {side * 0.19, 1.38, 0}, joint[3] = {side * 0.09, 0.88, 0};
        double elbow[3], hand[3], knee[3], ankle[3], toe[3];
        limb(shoulder, 0.28, -swing, side * lift, elbow);
        limb(elbow, 0.26, -swing + 0.5, side * lift * 0.6, hand);
        limb(joint, 0.42, swing, side * 0.03, knee);
        limb(knee, 0.40, swing - 0.35 * (1 - cos(step)), 0, ankle);
        toe[0] = ankle[0];
        toe[1] = ankle[1] - 0.02;
        toe[2] = ankle[2] + 0.13;
        *p++ = part(shoulder, elbow, 0.055, shirt);
        *p++ = part(elbow, hand, 0.042, skin);
        *p++ = part(joint, knee, 0.08, trousers);
        *p++ = part(knee, ankle, 0.055, trousers);
        *p++ = part(ankle, toe, 0.04, hair);
    }
    // Facing along its circle, feet on the floor.
    const double at[3] = {0.45 * sin(along), 0.03, 0.45 * cos(along)};
    place(figure, along + 0.5 * M_PI, at);
}

void orl_figure_part_offset(const struct orl_figure_part *p, const double at[3], double off[3])
{
    double ab[3];
    for (int k = 0; k < 3; k++) {
        ab[k] = p->b[k] - p->a[k];
        off[k] = at[k] - p->a[k];
    }
    double length2 = orl_dot3(ab, ab), t = length2 > 0 ? orl_dot3(off, ab) / length2 : 0;
    t = t < 0 ? 0 : t > 1 ? 1 : t;
    for (int k = 0; k < 3; k++)
        off[k] -= t * ab[k];
}

double orl_figure_distance(const struct orl_figure *figure, const double at[3], int *nearest)
{
    double least = INFINITY;
    for (int i = 0; i < ORL_FIGURE_PARTS; i++) {
        double off[3];
        orl_figure_part_offset(&figure->parts[i], at, off);
        double d = sqrt(orl_dot3(off, off)) - figure->parts[i].radius;
        if (d < least) {
            least = d;
            if (nearest)
                *nearest = i;
        }
    }
    return least;
}

// --- its mesh ---

// Grid around the figure with at least a cell of free space.
static struct orl_grid grid_around(const struct orl_figure *figure, double spacing)
{
    double low[3] = {INFINITY, INFINITY, INFINITY}, high[3] = {-INFINITY, -INFINITY, -INFINITY};
    for (int i = 0; i < ORL_FIGURE_PARTS; i++) {
        const struct orl_figure_part *p = &figure->parts[i];
        for (int k = 0; k < 3; k++) {
            low[k] = fmin(low[k], fmin(p->a[k], p->b[k]) - p->radius);
            high[k] = fmax(high[k], fmax(p->a[k], p->b[k]) + p->radius);
        }
    }
    struct orl_grid grid = {.spacing = spacing};
    for (int k = 0; k < 3; k++) {
        grid.origin[k] = low[k] - 1.5 * spacing;
        grid.size[k] = (int)ceil((high[k] - low[k]) / spacing) + 4;
    }
    return grid;
}

static void gradient(const struct orl_figure *figure, const double at[3], double normal[3])
{
    const double e = 1e-6;
    for (int k = 0; k < 3; k++) {
        double a[3] = {at[0], at[1], at[2]}, b[3] = {at[0], at[1], at[2]};
        a[k] += e;
        b[k] -= e;
        normal[k] = orl_figure_distance(figure, a, NULL) - orl_figure_distance(figure, b, NULL);
    }
    orl_normalize3(normal);
}

// Moves vertices onto the surface (Newton's method) and sets their colours.
static enum orl_result finish_mesh(const struct orl_log *log, const struct orl_figure *figure,
                                   struct orl_mesh *mesh)
{
    mesh->normal = orl_array(log, mesh->vertex_count, sizeof *mesh->normal);
    mesh->color = orl_array(log, mesh->vertex_count, sizeof *mesh->color);
    ORL_TRY_MEMORY(mesh->normal && mesh->color);
    for (size_t i = 0; i < mesh->vertex_count; i++) {
        double at[3], normal[3], color[3];
        for (int k = 0; k < 3; k++)
            at[k] = (double)mesh->position[i][k];
        // In a crease the gradient jumps between two parts: more rounds than elsewhere.
        for (int round = 0; round < 40; round++) {
            double d = orl_figure_distance(figure, at, NULL);
            gradient(figure, at, normal);
            if (fabs(d) < 1e-7)
                break;
            for (int k = 0; k < 3; k++)
                at[k] -= d * normal[k];
        }
        int nearest = 0;
        orl_figure_distance(figure, at, &nearest);
        orl_figure_part_color(&figure->parts[nearest], at, color);
        for (int k = 0; k < 3; k++) {
            mesh->position[i][k] = (float)at[k];
            mesh->normal[i][k] = (float)normal[k];
            mesh->color[i][k] = (uint8_t)lrintf(255 * orl_srgb_encode((float)color[k]));
        }
    }
    return ORL_OK;
}

enum orl_result orl_figure_mesh(const struct orl_log *log, const struct orl_figure *figure,
                                double spacing, struct orl_mesh *mesh)
{
    memset(mesh, 0, sizeof *mesh);
    ORL_REQUIRE(log, spacing > 0.001 && spacing < 0.1);
    struct orl_grid grid = grid_around(figure, spacing);
    float *value = orl_array(log, (size_t)grid.size[0] * (size_t)grid.size[1] *
                                      (size_t)grid.size[2], sizeof *value);
    ORL_TRY_MEMORY(value);
    float *out = value;
    for (int z = 0; z < grid.size[2]; z++)
        for (int y = 0; y < grid.size[1]; y++)
            for (int x = 0; x < grid.size[0]; x++) {
                const double at[3] = {grid.origin[0] + x * spacing, grid.origin[1] + y * spacing,
                                      grid.origin[2] + z * spacing};
                *out++ = (float)orl_figure_distance(figure, at, NULL);
            }
    grid.value = value;
    enum orl_result result = orl_isosurface(log, &grid, mesh);
    ORL_THEN(result, finish_mesh(log, figure, mesh));
    if (result != ORL_OK)
        orl_mesh_finish(mesh);
    free(value);
    return result;
}
