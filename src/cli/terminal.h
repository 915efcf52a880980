// Progress and interruption in a terminal.
#ifndef ORL_CLI_TERMINAL_H
#define ORL_CLI_TERMINAL_H

#include "oriel/log.h"
#include "oriel/progress.h"

struct terminal {
    bool quiet, tty;
    bool line_open;        // true while a \r line is unfinished
    char step[64];         // the current step
    char ended[64];        // the step whose end was reported last
    double step_start_s, last_print_s;
    struct orl_log log;    // finishes an open line before it prints
    struct orl_progress progress;
};
// Sets up log and progress, which point to `terminal`, and a handler by which the first SIGINT or
// SIGTERM cancels. On a terminal, progress is one line with the remaining time; elsewhere it is a
// line when a step starts and one when the step ends.
void terminal_init(struct terminal *terminal, enum orl_log_level level, bool quiet);
// Finishes an open progress line.
void terminal_finish(struct terminal *terminal);

#endif
