#include "scene/hull.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "bridge/bridge.h"
#include "core/memory.h"
#include "scene/isosurface.h"

enum orl_result orl_hull_init(const struct orl_log *log, struct orl_hull *hull, int side,
                              const double origin[3], double size)
{
    memset(hull, 0, sizeof *hull);
    ORL_REQUIRE(log, side >= ORL_HULL_SIDE_MIN && side <= ORL_HULL_SIDE_MAX && size > 0);
    size_t count = (size_t)side * (size_t)side * (size_t)side;
    *hull = (struct orl_hull){.side = side, .voxel = size / side,
                              .inside = orl_array(log, count, 1)};
    if (!hull->inside)
        return ORL_ERR_MEMORY;
    memcpy(hull->origin, origin, sizeof hull->origin);
    memset(hull->inside, 1, count);
    return ORL_OK;
}

void orl_hull_finish(struct orl_hull *hull)
{
    if (!hull)
        return;
    free(hull->inside);
    memset(hull, 0, sizeof *hull);
}

// --- one silhouette ---

enum orl_result orl_silhouette_is_open(const struct orl_log *log, const struct orl_image *mask,
                                       bool *open)
{
    int largest, at_border;
    enum orl_result result = orl_bridge_pieces(log, mask, &largest, &at_border);
    *open = result == ORL_OK && at_border > 0 && 2 * at_border >= largest;
    return result;
}

// Summed-area table of the mask: four entries tell whether any box touches the subject.
struct table {
    int width, height;
    uint32_t *sum; // (width + 1) x (height + 1)
    bool open;     // the subject leaves the picture
};

static enum orl_result table_init(const struct orl_log *log, const struct orl_image *mask,
                                  struct table *table)
{
    int w = mask->width, h = mask->height;
    *table = (struct table){.width = w, .height = h};
    table->sum = orl_array(log, (size_t)(w + 1) * (size_t)(h + 1), sizeof *table->sum);
    if (!table->sum)
        return ORL_ERR_MEMORY;
    for (int y = 0; y < h; y++) {
        uint32_t row = 0;
        const uint32_t *above = table->sum + (size_t)y * (size_t)(w + 1);
        uint32_t *here = table->sum + (size_t)(y + 1) * (size_t)(w + 1);
        for (int x = 0; x < w; x++) {
            row += mask->u8[(size_t)y * (size_t)w + (size_t)x] != 0;
            here[x + 1] = above[x + 1] + row;
        }
    }
    return orl_silhouette_is_open(log, mask, &table->open);
}

static double clamped(double v, int end)
{
    return v < 0 ? 0 : v > end ? end : v;
}

// How far a box reaches beyond the picture, pixels.
static double beyond(const struct table *t, const double low[2], const double high[2])
{
    double x = fmax(-low[0], high[0] - t->width), y = fmax(-low[1], high[1] - t->height);
    return fmax(fmax(x, y), 0);
}

// True when a pixel of the box, given in pixel coordinates, belongs to the subject or may do so
// outside the picture, where a subject that leaves it may spread by 45 degrees.
static bool any_inside(const struct table *t, const double low[2], const double high[2])
{
    double spread = t->open ? beyond(t, low, high) : 0;
    int x0 = (int)clamped(floor(low[0] - spread), t->width - (t->open && spread > 0));
    int x1 = (int)clamped(floor(high[0] + spread) + 1, t->width);
    int y0 = (int)clamped(floor(low[1] - spread), t->height - (t->open && spread > 0));
    int y1 = (int)clamped(floor(high[1] + spread) + 1, t->height);
    if (t->open && spread > 0) { // what lies wholly beyond still has the nearest row or column
        x1 = x1 > 0 ? x1 : 1;
        y1 = y1 > 0 ? y1 : 1;
    }
    const uint32_t *top = t->sum + (size_t)y0 * (size_t)(t->width + 1);
    const uint32_t *bottom = t->sum + (size_t)y1 * (size_t)(t->width + 1);
    return bottom[x1] - bottom[x0] - top[x1] + top[x0] != 0;
}

// True when the ball around a point may contain a part of the subject.
static bool leaves_room(const struct table *t, const struct orl_view *view, const double world[3],
                        double radius)
{
    const struct orl_camera *c = &view->camera;
    double cam[3], low[2], high[2];
    orl_pose_apply(&view->cam_from_world, world, cam);
    // A ball that crosses the camera's plane stays; a ball behind the camera is not seen.
    if (cam[2] <= radius)
        return cam[2] > -radius;
    const double focal[2] = {c->fx, c->fy}, centre[2] = {c->cx, c->cy};
    for (int k = 0; k < 2; k++) {
        // |(x + dx) / (z + dz) - x / z| <= (1 + |x / z|) r / (z - r) for |d| <= r.
        double at = cam[k] / cam[2], off = (1 + fabs(at)) * radius / (cam[2] - radius);
        low[k] = focal[k] * (at - off) + centre[k];
        high[k] = focal[k] * (at + off) + centre[k];
    }
    return any_inside(t, low, high);
}

enum orl_result orl_hull_carve(const struct orl_log *log, const struct orl_silhouette *silhouette,
                               struct orl_hull *hull)
{
    const struct orl_image *mask = &silhouette->mask;
    struct table table;
    ORL_REQUIRE(log, mask->type == ORL_PIXEL_U8 && mask->channels == 1 &&
                         mask->width == silhouette->view.camera.width &&
                         mask->height == silhouette->view.camera.height);
    enum orl_result result = table_init(log, mask, &table);
    double radius = 0.5 * sqrt(3.0) * hull->voxel; // of the sphere around a voxel
    uint8_t *at = hull->inside;
    for (int z = 0; result == ORL_OK && z < hull->side; z++)
        for (int y = 0; y < hull->side; y++)
            for (int x = 0; x < hull->side; x++, at++) {
                const double centre[3] = {hull->origin[0] + (x + 0.5) * hull->voxel,
                                          hull->origin[1] + (y + 0.5) * hull->voxel,
                                          hull->origin[2] + (z + 0.5) * hull->voxel};
                *at = *at && leaves_room(&table, &silhouette->view, centre, radius);
            }
    free(table.sum);
    return result;
}

// --- bounds ---

// The centre of a silhouette's bounding box and half the box's diagonal, in pixels.
struct blob {
    double centre[2], reach_px;
};

static bool find_blob(const struct orl_image *mask, struct blob *blob)
{
    int low[2] = {mask->width, mask->height}, high[2] = {-1, -1};
    const uint8_t *at = mask->u8;
    for (int y = 0; y < mask->height; y++)
        for (int x = 0; x < mask->width; x++, at++) {
            const int here[2] = {x, y};
            for (int k = 0; *at && k < 2; k++) {
                low[k] = here[k] < low[k] ? here[k] : low[k];
                high[k] = here[k] > high[k] ? here[k] : high[k];
            }
        }
    for (int k = 0; k < 2; k++)
        blob->centre[k] = 0.5 * (low[k] + high[k] + 1);
    blob->reach_px = 0.5 * hypot(high[0] - low[0] + 1, high[1] - low[1] + 1);
    return high[0] >= 0;
}

// The point nearest to the rays through the silhouettes' centres.
static bool find_centre(const struct orl_silhouette *silhouettes, const struct blob *blobs,
                        size_t count, double centre[3])
{
    struct orl_ray_meeting meeting = {0};
    for (size_t i = 0; i < count; i++) {
        double eye[3], ray[3];
        orl_pose_centre(&silhouettes[i].view.cam_from_world, eye);
        orl_view_unproject(&silhouettes[i].view, blobs[i].centre[0], blobs[i].centre[1], 1, ray);
        for (int k = 0; k < 3; k++)
            ray[k] -= eye[k];
        orl_ray_meeting_add(&meeting, eye, ray);
    }
    return orl_ray_meeting_point(&meeting, centre);
}

// The largest distance from the centre that any silhouette reaches, in scene units.
static double find_reach(const struct orl_silhouette *silhouettes, const struct blob *blobs,
                         size_t count, const double centre[3])
{
    double most = 0;
    for (size_t i = 0; i < count; i++) {
        double pixel[2], depth;
        const struct orl_view *view = &silhouettes[i].view;
        if (!orl_view_project(view, centre, pixel, &depth))
            continue;
        double px = blobs[i].reach_px + hypot(pixel[0] - blobs[i].centre[0],
                                              pixel[1] - blobs[i].centre[1]);
        most = fmax(most, px * depth / fmin(view->camera.fx, view->camera.fy));
    }
    return most;
}

// The bounding box of the hull, in voxels. False when the hull is empty.
static bool occupied(const struct orl_hull *hull, int low[3], int high[3])
{
    const uint8_t *at = hull->inside;
    for (int k = 0; k < 3; k++)
        low[k] = hull->side, high[k] = -1;
    for (int z = 0; z < hull->side; z++)
        for (int y = 0; y < hull->side; y++)
            for (int x = 0; x < hull->side; x++, at++) {
                const int here[3] = {x, y, z};
                for (int k = 0; *at && k < 3; k++) {
                    low[k] = here[k] < low[k] ? here[k] : low[k];
                    high[k] = here[k] > high[k] ? here[k] : high[k];
                }
            }
    return high[0] >= 0;
}

static enum orl_result carve_all(const struct orl_log *log,
                                 const struct orl_silhouette *silhouettes, size_t count,
                                 struct orl_hull *hull)
{
    enum orl_result result = ORL_OK;
    for (size_t i = 0; result == ORL_OK && i < count; i++)
        result = orl_hull_carve(log, &silhouettes[i], hull);
    return result;
}

// Carves a coarse cube around the centre. The result is the bounding box of the hull with a margin
// of one voxel; *cut: the hull reaches the cube's faces.
static enum orl_result try_bounds(const struct orl_log *log,
                                  const struct orl_silhouette *silhouettes, size_t count,
                                  const double centre[3], double reach, double origin[3],
                                  double *size, bool *cut)
{
    enum { COARSE = 48 };
    struct orl_hull hull;
    int low[3], high[3], most = 0;
    const double start[3] = {centre[0] - reach, centre[1] - reach, centre[2] - reach};
    enum orl_result result = orl_hull_init(log, &hull, COARSE, start, 2 * reach);
    if (result == ORL_OK)
        result = carve_all(log, silhouettes, count, &hull);
    bool any = result == ORL_OK && occupied(&hull, low, high);
    orl_hull_finish(&hull);
    if (result != ORL_OK)
        return result;
    if (!any)
        return orl_fail(log, ORL_ERR_DATA, "the silhouettes have no place in common: are "
                        "cameras and masks of the same time step?");
    *cut = false;
    for (int k = 0; k < 3; k++) {
        *cut = *cut || low[k] == 0 || high[k] == COARSE - 1;
        most = high[k] - low[k] + 3 > most ? high[k] - low[k] + 3 : most;
    }
    double voxel = 2 * reach / COARSE;
    *size = most * voxel;
    for (int k = 0; k < 3; k++)
        origin[k] = start[k] + 0.5 * (low[k] + high[k] + 1 - most) * voxel;
    return ORL_OK;
}

// Tries larger cubes while the hull reaches the cube's faces. If it does not end, specks at the
// borders of silhouettes are more likely than a large subject, and the first cube is the result.
static enum orl_result search_bounds(const struct orl_log *log,
                                     const struct orl_silhouette *silhouettes, size_t count,
                                     const double centre[3], double reach,
                                     struct orl_hull_bounds *bounds)
{
    enum { ROUNDS = 4 };
    bool cut = true;
    enum orl_result result = ORL_OK;
    for (int round = 0; result == ORL_OK && cut && round < ROUNDS; round++)
        result = try_bounds(log, silhouettes, count, centre, ldexp(reach, round), bounds->origin,
                            &bounds->size, &cut);
    bounds->endless = cut;
    if (result == ORL_OK && cut)
        result = try_bounds(log, silhouettes, count, centre, reach, bounds->origin, &bounds->size,
                            &cut);
    return result;
}

void orl_hull_warn_endless(const struct orl_log *log)
{
    orl_logf(log, ORL_LOG_WARNING, "the silhouettes leave room without end; the hull is cut off "
             "where the subject's outlines end");
}

enum orl_result orl_hull_find_bounds(const struct orl_log *log,
                                     const struct orl_silhouette *silhouettes, size_t count,
                                     struct orl_hull_bounds *bounds)
{
    double centre[3];
    struct blob *blobs = orl_array(log, count, sizeof *blobs);
    enum orl_result result = blobs ? ORL_OK : ORL_ERR_MEMORY;
    *bounds = (struct orl_hull_bounds){0};
    for (size_t i = 0; result == ORL_OK && i < count; i++)
        if (!find_blob(&silhouettes[i].mask, &blobs[i]))
            result = orl_fail(log, ORL_ERR_DATA, "silhouette %zu of %zu is empty", i + 1, count);
    if (result == ORL_OK && (count < 2 || !find_centre(silhouettes, blobs, count, centre)))
        result = orl_fail(log, ORL_ERR_DATA, "a hull needs silhouettes from two places or more");
    double reach = result == ORL_OK ? find_reach(silhouettes, blobs, count, centre) : 0;
    if (result == ORL_OK && !(reach > 0))
        result = orl_fail(log, ORL_ERR_DATA, "no camera faces what the silhouettes have in common");
    if (result == ORL_OK)
        result = search_bounds(log, silhouettes, count, centre, reach, bounds);
    free(blobs);
    return result;
}

// --- surface ---

enum orl_result orl_hull_field_mesh(const struct orl_log *log, const struct orl_hull *cube,
                                    const float *field, size_t triangles, struct orl_mesh *mesh)
{
    // Samples are the voxels' centres, with a border of samples outside the subject around.
    int n = cube->side + 2;
    size_t side = (size_t)cube->side, count = (size_t)n * (size_t)n * (size_t)n;
    memset(mesh, 0, sizeof *mesh);
    float *value = orl_array(log, count, sizeof *value);
    if (!value)
        return ORL_ERR_MEMORY;
    for (size_t i = 0; i < count; i++)
        value[i] = (float)cube->voxel;
    for (size_t z = 0; z < side; z++)
        for (size_t y = 0; y < side; y++)
            memcpy(value + 1 + (size_t)n * (y + 1 + (size_t)n * (z + 1)),
                   field + side * (y + side * z), side * sizeof *value);
    struct orl_grid grid = {.size = {n, n, n}, .spacing = cube->voxel, .value = value};
    for (int k = 0; k < 3; k++)
        grid.origin[k] = cube->origin[k] - 0.5 * cube->voxel;
    enum orl_result result = orl_isosurface(log, &grid, mesh);
    free(value);
    if (result == ORL_OK && !mesh->triangle_count)
        result = orl_fail(log, ORL_ERR_DATA, "the hull is empty");
    if (result == ORL_OK && triangles)
        result = orl_mesh_decimate(log, triangles, mesh);
    if (result == ORL_OK)
        result = orl_mesh_set_normals(log, mesh);
    if (result != ORL_OK)
        orl_mesh_finish(mesh);
    return result;
}
