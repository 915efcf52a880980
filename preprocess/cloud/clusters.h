// Clusters of photographs that overlap, so that fusion of one takes little memory.
#ifndef ORL_PREPROCESS_CLUSTERS_H
#define ORL_PREPROCESS_CLUSTERS_H

#include "oriel/names.h"
#include "oriel/points.h"
#include "scene/colmap.h"

// Each training photograph is a member of one cluster, and each sparse point belongs to the cluster
// whose members show it best together. Depends on the model, the photographs and the size alone.
struct orl_clusters {
    const struct orl_colmap_model *model;
    size_t count;
    size_t size;   // members at most
    int *member;   // owned; of each image of the model: its cluster; -1: not a training photograph
    int *owner;    // owned; of each sparse point: its cluster; -1: no training photograph sees it
};

// Clusters the photographs `train` of the model, at most `size` a cluster. The model must outlive
// the clusters.
enum orl_result orl_clusters_make(const struct orl_log *log, const struct orl_colmap_model *model,
                                  const struct orl_names *train, size_t size,
                                  struct orl_clusters *clusters) ORL_CHECK_RESULT;
void orl_clusters_finish(struct orl_clusters *clusters);
// How many photographs that are no members help a cluster of so many members at most.
size_t orl_clusters_helpers(size_t size);
// The photographs that are fused for a cluster, in the model's order: its members, and of the others
// those that show the cluster's sparse points best.
enum orl_result orl_clusters_photographs(const struct orl_log *log,
                                         const struct orl_clusters *clusters, int cluster,
                                         struct orl_names *names) ORL_CHECK_RESULT;
// Drops the points whose nearest sparse point belongs to another cluster, so that the clouds of all
// clusters together have each surface once.
enum orl_result orl_clusters_keep_own(const struct orl_log *log,
                                      const struct orl_clusters *clusters, int cluster,
                                      struct orl_points *points) ORL_CHECK_RESULT;

#endif
