// The sky of a scene: where it is, and what it looks like in the photographs.
#ifndef ORL_SCENE_SKY_H
#define ORL_SCENE_SKY_H

#include "oriel/scene.h"

// The photograph's view, turned by quarters about its axis so that it is upright as the orientation
// says; the same pixels, none mirrored.
struct orl_view orl_photo_upright(const struct orl_photo *photo);
// The mean upward direction of the upright photographs, world. False, and 0 -1 0, where they cancel
// each other.
bool orl_scene_mean_up(const struct orl_scene *scene, double up[3]);
// The direction upwards, world, of length 1: away from the ground, or where no ground is known, the
// one to which the horizontal axes of the cameras are perpendicular. A camera may stand on its side.
void orl_scene_upwards(const struct orl_scene *scene, double up[3]);
// The mean colour of a photograph's sky in square roots of light, its light multiplied by `gain` as
// shaders do (scene/meter.h).
void orl_sky_of_photo(const struct orl_photo *photo, const float gain[3], float root[3]);
// Mean over the photographs that show the sky, but those that `skip` (NULL: none) leaves out, of
// orl_sky_of_photo. aligned: at the scene's exposure, else at their own. Returns their number; with 0
// the mean is 0.
size_t orl_skies_mean(const struct orl_scene *scene, const bool *skip, bool aligned,
                      float root[3]);
// Whether the photographs' skies are of different days, by how far they are from their mean at the
// scene's exposure.
bool orl_skies_differ(const struct orl_scene *scene);

#endif
