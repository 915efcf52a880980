// Descriptors as SIFT's: 128 bytes each, of length 512, that are alike by a known amount.
#ifndef ORL_TESTS_SIFT_LIKE_H
#define ORL_TESTS_SIFT_LIKE_H

#include <math.h>
#include <stdint.h>

enum { SIFT_SIZE = 128 };

// Sum of uniform numbers: mean 0, variance 1, from a generator that every machine has alike.
static inline float sift_noise(uint32_t *state)
{
    float sum = -6;
    for (int i = 0; i < 12; i++) {
        *state = *state * 1664525u + 1013904223u;
        sum += (float)(*state >> 8) / (float)(1 << 24);
    }
    return sum;
}

// Feature number `id`, which correlates by `alike` [0, 1] with what it is elsewhere; the rest is noise.
static inline void sift_write(uint8_t *out, uint32_t id, float alike, uint32_t *noise)
{
    uint32_t own = id * 2654435761u + 12345;
    float values[SIFT_SIZE], sum = 0;
    for (int k = 0; k < SIFT_SIZE; k++) {
        float v = 2 + alike * sift_noise(&own) + sqrtf(1 - alike * alike) * sift_noise(noise);
        values[k] = v > 0 ? v : 0;
        sum += values[k] * values[k];
    }
    for (int k = 0; k < SIFT_SIZE; k++) {
        float v = roundf(512 * values[k] / sqrtf(sum));
        out[k] = v > 255 ? 255 : (uint8_t)v;
    }
}

#endif
