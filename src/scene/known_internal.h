// Shared by the readers of known cameras.
#ifndef ORL_SCENE_KNOWN_INTERNAL_H
#define ORL_SCENE_KNOWN_INTERNAL_H

#include "scene/known_cameras.h"

// COLMAP's ids of the camera models that other programs' cameras are converted to.
enum { ORL_COLMAP_PINHOLE = 1, ORL_COLMAP_RADIAL = 3, ORL_COLMAP_OPENCV = 4,
       ORL_COLMAP_OPENCV_FISHEYE = 5, ORL_COLMAP_FULL_OPENCV = 6 };

// Larger files are refused.
#define ORL_KNOWN_FILE_MAX ((size_t)256 << 20)

// One camera of a file.
struct orl_known_camera {
    const char *path; // of the picture, as the file states it; the last part is the name
    int width, height; // 0 0: not stated
    int model;
    double params[12];
    struct orl_known_gap gap;
    struct orl_pose pose;
};

// Converts focal lengths, principal point and `count` of OpenCV's distortion terms k1 k2 p1 p2 k3
// k4 k5 k6 to the simplest COLMAP model.
void orl_known_set_opencv(struct orl_known_camera *camera, const double f_c[4],
                          const double *distortion, size_t count);
// Appends a camera. It is shared with the previous one when the two are equal. `place` names the
// camera in messages, such as "camera 3".
enum orl_result orl_known_add(const struct orl_log *log, const char *file, const char *place,
                              const struct orl_known_camera *camera,
                              struct orl_known_cameras *known) ORL_CHECK_RESULT;

enum orl_result orl_known_read_json(const struct orl_log *log, const char *path,
                                    double pixel_centre,
                                    struct orl_known_cameras *known) ORL_CHECK_RESULT;
enum orl_result orl_known_read_bundler(const struct orl_log *log, const char *path,
                                       double pixel_centre,
                                       struct orl_known_cameras *known) ORL_CHECK_RESULT;
enum orl_result orl_known_read_middlebury(const struct orl_log *log, const char *path,
                                          double pixel_centre,
                                          struct orl_known_cameras *known) ORL_CHECK_RESULT;

#endif
