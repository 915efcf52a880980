// scene.json and .oriel/stages.json (docs/reference/files.md).
#ifndef ORL_SCENE_MANIFEST_H
#define ORL_SCENE_MANIFEST_H

#include <jansson.h>

#include "oriel/scene.h"

#define ORL_MANIFEST_VERSION 1

// Sets what scene.json says of each photograph of `scene`; warns when points.ply or the sparse
// model is not what it names by checksum.
enum orl_result orl_manifest_read(const struct orl_log *log, const char *path,
                                  struct orl_scene *scene) ORL_CHECK_RESULT;
// Compares all `files` that DIR/scene.json names by checksum; each that is missing or changed
// is logged as an error and counted in *bad.
enum orl_result orl_manifest_check(const struct orl_log *log, const char *dir, size_t *bad,
                                   size_t *files) ORL_CHECK_RESULT;
// What is "ground": null where there is none. New.
json_t *orl_manifest_ground(const struct orl_ground *ground);
// ORL_OK when prepare never worked on this folder; else ORL_ERR_DATA, logged with
// the first stage that is missing.
enum orl_result orl_manifest_check_unfinished(const struct orl_log *log,
                                              const char *dir) ORL_CHECK_RESULT;

#endif
