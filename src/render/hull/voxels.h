// Private to src/render: a cube of voxels that holds the scene's surfaces, carved from silhouettes
// or filled from points.
#ifndef ORL_RENDER_VOXELS_H
#define ORL_RENDER_VOXELS_H

#include "render/frame/frame.h"
#include "scene/cones.h"

struct voxels {
    struct orl_hull cube;
    // At each voxel's centre, x fastest, scene units: of a hull the signed distance to the nearest
    // cone of a silhouette, negative inside; of points -voxel where there are some, else voxel.
    float *field;         // side^3; owned
    float (*centre)[3];   // of the voxels at the surface, world; owned
    size_t count;         // of these
};

// What the voxels of this frame would be made of: equal keys mean equal voxels.
uint64_t orl_voxels_key(const struct frame *frame);
// Lists the photographs that this frame may use and that have silhouettes. The caller frees *photos.
enum orl_result orl_voxels_silhouettes(const struct frame *frame, size_t **photos, size_t *count) ORL_CHECK_RESULT;
// Carves the voxels from the silhouettes of the photographs that this frame may use: the AND of the
// partial hulls of all cameras (Goldluecke 2003, section 2). A voxel stays if its centre may be the
// subject's. Where there are no silhouettes, voxels with points in them stay, but not for a `hull`.
// ORL_ERR_DATA: the silhouettes have no place in common. ORL_ERR_NOT_FOUND: neither silhouettes nor
// points that may do.
enum orl_result orl_voxels_make(const struct frame *frame, bool hull, struct voxels *voxels);
void orl_voxels_finish(struct voxels *voxels);

// Side of the cube of this frame.
int orl_voxels_side(const struct frame *frame);

// --- the steps of carving, for prefetch.c ---

// Reads the silhouettes of these photographs into masks[], one for each photograph of the scene, and makes their
// cones. The caller releases both, also after a failure.
enum orl_result orl_cones_read(const struct orl_log *log, const struct orl_scene *scene, const size_t *photos,
                               size_t count, int side, struct orl_image *masks, struct cones *cones) ORL_CHECK_RESULT;
// Asks the device for the intersection of all cones, as orl_cones_field. The caller destroys *field.
// Does not wait for the device.
enum orl_result orl_cones_carve(struct orl_gpu *gpu, const struct cones *cones,
                                struct orl_buf **field) ORL_CHECK_RESULT;

// Reads what orl_cones_carve gave. The surface is not listed yet.
enum orl_result orl_voxels_read(const struct orl_log *log, const struct cones *cones,
                                const struct orl_buf *field, struct voxels *voxels) ORL_CHECK_RESULT;
// Lists the voxels that stay and touch one that does not: work of the processor alone.
enum orl_result orl_voxels_list(const struct orl_log *log, struct voxels *voxels) ORL_CHECK_RESULT;

// As orl_voxels_make for given cones (carve) or points (fill).
enum orl_result orl_voxels_carve(struct orl_gpu *gpu, const struct cones *cones, struct voxels *voxels);
enum orl_result orl_voxels_fill(const struct orl_log *log, const struct orl_points *points,
                                int side, struct voxels *voxels);

#endif
