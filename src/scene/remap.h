// Pictures without the lens's distortion, as COLMAP's image_undistorter makes them.
#ifndef ORL_SCENE_REMAP_H
#define ORL_SCENE_REMAP_H

#include "oriel/image.h"
#include "scene/colmap.h"

// Makes the picture that camera `to` would have taken from the same place, of any pixel type.
// `image` has the size of camera `from`. Resampling is bilinear, and black where `from` saw
// nothing. Where `to` is coarser, the picture is undistorted at the resolution of `from` and then
// reduced to the size of `to`, as COLMAP does.
enum orl_result orl_undistort(const struct orl_log *log, const struct orl_colmap_camera *from,
                              const struct orl_camera *to, const struct orl_image *image,
                              struct orl_image *undistorted) ORL_CHECK_RESULT;

#endif
