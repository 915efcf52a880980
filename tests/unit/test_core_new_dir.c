// Folders that take their name when they are whole, and what stands beside them.
#include "test.h"

#include <sys/stat.h>
#include <unistd.h>
#include <utime.h>

#include "core/new_dir.h"

static char *dir;

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

static void put(const char *folder, const char *name, const char *text)
{
    char *path = test_path(folder, name);
    assert_int_equal(orl_file_write(NULL, path, text, strlen(text)), ORL_OK);
    free(path);
}

static void expect(const char *folder, const char *name, const char *text)
{
    char *path = test_path(folder, name);
    test_expect_text(path, text);
    free(path);
}

// Folders with names that earlier versions took for their own are the user's.
static void leaves_what_is_not_its_own(void **state)
{
    (void)state;
    static const char *const others[] = {"out.part", "out.old.part", ".oriel-part-mine",
                                         ".oriel-old-0123456789abcdef-outer"};
    char *out = test_path(dir, "out");
    for (size_t i = 0; i < 4; i++) {
        char *other = test_path(dir, others[i]);
        assert_int_equal(orl_dir_make(NULL, other), ORL_OK);
        put(other, "precious", "p");
        assert_int_equal(utime(other, &(struct utimbuf){1, 1}), 0); // old
        free(other);
    }
    for (int round = 0; round < 3; round++) { // a new folder, one refused, one over the other
        struct orl_new_dir new;
        enum orl_result result = orl_new_dir_begin(NULL, out, round == 2, &new);
        assert_int_equal(result, round == 1 ? ORL_ERR_ARGUMENT : ORL_OK);
        if (result == ORL_OK) {
            put(new.path, "file", "new");
            assert_int_equal(orl_new_dir_finish(NULL, &new), ORL_OK);
        }
        orl_new_dir_abort(NULL, &new);
    }
    for (size_t i = 0; i < 4; i++) {
        char *other = test_path(dir, others[i]);
        expect(other, "precious", "p");
        free(other);
    }
    assert_int_equal(test_count_entries(dir), 5);
    free(out);
}

static void replaces_and_aborts(void **state)
{
    (void)state;
    char *out = test_path(dir, "out"), *slashed = test_path(dir, "out//");
    struct orl_new_dir new;
    for (int round = 0; round < 2; round++) { // a new name, then one that is there
        assert_int_equal(orl_new_dir_begin(NULL, slashed, true, &new), ORL_OK);
        put(new.path, "file", round ? "b" : "a");
        assert_int_equal(orl_new_dir_finish(NULL, &new), ORL_OK);
        expect(out, "file", round ? "b" : "a");
        assert_int_equal(chmod(out, 0750), 0);
    }
    struct stat st;
    assert_int_equal(stat(out, &st), 0);
    assert_int_equal(st.st_mode & 0777, 0750);
    assert_int_equal(orl_new_dir_begin(NULL, out, true, &new), ORL_OK);
    put(new.path, "file", "c");
    orl_new_dir_abort(NULL, &new);
    orl_new_dir_abort(NULL, &new);
    expect(out, "file", "b");
    assert_int_equal(test_count_entries(dir), 1);
    free(out);
    free(slashed);
}

// As a kill between two renames leaves it, where names cannot be exchanged.
static void restores(void **state)
{
    (void)state;
    char *out = test_path(dir, "out"), *old = test_path(dir, ".oriel-old-0123456789abcdef-out");
    struct orl_new_dir new;
    assert_int_equal(orl_dir_make(NULL, old), ORL_OK);
    put(old, "file", "old");
    assert_int_equal(orl_new_dir_begin(NULL, out, true, &new), ORL_OK);
    orl_new_dir_abort(NULL, &new);
    expect(out, "file", "old");
    assert_int_equal(test_count_entries(dir), 1);
    free(out);
    free(old);
}

static void goes_through_links(void **state)
{
    (void)state;
    char *link = test_path(dir, "link"), *real = test_path(dir, "behind/real");
    assert_int_equal(symlink("behind/real", link), 0);
    for (int round = 0; round < 2; round++) {
        struct orl_new_dir new;
        struct stat st;
        assert_int_equal(orl_new_dir_begin(NULL, link, true, &new), ORL_OK);
        put(new.path, "file", round ? "b" : "a");
        assert_int_equal(orl_new_dir_finish(NULL, &new), ORL_OK);
        assert_int_equal(lstat(link, &st), 0);
        assert_true(S_ISLNK(st.st_mode));
        expect(real, "file", round ? "b" : "a");
    }
    assert_int_equal(test_count_entries(dir), 2);
    free(link);
    free(real);
}

// The second of two runs is told; what a killed one left goes once it is old.
static void one_at_a_time(void **state)
{
    (void)state;
    char *out = test_path(dir, "out"), *other = test_path(dir, "other");
    struct orl_new_dir first, second, third;
    assert_int_equal(orl_new_dir_begin(NULL, out, false, &first), ORL_OK);
    assert_int_equal(utime(first.outer, &(struct utimbuf){1, 1}), 0);
    assert_int_equal(orl_new_dir_begin(NULL, out, false, &second), ORL_ERR_ARGUMENT);
    assert_int_equal(orl_new_dir_begin(NULL, out, true, &second), ORL_ERR_ARGUMENT);
    assert_int_equal(orl_new_dir_begin(NULL, other, false, &third), ORL_OK);
    assert_true(orl_path_is_dir(first.path)); // nor has it been swept
    orl_new_dir_abort(NULL, &third);
    close(first.fd); // as when the program is killed
    assert_int_equal(orl_new_dir_begin(NULL, other, false, &third), ORL_OK);
    assert_false(orl_path_is_dir(first.path));
    orl_new_dir_abort(NULL, &third);
    first.fd = -1;
    orl_new_dir_abort(NULL, &first);
    assert_int_equal(test_count_entries(dir), 0);
    free(out);
    free(other);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test_setup_teardown(leaves_what_is_not_its_own, set_up, tear_down),
        cmocka_unit_test_setup_teardown(replaces_and_aborts, set_up, tear_down),
        cmocka_unit_test_setup_teardown(restores, set_up, tear_down),
        cmocka_unit_test_setup_teardown(goes_through_links, set_up, tear_down),
        cmocka_unit_test_setup_teardown(one_at_a_time, set_up, tear_down),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
