// Memory of fusion: what it takes, and the clusters that keep to a budget.
#ifndef ORL_PREPROCESS_FUSE_MEMORY_H
#define ORL_PREPROCESS_FUSE_MEMORY_H

#include "oriel/names.h"
#include "scene/colmap.h"

// Bytes that fusion may take, for the option --max-ram; 0: half of what is free.
double orl_fuse_budget(size_t max_ram_bytes);

// The sum of the pixels of some photographs of the model.
double orl_fuse_pixels(const struct orl_colmap_model *model, const struct orl_names *names);

// Bytes of a fusion of so many pixels.
double orl_fuse_bytes(double pixels);

// How many of the `count` photographs of a fusion may be read at once, normals and colours: more than a quarter of
// them where the budget has room.
size_t orl_fuse_at_once(double pixels, size_t count, double budget);

// The photographs of a cluster at most: as many as fit in the budget, in bytes, with the photographs
// that help the cluster (docs/how/pipeline.md#clusters). At most `most`. Clusters are as equal as can
// be, so a little more or less memory gives the same clusters. *size is at least 1.
enum orl_result orl_fuse_plan_size(const struct orl_log *log, const struct orl_colmap_model *model,
                                   const struct orl_names *names, size_t most, double budget,
                                   size_t *size) ORL_CHECK_RESULT;

#endif
