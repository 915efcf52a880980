// cmocka with its required includes, and what several tests need.
#ifndef ORL_TESTS_TEST_H
#define ORL_TESTS_TEST_H

#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <cmocka.h>

#include "core/file.h"

// cmocka has one of its own, but under a name that changes with its version.
#define assert_between(value, least, most) \
    assert_true((long long)(value) >= (long long)(least) && \
                (long long)(value) <= (long long)(most))

// A fresh folder below $TMPDIR or /tmp, to be removed with test_dir_remove.
static inline char *test_dir_make(void)
{
    const char *base = getenv("TMPDIR");
    char *path = malloc(4096);
    assert_non_null(path);
    snprintf(path, 4096, "%s/oriel-test-XXXXXX", base && *base ? base : "/tmp");
    assert_non_null(mkdtemp(path));
    return path;
}

static inline void test_dir_remove(char *path)
{
    assert_int_equal(orl_dir_remove(NULL, path), ORL_OK);
    free(path);
}

// A fresh folder and the path of a file in it, for a test's set-up: 0, else -1.
static inline int test_file_make(const char *name, char **dir, char **file)
{
    *dir = test_dir_make();
    *file = orl_path_join(NULL, *dir, name);
    return *file ? 0 : -1;
}

static inline int test_file_remove(char *dir, char *file)
{
    free(file);
    test_dir_remove(dir);
    return 0;
}

// Of a file in it, to be freed.
static inline char *test_path(const char *dir, const char *name)
{
    char *path = orl_path_join(NULL, dir, name);
    assert_non_null(path);
    return path;
}

static inline void test_expect_text(const char *path, const char *want)
{
    uint8_t *data;
    size_t size;
    assert_int_equal(orl_file_read(NULL, path, 1 << 20, &data, &size), ORL_OK);
    assert_int_equal(size, strlen(want));
    assert_string_equal((char *)data, want); // the zero byte after the end
    free(data);
}

static inline size_t test_count_entries(const char *dir)
{
    struct orl_names names;
    assert_int_equal(orl_dir_list(NULL, dir, &names), ORL_OK);
    size_t count = names.count;
    orl_names_finish(&names);
    return count;
}

// Fails where the processor seconds that `take` gives for a count grow like its square: by 256 here,
// in place of 16 and what caches and busy neighbours cost, so that half of it is too much. A limit in
// seconds would depend on the machine and its load. Threads that wait for a busy core count too, so
// the least of several measurements is taken.
static inline void test_grows_in_proportion(double (*take)(int count))
{
    enum { FEW = 5000, TIMES = 16, MOST = 8 * TIMES, REPEATS = 64 };
    double few = INFINITY, many = INFINITY;
    int repeats = 0;
    do {
        few = fmin(few, take(FEW));
        many = fmin(many, take(TIMES * FEW));
    } while (many > MOST * few && ++repeats < REPEATS);
    if (many > MOST * few)
        fail_msg("%d take %.3f s, %d take %.3f s", FEW, few, TIMES * FEW, many);
}

// Opens DIR/NAME to write text.
static inline FILE *test_create(const char *dir, const char *name)
{
    char path[4096];
    snprintf(path, sizeof path, "%s/%s", dir, name);
    FILE *file = fopen(path, "w");
    assert_non_null(file);
    return file;
}

// All that was logged, a line each.
struct said {
    char text[8192];
};

static inline void test_listen(void *priv, enum orl_log_level level, const char *message)
{
    (void)level;
    struct said *said = priv;
    size_t used = strlen(said->text);
    snprintf(said->text + used, sizeof said->text - used, "%s\n", message);
}

// A log that collects in `said`, emptied first.
static inline struct orl_log log_to(struct said *said)
{
    said->text[0] = '\0';
    return (struct orl_log){.level = ORL_LOG_DEBUG, .print = test_listen, .priv = said};
}

#endif
