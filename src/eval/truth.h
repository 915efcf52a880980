// True radiance of synthetic photographs (docs/reference/synthetic.md), as a scene sees it.
#ifndef ORL_EVAL_TRUTH_H
#define ORL_EVAL_TRUTH_H

#include "oriel/image.h"
#include "scene/colmap.h"
#include "oriel/scene.h"

struct orl_truth {
    const struct orl_scene *scene;  // not owned
    char *dir;                      // owned
    double *ev;                     // owned; per photograph of the scene: its true exposure
    struct orl_colmap_model model;  // the calibrated cameras, with their distortion; or empty
};

// dir: what `oriel synth` wrote beside the photographs, with synth.json and radiance/.
// Without SCENE/.oriel/calibrate, which says how photographs were undistorted, they count
// as they were taken, with a warning, if their sizes agree.
enum orl_result orl_truth_open(const struct orl_log *log, const struct orl_scene *scene,
                               const char *dir, struct orl_truth *truth) ORL_CHECK_RESULT;
void orl_truth_finish(struct orl_truth *truth);
// Radiance where a photograph was taken, F32 x3, undistorted to its pixels, in the scene's
// units: white at the scene's middle exposure is 1.
enum orl_result orl_truth_read(const struct orl_log *log, const struct orl_truth *truth,
                               size_t photo, struct orl_image *radiance) ORL_CHECK_RESULT;

#endif
