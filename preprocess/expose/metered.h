// The light in a photograph, as its camera's automatic exposure met it.
#ifndef ORL_PREPROCESS_METERED_H
#define ORL_PREPROCESS_METERED_H

#include "preprocess/expose/expose.h"

// Meters (scene/meter.h) the photograph in folder `dir` after it is brought to the scene's exposure, as rendering
// does with this gain and the photograph's vignetting. Sets photo->light.
enum orl_result orl_photo_metered(const struct orl_log *log, const char *dir, struct orl_exposed *photo,
                                  const float gain[3]) ORL_CHECK_RESULT;

// Did automatic exposure choose these exposures, rather than a bracket? light: of each picture as it is, with gains of
// 1. Automatic exposure makes all pictures about equally bright; those of a bracket are brighter with more exposure.
// True where brightness grows by less than a quarter of a stop with each stop of exposure: by 0.1 at most in
// photographs of three places, by 0.45 in a bracket of 16 exposures (Debevec and Malik 1997).
bool orl_exposures_are_metered(const struct orl_exposed *photos, size_t count);

#endif
