// Expose: exposure of each photograph and the series it belongs to, response of its camera,
// and what brings photographs to one exposure and white balance.
#ifndef ORL_PREPROCESS_EXPOSE_H
#define ORL_PREPROCESS_EXPOSE_H

#include "core/log.h"

struct orl_exposure {
    bool known;  // in: ev is set
    bool test;   // in: has no say in the median or the series
    double ev;   // in: log2 of exposure; out: relative to the median, 0 if unknown
    int series;  // out: from 0, darkest first
};

// Photographs whose exposures differ by less than this, step by step, are one
// series: half of the third of a stop that cameras set.
#define ORL_EXPOSURE_STEP_EV 0.17
// The same for exposures estimated from the scene.
#define ORL_ESTIMATED_STEP_EV 0.5

// Median and series come from known exposures of photographs that are not held out;
// the others join the series nearest to them. Returns the number of series.
enum orl_result orl_exposures_group(const struct orl_log *log, struct orl_exposure *exposures,
                                    size_t count, double step_ev,
                                    int *series_count) ORL_CHECK_RESULT;

// --- lists of exposures ---

struct orl_listed_exposure {
    char *name;    // owned; of the photograph, extension optional
    double ev;     // log2 of exposure
    bool absolute; // from time, aperture and ISO, as EXIF's; else on a scale of its own
};
struct orl_exposure_list {
    struct orl_listed_exposure *items; // owned
    size_t count;
};
// CSV: NAME,TIME,APERTURE,ISO (TIME in seconds, "1/250" too) or NAME,EV, all lines alike;
// a first line of titles is skipped. ORL_ERR_FORMAT names the line.
enum orl_result orl_exposure_list_read(const struct orl_log *log, const char *path,
                                       struct orl_exposure_list *list) ORL_CHECK_RESULT;
// NULL when the photograph is not listed.
const struct orl_listed_exposure *orl_exposure_list_find(const struct orl_exposure_list *list,
                                                         const char *photo);
void orl_exposure_list_finish(struct orl_exposure_list *list);

// --- gains of photographs that were not aligned ---

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
