// The commands. Each parses its own arguments and returns the exit status: 0 only if the whole job
// was done, 2 for wrong usage or unusable input.
#ifndef ORL_CLI_COMMANDS_H
#define ORL_CLI_COMMANDS_H

#include "cli/args.h"
#include "cli/terminal.h"

struct command {
    const char *name, *summary;
    int (*run)(int argc, char **argv); // without the command's own name
};

int cmd_prepare(int argc, char **argv);
int cmd_calibrate(int argc, char **argv);
int cmd_densify(int argc, char **argv);
int cmd_export(int argc, char **argv);
int cmd_fuse(int argc, char **argv);
int cmd_hdr(int argc, char **argv);
int cmd_bench(int argc, char **argv);
int cmd_chart(int argc, char **argv);
int cmd_import(int argc, char **argv);
int cmd_info(int argc, char **argv);
int cmd_lod(int argc, char **argv);
int cmd_methods(int argc, char **argv);
int cmd_plan(int argc, char **argv);
int cmd_publish(int argc, char **argv);
int cmd_stress(int argc, char **argv);
int cmd_render(int argc, char **argv);
int cmd_eval(int argc, char **argv);
int cmd_synth(int argc, char **argv);
int cmd_trim(int argc, char **argv);
int cmd_tune(int argc, char **argv);
int cmd_walk(int argc, char **argv);

// Starts a command: parses the arguments and sets `terminal` up by --quiet and --verbose. Returns
// false, with the exit status in *status, when nothing is left to do.
bool command_begin(const struct arg_command *command, int argc, char **argv,
                   struct arg_common *common, struct terminal *terminal,
                   const char **positionals, size_t *positional_count, int *status);
// The work of a command with its one positional (NULL: absent) and its options.
typedef enum orl_result command_run(const struct terminal *terminal, const void *options,
                                    const struct arg_common *common, const char *positional);
// Runs a whole command that takes one positional: parses, runs, and returns the exit status, which
// is an error when stdout could not be written.
int command_main(const struct arg_command *command, int argc, char **argv, command_run *run,
                 const void *options);
// Sets *whole when the folder has a scene.json: a job of a scene that is whole has nothing to do,
// and the files that it would read may be gone.
enum orl_result command_is_whole(const struct orl_log *log, const char *scene, bool *whole);
// 0 for ORL_OK; 2 for argument, format, data and not-found errors; 130 when cancelled; 1 for other
// errors.
int command_status(enum orl_result result);

#endif
