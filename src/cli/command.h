// The commands, each a table of options and a function.
#ifndef ORL_CLI_COMMAND_H
#define ORL_CLI_COMMAND_H

#include <stdio.h>

#include "cli/terminal.h"
#include "core/arguments.h"
#include "oriel/path.h"
#include "oriel/render.h"

// Options of every command.
#define COMMON_OPTIONS(ROW) \
    ROW(help, "help", FLAG, "show this help") \
    ROW(quiet, "quiet", FLAG, "errors and results only") \
    ROW(verbose, "verbose", FLAG, "say more") \
    ROW(shader_dir, "shader-dir", TEXT("DIR"), "read shaders from DIR (for development)")
struct common_options {
    COMMON_OPTIONS(ORL_OPTION_MEMBER)
};
const struct orl_option *common_option_rows(void);

enum command_group {
    COMMAND_MAKE,
    COMMAND_LOOK,
    COMMAND_MEASURE,
    COMMAND_FIT,
    COMMAND_JOB,
    COMMAND_GROUP_COUNT
};

// One run of a command: what it was asked for, and what it works with. command_main releases the
// latter.
struct call {
    const struct command *command;
    struct terminal *terminal;
    const struct orl_log *log;           // the terminal's
    const struct orl_progress *progress; // the terminal's
    const void *options;                 // the command's struct
    const struct common_options *common;
    const char *const *inputs;           // positionals, which a NULL ends
    struct orl_scene *scene;             // these are NULL until the command opens them
    struct orl_gpu *gpu;
    struct orl_renderer *renderer;
    struct orl_path path;
    bool *skip; // per photograph of the scene
};

struct command {
    const char *name;
    enum command_group group;
    bool hidden;         // only jobs call it: as oriel job NAME
    const char *brief;   // in a few words
    const char *usage;   // what follows the name
    const char *summary;
    void (*print_more)(FILE *out); // after the summary: what other tables hold; NULL: nothing
    const struct orl_option *(*rows)(void);
    const void *presets; // a struct of the options with their defaults
    size_t size;         // of that struct
    size_t inputs_min, inputs_max;
    enum orl_result (*run)(struct call *call);
};

// Defines the struct, the rows and the defaults of a command's options.
#define COMMAND_OPTIONS(name, LIST) \
    struct name { LIST(ORL_OPTION_MEMBER) }; \
    static const struct name name##_presets = {LIST(ORL_OPTION_PRESET)}; \
    static ORL_OPTION_ROWS(name##_rows, name, LIST)
// Members of struct command for them.
#define COMMAND_TABLE(name) \
    .rows = name##_rows, .presets = &name##_presets, .size = sizeof(struct name)

// Every command, in the order of the overview: command_NAME in cmd_NAME.c.
#define COMMANDS(NAME) \
    NAME(prepare) NAME(import) NAME(synth) NAME(densify) NAME(lod) NAME(render) NAME(walk) \
    NAME(publish) NAME(export) NAME(hdr) NAME(info) NAME(methods) NAME(refine) NAME(eval) NAME(bench) \
    NAME(chart) NAME(stress) NAME(plot) NAME(tune) NAME(trim) NAME(plan) NAME(help) NAME(calibrate) NAME(fuse)
#define COMMAND_DECLARATION(name) extern const struct command command_##name;
COMMANDS(COMMAND_DECLARATION)
extern const struct command *const commands[]; // ended by NULL
extern const char *const command_groups[COMMAND_GROUP_COUNT]; // their titles
const struct orl_option *no_option_rows(void);

// NULL: there is no such command, hidden or not.
const struct command *command_find(const char *name, bool hidden);
// Parses the arguments, runs the command and returns the exit status: 0 only if the whole job was
// done, 2 for wrong usage or input that is wrong or not supported, 130 when cancelled, 1 for other errors.
int command_main(const struct command *command, int argc, const char *const *argv);
int command_status(enum orl_result result);

// Opens the scene that the first positional names, in the light of a photograph unless that is NULL.
enum orl_result command_scene(struct call *call, const char *light) ORL_CHECK_RESULT;
// Opens the device as the common options ask for it.
enum orl_result command_device(struct call *call) ORL_CHECK_RESULT;
// Opens the device and a renderer of the scene.
enum orl_result command_renderer(struct call *call,
                                 const struct orl_renderer_params *params) ORL_CHECK_RESULT;
// ORL_ERR_ARGUMENT, logged: more than one of the options that hold photographs out is given.
enum orl_result command_held_out(const struct orl_log *log, int every, const struct orl_names *list,
                                 struct orl_test_block block) ORL_CHECK_RESULT;
// True, which it says, when the scene's folder has a scene.json: a job of a scene that is whole has
// nothing to do, and the files that it would read may be gone.
bool command_is_whole(const struct call *call);

#endif
