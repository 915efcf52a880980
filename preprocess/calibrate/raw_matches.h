// Oriel's own matching of all features of chosen pairs, on the CPU. COLMAP verifies what it finds.
#ifndef ORL_PREPROCESS_RAW_MATCHES_H
#define ORL_PREPROCESS_RAW_MATCHES_H

#include "preprocess/calibrate/database.h"
#include "preprocess/calibrate/pairs.h"
#include "preprocess/job/threads.h"

// Writes matches of the pairs into the database. `names` are the photographs' names there. Pairs that
// have matches keep them. The features of all photographs of the pairs are in memory at once.
// progress: its progress, as of the step "matching".
enum orl_result orl_raw_matches_write(const struct orl_log *log, const struct orl_each *progress,
                                      struct orl_database *db, const char *const *names,
                                      size_t photo_count, const struct orl_pair *pairs,
                                      size_t count) ORL_CHECK_RESULT;

#endif
