// A camera's response curve, from scene points that were seen at several exposures.
#ifndef ORL_PREPROCESS_RESPONSE_H
#define ORL_PREPROCESS_RESPONSE_H

#include "preprocess/expose/samples.h"
#include "oriel/prepare_params.h"
#include "oriel/scene.h"

enum orl_response_outcome {
    ORL_RESPONSE_FOUND,
    ORL_RESPONSE_ONE_EXPOSURE, // exposures differ by less than ORL_RESPONSE_RANGE_EV
    ORL_RESPONSE_FEW_SAMPLES,  // there are few, or they cover few values
    ORL_RESPONSE_SRGB,         // sRGB explains the samples as well
};
#define ORL_RESPONSE_RANGE_EV 0.5

struct orl_response_fit {
    enum orl_response_outcome outcome;
    size_t points; // scene points seen at different exposures
    double spread_srgb_ev, spread_ev; // robust spread of a point's radiance by sRGB and by the
                                      // curve
};

// The response of the photographs of `camera`, of which it takes those whose exposure is known.
// Debevec and Malik 1997, eq. 3, with points that only some photographs show, robust against
// outliers. The curve is sRGB times the exponential of a smooth polynomial of the value. The
// polynomial continues the curve where there are no samples. It also removes an ambiguity of series
// with equal steps, which cannot show a ripple with the period of the step. Exposures may be wrong
// in single photographs as long as they are right on average. With any outcome but
// ORL_RESPONSE_FOUND the curve is sRGB.
// With ORL_RESPONSE_DEBEVEC and _ROBERTSON the curve is OpenCV's, of points that are known at every
// exposure. Vignetting is left in them, and so are outliers; exposures count as exact, and the
// curve is taken even if sRGB explains the samples as well.
enum orl_result orl_response_fit(const struct orl_log *log, enum orl_response_method method,
                                 const struct orl_samples *samples,
                                 const struct orl_exposed *photos, size_t photo_count, int camera,
                                 struct orl_response *response,
                                 struct orl_response_fit *fit) ORL_CHECK_RESULT;

// OpenCV's curves by `method`, in any unit and not always rising. *found: enough points are known at every
// exposure.
enum orl_result orl_response_opencv(const struct orl_log *log, enum orl_response_method method,
                                    const struct orl_samples *samples,
                                    const struct orl_exposed *photos, size_t photo_count, int camera,
                                    float linear[3][256], bool *found) ORL_CHECK_RESULT;

#endif
