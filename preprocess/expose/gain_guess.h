// Estimates the gains of photographs that were not aligned.
#ifndef ORL_PREPROCESS_GAIN_GUESS_H
#define ORL_PREPROCESS_GAIN_GUESS_H

#include "oriel/option_row.h"
#include "preprocess/expose/expose.h"

// REFERENCE: 1, the scene's reference exposure. NEIGHBOURS: the gain of nearby photographs that share content.
// EXPOSURE: as in EXIF or in a list. METER: what automatic exposure makes of the light in the picture. BOTH and
// METER_NEAR: the two before, corrected by the neighbours' deviation from theirs.
#define ORL_GAIN_GUESSES(NAME) \
    NAME(ORL_GUESS_REFERENCE, "reference") NAME(ORL_GUESS_NEIGHBOURS, "neighbours") \
    NAME(ORL_GUESS_EXPOSURE, "exposure") NAME(ORL_GUESS_BOTH, "exposure and neighbours") \
    NAME(ORL_GUESS_METER, "metering") NAME(ORL_GUESS_METER_NEAR, "metering and neighbours")
enum orl_gain_guess { ORL_GAIN_GUESSES(ORL_ENUMERATOR) };

// Estimates the gains of held-out photographs, which follow the aligned ones, without using their pixels. It uses the
// guess with the least error when each aligned photograph's gain is estimated from the others. shared[i *
// aligned_count + k]: scene points common to photograph i and aligned photograph k; own[i]: scene points of
// photograph i. Of the aligned ones `light` is metered at the scene's exposure. Returns the guess that was used.
// The light in a held-out photograph is unknown before it is rendered: its gain holds for the aligned photographs'
// mean light, metering[1], and grows by metering[0] stops with each stop of light.
enum orl_gain_guess orl_gains_guess(struct orl_exposed *photos, size_t aligned_count, size_t count,
                                    const uint32_t *shared, const uint32_t *own, double metering[2]);

#endif
