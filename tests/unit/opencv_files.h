// OpenCV's own readers and writers, to compare ours with.
#ifndef ORL_TESTS_OPENCV_FILES_H
#define ORL_TESTS_OPENCV_FILES_H

#include <stdbool.h>

#ifdef __cplusplus
extern "C" {
#endif

// Reads a picture of exactly this size as RGB floats, as stored.
bool test_opencv_read_rgb(const char *path, int width, int height, float *rgb);
// Writes RGB samples; the format follows from the extension.
bool test_opencv_write_rgb16(const char *path, int width, int height, const unsigned short *rgb);

#ifdef __cplusplus
}
#endif

#endif
