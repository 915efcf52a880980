#include "preprocess/cloud/hull_points.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "core/memory.h"
#include "core/order.h"
#include "scene/nearest_points.h"

enum {
    SIDE_MIN = 32,     // voxels
    SIDE_MAX = 256,    // 224 MiB while the surface is made
    VOXEL_BYTES = 14,  // inside, through, stack or field, and the surface's copy of the field
    WRONG_ONE_IN = 32, // silhouettes and maps
};
// The cube is around the inner 99 % of the points along each axis, and half as large again as they:
// stereo may have missed a part of the subject. In a larger one the backdrop would leave more that
// is not the subject.
static const double OUTERMOST = 0.005, ROOM = 1.5;
static const double VOXEL_PX = 2;   // least size of a voxel, pixels of the photographs
static const double THROUGH = 1.5;  // voxels that a map must see behind the centre of one
static const double APART = 0.5;    // voxels from any other point to a new one
static const double NEAR_HULL = 0.1; // of the cube: nearer points outside are outliers

// How many photographs may be wrong about a place.
static int wrong_allowed(const struct orl_hull_points *hull)
{
    return (int)(hull->count / WRONG_ONE_IN);
}

// --- silhouettes ---

enum orl_silhouette_test orl_silhouette_ask(const struct orl_silhouette *s,
                                            const double world[3], double pixel[2])
{
    double depth;
    if (!orl_view_project(&s->view, world, pixel, &depth) ||
        !(pixel[0] >= 0 && pixel[1] >= 0 && pixel[0] < s->mask.width && pixel[1] < s->mask.height))
        return ORL_SILHOUETTE_UNSEEN;
    return s->mask.u8[(size_t)pixel[1] * (size_t)s->mask.width + (size_t)pixel[0]]
               ? ORL_SILHOUETTE_INSIDE
               : ORL_SILHOUETTE_OUTSIDE;
}

static bool excludes(const struct orl_silhouette *s, const double world[3])
{
    double pixel[2];
    return orl_silhouette_ask(s, world, pixel) == ORL_SILHOUETTE_OUTSIDE;
}

static bool is_outside(const struct orl_hull_points *hull, const double world[3])
{
    int against = 0, most = wrong_allowed(hull);
    for (size_t i = 0; i < hull->count && against <= most; i++)
        against += excludes(&hull->silhouettes[i], world);
    return against > most;
}

static enum orl_result mark_outside(const struct orl_log *log, const struct orl_points *points,
                                    struct orl_hull_points *hull)
{
    hull->outside = orl_array(log, points->count, sizeof *hull->outside);
    ORL_TRY_MEMORY(hull->outside);
    double all = 0, outside = 0;
    for (size_t i = 0; i < points->count; i++) {
        const float *p = points->position[i];
        int others = points->photographs[i] > 1 ? points->photographs[i] - 1 : 0;
        hull->outside[i] = is_outside(hull, (double[3]){(double)p[0], (double)p[1], (double)p[2]});
        outside += hull->outside[i] ? others : 0;
        all += others;
    }
    hull->outside_share = all > 0 ? outside / all : 0;
    return ORL_OK;
}

// --- parts of the cube ---

// Marks a voxel that is inside by 2 and puts it on the stack.
static void visit(uint8_t *inside, size_t index, uint32_t *stack, size_t *height)
{
    if (inside[index] != 1)
        return;
    inside[index] = 2;
    stack[(*height)++] = (uint32_t)index;
}

// Keeps the parts that hold points: others were left by chance, where few silhouettes overlap.
static enum orl_result keep_parts(const struct orl_log *log, const struct orl_points *points,
                                  struct orl_hull_points *hull)
{
    const struct orl_hull *cube = &hull->cube;
    uint8_t *inside = hull->inside;
    size_t side = (size_t)cube->side, count = orl_hull_voxels(cube), height = 0, index;
    const size_t step[3] = {1, side, side * side};
    uint32_t *stack = orl_array(log, count, sizeof *stack);
    ORL_TRY_MEMORY(stack);
    for (size_t i = 0; i < points->count; i++)
        if (!hull->outside[i] && orl_hull_find(cube, points->position[i], &index))
            visit(inside, index, stack, &height);
    while (height > 0) {
        index = stack[--height];
        const size_t at[3] = {index % side, index / side % side, index / (side * side)};
        for (int k = 0; k < 3; k++) {
            if (at[k] > 0)
                visit(inside, index - step[k], stack, &height);
            if (at[k] + 1 < side)
                visit(inside, index + step[k], stack, &height);
        }
    }
    for (size_t i = 0; i < count; i++)
        inside[i] = inside[i] == 2;
    free(stack);
    return ORL_OK;
}

// --- the cube ---

// The middle and the longest extent of the points inside all silhouettes.
static enum orl_result find_extent(const struct orl_log *log, const struct orl_points *points,
                                   const bool *outside, double middle[3], double *extent)
{
    float *sorted = orl_array(log, points->count, sizeof *sorted);
    *extent = 0;
    ORL_TRY_MEMORY(sorted);
    for (int k = 0; k < 3; k++) {
        size_t count = 0;
        for (size_t i = 0; i < points->count; i++)
            if (!outside[i])
                sorted[count++] = points->position[i][k];
        if (!count)
            break;
        qsort(sorted, count, sizeof *sorted, orl_order_floats);
        size_t cut = (size_t)(OUTERMOST * (double)count);
        double low = (double)sorted[cut], high = (double)sorted[count - 1 - cut];
        middle[k] = 0.5 * (low + high);
        *extent = fmax(*extent, high - low);
    }
    free(sorted);
    return ORL_OK;
}

// The finest size of a pixel at the middle, over the photographs.
static double pixel_size(const struct orl_hull_points *hull, const double middle[3])
{
    double least = INFINITY, pixel[2], depth;
    for (size_t i = 0; i < hull->count; i++) {
        const struct orl_view *view = &hull->silhouettes[i].view;
        if (orl_view_project(view, middle, pixel, &depth))
            least = fmin(least, depth / fmax(view->camera.fx, view->camera.fy));
    }
    return least;
}

enum orl_result orl_hull_points_begin(const struct orl_log *log,
                                      const struct orl_silhouette *silhouettes, size_t count,
                                      const struct orl_points *points, size_t max_bytes,
                                      struct orl_hull_points *hull)
{
    double middle[3] = {0}, extent = 0;
    *hull = (struct orl_hull_points){.silhouettes = silhouettes, .count = count};
    enum orl_result result = mark_outside(log, points, hull);
    ORL_THEN(result, find_extent(log, points, hull->outside, middle, &extent));
    if (result != ORL_OK || !(extent > 0))
        return result;
    double size = ROOM * extent, voxel = VOXEL_PX * pixel_size(hull, middle);
    double most = max_bytes ? fmin(cbrt((double)max_bytes / VOXEL_BYTES), SIDE_MAX) : SIDE_MAX;
    int side = (int)fmax(fmin(ceil(size / voxel), most), SIDE_MIN);
    hull->cube = (struct orl_hull){.side = side, .voxel = size / side};
    for (int k = 0; k < 3; k++)
        hull->cube.origin[k] = middle[k] - 0.5 * size;
    hull->inside = orl_array(log, orl_hull_voxels(&hull->cube), 1);
    hull->through = orl_array(log, orl_hull_voxels(&hull->cube), 1);
    ORL_TRY_MEMORY(hull->inside && hull->through);
    for (size_t i = 0; i < orl_hull_voxels(&hull->cube); i++) {
        double centre[3];
        orl_hull_centre(&hull->cube, i, centre);
        hull->inside[i] = !is_outside(hull, centre);
    }
    return ORL_OK;
}

void orl_hull_points_finish(struct orl_hull_points *hull)
{
    free(hull->inside);
    free(hull->through);
    free(hull->outside);
    *hull = (struct orl_hull_points){0};
}

// --- depth maps ---

void orl_hull_points_see(struct orl_hull_points *hull, size_t which,
                         const struct orl_depth_map *map)
{
    const struct orl_silhouette *s = &hull->silhouettes[which];
    size_t count = hull->through ? orl_hull_voxels(&hull->cube) : 0;
    for (size_t i = 0; i < count; i++) {
        double centre[3], pixel[2], depth;
        orl_hull_centre(&hull->cube, i, centre);
        if (!hull->inside[i] || hull->through[i] == UINT8_MAX || excludes(s, centre) ||
            !orl_view_project(&map->view, centre, pixel, &depth) ||
            !(pixel[0] >= 0 && pixel[1] >= 0 && pixel[0] < map->depth.width &&
              pixel[1] < map->depth.height))
            continue;
        double seen = (double)map->depth.f32[(size_t)pixel[1] * (size_t)map->depth.width +
                                             (size_t)pixel[0]];
        hull->through[i] += seen > depth + THROUGH * hull->cube.voxel; // no depth is 0
    }
}

// --- the surface ---

// Smooths lines of `side` values that lie `step` apart, by the binomial filter 1 4 6 4 1.
static void smooth_line(float *at, size_t step, int side)
{
    float line[SIDE_MAX + 4] = {0};
    for (int i = 0; i < side; i++)
        line[i + 2] = at[(size_t)i * step];
    for (int i = 0; i < side; i++)
        at[(size_t)i * step] = (line[i] + line[i + 4] + 4 * (line[i + 1] + line[i + 3]) +
                                6 * line[i + 2]) / 16;
}

// The surface, smoothed over the steps of the voxels. No triangles: what is left is thinner than three
// voxels everywhere, and smoothing takes it.
static enum orl_result make_surface(const struct orl_log *log, const struct orl_hull_points *hull,
                                    struct orl_mesh *mesh)
{
    const struct orl_hull *cube = &hull->cube;
    size_t side = (size_t)cube->side, count = orl_hull_voxels(cube);
    float *field = orl_array(log, count, sizeof *field);
    ORL_TRY_MEMORY(field);
    for (size_t i = 0; i < count; i++)
        field[i] = hull->inside[i];
    for (size_t a = 0; a < side * side; a++)
        smooth_line(field + side * a, 1, cube->side);
    for (size_t a = 0; a < side * side; a++)
        smooth_line(field + a % side + side * side * (a / side), side, cube->side);
    for (size_t a = 0; a < side * side; a++)
        smooth_line(field + a, side * side, cube->side);
    bool any = false;
    for (size_t i = 0; i < count; i++) {
        field[i] = 0.5f - field[i];
        any = any || field[i] < 0;
    }
    enum orl_result result = any ? orl_hull_field_mesh(log, cube, field, 0, mesh) : ORL_OK;
    free(field);
    return result;
}

// --- points ---

// True if the cube cuts the hull off here.
static bool is_cut(const struct orl_hull *cube, const float position[3])
{
    bool cut = false;
    for (int k = 0; k < 3; k++) {
        double at = ((double)position[k] - cube->origin[k]) / cube->voxel;
        cut = cut || !(at > 1 && at < cube->side - 1);
    }
    return cut;
}

// `surface` has room for as many points as the mesh has vertices.
static void surface_points(const struct orl_hull *cube, const struct orl_mesh *mesh, struct orl_points *surface)
{
    surface->count = 0;
    for (size_t i = 0; i < mesh->vertex_count; i++)
        if (orl_point_usable(mesh->position[i]) && !is_cut(cube, mesh->position[i])) {
            memcpy(surface->position[surface->count], mesh->position[i], sizeof mesh->position[i]);
            memcpy(surface->normal[surface->count++], mesh->normal[i], sizeof mesh->normal[i]);
        }
}

// Drops the points that are within `reach` of another cloud.
static enum orl_result drop_near(const struct orl_log *log, const struct orl_points *others,
                                 double reach, struct orl_points *points)
{
    size_t left = 0;
    if (!others->count || !points->count)
        return ORL_OK;
    int *found = orl_array(log, points->count, sizeof *found);
    float *dist2 = orl_array(log, points->count, sizeof *dist2);
    enum orl_result result = found && dist2 ? orl_points_nearest(log, others, points, found, dist2)
                                            : ORL_ERR_MEMORY;
    for (size_t i = 0; result == ORL_OK && i < points->count; i++)
        if ((double)dist2[i] > reach * reach)
            orl_points_copy(points, i, points, left++);
    if (result == ORL_OK)
        points->count = left;
    free(found);
    free(dist2);
    return result;
}

// `count` points of a cloud, which stay its own.
static struct orl_points part_of(const struct orl_points *points, size_t first, size_t count)
{
    return (struct orl_points){.count = count, .position = points->position + first, .normal = points->normal + first,
                               .radius = points->radius + first, .color = points->color + first,
                               .photographs = points->photographs + first};
}

static enum orl_result replace_points(const struct orl_log *log, const struct orl_hull_points *hull,
                                      const struct orl_mesh *mesh, struct orl_points *points,
                                      size_t *added)
{
    struct orl_points all; // what lies inside, outside and on the surface, one after the other
    size_t inside = 0, to[2] = {0};
    ORL_TRY(orl_points_init(log, &all, points->count + mesh->vertex_count));
    for (size_t i = 0; i < points->count; i++)
        inside += !hull->outside[i];
    to[true] = inside;
    for (size_t i = 0; i < points->count; i++)
        orl_points_copy(points, i, &all, to[hull->outside[i]]++);
    struct orl_points in = part_of(&all, 0, inside), out = part_of(&all, inside, points->count - inside);
    struct orl_points surface = part_of(&all, points->count, mesh->vertex_count);
    surface_points(&hull->cube, mesh, &surface);
    enum orl_result result = drop_near(log, &surface, NEAR_HULL * hull->cube.side * hull->cube.voxel, &out);
    ORL_THEN(result, drop_near(log, &in, APART * hull->cube.voxel, &surface));
    if (result != ORL_OK) {
        orl_points_finish(&all);
        return result;
    }
    *added = in.count + out.count;
    for (size_t i = 0; i < surface.count; i++)
        orl_points_copy(&surface, i, &all, *added + i);
    all.count = *added + surface.count;
    orl_points_finish(points);
    *points = all;
    return ORL_OK;
}

enum orl_result orl_hull_points_end(const struct orl_log *log, struct orl_hull_points *hull,
                                    struct orl_points *points, size_t *added)
{
    struct orl_mesh mesh = {0};
    bool any = false;
    *added = points->count;
    if (!hull->through)
        return ORL_OK;
    for (size_t i = 0; i < orl_hull_voxels(&hull->cube); i++)
        hull->inside[i] = hull->inside[i] && hull->through[i] <= wrong_allowed(hull);
    enum orl_result result = keep_parts(log, points, hull);
    for (size_t i = 0; i < orl_hull_voxels(&hull->cube); i++)
        any = any || hull->inside[i];
    if (result != ORL_OK || !any)
        return result;
    result = make_surface(log, hull, &mesh);
    if (result == ORL_OK && mesh.triangle_count)
        result = replace_points(log, hull, &mesh, points, added);
    orl_mesh_finish(&mesh);
    return result;
}
