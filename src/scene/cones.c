#include "scene/cones.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "bridge/bridge.h"
#include "core/memory.h"

void orl_cones_finish(struct cones *cones)
{
    for (size_t i = 0; i < cones->count; i++)
        orl_image_finish(&cones->all[i].distance);
    free(cones->all);
    memset(cones, 0, sizeof *cones);
}

enum orl_result orl_cones_make(const struct orl_log *log, const struct orl_silhouette *silhouettes,
                               size_t count, struct cones *cones)
{
    memset(cones, 0, sizeof *cones);
    enum orl_result result = orl_hull_find_bounds(log, silhouettes, count, &cones->bounds);
    if (result != ORL_OK)
        return result;
    cones->all = orl_array(log, count, sizeof *cones->all);
    if (!cones->all)
        return ORL_ERR_MEMORY;
    cones->count = count;
    for (size_t i = 0; result == ORL_OK && i < count; i++) {
        struct cone *cone = &cones->all[i];
        cone->view = silhouettes[i].view;
        result = orl_silhouette_is_open(log, &silhouettes[i].mask, &cone->open);
        if (result == ORL_OK)
            result = orl_bridge_distance(log, &silhouettes[i].mask, &cone->distance);
    }
    if (result != ORL_OK)
        orl_cones_finish(cones);
    return result;
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

enum orl_result orl_cones_field(const struct orl_log *log, const struct cones *cones, int side,
                                float **field)
{
    double voxel = cones->bounds.size / side;
    float *at = *field = orl_array(log, (size_t)side * (size_t)side * (size_t)side, sizeof *at);
    if (!at)
        return ORL_ERR_MEMORY;
    for (int z = 0; z < side; z++)
        for (int y = 0; y < side; y++)
            for (int x = 0; x < side; x++) {
                const double centre[3] = {cones->bounds.origin[0] + (x + 0.5) * voxel,
                                          cones->bounds.origin[1] + (y + 0.5) * voxel,
                                          cones->bounds.origin[2] + (z + 0.5) * voxel};
                *at++ = value_at(cones, centre, ORL_CONES_MAX * voxel);
            }
    return ORL_OK;
}

enum orl_result orl_cones_mesh(const struct orl_log *log, const struct orl_silhouette *silhouettes,
                               size_t count, int side, size_t triangles, bool *said,
                               struct orl_mesh *mesh)
{
    struct cones cones;
    float *field = NULL;
    memset(mesh, 0, sizeof *mesh);
    enum orl_result result = orl_cones_make(log, silhouettes, count, &cones);
    if (result != ORL_OK)
        return result;
    if (cones.bounds.endless && said) {
        if (!*said)
            orl_hull_warn_endless(log);
        *said = true;
    }
    struct orl_hull cube = {.side = side, .voxel = cones.bounds.size / side};
    memcpy(cube.origin, cones.bounds.origin, sizeof cube.origin);
    result = orl_cones_field(log, &cones, side, &field);
    if (result == ORL_OK)
        result = orl_hull_field_mesh(log, &cube, field, triangles, mesh);
    free(field);
    orl_cones_finish(&cones);
    return result;
}
