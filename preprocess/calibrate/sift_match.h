// Nearest SIFT descriptors, by brute force.
#ifndef ORL_PREPROCESS_SIFT_MATCH_H
#define ORL_PREPROCESS_SIFT_MATCH_H

#include "oriel/common.h"

enum { ORL_SIFT_SIZE = 128 }; // bytes of a descriptor

// Descriptors of SIFT, of length 512 as COLMAP stores them.
struct orl_descriptors {
    const uint8_t *data;
    size_t count;
};

// The nearest of a feature among those of another photograph: dot products with the nearest two, -1
// where there is none, and the index of the nearest.
struct orl_nearest {
    int32_t best, second;
    uint32_t index;
};

// `from` as 16-bit numbers, which multiply and add in pairs in one instruction (pmaddwd).
void orl_sift_widen(const uint8_t *from, size_t count, int16_t *to);
// Fills of_a for each of `a`, and of_b for each of `b`, both widened.
void orl_sift_nearest(const int16_t *a, size_t a_count, const int16_t *b, size_t b_count,
                      struct orl_nearest *of_a, struct orl_nearest *of_b);
// Is feature i of `a` a match: each other's nearest, within 0.7 radians, and nearer than 0.8 times the
// next nearest, as COLMAP has it?
bool orl_sift_is_match(const struct orl_nearest *of_a, const struct orl_nearest *of_b, size_t i);

#endif
