#include "oriel/log.h"

#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>

#include "core/text.h"

static void print_stderr(void *priv, enum orl_log_level level, const char *message)
{
    (void)priv;
    static const char *const words[] = {"error: ", "warning: ", "", "debug: "};
    fprintf(stderr, "oriel: %s%s\n", words[level], message);
}

struct orl_log orl_log_stderr(enum orl_log_level level)
{
    return (struct orl_log){.level = level, .print = print_stderr};
}

static void log_va(const struct orl_log *log, enum orl_log_level level,
                   const char *format, va_list args)
{
    if (!log || !log->print || level > log->level)
        return;
    char message[4096], shown[4096];
    vsnprintf(message, sizeof message, format, args);
    orl_text_escape(message, shown, sizeof shown); // file names may contain any bytes
    log->print(log->priv, level, shown);
}

void orl_logf(const struct orl_log *log, enum orl_log_level level, const char *format, ...)
{
    va_list args;
    va_start(args, format);
    log_va(log, level, format, args);
    va_end(args);
}

enum orl_result orl_fail(const struct orl_log *log, enum orl_result result,
                         const char *format, ...)
{
    va_list args;
    va_start(args, format);
    log_va(log, ORL_LOG_ERROR, format, args);
    va_end(args);
    return result;
}

enum orl_result orl_require_failed(const struct orl_log *log, const char *expr,
                                   const char *file, int line)
{
    orl_logf(log, ORL_LOG_ERROR, "%s:%d: caller broke the rule: %s", file, line, expr);
#ifndef NDEBUG
    abort();
#endif
    return ORL_ERR_ARGUMENT;
}
