// Gains of photographs that were not aligned.
#ifndef ORL_PREPROCESS_GAIN_GUESS_H
#define ORL_PREPROCESS_GAIN_GUESS_H

#include "oriel/common.h"

// A photograph whose gain is known, or wanted.
struct orl_gain_view {
    double eye[3]; // world
    bool known;    // ev is set
    double ev;     // relative to the scene's reference
    float gain[3]; // in: of aligned ones; out: of the others
};

enum orl_gain_guess {
    ORL_GUESS_REFERENCE,  // 1: the scene's reference exposure
    ORL_GUESS_NEIGHBOURS, // that of photographs from near by that show the same
    ORL_GUESS_EXPOSURE,   // from EXIF or a list
    ORL_GUESS_BOTH,       // from EXIF, off by what neighbours are off
};
const char *orl_gain_guess_name(enum orl_gain_guess guess);

// Gains of held-out views from everything but their pixels: the guess that does best when
// each aligned photograph's gain is guessed from the others'. shared[i * aligned_count + k]:
// scene points common to view i and aligned photograph k, i counting the aligned ones first
// and then the others; own[i]: scene points of view i. Returns the guess that was used.
enum orl_gain_guess orl_gains_guess(const struct orl_gain_view *aligned, size_t aligned_count,
                                    struct orl_gain_view *others, size_t other_count,
                                    const uint32_t *shared, const uint32_t *own);

#endif
