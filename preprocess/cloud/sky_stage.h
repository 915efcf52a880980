// The skies that photographs show.
#ifndef ORL_PREPROCESS_SKY_STAGE_H
#define ORL_PREPROCESS_SKY_STAGE_H

#include "preprocess/job/job.h"
#include "oriel/scene.h"

// Sets `sky` and `sky_spread` of each training photograph. The sky is what is smooth, bright or blue,
// lies beside the points and reaches the upper border of the picture; upwards is as in
// scene/sky.h. Held-out photographs are not read, and count as without a sky.
enum orl_result orl_skies_find(const struct orl_log *log,
                               struct orl_scene *scene) ORL_CHECK_RESULT;
// Sets "skies" of `record`: by name, "sky" of each photograph that shows it.
enum orl_result orl_stage_sky(struct orl_job *job, json_t *record) ORL_CHECK_RESULT;

#endif
