// Private to import: what its steps share.
#ifndef ORL_PREPROCESS_IMPORT_INTERNAL_H
#define ORL_PREPROCESS_IMPORT_INTERNAL_H

#include "core/new_dir.h"
#include "oriel/image.h"
#include "oriel/progress.h"
#include "preprocess/import/import_params.h"
#include "scene/known_cameras.h"

// The kind of file that was found under a camera's name.
enum import_kind { IMPORT_NOTHING, IMPORT_PICTURE, IMPORT_FOLDER, IMPORT_CLIP };
struct import_found {
    enum import_kind kind;
    char *path; // owned
};

// One camera with its pictures.
struct import_view {
    const struct orl_colmap_image *image; // one of the known cameras
    size_t camera;                        // index of its camera in the known cameras' model
    char *name;                           // name of the photograph in the scene; owned
    struct import_found picture, mask, background;
    bool composed; // its picture had alpha, and lies on white
    bool gain_map; // its picture is HDR by a gain map
    bool masked;   // has a silhouette in the scene
    int orientation; // by EXIF; 0: not known
    bool test;
};

struct import_job {
    const struct orl_log *log;
    const struct orl_progress *progress;
    const struct orl_import_params *params;
    struct orl_new_dir new_dir;
    const char *dir; // the folder that is filled, of new_dir
    struct orl_known_cameras known;
    struct orl_camera *targets; // undistorted, one for each known camera; owned
    struct import_view *views;  // sorted by name; owned
    size_t view_count;
    const char **why_not; // why a known camera is left out; NULL: it is not; owned
    bool sequence;      // true when the pictures are folders or clips
    size_t frame_count; // frames of the sequence that were written
    size_t mask_count, empty_masks; // silhouettes that were written, and those without a subject
    char *first_empty; // file or picture of the first such; owned
    bool said_endless;  // see orl_cones_mesh
};

// --- import_find.c ---

void orl_import_found_finish(struct import_found *found);
// Lists the pictures in a folder, sorted by name.
enum orl_result orl_import_list_pictures(const struct orl_log *log, const char *dir,
                                         struct orl_names *names) ORL_CHECK_RESULT;
// Finds each camera's picture, mask and background, names the photographs and marks the held-out
// ones.
enum orl_result orl_import_find_all(struct import_job *job) ORL_CHECK_RESULT;

// --- import_frames.c: pictures of a folder or clip, one after another ---

struct import_frames {
    char *dir; // owned
    struct orl_names names;
    bool temporary; // decoded from a clip; `dir` is removed when the frames are released
    size_t first, step, count;
};
enum orl_result orl_import_frames_open(const struct import_job *job, const struct import_found *found,
                                       const struct orl_frame_range *range,
                                       struct import_frames *frames) ORL_CHECK_RESULT;
// Path of picture i of frames->count (ORL_PATH).
#define IMPORT_FRAME_PATH(frames, i) \
    ORL_PATH((frames)->dir, "%s", (frames)->names.items[(frames)->first + (i) * (frames)->step])
void orl_import_frames_close(const struct import_job *job, struct import_frames *frames);

// --- import_target.c ---

// The pinhole camera for the undistorted pictures: the same focal length, and the largest rectangle
// around the principal point that the distorted picture covers without gaps.
struct orl_camera orl_import_target(const struct orl_colmap_camera *from, int max_size);
// True when undistortion leaves the pictures unchanged.
bool orl_import_is_same(const struct orl_colmap_camera *from, const struct orl_camera *to);

// --- import_pictures.c ---

// Writes undistorted photographs, silhouettes and backgrounds of all frames.
enum orl_result orl_import_pictures(struct import_job *job) ORL_CHECK_RESULT;

// --- import_scene.c ---

// Writes the model of the undistorted photographs to the folder `name`. for_database: those that are
// not held out, each with a camera of its own, as COLMAP's database has them: from 4.0 on it asks that
// photographs have the same cameras in both. Points and their tracks come from `points`, whose
// photographs have the known cameras' names, or with `renamed` the scene's.
struct import_points {
    const struct orl_colmap_model *model;
    bool renamed;
};
enum orl_result orl_import_write_model(const struct import_job *job, const char *name, bool for_database,
                                       const struct import_points *points) ORL_CHECK_RESULT;
// Writes points.ply from a cloud, or without points.
enum orl_result orl_import_write_points(const struct import_job *job, size_t *count) ORL_CHECK_RESULT;
enum orl_result orl_import_write_mesh(struct import_job *job, size_t *triangles) ORL_CHECK_RESULT;
// Writes scene.json, which must be the last file, or adds the part of import to the one that the stages of
// prepare wrote.
enum orl_result orl_import_write_manifest(const struct import_job *job, size_t points,
                                          size_t triangles) ORL_CHECK_RESULT;

#endif
