// Vectors of three doubles.
#ifndef ORL_CORE_VEC3_H
#define ORL_CORE_VEC3_H

#include <math.h>

static inline double orl_dot3(const double a[3], const double b[3])
{
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}

// `out` must differ from a and b.
static inline void orl_cross3(const double a[3], const double b[3], double out[3])
{
    out[0] = a[1] * b[2] - a[2] * b[1];
    out[1] = a[2] * b[0] - a[0] * b[2];
    out[2] = a[0] * b[1] - a[1] * b[0];
}

// Makes v a unit vector and returns its previous length. A zero vector stays zero.
static inline double orl_normalize3(double v[3])
{
    double length = sqrt(orl_dot3(v, v));
    for (int k = 0; k < 3 && length > 0; k++)
        v[k] /= length;
    return length;
}

#endif
