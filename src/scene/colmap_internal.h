// Shared by the readers and writers of COLMAP's models.
#ifndef ORL_SCENE_COLMAP_INTERNAL_H
#define ORL_SCENE_COLMAP_INTERNAL_H

#include "scene/colmap.h"

// How a camera model distorts: as OpenCV does, or not at all; by the angle from the axis; ...
enum orl_colmap_lens_kind { ORL_LENS_FLAT, ORL_LENS_FISHEYE, ORL_LENS_FOV, ORL_LENS_THIN_PRISM,
                            ORL_LENS_RAD_TAN_THIN_PRISM, ORL_LENS_DIVISION, ORL_LENS_EUCM };
struct orl_colmap_lens {
    int params;        // how many the model has
    int focal_lengths; // 1: they start with f cx cy; 2: with fx fy cx cy; distortion follows
    enum orl_colmap_lens_kind kind;
};
// All 0 when the model is unknown.
struct orl_colmap_lens orl_colmap_model_lens(int model);
// COLMAP's id of a model's name, -1 when it is unknown.
int orl_colmap_model_id(const char *name);

// True when a folder has a file of this name.
bool orl_colmap_has(const char *dir, const char *name);

// Fills camera->pinhole from model and params. NULL, or the problem in words.
const char *orl_colmap_camera_set(struct orl_colmap_camera *camera, uint64_t width,
                                  uint64_t height);
// The problem with a picture's name in words, or NULL. Names are joined to a folder and
// must not lead out of it.
const char *orl_colmap_name_problem(const char *name);

// Sorts images by name and checks that ids and names are unique and that cameras exist. `file` is
// for messages.
enum orl_result orl_colmap_check(const struct orl_log *log, const char *file,
                                 struct orl_colmap_model *model) ORL_CHECK_RESULT;
// Sorts cameras by id for look-up and checks that ids are unique.
enum orl_result orl_colmap_sort_cameras(const struct orl_log *log, const char *path,
                                        struct orl_colmap_model *model) ORL_CHECK_RESULT;

#endif
