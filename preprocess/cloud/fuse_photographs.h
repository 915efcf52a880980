// One fusion by COLMAP: the points that the depth maps of some photographs agree on.
#ifndef ORL_PREPROCESS_FUSE_PHOTOGRAPHS_H
#define ORL_PREPROCESS_FUSE_PHOTOGRAPHS_H

#include "oriel/points.h"
#include "preprocess/job/job.h"

struct orl_fusion {
    const char *workspace;         // COLMAP's, with these photographs in stereo/fusion.cfg
    const char *temp;              // a folder for COLMAP's clouds
    const struct orl_names *names; // the photographs
    double done, total;            // of `total` fusions, `done` are finished; for progress
    // Set by the fusion:
    double cache_gib;              // COLMAP's cache of maps; 0: all maps were in memory
    size_t of_three, strays;       // points of three photographs; outliers that were dropped
};
// Fuses them, in memory within --max-ram where that suffices. ORL_ERR_DATA: nothing that two
// photographs agree on.
enum orl_result orl_fuse_photographs(struct orl_job *job, const struct orl_colmap_model *model,
                                     struct orl_fusion *fusion,
                                     struct orl_points *points) ORL_CHECK_RESULT;

#endif
