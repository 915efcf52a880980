// COLMAP's database of features (SQLite).
#ifndef ORL_PREPROCESS_DATABASE_H
#define ORL_PREPROCESS_DATABASE_H

#include "oriel/log.h"
#include "preprocess/calibrate/sift_match.h"

struct orl_database;
// Opens a database that is there. ORL_ERR_FORMAT when it is not a database of COLMAP's.
enum orl_result orl_database_open(const struct orl_log *log, const char *path,
                                  struct orl_database **db) ORL_CHECK_RESULT;
void orl_database_close(struct orl_database **db);
// The `limit` features of largest scale of the photograph `name`, the largest first; 0: all, in COLMAP's
// order.
enum orl_result orl_database_features(struct orl_database *db, const char *name, size_t limit,
                                      struct orl_features *features) ORL_CHECK_RESULT;
// Makes photographs with fewer features than `least` ones without any.
enum orl_result orl_database_drop_features(struct orl_database *db, int least) ORL_CHECK_RESULT;
// Matches of two photographs, by COLMAP's ids: indices of their features.
enum orl_result orl_database_has_matches(struct orl_database *db, uint32_t a, uint32_t b,
                                         bool *has) ORL_CHECK_RESULT;
enum orl_result orl_database_write_matches(struct orl_database *db, uint32_t a, uint32_t b,
                                           uint32_t (*matches)[2], size_t count) ORL_CHECK_RESULT;
// True when the photograph has matches with any other that COLMAP uses.
enum orl_result orl_database_is_connected(struct orl_database *db, uint32_t id,
                                          bool *connected) ORL_CHECK_RESULT;
// False when a homography explains every pair that COLMAP verified: the camera turned on one spot, or
// the subject is flat.
enum orl_result orl_database_has_parallax(struct orl_database *db, bool *parallax) ORL_CHECK_RESULT;
// What is written between the two is written at once, or not at all.
enum orl_result orl_database_begin(struct orl_database *db) ORL_CHECK_RESULT;
enum orl_result orl_database_commit(struct orl_database *db) ORL_CHECK_RESULT;
// COLMAP splits the lines of its pair lists at spaces. While a list is read, names in the database
// have ORL_HIDDEN_SPACE in place of ' '; '/' stands in those of imported photographs in sub-folders.
#define ORL_HIDDEN_SPACE '\x1f'
enum orl_result orl_database_hide_spaces(struct orl_database *db, bool hide) ORL_CHECK_RESULT;

// --- databases of parts (parts.h) ---

// Adds the photographs of another database with their cameras and features, under new ids.
enum orl_result orl_database_add_photographs(struct orl_database *db,
                                             const char *path) ORL_CHECK_RESULT;
// Gives the photograph `name` the camera of `first`. Cameras that no photograph has are removed.
enum orl_result orl_database_share_camera(struct orl_database *db, const char *first,
                                          const char *name) ORL_CHECK_RESULT;
// Adds the matches of another database that has the same photographs under the same ids.
enum orl_result orl_database_add_matches(struct orl_database *db, const char *path) ORL_CHECK_RESULT;
// Makes a database with the cameras and photographs of `other` and without features. `other` is
// attached until orl_database_detach, and features of photographs are taken from it.
enum orl_result orl_database_create_like(const struct orl_log *log, const char *path,
                                         const char *other,
                                         struct orl_database **db) ORL_CHECK_RESULT;
enum orl_result orl_database_take_features(struct orl_database *db,
                                           const char *name) ORL_CHECK_RESULT;
enum orl_result orl_database_detach(struct orl_database *db) ORL_CHECK_RESULT;

#endif
