// Converts light back to the values of photographs.
#ifndef ORL_RENDER_REEXPOSE_H
#define ORL_RENDER_REEXPOSE_H

#include "oriel/image.h"
#include "oriel/scene.h"

// The 8-bit picture that a photograph of the scene would have shown of `light`: F32 x3 in the
// scene's units (1 is white at the middle exposure), seen by the photograph's camera or one with
// its field of view. Applies the photograph's exposure (gain, which includes white balance),
// vignetting and response curve, then clips and rounds to the nearest of the curve's 256 values.
// Without a response curve: sRGB.
enum orl_result orl_photo_expose(const struct orl_log *log, const struct orl_scene *scene,
                                 size_t photo, const struct orl_image *light,
                                 struct orl_image *picture) ORL_CHECK_RESULT;

// Converts the colours of aligned photographs (F32 x3, not radiance) in place to those that this
// photograph would have shown: the inverse of photo_aligned in shaders/gather/sample/srgb.glsl.
void orl_photo_unalign(const struct orl_photo *photo, struct orl_image *color);

#endif
