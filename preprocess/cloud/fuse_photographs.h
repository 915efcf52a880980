// One fusion: the points that the depth maps of some photographs agree on.
#ifndef ORL_PREPROCESS_FUSE_PHOTOGRAPHS_H
#define ORL_PREPROCESS_FUSE_PHOTOGRAPHS_H

#include "oriel/points.h"
#include "preprocess/cloud/fuse_maps.h"
#include "preprocess/job/job.h"

// How many others each photograph is compared with: those that share most sparse points with it.
#define ORL_FUSE_OTHERS 48

// Fuses the maps of these photographs (stereo/, the scene's masks applied). Of `total` fusions,
// `done` are finished, for progress. ORL_ERR_DATA: nothing that two photographs agree on.
enum orl_result orl_fuse_photographs(struct orl_job *job, const struct orl_colmap_model *model,
                                     const struct orl_names *names, double done, double total,
                                     struct orl_points *points) ORL_CHECK_RESULT;

// Reads the depth map of a photograph, the scene's mask applied. Without data: there is none. The
// caller releases map->depth.
enum orl_result orl_fuse_read_map(const struct orl_job *job, const struct orl_colmap_model *model,
                                  const struct orl_colmap_image *image,
                                  struct orl_depth_map *map) ORL_CHECK_RESULT;

#endif
