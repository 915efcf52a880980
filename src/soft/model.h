// Soft splats: ellipsoids whose opacity falls as a Gaussian (Kerbl 2023, 3D Gaussian splatting), each of one colour from
// all sides. They are adjusted by descent on the photographs (descent.h) and drawn by soft_raster.h.
#ifndef ORL_SOFT_MODEL_H
#define ORL_SOFT_MODEL_H

#include "oriel/points.h"
#include "scene/mesh.h"
#include "shared/soft_blocks.h"

// Values of a splat, as soft_blocks.h lists them: where they begin.
enum { ORL_SOFT_PLACE = 0, ORL_SOFT_OPACITY = 3, ORL_SOFT_SIGMA = 4, ORL_SOFT_PIXEL = 7, ORL_SOFT_TURN = 8,
       ORL_SOFT_COLOR = 12, ORL_SOFT_VALUES = 4 * ORL_SOFT_VEC4S };

struct orl_soft_model {
    float (*splats)[ORL_SOFT_VALUES]; // owned
    size_t count, capacity;
    float (*moments)[ORL_SOFT_VALUES]; // owned: running means of the gradients of all splats in a descent, then those of
                                       // their squares; NULL: zeros
};

// A splat for one of `every` points, the same for the same seed: a disc of the point's colour that is as
// large as those that it stands for.
enum orl_result orl_soft_from_points(const struct orl_log *log, const struct orl_points *points, double every,
                                     uint64_t seed, struct orl_soft_model *model) ORL_CHECK_RESULT;
// About `count` splats on a mesh, the same for the same seed: grey discs that cover it.
enum orl_result orl_soft_from_mesh(const struct orl_log *log, const struct orl_mesh *mesh, double count, uint64_t seed,
                                   struct orl_soft_model *model) ORL_CHECK_RESULT;
// Adds a round splat: place, world; sigma, scene units; sRGB colour, [0, 1].
enum orl_result orl_soft_add(const struct orl_log *log, struct orl_soft_model *model, const double place[3],
                             double sigma, float opacity, const float rgb[3]) ORL_CHECK_RESULT;
// Drops splats less opaque than this and those with values that are not finite, and all moments.
void orl_soft_drop(struct orl_soft_model *model, float opacity);
void orl_soft_finish(struct orl_soft_model *model);

// Uniform in [0, 1), the same sequence for the same seed on every machine (xorshift64).
double orl_soft_random(uint64_t *state);

#endif
