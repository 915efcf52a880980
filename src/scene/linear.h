// A scene's photographs as linear light, where they were given with more than 8 bits
// (docs/reference/files.md, images_linear).
#ifndef ORL_SCENE_LINEAR_H
#define ORL_SCENE_LINEAR_H

#include "oriel/image.h"
#include "oriel/scene.h"

// The undistorted photograph, F32 x3, in the units of its 8-bit twin: 1 is that one's
// white before any response curve or exposure. When there is none (photo->linear false)
// ORL_OK with image->data NULL. *clips: no value is above 1, so the sensor, or the file's
// samples, may have been full there.
enum orl_result orl_scene_read_linear(const struct orl_log *log, const struct orl_scene *scene,
                                      size_t photo, struct orl_image *image,
                                      bool *clips) ORL_CHECK_RESULT;
// As such a file: half floats, R G B.
enum orl_result orl_linear_write(const struct orl_log *log, const char *path,
                                 const struct orl_image *image) ORL_CHECK_RESULT;

#endif
