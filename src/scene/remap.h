// Pictures without the lens's distortion, as COLMAP's image_undistorter makes them.
#ifndef ORL_SCENE_REMAP_H
#define ORL_SCENE_REMAP_H

#include "oriel/image.h"
#include "scene/colmap.h"

// What camera `to` would have seen from the same place, of any pixel type. `image` has the
// size of camera `from`. Resampled bilinearly, black where `from` saw nothing; where `to` is
// coarser as COLMAP does: at the size of `from`, then brought to the size of `to`.
enum orl_result orl_undistort(const struct orl_log *log, const struct orl_colmap_camera *from,
                              const struct orl_camera *to, const struct orl_image *image,
                              struct orl_image *undistorted) ORL_CHECK_RESULT;

#endif
