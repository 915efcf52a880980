// scene.json: the results of the stages in one file. It makes the folder a scene, so it is written
// last.
#ifndef ORL_PREPROCESS_SCENE_JSON_H
#define ORL_PREPROCESS_SCENE_JSON_H

#include "preprocess/job/job.h"

enum orl_result orl_scene_json_write(struct orl_job *job) ORL_CHECK_RESULT;

#endif
