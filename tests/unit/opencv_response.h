// OpenCV's response calibration, to compare with.
#ifndef ORL_TESTS_OPENCV_RESPONSE_H
#define ORL_TESTS_OPENCV_RESPONSE_H

#include <stdbool.h>
#include <stdint.h>

#ifdef __cplusplus
extern "C" {
#endif

// `stack`: of each photograph, side x side pixels of three channels, times in seconds.
// The curve is linear light by channel and value, in any unit. False when OpenCV throws.
bool opencv_response(bool robertson, const uint8_t *stack, int photos, int side,
                     const float *times, float curve[3][256]);

#ifdef __cplusplus
}
#endif

#endif
