// scene.json and .oriel/stages.json (docs/formats.md).
#ifndef ORL_SCENE_MANIFEST_H
#define ORL_SCENE_MANIFEST_H

#include <jansson.h>

#include "scene/scene.h"

#define ORL_MANIFEST_VERSION 1

// Parses a JSON object of at most 64 MiB, released with json_decref. Errors name
// the file, line, byte and reason.
enum orl_result orl_json_read(const struct orl_log *log, const char *path,
                              json_t **out) ORL_CHECK_RESULT;
// Indented, keys in order of insertion; written whole or not at all.
enum orl_result orl_json_write(const struct orl_log *log, const char *path,
                               const json_t *value) ORL_CHECK_RESULT;

// Sets what scene.json says of each photograph of `scene`; warns when the file at
// points_path is not the one that it names by checksum.
enum orl_result orl_manifest_read(const struct orl_log *log, const char *path,
                                  const char *points_path,
                                  struct orl_scene *scene) ORL_CHECK_RESULT;
// Its part of "tuned"; called by orl_manifest_read.
enum orl_result orl_manifest_read_tuned(const struct orl_log *log, const char *path,
                                        const json_t *root,
                                        struct orl_scene *scene) ORL_CHECK_RESULT;
// What is "ground": null where there is none. New.
json_t *orl_manifest_ground(const struct orl_ground *ground);
// Sets "tuned" of a method in DIR/scene.json; takes over `record`, whose "settings" has
// option keys and numbers. ORL_ERR_NOT_FOUND: there is no scene.json.
enum orl_result orl_manifest_write_tuned(const struct orl_log *log, const char *dir,
                                         const char *method, json_t *record) ORL_CHECK_RESULT;
// ORL_OK when prepare never worked on this folder; else ORL_ERR_DATA, logged with
// the first stage that is missing.
enum orl_result orl_manifest_check_unfinished(const struct orl_log *log,
                                              const char *dir) ORL_CHECK_RESULT;

#endif
