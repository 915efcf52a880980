// What the stages of prepare share. Internal to preprocess/.
#ifndef ORL_PREPROCESS_JOB_H
#define ORL_PREPROCESS_JOB_H

#include <jansson.h>

#include "io/picture.h"
#include "preprocess/expose.h"
#include "preprocess/prepare.h"
#include "scene/colmap.h"

enum orl_stage_id {
    ORL_STAGE_COLLECT,
    ORL_STAGE_CALIBRATE,
    ORL_STAGE_UNDISTORT,
    ORL_STAGE_DENSIFY,
    ORL_STAGE_FUSE,
    ORL_STAGE_RADII,
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
    // COLMAP, once orl_job_find_colmap has been called.
    const char *colmap;
    char colmap_version[64];
    bool colmap_known, colmap_cuda;
    char keys[ORL_STAGE_COUNT][20]; // hexadecimal
    char exposures_hash[20];        // of the list of exposures; "": none
    struct orl_exposure_list exposures; // the list; owned
    // Of the programs run since the stage began.
    double child_cpu_s;
    size_t child_peak_bytes;
};

// --- job.c ---

// Path inside the scene; released with free().
char *orl_job_path(const struct orl_job *job, const char *format, ...) ORL_PRINTF(2, 3);
// Removes SCENE/`name`, then renames SCENE/`temp` to it.
enum orl_result orl_job_replace(const struct orl_job *job, const char *temp,
                                const char *name) ORL_CHECK_RESULT;
// Removes SCENE/`name` and makes it an empty folder.
enum orl_result orl_job_fresh_dir(const struct orl_job *job, const char *name) ORL_CHECK_RESULT;
// A symbolic link at `path` to `target`.
enum orl_result orl_job_link(const struct orl_job *job, const char *target,
                             const char *path) ORL_CHECK_RESULT;
enum orl_result orl_job_remove(const struct orl_job *job, const char *name) ORL_CHECK_RESULT;
bool orl_job_has(const struct orl_job *job, const char *name);
// Names of the photographs that are registered in the undistorted model, split.
enum orl_result orl_job_registered(const struct orl_job *job, struct orl_names *train,
                                   struct orl_names *test) ORL_CHECK_RESULT;
const struct orl_source *orl_job_find(const struct orl_job *job, const char *name);
// One line per name.
enum orl_result orl_job_write_list(const struct orl_job *job, const char *path,
                                   const struct orl_names *names) ORL_CHECK_RESULT;
// The key that a stage's result has with these inputs and settings (prepare.c).
const char *orl_job_key(const struct orl_job *job, enum orl_stage_id stage);
// The settings of this job, for scene.json (prepare.c).
json_t *orl_job_settings(const struct orl_job *job);
// Says so when the scene's disk has hardly any room left.
void orl_job_hint_disk(const struct orl_job *job);

// --- colmap_run.c ---

enum { ORL_COLMAP_ARGS_MAX = 64 };
// A command line being put together. Text is copied.
struct orl_colmap_args {
    char *items[ORL_COLMAP_ARGS_MAX + 1];
    size_t count;
    bool failed; // no memory or no room
};
void orl_colmap_arg(struct orl_colmap_args *args, const char *name, const char *format,
                    ...) ORL_PRINTF(3, 4);
// Finds COLMAP, its version and whether it can use CUDA. ORL_ERR_EXTERNAL, with
// advice, when it cannot be run.
enum orl_result orl_job_find_colmap(struct orl_job *job) ORL_CHECK_RESULT;
// Runs `colmap COMMAND ...` and releases args. Progress is read from its output:
// `done` of `total` units are finished already, and it adds up to `share` of them.
struct orl_colmap_run {
    const char *command, *step;
    double done, share, total;
    const char *tolerated; // failing is fine when it prints this; NULL: never
};
enum orl_result orl_job_colmap(struct orl_job *job, const struct orl_colmap_run *run,
                               struct orl_colmap_args *args) ORL_CHECK_RESULT;
// Progress in [0, 1) that a line of COLMAP's output tells; negative: none. `total`
// is the number of photographs, for the mapper's lines.
double orl_colmap_line_progress(const char *line, double total);

// --- advice.c: what was given in place of photographs of a scene ---

// `extensions` ends with NULL; case does not matter.
bool orl_has_extension(const char *name, const char *const *extensions);
// By extension.
bool orl_is_photo_name(const char *name);
bool orl_is_video_name(const char *name);
// ORL_ERR_DATA: a video was named as a photograph.
enum orl_result orl_fail_video(const struct orl_job *job, const char *path) ORL_CHECK_RESULT;
// ORL_ERR_NOT_FOUND, with what else is in `dir`: folders of photographs, videos.
enum orl_result orl_fail_no_photos(const struct orl_job *job, const char *dir) ORL_CHECK_RESULT;
// How many views the photographs show, those of a camera that stood still being one whatever
// their exposure and whoever walked by. Counts up to `enough`.
enum orl_result orl_count_views(const struct orl_job *job, size_t enough,
                                size_t *views) ORL_CHECK_RESULT;

// --- develop.c: photographs that COLMAP cannot read, or with more than 8 bits ---

// By its extension: does COLMAP need an 8-bit twin of it?
bool orl_develop_wanted(const char *name);
// The twin's name, released with free().
char *orl_develop_name(const struct orl_log *log, const char *name);
// Makes the twins that are not there yet: source->path becomes the twin's.
enum orl_result orl_develop(struct orl_job *job) ORL_CHECK_RESULT;
// Linear light of all deep photographs in the model SCENE/`sparse`, as SCENE/`out`/NAME.exr.
enum orl_result orl_develop_undistort(const struct orl_job *job, const char *sparse,
                                      const char *out, size_t *written) ORL_CHECK_RESULT;

// --- exposures ---

enum orl_exposure_source {
    ORL_EXPOSURE_UNKNOWN,
    ORL_EXPOSURE_EXIF,
    ORL_EXPOSURE_LIST,
    ORL_EXPOSURE_SCENE, // estimated
};
// log2 of the photograph's exposure from the list or EXIF. A list of EV has a scale of its
// own, which EXIF does not share: then EXIF says nothing.
enum orl_exposure_source orl_source_exposure(const struct orl_exposure_list *list,
                                             const struct orl_source *source, double *ev);
// normalise.c: do exposures differ so much that features need brightened copies?
bool orl_normalise_wanted(const struct orl_job *job);
// Fills SCENE/`dir` with brightened copies of dark photographs, counted, and links to the
// others; does nothing when they are not wanted.
enum orl_result orl_normalise(const struct orl_job *job, const char *dir,
                              size_t *copies) ORL_CHECK_RESULT;

// --- the stages ---
// Each leaves whole results under their final names or fails. `record` takes what
// is worth keeping: settings as used, counts.

// Lists and checks the photographs, and links them into .oriel/photos.
enum orl_result orl_stage_collect(struct orl_job *job) ORL_CHECK_RESULT;
enum orl_result orl_stage_calibrate(struct orl_job *job, json_t *record) ORL_CHECK_RESULT;
enum orl_result orl_stage_undistort(struct orl_job *job, json_t *record) ORL_CHECK_RESULT;
enum orl_result orl_stage_densify(struct orl_job *job, json_t *record) ORL_CHECK_RESULT;
enum orl_result orl_stage_fuse(struct orl_job *job, json_t *record) ORL_CHECK_RESULT;
enum orl_result orl_stage_radii(struct orl_job *job, json_t *record) ORL_CHECK_RESULT;
enum orl_result orl_stage_expose(struct orl_job *job, json_t *record) ORL_CHECK_RESULT;
// Writes scene.json from all that is there.
enum orl_result orl_stage_manifest(struct orl_job *job) ORL_CHECK_RESULT;

// --- shared settings ---

int orl_job_max_size(const struct orl_prepare_params *params);

#endif
