// What stands at the end of a path decides how output gets there.
#include "test.h"

#include <fcntl.h>
#include <signal.h>
#include <string.h>
#include <sys/file.h>
#include <sys/random.h>
#include <sys/resource.h>
#include <sys/stat.h>
#include <sys/syscall.h>
#include <sys/sysmacros.h>
#include <time.h>
#include <unistd.h>

#include "core/file.h"
#include "core/memory.h"
#include "core/text.h"

static char *dir;
static const unsigned long long *guessed; // what somebody knows of the next temporary name

// Stands in for the kernel's.
ssize_t getrandom(void *to, size_t size, unsigned flags)
{
    if (!guessed || size != sizeof *guessed)
        return syscall(SYS_getrandom, to, size, flags);
    memcpy(to, guessed, size);
    return (ssize_t)size;
}

static int set_up(void **state)
{
    (void)state;
    dir = test_dir_make();
    return 0;
}

static int tear_down(void **state)
{
    (void)state;
    test_dir_remove(dir);
    return 0;
}

static mode_t mode_of(const char *path)
{
    struct stat st;
    assert_int_equal(lstat(path, &st), 0);
    return st.st_mode;
}

static void links_stay_links(void **state)
{
    (void)state;
    char *file = test_path(dir, "file");
    char *link = test_path(dir, "link");
    char *chain = test_path(dir, "chain");
    char *dangling = test_path(dir, "dangling");
    char *fresh = test_path(dir, "fresh");
    char *loop = test_path(dir, "loop");
    assert_int_equal(orl_file_write(NULL, file, "old", 3), ORL_OK);
    assert_int_equal(symlink("file", link), 0);
    assert_int_equal(symlink(link, chain), 0);
    assert_int_equal(symlink("fresh", dangling), 0);
    assert_int_equal(symlink("loop", loop), 0);
    assert_int_equal(orl_file_write(NULL, chain, "new", 3), ORL_OK);
    assert_true(S_ISLNK(mode_of(link)) && S_ISLNK(mode_of(chain)));
    test_expect_text(file, "new");
    assert_int_equal(orl_file_write(NULL, dangling, "first", 5), ORL_OK);
    assert_true(S_ISLNK(mode_of(dangling)));
    test_expect_text(fresh, "first");
    assert_int_equal(orl_file_write(NULL, loop, "x", 1), ORL_ERR_IO);
    char *const made[] = {file, link, chain, dangling, fresh, loop};
    for (size_t i = 0; i < ORL_COUNT(made); i++) {
        assert_int_equal(unlink(made[i]), 0);
        free(made[i]);
    }
    assert_int_equal(test_count_entries(dir), 0);
}

static void fifos_are_written_to(void **state)
{
    (void)state;
    char *path = test_path(dir, "fifo"), got[8] = "";
    assert_int_equal(mkfifo(path, 0600), 0);
    int fd = open(path, O_RDONLY | O_NONBLOCK);
    assert_true(fd >= 0);
    assert_int_equal(orl_file_write(NULL, path, "word", 4), ORL_OK);
    assert_int_equal(read(fd, got, sizeof got), 4);
    assert_string_equal(got, "word");
    assert_true(S_ISFIFO(mode_of(path)));
    assert_int_equal(test_count_entries(dir), 1);
    close(fd);
    unlink(path);
    free(path);
}

static void devices_stay_devices(void **state)
{
    (void)state;
    // Not /dev itself: a mistake here, as root, must not cost the machine its devices.
    char *path = test_path(dir, "link");
    char *full = test_path(dir, "full");
    char *own = test_path(dir, "own");
    assert_int_equal(symlink("/dev/null", path), 0);
    assert_int_equal(symlink("/dev/full", full), 0);
    assert_int_equal(orl_file_write(NULL, path, "x", 1), ORL_OK);
    assert_int_equal(orl_file_write(NULL, full, "x", 1), ORL_ERR_IO);
    assert_true(S_ISLNK(mode_of(path)) && S_ISLNK(mode_of(full)));
    if (mknod(own, S_IFCHR | 0600, makedev(1, 3)) == 0 && access(own, W_OK) == 0) {
        (void)!orl_file_write(NULL, own, "x", 1); // may be mounted without devices
        assert_true(S_ISCHR(mode_of(own)));
        unlink(own);
    }
    unlink(path);
    unlink(full);
    free(path);
    free(full);
    free(own);
}

// Reading must not wait for somebody to write.
static void fifos_are_not_read(void **state)
{
    (void)state;
    char *path = test_path(dir, "fifo");
    uint8_t *data;
    size_t size;
    FILE *stream;
    assert_int_equal(mkfifo(path, 0600), 0);
    alarm(20);
    assert_int_equal(orl_file_read(NULL, path, 100, &data, &size), ORL_ERR_IO);
    assert_int_equal(orl_file_open(NULL, path, &stream), ORL_ERR_IO);
    assert_null(stream);
    alarm(0);
    unlink(path);
    free(path);
}

static void permissions_are_kept(void **state)
{
    (void)state;
    char *path = test_path(dir, "private");
    assert_int_equal(orl_file_write(NULL, path, "x", 1), ORL_OK);
    assert_int_equal(chmod(path, 0600), 0);
    assert_int_equal(orl_file_write(NULL, path, "y", 1), ORL_OK);
    assert_int_equal(mode_of(path) & 0777, 0600);
    unlink(path);
    free(path);
}

static void temporary_names_differ(void **state)
{
    (void)state;
    char *path = test_path(dir, "frame.exr");
    struct orl_atomic_file a, b;
    assert_int_equal(orl_atomic_begin(NULL, path, &a), ORL_OK);
    assert_int_equal(orl_atomic_begin(NULL, path, &b), ORL_OK);
    assert_string_not_equal(a.temp, b.temp);
    assert_true(fcntl(a.fd, F_GETFD) & FD_CLOEXEC);
    orl_atomic_abort(&a);
    orl_atomic_abort(&b);
    assert_int_equal(test_count_entries(dir), 0);
    free(path);
}

// Somebody who writes to the same folder and foresees the name puts a link there.
static void temporary_files_are_never_there_before(void **state)
{
    (void)state;
    static const unsigned long long number = 0x5ca1ab1e;
    char *path = test_path(dir, "frame.exr"), *victim = test_path(dir, "victim");
    char *trap = test_path(dir, ".oriel-part-000000005ca1ab1e-frame.exr");
    assert_int_equal(orl_file_write(NULL, victim, "precious", 8), ORL_OK);
    assert_int_equal(symlink("victim", trap), 0);
    guessed = &number;
    assert_int_equal(orl_file_write(NULL, path, "x", 1), ORL_ERR_IO);
    assert_int_equal(unlink(trap), 0);
    assert_int_equal(link(victim, trap), 0);
    assert_int_equal(orl_file_write(NULL, path, "x", 1), ORL_ERR_IO);
    guessed = NULL;
    test_expect_text(victim, "precious");
    assert_int_equal(unlink(trap), 0);
    assert_int_equal(unlink(victim), 0);
    assert_int_equal(test_count_entries(dir), 0);
    free(path);
    free(victim);
    free(trap);
}

static void the_longest_names_work(void **state)
{
    (void)state;
    char name[256];
    memset(name, 'n', 255);
    memcpy(name + 251, ".png", 5);
    char *path = test_path(dir, name);
    assert_int_equal(orl_file_write(NULL, path, "x", 1), ORL_OK);
    test_expect_text(path, "x");
    unlink(path);
    free(path);
    for (size_t i = 0; i < 200; i += 2)
        memcpy(name + i, "\xc3\xa9", 2);
    memcpy(name + 200, "x.png", 6);
    struct orl_atomic_file file;
    path = test_path(dir, name);
    assert_int_equal(orl_atomic_begin(NULL, path, &file), ORL_OK);
    char shown[ORL_PATH_SIZE];
    orl_text_escape(file.temp, shown, sizeof shown);
    assert_string_equal(shown, file.temp); // else it is not UTF-8
    orl_atomic_abort(&file);
    free(path);
}

static void a_cut_write_leaves_nothing(void **state)
{
    (void)state;
    char *path = test_path(dir, "large"), *text = calloc(1, 1 << 16);
    struct rlimit before, tight;
    assert_int_equal(orl_file_write(NULL, path, "old", 3), ORL_OK);
    assert_int_equal(getrlimit(RLIMIT_FSIZE, &before), 0);
    tight = (struct rlimit){.rlim_cur = 1 << 12, .rlim_max = before.rlim_max};
    signal(SIGXFSZ, SIG_IGN);
    assert_int_equal(setrlimit(RLIMIT_FSIZE, &tight), 0);
    enum orl_result result = orl_file_write(NULL, path, text, 1 << 16);
    assert_int_equal(setrlimit(RLIMIT_FSIZE, &before), 0);
    assert_int_equal(result, ORL_ERR_IO);
    test_expect_text(path, "old");
    assert_int_equal(test_count_entries(dir), 1);
    unlink(path);
    free(path);
    free(text);
}

// A temporary file that nobody holds any more goes; one that is being written, one that is
// young and a link of such a name stay.
static void sweeping(void **state)
{
    (void)state;
    char *stale = test_path(dir, ".oriel-part-0000000000000000-a.png");
    char *young = test_path(dir, ".oriel-part-0000000000000001-a.png");
    char *link = test_path(dir, ".oriel-part-0000000000000002-a.png"), *path = test_path(dir, "a.png");
    struct timespec old[2] = {{.tv_sec = time(NULL) - 3600}, {.tv_sec = time(NULL) - 3600}};
    struct orl_atomic_file file;
    assert_int_equal(orl_file_write(NULL, stale, "x", 1), ORL_OK);
    assert_int_equal(orl_file_write(NULL, young, "x", 1), ORL_OK);
    assert_int_equal(symlink("a.png", link), 0);
    assert_int_equal(orl_atomic_begin(NULL, path, &file), ORL_OK);
    assert_int_equal(utimensat(AT_FDCWD, stale, old, 0), 0);
    assert_int_equal(futimens(file.fd, old), 0);
    assert_int_equal(orl_dir_make(NULL, dir), ORL_OK);
    assert_int_equal(access(stale, F_OK), -1);
    assert_int_equal(access(young, F_OK), 0);
    assert_int_equal(access(file.temp, F_OK), 0);
    assert_true(S_ISLNK(mode_of(link)));
    orl_atomic_abort(&file);
    unlink(young);
    unlink(link);
    assert_int_equal(test_count_entries(dir), 0);
    free(stale);
    free(young);
    free(link);
    free(path);
}

static void memory_is_known(void **state)
{
    (void)state;
    struct rlimit before, tight;
    uint64_t bytes = orl_memory_available();
    assert_true(bytes > 1 << 20);
    assert_int_equal(getrlimit(RLIMIT_AS, &before), 0);
    tight = (struct rlimit){.rlim_cur = 1 << 20, .rlim_max = before.rlim_max};
    assert_int_equal(setrlimit(RLIMIT_AS, &tight), 0); // less than the process has
    bytes = orl_memory_available();
    assert_int_equal(setrlimit(RLIMIT_AS, &before), 0);
    assert_true(bytes == 0);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(links_stay_links),
        cmocka_unit_test(fifos_are_written_to),
        cmocka_unit_test(devices_stay_devices),
        cmocka_unit_test(fifos_are_not_read),
        cmocka_unit_test(permissions_are_kept),
        cmocka_unit_test(temporary_names_differ),
        cmocka_unit_test(temporary_files_are_never_there_before),
        cmocka_unit_test(the_longest_names_work),
        cmocka_unit_test(a_cut_write_leaves_nothing),
        cmocka_unit_test(sweeping),
        cmocka_unit_test(memory_is_known),
    };
    return cmocka_run_group_tests(tests, set_up, tear_down);
}
