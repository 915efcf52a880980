// Silhouettes: which pixels of a photograph show the subject.
#ifndef ORL_SCENE_SILHOUETTE_H
#define ORL_SCENE_SILHOUETTE_H

#include "oriel/image.h"

// Values of a silhouette, U8 x1: outside; on the boundary (inside, next to outside); inside.
enum { ORL_ALPHA_OUT = 0, ORL_ALPHA_EDGE = 128, ORL_ALPHA_IN = 255 };

// Converts a mask of zero and nonzero values to these values, boundary included.
void orl_silhouette_mark_edges(struct orl_image *mask);

// Segments a subject before a dark background: pixels with a channel above `threshold` (0 to 254;
// negative: chosen by Otsu's method (1979) on square roots of the values). The result is 0 or
// 255, without specks. *used receives the threshold.
enum orl_result orl_silhouette_dark(const struct orl_log *log, const struct orl_image *picture,
                                    int threshold, int *used,
                                    struct orl_image *mask) ORL_CHECK_RESULT;

// --- difference from the background ---

// A background model from pictures of the place without the subject: mean and variance of each
// pixel.
struct orl_background {
    struct orl_image mean, deviation; // F32 x3, in 8-bit values; deviation holds the variance
    size_t count;                     // pictures added
};
// Adds a picture, U8 x3; all pictures must have the same size.
enum orl_result orl_background_add(const struct orl_log *log, struct orl_background *background,
                                   const struct orl_image *picture) ORL_CHECK_RESULT;
void orl_background_finish(struct orl_background *background);

struct orl_difference_params {
    double sigmas;        // a pixel off by more standard deviations is the subject's, > 0
    double deviation_min; // least standard deviation (noise, coding), in 8-bit values, > 0
    double shadow;        // a shadow scales a pixel's value by at least this factor, (0, 1]
    double light;         // reflected light scales it by at most this factor, >= 1
};
#define ORL_DIFFERENCE_DEFAULTS .sigmas = 6, .deviation_min = 4, .shadow = 0.6, .light = 1.2
// Segments the subject by distortion of colour and brightness (Horprasert 1999): a darker or
// slightly lighter version of the background is a shadow or reflection, not the subject. The result
// is 0 or 255, after opening, closing and removal of specks and small holes.
enum orl_result orl_silhouette_difference(const struct orl_log *log,
                                          const struct orl_background *background,
                                          const struct orl_difference_params *params,
                                          const struct orl_image *picture,
                                          struct orl_image *mask) ORL_CHECK_RESULT;

#endif
