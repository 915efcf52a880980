// Matches of SIFT's features, by brute force.
#ifndef ORL_PREPROCESS_SIFT_MATCH_H
#define ORL_PREPROCESS_SIFT_MATCH_H

#include "oriel/log.h"

enum { ORL_SIFT_SIZE = 128 }; // bytes of a descriptor

// Features of a photograph.
struct orl_features {
    uint32_t id;          // COLMAP's, of the photograph; 0: not read
    uint8_t *descriptors; // of length 512 as COLMAP stores them; owned
    size_t count;
};

// Pairs of features, by index, of the first `limit` of both photographs: each other's nearest, within
// 0.7 radians, and nearer than 0.8 times the next nearest, as COLMAP has it.
struct orl_sift_matches {
    uint32_t (*items)[2]; // owned
    size_t count;
};
enum orl_result orl_sift_match(const struct orl_features *a, const struct orl_features *b, size_t limit,
                               struct orl_sift_matches *matches) ORL_CHECK_RESULT;

#endif
