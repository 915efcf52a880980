// scene.json and .oriel/stages.json (docs/reference/files.md).
#ifndef ORL_SCENE_MANIFEST_H
#define ORL_SCENE_MANIFEST_H

#include <jansson.h>

#include "oriel/scene.h"

#define ORL_MANIFEST_VERSION 1

// Sets the fields of `scene` and its photographs that scene.json states. Warns when the sparse model
// or, where it is read (`points`), points.ply does not match its checksum.
enum orl_result orl_manifest_read(const struct orl_log *log, const char *path, bool points,
                                  struct orl_scene *scene) ORL_CHECK_RESULT;
// The same without the checksums, from the manifest `root`. Messages name `path`, where its values
// are from.
enum orl_result orl_manifest_take(const struct orl_log *log, const char *path, const json_t *root,
                                  struct orl_scene *scene) ORL_CHECK_RESULT;
// Checks every file that DIR/scene.json names by checksum, and counts these files in *files. Each
// file that is missing or changed is logged as an error and counted in *bad, but points.ply may be
// missing where there is points.lod.
enum orl_result orl_manifest_check(const struct orl_log *log, const char *dir, size_t *bad,
                                   size_t *files) ORL_CHECK_RESULT;
// Reads "room" of scene.json or cameras.json, its lowest and its highest corner; it may be missing.
enum orl_result orl_manifest_read_room(const struct orl_log *log, const char *path,
                                       const json_t *root,
                                       struct orl_room *room) ORL_CHECK_RESULT;
// The value of "room", released with json_decref; JSON null where it is not known.
json_t *orl_manifest_room(const struct orl_room *room);
// The value of "ground", released with json_decref; JSON null where there is no ground.
json_t *orl_manifest_ground(const struct orl_ground *ground);
// The value of "backdrop", released with json_decref.
json_t *orl_manifest_backdrop(bool rests);
// Of the file of soft splats in a scene, which oriel refine makes.
#define ORL_SOFT_NAME "soft.ply"
// Where it goes on, while it has not finished.
#define ORL_REFINE_STATE_NAME "refine.state"
// ORL_OK when prepare never worked on this folder. Otherwise logs the first missing stage and
// returns ORL_ERR_DATA.
enum orl_result orl_manifest_check_unfinished(const struct orl_log *log,
                                              const char *dir) ORL_CHECK_RESULT;

#endif
