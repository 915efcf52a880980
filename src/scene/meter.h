// A photograph's colours at the scene's exposure, and the light in it as a camera meters it.
#ifndef ORL_SCENE_METER_H
#define ORL_SCENE_METER_H

#include "oriel/image.h"
#include "oriel/scene.h"

// Brings linear colour to the scene's exposure. Written in GLSL as photo_aligned of
// shaders/gather/sample/srgb.glsl, which says why. Increases with `value` in [0, 1].
float orl_light_aligned(float gain, float value);

// Squared distance of a place of a picture, pixels, from the principal point, in half diagonals.
double orl_squared_radius(const struct orl_camera *camera, double x, double y);
// Relative illumination at a place of a picture that `camera` took, pixels (orl_photo.vignette): a tenth at least,
// since the polynomial may fall below 0 beside the samples that it was fitted to.
float orl_illumination(const float vignette[3], const struct orl_camera *camera, double x,
                       double y);

// A weighted mean of luminance. Zero-initialised, it holds nothing.
struct orl_meter {
    double light, weight;
};

// Adds a linear colour at (x, y) of a picture of this size. The weight falls from the centre as in
// centre-weighted metering, the usual one of cameras. Colour counts as white at most, since a
// photograph shows no more.
void orl_meter_add(struct orl_meter *meter, const float rgb[3], double x, double y, int width,
                   int height);
// log2 of the mean luminance; black counts as 2^-16, and so does an empty meter.
double orl_meter_log2(const struct orl_meter *meter);
// Meters a picture, F32 x3, linear.
double orl_picture_metered(const struct orl_image *color);

// --- the light that a scene is shown in: the exposure and white balance of one of its photographs ---

// Makes gains relative to the photograph of this name (with or without extension), so that aligned
// photographs appear in its exposure and white balance and it keeps its own colours. Call before a
// renderer is created. NULL: the light stays. ORL_ERR_ARGUMENT: there is no such photograph, or it
// is held out, so that its pixels are not known.
enum orl_result orl_scene_set_light(const struct orl_log *log, struct orl_scene *scene,
                                    const char *photo) ORL_CHECK_RESULT;

#endif
