// Cameras that other programs have calibrated, in their own formats, as a COLMAP model.
#ifndef ORL_SCENE_KNOWN_CAMERAS_H
#define ORL_SCENE_KNOWN_CAMERAS_H

#include "oriel/scene.h"
#include "scene/colmap.h"

// What a file does not state about a camera, to be completed from one of its pictures.
struct orl_known_gap {
    bool size;        // the picture's size is missing
    bool centre;      // the principal point is missing: the picture's centre is used
    double fov_x_rad; // > 0: the focal length follows from this horizontal field of view
};

struct orl_known_cameras {
    // Cameras may be distorted. `pinhole` is unset while the picture's size is missing.
    struct orl_colmap_model model;
    struct orl_known_gap *gaps; // one for each camera of the model; owned
    // paths[i] is the stated path of the picture of the image with id i + 1, relative to
    // `folder`. Entries and the array may be NULL; owned.
    char **paths;
    size_t path_count;
    struct orl_room room; // that the file states
    char *folder; // owned; base of the paths, where pictures are searched for
};

// Reads cameras. The format is recognised by content:
// - a COLMAP model, or a folder that has one (sparse/0, sparse, or the folder itself);
// - cameras.json: {"pixel_centre": 0, "room": [[x, y, z], [x, y, z]], "cameras": [{"name", "width", "height", "K": 3 rows,
//   "R": 3 rows, "t", "dist": [k1, k2, p1, p2, k3, k4, k5, k6] or fewer}]}, x_cam = R x + t;
// - Inria's cameras.json; nerfstudio's transforms.json;
// - Bundler's bundle.out, with list.txt beside it; Middlebury's NAME_par.txt;
// - a folder with one of these files.
// `pixel_centre`: coordinate of the centre of the top left pixel in the file, 0 or 0.5. Negative:
// the format's convention, which is 0 for Middlebury and for a cameras.json without
// "pixel_centre", and 0.5 for other formats.
// Errors name the file, the line or camera, and the reason.
enum orl_result orl_known_cameras_read(const struct orl_log *log, const char *path,
                                       double pixel_centre,
                                       struct orl_known_cameras *known) ORL_CHECK_RESULT;
void orl_known_cameras_finish(struct orl_known_cameras *known);

// Completes camera `index` for a picture of this size. Where the file states a size, the picture
// must have its aspect ratio, and the camera is scaled to the picture. `name` is for messages.
enum orl_result orl_known_camera_settle(const struct orl_log *log,
                                        struct orl_known_cameras *known, size_t index,
                                        const char *name, int width,
                                        int height) ORL_CHECK_RESULT;

#endif
