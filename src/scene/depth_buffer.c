#include "scene/depth_buffer.h"

#include <math.h>
#include <stdlib.h>

#include "core/memory.h"

enum {
    SIDE_MAX = 512,
    SPLAT_MAX = 6, // largest half side of a point
};
// Fraction of depth. Points are drawn flat and facing the camera, unlike the surfaces.
static const double DEPTH_TOLERANCE = 0.02;

static void splat(struct orl_depth_buffer *buffer, const double pixel[2], double depth,
                  double radius)
{
    int x = (int)floor(pixel[0] * buffer->scale), y = (int)floor(pixel[1] * buffer->scale);
    int r = (int)fmin(radius * buffer->scale + 0.5, SPLAT_MAX);
    for (int j = y - r < 0 ? 0 : y - r; j <= y + r && j < buffer->height; j++)
        for (int i = x - r < 0 ? 0 : x - r; i <= x + r && i < buffer->width; i++) {
            float *z = &buffer->z[(size_t)j * (size_t)buffer->width + (size_t)i];
            *z = fminf(*z, (float)depth);
        }
}

bool orl_view_shows(const struct orl_view *view, const double world[3], double pixel[2],
                    double *depth)
{
    return orl_view_project(view, world, pixel, depth) && pixel[0] >= 0 && pixel[1] >= 0 &&
           pixel[0] < view->camera.width && pixel[1] < view->camera.height;
}

bool orl_point_project(const struct orl_view *view, const float position[3], double pixel[2],
                       double *depth)
{
    const double world[3] = {(double)position[0], (double)position[1], (double)position[2]};
    return orl_view_shows(view, world, pixel, depth);
}

enum orl_result orl_depth_buffer_draw(const struct orl_log *log, const struct orl_view *view,
                                      const struct orl_points *points,
                                      struct orl_depth_buffer *buffer)
{
    const struct orl_camera *c = &view->camera;
    int side = c->width > c->height ? c->width : c->height;
    buffer->scale = fmin(1, (double)SIDE_MAX / side);
    buffer->width = (int)ceil(c->width * buffer->scale);
    buffer->height = (int)ceil(c->height * buffer->scale);
    size_t count = (size_t)buffer->width * (size_t)buffer->height;
    buffer->z = orl_array(log, count, sizeof *buffer->z);
    ORL_TRY_MEMORY(buffer->z);
    for (size_t i = 0; i < count; i++)
        buffer->z[i] = INFINITY;
    for (size_t i = 0; i < points->count; i++) {
        double pixel[2], depth;
        if (orl_point_project(view, points->position[i], pixel, &depth))
            splat(buffer, pixel, depth, (double)points->radius[i] * c->fx / depth);
    }
    return ORL_OK;
}

void orl_depth_buffer_finish(struct orl_depth_buffer *buffer)
{
    free(buffer->z);
    buffer->z = NULL;
}

bool orl_depth_buffer_shows(const struct orl_depth_buffer *buffer, const double pixel[2],
                            double depth)
{
    int x = (int)(pixel[0] * buffer->scale), y = (int)(pixel[1] * buffer->scale);
    if (x < 1 || y < 1 || x + 1 >= buffer->width || y + 1 >= buffer->height)
        return false;
    for (int j = y - 1; j <= y + 1; j++)
        for (int i = x - 1; i <= x + 1; i++)
            if ((double)buffer->z[(size_t)j * (size_t)buffer->width + (size_t)i] <
                depth * (1 - DEPTH_TOLERANCE))
                return false;
    return true;
}
