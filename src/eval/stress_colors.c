// Which photographs show a point, and the colours that they give it.
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "core/memory.h"
#include "core/vec3.h"
#include "eval/stress_internal.h"
#include "scene/nearest_points.h"

static const int cell_px = 4;         // side of the cells whose nearest point hides others
static const double same_depth = 0.02; // fraction of depth, at least
static const double same_cells = 3;   // sizes of a cell: surfaces at up to some 70 degrees

// How finely a photograph shows a point, whether or not something hides it, and where; 0: outside.
static double detail_in(const struct orl_photo *photo, const struct orl_points *points,
                        size_t point, double at[2], double *z)
{
    const struct orl_camera *camera = &photo->view.camera;
    const float *p = points->position[point], *n = points->normal[point];
    double world[3] = {(double)p[0], (double)p[1], (double)p[2]}, way[3];
    if (photo->test || !orl_view_project(&photo->view, world, at, z) || at[0] < 0 || at[1] < 0 ||
        at[0] >= camera->width || at[1] >= camera->height)
        return 0;
    orl_pose_centre(&photo->view.cam_from_world, way);
    for (int k = 0; k < 3; k++)
        way[k] -= world[k];
    double distance = orl_normalize3(way);
    double facing = way[0] * (double)n[0] + way[1] * (double)n[1] + way[2] * (double)n[2];
    return fmax(facing, 1e-3) * camera->fx / distance;
}

int orl_stress_photo_of(const struct stress_case *c, size_t point, int pixel[2])
{
    int best = -1;
    double most = 0;
    for (size_t i = 0; i < c->scene.photo_count; i++) {
        double at[2], z;
        double detail = detail_in(&c->scene.photos[i], &c->scene.points, point, at, &z);
        if (detail <= most)
            continue;
        most = detail;
        best = (int)i;
        pixel[0] = (int)at[0];
        pixel[1] = (int)at[1];
    }
    return best;
}

// --- colours ---

struct painting {
    struct orl_points *points;
    double *detail;  // per point: of the photograph that gave its colour; 0: none has
    float *nearest;  // per cell of one photograph
};

static size_t cell_of(const struct orl_photo *photo, const double at[2])
{
    size_t columns = (size_t)(photo->view.camera.width / cell_px) + 1;
    return (size_t)at[1] / (size_t)cell_px * columns + (size_t)at[0] / (size_t)cell_px;
}

static size_t cells_of(const struct orl_photo *photo)
{
    const struct orl_camera *camera = &photo->view.camera;
    return (size_t)(camera->width / cell_px + 1) * (size_t)(camera->height / cell_px + 1);
}

// Gives a photograph's colours to the points that it shows more finely than others do.
static void paint_from(struct painting *p, const struct orl_photo *photo,
                       const struct orl_image *picture)
{
    double at[2], z, slack = fmax(same_depth, same_cells * cell_px / photo->view.camera.fx);
    for (size_t k = 0; k < cells_of(photo); k++)
        p->nearest[k] = INFINITY;
    for (size_t i = 0; i < p->points->count; i++)
        if (detail_in(photo, p->points, i, at, &z) > 0) {
            float *nearest = &p->nearest[cell_of(photo, at)];
            *nearest = fminf(*nearest, (float)z);
        }
    for (size_t i = 0; i < p->points->count; i++) {
        double detail = detail_in(photo, p->points, i, at, &z);
        if (detail <= p->detail[i] || z > (1 + slack) * (double)p->nearest[cell_of(photo, at)])
            continue;
        p->detail[i] = detail;
        memcpy(p->points->color[i],
               picture->u8 + 3 * ((size_t)at[1] * (size_t)picture->width + (size_t)at[0]), 3);
    }
}

// Points that no photograph shows take the colour of the nearest one that a photograph shows.
static enum orl_result paint_hidden(const struct orl_log *log, struct painting *p)
{
    struct orl_points shown = {0}, hidden = {0};
    size_t count = p->points->count, shown_count = 0, at = 0;
    for (size_t i = 0; i < count; i++)
        shown_count += p->detail[i] > 0;
    if (shown_count == 0 || shown_count == count)
        return ORL_OK;
    int *found = orl_array(log, count - shown_count, sizeof *found);
    float *dist2 = orl_array(log, count - shown_count, sizeof *dist2);
    enum orl_result result = found && dist2 ? orl_points_init(log, &shown, shown_count)
                                            : ORL_ERR_MEMORY;
    if (result == ORL_OK)
        result = orl_points_init(log, &hidden, count - shown_count);
    for (size_t i = 0, to = 0; result == ORL_OK && i < count; i++) {
        if (p->detail[i] > 0)
            orl_points_copy(p->points, i, &shown, to++);
        else
            orl_points_copy(p->points, i, &hidden, at++);
    }
    if (result == ORL_OK)
        result = orl_points_nearest(log, &shown, &hidden, found, dist2);
    at = 0;
    for (size_t i = 0; result == ORL_OK && i < count; i++)
        if (!(p->detail[i] > 0))
            memcpy(p->points->color[i], shown.color[found[at++]], 3);
    orl_points_finish(&shown);
    orl_points_finish(&hidden);
    free(found);
    free(dist2);
    return result;
}

enum orl_result orl_stress_color_points(const struct orl_log *log, const struct orl_image *photos,
                                        struct orl_scene *scene)
{
    size_t cells = 0;
    for (size_t i = 0; i < scene->photo_count; i++)
        cells = cells_of(&scene->photos[i]) > cells ? cells_of(&scene->photos[i]) : cells;
    struct painting p = {.points = &scene->points,
                         .detail = orl_array(log, scene->points.count, sizeof *p.detail),
                         .nearest = orl_array(log, cells, sizeof *p.nearest)};
    enum orl_result result = p.detail && p.nearest ? ORL_OK : ORL_ERR_MEMORY;
    for (size_t i = 0; result == ORL_OK && i < scene->photo_count; i++)
        if (!scene->photos[i].test)
            paint_from(&p, &scene->photos[i], &photos[i]);
    if (result == ORL_OK)
        result = paint_hidden(log, &p);
    free(p.detail);
    free(p.nearest);
    return result;
}
