// Shared by the readers of known cameras.
#ifndef ORL_SCENE_KNOWN_INTERNAL_H
#define ORL_SCENE_KNOWN_INTERNAL_H

#include <jansson.h>

#include "scene/known_cameras.h"

// Larger files of JSON are refused.
#define ORL_KNOWN_FILE_MAX ((size_t)256 << 20)

// One camera of a file.
struct orl_known_camera {
    const char *place; // names the camera in messages, such as "camera 3"
    const char *path;  // of the picture, as the file states it
    const char *mask; // likewise; NULL: none
    enum orl_known_split split;
    int width, height; // 0 0: not stated
    int model;
    double params[ORL_COLMAP_PARAMS];
    struct orl_known_gap gap;
    struct orl_pose pose;
};

// Logs what is wrong with a camera of a file; returns ORL_ERR_FORMAT.
enum orl_result orl_known_bad(const struct orl_log *log, const char *file, const char *place, const char *what);
// Appends a camera of a file. It is shared with the previous one when the two are equal.
enum orl_result orl_known_add(const struct orl_log *log, const char *file, const struct orl_known_camera *camera,
                              struct orl_known_cameras *known) ORL_CHECK_RESULT;
// Sets the images' names from the pictures' paths.
enum orl_result orl_known_name_images(const struct orl_log *log, const char *file,
                                      struct orl_known_cameras *known) ORL_CHECK_RESULT;
// Chooses known->origin and takes it off.
enum orl_result orl_known_place(const struct orl_log *log,
                                struct orl_known_cameras *known) ORL_CHECK_RESULT;
// Logs what was read of a format from a file.
void orl_known_say_read(const struct orl_log *log, const char *file, const char *format,
                        const struct orl_known_cameras *known);
// Sets the folder that pictures are relative to, of the file that was found at `path`, a file or folder.
void orl_known_set_folder(const char *path, const char *found, struct orl_known_cameras *known);

// True for the root of Oriel's own cameras.json.
bool orl_known_is_own(const json_t *root);
// Reads it. pixel_centre: as that of orl_known_cameras_read.
enum orl_result orl_known_read_own(const struct orl_log *log, const char *path, double pixel_centre,
                                   const json_t *root, struct orl_known_cameras *known) ORL_CHECK_RESULT;
// Reads a file or folder of any other program but COLMAP by way of the script, which needs python3.
enum orl_result orl_known_read_converted(const struct orl_log *log, const char *path, double pixel_centre,
                                         struct orl_known_cameras *known) ORL_CHECK_RESULT;
extern const char orl_known_script[]; // known_cameras.py

#endif
