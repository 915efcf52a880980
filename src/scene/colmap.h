// COLMAP's files: sparse models (binary or text) and depth or normal maps.
// Sizes are checked against the file before memory is allocated. Errors name
// the file, the offset and the reason.
#ifndef ORL_SCENE_COLMAP_H
#define ORL_SCENE_COLMAP_H

#include "oriel/image.h"
#include "oriel/camera.h"

enum { ORL_COLMAP_PARAMS = 16 }; // the most that a camera model has

struct orl_colmap_camera {
    uint32_t id;
    int model;               // COLMAP's model id; 0 SIMPLE_PINHOLE, 1 PINHOLE, ...
    struct orl_camera pinhole; // the camera without its distortion
    double params[ORL_COLMAP_PARAMS];
    int param_count;
};

struct orl_colmap_image {
    uint32_t id, camera_id;
    char *name; // owned
    struct orl_pose cam_from_world;
    // The sparse points that the image sees: indices into orl_colmap_model.points.
    uint32_t *points; // owned
    size_t point_count, point_capacity;
};

struct orl_colmap_point {
    uint64_t id;
    double position[3]; // world
    uint8_t rgb[3];
    double error_px;        // mean reprojection error
    uint32_t track_length;  // number of photographs that see the point
};

// Cameras are sorted by id, images by name. Readers drop points that are not finite or beyond
// ORL_WORLD_MAX, with a warning.
struct orl_colmap_model {
    struct orl_colmap_camera *cameras;
    size_t camera_count, camera_capacity;
    struct orl_colmap_image *images;
    size_t image_count, image_capacity;
    struct orl_colmap_point *points;
    size_t point_count, point_capacity;
};

// Reads cameras, images and points3D from `dir`: the .bin files if they exist, else the .txt files.
// ORL_ERR_FORMAT: a file is damaged. ORL_ERR_NOT_FOUND: there is no model.
enum orl_result orl_colmap_read(const struct orl_log *log, const char *dir,
                                struct orl_colmap_model *model) ORL_CHECK_RESULT;
// Reads only poses, in the order of a file like images.txt, and cameras from a cameras.txt beside
// it where there is one.
enum orl_result orl_colmap_read_poses(const struct orl_log *log, const char *path,
                                      struct orl_colmap_model *model) ORL_CHECK_RESULT;
void orl_colmap_finish(struct orl_colmap_model *model);
// Writes cameras.bin, images.bin and points3D.bin into `dir`, which must exist. Observations are
// written at the projections of their points. keep: of each image, whether it is written; NULL: all are.
enum orl_result orl_colmap_write(const struct orl_log *log, const char *dir, const struct orl_colmap_model *model,
                                 const bool *keep) ORL_CHECK_RESULT;
// NULL when no camera has that id.
const struct orl_colmap_camera *orl_colmap_camera_by_id(const struct orl_colmap_model *model,
                                                        uint32_t id);

// NULL when no image has that name.
const struct orl_colmap_image *orl_colmap_image_by_name(const struct orl_colmap_model *model,
                                                        const char *name);
// Sets shared[i], for each image i of the model, to how many of its points `image` sees too.
enum orl_result orl_colmap_count_shared(const struct orl_log *log, const struct orl_colmap_model *model,
                                        const struct orl_colmap_image *image, size_t *shared) ORL_CHECK_RESULT;
// A camera without distortion.
struct orl_colmap_camera orl_colmap_pinhole(uint32_t id, const struct orl_camera *camera);
// Pose and pinhole camera of one of the model's images, without distortion.
struct orl_view orl_colmap_image_view(const struct orl_colmap_model *model,
                                      const struct orl_colmap_image *image);

// Projects the ray with x/z, y/z = ray to pixels, with the distortion of the camera's COLMAP
// model. The camera must come from orl_colmap_read.
void orl_colmap_camera_project(const struct orl_colmap_camera *camera, const double ray[2],
                               double pixel[2]);
// True when the model has no distortion, or terms that are exactly zero.
bool orl_colmap_camera_is_pinhole(const struct orl_colmap_camera *camera);
// True when every corner of the picture is the projection of a ray. False when a badly estimated
// distortion folds back before it reaches a corner.
bool orl_colmap_camera_reaches_corners(const struct orl_colmap_camera *camera);

// Maps are files of "W&H&C&" and W*H*C float32, channel by channel. Depth maps have one
// channel (z in scene units, 0 = none), normal maps three (camera frame).
// The image is interleaved in memory.
enum orl_result orl_colmap_map_read(const struct orl_log *log, const char *path,
                                    struct orl_image *image) ORL_CHECK_RESULT;
enum orl_result orl_colmap_map_write(const struct orl_log *log, const char *path,
                                     const struct orl_image *image) ORL_CHECK_RESULT;

// Makes the picture that camera `to` would have taken from the same place, of any pixel type.
// `image` has the size of camera `from`. Resampling is bilinear, and black where `from` saw
// nothing. Where `to` is coarser, the picture is undistorted at the resolution of `from` and then
// reduced to the size of `to`, as COLMAP does.
enum orl_result orl_undistort(const struct orl_log *log, const struct orl_colmap_camera *from,
                              const struct orl_camera *to, const struct orl_image *image,
                              struct orl_image *undistorted) ORL_CHECK_RESULT;

#endif
