#include <poll.h>
#include <stdio.h>
#include <string.h>
#include <unistd.h>

#include "cli/command.h"
#include "cli/help.h"

// jobs: what follows "oriel job", the commands that only jobs of oriel plan call.
static int run_command(int argc, const char *const *argv, bool jobs)
{
    const char *name = argc > 0 ? argv[0] : "";
    if (!jobs && argc > 1 && strcmp(name, "help") == 0 && strcmp(argv[1], "--complete") == 0) {
        help_complete((size_t)argc - 2, argv + 2); // words of a line that is half typed are no arguments
        return 0;
    }
    const struct command *command = command_find(name, jobs);
    if (command)
        return command_main(command, argc - 1, argv + 1);
    if (!jobs && strcmp(name, "job") == 0)
        return run_command(argc - 1, argv + 1, true);
    if (!jobs && (strcmp(name, "version") == 0 || strcmp(name, "--version") == 0)) {
        printf("oriel %s\n", ORL_VERSION);
        return 0;
    }
    bool asked = strcmp(name, "--help") == 0;
    FILE *out = asked ? stdout : stderr;
    if (jobs)
        help_print_jobs(out);
    else
        help_print_overview(out);
    if (!asked && *name)
        fprintf(stderr, "\noriel: error: unknown command %s\n", name);
    return asked ? 0 : 2;
}

// Whether the reader of standard output, such as head, has closed the pipe: it has read what it wants.
static bool reader_has_left(void)
{
    struct pollfd out = {.fd = STDOUT_FILENO};
    return poll(&out, 1, 0) == 1 && (out.revents & POLLERR);
}

int main(int argc, char **argv)
{
    int status = run_command(argc - 1, (const char *const *)argv + 1, false);
    // ferror remembers an earlier failed write, which fflush does not.
    if ((fflush(stdout) != 0 || ferror(stdout)) && status == 0 && !reader_has_left()) {
        fprintf(stderr, "oriel: error: standard output: cannot write all of it\n");
        status = command_status(ORL_ERR_IO);
    }
    return status;
}
