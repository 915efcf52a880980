// Dense depth without CUDA: PatchMatch multi-view stereo in GL compute shaders. It reads and writes
// COLMAP's undistorted workspace.
#ifndef ORL_PREPROCESS_DENSIFY_H
#define ORL_PREPROCESS_DENSIFY_H

#include "core/file.h"
#include "oriel/progress.h"
#include "oriel/gpu.h"
#include "scene/colmap.h"

// Raised when the same photographs and settings give different maps.
enum { ORL_DENSIFY_VERSION = 6 };

// One unit of work, which may run beside others, on other machines too: one pass over some of the
// photographs.
struct orl_densify_part {
    int pass;         // 0: photometric, 1 to geometric_passes; all parts of the pass before must be
                      // done
    int index, count; // part `index` of `count` about equal parts of the photographs, from 0 on
};

struct orl_densify_params {
    int sources;          // source photographs per reference, [1, 16]; cost grows with it
    int iterations;       // photometric red-black sweeps, [1, 16]: two more at the coarsest level,
                          // half as many at each finer one
    int geometric_passes; // passes with geometric consistency, [0, 8]; each uses the depths of the
                          // previous pass
    int window_radius;    // NCC patch radius in pixels, [1, 15]; about half of it at the finest
                          // level, where coarser levels have found the rough shape
    int window_step;      // patch sampling step in pixels, [1, 4]
    uint32_t seed;
    const struct orl_colmap_model *model; // of WORKSPACE/sparse, when already read; NULL: read by
                                          // orl_densify
    const char *masks_dir; // MASKS/NAME.png, where 0 marks the background; NULL: none
    size_t max_vram_bytes; // limit of device memory, 0: none. When one photograph needs more,
                           // orl_densify uses fewer sources, down to four, then halves photographs
                           // and maps until they fit; it logs a warning
    const struct orl_densify_part *part; // NULL: everything. A part needs orl_densify_begin, with
                                         // the same settings and photographs, to have run
};
#define ORL_DENSIFY_DEFAULTS                                                               \
    .sources = 8, .iterations = 4, .geometric_passes = 2, .window_radius = 5, .window_step = 2, \
    .seed = 1

// Writes WORKSPACE/stereo/{depth_maps,normal_maps}/NAME.{photometric,geometric}.bin for every
// photograph in `photos` (names; NULL: all of the model), and the last pass's
// confidence_maps/NAME.geometric.bin. Confidence maps have the same format: 0 without depth, 0.2
// where a plain surface was completed from its surroundings, up to 1 where many sources agree. Only
// `photos` serve as sources. Existing maps are kept when stereo/densify.json says that they were
// made from the same photographs with the same settings; otherwise all maps are made again. The
// same seed gives the same maps. An interrupted run leaves only complete files. ORL_ERR_ARGUMENT:
// the workspace holds maps that another program made, or links in place of the map folders, or
// another densifier is running there.
enum orl_result orl_densify(struct orl_gpu *gpu, const char *workspace,
                            const struct orl_names *photos,
                            const struct orl_densify_params *params,
                            const struct orl_progress *progress) ORL_CHECK_RESULT;

// The ending of a pass's maps, NAME.KIND.bin.
enum { ORL_DENSIFY_KIND_SIZE = 24 };
void orl_densify_pass_kind(int pass, int geometric_passes, char kind[ORL_DENSIFY_KIND_SIZE]);
// Of `parts` parts of the photographs: which read maps of which. reads[a * parts + b] is set where
// a photograph of part a has a source in part b.
enum orl_result orl_densify_part_sources(const struct orl_log *log,
                                         const struct orl_colmap_model *model,
                                         const struct orl_names *photos, int sources, int parts,
                                         bool *reads) ORL_CHECK_RESULT;

// Makes WORKSPACE/stereo ready for parts: removes maps of other settings or photographs. A later
// orl_densify without a part finds what the parts have made, makes what is missing, and removes
// what only other passes read.
enum orl_result orl_densify_begin(const struct orl_log *log, const char *workspace,
                                  const struct orl_names *photos,
                                  const struct orl_densify_params *params) ORL_CHECK_RESULT;

#endif
