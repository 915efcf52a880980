// Cameras that other programs have calibrated, in their own formats, as a COLMAP model.
#ifndef ORL_SCENE_KNOWN_CAMERAS_H
#define ORL_SCENE_KNOWN_CAMERAS_H

#include "oriel/scene.h"
#include "scene/colmap.h"

// What a file does not state about a camera, to be completed from one of its pictures.
struct orl_known_gap {
    bool size;        // the picture's size is missing
    bool centre;      // the principal point is missing: the picture's centre is used
    double side;      // > 0: lengths are in units in which the larger side is so long, and the principal
                      // point is measured from the picture's centre
    double fov_x_rad; // > 0: the focal length follows from this horizontal field of view
};

// Where a photograph goes, as the file of cameras says.
enum orl_known_split { ORL_KNOWN_TRAIN, ORL_KNOWN_TEST, ORL_KNOWN_UNUSED };

// What a file states about a picture.
struct orl_known_picture {
    char *path; // '/' between its parts, relative to the file's folder; owned
    char *mask; // path of its mask; NULL: none is stated; owned
    enum orl_known_split split;
};

struct orl_known_cameras {
    // Cameras may be distorted. `pinhole` is unset while the picture's size is missing. Images are
    // named by the last part of their paths; where two of these are equal, by the paths without the
    // folders that all have in common.
    struct orl_colmap_model model;
    struct orl_known_gap *gaps; // one for each camera of the model; owned
    size_t gap_capacity;
    // pictures[i] is that of the image with id i + 1; NULL where files name no paths; owned.
    struct orl_known_picture *pictures;
    size_t picture_count, picture_capacity;
    bool splits;       // the file states which photographs are held out
    char points_file[ORL_PATH_SIZE]; // a cloud in the cameras' world, if it is there; "": none is stated
    // The file's coordinates minus `origin` are those of the model and the room.
    double origin[3];
    struct orl_room room; // that the file states
    char folder[ORL_PATH_SIZE]; // base of the paths, where pictures are searched for
};

// Reads cameras of any format in the table of known_formats.c, which is recognised by names of files
// and by their content. `path` is a file or a folder that has one. An info names the format.
// `pixel_centre`: coordinate of the centre of the top left pixel in the file, 0 or 0.5. Negative:
// the format's convention, which is 0 for Middlebury and for a cameras.json without
// "pixel_centre", and 0.5 for other formats.
// Where cameras are far from 0 compared with their distances, `origin` is taken off.
// Errors name the file, the line or camera, and the reason.
enum orl_result orl_known_cameras_read(const struct orl_log *log, const char *path,
                                       double pixel_centre,
                                       struct orl_known_cameras *known) ORL_CHECK_RESULT;
void orl_known_cameras_finish(struct orl_known_cameras *known);
// Finds a file that a file of cameras states, maybe with a path of another machine: at `stated`, else at
// the longest end of it that is there below `folder`. False: it is not here.
bool orl_known_find(const char *folder, const char *stated, char path[ORL_PATH_SIZE]);
// A table of the formats for a command's help, released with free().
char *orl_known_formats_text(const struct orl_log *log);

// Completes camera `index` for a picture of this size. Where the file states a size, the picture
// must have its aspect ratio, and the camera is scaled to the picture. `name` is for messages.
enum orl_result orl_known_camera_settle(const struct orl_log *log,
                                        struct orl_known_cameras *known, size_t index,
                                        const char *name, int width,
                                        int height) ORL_CHECK_RESULT;

#endif
