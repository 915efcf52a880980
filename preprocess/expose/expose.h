// Exposures of photographs, and the series that they form.
#ifndef ORL_PREPROCESS_EXPOSE_H
#define ORL_PREPROCESS_EXPOSE_H

#include "oriel/camera.h"
#include "oriel/log.h"
#include "preprocess/job/exposure_list.h"

// A photograph, as far as its exposure goes. Its response, gain and vignetting are those of struct orl_photo.
struct orl_exposed {
    const char *name; // of the undistorted file in the folder of photographs
    struct orl_view view;
    enum orl_exposure_source from;
    bool known; // true when ev is set
    bool test;  // held out
    double ev;  // log2 of exposure
    int series; // by orl_exposures_group, from 0, darkest first
    int camera; // index from 0; photographs of one camera share a response; -1: sRGB's
    int lens;   // index from 0; photographs with one lens share vignetting
    const float (*linear)[256]; // response, three channels; NULL: sRGB
    float gain[3], vignette[3];
    // By orl_align:
    double off_ev;  // of the gain from the exposure, also where the gain was refused; 0: unknown
    size_t samples; // observations that the gain was fitted to
    bool refused;   // the gain was not plausible, so that of the exposure is used
    double light;   // by orl_photo_metered: log2
};

// Sorted exposures whose steps are smaller than this form one series: half of the third of a stop
// in which cameras are set.
#define ORL_EXPOSURE_STEP_EV 0.17
// The same step for exposures that are estimated from the scene.
#define ORL_ESTIMATED_STEP_EV 0.5
// No scene has exposures so far from the middle one; scene.json holds gains of up to 2^19, as an exposure leaves its
// photograph 2 EV, and each channel 1 EV more.
#define ORL_EXPOSURE_FAR_EV 16

// The median and the series come from known exposures of photographs that are not held out. Other
// photographs join the nearest series. Exposures become relative to the median (unknown ones 0) unless they are
// to stay; those that are farther than ORL_EXPOSURE_FAR_EV from it become unknown, with a warning.
enum orl_result orl_exposures_group(const struct orl_log *log, struct orl_exposed *photos,
                                    size_t count, double step_ev, bool stays,
                                    int *series_count) ORL_CHECK_RESULT;

#endif
