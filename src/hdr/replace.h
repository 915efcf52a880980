// Airieau 2012, section 4: the photographs of one series, replaced by what they would have shown
// with the whole range of the scene.
#ifndef ORL_HDR_REPLACE_H
#define ORL_HDR_REPLACE_H

#include "oriel/hdr.h"
#include "oriel/progress.h"
#include "render/output/tone.h"

struct orl_replace_params {
    int series;
    const char *out;             // folder of the new scene: missing or empty
    const bool *skip;            // as for orl_hdr_draw
    struct orl_tone_params tone; // of the 8-bit pictures
    const char *method;          // name, for the manifest
};

// Writes a scene whose training photographs are those of the series as radiance: 8-bit pictures,
// and linear versions that do not clip. Their exposure is the scene's middle exposure, so gains are
// 1; response and vignetting are gone. The other series are left out. Held-out photographs stay as
// they were. The folder gets its name once it is whole.
// ORL_ERR_NOT_FOUND: no training photograph belongs to the series.
enum orl_result orl_hdr_replace_series(struct orl_hdr *hdr,
                                       const struct orl_replace_params *params,
                                       const struct orl_progress *progress) ORL_CHECK_RESULT;

#endif
