// The visual hull: the largest shape consistent with all silhouettes, on a grid of voxels.
#ifndef ORL_SCENE_HULL_H
#define ORL_SCENE_HULL_H

#include "oriel/image.h"
#include "oriel/camera.h"
#include "scene/mesh.h"

// A silhouette mask: U8 x1, nonzero on the subject.
struct orl_silhouette {
    struct orl_view view;
    struct orl_image mask; // of the view's size; not owned
};

// A cube of side^3 voxels, x fastest. The lowest corner of voxel i j k is
// origin + voxel * (i, j, k).
struct orl_hull {
    int side;
    double origin[3], voxel; // scene units
};

enum { ORL_HULL_SIDE_MIN = 2, ORL_HULL_SIDE_MAX = 1024 };

// True if the subject leaves the picture: the largest piece of the mask touches its border, or
// another one at least half as large does. Smaller ones at the border are more likely things of the
// background that moved.
enum orl_result orl_silhouette_is_open(const struct orl_log *log, const struct orl_image *mask,
                                       bool *open) ORL_CHECK_RESULT;

// Makes the surface, with normals, where a field is 0 that is negative inside: it has a value at each
// voxel's centre of the cube, x fastest. At most about `triangles` (0: unlimited).
enum orl_result orl_hull_field_mesh(const struct orl_log *log, const struct orl_hull *cube,
                                    const float *field, size_t triangles,
                                    struct orl_mesh *mesh) ORL_CHECK_RESULT;

#endif
