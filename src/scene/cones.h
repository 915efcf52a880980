// The visual hull: the largest shape consistent with all silhouettes, on a grid of voxels, and on the cones of its
// silhouettes: each camera's partial hull as signed distances.
#ifndef ORL_SCENE_CONES_H
#define ORL_SCENE_CONES_H

#include "oriel/camera.h"
#include "oriel/image.h"
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
    bool endless; // silhouettes leave room without end, and the cube cuts the hull off
};

enum { ORL_HULL_SIDE_MIN = 2, ORL_HULL_SIDE_MAX = 1024 };

size_t orl_hull_voxels(const struct orl_hull *cube);
void orl_hull_centre(const struct orl_hull *cube, size_t index, double centre[3]);
// The voxel that holds a position; false: it is beyond the cube.
bool orl_hull_find(const struct orl_hull *cube, const float position[3], size_t *index);
// Warns about a hull that is endless.
void orl_hull_warn_endless(const struct orl_log *log);

// Makes the surface, with normals, where a field is 0 that is negative inside: it has a value at each
// voxel's centre of the cube, x fastest. At most about `triangles` (0: unlimited).
enum orl_result orl_hull_field_mesh(const struct orl_log *log, const struct orl_hull *cube,
                                    const float *field, size_t triangles,
                                    struct orl_mesh *mesh) ORL_CHECK_RESULT;

// --- cones ---

// Distances to a cone are told apart up to so many voxels.
#define ORL_CONES_MAX 4.0

// One camera's partial hull.
struct cone {
    struct orl_view view;
    struct orl_image distance; // F32 x1: signed distance to the outline, pixels, positive outside
    bool open;                 // the subject leaves the picture
};

struct cones {
    struct cone *all; // owned
    size_t count;
    struct orl_hull cube; // contains what all of them have in common, with a small margin
};

enum orl_result orl_cone_make(const struct orl_log *log, const struct orl_silhouette *silhouette,
                              struct cone *cone) ORL_CHECK_RESULT;
// With a cube of side^3 voxels. ORL_ERR_DATA: a silhouette is empty, or the silhouettes have no place in common.
enum orl_result orl_cones_make(const struct orl_log *log, const struct orl_silhouette *silhouettes,
                               size_t count, int side, struct cones *cones) ORL_CHECK_RESULT;
void orl_cones_finish(struct cones *cones);
// Intersects all cones: at each voxel's centre of their cube the signed distance to the nearest cone, scene units,
// negative inside. The caller frees *field.
enum orl_result orl_cones_field(const struct orl_log *log, const struct cones *cones,
                                float **field) ORL_CHECK_RESULT;
// Makes the hull's surface, with normals, of at most about `triangles` (0: unlimited). *said: that
// the hull has no end has been said, which is said once; NULL: it is not said.
enum orl_result orl_cones_mesh(const struct orl_log *log, const struct orl_silhouette *silhouettes,
                               size_t count, int side, size_t triangles, bool *said,
                               struct orl_mesh *mesh) ORL_CHECK_RESULT;

#endif
