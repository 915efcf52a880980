// scene.json: the results of the stages in one file. It makes the folder a scene, so it is written
// last.
#ifndef ORL_PREPROCESS_SCENE_JSON_H
#define ORL_PREPROCESS_SCENE_JSON_H

#include "oriel/scene.h"
#include "preprocess/job/job.h"

// Opens the scene as scene.json will state it, of the stages that are done, before it is written.
// The caller destroys it.
enum orl_result orl_scene_json_open(struct orl_job *job,
                                    struct orl_scene **scene) ORL_CHECK_RESULT;
enum orl_result orl_scene_json_write(struct orl_job *job) ORL_CHECK_RESULT;

#endif
