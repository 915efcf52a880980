// A scene folder (docs/reference/files.md): photographs with cameras, and points.
#ifndef ORIEL_SCENE_H
#define ORIEL_SCENE_H

#include "oriel/camera.h"
#include "oriel/points.h"

struct orl_colmap_model;
struct orl_names;

struct orl_photo {
    char *name;           // owned; file SCENE/images/<name>
    struct orl_view view; // size and intrinsics as of the undistorted file
    bool test;            // held out: calibration only
    bool linear;          // there is a linear version too: orl_scene_read_linear
    bool masked;          // there is a mask: orl_scene_mask_path
    double exposure_ev;   // log2 of exposure relative to the scene's median; 0 if unknown
    bool has_exposure;    // exposure_ev comes from EXIF or a list
    int series;           // exposure series, from 0
    float gain[3];        // multiplies linear colour; 1 1 1 unless aligned
    // Relative illumination 1 + v[0] r^2 + v[1] r^4 + v[2] r^6 at distance r from the
    // principal point in units of half the picture's diagonal; 0 0 0: none.
    float vignette[3];
    int response; // index into orl_scene.responses; -1: sRGB
};

// How a camera turns exposure into 8-bit values.
struct orl_response {
    float linear[3][256]; // per channel and value: linear exposure, increasing, 255 is 1
};

// A method's option as oriel tune found it best for the scene.
struct orl_tuned {
    char *method, *key; // owned
    double value;
};

// A plane: where the photographer stood.
struct orl_ground {
    double plane[4]; // world: dot(plane, (X, 1)) is X's height above it, in scene units
    double height;   // mean of the photographs' above it; 0: there is none
    bool known;      // looked for, or told by scene.json
};

struct orl_scene {
    char *dir; // owned
    struct orl_photo *photos;
    size_t photo_count;
    struct orl_points points;
    struct orl_response *responses; // one per camera model that has a measured one
    size_t response_count;
    struct orl_tuned *tuned;
    size_t tuned_count;
    size_t frame_count;    // moments of a sequence; 0: a still scene
    int frame;             // the moment that its photographs show, -1: SCENE/images
    double photo_distance; // median distance from training photographs to points they see
    struct orl_ground ground;
};

// Opens SCENE (scene.json, points.ply) or a plain COLMAP dense workspace with
// fused.ply, whose radii are computed on the fly. A scene that prepare has not
// finished is refused with ORL_ERR_DATA, naming the missing stage.
enum orl_result orl_scene_open(const struct orl_log *log, const char *dir,
                               struct orl_scene **out) ORL_CHECK_RESULT;
// The same of a folder that is being prepared, from its sparse model and points.ply: nothing
// is known of exposures, photographs named in `test` (NULL: none) are held out, and the ground
// is that which points tell of.
enum orl_result orl_scene_open_unfinished(const struct orl_log *log, const char *dir,
                                          const struct orl_colmap_model *model,
                                          const struct orl_names *test,
                                          struct orl_scene **out) ORL_CHECK_RESULT;
void orl_scene_destroy(struct orl_scene **scene);
// Index of the photograph of this name (with or without extension), -1 if none.
int orl_scene_find_photo(const struct orl_scene *scene, const char *name);
// Photographs and silhouettes are those of moment `frame` from now on; cameras and all else stay.
// -1: those of the scene itself. ORL_ERR_ARGUMENT: there is no such moment; ORL_ERR_NOT_FOUND: a
// photograph of it is missing. Then the scene stays as it was.
enum orl_result orl_scene_set_frame(const struct orl_log *log, struct orl_scene *scene,
                                    int frame) ORL_CHECK_RESULT;
// "SCENE/images/<name>", or of the chosen moment "SCENE/frames/<number>/images/<name>"; released
// with free().
char *orl_scene_photo_path(const struct orl_log *log, const struct orl_scene *scene,
                           size_t photo);
// Its mask or silhouette (silhouette.h), "SCENE/masks/<name>.png" or of the chosen moment "SCENE/
// frames/<number>/masks/<name>.png": as large as the photograph, 0 where it does not show the
// subject. There when photo->masked.
char *orl_scene_mask_path(const struct orl_log *log, const struct orl_scene *scene, size_t photo);
// The place without the subject: "SCENE/background/<name>.png", there or not.
char *orl_scene_background_path(const struct orl_log *log, const struct orl_scene *scene,
                                size_t photo);
// "SCENE/mesh.ply", there or not.
char *orl_scene_mesh_path(const struct orl_log *log, const struct orl_scene *scene);
// "SCENE/images_linear/<name>.exr", there or not.
char *orl_scene_linear_path(const struct orl_log *log, const struct orl_scene *scene,
                            size_t photo);

#endif
