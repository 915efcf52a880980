// True radiance of synthetic photographs (docs/reference/synthetic.md) in the pixels and units of a
// scene.
#ifndef ORL_EVAL_TRUTH_H
#define ORL_EVAL_TRUTH_H

#include "oriel/image.h"
#include "scene/colmap.h"
#include "oriel/scene.h"

struct orl_truth {
    const struct orl_scene *scene;  // not owned
    char *dir;                      // owned
    double *ev;                     // owned; true exposure of each photograph of the scene
    bool vehicle;                   // the truth says where one is
    struct orl_colmap_model model;  // the calibrated cameras with their distortion, or empty
};

// dir: the folder that `oriel synth` wrote beside the photographs, with synth.json and radiance/.
// SCENE/.oriel/calibrate holds the distortion of the photographs. Without it, radiance is used as
// taken, with a warning, and its size must be that of the photographs.
enum orl_result orl_truth_open(const struct orl_log *log, const struct orl_scene *scene,
                               const char *dir, struct orl_truth *truth) ORL_CHECK_RESULT;
void orl_truth_finish(struct orl_truth *truth);
// Radiance at a photograph's pixels, F32 x3, undistorted, in the scene's units: 1 is white at the
// scene's middle exposure.
enum orl_result orl_truth_read(const struct orl_log *log, const struct orl_truth *truth,
                               size_t photo, struct orl_image *radiance) ORL_CHECK_RESULT;
// How much of a photograph's pixel shows the vehicle, the lamp or a wire, F32 x1, undistorted. Only
// with truth->vehicle.
enum orl_result orl_truth_vehicle(const struct orl_log *log, const struct orl_truth *truth,
                                  size_t photo, struct orl_image *vehicle) ORL_CHECK_RESULT;

#endif
