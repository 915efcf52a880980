// What oriel prepare is asked to do.
#ifndef ORIEL_PREPARE_PARAMS_H
#define ORIEL_PREPARE_PARAMS_H

#include "oriel/names.h"

struct orl_gpu;

enum orl_quality { ORL_QUALITY_DRAFT, ORL_QUALITY_STANDARD, ORL_QUALITY_HIGH };
// auto: photographs share a camera when size, EXIF camera model and focal length are equal.
enum orl_camera_sharing { ORL_SHARING_AUTO, ORL_SHARING_SINGLE, ORL_SHARING_EACH };
// auto: exhaustive up to 25 photographs, retrieval above. sequential: neighbours by name.
// retrieval: pairs that a quick look at their features finds to overlap. When too few register,
// exhaustive after all.
enum orl_matching {
    ORL_MATCHING_AUTO,
    ORL_MATCHING_EXHAUSTIVE,
    ORL_MATCHING_SEQUENTIAL,
    ORL_MATCHING_RETRIEVAL,
};
// Which of COLMAP's programs finds the poses. auto: incremental up to 400 photographs; above, global
// where COLMAP has it (version 4), else hierarchical. When global or hierarchical registers fewer
// than half, incremental after all.
enum orl_mapper {
    ORL_MAPPER_AUTO,
    ORL_MAPPER_INCREMENTAL,
    ORL_MAPPER_HIERARCHICAL,
    ORL_MAPPER_GLOBAL,
};
// auto: COLMAP's densifier when COLMAP was built with CUDA, else Oriel's own.
enum orl_densifier { ORL_DENSIFIER_AUTO, ORL_DENSIFIER_GL, ORL_DENSIFIER_COLMAP };

// minimal: only the files that commands read. all: also depth, normal and confidence maps
// (stereo/).
enum orl_keep { ORL_KEEP_MINIMAL, ORL_KEEP_ALL };

// collect and undistort: stops before the features or the stereo, which oriel plan divides into jobs
// for several machines.
enum orl_until { ORL_UNTIL_END, ORL_UNTIL_COLLECT, ORL_UNTIL_UNDISTORT };

// The triangle mesh that is made for methods that draw one; none: no mesh. poisson: from the points.
// delaunay: from the sparse points and what sees them; needs a COLMAP built with CGAL.
enum orl_prepare_mesh { ORL_MESH_NONE, ORL_MESH_POISSON, ORL_MESH_DELAUNAY };

// How the finished scene will be drawn: as its method is (none), or with what training photographs
// find better, each rendered from the others. short: a few changes that measured well, in less than
// a tenth of the time of prepare. long: among all methods and options.
enum orl_adapt_effort { ORL_ADAPT_NONE, ORL_ADAPT_SHORT, ORL_ADAPT_LONG };

// Whether the visual hull closes surfaces of a subject with silhouettes that stereo leaves open.
enum orl_hull_use { ORL_HULL_NONE, ORL_HULL_CLOSE };

// Whether to look for what single photographs show before the scene.
enum orl_occluder_search { ORL_OCCLUDER_SEARCH_NONE, ORL_OCCLUDER_SEARCH_FIND };

// Which photographs that are named as doubtful are left out. blurred: much less sharp than most.
// duplicates: same picture as another, re-encoded, or of a camera that stood still.
enum orl_leave_out {
    ORL_LEAVE_OUT_NONE,
    ORL_LEAVE_OUT_BLURRED,
    ORL_LEAVE_OUT_DUPLICATES,
    ORL_LEAVE_OUT_BOTH,
};

// Names of the values above, in their order; NULL after the last.
extern const char *const orl_quality_names[];
extern const char *const orl_camera_sharing_names[];
extern const char *const orl_matching_names[];
extern const char *const orl_mapper_names[];
extern const char *const orl_densifier_names[];
extern const char *const orl_keep_names[];
extern const char *const orl_prepare_mesh_names[];
extern const char *const orl_adapt_effort_names[];
extern const char *const orl_hull_use_names[];
extern const char *const orl_occluder_search_names[];
extern const char *const orl_leave_out_names[];
extern const char *const orl_until_names[];

// Photographs by their place in the order of names, from 0.
struct orl_test_block {
    int first, end; // first to end - 1; end 0: none
};

struct orl_prepare_params {
    const char *const *inputs; // photographs, videos and folders of them, with their sub-folders
    size_t input_count;
    const char *out;           // the scene folder
    double fps;                // frames taken of a second of video; 0: 2 a second
    int frames;                // frames taken of each video instead; 0: by fps
    enum orl_leave_out leave_out;
    int test_every;            // hold out photographs 0, N, 2N, ... by name; 0: none
    const struct orl_names *test_list; // hold out these (extension optional); NULL: none
    struct orl_test_block test_block;  // hold out these
    int max_size;              // larger side of the undistorted photographs in pixels;
                               // 0: by quality
    enum orl_quality quality;
    enum orl_camera_sharing sharing;
    enum orl_matching matching;
    enum orl_mapper mapper;
    enum orl_densifier densifier;
    enum orl_keep keep;
    enum orl_prepare_mesh mesh;
    enum orl_hull_use hull;
    enum orl_occluder_search occluders;
    enum orl_adapt_effort adapt;
    double adapt_budget_s;     // of the long one, but for the comparison of methods
    int radius_neighbours;     // a splat's radius is the distance to its k-th neighbour, [1, 64],
    double radius_overlap;     // times this, (0, 8]; 0 each: 6 and 1
    int fuse_cluster;          // photographs fused together at most; 0: what fits in
                               // memory, and 400
    const char *masks_dir;     // NAME.png or NAME.EXT.png, black = ignore; NULL: none
    const char *exposures;     // CSV that overrides EXIF (exposure_list.h); NULL: none
    enum orl_until until;
    bool resume;               // continue after the stages that are complete
    uint32_t seed;
    struct orl_gpu *gpu;       // NULL: opened when densify needs it
    size_t max_vram_bytes;     // device memory that densify keeps to; 0: no limit
    size_t max_ram_bytes;      // memory that fusion and points keep to; 0: half of what is
                               // free then
    const char *shader_dir;    // for a GPU opened here; NULL: the embedded shaders
};

// Larger side of the undistorted photographs in pixels: max_size, or by quality where that is 0.
int orl_prepare_max_size(const struct orl_prepare_params *params);

#endif
