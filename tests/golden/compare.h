// Comparison with pictures kept in the repository.
#ifndef ORL_TESTS_COMPARE_H
#define ORL_TESTS_COMPARE_H

#include "oriel/image.h"

// A sample agrees when |actual - expected| <= absolute + relative * |expected|; a pixel
// when all its samples do; pictures when at most `fraction` of the pixels disagree and
// none by more than `outlier` (0: no limit). One sample that is not finite is enough to fail.
struct golden_tolerance {
    double absolute, relative, fraction, outlier;
};

struct golden_report {
    size_t pixels, wrong;
    double worst; // largest |actual - expected|
    int x, y;     // where
};

// F32 images of any channels. False for different sizes.
bool golden_compare(const struct orl_image *actual, const struct orl_image *expected,
                    const struct golden_tolerance *tolerance, struct golden_report *report);

// Compares the channels (at most 4 per golden) with DIR/<name>.<driver>.exr, else
// DIR/<name>.exr. On a mismatch it prints a line to stderr and writes
// <name>.actual.exr and <name>.diff.exr into `out_dir`. With ORIEL_UPDATE_GOLDEN=1 it
// writes DIR/<name>.exr instead and succeeds.
bool golden_check(const char *dir, const char *out_dir, const char *name, const char *driver,
                  const char *const *channels, const struct orl_image *actual,
                  const struct golden_tolerance *tolerance);

#endif
