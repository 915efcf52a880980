// Where oriel refine goes on after it was cut off: SCENE/refine.state, a file for the same machine.
#ifndef ORL_EVAL_REFINE_STATE_H
#define ORL_EVAL_REFINE_STATE_H

#include "eval/refine.h"
#include "soft/descent.h"

// Zero-initialised, it is the beginning. The file holds it as it is, then the model's splats and, once a step of this
// part has been made, its moments.
struct orl_refine_state {
    uint64_t key;    // hash of all that the splats depend on: photographs, settings, the splats to begin with
    uint64_t splats; // of the model
    int32_t part;    // of the descent: 0; 1: the shares have been found
    struct orl_soft_descent_report at; // in this part
    struct orl_refine_report report;
};

enum orl_result orl_refine_state_write(const struct orl_log *log, const char *path, struct orl_refine_state *state,
                                       const struct orl_soft_model *model) ORL_CHECK_RESULT;
// Replaces *state and *model by those in the file, if there is one with the key of *state. Another one is logged.
enum orl_result orl_refine_state_read(const struct orl_log *log, const char *path, struct orl_refine_state *state,
                                      struct orl_soft_model *model) ORL_CHECK_RESULT;

#endif
