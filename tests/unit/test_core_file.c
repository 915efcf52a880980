#include "test.h"

#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

#include "core/file.h"
#include "core/memory.h"

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

static void paths(void **state)
{
    (void)state;
    const char *const want[][3] = {{"a", "b", "a/b"}, {"a/", "b", "a/b"}, {"/", "b", "/b"}};
    for (size_t i = 0; i < ORL_COUNT(want); i++) {
        char *path = orl_path_join(NULL, want[i][0], want[i][1]);
        assert_string_equal(path, want[i][2]);
        free(path);
        assert_string_equal(ORL_PATH(want[i][0], "%s", want[i][1]), want[i][2]);
    }
    assert_string_equal(ORL_PATH("", "%05d.png", 7), "00007.png");
    assert_string_equal(orl_path_name("a/b/c.png"), "c.png");
    assert_string_equal(orl_path_name("c.png"), "c.png");
    assert_string_equal(orl_path_name("a/"), "");
    assert_true(orl_path_is_dir(dir));
    assert_false(orl_path_is_file(dir));
    assert_false(orl_path_is_file("/nowhere/at/all"));
}

// As deep as a path can tell: each level may take little of the stack.
static void deep_folders_are_flushed_and_removed(void **state)
{
    (void)state;
    enum { LEVELS = 1900 };
    char path[ORL_PATH_SIZE];
    size_t length = strlen(orl_path_print(path, dir, "deep"));
    for (int i = 0; i < LEVELS; i++) {
        assert_int_equal(mkdir(path, 0777), 0);
        memcpy(path + length, "/a", 3);
        length += 2;
    }
    const char *deep = ORL_PATH(dir, "deep");
    assert_int_equal(orl_flush(NULL, deep), ORL_OK);
    assert_int_equal(orl_dir_remove(NULL, deep), ORL_OK);
    assert_false(orl_path_is_dir(deep));
}

// All slashes: a shorter cut would be the root folder.
static void long_paths_open_nothing(void **state)
{
    (void)state;
    char name[2 * ORL_PATH_SIZE];
    FILE *stream;
    memset(name, '/', sizeof name);
    name[sizeof name - 1] = 0;
    const char *const cut[] = {ORL_PATH("/", "%s", name), ORL_PATH(name, "b")};
    for (size_t i = 0; i < ORL_COUNT(cut); i++) {
        assert_int_equal(strlen(cut[i]), ORL_PATH_SIZE - 1);
        assert_false(orl_path_is_dir(cut[i]));
        assert_int_not_equal(orl_file_open(NULL, cut[i], &stream), ORL_OK);
    }
}

static void names_without_extension(void **state)
{
    (void)state;
    assert_int_equal(orl_path_stem("a.b/c.png"), 5);
    assert_int_equal(orl_path_stem("c.jpg.png"), 5);
    assert_int_equal(orl_path_stem("a.b/c"), 5); // the dot is the folder's
    assert_true(orl_path_is_named("a/c.png", "a/c.png"));
    assert_true(orl_path_is_named("a/c.png", "a/c"));
    assert_false(orl_path_is_named("a/c.png", "c"));
    assert_false(orl_path_is_named("a/c.png", "a/c.jpg"));
    assert_false(orl_path_is_named("a/cd.png", "a/c"));
}

static void lines_of_a_text(void **state)
{
    (void)state;
    static const char text[] = "one\n\ntwo words\r\nthree";
    char *path = test_path(dir, "lines");
    struct orl_names names = {0};
    assert_int_equal(orl_file_write(NULL, path, text, strlen(text)), ORL_OK);
    assert_int_equal(orl_file_read_names(NULL, path, &names), ORL_OK);
    assert_int_equal(names.count, 3);
    assert_string_equal(names.items[0], "one");
    assert_string_equal(names.items[1], "two words");
    assert_string_equal(names.items[2], "three");
    assert_int_equal(unlink(path), 0);
    assert_int_not_equal(orl_file_read_names(NULL, path, &names), ORL_OK);
    orl_names_finish(&names);
    free(path);
}

static void temporary_folders(void **state)
{
    (void)state;
    char *first, *second;
    struct stat status;
    assert_int_equal(setenv("TMPDIR", dir, 1), 0);
    assert_int_equal(orl_dir_make_temporary(NULL, "test", &first), ORL_OK);
    assert_int_equal(orl_dir_make_temporary(NULL, "test", &second), ORL_OK);
    assert_string_not_equal(first, second);
    assert_int_equal(strncmp(first, dir, strlen(dir)), 0);
    assert_non_null(strstr(first, "/oriel-test-"));
    assert_int_equal(stat(first, &status), 0);
    assert_int_equal(status.st_mode & 077, 0); // no one else's
    assert_int_equal(rmdir(first), 0);
    assert_int_equal(rmdir(second), 0);
    free(first);
    free(second);
    assert_int_equal(setenv("TMPDIR", "/nowhere/at/all", 1), 0);
    assert_int_equal(orl_dir_make_temporary(NULL, "test", &first), ORL_ERR_IO);
    assert_null(first);
    assert_int_equal(unsetenv("TMPDIR"), 0);
}

static void write_and_read(void **state)
{
    (void)state;
    char *path = test_path(dir, "text");
    assert_int_equal(orl_file_write(NULL, path, "hello", 5), ORL_OK);
    test_expect_text(path, "hello");
    assert_int_equal(orl_file_write(NULL, path, "", 0), ORL_OK); // replaces
    test_expect_text(path, "");
    assert_int_equal(test_count_entries(dir), 1);
    assert_int_equal(unlink(path), 0);
    free(path);
}

static void reading_refuses(void **state)
{
    (void)state;
    char *path = test_path(dir, "ten");
    uint8_t *data = (uint8_t *)path;
    size_t size = 99;
    assert_int_equal(orl_file_write(NULL, path, "0123456789", 10), ORL_OK);
    assert_int_equal(orl_file_read(NULL, path, 9, &data, &size), ORL_ERR_FORMAT);
    assert_null(data);
    assert_int_equal(size, 0);
    assert_int_equal(orl_file_read(NULL, path, 10, &data, &size), ORL_OK);
    free(data);
    assert_int_equal(orl_file_read(NULL, "/nowhere/at/all", 10, &data, &size),
                     ORL_ERR_NOT_FOUND);
    assert_int_equal(orl_file_read(NULL, dir, 10, &data, &size), ORL_ERR_IO);
    assert_int_equal(unlink(path), 0);
    free(path);
}

// A file may claim any size without a byte on the disk.
static void a_file_beyond_memory_is_refused(void **state)
{
    (void)state;
    char *path = test_path(dir, "sparse");
    uint8_t *data;
    size_t size;
    assert_int_equal(orl_file_write(NULL, path, "x", 1), ORL_OK);
    off_t length = (off_t)(orl_memory_available() / 2 * 3);
    if (truncate(path, length) == 0) {
        struct said said;
        struct orl_log log = log_to(&said);
        assert_int_equal(orl_file_read(&log, path, SIZE_MAX / 2, &data, &size), ORL_ERR_MEMORY);
        // Said ahead of the allocation, which fails by itself on some machines only.
        assert_non_null(strstr(said.text, "more than the memory left"));
    }
    assert_int_equal(unlink(path), 0);
    free(path);
}

// What was there before stays until the new file is whole.
static void atomic_files(void **state)
{
    (void)state;
    char *path = test_path(dir, "kept.png");
    struct orl_atomic_file file;
    assert_int_equal(orl_file_write(NULL, path, "old", 3), ORL_OK);
    assert_int_equal(orl_atomic_begin(NULL, path, &file), ORL_OK);
    assert_string_equal(strrchr(file.temp, '.'), ".png"); // writers may go by extension
    FILE *out = fopen(file.temp, "wb");
    assert_non_null(out);
    assert_true(fputs("half", out) >= 0);
    assert_int_equal(fclose(out), 0);
    test_expect_text(path, "old");
    orl_atomic_abort(&file);
    assert_string_equal(file.temp, "");
    test_expect_text(path, "old");
    assert_int_equal(test_count_entries(dir), 1);

    assert_int_equal(orl_atomic_begin(NULL, path, &file), ORL_OK);
    out = fopen(file.temp, "wb");
    assert_true(fputs("new", out) >= 0);
    assert_int_equal(fclose(out), 0);
    assert_int_equal(orl_atomic_commit(NULL, &file), ORL_OK);
    orl_atomic_abort(&file); // after commit: nothing
    test_expect_text(path, "new");
    assert_int_equal(test_count_entries(dir), 1);
    assert_int_equal(unlink(path), 0);
    free(path);
}

static void failed_writes_leave_nothing(void **state)
{
    (void)state;
    struct orl_atomic_file file;
    char *missing = test_path(dir, "no/such/folder");
    char *folder = test_path(dir, "folder");
    char *path = test_path(dir, "x");
    assert_int_equal(orl_file_write(NULL, missing, "x", 1), ORL_ERR_IO);
    assert_int_equal(test_count_entries(dir), 0);
    assert_int_equal(orl_dir_make(NULL, folder), ORL_OK);
    assert_int_equal(orl_file_write(NULL, folder, "x", 1), ORL_ERR_IO); // a folder is in the way
    assert_int_equal(test_count_entries(dir), 1);
    assert_int_equal(orl_atomic_begin(NULL, path, &file), ORL_OK);
    assert_int_equal(orl_atomic_commit(NULL, &file), ORL_ERR_IO); // nothing was written
    assert_false(orl_path_is_file(path));
    assert_int_equal(orl_dir_remove(NULL, folder), ORL_OK);
    free(missing);
    free(folder);
    free(path);
}

static void folders(void **state)
{
    (void)state;
    char *deep = test_path(dir, "a/b/c");
    char *top = test_path(dir, "a");
    char *file = test_path(dir, "a/file");
    char *link = test_path(dir, "a/l"), *outside = test_path(dir, "outside");
    assert_int_equal(orl_dir_make(NULL, deep), ORL_OK);
    assert_int_equal(orl_dir_make(NULL, deep), ORL_OK);
    assert_true(orl_path_is_dir(deep));
    assert_int_equal(orl_file_write(NULL, file, "x", 1), ORL_OK);
    assert_int_equal(orl_dir_make(NULL, file), ORL_ERR_IO);
    assert_int_equal(orl_dir_make(NULL, outside), ORL_OK);
    char *precious = orl_path_join(NULL, outside, "precious");
    assert_int_equal(orl_file_write(NULL, precious, "x", 1), ORL_OK);
    assert_int_equal(symlink(outside, link), 0);
    assert_int_equal(orl_dir_remove(NULL, top), ORL_OK);
    assert_false(orl_path_is_dir(top));
    assert_true(orl_path_is_file(precious)); // links are removed, not followed
    assert_int_equal(orl_dir_remove(NULL, top), ORL_OK);
    assert_int_equal(orl_dir_remove(NULL, outside), ORL_OK);
    free(deep);
    free(top);
    free(file);
    free(link);
    free(outside);
    free(precious);
}

static void listing(void **state)
{
    (void)state;
    const char *const names[] = {"b", "a10", "a2", "B", ".hidden"};
    const char *const sorted[] = {".hidden", "B", "a10", "a2", "b"};
    for (size_t i = 0; i < ORL_COUNT(names); i++) {
        char *path = test_path(dir, names[i]);
        assert_int_equal(orl_file_write(NULL, path, "", 0), ORL_OK);
        free(path);
    }
    struct orl_names list;
    assert_int_equal(orl_dir_list(NULL, dir, &list), ORL_OK);
    assert_int_equal(list.count, ORL_COUNT(sorted));
    for (size_t i = 0; i < ORL_COUNT(sorted); i++) {
        assert_string_equal(list.items[i], sorted[i]);
        char *path = test_path(dir, sorted[i]);
        assert_int_equal(unlink(path), 0);
        free(path);
    }
    assert_true(orl_names_contain(&list, "a2"));
    assert_false(orl_names_contain(&list, "a"));
    orl_names_finish(&list);
    assert_int_equal(orl_dir_list(NULL, "/nowhere/at/all", &list), ORL_ERR_NOT_FOUND);
}

static void hashes(void **state)
{
    (void)state;
    char *path = test_path(dir, "hashed");
    uint64_t empty, one, again;
    assert_int_equal(orl_file_write(NULL, path, "", 0), ORL_OK);
    assert_int_equal(orl_file_hash(NULL, path, &empty), ORL_OK);
    assert_true(empty == 0x2d06800538d394c2ULL); // XXH3's own value of nothing
    assert_int_equal(orl_file_write(NULL, path, "x", 1), ORL_OK);
    assert_int_equal(orl_file_hash(NULL, path, &one), ORL_OK);
    assert_int_equal(orl_file_hash(NULL, path, &again), ORL_OK);
    assert_true(one == again && one != empty);
    assert_int_equal(orl_file_hash(NULL, "/nowhere", &one), ORL_ERR_NOT_FOUND);
    assert_int_equal(unlink(path), 0);
    free(path);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(paths),
        cmocka_unit_test(long_paths_open_nothing),
        cmocka_unit_test(deep_folders_are_flushed_and_removed),
        cmocka_unit_test(names_without_extension),
        cmocka_unit_test(lines_of_a_text),
        cmocka_unit_test(temporary_folders),
        cmocka_unit_test(write_and_read),
        cmocka_unit_test(reading_refuses),
        cmocka_unit_test(a_file_beyond_memory_is_refused),
        cmocka_unit_test(atomic_files),
        cmocka_unit_test(failed_writes_leave_nothing),
        cmocka_unit_test(folders),
        
        cmocka_unit_test(listing),
        cmocka_unit_test(hashes),
    };
    return cmocka_run_group_tests(tests, set_up, tear_down);
}
