// What photographs show before the scene and has no points: branches near the camera, signs, people.
// Stereo finds nothing there, so that it would be painted onto what is behind it. All other
// photographs together contradict it (as robust statistics separate passers-by in stacks of
// photographs), which is decided by region, not pixel by pixel.
#ifndef ORL_EVAL_OCCLUDER_MASKS_H
#define ORL_EVAL_OCCLUDER_MASKS_H

#include "oriel/progress.h"
#include "oriel/render.h"

// Longer side of the pictures that are compared, at most, and so that of masks, pixels.
enum { ORL_OCCLUDERS_SIDE = 384 };

// Renderings: the mean of all photographs that see a place, the best photographs of each pixel, and the points' own colours.
enum { ORL_OCCLUDER_CONSENSUS, ORL_OCCLUDER_NEAREST, ORL_OCCLUDER_POINTS, ORL_OCCLUDER_RENDERINGS };
// A photograph, and renderings of its view without it.
struct orl_occluder_pictures {
    struct orl_image photo;     // U8 x3, as are the renderings, of the same size
    struct orl_image rendered[ORL_OCCLUDER_RENDERINGS];
    struct orl_image covered;   // F32 x1: 1 where there is a surface
};
// The occluders of the photograph: regions in which it differs by much from the consensus, in square
// roots of light, if on a hundredth of the picture and half of the region's surfaces it differs from
// the nearest photographs and from the points, too, and has the structure of neither rendering of
// photographs. Errors of geometry show in the consensus alone, the nearest photographs may show
// another part of the same occluder, a surface in another light keeps its structure, and points of a
// surface that this photograph alone shows have its colours. *mask: U8 x1, 255 there, else 0; owned
// by the caller. *share: of the picture; 0: there are none, and *mask is empty.
enum orl_result orl_occluder_mask(const struct orl_log *log,
                                  const struct orl_occluder_pictures *pictures,
                                  struct orl_image *mask, double *share) ORL_CHECK_RESULT;

// The same for every training photograph of a scene, each compared with renderings from the nearest
// of the others.
// An occluder also makes the few differ that see what it hides: so the photographs are compared
// again, the most occluded first, without those that were found before. masks and shares: one for
// each photograph of the scene; those of held-out photographs stay empty. The masks are the caller's
// (orl_image_finish), also after a failure. ORL_ERR_DATA: fewer than ORL_VALIDATION_TRAIN_MIN photographs
// are for training.
enum orl_result orl_occluders_find(struct orl_gpu *gpu, const struct orl_scene *scene,
                                   const struct orl_progress *progress, struct orl_image *masks,
                                   double *shares) ORL_CHECK_RESULT;

#endif
