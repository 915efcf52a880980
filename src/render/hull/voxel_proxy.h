// Private to src/render: what is carved from silhouettes as the proxy: voxels, drawn as billboards, or
// their hull.
#ifndef ORL_RENDER_VOXEL_PROXY_H
#define ORL_RENDER_VOXEL_PROXY_H

#include "render/proxy/mesh_proxy.h"
#include "render/hull/voxels.h"

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
