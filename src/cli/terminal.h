// Progress and interruption in a terminal.
#ifndef ORL_CLI_TERMINAL_H
#define ORL_CLI_TERMINAL_H

#include "oriel/log.h"
#include "oriel/progress.h"

struct terminal {
    bool quiet, tty;
    bool line_open;        // an unfinished \r line
    char step[64];         // under way
    char ended[64];        // whose end was reported last
    double step_start_s, last_print_s;
    struct orl_log log;    // ends an open line before it prints
    struct orl_progress progress;
};
// Sets up log and progress, which point to `terminal`, and SIGINT and SIGTERM so that
// the first one cancels. On a terminal progress is one line with the time left; elsewhere
// one line when a step starts and one when it ends.
void terminal_init(struct terminal *terminal, enum orl_log_level level, bool quiet);
// Ends an open progress line.
void terminal_finish(struct terminal *terminal);

#endif
