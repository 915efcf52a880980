// Options by the rows of a table (oriel/option_row.h): parsing, texts and records of their values.
#ifndef ORL_CORE_ARGUMENTS_H
#define ORL_CORE_ARGUMENTS_H

#include <jansson.h>

#include "oriel/option_row.h"

// Rows, and the struct that holds their values.
struct orl_option_set {
    const struct orl_option *rows; // NULL ends a list of sets
    void *values;
};

// Parses the arguments of `command` into the values, which hold the defaults. Options may stand
// before, between or after positionals, "--name=value" is accepted, and "--" ends the options. Texts
// and positionals, of which there are `most` at most, point into argv. ORL_ERR_ARGUMENT, logged: an
// argument is not allowed.
enum orl_result orl_arguments_parse(const struct orl_log *log, const char *command,
                                  const struct orl_option_set *sets, int argc,
                                  const char *const *argv, size_t most, const char **positionals,
                                  size_t *positional_count) ORL_CHECK_RESULT;
// ORL_ERR_ARGUMENT, logged: an option that must be given is not.
enum orl_result orl_arguments_check(const struct orl_log *log, const char *command,
                                  const struct orl_option *rows,
                                  const void *values) ORL_CHECK_RESULT;
// Takes the text, WxH, given for this option. ORL_ERR_ARGUMENT, logged: it is no size.
enum orl_result orl_size_parse(const struct orl_log *log, const char *option, const char *text,
                               struct orl_size *size) ORL_CHECK_RESULT;
// Releases the lists among the values.
void orl_arguments_finish(const struct orl_option *rows, void *values);

bool orl_option_has_preset(const struct orl_option *row);
// Takes the text. ORL_ERR_ARGUMENT, logged with what is allowed: it is no value of this option.
enum orl_result orl_option_set(const struct orl_log *log, const struct orl_option *row, const char *text,
                               void *values) ORL_CHECK_RESULT;
enum { ORL_OPTION_ALLOWED = 256 };
// The names of a choice, or the range of a number.
void orl_option_allowed(const struct orl_option *row, char text[ORL_OPTION_ALLOWED]);
// Numbers and bytes as such, else the text that is given; NULL: not given.
json_t *orl_option_json(const struct orl_option *row, const void *values);

// Appends "--name", "value" to a list for every value that was given or has a default and is recorded. The same arguments,
// parsed, give the same values in any folder.
void orl_arguments_record(json_t *list, const struct orl_option *rows, const void *values);
// Adds to `settings` the values that are part of the stage's key.
void orl_arguments_settings(json_t *settings, const struct orl_option *rows, const void *values,
                          const char *stage);
// Takes such values, where `settings` has them. ORL_ERR_ARGUMENT, logged: one is not allowed.
enum orl_result orl_arguments_take(const struct orl_log *log, const json_t *settings,
                                 const struct orl_option *rows, void *values,
                                 const char *stage) ORL_CHECK_RESULT;

#endif
