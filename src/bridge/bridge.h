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

#ifdef __cplusplus
}
#endif

#endif
