// Estimates the gains of photographs that were not aligned.
#ifndef ORL_PREPROCESS_GAIN_GUESS_H
#define ORL_PREPROCESS_GAIN_GUESS_H

#include "oriel/option_row.h"

// A photograph whose gain is known or wanted.
struct orl_gain_view {
    double eye[3]; // camera centre in the world
    bool known;    // true when ev is set
    double ev;     // relative to the scene's reference
    float gain[3]; // in: of the aligned views; out: of the other views
    double light;  // of the aligned views: metered light at the scene's exposure, log2
};

// REFERENCE: 1, the scene's reference exposure. NEIGHBOURS: the gain of nearby photographs that share content.
// EXPOSURE: as in EXIF or in a list. METER: what automatic exposure makes of the light in the picture. BOTH and
// METER_NEAR: the two before, corrected by the neighbours' deviation from theirs.
#define ORL_GAIN_GUESSES(NAME) \
    NAME(ORL_GUESS_REFERENCE, "reference") NAME(ORL_GUESS_NEIGHBOURS, "neighbours") \
    NAME(ORL_GUESS_EXPOSURE, "exposure") NAME(ORL_GUESS_BOTH, "exposure and neighbours") \
    NAME(ORL_GUESS_METER, "metering") NAME(ORL_GUESS_METER_NEAR, "metering and neighbours")
enum orl_gain_guess { ORL_GAIN_GUESSES(ORL_ENUMERATOR) };

// Estimates gains of held-out views without using their pixels. It uses the guess with the least
// error when each aligned photograph's gain is estimated from the others. shared[i * aligned_count
// + k]: scene points common to view i and aligned photograph k, where i counts the aligned views
// first and then the others; own[i]: scene points of view i. Returns the guess that was used.
// The light in an other view is unknown before it is rendered: its gain holds for the aligned views'
// mean light, metering[1], and grows by metering[0] stops with each stop of light.
enum orl_gain_guess orl_gains_guess(const struct orl_gain_view *aligned, size_t aligned_count,
                                    struct orl_gain_view *others, size_t other_count,
                                    const uint32_t *shared, const uint32_t *own,
                                    double metering[2]);

#endif
