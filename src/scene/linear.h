// A scene's photographs as linear light, where the originals have more than 8 bits
// (docs/reference/files.md, images_linear).
#ifndef ORL_SCENE_LINEAR_H
#define ORL_SCENE_LINEAR_H

#include "oriel/image.h"
#include "oriel/scene.h"

// Reads the linear version of an undistorted photograph, F32 x3. A value of 1 is the white of the
// 8-bit version, before any response curve or exposure. When there is no linear version
// (photo->linear false) the result is ORL_OK and image->data NULL. *clips: no value is above 1, so
// the sensor or the file's samples may have been saturated there.
enum orl_result orl_scene_read_linear(const struct orl_log *log, const struct orl_scene *scene,
                                      size_t photo, struct orl_image *image,
                                      bool *clips) ORL_CHECK_RESULT;
// Writes a linear version: half floats, channels R G B.
enum orl_result orl_linear_write(const struct orl_log *log, const char *path,
                                 const struct orl_image *image) ORL_CHECK_RESULT;

#endif
