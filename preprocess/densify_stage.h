// The stage densify of a job: depth maps by the built-in stereo (preprocess/densify, which works on
// any COLMAP workspace) or by COLMAP's stereo.
#ifndef ORL_PREPROCESS_DENSIFY_STAGE_H
#define ORL_PREPROCESS_DENSIFY_STAGE_H

#include "preprocess/densify/densify.h"
#include "preprocess/job/job.h"

// What the stereo does by the options of prepare.
struct orl_densify_params orl_densify_settings(const struct orl_prepare_params *params);
// Makes SCENE/stereo ready for the parts of the built-in stereo (orl_densify_begin); for COLMAP's,
// which has no parts, it does nothing.
enum orl_result orl_stage_densify_begin(struct orl_job *job) ORL_CHECK_RESULT;

#endif
