// Preemptive matching (Wu 2013, "Towards linear-time incremental structure from motion", 3): the few
// features of largest scale of two photographs tell whether all of them are worth matching.
#ifndef ORL_PREPROCESS_PREEMPT_H
#define ORL_PREPROCESS_PREEMPT_H

#include "oriel/log.h"
#include "oriel/progress.h"
#include "preprocess/calibrate/sift_match.h"

enum { ORL_PREEMPT_FEATURES = 256 };

struct orl_preempt_pair {
    uint32_t a, b; // indices
    int matches;   // what comes out
};
// Counts the matches (orl_sift_is_match) among the first ORL_PREEMPT_FEATURES of both photographs of
// each pair, on all processors. The pairs should be in order of `a`.
enum orl_result orl_preempt_match_all(const struct orl_log *log,
                                      const struct orl_progress *progress,
                                      const struct orl_descriptors *photos,
                                      struct orl_preempt_pair *pairs,
                                      size_t count) ORL_CHECK_RESULT;

#endif
