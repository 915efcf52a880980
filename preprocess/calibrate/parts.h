// Calibration as jobs: features and matches of parts, which several machines make, each in a
// database of its own. Calibrate joins them (docs/how/scale.md).
#ifndef ORL_PREPROCESS_PARTS_H
#define ORL_PREPROCESS_PARTS_H

#include "preprocess/calibrate/features.h"
#include "preprocess/calibrate/match.h"

#define ORL_PARTS_STATE ORL_CALIBRATE_WORK "/work.json" // what the jobs need, below the scene

// Leaves what the jobs need in the folder of the calibration, and keeps what they have done for this
// key. Called with the folder's brightened copies made.
enum orl_result orl_parts_begin(struct orl_job *job,
                                const struct orl_camera_groups *groups) ORL_CHECK_RESULT;
// True when orl_parts_begin was called with this key.
bool orl_parts_begun(const struct orl_job *job);
// Sets *joined when the jobs have done all; the database then has all features and matches.
enum orl_result orl_parts_join(struct orl_job *job, struct orl_match_summary *summary,
                               bool *joined) ORL_CHECK_RESULT;
// Removes what the jobs have left.
enum orl_result orl_parts_remove(const struct orl_job *job) ORL_CHECK_RESULT;

#define ORL_PART_STEPS(NAME) \
    NAME(ORL_PART_FEATURES, "features") NAME(ORL_PART_PAIRS, "pairs") \
    NAME(ORL_PART_MATCHES, "matches")
enum orl_part_step { ORL_PART_STEPS(ORL_ENUMERATOR) };
extern const char *const orl_part_step_names[]; // NULL after the last

// Runs a job of the calibration that has begun in `scene`: the features of one part of the
// photographs; the choice of pairs, from the features of all parts; or the matches of one part of
// the chosen pairs. Does nothing when its result is there.
// ORL_ERR_DATA: what it needs is missing.
enum orl_result orl_part_run(const struct orl_log *log, const char *scene, enum orl_part_step step,
                             int part, int parts,
                             const struct orl_progress *progress) ORL_CHECK_RESULT;

#endif
