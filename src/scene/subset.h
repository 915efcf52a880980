// A new scene folder with some of another scene's photographs.
#ifndef ORL_SCENE_SUBSET_H
#define ORL_SCENE_SUBSET_H

#include <jansson.h>

#include "oriel/scene.h"

// Writes into the folder `dir` what all photographs of the scene share: points, mesh, and the
// sparse model of the photographs with keep[i]. *manifest is the scene's own manifest with these
// photographs, their counts and the checksums of these files. The caller copies or makes the
// pictures, writes the manifest last as DIR/scene.json, and releases it with json_decref.
// ORL_ERR_DATA: the scene has no manifest (a plain COLMAP workspace), or is a sequence.
enum orl_result orl_subset_begin(const struct orl_log *log, const struct orl_scene *scene,
                                 const bool *keep, const char *dir,
                                 json_t **manifest) ORL_CHECK_RESULT;
// Copies all files of one photograph: picture, linear version, mask, background.
enum orl_result orl_subset_copy_photo(const struct orl_log *log, const struct orl_scene *scene,
                                      size_t photo, const char *dir) ORL_CHECK_RESULT;
// Copies those files of one photograph that do not depend on its picture: mask, background.
enum orl_result orl_subset_copy_masks(const struct orl_log *log, const struct orl_scene *scene,
                                      size_t photo, const char *dir) ORL_CHECK_RESULT;

// --- the steps of orl_subset_begin ---

// Writes DIR/sparse with the photographs with keep[i]. ORL_ERR_DATA: the model has other photographs
// than when the scene was opened.
enum orl_result orl_subset_write_model(const struct orl_log *log, const struct orl_scene *scene,
                                       const bool *keep, const char *dir) ORL_CHECK_RESULT;
// Removes all photographs but those with keep[i] from the manifest `root`, and sets the counts of
// photographs.
void orl_subset_keep_photographs(const struct orl_scene *scene, const bool *keep, json_t *root);
// Sets sums[name], a JSON object's member, to the checksum of DIR/name.
enum orl_result orl_subset_add_checksum(const struct orl_log *log, const char *dir,
                                        const char *name, json_t *sums) ORL_CHECK_RESULT;
// The same for points and sparse model.
enum orl_result orl_subset_add_checksums(const struct orl_log *log, const char *dir,
                                         json_t *sums) ORL_CHECK_RESULT;

#endif
