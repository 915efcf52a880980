#include "test.h"

#include <signal.h>
#include <string.h>
#include <unistd.h>

#include "core/process.h"

struct heard {
    char last[4096];
    int errors;
};

static void hear(void *priv, enum orl_log_level level, const char *message)
{
    struct heard *heard = priv;
    heard->errors += level == ORL_LOG_ERROR;
    snprintf(heard->last, sizeof heard->last, "%s", message);
}

static enum orl_result run(struct heard *heard, const char *script)
{
    struct orl_log log = {.level = ORL_LOG_INFO, .print = hear, .priv = heard};
    const char *const argv[] = {"sh", "-c", script, NULL};
    return orl_process_run(&log, &(struct orl_process_params){.argv = argv}, NULL);
}

static void success_is_silent(void **state)
{
    (void)state;
    struct heard heard = {0};
    assert_int_equal(run(&heard, "echo hello; exit 0"), ORL_OK);
    assert_int_equal(heard.errors, 0);
}

static void failure_says_status_and_last_lines(void **state)
{
    (void)state;
    struct heard heard = {0};
    assert_int_equal(run(&heard, "for i in 1 2 3 4 5 6 7 8 9 10 11 12; do echo line $i; done; "
                                 "echo to stderr >&2; exit 3"), ORL_ERR_EXTERNAL);
    assert_int_equal(heard.errors, 1);
    assert_non_null(strstr(heard.last, "exit status 3"));
    assert_non_null(strstr(heard.last, "line 12"));
    assert_non_null(strstr(heard.last, "to stderr"));
    assert_null(strstr(heard.last, "line 3\n")); // the end, not all
}

static void signals_are_named(void **state)
{
    (void)state;
    struct heard heard = {0};
    assert_int_equal(run(&heard, "kill -KILL $$"), ORL_ERR_EXTERNAL);
    assert_non_null(strstr(heard.last, "signal 9"));
}

static void a_missing_program_is_not_found(void **state)
{
    (void)state;
    struct heard heard = {0};
    struct orl_log log = {.level = ORL_LOG_INFO, .print = hear, .priv = &heard};
    const char *const argv[] = {"oriel-no-such-program", NULL};
    assert_int_equal(orl_process_run(&log, &(struct orl_process_params){.argv = argv}, NULL),
                     ORL_ERR_NOT_FOUND);
    assert_non_null(strstr(heard.last, "oriel-no-such-program"));
}

struct lines {
    int count;
    char text[8][64];
};

static void take_line(void *priv, const char *line)
{
    struct lines *lines = priv;
    assert_true(lines->count < 8);
    snprintf(lines->text[lines->count++], sizeof lines->text[0], "%s", line);
}

static void lines_environment_and_log(void **state)
{
    (void)state;
    char *dir = test_dir_make(), *log_path = orl_path_join(NULL, dir, "log");
    const char *const argv[] = {"sh", "-c", "echo one; printf 'two\\rthree'; echo; echo $ORL_WORD",
                                NULL};
    const char *const env[] = {"ORL_WORD=from outside", NULL};
    struct lines lines = {0};
    struct orl_process_usage usage;
    struct orl_process_params params = {.argv = argv, .log_path = log_path, .line = take_line,
                                        .line_priv = &lines, .env = env};
    assert_int_equal(orl_process_run(NULL, &params, &usage), ORL_OK);
    assert_int_equal(lines.count, 4);
    assert_string_equal(lines.text[0], "one");
    assert_string_equal(lines.text[1], "two"); // progress bars use \r
    assert_string_equal(lines.text[2], "three");
    assert_string_equal(lines.text[3], "from outside");
    assert_true(usage.cpu_s >= 0 && usage.cpu_s < 60);
    assert_true(usage.peak_rss_bytes > 0);
    uint8_t *data;
    size_t size;
    assert_int_equal(orl_file_read(NULL, log_path, 4096, &data, &size), ORL_OK);
    assert_non_null(strstr((char *)data, "$ sh -c")); // the command itself, then its output
    assert_non_null(strstr((char *)data, "from outside"));
    free(data);
    assert_null(getenv("ORL_WORD")); // the child's alone
    free(log_path);
    test_dir_remove(dir);
}

static void much_output_does_not_block(void **state)
{
    (void)state;
    struct heard heard = {0};
    assert_int_equal(run(&heard, "yes 0123456789 | head -n 100000"), ORL_OK);
    // One line beyond any buffer.
    assert_int_equal(run(&heard, "head -c 1000000 /dev/zero | tr '\\0' x; exit 1"),
                     ORL_ERR_EXTERNAL);
}

static bool always(void *priv)
{
    (void)priv;
    return true;
}

// The program and its children end at once; the caller does not wait for their sleep.
static void cancellation(void **state)
{
    (void)state;
    const char *const argv[] = {"sh", "-c", "sleep 50 & sleep 50", NULL};
    const struct orl_progress progress = {.cancelled = always};
    struct heard heard = {0};
    struct orl_log log = {.level = ORL_LOG_INFO, .print = hear, .priv = &heard};
    double start = orl_time_s();
    assert_int_equal(orl_process_run(&log, &(struct orl_process_params){.argv = argv,
                                                                        .progress = &progress},
                                     NULL), ORL_ERR_CANCELLED);
    assert_true(orl_time_s() - start < 20);
    assert_int_equal(heard.errors, 0);
}

// Neither files that a library opened without O_CLOEXEC, nor a SIGPIPE that is ignored.
static void programs_inherit_nothing(void **state)
{
    (void)state;
    struct heard heard = {0};
    assert_int_equal(dup2(STDERR_FILENO, 77), 77);
    assert_int_equal(run(&heard, "[ ! -e /proc/self/fd/77 ]"), ORL_OK);
    close(77);
    signal(SIGPIPE, SIG_IGN);
    assert_int_equal(run(&heard, "kill -PIPE $$; exit 0"), ORL_ERR_EXTERNAL);
    assert_non_null(strstr(heard.last, "signal 13"));
    signal(SIGPIPE, SIG_DFL);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(success_is_silent),
        cmocka_unit_test(failure_says_status_and_last_lines),
        cmocka_unit_test(signals_are_named),
        cmocka_unit_test(a_missing_program_is_not_found),
        cmocka_unit_test(lines_environment_and_log),
        cmocka_unit_test(much_output_does_not_block),
        cmocka_unit_test(cancellation),
        cmocka_unit_test(programs_inherit_nothing),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
