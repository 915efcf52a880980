// Reading COLMAP's database.
#include <sqlite3.h>
#include <unistd.h>

#include "preprocess/calibrate/match.h"
#include "sift_like.h"
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
            "data BLOB);"
            "CREATE TABLE matches (pair_id INTEGER PRIMARY KEY NOT NULL, rows INTEGER NOT NULL, "
            "cols INTEGER NOT NULL, data BLOB);");
}

// Tables that databases of parts have, too.
static void make_more_tables(void)
{
    make_tables();
    run_sql("CREATE TABLE cameras (camera_id INTEGER PRIMARY KEY, model INTEGER);"
            "CREATE TABLE two_view_geometries (pair_id INTEGER PRIMARY KEY, rows INTEGER, config INTEGER);"
            "INSERT INTO cameras VALUES (1, 2);");
}

// The one number that a query of the file gives.
static int64_t number(const char *path, const char *sql)
{
    sqlite3 *db;
    sqlite3_stmt *statement;
    assert_int_equal(sqlite3_open(path, &db), SQLITE_OK);
    assert_int_equal(sqlite3_prepare_v2(db, sql, -1, &statement, NULL), SQLITE_OK);
    assert_int_equal(sqlite3_step(statement), SQLITE_ROW);
    int64_t value = sqlite3_column_int64(statement, 0);
    sqlite3_finalize(statement);
    sqlite3_close(db);
    return value;
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
        struct orl_features features;
        for (size_t limit = 0; limit <= 8; limit++) {
            assert_int_equal(orl_database_features(db, names[i], limit, &features), ORL_OK);
            assert_int_equal(features.id, i + 1);
            assert_int_equal(features.count, limit && limit < 5 ? limit : 5);
            for (size_t k = 0; k < features.count * ORL_SIFT_SIZE; k++)
                assert_int_equal(features.descriptors[k], limit ? order[k / ORL_SIFT_SIZE] : k / ORL_SIFT_SIZE);
            free(features.descriptors);
        }
    }
    orl_database_close(&db);
    assert_null(db);
}

static void no_features_is_no_error(void **state)
{
    (void)state;
    static const char *const names[] = {"dark.jpg", "none.jpg"};
    make_tables();
    insert_photo(1, "dark.jpg", 6, NULL, 0);
    run_sql("INSERT INTO images VALUES (2, 'none.jpg', 1)");
    struct orl_database *db = open_database();
    for (size_t i = 0; i < 2; i++) {
        struct orl_features features;
        assert_int_equal(orl_database_features(db, names[i], 9, &features), ORL_OK);
        assert_int_equal(features.count, 0);
        free(features.descriptors);
    }
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
        struct orl_features features;
        remove(file);
        make_tables();
        insert_photo(1, "a.jpg", 6, scales, 2);
        run_sql(cases[i].damage);
        assert_int_equal(orl_database_open(&log, file, &db), ORL_OK);
        assert_int_equal(orl_database_features(db, "a.jpg", 9, &features), cases[i].result);
        assert_null(features.descriptors);
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
    struct orl_features features;
    uint8_t *bytes;
    size_t size;
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
        result = orl_database_features(db, "39.jpg", 9, &features);
    assert_int_equal(result, ORL_ERR_FORMAT);
    assert_non_null(strstr(said.text, "cannot be used as COLMAP's database"));
    orl_database_close(&db);
}

// --- matches ---

enum { MANY = 200 };

// A photograph that sees these features of the world.
static void insert_view(int id, const char *name, const int *features, int count)
{
    static float keypoints[MANY * 6];
    static uint8_t descriptors[MANY * SIFT_SIZE];
    char sql[300];
    uint32_t noise = (uint32_t)id;
    for (int i = 0; i < count; i++)
        sift_write(descriptors + i * SIFT_SIZE, (uint32_t)features[i], 0.95f, &noise);
    snprintf(sql, sizeof sql, "INSERT INTO images VALUES (%d, '%s', 1)", id, name);
    run_sql(sql);
    insert_blob("keypoints", id, count, 6, keypoints, (size_t)count * 6 * sizeof *keypoints);
    insert_blob("descriptors", id, count, SIFT_SIZE, descriptors, (size_t)count * SIFT_SIZE);
}

// Matches of the pair as COLMAP finds them in the database.
static int stored(long long pair_id, uint32_t (*matches)[2])
{
    sqlite3 *db;
    sqlite3_stmt *statement;
    int rows = -1;
    assert_int_equal(sqlite3_open(file, &db), SQLITE_OK);
    assert_int_equal(sqlite3_prepare_v2(db, "SELECT rows, cols, data FROM matches WHERE pair_id = ?",
                                        -1, &statement, NULL), SQLITE_OK);
    sqlite3_bind_int64(statement, 1, pair_id);
    if (sqlite3_step(statement) == SQLITE_ROW) {
        rows = sqlite3_column_int(statement, 0);
        assert_int_equal(sqlite3_column_int(statement, 1), 2);
        assert_int_equal(sqlite3_column_bytes(statement, 2), rows * 8);
        if (rows)
            memcpy(matches, sqlite3_column_blob(statement, 2), (size_t)rows * 8);
    }
    sqlite3_finalize(statement);
    sqlite3_close(db);
    return rows;
}

// Photograph `i` sees features 100 i to 100 i + 149, in an order that differs; COLMAP's ids fall.
static void matches_are_written_for_colmap(void **state)
{
    (void)state;
    struct orl_source sources[] = {{.name = "a.jpg"}, {.name = "b.jpg"}, {.name = "c.jpg"}, {.name = "dark.jpg"}};
    struct orl_pair pairs[] = {{0, 1}, {0, 2}, {1, 2}, {2, 3}};
    const struct orl_job job = {.sources = sources, .source_count = 4};
    const struct orl_pair_list list = {.items = pairs, .count = 4};
    uint32_t matches[MANY][2];
    make_tables();
    for (int i = 0; i < 3; i++) {
        int features[150];
        for (int k = 0; k < 150; k++)
            features[k] = 100 * i + k * 7 % 150;
        insert_view(9 - i, sources[i].name, features, 150);
    }
    insert_view(1, sources[3].name, NULL, 0);
    struct orl_database *db = open_database();
    assert_int_equal(orl_match_features(&job, db, &list, 0, 4), ORL_OK);
    const long long base = 2147483647; // COLMAP's: the smaller id times this, plus the larger
    assert_int_equal(stored(7 * base + 9, matches), 0);
    assert_int_equal(stored(1 * base + 7, matches), 0);
    for (int low = 7; low <= 8; low++) {
        assert_int_equal(stored(low * base + low + 1, matches), 50);
        for (int i = 0; i < 50; i++) { // of the smaller id first, which sees what lies further on
            int here = 100 * (9 - low) + (int)matches[i][0] * 7 % 150;
            int there = 100 * (8 - low) + (int)matches[i][1] * 7 % 150;
            assert_int_equal(here, there);
        }
    }
    // What is there stays, whatever it says.
    run_sql("UPDATE matches SET rows = 0, data = x''");
    assert_int_equal(orl_match_features(&job, db, &list, 0, 4), ORL_OK);
    assert_int_equal(stored(7 * base + 8, matches), 0);
    run_sql("DELETE FROM matches WHERE pair_id < 17000000000");
    assert_int_equal(orl_match_features(&job, db, &list, 0, 4), ORL_OK);
    assert_int_equal(stored(7 * base + 8, matches), 50);
    assert_int_equal(stored(8 * base + 9, matches), 0);
    orl_database_close(&db);
}

static bool cancelled(void *priv)
{
    (void)priv;
    return true;
}

static void matching_can_be_interrupted(void **state)
{
    (void)state;
    struct orl_source sources[] = {{.name = "a.jpg"}, {.name = "b.jpg"}};
    struct orl_pair pairs[] = {{0, 1}};
    const struct orl_progress cancel = {.cancelled = cancelled};
    const struct orl_job job = {.sources = sources, .source_count = 2, .progress = &cancel};
    const struct orl_pair_list list = {.items = pairs, .count = 1};
    uint32_t matches[MANY][2];
    static const int features[] = {1, 2, 3};
    make_tables();
    insert_view(1, sources[0].name, features, 3);
    insert_view(2, sources[1].name, features, 3);
    struct orl_database *db = open_database();
    assert_int_equal(orl_match_features(&job, db, &list, 0, 1), ORL_ERR_CANCELLED);
    assert_int_equal(stored(2147483647LL + 2, matches), -1);
    run_sql("DROP TABLE matches");
    assert_int_equal(orl_match_features(&job, db, &list, 0, 1), ORL_ERR_FORMAT);
    orl_database_close(&db);
}

static void spaces_are_hidden_and_come_back(void **state)
{
    (void)state;
    static const float scales[] = {2, 8};
    struct orl_features features;
    make_tables();
    insert_photo(1, "one day/in may.jpg", 6, scales, 2);
    struct orl_database *db = open_database();
    assert_int_equal(orl_database_hide_spaces(db, true), ORL_OK);
    assert_int_equal(orl_database_features(db, "one\x1f" "day/in\x1fmay.jpg", 9, &features), ORL_OK);
    free(features.descriptors);
    assert_int_equal(orl_database_hide_spaces(db, false), ORL_OK);
    assert_int_equal(orl_database_features(db, "one day/in may.jpg", 9, &features), ORL_OK);
    free(features.descriptors);
    orl_database_close(&db);
}

// 1 and 3 have enough in common, 2 and 4 too little, 5 with nothing.
static void few_inliers_do_not_connect(void **state)
{
    (void)state;
    make_more_tables();
    run_sql("INSERT INTO two_view_geometries VALUES (2147483647 * 1 + 3, 15, 2), "
            "(2147483647 * 2 + 4, 14, 2);");
    struct orl_database *db = open_database();
    for (uint32_t id = 1; id <= 5; id++) {
        bool connected;
        assert_int_equal(orl_database_is_connected(db, id, &connected), ORL_OK);
        assert_int_equal(connected, id == 1 || id == 3);
    }
    orl_database_close(&db);
}

static void few_features_are_dropped(void **state)
{
    (void)state;
    const float scales[] = {3, 1, 2};
    make_tables();
    insert_photo(1, "few.jpg", 6, scales, 2);
    insert_photo(2, "enough.jpg", 6, scales, 3);
    struct orl_database *db = open_database();
    assert_int_equal(orl_database_drop_features(db, 3), ORL_OK);
    static const char *const names[] = {"few.jpg", "enough.jpg"};
    for (size_t i = 0; i < 2; i++) {
        struct orl_features features;
        assert_int_equal(orl_database_features(db, names[i], 0, &features), ORL_OK);
        assert_int_equal(features.count, i ? 3 : 0);
        free(features.descriptors);
    }
    orl_database_close(&db);
}

static bool has_parallax(void)
{
    bool parallax;
    struct orl_database *db = open_database();
    assert_int_equal(orl_database_has_parallax(db, &parallax), ORL_OK);
    orl_database_close(&db);
    return parallax;
}

static void homographies_have_no_parallax(void **state)
{
    (void)state;
    make_more_tables();
    assert_false(has_parallax());
    run_sql("INSERT INTO two_view_geometries VALUES (1, 99, 4), (2, 99, 5), (3, 99, 6), (4, 99, 7), (5, 0, 0), "
            "(6, 14, 2);");
    assert_false(has_parallax());
    run_sql("INSERT INTO two_view_geometries VALUES (7, 15, 3);");
    assert_true(has_parallax());
}

static void parts_are_joined(void **state)
{
    (void)state;
    const float scales[] = {3, 1, 2};
    char other[4096];
    struct orl_database *db;
    snprintf(other, sizeof other, "%s/other.db", dir);
    // Two parts with a photograph each, which has id 1 and camera 1 in both.
    make_more_tables();
    insert_photo(1, "b.png", 4, scales, 2);
    assert_int_equal(rename(file, other), 0);
    make_more_tables();
    insert_photo(1, "a.png", 4, scales, 3);
    assert_int_equal(orl_database_open(NULL, file, &db), ORL_OK);
    assert_int_equal(orl_database_add_photographs(db, other), ORL_OK);
    assert_int_equal(number(file, "SELECT image_id FROM images WHERE name = 'b.png'"), 2);
    assert_int_equal(number(file, "SELECT camera_id FROM images WHERE name = 'b.png'"), 2);
    assert_int_equal(number(file, "SELECT rows FROM keypoints WHERE image_id = 2"), 2);
    assert_int_equal(number(file, "SELECT rows FROM descriptors WHERE image_id = 1"), 3);
    assert_int_equal(orl_database_share_camera(db, "a.png", "b.png"), ORL_OK);
    assert_int_equal(number(file, "SELECT count(*) FROM cameras"), 1);
    assert_int_equal(number(file, "SELECT max(camera_id) FROM images"), 1);
    orl_database_close(&db);
}

// Tables of COLMAP 3.12 and later, with what one photograph of one camera has in them.
static void make_rigs(void)
{
    run_sql("CREATE TABLE rigs (rig_id INTEGER PRIMARY KEY, ref_sensor_id INTEGER,"
            " ref_sensor_type INTEGER);"
            "CREATE TABLE frames (frame_id INTEGER PRIMARY KEY, rig_id INTEGER);"
            "CREATE TABLE frame_data (frame_id INTEGER, data_id INTEGER, sensor_id INTEGER,"
            " sensor_type INTEGER);"
            "INSERT INTO rigs VALUES (1, 1, 0); INSERT INTO frames VALUES (1, 1);"
            "INSERT INTO frame_data VALUES (1, 1, 1, 0);");
}

static void parts_with_rigs_are_joined(void **state)
{
    (void)state;
    const float scales[] = {3, 1, 2};
    char other[4096], part[4096];
    struct orl_database *db;
    snprintf(other, sizeof other, "%s/other.db", dir);
    snprintf(part, sizeof part, "%s/part.db", dir);
    make_more_tables();
    make_rigs();
    insert_photo(1, "b.png", 4, scales, 2);
    assert_int_equal(rename(file, other), 0);
    make_more_tables();
    make_rigs();
    insert_photo(1, "a.png", 4, scales, 3);
    assert_int_equal(orl_database_open(NULL, file, &db), ORL_OK);
    assert_int_equal(orl_database_add_photographs(db, other), ORL_OK);
    // The frame and the rig that the second photograph has are its own.
    static const char rows[] =
        "SELECT count(*) FROM images JOIN frame_data ON data_id = image_id AND sensor_id = camera_id "
        "JOIN frames USING (frame_id) JOIN rigs ON rigs.rig_id = frames.rig_id AND "
        "ref_sensor_id = camera_id";
    assert_int_equal(number(file, rows), 2);
    assert_int_equal(number(file, "SELECT count(DISTINCT ref_sensor_id) FROM rigs"), 2);
    assert_int_equal(orl_database_share_camera(db, "a.png", "b.png"), ORL_OK);
    assert_int_equal(number(file, rows), 2);
    assert_int_equal(number(file, "SELECT count(*) FROM rigs"), 1);
    assert_int_equal(number(file, "SELECT count(*) FROM frames"), 2);
    orl_database_close(&db);
    assert_int_equal(orl_database_create_like(NULL, part, file, &db), ORL_OK);
    assert_int_equal(number(part, rows), 2);
    orl_database_close(&db);
}

static void a_part_has_the_features_of_its_pairs(void **state)
{
    (void)state;
    const float scales[] = {3, 1, 2};
    char part[4096];
    struct orl_database *db;
    snprintf(part, sizeof part, "%s/part.db", dir);
    make_more_tables();
    insert_photo(1, "a.png", 4, scales, 3);
    insert_photo(7, "b.png", 4, scales, 2);
    assert_int_equal(orl_database_create_like(NULL, part, file, &db), ORL_OK);
    assert_int_equal(orl_database_take_features(db, "b.png"), ORL_OK);
    assert_int_equal(orl_database_detach(db), ORL_OK);
    uint32_t matches[][2] = {{0, 1}};
    assert_int_equal(orl_database_write_matches(db, 1, 7, matches, 1), ORL_OK);
    orl_database_close(&db);
    assert_int_equal(number(part, "SELECT count(*) FROM images"), 2);
    assert_int_equal(number(part, "SELECT sum(image_id) FROM keypoints"), 7);
    assert_int_equal(number(part, "SELECT sum(image_id) FROM descriptors"), 7);
    // And its matches come back, once.
    assert_int_equal(orl_database_open(NULL, file, &db), ORL_OK);
    assert_int_equal(orl_database_add_matches(db, part), ORL_OK);
    assert_int_equal(orl_database_add_matches(db, part), ORL_OK);
    assert_int_equal(number(file, "SELECT count(*) FROM matches"), 1);
    assert_int_equal(number(file, "SELECT pair_id FROM matches"), (int64_t)INT32_MAX + 7);
    orl_database_close(&db);
}

// A stranger's database may hold more SQL behind the statement that makes a table.
static void a_part_runs_no_sql_of_a_stranger(void **state)
{
    (void)state;
    char part[4096], other[4096], sql[9000];
    struct orl_database *db;
    snprintf(part, sizeof part, "%s/part.db", dir);
    snprintf(other, sizeof other, "%s/other.db", dir);
    make_more_tables();
    snprintf(sql, sizeof sql, "PRAGMA writable_schema = ON; UPDATE sqlite_master SET sql = sql || "
             "'; ATTACH ''%s'' AS other; CREATE TABLE other.evil (a)' WHERE name = 'images'", other);
    run_sql(sql);
    assert_int_equal(orl_database_create_like(NULL, part, file, &db), ORL_OK);
    orl_database_close(&db);
    assert_int_not_equal(access(other, F_OK), 0);
    assert_int_equal(number(part, "SELECT count(*) FROM images"), 0);
}

static void no_trigger_of_a_stranger_runs(void **state)
{
    (void)state;
    struct orl_database *db;
    uint32_t matches[][2] = {{0, 1}};
    make_more_tables();
    run_sql("INSERT INTO images VALUES (1, 'a.png', 1);"
            "CREATE TRIGGER evil AFTER INSERT ON matches BEGIN DELETE FROM images; END");
    assert_int_equal(orl_database_open(NULL, file, &db), ORL_OK);
    assert_int_equal(orl_database_write_matches(db, 1, 7, matches, 1), ORL_OK);
    orl_database_close(&db);
    assert_int_equal(number(file, "SELECT count(*) FROM images"), 1);
}

#define FILE_TEST(name) cmocka_unit_test_setup_teardown(name, set_up, tear_down)

int main(void)
{
    const struct CMUnitTest tests[] = {
        FILE_TEST(largest_scales_come_first), FILE_TEST(no_features_is_no_error),
        FILE_TEST(says_what_is_wrong_with_features), FILE_TEST(says_what_is_no_database),
        FILE_TEST(says_when_it_is_cut_off), FILE_TEST(spaces_are_hidden_and_come_back),
        FILE_TEST(few_inliers_do_not_connect), FILE_TEST(few_features_are_dropped), FILE_TEST(homographies_have_no_parallax),
        FILE_TEST(parts_are_joined),
        FILE_TEST(parts_with_rigs_are_joined),
        FILE_TEST(a_part_has_the_features_of_its_pairs),
        FILE_TEST(a_part_runs_no_sql_of_a_stranger),
        FILE_TEST(no_trigger_of_a_stranger_runs),
        FILE_TEST(matches_are_written_for_colmap), FILE_TEST(matching_can_be_interrupted),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
