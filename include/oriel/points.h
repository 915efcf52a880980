// The point cloud: one oriented disc (splat) per point.
#ifndef ORIEL_POINTS_H
#define ORIEL_POINTS_H

#include "oriel/log.h"

struct orl_points {
    size_t count;
    float (*position)[3]; // world, scene units
    float (*normal)[3];   // world, unit length, towards the photographs; 0 0 0: unknown
    float *radius;        // scene units, > 0; 0: unknown so far
    uint8_t (*color)[3];  // sRGB
    uint8_t *photographs; // how many agree on the point, 255: at least 255;
                          // 0: unknown
};

// Allocates `count` zeroed points.
enum orl_result orl_points_init(const struct orl_log *log, struct orl_points *points,
                                size_t count) ORL_CHECK_RESULT;
void orl_points_finish(struct orl_points *points);
// Copies all attributes of point i of `from` to point k of `to`. `to` may be `from`.
void orl_points_copy(const struct orl_points *from, size_t i, struct orl_points *to, size_t k);
// True when the position is finite and within ORL_WORLD_MAX.
bool orl_point_usable(const float position[3]);
// Drops points that are not usable and counts them in a warning.
void orl_points_drop_unusable(const struct orl_log *log, struct orl_points *points);

// Drops points without a radius, which are not drawn; how many.
size_t orl_points_drop_flat(struct orl_points *points);

// Reads PLY, ascii or binary little endian: x y z, optional nx ny nz, red green blue, radius,
// photographs, in any order and scalar type. Other properties and elements are skipped. Files of 3D
// and 2D Gaussian splatting (f_dc_0 .. 2, opacity, scale_0 .. 1 or 2) become opaque discs, those
// without that are more transparent than opaque. Points that
// are not finite or beyond ORL_WORLD_MAX are dropped, and negative radii are set to 0; a warning
// counts both. `origin` is taken off the positions before they become floats, which hold seven digits;
// NULL: nothing is.
enum orl_result orl_points_read(const struct orl_log *log, const char *path, const double *origin,
                                struct orl_points *points) ORL_CHECK_RESULT;
// Writes binary little-endian PLY: x y z nx ny nz red green blue radius photographs. small: normals
// take a byte a component, which is exact to half a degree, and `photographs` is left out.
// `origin` is added to the positions, which are written as doubles unless it is 0; NULL: it is 0.
enum orl_result orl_points_write(const struct orl_log *log, const char *path,
                                 const struct orl_points *points, bool small,
                                 const double *origin) ORL_CHECK_RESULT;

#endif
