// Dense depth without CUDA: PatchMatch multi-view stereo in GL compute, reading
// and writing COLMAP's undistorted workspace.
#ifndef ORL_PREPROCESS_DENSIFY_H
#define ORL_PREPROCESS_DENSIFY_H

#include "core/file.h"
#include "oriel/progress.h"
#include "oriel/gpu.h"
#include "scene/colmap.h"

// Raised when the same photographs and settings give other maps than before.
enum { ORL_DENSIFY_VERSION = 5 };

struct orl_densify_params {
    int sources;          // source photographs per reference, [1, 16]; cost grows with it
    int iterations;       // photometric red-black sweeps, [1, 16]: two more at the coarsest of
                          // the scales, half as many at each finer one
    int geometric_passes; // sweeps with geometric consistency, [0, 8], each with the depths that
                          // the one before found
    int window_radius;    // NCC patch radius in pixels, [1, 15]; about half of it at the finest
                          // level, where a coarser one has told the rough shape
    int window_step;      // patch sampling step in pixels, [1, 4]
    uint32_t seed;
    const struct orl_colmap_model *model; // of WORKSPACE/sparse, where it is read already; NULL:
                                          // read here
    const char *masks_dir; // MASKS/NAME.png, 0 = not the subject; NULL: none
    size_t max_vram_bytes; // device memory to keep to, 0: no limit. When one photograph needs
                           // more, fewer sources are used, down to four, then photographs and
                           // maps of half the size, or a quarter, ...; a warning says so
};
#define ORL_DENSIFY_DEFAULTS                                                               \
    .sources = 8, .iterations = 4, .geometric_passes = 2, .window_radius = 5, .window_step = 2, \
    .seed = 1

// Writes WORKSPACE/stereo/{depth_maps,normal_maps}/NAME.{photometric,geometric}.bin
// and, of the last pass, confidence_maps/NAME.geometric.bin (same format: 0 where there is no
// depth, 0.2 where a plain surface was completed from around, up to 1 where many sources agree)
// for every photograph in `photos` (names; NULL: all of the model), using only those as sources.
// Photographs whose maps are already there are skipped when these were made from the same
// photographs with the same settings, as stereo/densify.json says; else all maps are made again.
// The same seed gives the same maps. Interrupted, it leaves whole files only.
// ORL_ERR_ARGUMENT: there are maps that densify did not make, links in place of their folders, or
// another densify is at work there.
enum orl_result orl_densify(struct orl_gpu *gpu, const char *workspace,
                            const struct orl_names *photos,
                            const struct orl_densify_params *params,
                            const struct orl_progress *progress) ORL_CHECK_RESULT;

#endif
