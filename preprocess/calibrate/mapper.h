// COLMAP's mappers, which find poses and sparse points from matches.
#ifndef ORL_PREPROCESS_MAPPER_H
#define ORL_PREPROCESS_MAPPER_H

#include "preprocess/job/job.h"

// The mapper that these parameters, this many photographs and this COLMAP ask for; never auto.
// ORL_ERR_EXTERNAL: this COLMAP does not have the mapper that was asked for.
enum orl_result orl_mapper_choose(const struct orl_job *job,
                                  enum orl_mapper *mapper) ORL_CHECK_RESULT;

struct orl_mapper_run {
    enum orl_mapper mapper;
    const char *from; // a model to go on with, by the incremental mapper; NULL: a new start
    const char *out;  // an empty folder for the models
    bool loose;       // narrower baselines and fewer inliers suffice
    bool straight;    // there is no distortion
};
// Leaves models in `out` or in numbered folders below it; none when no pair of photographs can start
// one, which is no error.
enum orl_result orl_mapper_run(struct orl_job *job,
                               const struct orl_mapper_run *run) ORL_CHECK_RESULT;
// Triangulates the points of the model `from` anew and adjusts the model as a whole, into the empty
// folder `out`. The hierarchical mapper joins its parts without that.
enum orl_result orl_mapper_refine(struct orl_job *job, const char *from, const char *out,
                                  bool straight) ORL_CHECK_RESULT;

#endif
