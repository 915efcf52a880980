// The job of oriel prepare: its input, the folder that it works in, and the results of the stages
// so far. All stages share the job, which calls none of them.
#ifndef ORL_PREPROCESS_JOB_H
#define ORL_PREPROCESS_JOB_H

#include <jansson.h>

#include "core/file.h"
#include "oriel/gpu.h"
#include "oriel/progress.h"
#include "io/picture.h"
#include "preprocess/job/exposure_list.h"
#include "oriel/prepare_params.h"
#include "scene/colmap.h"

struct orl_scene;

// In the order in which the stages run.
enum orl_stage_id {
    ORL_STAGE_COLLECT,
    ORL_STAGE_CALIBRATE,
    ORL_STAGE_UNDISTORT,
    ORL_STAGE_DENSIFY,
    ORL_STAGE_FUSE,
    ORL_STAGE_RADII,
    ORL_STAGE_GROUND,
    ORL_STAGE_MESH,
    ORL_STAGE_EXPOSE,
    ORL_STAGE_TUNE,
    ORL_STAGE_OCCLUDERS,
    ORL_STAGE_COUNT
};

// A photograph of the input that can be read.
struct orl_source {
    char *name;     // owned; unique, also its name in COLMAP's database
    char *given;    // owned; its path in the input, below the folder that was given
    char *path;     // owned; absolute path of the file that COLMAP reads
    char *original; // owned; absolute path of the file that `path` was developed from, NULL: none
    char *mask; // owned; absolute path of its mask, NULL: none
    uint64_t hash, mask_hash;
    int width, height;
    struct orl_exif exif;
    int clip;       // the video that it is a frame of, from 1 on; 0: a photograph
    bool test;
    bool deep;      // more than 8 bits a sample
    bool profiled;  // JPEG and PNG: colours of another profile than sRGB
    bool gain_map;  // HDR by a gain map, which is not used
    bool unbounded; // floating point without a fixed white
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
    double linear_scale; // factor on the light of unbounded sources, once developed
    size_t given;    // number of photographs found, readable or not
    json_t *skipped; // owned; [{"name", "why"}]
    json_t *stages;  // owned; .oriel/stages.json
    // Sparse models; without images: not read yet.
    struct orl_colmap_model calibrated; // .oriel/calibrate/model, see orl_job_calibrated
    struct orl_colmap_model sparse;     // SCENE/sparse, see orl_job_sparse
    // COLMAP, once orl_job_find_colmap has been called.
    const char *colmap;
    char colmap_version[64];
    bool colmap_known, colmap_cuda;
    bool colmap_global;                 // has it global_mapper?
    bool colmap_features, colmap_seed; // has it COLMAP 4's option names for features, for seeds?
    char keys[ORL_STAGE_COUNT][20]; // hexadecimal; a hash of everything that a stage's result
                                    // depends on
    char exposures_hash[20];        // of the list of exposures; "": none
    struct orl_exposure_list exposures; // the list; owned
    // Processor time of child processes since the stage began.
    double child_cpu_s;
    size_t child_peak_bytes;
    struct orl_gpu *own_gpu; // owned; of orl_job_gpu where the parameters have none
    json_t *programs; // owned; {"COMMAND_s": its processor time} of the stage that runs
};

// Opens the folder params->out, which is made if needed, and locks it. On success and failure
// alike, the caller must call orl_job_close.
enum orl_result orl_job_open(struct orl_job *job, const struct orl_log *log,
                             const struct orl_prepare_params *params,
                             const struct orl_progress *progress) ORL_CHECK_RESULT;
// Joins the work on the scene params->out beside other such jobs and no prepare. The job has no
// sources. On success and failure alike, the caller must call orl_job_close.
enum orl_result orl_job_attach(struct orl_job *job, const struct orl_log *log,
                               const struct orl_prepare_params *params,
                               const struct orl_progress *progress) ORL_CHECK_RESULT;
// Makes the photographs of SCENE/sparse the sources of such a job, with their names alone. Those that
// are not in stereo/fusion.cfg are held out.
enum orl_result orl_job_take_sources(struct orl_job *job) ORL_CHECK_RESULT;
// Removes the folder that orl_job_open made, so that wrong input leaves no folder behind that the
// corrected command would refuse. Leaves a folder alone that held files before.
void orl_job_leave(const struct orl_job *job);
void orl_job_close(struct orl_job *job);
// The device of all stages: that of the parameters, or one that the first call opens and the job owns.
enum orl_result orl_job_gpu(struct orl_job *job, struct orl_gpu **gpu) ORL_CHECK_RESULT;
void orl_source_finish(struct orl_source *source);

// --- files in the scene ---

// Replaces SCENE/`name` by SCENE/`temp`.
enum orl_result orl_job_replace(const struct orl_job *job, const char *temp,
                                const char *name) ORL_CHECK_RESULT;
// Replaces SCENE/`name` by an empty folder.
enum orl_result orl_job_fresh_dir(const struct orl_job *job, const char *name) ORL_CHECK_RESULT;
// Makes a symbolic link at `path` to `target`, or a copy on a drive without links (FAT).
enum orl_result orl_job_link(const struct orl_job *job, const char *target,
                             const char *path) ORL_CHECK_RESULT;
enum orl_result orl_job_remove(const struct orl_job *job, const char *name) ORL_CHECK_RESULT;
bool orl_job_has(const struct orl_job *job, const char *name);
// Whether SCENE/`name`, which orl_job_write_key wrote, has the key that the stage has now.
bool orl_job_has_key(const struct orl_job *job, enum orl_stage_id stage, const char *name);
enum orl_result orl_job_write_key(const struct orl_job *job, enum orl_stage_id stage,
                                  const char *name) ORL_CHECK_RESULT;
// Writes job->stages.
enum orl_result orl_job_save_stages(const struct orl_job *job) ORL_CHECK_RESULT;
// Writes one name per line.
enum orl_result orl_job_write_list(const struct orl_job *job, const char *path,
                                   const struct orl_names *names) ORL_CHECK_RESULT;
// Says what `stage` is about to write and fails with ORL_ERR_IO when the scene's disk has not that
// much left.
enum orl_result orl_job_need_disk(const struct orl_job *job, const char *stage,
                                  double bytes) ORL_CHECK_RESULT;
// Logs a hint when the scene's disk is nearly full.
void orl_job_hint_disk(const struct orl_job *job);

// --- photographs and their model ---

// log2 of the photograph's exposure, from the job's list or EXIF. EXIF is ignored when the list holds EV,
// whose scale differs from that of EXIF.
enum orl_exposure_source orl_source_exposure(const struct orl_job *job,
                                             const struct orl_source *source, double *ev);
const struct orl_source *orl_job_find(const struct orl_job *job, const char *name);
// The calibrated model of the photographs as given. The first call reads it; the job owns it.
enum orl_result orl_job_calibrated(struct orl_job *job,
                                   const struct orl_colmap_model **model) ORL_CHECK_RESULT;
// The same for the undistorted model in SCENE/sparse, which stays valid until another is set. All of its
// photographs are among the sources: orl_job_find finds each.
enum orl_result orl_job_sparse(struct orl_job *job,
                               const struct orl_colmap_model **model) ORL_CHECK_RESULT;
// Opens the scene with this model, its points and held-out photographs as the sources say, before
// there is a scene.json. The caller destroys it.
enum orl_result orl_job_open_scene(struct orl_job *job, struct orl_scene **scene) ORL_CHECK_RESULT;
// Makes the undistorted model in SCENE/`name`, which will become SCENE/sparse, the job's.
enum orl_result orl_job_set_sparse(struct orl_job *job, const char *name,
                                   const struct orl_colmap_model **model) ORL_CHECK_RESULT;
// Names of the photographs in the undistorted model that are not held out.
enum orl_result orl_job_train_names(struct orl_job *job, struct orl_names *names) ORL_CHECK_RESULT;

// --- the stages, each in a file of its name ---

// Of `record`: what is worth keeping, such as settings as used, and counts.

// Lists and checks the photographs, and links them into .oriel/photos.
enum orl_result orl_stage_collect(struct orl_job *job) ORL_CHECK_RESULT;
// Leaves .oriel/calibrate/model, of the photographs that could be placed.
enum orl_result orl_stage_calibrate(struct orl_job *job, json_t *record) ORL_CHECK_RESULT;
// Makes the folder of the calibration ready for jobs (calibrate/parts.h), which keep what they have done.
enum orl_result orl_calibrate_begin(struct orl_job *job) ORL_CHECK_RESULT;
// Leaves SCENE/images and SCENE/sparse, and what travels with them (calibrate/companions.h).
enum orl_result orl_stage_undistort(struct orl_job *job, json_t *record) ORL_CHECK_RESULT;
// Writes SCENE/stereo.
enum orl_result orl_stage_densify(struct orl_job *job, json_t *record) ORL_CHECK_RESULT;
// Writes .oriel/fused.ply. Clouds of clusters that oriel job fuse has made are used.
enum orl_result orl_stage_fuse(struct orl_job *job, json_t *record) ORL_CHECK_RESULT;
json_t *orl_stage_fuse_settings(const struct orl_job *job);
// Writes SCENE/points.ply, with a radius and a normal for each point, or SCENE/points.lod where the
// cloud is larger than memory, and removes the other.
enum orl_result orl_stage_radii(struct orl_job *job, json_t *record) ORL_CHECK_RESULT;
json_t *orl_stage_radii_settings(const struct orl_job *job);
// Sets "ground" of `record` to the plane that the points tell, so that no one who opens the scene need look
// for it; null when there is no ground.
enum orl_result orl_stage_ground(struct orl_job *job, json_t *record) ORL_CHECK_RESULT;
// Writes SCENE/mesh.ply as params->mesh asks. ORL_ERR_EXTERNAL: COLMAP failed, or was built without
// the mesher.
enum orl_result orl_stage_mesh(struct orl_job *job, json_t *record) ORL_CHECK_RESULT;
// Sets exposure, series, gain, vignetting and response of every photograph in `record`.
enum orl_result orl_stage_expose(struct orl_job *job, json_t *record) ORL_CHECK_RESULT;
// Renders some training photographs, each from the others, and sets in `record` what brings them closer: "tuned", the
// settings of the scene's method as orl_search_record has them, and "backdrop" (orl_manifest_backdrop). Held-out
// photographs take no part. Without a device, or with fewer than five photographs, "tuned" is empty and the backdrop
// moves.
enum orl_result orl_stage_tune(struct orl_job *job, json_t *record) ORL_CHECK_RESULT;
// Writes SCENE/occluders/NAME.png of each training photograph that shows any, and sets "occluded" in
// `record`: the share of the picture by name. Without a device, or with too few photographs, none
// are found.
enum orl_result orl_stage_occluders(struct orl_job *job, json_t *record) ORL_CHECK_RESULT;

#endif
