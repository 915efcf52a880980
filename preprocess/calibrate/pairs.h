// Which pairs of photographs are worth matching: those that overlap, in any collection, ordered or
// not, found from the features alone and, where there are, times and positions of EXIF.
#ifndef ORL_PREPROCESS_PAIRS_H
#define ORL_PREPROCESS_PAIRS_H

#include "oriel/progress.h"
#include "preprocess/calibrate/sift_match.h"

struct orl_pair_photo {
    struct orl_features features; // the largest in scale first
    double taken_s;               // when, on one clock; NAN: unknown
    double latitude, longitude;   // degrees; NAN: unknown
};
enum { ORL_PAIR_FEATURES = 256 }; // the first of a photograph, which tell whether a pair is worth matching

struct orl_pair {
    uint32_t a, b; // indices of photographs, a < b
};
struct orl_pair_list {
    struct orl_pair *items; // owned; in order of a, then b
    size_t count;
    size_t tried;           // pairs that preemptive matching (Wu 2013) looked at
};

enum orl_result orl_pairs_choose(const struct orl_log *log, const struct orl_progress *progress,
                                 const struct orl_pair_photo *photos, size_t count, uint32_t seed,
                                 struct orl_pair_list *list) ORL_CHECK_RESULT;
void orl_pairs_finish(struct orl_pair_list *list);

#endif
