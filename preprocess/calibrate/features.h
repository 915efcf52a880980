// Features of photographs, by COLMAP.
#ifndef ORL_PREPROCESS_FEATURES_H
#define ORL_PREPROCESS_FEATURES_H

#include "preprocess/job/job.h"

// Which photographs share a camera.
struct orl_camera_groups {
    int *of;      // owned; of each source: its camera
    int *size;    // owned; of each camera: its photographs
    int count;
};

// Sets the groups by --camera-sharing, sizes and EXIF. ORL_ERR_ARGUMENT: one camera was asked for
// and the photographs have different sizes.
enum orl_result orl_camera_groups_find(const struct orl_job *job,
                                       struct orl_camera_groups *groups) ORL_CHECK_RESULT;
void orl_camera_groups_finish(struct orl_camera_groups *groups);

// What features are taken of: part `part` of `parts` of the photographs, in the order of their
// cameras, into COLMAP's database at `database`, a name below the scene without its extension .db.
// Photographs that have features there keep them.
struct orl_features_run {
    const char *database;
    int part, parts;
    bool costly; // more features that bear wider baselines
    bool whole;  // masks are passed over
};
enum orl_result orl_features_extract(struct orl_job *job, const struct orl_camera_groups *groups,
                                     const struct orl_features_run *run) ORL_CHECK_RESULT;
// Makes the folder of masks for COLMAP, where there are masks.
enum orl_result orl_features_link_masks(const struct orl_job *job) ORL_CHECK_RESULT;

#endif
