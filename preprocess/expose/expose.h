// Exposures of photographs, and the series that they form.
#ifndef ORL_PREPROCESS_EXPOSE_H
#define ORL_PREPROCESS_EXPOSE_H

#include "oriel/log.h"

struct orl_exposure {
    bool known;  // in: true when ev is set
    bool test;   // in: held out; excluded from the median and the series
    double ev;   // in: log2 of exposure; out, unless it is to stay: relative to the median, 0 if unknown
    int series;  // out: from 0, darkest first
};

// Sorted exposures whose steps are smaller than this form one series: half of the third of a stop
// in which cameras are set.
#define ORL_EXPOSURE_STEP_EV 0.17
// The same step for exposures that are estimated from the scene.
#define ORL_ESTIMATED_STEP_EV 0.5

// The median and the series come from known exposures of photographs that are not held out. Other
// photographs join the nearest series. Returns the number of series.
enum orl_result orl_exposures_group(const struct orl_log *log, struct orl_exposure *exposures,
                                    size_t count, double step_ev, bool stays,
                                    int *series_count) ORL_CHECK_RESULT;

#endif
