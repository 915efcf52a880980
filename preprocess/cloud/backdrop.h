// The backdrop: what lies behind the points.
#ifndef ORL_PREPROCESS_BACKDROP_H
#define ORL_PREPROCESS_BACKDROP_H

#include "preprocess/job/job.h"
#include "oriel/scene.h"

// Sets scene->backdrop_rests from the training photographs: whether what they show beside the points
// stays at the same place of their camera frames, as behind a turntable, although the points turn.
// Held-out photographs are not read.
enum orl_result orl_backdrop_find(const struct orl_log *log,
                                  struct orl_scene *scene) ORL_CHECK_RESULT;
// Sets "backdrop" of `record`: "rests" or "moves".
enum orl_result orl_stage_backdrop(struct orl_job *job, json_t *record) ORL_CHECK_RESULT;

#endif
