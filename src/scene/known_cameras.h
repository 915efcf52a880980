// Cameras that other programs have calibrated, in their own formats, as a COLMAP model.
#ifndef ORL_SCENE_KNOWN_CAMERAS_H
#define ORL_SCENE_KNOWN_CAMERAS_H

#include "scene/colmap.h"

// What a file leaves open about a camera until a picture of it is there.
struct orl_known_gap {
    bool size;        // the picture's size
    bool centre;      // the principal point: the picture's centre
    double fov_x_rad; // > 0: the focal length, by this horizontal angle
};

struct orl_known_cameras {
    // Distorted cameras too; without a picture's size `pinhole` is not set.
    struct orl_colmap_model model;
    struct orl_known_gap *gaps; // one for each camera of the model; owned
    // Where the file says the picture of the image with id i + 1 is, relative to the file's
    // folder; entries and the array may be NULL; owned.
    char **paths;
    size_t path_count;
    char *folder; // owned; that paths are relative to, and where pictures are looked for
};

// Reads by content:
// - a COLMAP model, or a folder that has one (sparse/0, sparse, or itself);
// - cameras.json: {"pixel_centre": 0, "cameras": [{"name", "width", "height", "K": 3 rows,
//   "R": 3 rows, "t", "dist": [k1, k2, p1, p2, k3, k4, k5, k6] or fewer}]}, x_cam = R x + t;
// - Inria's cameras.json; nerfstudio's transforms.json;
// - Bundler's bundle.out, with list.txt beside it; Middlebury's NAME_par.txt;
// - a folder with one of these files.
// `pixel_centre`: coordinate of the centre of the top left pixel in the file, 0 or 0.5; negative:
// as is the format's custom (0: Middlebury and cameras.json that do not say; else 0.5).
// Errors name the file, the line or camera, and the reason.
enum orl_result orl_known_cameras_read(const struct orl_log *log, const char *path,
                                       double pixel_centre,
                                       struct orl_known_cameras *known) ORL_CHECK_RESULT;
void orl_known_cameras_finish(struct orl_known_cameras *known);

// Completes camera `index` for a picture of this size. Where the file told a size, the picture
// must have its aspect, and the camera is scaled to it. `name` is for messages.
enum orl_result orl_known_camera_settle(const struct orl_log *log,
                                        struct orl_known_cameras *known, size_t index,
                                        const char *name, int width,
                                        int height) ORL_CHECK_RESULT;

#endif
