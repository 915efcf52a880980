// The light in a photograph, as its camera's automatic exposure met it.
#ifndef ORL_PREPROCESS_METERED_H
#define ORL_PREPROCESS_METERED_H

#include "oriel/camera.h"
#include "oriel/log.h"

// Meters (scene/meter.h) the photograph in `path` after it is brought to the scene's exposure, as
// rendering does with this gain and vignetting of orl_photo. Writes log2 of the light.
enum orl_result orl_photo_metered(const struct orl_log *log, const char *path,
                                  const struct orl_camera *camera, const float gain[3],
                                  const float vignette[3], double *light) ORL_CHECK_RESULT;

#endif
