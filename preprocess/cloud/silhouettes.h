// The silhouettes of a subject that was photographed from all around.
#ifndef ORL_PREPROCESS_SILHOUETTES_H
#define ORL_PREPROCESS_SILHOUETTES_H

#include "oriel/points.h"
#include "preprocess/job/job.h"
#include "scene/cones.h"

struct orl_silhouettes {
    struct orl_silhouette *items;          // owned, masks too
    const struct orl_colmap_image **image; // owned; the photograph of each, in the model
    size_t count;                          // 0: there are none to rely on
    bool given;                            // masks of the scene; false: a dark backdrop
};

// Finds them for the training photographs `train`: the scene's masks, if each photograph has one, or
// without masks what is brighter than a dark backdrop, if all have one. None if there are fewer than
// five, if they were taken from one side of the points, so that their hull would be much larger than
// the subject, or if the silhouettes leave the pictures. The model must outlive them.
enum orl_result orl_silhouettes_find(struct orl_job *job, const struct orl_colmap_model *model,
                                     const struct orl_names *train, const struct orl_points *points,
                                     struct orl_silhouettes *found) ORL_CHECK_RESULT;
void orl_silhouettes_finish(struct orl_silhouettes *found);

#endif
