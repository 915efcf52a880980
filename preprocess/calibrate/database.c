#include "preprocess/calibrate/database.h"

#include <math.h>
#include <sqlite3.h>
#include <stdlib.h>
#include <string.h>

#include "core/memory.h"

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

enum orl_result orl_database_open(const struct orl_log *log, const char *path,
                                  struct orl_database **out)
{
    static const char sql[] =
        "SELECT k.rows, k.cols, k.data, d.rows, d.cols, d.data FROM images AS i "
        "LEFT JOIN keypoints AS k ON k.image_id = i.image_id "
        "LEFT JOIN descriptors AS d ON d.image_id = i.image_id WHERE i.name = ?";
    *out = NULL;
    struct orl_database *db = orl_array(log, 1, sizeof *db);
    if (!db)
        return ORL_ERR_MEMORY;
    db->log = log;
    db->path = orl_strdup(log, path);
    enum orl_result result = db->path ? ORL_OK : ORL_ERR_MEMORY;
    if (result == ORL_OK &&
        (sqlite3_open_v2(path, &db->handle, SQLITE_OPEN_READWRITE, NULL) != SQLITE_OK ||
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

struct ranked {
    float scale;
    size_t row;
};

static int by_scale(const void *a, const void *b)
{
    const struct ranked *x = a, *y = b;
    if (x->scale != y->scale)
        return x->scale < y->scale ? 1 : -1;
    return x->row < y->row ? -1 : x->row > y->row;
}

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

static enum orl_result take_largest(const struct orl_database *db, const struct table *keypoints,
                                    const struct table *all, size_t limit, uint8_t **descriptors,
                                    size_t *count)
{
    struct ranked *order = orl_array(db->log, all->rows, sizeof *order);
    size_t kept = all->rows < limit ? all->rows : limit;
    uint8_t *out = orl_array(db->log, kept, ORL_SIFT_SIZE);
    if (!order || !out) {
        free(order);
        free(out);
        return ORL_ERR_MEMORY;
    }
    for (size_t i = 0; i < all->rows; i++) {
        float keypoint[6];
        memcpy(keypoint, (const float *)keypoints->data + i * keypoints->columns,
               keypoints->columns * sizeof *keypoint);
        float scale = scale_of(keypoint, keypoints->columns);
        order[i] = (struct ranked){isfinite(scale) ? scale : 0, i};
    }
    qsort(order, all->rows, sizeof *order, by_scale);
    for (size_t i = 0; i < kept; i++)
        memcpy(out + i * ORL_SIFT_SIZE,
               (const uint8_t *)all->data + order[i].row * ORL_SIFT_SIZE, ORL_SIFT_SIZE);
    free(order);
    *descriptors = out;
    *count = kept;
    return ORL_OK;
}

enum orl_result orl_database_descriptors(struct orl_database *db, const char *name, size_t limit,
                                         uint8_t **descriptors, size_t *count)
{
    struct table keypoints, all;
    enum orl_result result = ORL_OK;
    *descriptors = NULL;
    *count = 0;
    sqlite3_bind_text(db->features, 1, name, -1, SQLITE_STATIC);
    int step = sqlite3_step(db->features);
    if (step == SQLITE_DONE)
        result = orl_fail(db->log, ORL_ERR_DATA, "%s: COLMAP has no features of %s", db->path,
                          name);
    else if (step != SQLITE_ROW)
        result = fail(db);
    else if (!get_table(db->features, 0, sizeof(float), &keypoints) ||
             !get_table(db->features, 3, 1, &all) || keypoints.rows != all.rows ||
             (all.rows && (all.columns != ORL_SIFT_SIZE ||
                           (keypoints.columns != 4 && keypoints.columns != 6))))
        result = orl_fail(db->log, ORL_ERR_FORMAT, "%s: the features of %s are damaged", db->path,
                          name);
    else if (all.rows)
        result = take_largest(db, &keypoints, &all, limit, descriptors, count);
    sqlite3_reset(db->features);
    return result;
}

enum orl_result orl_database_hide_spaces(struct orl_database *db, bool hide)
{
    const char *sql = hide ? "UPDATE images SET name = replace(name, ' ', '/')"
                           : "UPDATE images SET name = replace(name, '/', ' ')";
    return sqlite3_exec(db->handle, sql, NULL, NULL, NULL) == SQLITE_OK ? ORL_OK : fail(db);
}
