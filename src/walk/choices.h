// Private to src/walk: the methods and options that a client may choose from, and its choice.
#ifndef ORL_WALK_CHOICES_H
#define ORL_WALK_CHOICES_H

#include <jansson.h>

#include "eval/choice.h"

enum { WALK_PROBLEM_BYTES = 1024 };

// What there is to choose from: {"list": [{name, description}], "options": [{key, help, and names or
// least, most, unit}], "chosen": orl_walk_choice_json}.
json_t *orl_walk_methods_json(const struct orl_choice *chosen);
// {"name", "values": {KEY: TEXT}}, the latter of the options that the method reads.
json_t *orl_walk_choice_json(const struct orl_choice *choice);
// Is this a message {"method": NAME, "set": ["KEY=VALUE", ..]}?
bool orl_walk_choice_asked(const json_t *message);
// Makes the choice of such a message as the command line does. On failure *choice is unchanged and
// `problem` holds what is wrong.
enum orl_result orl_walk_choice_read(const struct orl_scene *scene, const json_t *message,
                                     struct orl_choice *choice,
                                     char problem[WALK_PROBLEM_BYTES]) ORL_CHECK_RESULT;
// The parameters of frames while the view moves: what costs most is left out, as far as the row of
// the method "oriel-fast" says, and a photograph's own place means nothing. The depth of
// photographs stays the same.
struct orl_render_params orl_walk_moving_params(const struct orl_render_params *params);

#endif
