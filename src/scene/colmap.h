// COLMAP's files: sparse model (binary or text) and depth or normal maps.
// Sizes are checked against the file before anything is allocated; errors name
// the file, the offset and the reason.
#ifndef ORL_SCENE_COLMAP_H
#define ORL_SCENE_COLMAP_H

#include "oriel/image.h"
#include "oriel/camera.h"

struct orl_colmap_camera {
    uint32_t id;
    int model;               // COLMAP's model id; 0 SIMPLE_PINHOLE, 1 PINHOLE, ...
    struct orl_camera pinhole; // without the distortion of other models
    double params[12];
    int param_count;
};

struct orl_colmap_image {
    uint32_t id, camera_id;
    char *name; // owned
    struct orl_pose cam_from_world;
    // The sparse points it sees: indices into orl_colmap_model.points.
    uint32_t *points; // owned
    size_t point_count;
};

struct orl_colmap_point {
    uint64_t id;
    double position[3]; // world
    uint8_t rgb[3];
    double error_px;        // mean reprojection error
    uint32_t track_length;  // photographs that see it
};

// Cameras sorted by id, images by name. Points that are not finite or beyond ORL_WORLD_MAX are
// dropped with a warning.
struct orl_colmap_model {
    struct orl_colmap_camera *cameras;
    size_t camera_count;
    struct orl_colmap_image *images;
    size_t image_count;
    struct orl_colmap_point *points;
    size_t point_count;
};

// Reads cameras, images and points3D (.bin if there, else .txt) from `dir`.
// ORL_ERR_FORMAT for damaged files, ORL_ERR_NOT_FOUND when there are none.
enum orl_result orl_colmap_read(const struct orl_log *log, const char *dir,
                                struct orl_colmap_model *model) ORL_CHECK_RESULT;
// Poses alone, in the order of a file like images.txt, and the cameras of a cameras.txt beside it
// where there is one.
enum orl_result orl_colmap_read_poses(const struct orl_log *log, const char *path,
                                      struct orl_colmap_model *model) ORL_CHECK_RESULT;
void orl_colmap_finish(struct orl_colmap_model *model);
// Writes cameras.bin, images.bin and points3D.bin into `dir`, which is there. Observations lie
// where their points project.
enum orl_result orl_colmap_write(const struct orl_log *log, const char *dir,
                                 const struct orl_colmap_model *model) ORL_CHECK_RESULT;
// NULL when there is none of that id.
const struct orl_colmap_camera *orl_colmap_camera_by_id(const struct orl_colmap_model *model,
                                                        uint32_t id);

// NULL when there is none of that name.
const struct orl_colmap_image *orl_colmap_image_by_name(const struct orl_colmap_model *model,
                                                        const char *name);
// Pose and pinhole camera of one of the model's images, without distortion.
struct orl_view orl_colmap_image_view(const struct orl_colmap_model *model,
                                      const struct orl_colmap_image *image);

// Where a ray with x/z, y/z = ray meets the picture, in pixels, distortion included, as
// COLMAP's model of this camera has it. The camera must come from orl_colmap_read.
void orl_colmap_camera_project(const struct orl_colmap_camera *camera, const double ray[2],
                               double pixel[2]);
// Does each corner of the picture see a ray? Not where the distortion of a camera estimated amiss
// turns back on itself before.
bool orl_colmap_camera_reaches_corners(const struct orl_colmap_camera *camera);

// "W&H&C&" then W*H*C float32, channel by channel. Depth maps have one channel
// (z in scene units, 0 = none), normal maps three (camera frame).
// The image is interleaved in memory.
enum orl_result orl_colmap_map_read(const struct orl_log *log, const char *path,
                                    struct orl_image *image) ORL_CHECK_RESULT;
enum orl_result orl_colmap_map_write(const struct orl_log *log, const char *path,
                                     const struct orl_image *image) ORL_CHECK_RESULT;

// Of each of the `count` points of a fused cloud, how many photographs it was fused from
// (255: as many or more), from the file that COLMAP writes beside it (fused.ply.vis).
enum orl_result orl_colmap_visibility_read(const struct orl_log *log, const char *path,
                                           size_t count, uint8_t *photographs) ORL_CHECK_RESULT;

#endif
