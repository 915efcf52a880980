// A scene's photographs as linear light, where the originals have more than 8 bits
// (docs/reference/files.md, images_linear).
#ifndef ORL_SCENE_LINEAR_H
#define ORL_SCENE_LINEAR_H

#include "oriel/image.h"
#include "oriel/scene.h"

// Writes a linear version: half floats, channels R G B.
enum orl_result orl_linear_write(const struct orl_log *log, const char *path,
                                 const struct orl_image *image) ORL_CHECK_RESULT;

#endif
