// The light in a photograph, as its camera's automatic exposure met it.
#ifndef ORL_PREPROCESS_METERED_H
#define ORL_PREPROCESS_METERED_H

#include <stdbool.h>
#include <stddef.h>

#include "oriel/camera.h"
#include "oriel/log.h"

// Meters (scene/meter.h) the photograph in `path` after it is brought to the scene's exposure, as
// rendering does with this gain and vignetting of orl_photo. Writes log2 of the light.
enum orl_result orl_photo_metered(const struct orl_log *log, const char *path,
                                  const struct orl_camera *camera, const float gain[3],
                                  const float vignette[3], double *light) ORL_CHECK_RESULT;

// Did automatic exposure choose these exposures, rather than a bracket? ev: their log2; light: of each picture as it
// is, with gains of 1. Automatic exposure makes all pictures about equally bright; those of a bracket are brighter with
// more exposure. True where brightness grows by less than a quarter of a stop with each stop of exposure: by 0.1
// at most in photographs of three places, by 0.45 in a bracket of 16 exposures (Debevec and Malik 1997).
bool orl_exposures_are_metered(const double *ev, const double *light, size_t count);

#endif
