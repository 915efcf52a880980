#include "io/stream.h"

#include <string.h>

static const uint8_t png[] = {0x89, 'P', 'N', 'G', '\r', '\n', 0x1a, '\n'};
static const uint8_t jpeg[] = {0xff, 0xd8, 0xff};

static size_t big_endian(const uint8_t *bytes, int count)
{
    size_t value = 0;
    for (int i = 0; i < count; i++)
        value = value << 8 | bytes[i];
    return value;
}

// These return the length of the file that begins here; 0: it does not end within the bytes.

static size_t png_length(const uint8_t *bytes, size_t count)
{
    enum { FRAME = 12 }; // of a chunk: length and kind before its data, a checksum after them
    size_t at = sizeof png;
    while (count - at >= FRAME) {
        size_t size = big_endian(bytes + at, 4) + FRAME;
        bool last = memcmp(bytes + at + 4, "IEND", 4) == 0;
        if (size > count - at)
            return 0;
        at += size;
        if (last)
            return at;
    }
    return 0;
}

static size_t jpeg_length(const uint8_t *bytes, size_t count)
{
    size_t at = 2;
    while (at + 2 <= count) {
        uint8_t marker = bytes[at + 1];
        if (bytes[at] != 0xff || marker == 0 || marker == 0xff || (marker >= 0xd0 && marker <= 0xd7))
            at++; // data of a scan, in which 0xff is followed by 0 or by a marker to restart at; filling
        else if (marker == 0xd9)
            return at + 2;
        else if (at + 4 > count)
            return 0;
        else
            at += 2 + big_endian(bytes + at + 2, 2); // a segment, which may hold a thumbnail's markers
    }
    return 0;
}

bool orl_stream_find_picture(const uint8_t *bytes, size_t count, size_t *begin, size_t *length)
{
    for (*begin = 0; *begin < count; ++*begin) {
        const uint8_t *here = bytes + *begin;
        size_t left = count - *begin;
        // A beginning that the bytes cut off may become one.
        if (memcmp(here, png, left < sizeof png ? left : sizeof png) == 0) {
            *length = left < sizeof png ? 0 : png_length(here, left);
            return *length > 0;
        }
        if (memcmp(here, jpeg, left < sizeof jpeg ? left : sizeof jpeg) == 0) {
            *length = left < sizeof jpeg ? 0 : jpeg_length(here, left);
            return *length > 0;
        }
    }
    *length = 0;
    return false;
}
