#include "cli/terminal.h"

#include <signal.h>
#include <stdio.h>
#include <string.h>
#include <unistd.h>

#include "core/process.h"
#include "core/text.h"

// The one global variable: a signal handler has no other access to state.
static volatile sig_atomic_t interrupted;

static void on_signal(int number)
{
    interrupted = 1;
    signal(number, SIG_DFL); // a second signal ends the program at once
}

static bool cancelled(void *priv)
{
    (void)priv;
    return interrupted != 0;
}

void terminal_finish(struct terminal *t)
{
    if (t->line_open)
        fputc('\n', stderr);
    t->line_open = false;
}

static void print_log(void *priv, enum orl_log_level level, const char *message)
{
    struct terminal *t = priv;
    if (t->quiet && level > ORL_LOG_WARNING)
        return;
    terminal_finish(t);
    struct orl_log plain = orl_log_stderr(level);
    plain.print(plain.priv, level, message);
}

static void print_line(struct terminal *t, double done, double total, const char *detail,
                       double elapsed)
{
    double fraction = total > 0 ? done / total : 0;
    char shown[64];
    orl_text_escape(detail ? detail : "", shown, sizeof shown);
    if (fraction >= 1)
        fprintf(stderr, "\r%-10s done in %.1f s\x1b[K\n", t->step, elapsed);
    else if (fraction > 0.02 && elapsed > 1)
        fprintf(stderr, "\r%-10s %3.0f %%, %.0f s left  %.40s\x1b[K", t->step, 100 * fraction,
                elapsed * (1 - fraction) / fraction, shown);
    else
        fprintf(stderr, "\r%-10s %3.0f %%  %.40s\x1b[K", t->step, 100 * fraction, shown);
    t->line_open = fraction < 1;
    fflush(stderr);
}

static void report(void *priv, const char *step, double done, double total, const char *detail)
{
    struct terminal *t = priv;
    if (t->quiet)
        return;
    double now = orl_time_s();
    bool started = strcmp(step, t->step) != 0;
    bool ended = total > 0 && done >= total;
    if (started && ended && strcmp(step, t->ended) == 0)
        return; // reported already
    snprintf(t->ended, sizeof t->ended, "%s", ended ? step : "");
    if (started) {
        terminal_finish(t);
        snprintf(t->step, sizeof t->step, "%s", step);
        t->step_start_s = now;
        t->last_print_s = 0;
    }
    if (t->tty) {
        if (ended || now - t->last_print_s > 0.2) {
            print_line(t, done, total, detail, now - t->step_start_s);
            t->last_print_s = now;
        }
    } else if (ended) {
        fprintf(stderr, "%-10s done in %.1f s\n", t->step, now - t->step_start_s);
    } else if (started) {
        fprintf(stderr, "%-10s started\n", t->step);
    }
    if (ended)
        t->step[0] = '\0';
}

void terminal_init(struct terminal *t, enum orl_log_level level, bool quiet)
{
    memset(t, 0, sizeof *t);
    t->quiet = quiet;
    t->tty = isatty(STDERR_FILENO);
    t->log = (struct orl_log){.level = level, .print = print_log, .priv = t};
    t->progress = (struct orl_progress){.report = report, .cancelled = cancelled, .priv = t};
    signal(SIGINT, on_signal);
    signal(SIGTERM, on_signal);
    signal(SIGPIPE, SIG_IGN);
    signal(SIGXFSZ, SIG_IGN); // a write beyond ulimit -f fails instead, and is told
}
