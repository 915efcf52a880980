// Fuse: one point cloud from all depth maps, made by COLMAP. Many photographs are fused in
// clusters that overlap.
#ifndef ORL_PREPROCESS_FUSE_H
#define ORL_PREPROCESS_FUSE_H

#include "preprocess/job/job.h"

enum { ORL_FUSE_VERSION = 6 }; // raised when the points of the same maps change

json_t *orl_stage_fuse_settings(const struct orl_job *job);
// Writes .oriel/fused.ply. Clouds of clusters that oriel fuse has made are used.
enum orl_result orl_stage_fuse(struct orl_job *job, json_t *record) ORL_CHECK_RESULT;

// The photographs of a cluster at most, of the option --fuse-cluster; NULL: the default.
int orl_fuse_cluster_size(const char *option);
// The file of a cluster's cloud, with another extension than .ply for what belongs to it. The caller
// releases it with free().
char *orl_fuse_cluster_path(const struct orl_log *log, const char *scene, size_t size, int cluster,
                            const char *extension);

struct orl_fuse_params {
    int size;             // photographs of a cluster at most; 0: the default
    int cluster, count;   // the cluster to fuse, from 0 on, of so many
    bool masks;           // SCENE/masks is respected
    size_t max_ram_bytes; // 0: half of what is free
};
// Fuses one cluster of a scene whose stereo is complete and that is not whole yet. Leaves
// stereo/fused/ with the cluster's cloud, which orl_stage_fuse uses; does nothing when it is there.
enum orl_result orl_fuse_cluster(const struct orl_log *log, const char *scene,
                                 const struct orl_fuse_params *params,
                                 const struct orl_progress *progress) ORL_CHECK_RESULT;

#endif
