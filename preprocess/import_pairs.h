// Which pairs of photographs with known cameras are worth matching.
#ifndef ORL_PREPROCESS_IMPORT_PAIRS_H
#define ORL_PREPROCESS_IMPORT_PAIRS_H

#include "preprocess/calibrate/pairs.h"
#include "preprocess/import/import_internal.h"

// Of photographs that are not held out: all pairs where they are few, else each with those that are
// nearest among those that look the same way. Indices are those of import->views. *list is released
// with orl_pairs_finish.
enum orl_result orl_import_pairs(const struct import_job *import,
                                 struct orl_pair_list *list) ORL_CHECK_RESULT;

#endif
