// Points for imported photographs, made as prepare makes them.
#ifndef ORL_PREPROCESS_IMPORT_DENSIFY_H
#define ORL_PREPROCESS_IMPORT_DENSIFY_H

#include "preprocess/calibrate/pairs.h"
#include "preprocess/import/import_internal.h"

// Makes sparse points where the file of cameras has none (COLMAP's features, matches and
// triangulation with the known cameras, without held-out photographs). Then runs the stages of
// prepare from densify on, which write scene.json.
enum orl_result orl_import_densify(struct import_job *job) ORL_CHECK_RESULT;
// Which pairs of photographs that are not held out are worth matching: all where they are few, else each
// with those that are nearest among those that look the same way. Indices are those of import->views. *list
// is released with orl_pairs_finish.
enum orl_result orl_import_pairs(const struct import_job *import,
                                 struct orl_pair_list *list) ORL_CHECK_RESULT;

#endif
