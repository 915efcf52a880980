// What a photograph looks like at a small size and how sharp it is, to find photographs of one
// view, copies, and blurred ones.
#ifndef ORL_PREPROCESS_LOOK_H
#define ORL_PREPROCESS_LOOK_H

#include "oriel/image.h"

enum { ORL_LOOK_WIDTH = 96, ORL_LOOK_HEIGHT = 72 };

struct orl_look {
    float sharpness; // log2 of the ratio of fine to coarse detail, in the direction with least;
                     // INFINITY where there is too little detail to tell
    uint8_t luma[ORL_LOOK_WIDTH * ORL_LOOK_HEIGHT]; // the whole picture, at this size
};

// luma: U8 x1, of 64 x 64 pixels at least.
enum orl_result orl_look_make(const struct orl_log *log, const struct orl_image *luma,
                              struct orl_look *look) ORL_CHECK_RESULT;
// True when most of what has texture looks alike at any exposure. For a camera that stood still
// nearly all does; for photographs of a turntable 16 degrees apart, half does.
bool orl_look_same_view(const struct orl_look *a, const struct orl_look *b);
// True when the pictures are the same but for what encoding and noise do: nearly all that has
// texture is alike, at the same exposure.
bool orl_look_same_picture(const struct orl_look *a, const struct orl_look *b);
// The sharpness below which a photograph counts as blurred, among `count` others like it.
// Photographs whose sharpness is infinite, since they have too little detail to tell, do not count.
enum orl_result orl_look_blurred_below(const struct orl_log *log, const struct orl_look *looks,
                                       size_t count, float *limit) ORL_CHECK_RESULT;

#endif
