// Image filters from OpenCV, behind C: bridge.cpp is the only C++ file of Oriel.
// No C++ exception leaves it.
#ifndef ORL_BRIDGE_BRIDGE_H
#define ORL_BRIDGE_BRIDGE_H

#include "core/image.h"

#ifdef __cplusplus
extern "C" {
#endif

// Gaussian of `taps` x `taps` pixels (odd, [1, 255]) and standard deviation
// sigma_px > 0, normalised; the border pixel is repeated outward. F32, any channels.
enum orl_result orl_bridge_blur(const struct orl_log *log, const struct orl_image *image, int taps,
                                double sigma_px, struct orl_image *blurred) ORL_CHECK_RESULT;
// Another size: pixel area average where it shrinks, bilinear where it grows. U8 is
// averaged as stored and rounded.
enum orl_result orl_bridge_resize(const struct orl_log *log, const struct orl_image *image,
                                  int width, int height,
                                  struct orl_image *resized) ORL_CHECK_RESULT;


// Tone mapping operators over a whole picture, with OpenCV's defaults; the brightest
// hundredth of Mantiuk's result is clipped.
enum orl_tonemap { ORL_TONEMAP_DRAGO, ORL_TONEMAP_MANTIUK };
// F32 x3 of finite light from 0 on, in any unit; linear light in [0, 1] comes out.
enum orl_result orl_bridge_tonemap(const struct orl_log *log, const struct orl_image *image,
                                   enum orl_tonemap kind,
                                   struct orl_image *mapped) ORL_CHECK_RESULT;
// The picture as seen through `map`: F32 x2 per pixel of the result, the position in
// `image` in pixels, centres at whole numbers. Bilinear; black outside.
enum orl_result orl_bridge_remap(const struct orl_log *log, const struct orl_image *image,
                                 const struct orl_image *map,
                                 struct orl_image *remapped) ORL_CHECK_RESULT;

#ifdef __cplusplus
}
#endif

#endif
