// The stage mesh: a triangle mesh of the scene, made by COLMAP (docs/how/pipeline.md).
#ifndef ORL_PREPROCESS_CLOUD_MESH_STAGE_H
#define ORL_PREPROCESS_CLOUD_MESH_STAGE_H

#include "preprocess/job/job.h"

// Writes SCENE/mesh.ply as params->mesh asks. ORL_ERR_EXTERNAL: COLMAP failed, or was built without
// the mesher.
enum orl_result orl_stage_mesh(struct orl_job *job, json_t *record) ORL_CHECK_RESULT;

#endif
