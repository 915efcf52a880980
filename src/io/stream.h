// Pictures that follow one another in a stream, as cameras and FFmpeg's image2pipe write them.
#ifndef ORL_IO_STREAM_H
#define ORL_IO_STREAM_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

// Finds the first whole PNG or JPEG file in the bytes: true, and it begins at *begin and has *length
// bytes. False: more bytes are needed, and what is before *begin is of no such file.
bool orl_stream_find_picture(const uint8_t *bytes, size_t count, size_t *begin, size_t *length);

#endif
