// The settings of oriel import.
#ifndef ORL_PREPROCESS_IMPORT_PARAMS_H
#define ORL_PREPROCESS_IMPORT_PARAMS_H

#include "core/file.h"
#include "io/video.h"
#include "oriel/prepare_params.h"
#include "oriel/scene.h"

enum orl_import_silhouettes {
    ORL_SILHOUETTES_STATED,     // masks that the file of cameras names, else the pictures' alpha
    ORL_SILHOUETTES_GIVEN,      // files in masks_dir
    ORL_SILHOUETTES_DARK,       // a subject in front of a dark background
    ORL_SILHOUETTES_BACKGROUND, // difference from pictures or clips of the empty scene
};

enum orl_import_points {
    ORL_IMPORT_STATED_POINTS, // the cloud that the cameras' file names, else none
    ORL_IMPORT_NO_POINTS,
    ORL_IMPORT_CLOUD,   // points_file
    ORL_IMPORT_DENSIFY, // as orl_prepare does
};

struct orl_import_params {
    const char *cameras;       // file or folder, as for orl_known_cameras_read
    const char *out;           // the scene folder: new or empty
    const char *images_dir;    // pictures, folders of numbered ones, or clips, named like the
                               // cameras; NULL: images/ beside the cameras, or their folder
    double pixel_centre;       // as for orl_known_cameras_read; negative: by format
    int test_every;            // hold out photographs 0, N, 2N, ... by name; 0: none
    const struct orl_names *test_list; // hold out these (extension optional); NULL: none
    struct orl_test_block test_block;  // hold out these
    int max_size;              // greatest longer side of the scene's photographs, pixels; 0: any
    enum orl_import_silhouettes silhouettes;
    const char *masks_dir;     // of ORL_SILHOUETTES_GIVEN
    const char *background;    // folder of backgrounds, named like the cameras; NULL: none
    int dark_threshold;        // of ORL_SILHOUETTES_DARK, [0, 254]; negative: chosen automatically
    struct orl_frame_range frames; // of a sequence
    enum orl_import_points points;
    const char *points_file;   // a PLY cloud
    struct orl_prepare_params densify; // of ORL_IMPORT_DENSIFY: only quality, densifier, seed,
                                       // keep, hull, adapt, gpu, max_vram_bytes and shader_dir are used
    struct orl_room room;      // the room that the subject is in; not known: as the cameras' file
    const char *mesh;          // a PLY or OBJ mesh; NULL: none
    int hull_side;             // > 0: the mesh is the silhouettes' visual hull on hull_side^3
                               // voxels
    int hull_triangles;        // approximate limit; 0: none
};
#define ORL_IMPORT_DEFAULTS .pixel_centre = -1, .dark_threshold = -1, .frames = {0, 0, 1}, \
                            .densify = {.quality = ORL_QUALITY_STANDARD, .seed = 1, \
                                        .hull = ORL_HULL_CLOSE, .adapt = ORL_ADAPT_AUTO}

#endif
