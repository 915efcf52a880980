// Matches between the photographs' features, for the pairs that are worth it, verified by COLMAP.
#ifndef ORL_PREPROCESS_MATCH_H
#define ORL_PREPROCESS_MATCH_H

#include "preprocess/calibrate/database.h"
#include "preprocess/calibrate/pairs.h"
#include "preprocess/job/job.h"

#define ORL_CALIBRATE_WORK ".oriel/calibrate.tmp" // where calibrate works, inside the scene
#define ORL_CALIBRATE_NORMALISED ORL_CALIBRATE_WORK "/normalised" // what features are taken from
#define ORL_CALIBRATE_STEM ORL_CALIBRATE_WORK "/database" // without its extension
#define ORL_CALIBRATE_DATABASE ORL_CALIBRATE_STEM ".db"

// Opens the database `name`, a name below the scene; closed with orl_database_close.
enum orl_result orl_match_open_database(const struct orl_job *job, const char *name,
                                        struct orl_database **db) ORL_CHECK_RESULT;
// The way that this choice and this many photographs ask for; never auto.
enum orl_matching orl_match_way(enum orl_matching asked, size_t photographs);
// Removes a database with what SQLite keeps beside it: a program that was killed leaves a log there, which SQLite would
// replay into another database of this name.
enum orl_result orl_match_remove_database(const struct orl_job *job, const char *name) ORL_CHECK_RESULT;
// What retrieval did.
struct orl_match_summary {
    size_t tried, chosen; // pairs
    double choosing_s;
};
// guided: COLMAP also looks for matches by the geometry that it verified. marked: by other ways than retrieval, pairs
// of marked photographs alone; NULL: all. Pairs that have matches keep them. summary: stays as it is by other ways than
// retrieval, and may be NULL for them.
enum orl_result orl_match(struct orl_job *job, enum orl_matching way, bool guided, const bool *marked,
                          struct orl_match_summary *summary) ORL_CHECK_RESULT;
// Chooses pairs by retrieval from the features in `database`, a name below the scene. *list is
// released with orl_pairs_finish.
enum orl_result orl_match_choose(struct orl_job *job, const char *database,
                                 struct orl_pair_list *list,
                                 struct orl_match_summary *summary) ORL_CHECK_RESULT;
// Writes Oriel's own matches of `count` pairs of the list, from `first` on, into the database. Pairs that
// have matches keep them. The features of all photographs of the pairs are in memory at once.
enum orl_result orl_match_features(const struct orl_job *job, struct orl_database *db,
                                   const struct orl_pair_list *list, size_t first,
                                   size_t count) ORL_CHECK_RESULT;
// Matches these pairs and has COLMAP verify the matches, in `database`, a name below the scene; guided: as above.
enum orl_result orl_match_list(struct orl_job *job, const char *database, bool guided,
                               const struct orl_pair_list *list) ORL_CHECK_RESULT;

#endif
