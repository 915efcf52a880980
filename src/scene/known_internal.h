// Shared by the readers of known cameras.
#ifndef ORL_SCENE_KNOWN_INTERNAL_H
#define ORL_SCENE_KNOWN_INTERNAL_H

#include <jansson.h>

#include "oriel/names.h"
#include "scene/known_cameras.h"
#include "scene/text_lines.h"

// COLMAP's ids of the camera models that other programs' cameras are converted to.
enum { ORL_COLMAP_PINHOLE = 1, ORL_COLMAP_RADIAL = 3, ORL_COLMAP_OPENCV = 4,
       ORL_COLMAP_OPENCV_FISHEYE = 5, ORL_COLMAP_FULL_OPENCV = 6 };

// Larger files are refused.
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

// Converts focal lengths, principal point and `count` of OpenCV's distortion terms, k1 k2 p1 p2 k3
// k4 k5 k6 or of a fisheye k1 k2 k3 k4, to the simplest COLMAP model.
void orl_known_set_lens(struct orl_known_camera *camera, const double f_c[4], const double *distortion,
                        size_t count, bool fisheye);
// Appends a point, unless it is not finite or absurdly far.
enum orl_result orl_known_add_point(const struct orl_log *log, const double position[3],
                                    const double rgb[3],
                                    struct orl_colmap_model *model) ORL_CHECK_RESULT;
// Notes that an image sees a point.
enum orl_result orl_known_add_view(const struct orl_log *log, size_t image, uint32_t point,
                                   struct orl_colmap_model *model) ORL_CHECK_RESULT;
// Reads the rest of a line: the number of a point's views, then of each its camera's index, the feature's
// index, x and y. image_of[camera]: its image, -1: none; NULL: that of the same index. Notes them unless
// the point, at the end of the model, was left out.
enum orl_result orl_known_read_views(struct orl_text_lines *l, uint64_t camera_count,
                                     const int64_t *image_of, size_t points_before,
                                     struct orl_colmap_model *model) ORL_CHECK_RESULT;
// Sets the images' names from the pictures' paths.
enum orl_result orl_known_name_images(const struct orl_log *log, const char *file,
                                      struct orl_known_cameras *known) ORL_CHECK_RESULT;
// Chooses known->origin and takes it off.
enum orl_result orl_known_place(const struct orl_log *log,
                                struct orl_known_cameras *known) ORL_CHECK_RESULT;

// What a reader is given.
struct orl_known_source {
    const struct orl_log *log;
    const char *path;    // of the file or, for formats of many files, the folder
    double pixel_centre; // negative: the format's convention
    double shift;        // added to the file's pixel coordinates, gives COLMAP's
    const json_t *root;  // of a file in JSON
    struct orl_text_lines *lines; // of a file of text, ahead of the first
    const uint8_t *data; // of another file
    size_t size;
};
// Sets source->shift, where the file may state "pixel_centre". custom: the coordinate of the first pixel's centre
// where nobody states it.
enum orl_result orl_known_set_shift(struct orl_known_source *source, double custom) ORL_CHECK_RESULT;
// Logs what is wrong with a camera; returns ORL_ERR_FORMAT.
enum orl_result orl_known_bad(const struct orl_known_source *source, const char *place, const char *what);
// Appends a camera. It is shared with the previous one when the two are equal.
enum orl_result orl_known_add(const struct orl_known_source *source, const struct orl_known_camera *camera,
                              struct orl_known_cameras *known) ORL_CHECK_RESULT;

// Appends the cameras of a source, and sets what else the file states.
typedef enum orl_result orl_known_reader(const struct orl_known_source *source,
                                         struct orl_known_cameras *known);
orl_known_reader orl_known_read_own, orl_known_read_inria,
    orl_known_read_transforms, orl_known_read_splits, orl_known_read_bundler,
    orl_known_read_middlebury, orl_known_read_opensfm, orl_known_read_meshroom,
    orl_known_read_polycam, orl_known_read_record3d, orl_known_read_llff, orl_known_read_nvm,
    orl_known_read_realityscan, orl_known_read_metashape;

// Names, in one line, the keys of `objects` that are not in the NULL-terminated list `used`.
struct orl_known_unused {
    const char *const *used;
    struct orl_names names;
};
void orl_known_look_for_unused(struct orl_known_unused *unused, const json_t *object);
void orl_known_say_unused(const struct orl_known_source *source, struct orl_known_unused *unused);
// All of it for an object and the entries of those of its lists that are named, or for a list.
// `used` ends with NULL, as `lists` does; NULL: none is named.
void orl_known_say_unused_of(const struct orl_known_source *source, const json_t *root,
                             const char *const *used, const char *const *lists);

// The number of a key, or those of an array, which may be written as strings. False when they are missing,
// as many others or not finite.
bool orl_known_json_number(const json_t *object, const char *key, double *value);
bool orl_known_json_numbers(const json_t *array, size_t count, double *values);

#endif
