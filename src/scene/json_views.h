// Shared by the readers of cameras in JSON.
#ifndef ORL_SCENE_JSON_VIEWS_H
#define ORL_SCENE_JSON_VIEWS_H

#include <jansson.h>

#include "oriel/camera.h"

// Reads an array of `rows` arrays of `columns` finite numbers into `out`, row by row. False when it
// is anything else.
bool orl_json_rows(const json_t *array, size_t rows, size_t columns, double *out);
// A picture's width or height; 0 when the value is missing or not valid.
int orl_json_side(const json_t *entry, const char *key);
// Reads an entry of Inria's cameras.json: position is the camera centre, the columns of rotation
// are the camera's axes, and the principal point is the picture's centre. False when a value is
// missing. The caller checks the view with orl_view_problem.
bool orl_json_inria_view(const json_t *entry, struct orl_view *view);

#endif
