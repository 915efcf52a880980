// Small symmetric systems.
#ifndef ORL_CORE_CHOLESKY_H
#define ORL_CORE_CHOLESKY_H

#include "oriel/common.h"

// Solves a x = b in place by Cholesky factorisation. a: n x n, row-major; only its lower half is
// used, and it is overwritten. Returns false when a is not positive definite.
bool orl_cholesky_solve(double *a, double *b, size_t n);

#endif
