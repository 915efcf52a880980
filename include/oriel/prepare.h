// From a folder of photographs to a scene: the stages of preprocess/stages.c in their order
// (docs/how/pipeline.md).
#ifndef ORIEL_PREPARE_H
#define ORIEL_PREPARE_H

#include "oriel/progress.h"
#include "oriel/prepare_params.h"

// Makes the scene in the folder OUT (params->out). COLMAP is found on PATH or named by
// $ORIEL_COLMAP; its output goes to OUT/logs/colmap.log. OUT opens as a scene only after all
// stages are complete. After a failure `resume` continues after the last complete stage. `refine` adds
// soft splats to the whole scene, unless it has too few photographs or no device can draw it.
// ORL_ERR_ARGUMENT: OUT exists already without `resume`, or bad settings.
// ORL_ERR_NOT_FOUND, ORL_ERR_DATA: too few photographs, or too few that register.
// ORL_ERR_EXTERNAL: COLMAP is missing or failed.
enum orl_result orl_prepare(const struct orl_log *log, const struct orl_prepare_params *params,
                            const struct orl_progress *progress) ORL_CHECK_RESULT;

#endif
