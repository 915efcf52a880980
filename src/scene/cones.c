#include "scene/cones.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "bridge/bridge.h"
#include "core/memory.h"
#include "scene/isosurface.h"

size_t orl_hull_voxels(const struct orl_hull *cube)
{
    return (size_t)cube->side * (size_t)cube->side * (size_t)cube->side;
}

void orl_hull_centre(const struct orl_hull *cube, size_t index, double centre[3])
{
    size_t side = (size_t)cube->side;
    const size_t at[3] = {index % side, index / side % side, index / (side * side)};
    for (int k = 0; k < 3; k++)
        centre[k] = cube->origin[k] + ((double)at[k] + 0.5) * cube->voxel;
}

bool orl_hull_find(const struct orl_hull *cube, const float position[3], size_t *index)
{
    size_t at[3];
    for (int k = 0; k < 3; k++) {
        double v = floor(((double)position[k] - cube->origin[k]) / cube->voxel);
        if (!(v >= 0 && v < cube->side))
            return false;
        at[k] = (size_t)v;
    }
    *index = at[0] + (size_t)cube->side * (at[1] + (size_t)cube->side * at[2]);
    return true;
}

void orl_cones_finish(struct cones *cones)
{
    for (size_t i = 0; i < cones->count; i++)
        orl_image_finish(&cones->all[i].distance);
    free(cones->all);
    memset(cones, 0, sizeof *cones);
}

// Signed distance to the outline at a place inside the picture: between pixels' centres linear.
static double distance_at(const struct orl_image *distance, double x, double y)
{
    int w = distance->width, h = distance->height;
    double u = x - 0.5, v = y - 0.5;
    int x0 = (int)u, y0 = (int)v;
    int x1 = x0 + 1 < w ? x0 + 1 : x0, y1 = y0 + 1 < h ? y0 + 1 : y0;
    const float *top = distance->f32 + (size_t)y0 * (size_t)w;
    const float *bottom = distance->f32 + (size_t)y1 * (size_t)w;
    double along = u - x0, down = v - y0;
    return (1 - down) * ((1 - along) * (double)top[x0] + along * (double)top[x1]) +
           down * ((1 - along) * (double)bottom[x0] + along * (double)bottom[x1]);
}

// Signed distance of a place to a cone, scene units. shaders/hull/carve.comp has the same rule.
static double apart(const struct cone *cone, const double world[3])
{
    const struct orl_camera *c = &cone->view.camera;
    double cam[3];
    orl_pose_apply(&cone->view.cam_from_world, world, cam);
    if (cam[2] <= 0)
        return -cam[2]; // a camera sees nothing behind it
    const double pixel[2] = {c->fx * cam[0] / cam[2] + c->cx, c->fy * cam[1] / cam[2] + c->cy};
    const double within[2] = {fmin(fmax(pixel[0], 0.5), c->width - 0.5),
                              fmin(fmax(pixel[1], 0.5), c->height - 0.5)};
    double past = hypot(pixel[0] - within[0], pixel[1] - within[1]);
    // A subject that leaves the picture may spread by 45 degrees beyond it.
    double distance = distance_at(&cone->distance, within[0], within[1]) +
                      (cone->open && past > 0.5 ? -past : past);
    return distance * cam[2] / fmax(c->fx, c->fy);
}

static float value_at(const struct cones *cones, const double world[3], double most)
{
    double farthest = -INFINITY;
    for (size_t i = 0; i < cones->count && farthest < most; i++)
        farthest = fmax(farthest, apart(&cones->all[i], world));
    return (float)fmin(fmax(farthest, -most), most);
}

enum orl_result orl_cones_field(const struct orl_log *log, const struct cones *cones,
                                float **field)
{
    size_t count = orl_hull_voxels(&cones->cube);
    *field = orl_array(log, count, sizeof **field);
    ORL_TRY_MEMORY(*field);
    for (size_t i = 0; i < count; i++) {
        double centre[3];
        orl_hull_centre(&cones->cube, i, centre);
        (*field)[i] = value_at(cones, centre, ORL_CONES_MAX * cones->cube.voxel);
    }
    return ORL_OK;
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

// Finds the hull's bounding box on a coarse grid of the cube of this half edge around the centre. The cones' cube
// of side^3 becomes the box with a margin of one voxel of that grid; it is endless if the hull reaches the grid's faces.
static enum orl_result try_bounds(const struct orl_log *log, const double centre[3], double reach, int side,
                                  struct cones *cones)
{
    enum { COARSE = 48 };
    double voxel = 2 * reach / COARSE;
    const struct orl_hull start = {COARSE, {centre[0] - reach, centre[1] - reach, centre[2] - reach}, voxel, false};
    double room = sqrt(1.5) * voxel; // half a voxel's diagonal, seen in a picture's square
    int low[3] = {COARSE, COARSE, COARSE}, high[3] = {-1, -1, -1}, most = 0;
    float *field;
    cones->cube = start;
    ORL_TRY(orl_cones_field(log, cones, &field));
    for (int i = 0; i < COARSE * COARSE * COARSE; i++) {
        const int here[3] = {i % COARSE, i / COARSE % COARSE, i / (COARSE * COARSE)};
        for (int k = 0; (double)field[i] <= room && k < 3; k++) {
            low[k] = here[k] < low[k] ? here[k] : low[k];
            high[k] = here[k] > high[k] ? here[k] : high[k];
        }
    }
    free(field);
    if (high[0] < 0)
        return orl_fail(log, ORL_ERR_DATA, "the silhouettes have no place in common: are "
                        "cameras and masks of the same time step?");
    for (int k = 0; k < 3; k++) {
        cones->cube.endless = cones->cube.endless || low[k] == 0 || high[k] == COARSE - 1;
        most = high[k] - low[k] + 3 > most ? high[k] - low[k] + 3 : most;
    }
    cones->cube.side = side;
    cones->cube.voxel = most * voxel / side;
    for (int k = 0; k < 3; k++)
        cones->cube.origin[k] += 0.5 * (low[k] + high[k] + 1 - most) * voxel;
    return ORL_OK;
}

// Tries larger cubes while the hull reaches the cube's faces. If it does not end, specks at the
// borders of silhouettes are more likely than a large subject, and the first cube is the result.
static enum orl_result find_bounds(const struct orl_log *log, const double centre[3], double reach, int side,
                                   struct cones *cones)
{
    enum { ROUNDS = 4 };
    for (int round = 0; round < ROUNDS; round++) {
        ORL_TRY(try_bounds(log, centre, ldexp(reach, round), side, cones));
        if (!cones->cube.endless)
            return ORL_OK;
    }
    return try_bounds(log, centre, reach, side, cones);
}

void orl_hull_warn_endless(const struct orl_log *log)
{
    orl_logf(log, ORL_LOG_WARNING, "the silhouettes leave room without end; the hull is cut off "
             "where the subject's outlines end");
}

// --- the hull ---

// The point around which the hull is, and how far it may reach.
static enum orl_result find_place(const struct orl_log *log, const struct orl_silhouette *silhouettes,
                                  size_t count, double centre[3], double *reach)
{
    struct blob *blobs = orl_array(log, count, sizeof *blobs);
    enum orl_result result = blobs ? ORL_OK : ORL_ERR_MEMORY;
    for (size_t i = 0; result == ORL_OK && i < count; i++)
        if (!find_blob(&silhouettes[i].mask, &blobs[i]))
            result = orl_fail(log, ORL_ERR_DATA, "silhouette %zu of %zu is empty", i + 1, count);
    if (result == ORL_OK && (count < 2 || !find_centre(silhouettes, blobs, count, centre)))
        result = orl_fail(log, ORL_ERR_DATA, "a hull needs silhouettes from two places or more");
    *reach = result == ORL_OK ? find_reach(silhouettes, blobs, count, centre) : 0;
    if (result == ORL_OK && !(*reach > 0))
        result = orl_fail(log, ORL_ERR_DATA, "no camera faces what the silhouettes have in common");
    free(blobs);
    return result;
}

enum orl_result orl_cone_make(const struct orl_log *log, const struct orl_silhouette *silhouette,
                              struct cone *cone)
{
    int largest, at_border;
    *cone = (struct cone){.view = silhouette->view};
    ORL_TRY(orl_bridge_pieces(log, &silhouette->mask, &largest, &at_border));
    // The subject leaves the picture if the largest piece of the mask touches its border, or another one at
    // least half as large does. Smaller ones at the border are more likely things of the background that moved.
    cone->open = at_border > 0 && 2 * at_border >= largest;
    return orl_bridge_distance(log, &silhouette->mask, &cone->distance);
}

enum orl_result orl_cones_make(const struct orl_log *log, const struct orl_silhouette *silhouettes,
                               size_t count, int side, struct cones *cones)
{
    double centre[3], reach;
    memset(cones, 0, sizeof *cones);
    ORL_TRY(find_place(log, silhouettes, count, centre, &reach));
    cones->all = orl_array(log, count, sizeof *cones->all);
    ORL_TRY_MEMORY(cones->all);
    cones->count = count;
    enum orl_result result = ORL_OK;
    for (size_t i = 0; result == ORL_OK && i < count; i++)
        result = orl_cone_make(log, &silhouettes[i], &cones->all[i]);
    ORL_THEN(result, find_bounds(log, centre, reach, side, cones));
    if (result != ORL_OK)
        orl_cones_finish(cones);
    return result;
}

enum orl_result orl_cones_mesh(const struct orl_log *log, const struct orl_silhouette *silhouettes,
                               size_t count, int side, size_t triangles, bool *said,
                               struct orl_mesh *mesh)
{
    struct cones cones;
    float *field = NULL;
    memset(mesh, 0, sizeof *mesh);
    ORL_TRY(orl_cones_make(log, silhouettes, count, side, &cones));
    if (cones.cube.endless && said) {
        if (!*said)
            orl_hull_warn_endless(log);
        *said = true;
    }
    enum orl_result result = orl_cones_field(log, &cones, &field);
    ORL_THEN(result, orl_hull_field_mesh(log, &cones.cube, field, triangles, mesh));
    free(field);
    orl_cones_finish(&cones);
    return result;
}

// --- the surface ---

enum orl_result orl_hull_field_mesh(const struct orl_log *log, const struct orl_hull *cube,
                                    const float *field, size_t triangles, struct orl_mesh *mesh)
{
    // Samples are the voxels' centres, with a border of samples outside the subject around.
    int n = cube->side + 2;
    size_t side = (size_t)cube->side, count = (size_t)n * (size_t)n * (size_t)n;
    memset(mesh, 0, sizeof *mesh);
    float *value = orl_array(log, count, sizeof *value);
    ORL_TRY_MEMORY(value);
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
    ORL_THEN(result, orl_mesh_set_normals(log, mesh));
    if (result != ORL_OK)
        orl_mesh_finish(mesh);
    return result;
}
