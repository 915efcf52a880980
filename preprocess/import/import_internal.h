// What the steps of import share.
#ifndef ORL_PREPROCESS_IMPORT_INTERNAL_H
#define ORL_PREPROCESS_IMPORT_INTERNAL_H

#include "oriel/image.h"
#include "oriel/progress.h"
#include "preprocess/import/import_params.h"
#include "scene/known_cameras.h"

// What was found under a camera's name.
enum import_kind { IMPORT_NOTHING, IMPORT_PICTURE, IMPORT_FOLDER, IMPORT_CLIP };
struct import_found {
    enum import_kind kind;
    char *path; // owned
};

// One camera with its pictures.
struct import_view {
    const struct orl_colmap_image *image; // of the known cameras
    size_t camera;                        // index of its camera in their model
    char *name;                           // of the photograph in the scene; owned
    struct import_found picture, mask, background;
    bool test;
};

struct import_job {
    const struct orl_log *log;
    const struct orl_progress *progress;
    const struct orl_import_params *params;
    char *dir; // being filled; owned
    struct orl_known_cameras known;
    struct orl_camera *targets; // undistorted, one for each known camera; owned
    struct import_view *views;  // sorted by name; owned
    size_t view_count;
    bool sequence;      // the pictures are folders or clips
    size_t frame_count; // moments written
};

// --- import_scene.c: the folder ---

// "JOB->dir/name", released with free().
char *orl_import_path(const struct import_job *job, const char *format, ...) ORL_PRINTF(2, 3);

// --- import_find.c ---

// Looks in `dir` for what belongs to the camera `name`: a picture of this name, whatever its
// extension; a folder of this name with pictures or a clip (`role` where there are several); a
// clip of this name. `loosely`: also a picture whose name has it as a part. found->kind says.
enum orl_result orl_import_find(const struct orl_log *log, const char *dir, const char *name,
                                const char *role, bool loosely,
                                struct import_found *found) ORL_CHECK_RESULT;
void orl_import_found_finish(struct import_found *found);
// Pictures in a folder, sorted by name.
enum orl_result orl_import_list_pictures(const struct orl_log *log, const char *dir,
                                         struct orl_names *names) ORL_CHECK_RESULT;
// Finds each camera's picture, mask and background; names the photographs; holds out.
enum orl_result orl_import_find_all(struct import_job *job) ORL_CHECK_RESULT;

// --- import_frames.c: pictures of a folder or clip, one after another ---

struct import_frames {
    char *dir; // owned
    struct orl_names names;
    bool temporary; // decoded from a clip: `dir` is removed in the end
    size_t first, step, count;
};
enum orl_result orl_import_frames_open(const struct import_job *job, const struct import_found *found,
                                       const struct orl_frame_range *range,
                                       struct import_frames *frames) ORL_CHECK_RESULT;
// Path of picture i of frames->count, released with free().
char *orl_import_frames_path(const struct orl_log *log, const struct import_frames *frames, size_t i);
void orl_import_frames_close(const struct import_job *job, struct import_frames *frames);

// --- import_target.c ---

// The pinhole camera for the undistorted pictures: focal length as before, and the largest
// rectangle around the principal point that the distorted picture covers without gaps.
struct orl_camera orl_import_target(const struct orl_colmap_camera *from, int max_size);
// Do pictures stay as they are?
bool orl_import_is_same(const struct orl_colmap_camera *from, const struct orl_camera *to);

// --- import_pictures.c ---

// Undistorted photographs, silhouettes and backgrounds, of all moments.
enum orl_result orl_import_pictures(struct import_job *job) ORL_CHECK_RESULT;

// --- import_scene.c ---

// The model of the undistorted photographs, written to the folder `name`: all of them, or those
// that are not held out. Points and what sees them are those of `points`, whose photographs have
// the known cameras' names, or with `renamed` the scene's.
struct import_points {
    const struct orl_colmap_model *model;
    bool renamed;
};
enum orl_result orl_import_write_model(const struct import_job *job, const char *name, bool train_only,
                                       const struct import_points *points) ORL_CHECK_RESULT;
// points.ply from a cloud, or empty.
enum orl_result orl_import_write_points(const struct import_job *job, size_t *count) ORL_CHECK_RESULT;
enum orl_result orl_import_write_mesh(const struct import_job *job, size_t *triangles) ORL_CHECK_RESULT;
// scene.json, written last.
enum orl_result orl_import_write_manifest(const struct import_job *job, size_t points,
                                          size_t triangles) ORL_CHECK_RESULT;
// What import has to say in a scene.json that the stages of prepare have left.
enum orl_result orl_import_complete_manifest(const struct import_job *job,
                                             size_t triangles) ORL_CHECK_RESULT;

#endif
