// A scene folder (docs/reference/files.md): photographs with cameras, and points.
#ifndef ORIEL_SCENE_H
#define ORIEL_SCENE_H

#include "oriel/camera.h"
#include "oriel/points.h"

struct orl_colmap_model;
struct orl_lod;
struct orl_names;

struct orl_photo {
    char *name;           // owned; file SCENE/images/<name>
    struct orl_view view; // size and intrinsics as of the undistorted file, pixels as stored
    int orientation;      // by EXIF, 1 to 8: how the stored picture is turned; 0: not known
    bool test;            // held out: used for calibration only
    bool linear;          // has a linear version (ORL_FILE_LINEAR)
    bool radiance;        // its linear version is radiance (oriel hdr --replace-series): no value
                          // is clipped, however near to white
    bool masked;          // has a mask (ORL_FILE_MASK)
    float occluded;       // share of it that shows occluders (ORL_FILE_OCCLUDERS); 0: none
    double exposure_ev;   // log2 of exposure relative to the scene's median; 0 if unknown
    bool has_exposure;    // exposure_ev comes from EXIF or a list
    int series;           // exposure series, from 0
    float gain[3];        // multiplies linear colour; 1 1 1 unless aligned
    // Of a held-out photograph, whose gain is a guess: the gain holds for a rendering whose metered
    // light (scene/meter.h) is metered_ev, log2. Each stop more of it raises the gain by `metering`
    // stops, in [0, 1], as in a camera that exposes automatically. 0: the light does not matter.
    float metering, metered_ev;
    // Relative illumination is 1 + v[0] r^2 + v[1] r^4 + v[2] r^6 at distance r from the
    // principal point, in units of half the picture's diagonal; 0 0 0: no vignetting.
    float vignette[3];
    int response; // index into orl_scene.responses; -1: sRGB
};

// How a camera turns exposure into 8-bit values.
struct orl_response {
    float linear[3][256]; // linear exposure per channel and value; increasing, 1 at value 255
};

// The value of a method's option that oriel tune or oriel trim chose for the scene.
struct orl_tuned {
    char *method, *key; // owned
    double value;
    char *name; // owned: of an option whose values are names; NULL: `value` is meant
};

// How the scene is drawn unless a command says otherwise ("render" of scene.json).
struct orl_scene_defaults {
    char *method;     // owned; NULL: the first of all methods
    char *textures;   // owned: a name of orl_textures_names; NULL: the renderer chooses
    int depth_divide; // depth maps of photographs have 1/n of their size; 0 counts as 1
    bool depth_half;  // depth maps of photographs are half floats
};

// The ground plane that the photographer stood on.
struct orl_ground {
    double plane[4]; // world: dot(plane, (X, 1)) is X's height above it, in scene units
    double height;   // mean height of the photographs above the plane; 0: no plane was found
    bool known;      // the plane was searched for, or scene.json states it
};

// The room that the subject is in: a box, world.
struct orl_room {
    double low[3], high[3];
    bool known;
};

enum { ORL_LOD_SAMPLE = 2 << 20 };

struct orl_scene {
    char *dir; // owned
    struct orl_photo *photos;
    size_t photo_count;
    struct orl_points points; // with `lod`, a sample of up to ORL_LOD_SAMPLE points
    struct orl_lod *lod;      // owned: all points, drawn from a file (points.lod); NULL: `points` are
                              // all
    struct orl_response *responses; // one per camera model that has a measured one
    size_t response_count;
    struct orl_tuned *tuned;
    size_t tuned_count;
    struct orl_scene_defaults defaults;
    size_t frame_count;    // frames of a sequence; 0: a still scene
    int frame;             // the frame that the photographs show; -1: SCENE/images
    const char *time_steps_dir; // holds frames/ in place of SCENE, not owned; NULL: SCENE does
    double photo_distance; // median distance from training photographs to the points they see
    double near_distance;  // a quarter of the least distance from which a photograph shows surfaces;
                           // large splats nearer to a viewer are outliers; 0: not known
    struct orl_ground ground;
    bool backdrop_rests; // what lies behind the points stays where it is in photographs, as behind a
                         // turntable
    struct orl_room room;
    double origin[3]; // coordinates of the imported file minus this are those of the scene
};

// Opens SCENE (scene.json, points.ply or points.lod) or a plain COLMAP dense workspace with
// fused.ply, whose radii are computed on the fly. A scene that prepare has not
// finished is refused with ORL_ERR_DATA, naming the missing stage.
enum orl_result orl_scene_open(const struct orl_log *log, const char *dir,
                               struct orl_scene **out) ORL_CHECK_RESULT;
// Opens SCENE without its points.
enum orl_result orl_scene_open_photos(const struct orl_log *log, const char *dir,
                                      struct orl_scene **out) ORL_CHECK_RESULT;
// Opens a folder that is still being prepared, from its sparse model alone, without points and
// exposures.
enum orl_result orl_scene_open_model(const struct orl_log *log, const char *dir,
                                     const struct orl_colmap_model *model,
                                     struct orl_scene **out) ORL_CHECK_RESULT;
// As before, with points.ply or points.lod. Photographs named in `test` (NULL: none) are held out,
// and the ground plane is estimated from the points.
enum orl_result orl_scene_open_unfinished(const struct orl_log *log, const char *dir,
                                          const struct orl_colmap_model *model,
                                          const struct orl_names *test,
                                          struct orl_scene **out) ORL_CHECK_RESULT;
void orl_scene_destroy(struct orl_scene **scene);
// Reads the scene's sparse model (colmap.h), whose images have the photographs' order.
enum orl_result orl_scene_read_model(const struct orl_log *log, const struct orl_scene *scene,
                                     struct orl_colmap_model *model) ORL_CHECK_RESULT;
// The cameras of the photographs that are not held out. *views is owned by the caller (free).
enum orl_result orl_scene_training_views(const struct orl_log *log, const struct orl_scene *scene,
                                         struct orl_view **views, size_t *count) ORL_CHECK_RESULT;
// How many points the scene has, though `points` may be a sample of them.
size_t orl_scene_point_count(const struct orl_scene *scene);
// Were the photographs taken at several exposures on purpose? True where the mean exposures of two
// series are at least a stop and a half apart, and each has at least two, and a tenth, of all photographs
// that are not held out. Within one series a camera that meters by itself may vary more than that.
bool orl_scene_is_bracketed(const struct orl_scene *scene);
// Index of the photograph of this name (with or without extension), -1 if there is none.
int orl_scene_find_photo(const struct orl_scene *scene, const char *name);
// Selects the photographs and silhouettes of `frame`, or with -1 those of the scene itself. Cameras
// and everything else stay. On failure the scene is unchanged.
// ORL_ERR_ARGUMENT: there is no such frame. ORL_ERR_NOT_FOUND: one of its photographs is missing.
enum orl_result orl_scene_set_frame(const struct orl_log *log, struct orl_scene *scene,
                                    int frame) ORL_CHECK_RESULT;
// A photograph's files.
enum orl_photo_file {
    // "SCENE/images/<name>", or "SCENE/frames/<number>/images/<name>" when a frame is selected.
    ORL_FILE_PHOTO,
    // Its mask or silhouette (silhouette.h): "SCENE/masks/<name>.png", or
    // "SCENE/frames/<number>/masks/<name>.png" when a frame is selected. The mask is as large as the
    // photograph and 0 outside the subject. The file exists when photo->masked.
    ORL_FILE_MASK,
    // Where the photograph shows what stands before the scene and has no points: a mask of any size,
    // 255 there, else 0: "SCENE/occluders/<name>.png". The file exists when photo->occluded > 0. It is
    // of SCENE/images, not of the time steps of a sequence.
    ORL_FILE_OCCLUDERS,
    // A picture of the place without the subject: "SCENE/background/<name>.png". The file may be
    // missing.
    ORL_FILE_BACKGROUND,
    // "SCENE/images_linear/<name>.exr". The file may be missing.
    ORL_FILE_LINEAR,
};
struct orl_file_path orl_scene_file(const struct orl_scene *scene, size_t photo, enum orl_photo_file kind);
// "SCENE/mesh.ply", or the mesh of the selected frame, "SCENE/frames/<number>/mesh.ply", where there
// is one. The file may be missing.
struct orl_file_path orl_scene_mesh_path(const struct orl_scene *scene);

#endif
