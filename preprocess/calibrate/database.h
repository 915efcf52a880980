// COLMAP's database of features (SQLite).
#ifndef ORL_PREPROCESS_DATABASE_H
#define ORL_PREPROCESS_DATABASE_H

#include "core/log.h"

enum { ORL_SIFT_SIZE = 128 }; // bytes of a descriptor

struct orl_database;
// Opens a database that is there. ORL_ERR_FORMAT when it is not a database of COLMAP's.
enum orl_result orl_database_open(const struct orl_log *log, const char *path,
                                  struct orl_database **db) ORL_CHECK_RESULT;
void orl_database_close(struct orl_database **db);
// Descriptors of the `limit` features of largest scale of the photograph `name`, the largest first:
// *descriptors is released with free(). Without features *count is 0.
enum orl_result orl_database_descriptors(struct orl_database *db, const char *name, size_t limit,
                                         uint8_t **descriptors, size_t *count) ORL_CHECK_RESULT;
// COLMAP splits the lines of its pair lists at spaces. While a list is read, names in the database
// have '/' in place of ' ', which no name of a photograph holds otherwise.
enum orl_result orl_database_hide_spaces(struct orl_database *db, bool hide) ORL_CHECK_RESULT;

#endif
