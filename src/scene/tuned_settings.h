// "tuned" and "render" of scene.json: how the scene is drawn best.
#ifndef ORL_SCENE_TUNED_SETTINGS_H
#define ORL_SCENE_TUNED_SETTINGS_H

#include <jansson.h>

#include "oriel/scene.h"

// Sets scene->tuned and scene->defaults from the manifest `root`, read from the file `path`.
enum orl_result orl_tuned_read(const struct orl_log *log, const char *path, const json_t *root,
                               struct orl_scene *scene) ORL_CHECK_RESULT;
// ORL_ERR_NOT_FOUND, logged: there is no DIR/scene.json. ORL_ERR_IO: it cannot be replaced.
enum orl_result orl_tuned_can_write(const struct orl_log *log, const char *dir) ORL_CHECK_RESULT;
// Sets the entry of a method in "tuned" of DIR/scene.json. Takes ownership of `record`, whose
// "settings" maps option keys to numbers or names. Fails as orl_tuned_can_write.
enum orl_result orl_tuned_write(const struct orl_log *log, const char *dir, const char *method,
                                json_t *record) ORL_CHECK_RESULT;
// The value of "render" in scene.json, a new reference.
json_t *orl_defaults_json(const struct orl_scene_defaults *defaults);

#endif
