// From a folder of photographs to a scene: collect, calibrate, undistort,
// densify, fuse, radii, expose (docs/pipeline.md).
#ifndef ORL_PREPROCESS_PREPARE_H
#define ORL_PREPROCESS_PREPARE_H

#include "core/file.h"
#include "core/progress.h"

struct orl_gpu;

enum orl_quality { ORL_QUALITY_DRAFT, ORL_QUALITY_STANDARD, ORL_QUALITY_HIGH };
// auto: photographs of one size and one EXIF camera and focal length share a camera.
enum orl_camera_sharing { ORL_SHARING_AUTO, ORL_SHARING_SINGLE, ORL_SHARING_EACH };
// auto: exhaustive up to 120 photographs, then neighbours by name, then exhaustive
// after all when too few of them register.
enum orl_matching { ORL_MATCHING_AUTO, ORL_MATCHING_EXHAUSTIVE, ORL_MATCHING_SEQUENTIAL };
// auto: COLMAP's when it was built with CUDA, else the built-in one.
enum orl_densifier { ORL_DENSIFIER_AUTO, ORL_DENSIFIER_GL, ORL_DENSIFIER_COLMAP };

struct orl_prepare_params {
    const char *const *inputs; // photographs and folders of them
    size_t input_count;
    const char *out;           // the scene folder
    int test_every;            // hold out photographs 0, N, 2N, ... by name; 0: none
    const struct orl_names *test_list; // hold out these (extension optional); NULL: none
    int max_size;              // larger side of the undistorted photographs in pixels;
                               // 0: by quality
    enum orl_quality quality;
    enum orl_camera_sharing sharing;
    enum orl_matching matching;
    enum orl_densifier densifier;
    const char *masks_dir;     // NAME.png or NAME.EXT.png, black = ignore; NULL: none
    const char *exposures;     // CSV that overrides EXIF (expose.h); NULL: none
    bool resume;               // go on with what is there
    uint32_t seed;
    struct orl_gpu *gpu;       // NULL: opened when densify needs it
    size_t max_vram_bytes;     // device memory that densify keeps to; 0: no limit
    const char *shader_dir;    // for that; NULL: the embedded shaders
};

// Makes the scene. COLMAP is found on PATH or named by $ORIEL_COLMAP; its output
// goes to OUT/logs/colmap.log. Whatever fails, OUT does not open as a scene until
// all is done, and `resume` goes on after the last whole stage.
// ORL_ERR_ARGUMENT: OUT exists already without `resume`, or bad settings.
// ORL_ERR_NOT_FOUND, ORL_ERR_DATA: too few photographs, or too few that register.
// ORL_ERR_EXTERNAL: COLMAP is missing or failed.
enum orl_result orl_prepare(const struct orl_log *log, const struct orl_prepare_params *params,
                            const struct orl_progress *progress) ORL_CHECK_RESULT;

#endif
