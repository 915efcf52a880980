// Reading COLMAP's database.
#include <sqlite3.h>

#include "preprocess/calibrate/database.h"
#include "test.h"

static char *dir, *file;

static int set_up(void **state)
{
    (void)state;
    return test_file_make("database.db", &dir, &file);
}

static int tear_down(void **state)
{
    (void)state;
    return test_file_remove(dir, file);
}

static void run_sql(const char *sql)
{
    sqlite3 *db;
    assert_int_equal(sqlite3_open(file, &db), SQLITE_OK);
    assert_int_equal(sqlite3_exec(db, sql, NULL, NULL, NULL), SQLITE_OK);
    assert_int_equal(sqlite3_close(db), SQLITE_OK);
}

// The tables of COLMAP that are read.
static void make_tables(void)
{
    run_sql("CREATE TABLE images (image_id INTEGER PRIMARY KEY, name TEXT NOT NULL UNIQUE, "
            "camera_id INTEGER NOT NULL);"
            "CREATE TABLE keypoints (image_id INTEGER PRIMARY KEY, rows INTEGER, cols INTEGER, "
            "data BLOB);"
            "CREATE TABLE descriptors (image_id INTEGER PRIMARY KEY, rows INTEGER, cols INTEGER, "
            "data BLOB);");
}

static void insert_blob(const char *table, int id, int rows, int columns, const void *data,
                        size_t size)
{
    char sql[200];
    sqlite3 *db;
    sqlite3_stmt *statement;
    snprintf(sql, sizeof sql, "INSERT INTO %s VALUES (%d, %d, %d, ?)", table, id, rows, columns);
    assert_int_equal(sqlite3_open(file, &db), SQLITE_OK);
    assert_int_equal(sqlite3_prepare_v2(db, sql, -1, &statement, NULL), SQLITE_OK);
    sqlite3_bind_blob(statement, 1, data, (int)size, SQLITE_STATIC);
    assert_int_equal(sqlite3_step(statement), SQLITE_DONE);
    sqlite3_finalize(statement);
    sqlite3_close(db);
}

// Photograph `id` has features of these scales; all bytes of descriptor n are n.
static void insert_photo(int id, const char *name, int columns, const float *scales, int count)
{
    float keypoints[8 * 6] = {0};
    uint8_t descriptors[8 * ORL_SIFT_SIZE];
    char sql[300];
    assert_true(count <= 8);
    for (int i = 0; i < count; i++) {
        float *k = &keypoints[i * columns];
        k[0] = k[1] = 99;
        // Half a turn or so: scale is the length of the matrix's first column.
        k[2] = columns == 4 ? scales[i] : 0.6f * scales[i];
        if (columns == 6)
            k[4] = -0.8f * scales[i], k[3] = k[5] = 50;
        memset(descriptors + i * ORL_SIFT_SIZE, i, ORL_SIFT_SIZE);
    }
    snprintf(sql, sizeof sql, "INSERT INTO images VALUES (%d, '%s', 1)", id, name);
    run_sql(sql);
    insert_blob("keypoints", id, count, columns, keypoints,
                (size_t)(count * columns) * sizeof *keypoints);
    insert_blob("descriptors", id, count, ORL_SIFT_SIZE, descriptors,
                (size_t)count * ORL_SIFT_SIZE);
}

static struct orl_database *open_database(void)
{
    struct orl_database *db;
    assert_int_equal(orl_database_open(NULL, file, &db), ORL_OK);
    return db;
}

static void largest_scales_come_first(void **state)
{
    (void)state;
    static const float scales[] = {2, 8, 1, 4, 8};
    make_tables();
    insert_photo(1, "four.jpg", 4, scales, 5);
    insert_photo(2, "six.jpg", 6, scales, 5);
    struct orl_database *db = open_database();
    static const char *const names[] = {"four.jpg", "six.jpg"};
    for (int i = 0; i < 2; i++) {
        static const uint8_t order[] = {1, 4, 3, 0, 2};
        uint8_t *data;
        size_t count;
        for (size_t limit = 1; limit <= 8; limit++) {
            assert_int_equal(orl_database_descriptors(db, names[i], limit, &data, &count), ORL_OK);
            assert_int_equal(count, limit < 5 ? limit : 5);
            for (size_t k = 0; k < count * ORL_SIFT_SIZE; k++)
                assert_int_equal(data[k], order[k / ORL_SIFT_SIZE]);
            free(data);
        }
    }
    orl_database_close(&db);
    assert_null(db);
}

static void no_features_is_no_error(void **state)
{
    (void)state;
    uint8_t *data;
    size_t count;
    make_tables();
    insert_photo(1, "dark.jpg", 6, NULL, 0);
    run_sql("INSERT INTO images VALUES (2, 'none.jpg', 1)");
    struct orl_database *db = open_database();
    assert_int_equal(orl_database_descriptors(db, "dark.jpg", 9, &data, &count), ORL_OK);
    assert_int_equal(count, 0);
    assert_int_equal(orl_database_descriptors(db, "none.jpg", 9, &data, &count), ORL_OK);
    assert_int_equal(count, 0);
    orl_database_close(&db);
}

static void says_what_is_wrong_with_features(void **state)
{
    (void)state;
    static const float scales[] = {2, 8};
    static const struct {
        const char *damage;
        enum orl_result result;
        const char *says;
    } cases[] = {
        {"UPDATE images SET name = 'other.jpg'", ORL_ERR_DATA, "has no features of a.jpg"},
        {"UPDATE descriptors SET rows = 3", ORL_ERR_FORMAT, "the features of a.jpg are damaged"},
        {"UPDATE descriptors SET rows = -1", ORL_ERR_FORMAT, "are damaged"},
        {"UPDATE descriptors SET data = x'00'", ORL_ERR_FORMAT, "are damaged"},
        {"UPDATE descriptors SET rows = 4, cols = 64", ORL_ERR_FORMAT, "are damaged"},
        {"UPDATE keypoints SET rows = 1", ORL_ERR_FORMAT, "are damaged"},
        {"UPDATE keypoints SET cols = 5", ORL_ERR_FORMAT, "are damaged"},
        {"UPDATE keypoints SET rows = 4611686018427387904", ORL_ERR_FORMAT, "are damaged"},
        {"DELETE FROM keypoints", ORL_ERR_FORMAT, "are damaged"},
    };
    for (size_t i = 0; i < ORL_COUNT(cases); i++) {
        struct said said;
        struct orl_log log = log_to(&said);
        struct orl_database *db;
        uint8_t *data;
        size_t count;
        remove(file);
        make_tables();
        insert_photo(1, "a.jpg", 6, scales, 2);
        run_sql(cases[i].damage);
        assert_int_equal(orl_database_open(&log, file, &db), ORL_OK);
        assert_int_equal(orl_database_descriptors(db, "a.jpg", 9, &data, &count), cases[i].result);
        assert_null(data);
        assert_non_null(strstr(said.text, cases[i].says));
        assert_non_null(strstr(said.text, file));
        orl_database_close(&db);
    }
}

static void says_what_is_no_database(void **state)
{
    (void)state;
    struct said said;
    struct orl_log log = log_to(&said);
    struct orl_database *db;
    assert_int_equal(orl_database_open(&log, file, &db), ORL_ERR_IO); // it is not there
    assert_non_null(strstr(said.text, file));
    assert_int_equal(orl_path_is_file(file), false);
    assert_int_equal(orl_file_write(NULL, file, "neither SQLite nor COLMAP wrote this", 36), ORL_OK);
    assert_int_equal(orl_database_open(&log, file, &db), ORL_ERR_FORMAT);
    assert_non_null(strstr(said.text, "cannot be used as COLMAP's database"));
    assert_null(db);
    // A database, but of something else.
    remove(file);
    run_sql("CREATE TABLE images (image_id INTEGER)");
    assert_int_equal(orl_database_open(&log, file, &db), ORL_ERR_FORMAT);
    assert_non_null(strstr(said.text, "no such"));
}

// Cut off, as by a full disk.
static void says_when_it_is_cut_off(void **state)
{
    (void)state;
    static const float scales[] = {1, 2, 3, 4, 5, 6, 7, 8};
    struct said said;
    struct orl_log log = log_to(&said);
    uint8_t *bytes, *data;
    size_t size, count;
    struct orl_database *db = NULL;
    make_tables();
    for (int i = 1; i < 40; i++) {
        char name[20];
        snprintf(name, sizeof name, "%d.jpg", i);
        insert_photo(i, name, 6, scales, 8);
    }
    assert_int_equal(orl_file_read(NULL, file, 1 << 24, &bytes, &size), ORL_OK);
    assert_int_equal(orl_file_write(NULL, file, bytes, size / 2 / 4096 * 4096), ORL_OK);
    free(bytes);
    enum orl_result result = orl_database_open(&log, file, &db);
    if (result == ORL_OK)
        result = orl_database_descriptors(db, "39.jpg", 9, &data, &count);
    assert_int_equal(result, ORL_ERR_FORMAT);
    assert_non_null(strstr(said.text, "cannot be used as COLMAP's database"));
    orl_database_close(&db);
}

static void spaces_are_hidden_and_come_back(void **state)
{
    (void)state;
    static const float scales[] = {2, 8};
    uint8_t *data;
    size_t count;
    make_tables();
    insert_photo(1, "one day in may.jpg", 6, scales, 2);
    struct orl_database *db = open_database();
    assert_int_equal(orl_database_hide_spaces(db, true), ORL_OK);
    assert_int_equal(orl_database_descriptors(db, "one/day/in/may.jpg", 9, &data, &count), ORL_OK);
    free(data);
    assert_int_equal(orl_database_hide_spaces(db, false), ORL_OK);
    assert_int_equal(orl_database_descriptors(db, "one day in may.jpg", 9, &data, &count), ORL_OK);
    free(data);
    orl_database_close(&db);
}

#define FILE_TEST(name) cmocka_unit_test_setup_teardown(name, set_up, tear_down)

int main(void)
{
    const struct CMUnitTest tests[] = {
        FILE_TEST(largest_scales_come_first), FILE_TEST(no_features_is_no_error),
        FILE_TEST(says_what_is_wrong_with_features), FILE_TEST(says_what_is_no_database),
        FILE_TEST(says_when_it_is_cut_off), FILE_TEST(spaces_are_hidden_and_come_back),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
