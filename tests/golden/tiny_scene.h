// A scene small enough for a test: a painted box before a painted wall, its photographs
// ray traced, its points on a grid. Everything about it is known exactly.
#ifndef ORL_TESTS_TINY_SCENE_H
#define ORL_TESTS_TINY_SCENE_H

#include "oriel/image.h"
#include "oriel/scene.h"

enum { TINY_PHOTOS = 5, TINY_TEST_PHOTO = 2, TINY_WIDTH = 64, TINY_HEIGHT = 48 };

// Writes DIR/images/*.png and fills the scene (released with tiny_scene_finish);
// photograph TINY_TEST_PHOTO is held out. Asserts on failure.
void tiny_scene_make(const char *dir, struct orl_scene *scene);
void tiny_scene_finish(struct orl_scene *scene);

// What a camera at `view` sees: sRGB x3, and depth x1 (z in camera space).
void tiny_scene_trace(const struct orl_view *view, struct orl_image *color,
                      struct orl_image *depth);

#endif
