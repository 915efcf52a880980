// Silhouettes: which pixels of a photograph show the subject.
#ifndef ORL_SCENE_SILHOUETTE_H
#define ORL_SCENE_SILHOUETTE_H

#include "oriel/image.h"

// Values of a silhouette, U8 x1: outside, on the boundary (inside, next to outside), inside.
enum { ORL_ALPHA_OUT = 0, ORL_ALPHA_EDGE = 128, ORL_ALPHA_IN = 255 };

// Marks the boundary of a mask that is 0 or not.
void orl_silhouette_mark_edges(struct orl_image *mask);

// A subject before a dark ground: pixels one channel of which is above `threshold` (0 to 254;
// negative: found from the picture by Otsu's method on square roots, 1979). The result is 0 or
// 255, cleaned of specks. *used takes the threshold.
enum orl_result orl_silhouette_dark(const struct orl_log *log, const struct orl_image *picture,
                                    int threshold, int *used,
                                    struct orl_image *mask) ORL_CHECK_RESULT;

// --- difference from the background ---

// Pictures of the same place without the subject: mean and deviation of each pixel.
struct orl_background {
    struct orl_image mean, deviation; // F32 x3, values of 8 bits
    size_t count;                     // pictures added
};
// Adds a picture, U8 x3; all must have one size.
enum orl_result orl_background_add(const struct orl_log *log, struct orl_background *background,
                                   const struct orl_image *picture) ORL_CHECK_RESULT;
void orl_background_finish(struct orl_background *background);

struct orl_difference_params {
    double sigmas;        // a colour farther off than this many deviations is the subject's, > 0
    double deviation_min; // sensors' noise and coding: no pixel is steadier; values of 8 bits, > 0
    double shadow;        // a shadow leaves at least this share of a pixel's value, (0, 1]
    double light;         // and reflected light adds at most this share, >= 1
};
#define ORL_DIFFERENCE_DEFAULTS .sigmas = 6, .deviation_min = 4, .shadow = 0.6, .light = 1.2
// The subject, by distortion of colour and brightness (Horprasert 1999): what is a darker or
// slightly lighter version of the background is shadow or reflection, not subject. The result is
// 0 or 255, opened, closed, and cleaned of specks and small holes.
enum orl_result orl_silhouette_difference(const struct orl_log *log,
                                          const struct orl_background *background,
                                          const struct orl_difference_params *params,
                                          const struct orl_image *picture,
                                          struct orl_image *mask) ORL_CHECK_RESULT;

#endif
