// Vectors of locally aggregated descriptors (Jegou et al. 2010): one vector a photograph, so that
// photographs of one thing have vectors alike. The words are the scene's own.
#ifndef ORL_PREPROCESS_VLAD_H
#define ORL_PREPROCESS_VLAD_H

#include "preprocess/calibrate/pairs.h"

enum { ORL_VLAD_WORDS = 64, ORL_VLAD_SIZE = ORL_VLAD_WORDS * 128 };

// ORL_VLAD_SIZE numbers a photograph, of length 1 or, without features, 0. *vectors is released with
// free().
enum orl_result orl_vlad(const struct orl_log *log, const struct orl_pair_photo *photos,
                         size_t count, uint32_t seed, float **vectors) ORL_CHECK_RESULT;
// Cosine of the angle between two photographs' vectors.
float orl_vlad_similarity(const float *vectors, size_t a, size_t b);

#endif
