// FLIP: how large the difference of two pictures looks to a person who flips between them.
#ifndef ORL_EVAL_FLIP_H
#define ORL_EVAL_FLIP_H

#include "oriel/image.h"

// LDR-FLIP of Andersson et al. 2020 ("FLIP: A Difference Evaluator for Alternating Images"), at 67
// pixels per degree of visual angle as in the authors' program. a, b: U8 x3, sRGB, of one size.
// *mean: over all pixels, 0 (equal) to 1. Symmetric in a and b.
enum orl_result orl_flip_compare(const struct orl_log *log, const struct orl_image *a,
                                 const struct orl_image *b, double *mean) ORL_CHECK_RESULT;

#endif
