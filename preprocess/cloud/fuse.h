// Fuse: one point cloud from all depth maps, made by COLMAP.
#ifndef ORL_PREPROCESS_FUSE_H
#define ORL_PREPROCESS_FUSE_H

#include "preprocess/job/job.h"

// Writes .oriel/fused.ply.
enum orl_result orl_stage_fuse(struct orl_job *job, json_t *record) ORL_CHECK_RESULT;

#endif
