// A photograph at reduced size, and what of it lies beside the points.
#ifndef ORL_PREPROCESS_REDUCED_H
#define ORL_PREPROCESS_REDUCED_H

#include "oriel/image.h"
#include "oriel/scene.h"

struct orl_reduced {
    struct orl_view view;
    struct orl_image picture; // sRGB, 8 bits
    bool *open;               // owned: pixels without points
};

// Reads a photograph, its longer side at most `side` pixels. On success and failure alike, the caller
// must call orl_reduced_finish.
enum orl_result orl_reduced_read(const struct orl_log *log, const struct orl_scene *scene,
                                 size_t photo, int side, struct orl_reduced *out) ORL_CHECK_RESULT;
void orl_reduced_finish(struct orl_reduced *reduced);

#endif
