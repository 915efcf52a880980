// Command line options, described by tables.
#ifndef ORL_CLI_ARGS_H
#define ORL_CLI_ARGS_H

#include "core/file.h"
#include "oriel/prepare_params.h"

enum arg_type {
    ARG_FLAG,   // bool
    ARG_STRING, // const char *
    ARG_INT,    // int, within [min, max]
    ARG_NUMBER, // double, within [min, max]
    ARG_SIZE,   // struct arg_size: "WxH"
    ARG_LIST,   // struct orl_names: "A,B,C", or the option repeated
    ARG_ENUM,   // struct arg_enum
};

// One of several names, which the help and the error message list.
struct arg_enum {
    const char *const *names; // ended by NULL
    int value;                // index; the value before parsing is the default, -1: none
};

struct arg_size {
    int width, height; // 0 0: option absent
};

struct arg_option {
    const char *name;  // without "--"
    enum arg_type type;
    void *value;       // of the type's C type, holding the default
    const char *meta;  // placeholder such as "DIR"; NULL for flags
    const char *help;
    double min, max;   // ARG_INT, ARG_NUMBER
};

struct arg_command {
    const char *name, *usage, *summary;
    const struct arg_option *options; // ended by a NULL name
    size_t positionals_min, positionals_max;
};

// Options of every command: --help, --quiet, --verbose, --shader-dir DIR.
struct arg_common {
    bool help, quiet, verbose;
    const char *shader_dir;
};

// Parses the arguments. Options may stand before, between or after positionals, "--name=value" is
// accepted, and "--" ends the options. With --help it prints the help to stdout and returns ORL_OK
// with common->help set. Positionals point into argv. ORL_ERR_ARGUMENT, logged: an argument is not
// allowed.
enum orl_result args_parse(const struct orl_log *log, const struct arg_command *command, int argc,
                           char **argv, struct arg_common *common, const char **positionals,
                           size_t *positional_count) ORL_CHECK_RESULT;

// Reads "A:B", the block of --test-block; NULL: none. ORL_ERR_ARGUMENT, logged: anything else, or
// more than one of the options that hold photographs out is given.
enum orl_result args_held_out(const struct orl_log *log, int every, const struct orl_names *list,
                              const char *text, struct orl_test_block *block) ORL_CHECK_RESULT;
// Reads "K/N", the K-th of N parts with K from 1 to N. *index is K - 1. ORL_ERR_ARGUMENT, logged:
// anything else.
enum orl_result args_part(const struct orl_log *log, const char *text, int *index,
                          int *count) ORL_CHECK_RESULT;

#endif
