// Camera paths: sequences of views to render.
#ifndef ORIEL_PATH_H
#define ORIEL_PATH_H

#include "oriel/scene.h"

struct orl_path {
    struct orl_view *views;
    size_t count;
};

// Reads a path. The format is recognised by content:
// - Oriel keyframes: {"keyframes": [KEY, ...], "frames": N}. KEY is one of
//   {"photo": NAME}, {"position": [x,y,z], "target": [x,y,z], "up": [x,y,z]} and
//   {"cam_from_world": 3 rows of 4}, each with optional "fov_y_deg" and "seconds" to the next KEY (1).
//   The N frames are spread evenly in time: centres follow a cubic spline, Catmull-Rom's where all
//   seconds are equal, rotations are interpolated by slerp. Without "frames" the path consists of the
//   keyframes themselves.
// - nerfstudio camera_path.json, Inria cameras.json, COLMAP images.txt (cameras come from
//   cameras.txt beside it, or else from the scene's first photograph). They are in the coordinates of
//   the file of cameras that was imported, from which scene->origin is taken off.
// Keyframes without intrinsics of their own take those of the scene's first photograph.
// Errors name the file, the entry and the reason.
enum orl_result orl_path_read(const struct orl_log *log, const struct orl_scene *scene,
                              const char *file, struct orl_path *path) ORL_CHECK_RESULT;
// A smooth walk past all photographs in name order; frames >= 2.
enum orl_result orl_path_through_photos(const struct orl_log *log, const struct orl_scene *scene,
                                        size_t frames, struct orl_path *path) ORL_CHECK_RESULT;
// A circle around what the photographs look at, the point nearest to their optical axes, at the mean
// of their distances and heights, upright as they are on average. It starts beside the first
// photograph, whose intrinsics it has, and ends one step before its start. ORL_ERR_DATA: the axes
// do not meet before the cameras.
enum orl_result orl_path_around(const struct orl_log *log, const struct orl_scene *scene,
                                size_t frames, struct orl_path *path) ORL_CHECK_RESULT;
void orl_path_finish(struct orl_path *path);

// The camera for a picture of another size and aspect. The vertical field of view stays the same
// and square pixels stay square.
struct orl_camera orl_camera_reframed(const struct orl_camera *camera, int width, int height);

#endif
