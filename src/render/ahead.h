// Private to src/render: what the next moment of a sequence needs, made while this one is drawn. A
// thread reads its silhouettes and photographs, the device carves its hull between the passes of this
// frame and its end, and the thread makes a mesh of that. Pictures are the same without it.
#ifndef ORL_RENDER_AHEAD_H
#define ORL_RENDER_AHEAD_H

#include "render/voxels.h"

struct ahead;

// Starts to read what `frame` would need if it showed `moment`. The frame's proxy must be up to
// date. What cannot be read is left to the frame that shows the moment, which says why.
enum orl_result orl_ahead_create(const struct frame *frame, int moment,
                                 struct ahead **out) ORL_CHECK_RESULT;
// Waits for the file that is being read. Needs no orl_ahead_wait.
void orl_ahead_destroy(struct orl_gpu *gpu, struct ahead **ahead);
int orl_ahead_moment(const struct ahead *ahead);
// Asks for photographs, in this order.
void orl_ahead_want(struct ahead *ahead, const size_t *photos, size_t count);
// Asks the device for the hull if its silhouettes have been read. Does not wait.
enum orl_result orl_ahead_carve(struct orl_gpu *gpu, struct ahead *ahead) ORL_CHECK_RESULT;
// Gives the thread what the device has carved. Waits for the device.
enum orl_result orl_ahead_collect(struct orl_gpu *gpu, struct ahead *ahead) ORL_CHECK_RESULT;
// Waits until all is done that can be done without another call.
void orl_ahead_wait(struct ahead *ahead);

// True: the hull is the caller's. It was made for the key (orl_voxels_key) and, unless mesh is NULL,
// for a mesh of this many triangles. ahead may be NULL.
bool orl_ahead_take_hull(struct orl_gpu *gpu, struct ahead *ahead, uint64_t key, size_t triangles,
                         struct voxels *voxels, struct orl_mesh *mesh);
// True: the image is the caller's. ahead may be NULL. A mask is of a silhouette that takes part in
// the hull; a photograph is as orl_photo_read reads it.
bool orl_ahead_take_photo(struct ahead *ahead, size_t photo, struct orl_image *image);
bool orl_ahead_take_mask(struct ahead *ahead, size_t photo, struct orl_image *mask);

#endif
