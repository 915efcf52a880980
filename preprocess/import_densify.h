// Points for imported photographs, as prepare makes them.
#ifndef ORL_PREPROCESS_IMPORT_DENSIFY_H
#define ORL_PREPROCESS_IMPORT_DENSIFY_H

#include "preprocess/import/import_internal.h"

// Sparse points where the file of cameras has none (COLMAP: features, matches and triangulation
// with the known cameras; held-out photographs take no part), then the stages of prepare from
// densify on, which leave scene.json.
enum orl_result orl_import_densify(struct import_job *job) ORL_CHECK_RESULT;

#endif
