// Which methods a command works with, and with which values of their options: the methods' own,
// what was tuned for the scene, then KEY=VALUE settings, in this order.
#ifndef ORL_EVAL_CHOICE_H
#define ORL_EVAL_CHOICE_H

#include "core/file.h"
#include "oriel/render.h"

struct orl_choice {
    const struct orl_method *method;
    char setting[64]; // KEY=VALUE that differs between choices of a method; empty: none does
    struct orl_render_params params;
};

// scene: its tuned values are used; NULL: they are not. sample: what the renderer takes
// photographs for, on which it depends what may be set. ORL_ERR_ARGUMENT, listing what is
// allowed: an unknown method, a key that is unknown or that the method does not read, a value.
enum orl_result orl_choice_make(const struct orl_log *log, const struct orl_scene *scene,
                                enum orl_sample sample, const char *method,
                                const struct orl_names *settings,
                                struct orl_choice *choice) ORL_CHECK_RESULT;

struct orl_choices {
    struct orl_choice *items; // owned
    size_t count, capacity;
};
// methods: names, or "all" among them; none: the default method. varied: "KEY=A,B,..": each
// method once with each of the values; NULL: once.
enum orl_result orl_choices_make(const struct orl_log *log, const struct orl_scene *scene,
                                 enum orl_sample sample, const struct orl_names *methods,
                                 const struct orl_names *settings, const char *varied,
                                 struct orl_choices *choices) ORL_CHECK_RESULT;
void orl_choices_finish(struct orl_choices *choices);

#endif
