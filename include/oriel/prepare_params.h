// What oriel prepare is asked to do: each setting once, as a row.
#ifndef ORIEL_PREPARE_PARAMS_H
#define ORIEL_PREPARE_PARAMS_H

#include "oriel/option_row.h"

struct orl_gpu;

#define ORL_QUALITIES(NAME) \
    NAME(ORL_QUALITY_DRAFT, "draft") NAME(ORL_QUALITY_STANDARD, "standard") \
    NAME(ORL_QUALITY_HIGH, "high")
enum orl_quality { ORL_QUALITIES(ORL_ENUMERATOR) };

// auto: photographs share a camera when size, EXIF camera model and focal length are equal.
#define ORL_CAMERA_SHARINGS(NAME) \
    NAME(ORL_SHARING_AUTO, "auto") NAME(ORL_SHARING_SINGLE, "single") NAME(ORL_SHARING_EACH, "each")
enum orl_camera_sharing { ORL_CAMERA_SHARINGS(ORL_ENUMERATOR) };

// auto: exhaustive up to 25 photographs, retrieval above. sequential: neighbours by name.
// retrieval: pairs that a quick look at their features finds to overlap. When too few register,
// exhaustive after all.
#define ORL_MATCHINGS(NAME) \
    NAME(ORL_MATCHING_AUTO, "auto") NAME(ORL_MATCHING_EXHAUSTIVE, "exhaustive") \
    NAME(ORL_MATCHING_SEQUENTIAL, "sequential") NAME(ORL_MATCHING_RETRIEVAL, "retrieval")
enum orl_matching { ORL_MATCHINGS(ORL_ENUMERATOR) };

// Which of COLMAP's programs finds the poses. auto: incremental up to 400 photographs; above, global
// where COLMAP has it (version 4), else hierarchical. When global or hierarchical registers fewer
// than half, incremental after all.
#define ORL_MAPPERS(NAME) \
    NAME(ORL_MAPPER_AUTO, "auto") NAME(ORL_MAPPER_INCREMENTAL, "incremental") \
    NAME(ORL_MAPPER_HIERARCHICAL, "hierarchical") NAME(ORL_MAPPER_GLOBAL, "global")
enum orl_mapper { ORL_MAPPERS(ORL_ENUMERATOR) };

// auto: COLMAP's densifier when COLMAP was built with CUDA, else Oriel's own.
#define ORL_DENSIFIERS(NAME) \
    NAME(ORL_DENSIFIER_AUTO, "auto") NAME(ORL_DENSIFIER_GL, "gl") \
    NAME(ORL_DENSIFIER_COLMAP, "colmap")
enum orl_densifier { ORL_DENSIFIERS(ORL_ENUMERATOR) };

// minimal: only the files that commands read. all: also depth, normal and confidence maps
// (stereo/).
#define ORL_KEEPS(NAME) NAME(ORL_KEEP_MINIMAL, "minimal") NAME(ORL_KEEP_ALL, "all")
enum orl_keep { ORL_KEEPS(ORL_ENUMERATOR) };

// collect and undistort: stops before the features or the stereo, which oriel plan divides into jobs
// for several machines.
#define ORL_UNTILS(NAME) \
    NAME(ORL_UNTIL_END, "end") NAME(ORL_UNTIL_COLLECT, "collect") \
    NAME(ORL_UNTIL_UNDISTORT, "undistort")
enum orl_until { ORL_UNTILS(ORL_ENUMERATOR) };

// The triangle mesh that is made for methods that draw one. poisson: from the points. delaunay: from
// the sparse points and what sees them; needs a COLMAP built with CGAL.
#define ORL_PREPARE_MESHES(NAME) \
    NAME(ORL_MESH_NONE, "none") NAME(ORL_MESH_POISSON, "poisson") \
    NAME(ORL_MESH_DELAUNAY, "delaunay")
enum orl_prepare_mesh { ORL_PREPARE_MESHES(ORL_ENUMERATOR) };

// Whether the visual hull closes surfaces of a subject with silhouettes that stereo leaves open.
#define ORL_HULL_USES(NAME) NAME(ORL_HULL_NONE, "none") NAME(ORL_HULL_CLOSE, "close")
enum orl_hull_use { ORL_HULL_USES(ORL_ENUMERATOR) };

// Whether to look for what single photographs show before the scene.
#define ORL_OCCLUDER_SEARCHES(NAME) \
    NAME(ORL_OCCLUDER_SEARCH_NONE, "none") NAME(ORL_OCCLUDER_SEARCH_FIND, "find")
enum orl_occluder_search { ORL_OCCLUDER_SEARCHES(ORL_ENUMERATOR) };

// Whether the options of rendering are found on the scene's own photographs.
#define ORL_ADAPTS(NAME) NAME(ORL_ADAPT_NONE, "none") NAME(ORL_ADAPT_AUTO, "auto")
enum orl_adapt { ORL_ADAPTS(ORL_ENUMERATOR) };

// How the response curve of a camera is found from points that were seen at several exposures.
// polynomial: Oriel's own. debevec, robertson: OpenCV's, to compare with.
#define ORL_RESPONSE_METHODS(NAME) \
    NAME(ORL_RESPONSE_POLYNOMIAL, "polynomial") NAME(ORL_RESPONSE_DEBEVEC, "debevec") \
    NAME(ORL_RESPONSE_ROBERTSON, "robertson")
enum orl_response_method { ORL_RESPONSE_METHODS(ORL_ENUMERATOR) };

// Which photographs that are named as doubtful are left out. blurred: much less sharp than most.
// duplicates: same picture as another, re-encoded, or of a camera that stood still.
#define ORL_LEAVE_OUTS(NAME) \
    NAME(ORL_LEAVE_OUT_NONE, "none") NAME(ORL_LEAVE_OUT_BLURRED, "blurred") \
    NAME(ORL_LEAVE_OUT_DUPLICATES, "duplicates") NAME(ORL_LEAVE_OUT_BOTH, "both")
enum orl_leave_out { ORL_LEAVE_OUTS(ORL_ENUMERATOR) };

// By their enums.
extern const char *const orl_quality_names[], *const orl_matching_names[],
    *const orl_mapper_names[], *const orl_prepare_mesh_names[];

// clang-format off
// Held-out photographs take part in the calibration alone.
#define ORL_HELD_OUT_OPTIONS(ROW) \
    ROW(test_every, "test-every", INT(0, 2, 100000, "N"), \
        "hold out every N-th photograph by name") \
    ROW(test_list, "test-list", LIST("A,B,.."), "hold out these photographs") \
    ROW(test_block, "test-block", BLOCK, \
        "hold out photographs A to B - 1 in the order of names, from 0: the protocol beyond")

// A number outside its range, as 0, asks for the usual one. ROW's last column: which stages' keys
// have the value, and under which name; keys of scenes that there are stay valid if the default of a
// new option is left out (STAGE?KEY).
#define ORL_PREPARE_OPTIONS(ROW) \
    ROW(out, "out", NEEDED("SCENE"), "the scene folder to make", "-") \
    ROW(quality, "quality", CHOICE(orl_quality, ORL_QUALITIES, ORL_QUALITY_STANDARD, "NAME"), \
        "sizes and effort", \
        "calibrate=quality densify=quality mesh=quality scene=quality parts=quality") \
    ROW(max_size, "max-size", INT(0, 64, 16384, "PX"), \
        "larger side of photographs in the scene (by quality: 800, 1600, 3200)") \
    ROW(fps, "fps", NUMBER(0, 0.001, 1000, "N"), "frames taken of a second of video; default 2") \
    ROW(frames, "frames", INT(0, 1, 100000, "N"), "frames taken of each video instead") \
    ROW(leave_out, "leave-out", \
        CHOICE(orl_leave_out, ORL_LEAVE_OUTS, ORL_LEAVE_OUT_NONE, "WHAT"), \
        "doubtful photographs, which are named in any case, are left out") \
    ORL_HELD_OUT_OPTIONS(ROW) \
    ROW(masks_dir, "masks", PATH("DIR"), "NAME.png or NAME.EXT.png; black is ignored") \
    ROW(exposures, "exposures", PATH("FILE"), \
        "exposures in place of EXIF's: lines NAME,TIME,APERTURE,ISO or NAME,EV") \
    ROW(response, "response", \
        CHOICE(orl_response_method, ORL_RESPONSE_METHODS, ORL_RESPONSE_POLYNOMIAL, "HOW"), \
        "how response curves are found; debevec and robertson are OpenCV's, to compare with", \
        "expose?response") \
    ROW(sharing, "camera-sharing", \
        CHOICE(orl_camera_sharing, ORL_CAMERA_SHARINGS, ORL_SHARING_AUTO, "HOW"), \
        "which photographs are of one camera; auto: by size and EXIF", \
        "calibrate=sharing scene=camera_sharing") \
    ROW(matching, "matching", CHOICE(orl_matching, ORL_MATCHINGS, ORL_MATCHING_AUTO, "HOW"), \
        "which pairs are matched; sequential: neighbours by name; retrieval: by look", \
        "calibrate=matching scene=matching") \
    ROW(mapper, "mapper", CHOICE(orl_mapper, ORL_MAPPERS, ORL_MAPPER_AUTO, "HOW"), \
        "which of COLMAP's mappers; auto: incremental up to 400 photographs", \
        "calibrate?mapper") \
    ROW(densifier, "densifier", \
        CHOICE(orl_densifier, ORL_DENSIFIERS, ORL_DENSIFIER_AUTO, "NAME"), \
        "gl is built in, colmap needs CUDA", "densify=densifier scene=densifier") \
    ROW(fuse_cluster, "fuse-cluster", INT(0, 2, 100000, "N"), \
        "photographs fused together at most; default: what fits in memory, and 400") \
    ROW(hull, "hull", CHOICE(orl_hull_use, ORL_HULL_USES, ORL_HULL_CLOSE, "HOW"), \
        "close surfaces that stereo leaves open by the hull of silhouettes: masks, or what is " \
        "before a dark backdrop", "fuse?hull") \
    ROW(radius_neighbours, "radius-neighbours", INT(0, 1, 64, "K"), \
        "a splat reaches to its point's K-th neighbour; default 6") \
    ROW(radius_overlap, "radius-overlap", NUMBER(0, 0.01, 8, "X"), \
        "splats are X times as large; default 1") \
    ROW(mesh, "mesh", CHOICE(orl_prepare_mesh, ORL_PREPARE_MESHES, ORL_MESH_NONE, "HOW"), \
        "also make mesh.ply, for methods that draw a mesh", "mesh=mesh") \
    ROW(adapt, "adapt", CHOICE(orl_adapt, ORL_ADAPTS, ORL_ADAPT_AUTO, "HOW"), \
        "find the options of rendering that suit the scene by rendering training photographs", \
        "tune?adapt") \
    ROW(occluders, "occluders", \
        CHOICE(orl_occluder_search, ORL_OCCLUDER_SEARCHES, ORL_OCCLUDER_SEARCH_FIND, "HOW"), \
        "find what single photographs show before the scene, so that it is not painted onto what " \
        "is behind") \
    ROW(keep, "keep", CHOICE(orl_keep, ORL_KEEPS, ORL_KEEP_MINIMAL, "WHAT"), \
        "minimal is what commands read; all has the stereo's maps, too") \
    ROW(refine, "refine", FLAG, "when the scene is made, do what oriel refine does") \
    ROW(max_ram_bytes, "max-ram", MIB(1 << 24), \
        "memory that fusion and points keep to; default: half of what is free") \
    ROW(max_vram_bytes, "max-vram", MIB(1 << 20), "device memory that densify and refine keep to", \
        "densify?max_vram") \
    ROW(until, "until", CHOICE(orl_until, ORL_UNTILS, ORL_UNTIL_END, "STAGE"), \
        "stop before features or stereo, which oriel plan divides into jobs", "-") \
    ROW(resume, "resume", FLAG, "go on with what is in SCENE", "-") \
    ROW(seed, "seed", SEED, "of random choices", \
        "calibrate=seed densify=seed scene=seed parts=seed")
// clang-format on

struct orl_prepare_params {
    ORL_PREPARE_OPTIONS(ORL_OPTION_MEMBER)
    const char *const *inputs; // photographs, videos and folders of them, with their sub-folders
    size_t input_count;
    struct orl_gpu *gpu;       // NULL: opened when a stage needs it
    const char *shader_dir;    // for a GPU opened here; NULL: the embedded shaders
};
#define ORL_PREPARE_DEFAULTS ORL_PREPARE_OPTIONS(ORL_OPTION_PRESET) .inputs = NULL

const struct orl_option *orl_prepare_options(void);
// Larger side of the undistorted photographs in pixels: max_size, or by quality where that is 0.
int orl_prepare_max_size(const struct orl_prepare_params *params);

#endif
