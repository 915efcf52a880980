// Dense depth without CUDA: PatchMatch multi-view stereo in GL compute shaders. It reads and writes
// COLMAP's undistorted workspace.
#ifndef ORL_PREPROCESS_DENSIFY_H
#define ORL_PREPROCESS_DENSIFY_H

#include "core/file.h"
#include "oriel/progress.h"
#include "oriel/gpu.h"
#include "oriel/option_row.h"
#include "scene/colmap.h"

// Raised when the same photographs and settings give different maps.
enum { ORL_DENSIFY_VERSION = 9 };

// One unit of work, which may run beside others, on other machines too: one pass over some of the
// photographs.
struct orl_densify_part {
    int pass;         // 0: photometric, 1 to geometric_passes; all parts of the pass before must be
                      // done
    int index, count; // part `index` of `count` about equal parts of the photographs, from 0 on
};

// Cost grows with the number of source photographs. There are two photometric red-black sweeps more
// at the coarsest level, and half as many at each finer one; each geometric pass uses the depths of
// the previous one. The patch is about half as large at the finest level, where coarser levels have
// found the rough shape. When one photograph needs more device memory than the limit, or larger
// textures than every device has, orl_densify uses fewer sources, down to four, then halves
// photographs and maps until they fit; it logs a warning.
#define ORL_DENSIFY_OPTIONS(ROW) \
    ROW(masks_dir, "masks", TEXT("DIR"), "DIR/NAME.png: no depth where it is 0") \
    ROW(sources, "sources", INT(8, 1, 16, "N"), "source photographs each") \
    ROW(iterations, "iterations", INT(4, 1, 16, "N"), "photometric sweeps") \
    ROW(geometric_passes, "geometric-passes", INT(2, 0, 8, "N"), \
        "sweeps with geometric consistency") \
    ROW(window_radius, "window-radius", INT(5, 1, 15, "PX"), "patch radius") \
    ROW(window_step, "window-step", INT(2, 1, 4, "PX"), "patch sampling") \
    ROW(seed, "seed", SEED, "of the random hypotheses") \
    ROW(max_vram_bytes, "max-vram", MIB(1 << 20), "device memory to plan for")
struct orl_densify_params {
    ORL_DENSIFY_OPTIONS(ORL_OPTION_MEMBER)
    const struct orl_colmap_model *model; // of WORKSPACE/sparse, when already read; NULL: read by
                                          // orl_densify
    const struct orl_densify_part *part; // NULL: everything. A part needs orl_densify_begin, with
                                         // the same settings and photographs, to have run
};
const struct orl_option *orl_densify_options(void);
#define ORL_DENSIFY_DEFAULTS ORL_DENSIFY_OPTIONS(ORL_OPTION_PRESET) .model = NULL

// Writes WORKSPACE/stereo/{depth_maps,normal_maps}/NAME.{photometric,geometric}.bin for every
// photograph in `photos` (names; NULL: all of the model), and the last pass's
// confidence_maps/NAME.geometric.bin. Where there is no stereo/fusion.cfg, it writes one that lists these
// photographs, as colmap stereo_fusion needs it. Confidence maps have the same format: 0 without depth, 0.2
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

// The ending of a pass's maps, NAME.KIND.bin; returns `kind`.
enum { ORL_DENSIFY_KIND_SIZE = 24 };
const char *orl_densify_pass_kind(int pass, int geometric_passes, char kind[ORL_DENSIFY_KIND_SIZE]);
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
