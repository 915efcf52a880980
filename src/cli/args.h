// Table-driven command line options.
#ifndef ORL_CLI_ARGS_H
#define ORL_CLI_ARGS_H

#include "core/file.h"

enum arg_type {
    ARG_FLAG,   // bool
    ARG_STRING, // const char *
    ARG_INT,    // int, within [min, max]
    ARG_NUMBER, // double, within [min, max]
    ARG_SIZE,   // struct arg_size: "WxH"
    ARG_LIST,   // struct orl_names: "A,B,C", or the option repeated
    ARG_ENUM,   // struct arg_enum
};

// One of some names. The help and the error list them.
struct arg_enum {
    const char *const *names; // ended by NULL
    int value;                // index; what it is before parsing is the default, -1: none
};

struct arg_size {
    int width, height; // 0 0: not given
};

struct arg_option {
    const char *name;  // without "--"
    enum arg_type type;
    void *value;       // of the type's C type, holding the default
    const char *meta;  // "DIR", NULL for flags
    const char *help;
    double min, max;   // ARG_INT, ARG_NUMBER
};

struct arg_command {
    const char *name, *usage, *summary;
    const struct arg_option *options; // ended by a NULL name
    size_t positionals_min, positionals_max;
};

// Options every command has: --help, --quiet, --verbose, --shader-dir DIR.
struct arg_common {
    bool help, quiet, verbose;
    const char *shader_dir;
};

// Options may stand before, between or after positionals; "--name=value" works too;
// "--" ends them. ORL_ERR_ARGUMENT, logged, for anything that is not allowed. With
// --help it prints the help to stdout and returns ORL_OK with common->help set.
// Positionals point into argv.
enum orl_result args_parse(const struct orl_log *log, const struct arg_command *command, int argc,
                           char **argv, struct arg_common *common, const char **positionals,
                           size_t *positional_count) ORL_CHECK_RESULT;

#endif
