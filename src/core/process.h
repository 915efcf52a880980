// Running another program.
#ifndef ORL_CORE_PROCESS_H
#define ORL_CORE_PROCESS_H

#include "oriel/log.h"
#include "oriel/progress.h"

struct orl_process_params {
    const char *const *argv;   // NULL-terminated; argv[0] is looked up on PATH
    const char *log_path;      // stdout and stderr are appended to it; NULL: dropped
    const struct orl_progress *progress; // polled for cancellation
    // Called for every line that the program prints; may be NULL. `line` has no newline.
    void (*line)(void *priv, const char *line);
    void *line_priv;
    const char *const *env;    // extra "NAME=value" entries, NULL-terminated; may be NULL
};

struct orl_process_usage {
    double cpu_s;
    size_t peak_rss_bytes;
};

// Runs the program until it ends. Cancellation sends SIGTERM, then SIGKILL after
// five seconds. usage may be NULL.
// ORL_ERR_NOT_FOUND: no such program. ORL_ERR_EXTERNAL: the program failed; the error
// names the command, its exit status and the last lines that it printed.
// ORL_ERR_CANCELLED: interrupted.
enum orl_result orl_process_run(const struct orl_log *log, const struct orl_process_params *params,
                                struct orl_process_usage *usage) ORL_CHECK_RESULT;

// Monotonic time in seconds.
double orl_time_s(void);
// Processor time of all threads of this process so far, in seconds. Other work on the machine
// hardly changes it. With a software renderer it includes the rendering itself; with a GPU only the
// work of the driver and of Oriel.
double orl_cpu_time_s(void);

#endif
