// The methods that a command runs, and their options: the method's own values, then the values
// tuned for the scene, then KEY=VALUE settings.
#ifndef ORL_EVAL_CHOICE_H
#define ORL_EVAL_CHOICE_H

#include <jansson.h>

#include "core/file.h"
#include "oriel/render.h"

struct orl_choice {
    const struct orl_method *method;
    char setting[64]; // in which choices of one method differ: KEY=VALUE, or what --method paired adds; empty: none
    struct orl_render_params params;
};

// scene: its tuned values are used; NULL: none are. method: a name; NULL: the scene's default.
// sample: what the renderer samples photographs for, which decides which options may be set.
// ORL_ERR_ARGUMENT, with a list of what is allowed: an unknown method or key, a key that the method
// does not read, or a bad value.
enum orl_result orl_choice_make(const struct orl_log *log, const struct orl_scene *scene,
                                enum orl_sample sample, const char *method,
                                const struct orl_names *settings,
                                struct orl_choice *choice) ORL_CHECK_RESULT;

// Keys and values, numbers or names, of the options in which the choice differs from the method's own
// values: "settings" of "tuned" in scene.json. A new reference.
json_t *orl_choice_settings(const struct orl_choice *choice);

// How good a choice was on photographs: the value for a method in "tuned" of scene.json. before_psnr_db, psnr_db: means
// over the photographs without what was found, and with it; complete: no limit of time ended the search. A new reference.
json_t *orl_choice_record(const struct orl_choice *choice, double before_psnr_db, double psnr_db, size_t photographs,
                          int size_divide, bool complete);

struct orl_choices {
    struct orl_choice *items; // owned
    size_t count, capacity;
};
// methods: names; "all" is all of them, and "paired" adds each whose weights go with any proxy once
// more on that of oriel, by itself to all methods. None: the scene's default. varied: "KEY=A,B,..", each
// method once with each of the values; NULL: each method once.
enum orl_result orl_choices_make(const struct orl_log *log, const struct orl_scene *scene,
                                 enum orl_sample sample, const struct orl_names *methods,
                                 const struct orl_names *settings, const char *varied,
                                 struct orl_choices *choices) ORL_CHECK_RESULT;
void orl_choices_finish(struct orl_choices *choices);

#endif
