// cmocka with its required includes, and what several tests need.
#ifndef ORL_TESTS_TEST_H
#define ORL_TESTS_TEST_H

#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <cmocka.h>

#include "core/file.h"

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

#endif
