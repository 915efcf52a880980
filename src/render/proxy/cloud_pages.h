// Private to src/render: the part of a cloud with levels of detail that a view needs, on the device.
#ifndef ORL_RENDER_CLOUD_PAGES_H
#define ORL_RENDER_CLOUD_PAGES_H

#include "render/proxy/cloud.h"
#include "scene/point_lod.h"

// Which pages are in the cloud's one chunk. `lod` must outlive it. max_bytes: of device memory;
// 0: as many pages as one chunk may have.
enum orl_result orl_cloud_pages_init(struct orl_gpu *gpu, const struct orl_lod *lod,
                                     size_t max_bytes, struct cloud *cloud) ORL_CHECK_RESULT;
void orl_cloud_pages_finish(struct cloud_pages **pages);
// Chooses the coarsest pages that have enough points in each pixel of the view, or coarser ones where there
// is no room, and brings those to the device that are not there. No point is drawn of any other page.
enum orl_result orl_cloud_pages_choose(const struct cloud *cloud,
                                       const struct orl_view *view) ORL_CHECK_RESULT;

#endif
