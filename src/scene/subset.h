// A new scene folder with some of another scene's photographs.
#ifndef ORL_SCENE_SUBSET_H
#define ORL_SCENE_SUBSET_H

#include <jansson.h>

#include "oriel/scene.h"

struct orl_subset {
    const struct orl_log *log;
    const struct orl_scene *scene;
    const bool *keep;                // per photograph of the scene
    const struct orl_points *points; // of the new scene; NULL: the scene's points.ply
    const char *dir;                 // the new folder
    // The scene's own manifest with the photographs that stay, their counts, and the checksums of the files that
    // are in `dir` so far. The caller writes it last, as DIR/scene.json, and releases it with json_decref.
    json_t *manifest;
};
// Writes what all photographs of the scene share: points, meshes, and the sparse model of the photographs that stay.
// Sets subset->manifest; that of a scene without one (a plain COLMAP workspace) has the least that a scene needs.
// ORL_ERR_DATA: the sparse model has other photographs than when the scene was opened.
enum orl_result orl_subset_begin(struct orl_subset *subset) ORL_CHECK_RESULT;
// Adds the checksum of DIR/name, which the caller wrote, to the manifest.
enum orl_result orl_subset_add_checksum(const struct orl_subset *subset, const char *name) ORL_CHECK_RESULT;
// Copies all files of one photograph, and those of each time step of a sequence, but none that already has a
// checksum.
enum orl_result orl_subset_copy_photo(const struct orl_subset *subset, size_t photo) ORL_CHECK_RESULT;

#endif
