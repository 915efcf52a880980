#include "core/process.h"

#include <errno.h>
#include <fcntl.h>
#include <poll.h>
#include <signal.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/prctl.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <time.h>
#include <unistd.h>

enum { TAIL_LINES = 8, LINE_MAX_BYTES = 1024, EXIT_NO_PROGRAM = 127 };

// The last lines that the program printed, and the line being assembled.
struct output {
    char tail[TAIL_LINES][LINE_MAX_BYTES];
    size_t lines;
    char line[LINE_MAX_BYTES];
    size_t length;
};

double orl_time_s(void)
{
    struct timespec now;
    clock_gettime(CLOCK_MONOTONIC, &now);
    return (double)now.tv_sec + 1e-9 * (double)now.tv_nsec;
}

double orl_cpu_time_s(void)
{
    struct timespec t;
    clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &t);
    return (double)t.tv_sec + 1e-9 * (double)t.tv_nsec;
}

static void end_line(struct output *out, const struct orl_process_params *params)
{
    out->line[out->length] = '\0';
    if (out->length) {
        memcpy(out->tail[out->lines++ % TAIL_LINES], out->line, out->length + 1);
        if (params->line)
            params->line(params->line_priv, out->line);
    }
    out->length = 0;
}

static void take_output(struct output *out, const struct orl_process_params *params,
                        const char *text, size_t size)
{
    for (size_t i = 0; i < size; i++) {
        if (text[i] == '\n' || text[i] == '\r')
            end_line(out, params);
        else if (out->length + 1 < sizeof out->line)
            out->line[out->length++] = text[i];
    }
}

static void exec_child(const struct orl_process_params *params, int output_fd)
{
    setpgid(0, 0); // so that cancellation reaches the program's own children
    // The program ends with Oriel, so that a killed Oriel leaves no writer of its files behind.
    prctl(PR_SET_PDEATHSIG, SIGKILL);
    dup2(output_fd, STDOUT_FILENO);
    dup2(output_fd, STDERR_FILENO);
    int null_fd = open("/dev/null", O_RDONLY | O_CLOEXEC);
    if (null_fd >= 0)
        dup2(null_fd, STDIN_FILENO);
    // The program inherits neither open files (libraries may open theirs without O_CLOEXEC) nor
    // signal settings: a program that ignores SIGPIPE would write to a closed pipe for ever.
    close_range(STDERR_FILENO + 1, ~0U, CLOSE_RANGE_CLOEXEC);
    signal(SIGPIPE, SIG_DFL);
    signal(SIGXFSZ, SIG_DFL);
    sigset_t none;
    sigemptyset(&none);
    sigprocmask(SIG_SETMASK, &none, NULL);
    for (const char *const *entry = params->env; entry && *entry; entry++)
        putenv((char *)(uintptr_t)*entry);
    execvp(params->argv[0], (char *const *)(uintptr_t)params->argv);
    _exit(errno == ENOENT ? EXIT_NO_PROGRAM : 126);
}

// Copies the program's output until the program closes it. True when the job was cancelled.
static bool pump(const struct orl_process_params *params, struct output *out, int fd, pid_t pid,
                 FILE *log_file)
{
    double killed_at = 0;
    bool cancelled = false;
    for (;;) {
        struct pollfd pfd = {.fd = fd, .events = POLLIN};
        int ready = poll(&pfd, 1, 100);
        if (!cancelled && orl_progress_cancelled(params->progress)) {
            cancelled = true;
            killed_at = orl_time_s() + 5;
            kill(-pid, SIGTERM);
        } else if (cancelled && orl_time_s() > killed_at) {
            kill(-pid, SIGKILL);
        }
        if (ready <= 0)
            continue;
        char text[4096];
        ssize_t got = read(fd, text, sizeof text);
        if (got < 0 && errno == EINTR)
            continue;
        if (got <= 0)
            return cancelled;
        if (log_file)
            fwrite(text, 1, (size_t)got, log_file);
        take_output(out, params, text, (size_t)got);
    }
}

static void log_command(FILE *log_file, const char *const *argv)
{
    fprintf(log_file, "$");
    for (; *argv; argv++)
        fprintf(log_file, " %s", *argv);
    fprintf(log_file, "\n");
    fflush(log_file);
}

static enum orl_result report_failure(const struct orl_log *log, const char *const *argv,
                                      int status, const struct output *out)
{
    if (WIFEXITED(status) && WEXITSTATUS(status) == EXIT_NO_PROGRAM && out->lines == 0)
        return orl_fail(log, ORL_ERR_NOT_FOUND, "%s: this program is not installed", argv[0]);
    char tail[TAIL_LINES * 256] = "";
    size_t used = 0;
    size_t first = out->lines > TAIL_LINES ? out->lines - TAIL_LINES : 0;
    for (size_t i = first; i < out->lines; i++) {
        int wrote = snprintf(tail + used, sizeof tail - used, "\n    %.240s",
                             out->tail[i % TAIL_LINES]);
        if (wrote > 0 && used + (size_t)wrote < sizeof tail)
            used += (size_t)wrote;
    }
    bool by_signal = WIFSIGNALED(status);
    return orl_fail(log, ORL_ERR_EXTERNAL, "%s %s failed (%s %d); the end of its output:%s",
                    argv[0], argv[1] ? argv[1] : "", by_signal ? "signal" : "exit status",
                    by_signal ? WTERMSIG(status) : WEXITSTATUS(status), tail);
}

enum orl_result orl_process_run(const struct orl_log *log, const struct orl_process_params *params,
                                struct orl_process_usage *usage)
{
    enum orl_result result = ORL_OK;
    int fds[2] = {-1, -1};
    FILE *log_file = NULL;
    struct output *out = calloc(1, sizeof *out);
    if (!out || pipe2(fds, O_CLOEXEC) != 0) {
        result = orl_fail(log, ORL_ERR_IO, "%s: cannot start: %s", params->argv[0],
                          strerror(errno));
        goto end;
    }
    if (params->log_path && !(log_file = fopen(params->log_path, "abe"))) {
        result = orl_fail(log, ORL_ERR_IO, "%s: %s", params->log_path, strerror(errno));
        goto end;
    }
    if (log_file)
        log_command(log_file, params->argv);
    pid_t pid = fork();
    if (pid < 0) {
        result = orl_fail(log, ORL_ERR_IO, "%s: cannot start: %s", params->argv[0],
                          strerror(errno));
        goto end;
    }
    if (pid == 0)
        exec_child(params, fds[1]);
    close(fds[1]);
    fds[1] = -1;
    bool cancelled = pump(params, out, fds[0], pid, log_file);
    end_line(out, params);
    int status = 0;
    struct rusage used = {0};
    while (wait4(pid, &status, 0, &used) < 0 && errno == EINTR)
        continue;
    if (usage) {
        usage->cpu_s = (double)(used.ru_utime.tv_sec + used.ru_stime.tv_sec) +
                       1e-6 * (double)(used.ru_utime.tv_usec + used.ru_stime.tv_usec);
        usage->peak_rss_bytes = (size_t)used.ru_maxrss * 1024;
    }
    if (cancelled)
        result = ORL_ERR_CANCELLED;
    else if (!WIFEXITED(status) || WEXITSTATUS(status) != 0)
        result = report_failure(log, params->argv, status, out);
end:
    if (log_file)
        fclose(log_file);
    for (int i = 0; i < 2; i++)
        if (fds[i] >= 0)
            close(fds[i]);
    free(out);
    return result;
}
