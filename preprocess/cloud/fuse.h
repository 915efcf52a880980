// Fuse: one point cloud from all depth maps. Many photographs are fused in clusters that overlap.
#ifndef ORL_PREPROCESS_FUSE_H
#define ORL_PREPROCESS_FUSE_H

#include "preprocess/cloud/clusters.h"
#include "preprocess/job/job.h"

enum { ORL_FUSE_VERSION = 9 }; // raised when the points of the same maps change

// Clusters the photographs `train` of the model: at most `asked` a cluster (--fuse-cluster), or where
// that is 0, as many as fit in `budget` bytes and no more than 400. The model must outlive the
// clusters.
enum orl_result orl_fuse_clusters(const struct orl_log *log, const struct orl_colmap_model *model,
                                  const struct orl_names *train, int asked, double budget,
                                  struct orl_clusters *clusters) ORL_CHECK_RESULT;
// How many photographs are fused together at most where --fuse-cluster does not say: as many as fit
// in memory (--max-ram, or half of what is free) and no more than 400. The choice is kept in
// .oriel/stages.json. A later run without --max-ram makes the same choice while photographs and
// settings are the same, whatever memory is free then: it uses the clusters that are fused already,
// and gives the same points as a run that was not interrupted.
enum orl_result orl_fuse_choose(struct orl_job *job, const struct orl_colmap_model *model,
                                const struct orl_names *train, size_t *size) ORL_CHECK_RESULT;
// The file of a cluster's cloud (ORL_PATH), with another extension than .ply for what belongs to it. The folder's name
// holds what the points depend on beside the maps, which are beside it and go with it.
#define ORL_FUSE_CLUSTER_PATH(scene, size, cluster, extension) \
    ORL_PATH(scene, "stereo/fused/%d-%zu/%06d" extension, ORL_FUSE_VERSION, size, (cluster) + 1)

struct orl_fuse_params {
    int size;             // photographs of a cluster at most; 0: what fits in memory
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
