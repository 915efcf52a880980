// "tuned" of scene.json: settings of a method that suit the scene.
#ifndef ORL_SCENE_TUNED_SETTINGS_H
#define ORL_SCENE_TUNED_SETTINGS_H

#include <jansson.h>

#include "oriel/scene.h"

// Sets scene->tuned from the manifest `root`, read from the file `path`.
enum orl_result orl_tuned_read(const struct orl_log *log, const char *path, const json_t *root,
                               struct orl_scene *scene) ORL_CHECK_RESULT;
// Sets the entry of a method in "tuned" of DIR/scene.json. Takes ownership of `record`, whose
// "settings" maps option keys to numbers. ORL_ERR_NOT_FOUND: there is no scene.json.
enum orl_result orl_tuned_write(const struct orl_log *log, const char *dir, const char *method,
                                json_t *record) ORL_CHECK_RESULT;

#endif
