// The folder of a job: who may take it, on drives that know no locks or links, and when two
// start at once. This program's flock and symlink stand in for the drive's.
#include <errno.h>
#include <fcntl.h>
#include <stdio.h>
#include <string.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>

#include "core/lock.h"
#include "preprocess/job/job.h"
#include "oriel/prepare.h"
#include "test.h"

static int flock_errno, symlink_errno; // 0: it works
static const char *winner;             // a scene where another begins before the lock is had

int flock(int fd, int operation)
{
    (void)fd;
    (void)operation;
    if (winner) {
        char path[4096];
        snprintf(path, sizeof path, "%s/.oriel/stages.json", winner);
        winner = NULL; // writing locks the temporary file, too
        assert_int_equal(orl_file_write(NULL, path, "{}", 2), ORL_OK);
    }
    errno = flock_errno;
    return flock_errno ? -1 : 0;
}

int symlink(const char *target, const char *path)
{
    errno = symlink_errno;
    return symlink_errno ? -1 : symlinkat(target, AT_FDCWD, path);
}

static bool exists(const char *dir, const char *name)
{
    char path[4096];
    snprintf(path, sizeof path, "%s/%s", dir, name);
    return access(path, F_OK) == 0;
}

// A job that fails, as there are no photographs, in an empty folder.
static enum orl_result prepare_nothing(const char *dir, struct orl_log *log)
{
    static const char *const inputs[] = {"/nowhere/at/all"};
    return orl_prepare(log, &(struct orl_prepare_params){
        .inputs = inputs, .input_count = 1, .out = dir}, NULL);
}

static void leaves_nothing_behind(void **state)
{
    (void)state;
    struct said said;
    struct orl_log log = log_to(&said);
    char *dir = test_dir_make();
    assert_int_equal(prepare_nothing(dir, &log), ORL_ERR_NOT_FOUND);
    assert_int_equal(access(dir, F_OK), -1);
    free(dir);
}

static void loser_leaves_the_winner_alone(void **state)
{
    (void)state;
    struct said said;
    struct orl_log log = log_to(&said);
    char *dir = test_dir_make();
    // The other has the lock, or had it and is done.
    static const int errors[] = {EWOULDBLOCK, 0};
    static const char *const says[] = {"another oriel prepare is at work", "there already"};
    for (int i = 0; i < 2; i++) {
        winner = dir;
        flock_errno = errors[i];
        assert_int_equal(prepare_nothing(dir, &log), ORL_ERR_ARGUMENT);
        winner = NULL;
        flock_errno = 0;
        assert_non_null(strstr(said.text, says[i]));
        assert_true(exists(dir, ".oriel/stages.json"));
        assert_int_equal(orl_dir_remove(NULL, dir), ORL_OK);
        assert_int_equal(orl_dir_make(NULL, dir), ORL_OK);
    }
    test_dir_remove(dir);
}

static void goes_on_without_locks(void **state)
{
    (void)state;
    static const int errors[] = {EINVAL, ENOLCK, ENOTSUP};
    for (size_t i = 0; i < ORL_COUNT(errors); i++) {
        struct said said;
        struct orl_log log = log_to(&said);
        char *dir = test_dir_make();
        flock_errno = errors[i];
        assert_int_equal(prepare_nothing(dir, &log), ORL_ERR_NOT_FOUND);
        flock_errno = 0;
        assert_non_null(strstr(said.text, "cannot be locked"));
        assert_null(strstr(said.text, "at work"));
        free(dir); // left, as it was empty
    }
}

static void copies_where_links_are_unknown(void **state)
{
    (void)state;
    struct said said;
    struct orl_log log = log_to(&said);
    char *dir = test_dir_make(), from[4096], to[4096];
    struct orl_job job = {.log = &log, .dir = dir};
    snprintf(from, sizeof from, "%s/from", dir);
    snprintf(to, sizeof to, "%s/to", dir);
    assert_int_equal(orl_file_write(NULL, from, "light", 5), ORL_OK);
    struct stat st;
    assert_int_equal(orl_job_link(&job, from, to), ORL_OK);
    assert_int_equal(lstat(to, &st), 0);
    assert_true(S_ISLNK(st.st_mode));
    assert_int_equal(unlink(to), 0);
    symlink_errno = EPERM;
    assert_int_equal(orl_job_link(&job, from, to), ORL_OK);
    assert_int_equal(lstat(to, &st), 0);
    assert_true(S_ISREG(st.st_mode) && st.st_size == 5);
    symlink_errno = EACCES;
    assert_int_equal(orl_job_link(&job, from, to), ORL_ERR_IO);
    symlink_errno = 0;
    test_dir_remove(dir);
}

static void refuses_what_the_disk_cannot_hold(void **state)
{
    (void)state;
    struct said said;
    struct orl_log log = log_to(&said);
    char *dir = test_dir_make();
    const struct orl_job job = {.log = &log, .dir = dir};
    assert_int_equal(orl_job_need_disk(&job, "densify", 4096), ORL_OK);
    assert_int_equal(orl_job_need_disk(&job, "densify", 1e24), ORL_ERR_IO);
    assert_non_null(strstr(said.text, "densify writes about"));
    assert_non_null(strstr(said.text, dir));
    test_dir_remove(dir);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(leaves_nothing_behind),
        cmocka_unit_test(loser_leaves_the_winner_alone),
        cmocka_unit_test(goes_on_without_locks),
        cmocka_unit_test(copies_where_links_are_unknown),
        cmocka_unit_test(refuses_what_the_disk_cannot_hold),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
