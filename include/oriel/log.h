// Messages to the caller. The library prints only through the callback of struct orl_log.
#ifndef ORIEL_LOG_H
#define ORIEL_LOG_H

#include "oriel/result.h"

enum orl_log_level {
    ORL_LOG_ERROR,   // the call fails
    ORL_LOG_WARNING, // the call goes on with less than was asked for
    ORL_LOG_INFO,    // what a user wants to know about a run
    ORL_LOG_DEBUG,   // what a developer wants to know about a run
};

struct orl_log {
    enum orl_log_level level; // messages above this level are dropped
    // `message` is UTF-8; newline and tab are its only control characters.
    void (*print)(void *priv, enum orl_log_level level, const char *message);
    void *priv;
};

// A log that prints to stderr and marks warnings and errors with a prefix.
struct orl_log orl_log_stderr(enum orl_log_level level);

void orl_logf(const struct orl_log *log, enum orl_log_level level,
              const char *format, ...) ORL_PRINTF(3, 4);

// Logs an error and returns `result`: return orl_fail(log, ORL_ERR_IO, "...").
enum orl_result orl_fail(const struct orl_log *log, enum orl_result result,
                         const char *format, ...) ORL_PRINTF(3, 4);

// Checks for a caller's mistake: logs the expression and line and returns
// ORL_ERR_ARGUMENT; aborts in debug builds. Bad data must use orl_fail instead.
#define ORL_REQUIRE(log, expr)                                                \
    do {                                                                      \
        if (!(expr))                                                          \
            return orl_require_failed(log, #expr, __FILE__, __LINE__);        \
    } while (0)
enum orl_result orl_require_failed(const struct orl_log *log, const char *expr,
                                   const char *file, int line);

#endif
