#include <stdio.h>
#include <string.h>

#include "cli/command.h"
#include "cli/help.h"

static int print_usage_error(void (*print)(FILE *out), const char *name)
{
    print(stderr);
    if (*name)
        fprintf(stderr, "\noriel: error: unknown command %s\n", name);
    return 2;
}

// oriel job NAME: commands that only jobs of oriel plan call.
static int run_job(int argc, const char *const *argv)
{
    const char *name = argc > 0 ? argv[0] : "";
    const struct command *command = command_find(name, true);
    if (command)
        return command_main(command, argc - 1, argv + 1);
    if (strcmp(name, "--help") != 0)
        return print_usage_error(help_print_jobs, name);
    help_print_jobs(stdout);
    return 0;
}

static int run_command(int argc, const char *const *argv)
{
    const char *name = argc ? argv[0] : "";
    const struct command *command = command_find(name, false);
    if (command)
        return command_main(command, argc - 1, argv + 1);
    if (strcmp(name, "job") == 0)
        return run_job(argc - 1, argv + 1);
    if (strcmp(name, "version") == 0 || strcmp(name, "--version") == 0) {
        printf("oriel %s\n", ORL_VERSION);
        return 0;
    }
    if (strcmp(name, "--help") != 0)
        return print_usage_error(help_print_overview, name);
    help_print_overview(stdout);
    return 0;
}

int main(int argc, char **argv)
{
    int status = run_command(argc - 1, (const char *const *)argv + 1);
    // ferror remembers an earlier failed write, which fflush does not.
    if ((fflush(stdout) != 0 || ferror(stdout)) && status == 0) {
        fprintf(stderr, "oriel: error: standard output: cannot write all of it\n");
        status = command_status(ORL_ERR_IO);
    }
    return status;
}
