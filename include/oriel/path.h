// Camera paths: sequences of views to render.
#ifndef ORIEL_PATH_H
#define ORIEL_PATH_H

#include "oriel/scene.h"

struct orl_path {
    struct orl_view *views;
    size_t count;
};

// Reads, by content:
// - Oriel keyframes: {"keyframes": [KEY, ...], "frames": N}, KEY one of
//   {"photo": NAME}, {"position": [x,y,z], "target": [x,y,z], "up": [x,y,z]} or
//   {"cam_from_world": 3 rows of 4}, each with optional "fov_y_deg"; frames are spread
//   evenly, centres along a Catmull-Rom spline, rotations by slerp. Without "frames" the
//   keyframes themselves.
// - nerfstudio camera_path.json, Inria cameras.json, COLMAP images.txt (with cameras.txt
//   beside it, else the scene's first camera).
// Keys that do not say otherwise have the intrinsics of the scene's first photograph.
// Errors name the file, the entry and the reason.
enum orl_result orl_path_read(const struct orl_log *log, const struct orl_scene *scene,
                              const char *file, struct orl_path *path) ORL_CHECK_RESULT;
// A smooth walk past all photographs in name order; frames >= 2.
enum orl_result orl_path_through_photos(const struct orl_log *log, const struct orl_scene *scene,
                                        size_t frames, struct orl_path *path) ORL_CHECK_RESULT;
void orl_path_finish(struct orl_path *path);

// The same view for a picture of another size and aspect: vertical field of view and
// square pixels are kept.
struct orl_camera orl_camera_reframed(const struct orl_camera *camera, int width, int height);

#endif
