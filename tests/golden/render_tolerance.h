// How much a rendering may differ between drivers: the same tolerances in the golden
// tests and in the test that they are tight enough.
#ifndef ORL_TESTS_RENDER_TOLERANCE_H
#define ORL_TESTS_RENDER_TOLERANCE_H

#include "compare.h"

// Scene-linear colour, around 0.3. A few pixels at depth edges may go either way.
static const struct golden_tolerance color_tolerance = {
    .absolute = 0.004, .relative = 0.02, .fraction = 0.005};
// Depth around 3.5 scene units.
static const struct golden_tolerance depth_tolerance = {
    .absolute = 1e-4, .relative = 1e-3, .fraction = 0.005};

#endif
