// Private to src/render: what the next time step of a sequence needs, made while this one is drawn.
// Photographs are read ahead (photos/photo_loader.h). A thread reads the silhouettes, the device carves
// their hull between the passes of this frame and its end, and the thread makes a mesh of that. Pictures
// are the same without it.
#ifndef ORL_RENDER_PREFETCH_H
#define ORL_RENDER_PREFETCH_H

#include "render/hull/voxels.h"
#include "render/photos/photos.h"

struct prefetch;

// Starts to read what `frame` would need if it showed `time_step`. The frame's proxy must be up to
// date. What cannot be read is left to the frame that shows the time step, which says why. *out is
// NULL if files of the time step are missing.
enum orl_result orl_prefetch_create(const struct frame *frame, int time_step,
                                    struct prefetch **out) ORL_CHECK_RESULT;
// Waits for the silhouettes that are being read, and for the mesh that is being made.
void orl_prefetch_destroy(struct orl_gpu *gpu, struct prefetch **prefetch);
int orl_prefetch_time_step(const struct prefetch *prefetch);
// Asks for photographs, in this order.
void orl_prefetch_want(struct prefetch *prefetch, const size_t *photos, size_t count);
// Asks the device for the hull if its silhouettes have been read. Does not wait.
enum orl_result orl_prefetch_carve(struct orl_gpu *gpu, struct prefetch *prefetch) ORL_CHECK_RESULT;
// Gives the thread what the device has carved. Waits for the device.
enum orl_result orl_prefetch_collect(struct orl_gpu *gpu,
                                     struct prefetch *prefetch) ORL_CHECK_RESULT;

// True: the hull is the caller's. It was made for the key (orl_voxels_key) and, unless mesh is NULL,
// for a mesh. prefetch may be NULL.
bool orl_prefetch_take_hull(struct orl_gpu *gpu, struct prefetch *prefetch, uint64_t key,
                            struct voxels *voxels, struct orl_mesh *mesh);
// The photographs and masks that were read are there for the frame that is drawn now; NULL: there are
// none.
void orl_prefetch_show(struct prefetch *prefetch, struct photos *photos);

#endif
