// From light back to photographs.
#ifndef ORL_RENDER_REEXPOSE_H
#define ORL_RENDER_REEXPOSE_H

#include "core/image.h"
#include "scene/scene.h"

// The 8-bit picture that a photograph of the scene would have shown of `light`: F32 x3 in
// the scene's units (white at the middle exposure is 1), seen by the photograph's camera
// or one of its field of view. Its exposure (gain, which holds white balance too),
// vignetting and response curve are applied; then it is clipped and rounded to the nearest
// of the curve's 256 values. Without a response curve: sRGB.
enum orl_result orl_photo_expose(const struct orl_log *log, const struct orl_scene *scene,
                                 size_t photo, const struct orl_image *light,
                                 struct orl_image *picture) ORL_CHECK_RESULT;

// From the colours of aligned photographs (F32 x3, not radiance) to what this photograph
// would have shown of them, in place: the inverse of photo_aligned in photo.glsl.
void orl_photo_unalign(const struct orl_photo *photo, struct orl_image *color);

#endif
