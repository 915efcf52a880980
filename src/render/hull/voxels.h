// Private to src/render: a cube of voxels that holds the scene's surfaces, carved from silhouettes
// or filled from points.
#ifndef ORL_RENDER_VOXELS_H
#define ORL_RENDER_VOXELS_H

#include "render/proxy/mesh_proxy.h"
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

// As orl_voxels_make for given points.
enum orl_result orl_voxels_fill(const struct orl_log *log, const struct orl_points *points,
                                int side, struct voxels *voxels);

// --- voxel_proxy.c: what is carved as the proxy, drawn as billboards or as its hull ---

// State of orl_proxy_hull and orl_proxy_voxels.
struct voxel_state {
    struct mesh_state mesh;  // of orl_proxy_hull; first: see mesh_proxy.h
    uint64_t key;            // orl_voxels_key of the voxels
    bool said_endless;
    // Of orl_proxy_voxels:
    struct voxels voxels;
    struct orl_buf *centres; // voxels.centre on the device
    // Per voxel two sets of photographs, `words` words each: bit i of the first for a photograph i
    // of the scene that sees the whole of the voxel, of the second for one that sees a part. NULL
    // until they are asked for; owned.
    uint32_t *seen;
    size_t words;
};

// Finds which of the frame's photographs see which voxels of its proxy, unless that is known.
enum orl_result orl_voxels_see(const struct frame *frame, struct voxel_state *state);
// Width of a billboard, scene units: no voxel's projection reaches beyond it (Goldluecke 2003,
// section 3).
double orl_billboard_width(const struct voxel_state *state);

#endif
