#include "preprocess/calibrate/database.h"

#include <math.h>
#include <sqlite3.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "core/memory.h"
#include "core/order.h"

struct orl_database {
    const struct orl_log *log;
    char *path; // owned
    sqlite3 *handle;
    sqlite3_stmt *features; // of a photograph: its keypoints and descriptors
};

static enum orl_result fail(const struct orl_database *db)
{
    int code = sqlite3_errcode(db->handle);
    enum orl_result result = code == SQLITE_NOMEM                          ? ORL_ERR_MEMORY
                             : code == SQLITE_NOTADB || code == SQLITE_CORRUPT ||
                                     code == SQLITE_ERROR                  ? ORL_ERR_FORMAT
                                                                           : ORL_ERR_IO;
    return orl_fail(db->log, result, "%s: cannot be used as COLMAP's database: %s", db->path,
                    sqlite3_errmsg(db->handle));
}

// A database may be a stranger's: of what it holds, tables alone take part.
static bool open_file(const char *path, int flags, sqlite3 **handle)
{
    return sqlite3_open_v2(path, handle, flags, NULL) == SQLITE_OK &&
           sqlite3_db_config(*handle, SQLITE_DBCONFIG_ENABLE_TRIGGER, 0, NULL) == SQLITE_OK &&
           sqlite3_db_config(*handle, SQLITE_DBCONFIG_ENABLE_VIEW, 0, NULL) == SQLITE_OK &&
           sqlite3_db_config(*handle, SQLITE_DBCONFIG_TRUSTED_SCHEMA, 0, NULL) == SQLITE_OK;
}

enum orl_result orl_database_open(const struct orl_log *log, const char *path,
                                  struct orl_database **out)
{
    static const char sql[] =
        "SELECT k.rows, k.cols, k.data, d.rows, d.cols, d.data, i.image_id FROM images AS i "
        "LEFT JOIN keypoints AS k ON k.image_id = i.image_id "
        "LEFT JOIN descriptors AS d ON d.image_id = i.image_id WHERE i.name = ?";
    *out = NULL;
    struct orl_database *db = orl_array(log, 1, sizeof *db);
    ORL_TRY_MEMORY(db);
    db->log = log;
    db->path = orl_strdup(log, path);
    enum orl_result result = db->path ? ORL_OK : ORL_ERR_MEMORY;
    if (result == ORL_OK &&
        (!open_file(path, SQLITE_OPEN_READWRITE, &db->handle) ||
         // As COLMAP does: what is whole is flushed as a folder, and some drives cannot flush.
         sqlite3_exec(db->handle, "PRAGMA synchronous = OFF", NULL, NULL, NULL) != SQLITE_OK ||
         sqlite3_prepare_v2(db->handle, sql, -1, &db->features, NULL) != SQLITE_OK))
        result = fail(db);
    if (result == ORL_OK)
        *out = db;
    else
        orl_database_close(&db);
    return result;
}

void orl_database_close(struct orl_database **db)
{
    if (!*db)
        return;
    sqlite3_finalize((*db)->features);
    sqlite3_close((*db)->handle);
    free((*db)->path);
    free(*db);
    *db = NULL;
}

// --- features ---

// A keypoint is x, y, scale, orientation or x, y and a 2x2 matrix.
static float scale_of(const float *keypoint, size_t columns)
{
    return columns == 4 ? keypoint[2] : hypotf(keypoint[2], keypoint[4]);
}

// A blob of rows x columns values; 0 rows where there is none.
struct table {
    size_t rows, columns;
    const void *data;
};

static bool get_table(sqlite3_stmt *statement, int column, size_t value_size, struct table *table)
{
    sqlite3_int64 rows = sqlite3_column_int64(statement, column);
    sqlite3_int64 columns = sqlite3_column_int64(statement, column + 1);
    size_t size = (size_t)sqlite3_column_bytes(statement, column + 2);
    *table = (struct table){0};
    if (rows < 0 || rows > INT32_MAX || columns < 0 || columns > ORL_SIFT_SIZE)
        return false;
    table->rows = (size_t)rows;
    table->columns = (size_t)columns;
    table->data = sqlite3_column_blob(statement, column + 2);
    return size == table->rows * table->columns * value_size;
}

// Copies the `limit` features of largest scale; 0: all, in COLMAP's order.
static enum orl_result take(const struct orl_database *db, const struct table *keypoints, const struct table *all,
                            size_t limit, struct orl_features *features)
{
    struct orl_ranked *order = orl_array(db->log, all->rows, sizeof *order);
    size_t kept = limit && limit < all->rows ? limit : all->rows;
    features->descriptors = orl_array(db->log, kept, ORL_SIFT_SIZE);
    if (!order || !features->descriptors) {
        free(order);
        return ORL_ERR_MEMORY;
    }
    for (size_t i = 0; i < all->rows; i++) {
        float keypoint[6];
        memcpy(keypoint, (const float *)keypoints->data + i * keypoints->columns,
               keypoints->columns * sizeof *keypoint);
        float scale = limit ? scale_of(keypoint, keypoints->columns) : 0;
        order[i] = (struct orl_ranked){isfinite(scale) ? -(double)scale : 0, i};
    }
    qsort(order, all->rows, sizeof *order, orl_order_ranked);
    for (size_t i = 0; i < kept; i++)
        memcpy(features->descriptors + i * ORL_SIFT_SIZE,
               (const uint8_t *)all->data + order[i].index * ORL_SIFT_SIZE, ORL_SIFT_SIZE);
    free(order);
    features->id = (uint32_t)sqlite3_column_int64(db->features, 6);
    features->count = kept;
    return ORL_OK;
}

// Leaves the statement at the photograph's row, to be reset when the tables are done with.
static enum orl_result find_features(struct orl_database *db, const char *name,
                                     struct table *keypoints, struct table *descriptors)
{
    sqlite3_bind_text(db->features, 1, name, -1, SQLITE_STATIC);
    int step = sqlite3_step(db->features);
    if (step == SQLITE_DONE)
        return orl_fail(db->log, ORL_ERR_DATA, "%s: COLMAP has no features of %s", db->path, name);
    if (step != SQLITE_ROW)
        return fail(db);
    if (get_table(db->features, 0, sizeof(float), keypoints) &&
        get_table(db->features, 3, 1, descriptors) && keypoints->rows == descriptors->rows &&
        (!descriptors->rows || (descriptors->columns == ORL_SIFT_SIZE &&
                                (keypoints->columns == 4 || keypoints->columns == 6))))
        return ORL_OK;
    return orl_fail(db->log, ORL_ERR_FORMAT, "%s: the features of %s are damaged", db->path, name);
}

enum orl_result orl_database_features(struct orl_database *db, const char *name, size_t limit,
                                      struct orl_features *features)
{
    struct table keypoints = {0}, all = {0};
    *features = (struct orl_features){0};
    enum orl_result result = find_features(db, name, &keypoints, &all);
    ORL_THEN(result, take(db, &keypoints, &all, limit, features));
    sqlite3_reset(db->features);
    return result;
}

// --- matches ---

// COLMAP's key of a pair, the smaller id first.
static sqlite3_int64 pair_id(uint32_t a, uint32_t b)
{
    return (sqlite3_int64)INT32_MAX * (a < b ? a : b) + (a < b ? b : a);
}

// True if the query has a row, of this number.
static enum orl_result ask(struct orl_database *db, const char *sql, sqlite3_int64 number, bool *any)
{
    sqlite3_stmt *statement = NULL;
    int step = SQLITE_ERROR;
    if (sqlite3_prepare_v2(db->handle, sql, -1, &statement, NULL) == SQLITE_OK) {
        sqlite3_bind_int64(statement, 1, number);
        step = sqlite3_step(statement);
    }
    *any = step == SQLITE_ROW;
    enum orl_result result = *any || step == SQLITE_DONE ? ORL_OK : fail(db);
    sqlite3_finalize(statement);
    return result;
}

enum orl_result orl_database_has_matches(struct orl_database *db, uint32_t a, uint32_t b,
                                         bool *has)
{
    return ask(db, "SELECT 1 FROM matches WHERE pair_id = ?", pair_id(a, b), has);
}

enum orl_result orl_database_is_connected(struct orl_database *db, uint32_t id, bool *connected)
{
    // pair_id, taken apart; COLMAP ignores pairs of fewer inliers.
    static const char sql[] =
        "SELECT 1 FROM two_view_geometries WHERE rows >= 15 AND "
        "?1 IN (pair_id % 2147483647, (pair_id - pair_id % 2147483647) / 2147483647) LIMIT 1";
    return ask(db, sql, id, connected);
}

enum orl_result orl_database_has_parallax(struct orl_database *db, bool *parallax)
{
    // Of pairs that COLMAP uses: neither unverified (0, 1), nor planar, panoramic, or one of the two (4 to 6), nor a
    // watermark (7).
    static const char sql[] =
        "SELECT 1 FROM two_view_geometries WHERE rows >= 15 AND config NOT IN (0, 1, 4, 5, 6, 7) LIMIT ?";
    return ask(db, sql, 1, parallax);
}

enum orl_result orl_database_write_matches(struct orl_database *db, uint32_t a, uint32_t b,
                                           uint32_t (*matches)[2], size_t count)
{
    static const char sql[] = "INSERT INTO matches (pair_id, rows, cols, data) VALUES (?, ?, 2, ?)";
    sqlite3_stmt *statement = NULL;
    for (size_t i = 0; i < count && a > b; i++) {
        uint32_t first = matches[i][0];
        matches[i][0] = matches[i][1];
        matches[i][1] = first;
    }
    bool done = sqlite3_prepare_v2(db->handle, sql, -1, &statement, NULL) == SQLITE_OK &&
                sqlite3_bind_int64(statement, 1, pair_id(a, b)) == SQLITE_OK &&
                sqlite3_bind_int64(statement, 2, (sqlite3_int64)count) == SQLITE_OK &&
                sqlite3_bind_blob(statement, 3, matches, (int)(count * sizeof *matches),
                                  SQLITE_STATIC) == SQLITE_OK &&
                sqlite3_step(statement) == SQLITE_DONE;
    enum orl_result result = done ? ORL_OK : fail(db);
    sqlite3_finalize(statement);
    return result;
}

static enum orl_result run_sql(struct orl_database *db, const char *sql)
{
    return sqlite3_exec(db->handle, sql, NULL, NULL, NULL) == SQLITE_OK ? ORL_OK : fail(db);
}

enum orl_result orl_database_drop_features(struct orl_database *db, int least)
{
    char sql[160];
    snprintf(sql, sizeof sql, "DELETE FROM descriptors WHERE rows < %d; DELETE FROM keypoints WHERE rows < %d;", least,
             least);
    return run_sql(db, sql);
}

enum orl_result orl_database_begin(struct orl_database *db)
{
    return run_sql(db, "BEGIN");
}

enum orl_result orl_database_commit(struct orl_database *db)
{
    return run_sql(db, "COMMIT");
}

enum orl_result orl_database_hide_spaces(struct orl_database *db, bool hide)
{
    // Rows that need no change are not written, so that a database without such names keeps its bytes.
    return run_sql(db, hide ? "UPDATE images SET name = replace(name, ' ', char(31)) WHERE instr(name, ' ')"
                            : "UPDATE images SET name = replace(name, char(31), ' ') WHERE instr(name, char(31))");
}

// --- databases of parts ---

// Runs the first statement only: a file from elsewhere may hold others behind it, such as ATTACH.
static enum orl_result run_with_text(struct orl_database *db, const char *sql, const char *first,
                                     const char *second)
{
    sqlite3_stmt *statement = NULL;
    bool done = sqlite3_prepare_v2(db->handle, sql, -1, &statement, NULL) == SQLITE_OK &&
                (!first || sqlite3_bind_text(statement, 1, first, -1, SQLITE_STATIC) == SQLITE_OK) &&
                (!second ||
                 sqlite3_bind_text(statement, 2, second, -1, SQLITE_STATIC) == SQLITE_OK) &&
                (!statement || sqlite3_step(statement) == SQLITE_DONE);
    enum orl_result result = done ? ORL_OK : fail(db);
    sqlite3_finalize(statement);
    return result;
}

static enum orl_result attach(struct orl_database *db, const char *path)
{
    return run_with_text(db, "ATTACH ? AS part", path, NULL);
}

enum orl_result orl_database_detach(struct orl_database *db)
{
    return run_sql(db, "DETACH part");
}

// Databases of COLMAP 3.12 and later have rigs of cameras and frames of photographs that rigs take.
// Photographs of one camera each have a rig a camera and a frame a photograph.
static enum orl_result find_rigs(struct orl_database *db, bool *has)
{
    // One row is enough, and `ask` binds a number.
    return ask(db, "SELECT 1 FROM main.sqlite_master WHERE name = 'frames' LIMIT ?", 1, has);
}

// Runs `sql` on the attached database, at once or not at all.
static enum orl_result add_part(struct orl_database *db, const char *path, const char *sql)
{
    ORL_TRY(attach(db, path));
    enum orl_result result = run_sql(db, "BEGIN");
    ORL_THEN(result, run_sql(db, sql));
    if (result == ORL_OK)
        result = run_sql(db, "COMMIT");
    else
        sqlite3_exec(db->handle, "ROLLBACK", NULL, NULL, NULL);
    enum orl_result detached = orl_database_detach(db);
    return result == ORL_OK ? detached : result;
}

// All columns are copied, whatever a version of COLMAP calls them; only ids are moved.
#define MOVED(table, moves) \
    "CREATE TEMP TABLE moved AS SELECT * FROM part." table "; UPDATE moved SET " moves ";" \
    "INSERT INTO main." table " SELECT * FROM moved; DROP TABLE moved;"
#define PAST(id, table) id " = " id " + (SELECT past FROM " table "_past)"
#define BEGIN_MOVES(table, id) \
    "CREATE TEMP TABLE " table "_past AS SELECT coalesce(max(" id "), 0) AS past FROM main." table ";"
#define MOVES \
    BEGIN_MOVES("cameras", "camera_id") BEGIN_MOVES("images", "image_id") \
    MOVED("cameras", PAST("camera_id", "cameras")) \
    MOVED("images", PAST("image_id", "images") ", " PAST("camera_id", "cameras")) \
    MOVED("keypoints", PAST("image_id", "images")) MOVED("descriptors", PAST("image_id", "images"))
#define RIG_MOVES \
    BEGIN_MOVES("rigs", "rig_id") BEGIN_MOVES("frames", "frame_id") \
    MOVED("rigs", PAST("rig_id", "rigs") ", " PAST("ref_sensor_id", "cameras")) \
    MOVED("frames", PAST("frame_id", "frames") ", " PAST("rig_id", "rigs")) \
    MOVED("frame_data", PAST("frame_id", "frames") ", " PAST("data_id", "images") ", " \
                        PAST("sensor_id", "cameras"))
#define END_MOVES "DROP TABLE cameras_past; DROP TABLE images_past;"
#define END_RIG_MOVES "DROP TABLE rigs_past; DROP TABLE frames_past;"

enum orl_result orl_database_add_photographs(struct orl_database *db, const char *path)
{
    bool rigs = false;
    ORL_TRY(find_rigs(db, &rigs));
    return add_part(db, path, rigs ? MOVES RIG_MOVES END_MOVES END_RIG_MOVES : MOVES END_MOVES);
}

// The photograph `name` goes to the rig of the camera that it has.
static enum orl_result share_rig(struct orl_database *db, const char *name)
{
    ORL_TRY(run_with_text(
        db, "UPDATE frame_data SET sensor_id = (SELECT camera_id FROM images "
            "WHERE image_id = data_id) "
            "WHERE data_id = (SELECT image_id FROM images WHERE name = ?)", name, NULL));
    ORL_TRY(run_with_text(
        db, "UPDATE frames SET rig_id = (SELECT rig_id FROM rigs WHERE ref_sensor_id = "
            "(SELECT camera_id FROM images WHERE name = ?1)) "
            "WHERE frame_id = (SELECT frame_id FROM frame_data WHERE data_id = "
            "(SELECT image_id FROM images WHERE name = ?1))", name, NULL));
    return run_sql(db, "DELETE FROM rigs WHERE rig_id NOT IN (SELECT rig_id FROM frames)");
}

enum orl_result orl_database_share_camera(struct orl_database *db, const char *first,
                                          const char *name)
{
    bool rigs = false;
    ORL_TRY(run_with_text(
        db, "UPDATE images SET camera_id = (SELECT camera_id FROM images WHERE name = ?) "
            "WHERE name = ?", first, name));
    ORL_TRY(find_rigs(db, &rigs));
    if (rigs)
        ORL_TRY(share_rig(db, name));
    return run_sql(db, "DELETE FROM cameras WHERE camera_id NOT IN (SELECT camera_id FROM images)");
}

enum orl_result orl_database_add_matches(struct orl_database *db, const char *path)
{
    return add_part(db, path,
                    "INSERT OR REPLACE INTO main.matches SELECT * FROM part.matches;"
                    "INSERT OR REPLACE INTO main.two_view_geometries"
                    " SELECT * FROM part.two_view_geometries;");
}

#define COPIED(table) "INSERT INTO main." table " SELECT * FROM part." table ";"

// Makes the tables of the attached database, its cameras and its photographs.
static enum orl_result copy_tables(struct orl_database *db)
{
    static const char sql[] = "SELECT sql FROM part.sqlite_master WHERE sql IS NOT NULL "
                              "AND type IN ('table', 'index') AND name NOT LIKE 'sqlite_%'";
    sqlite3_stmt *statement = NULL;
    int step = SQLITE_ERROR;
    bool rigs = false;
    enum orl_result result = ORL_OK;
    if (sqlite3_prepare_v2(db->handle, sql, -1, &statement, NULL) == SQLITE_OK)
        while (result == ORL_OK && (step = sqlite3_step(statement)) == SQLITE_ROW)
            result = run_with_text(db, (const char *)sqlite3_column_text(statement, 0), NULL, NULL);
    if (result == ORL_OK && step != SQLITE_DONE)
        result = fail(db);
    sqlite3_finalize(statement);
    ORL_THEN(result, run_sql(db, COPIED("cameras") COPIED("images")));
    ORL_THEN(result, find_rigs(db, &rigs));
    if (result == ORL_OK && rigs)
        result = run_sql(db, COPIED("rigs") COPIED("frames") COPIED("frame_data"));
    return result;
}

enum orl_result orl_database_create_like(const struct orl_log *log, const char *path,
                                         const char *other, struct orl_database **db)
{
    struct orl_database made = {.log = log, .path = (char *)(uintptr_t)path};
    int flags = SQLITE_OPEN_READWRITE | SQLITE_OPEN_CREATE;
    enum orl_result result =
        open_file(path, flags, &made.handle) ? attach(&made, other) : fail(&made);
    *db = NULL;
    ORL_THEN(result, copy_tables(&made));
    sqlite3_close(made.handle);
    ORL_THEN(result, orl_database_open(log, path, db));
    return result == ORL_OK ? attach(*db, other) : result;
}

enum orl_result orl_database_take_features(struct orl_database *db, const char *name)
{
#define TAKEN(table) \
    "INSERT INTO main." table " SELECT * FROM part." table \
    " WHERE image_id = (SELECT image_id FROM main.images WHERE name = ?)"
    ORL_TRY(run_with_text(db, TAKEN("keypoints"), name, NULL));
    return run_with_text(db, TAKEN("descriptors"), name, NULL);
}
