// The visual hull: all that silhouettes leave room for, on a grid of voxels.
#ifndef ORL_SCENE_HULL_H
#define ORL_SCENE_HULL_H

#include "oriel/image.h"
#include "oriel/camera.h"
#include "scene/mesh.h"

// A silhouette: U8 x1, not 0 where the subject is.
struct orl_silhouette {
    struct orl_view view;
    struct orl_image mask; // of the view's size; not owned
};

// A cube of side^3 voxels, x fastest. Voxel i j k reaches from origin + voxel * (i, j, k) on.
struct orl_hull {
    int side;
    double origin[3], voxel; // scene units
    uint8_t *inside;         // side^3, 1: the voxel is part of the hull; owned
};

enum { ORL_HULL_SIDE_MIN = 2, ORL_HULL_SIDE_MAX = 1024 };

// A cube that holds everything the silhouettes leave room for, a little larger. ORL_ERR_DATA:
// a silhouette is empty, or they have no place in common.
enum orl_result orl_hull_bounds(const struct orl_log *log, const struct orl_silhouette *silhouettes,
                                size_t count, double origin[3], double *size) ORL_CHECK_RESULT;
// A full cube.
enum orl_result orl_hull_init(const struct orl_log *log, struct orl_hull *hull, int side,
                              const double origin[3], double size) ORL_CHECK_RESULT;
void orl_hull_finish(struct orl_hull *hull);
// Its AND with the partial hull of one silhouette (Goldluecke 2003, section 3). `reach` is the
// share of the voxel's circumscribed sphere that is looked at: at 1 a voxel goes only when the
// silhouette leaves room for no part of it, so the hull holds the subject; at 0 by its centre.
// Where the silhouette touches the picture's border, what lies outside the picture stays.
enum orl_result orl_hull_carve(const struct orl_log *log, const struct orl_silhouette *silhouette,
                               double reach, struct orl_hull *hull) ORL_CHECK_RESULT;
// Of all silhouettes, in the cube that orl_hull_bounds gives.
enum orl_result orl_hull_make(const struct orl_log *log, const struct orl_silhouette *silhouettes,
                              size_t count, int side, double reach,
                              struct orl_hull *hull) ORL_CHECK_RESULT;
double orl_hull_volume(const struct orl_hull *hull);
// Its surface, with normals, of at most about `triangles` (0: as many as it takes).
enum orl_result orl_hull_mesh(const struct orl_log *log, const struct orl_hull *hull,
                              size_t triangles, struct orl_mesh *mesh) ORL_CHECK_RESULT;

#endif
