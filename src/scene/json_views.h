// What readers of cameras as JSON share.
#ifndef ORL_SCENE_JSON_VIEWS_H
#define ORL_SCENE_JSON_VIEWS_H

#include <jansson.h>

#include "oriel/camera.h"

// An array of `rows` arrays of `columns` finite numbers, row by row; false when it is anything else.
bool orl_json_rows(const json_t *array, size_t rows, size_t columns, double *out);
// A picture's width or height; 0 when it is none.
int orl_json_side(const json_t *entry, const char *key);
// An entry of Inria's cameras.json: position is the centre, the columns of rotation are the
// camera's axes, and the principal point is the picture's centre. False when a value is missing;
// orl_view_problem tells whether the view can be used.
bool orl_json_inria_view(const json_t *entry, struct orl_view *view);

#endif
