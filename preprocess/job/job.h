// The job of oriel prepare: what it was given, the folder that it works in, and what the
// stages have found so far. The stages share it; it knows none of them.
#ifndef ORL_PREPROCESS_JOB_H
#define ORL_PREPROCESS_JOB_H

#include <jansson.h>

#include "oriel/progress.h"
#include "io/picture.h"
#include "preprocess/job/exposure_list.h"
#include "oriel/prepare_params.h"
#include "scene/colmap.h"

// In the order in which they run.
enum orl_stage_id {
    ORL_STAGE_COLLECT,
    ORL_STAGE_CALIBRATE,
    ORL_STAGE_UNDISTORT,
    ORL_STAGE_DENSIFY,
    ORL_STAGE_FUSE,
    ORL_STAGE_RADII,
    ORL_STAGE_GROUND,
    ORL_STAGE_EXPOSE,
    ORL_STAGE_COUNT
};

// A photograph that was given and can be read.
struct orl_source {
    char *name;     // owned; unique, also COLMAP's name for it
    char *given;    // owned; the name it was given under
    char *path;     // owned; absolute; what COLMAP reads
    char *original; // owned; absolute; what `path` was developed from, NULL: nothing
    char *mask; // owned; absolute path of its mask, NULL: none
    uint64_t hash, mask_hash;
    int width, height;
    struct orl_exif exif;
    bool test;
    bool deep;      // more than 8 bits a sample
    bool unbounded; // floats, whose white is a matter of choice
};

// A sparse model that was read once.
struct orl_job_model {
    struct orl_colmap_model model;
    bool known;
};

struct orl_job {
    const struct orl_log *log;
    const struct orl_progress *progress;
    const struct orl_prepare_params *params;
    char *dir;   // owned; the scene, absolute
    int lock_fd; // -1: not locked
    bool fresh;  // the folder was empty or new
    struct orl_source *sources; // owned; sorted by name
    size_t source_count, source_capacity;
    double linear_scale; // what light of unbounded sources is multiplied by, once developed
    size_t given;    // photographs found, readable or not
    json_t *skipped; // owned; [{"name", "why"}]
    json_t *stages;  // owned; .oriel/stages.json
    struct orl_job_model calibrated; // .oriel/calibrate/model, see orl_job_calibrated
    struct orl_job_model sparse;     // SCENE/sparse, see orl_job_sparse
    // COLMAP, once orl_job_find_colmap has been called.
    const char *colmap;
    char colmap_version[64];
    bool colmap_known, colmap_cuda;
    char keys[ORL_STAGE_COUNT][20]; // hexadecimal; what each stage's result depends on
    char exposures_hash[20];        // of the list of exposures; "": none
    struct orl_exposure_list exposures; // the list; owned
    // Of the programs run since the stage began.
    double child_cpu_s;
    size_t child_peak_bytes;
};

// Takes the folder params->out: makes it where it is not there, locks it. Whatever comes
// back, orl_job_close releases what the job holds.
enum orl_result orl_job_open(struct orl_job *job, const struct orl_log *log,
                             const struct orl_prepare_params *params,
                             const struct orl_progress *progress) ORL_CHECK_RESULT;
// Takes away what orl_job_open made: wrong input must not leave a folder that the next,
// right, command stumbles on. Does nothing to a folder that was there with something in it.
void orl_job_leave(const struct orl_job *job);
void orl_job_close(struct orl_job *job);
void orl_source_finish(struct orl_source *source);

// --- files in the scene ---

// Path inside the scene; released with free().
char *orl_job_path(const struct orl_job *job, const char *format, ...) ORL_PRINTF(2, 3);
// Removes SCENE/`name`, then renames SCENE/`temp` to it.
enum orl_result orl_job_replace(const struct orl_job *job, const char *temp,
                                const char *name) ORL_CHECK_RESULT;
// Removes SCENE/`name` and makes it an empty folder.
enum orl_result orl_job_fresh_dir(const struct orl_job *job, const char *name) ORL_CHECK_RESULT;
// A symbolic link at `path` to `target`, or a copy where the drive knows none (FAT).
enum orl_result orl_job_link(const struct orl_job *job, const char *target,
                             const char *path) ORL_CHECK_RESULT;
enum orl_result orl_job_remove(const struct orl_job *job, const char *name) ORL_CHECK_RESULT;
bool orl_job_has(const struct orl_job *job, const char *name);
// One line per name.
enum orl_result orl_job_write_list(const struct orl_job *job, const char *path,
                                   const struct orl_names *names) ORL_CHECK_RESULT;
// Says so when the scene's disk has hardly any room left.
void orl_job_hint_disk(const struct orl_job *job);

// --- photographs and their model ---

// log2 of its exposure, from the job's list or EXIF.
enum orl_exposure_source orl_source_exposure(const struct orl_job *job,
                                             const struct orl_source *source, double *ev);
const struct orl_source *orl_job_find(const struct orl_job *job, const char *name);
// The calibrated model, of the photographs as they were given. Read on the first call, owned
// by the job; it stays valid until another one is set.
enum orl_result orl_job_calibrated(struct orl_job *job,
                                   const struct orl_colmap_model **model) ORL_CHECK_RESULT;
// The same of the undistorted model in SCENE/sparse, whose photographs are all among the
// sources: orl_job_find finds each.
enum orl_result orl_job_sparse(struct orl_job *job,
                               const struct orl_colmap_model **model) ORL_CHECK_RESULT;
// Takes the undistorted model in SCENE/`name`, which will be SCENE/sparse, for the job's.
enum orl_result orl_job_set_sparse(struct orl_job *job, const char *name,
                                   const struct orl_colmap_model **model) ORL_CHECK_RESULT;
// Hands the calibrated model over, which is .oriel/calibrate/model now; *model is empty then.
void orl_job_set_calibrated(struct orl_job *job, struct orl_colmap_model *model);
// Names of the photographs in the undistorted model that are not held out.
enum orl_result orl_job_train_names(struct orl_job *job, struct orl_names *names) ORL_CHECK_RESULT;

#endif
