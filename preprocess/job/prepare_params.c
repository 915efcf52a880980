#include "oriel/prepare_params.h"

const char *const orl_quality_names[] = {"draft", "standard", "high", NULL};
const char *const orl_camera_sharing_names[] = {"auto", "single", "each", NULL};
const char *const orl_matching_names[] = {"auto", "exhaustive", "sequential", "retrieval",
                                           NULL};
const char *const orl_mapper_names[] = {"auto", "incremental", "hierarchical", "global", NULL};
const char *const orl_densifier_names[] = {"auto", "gl", "colmap", NULL};
const char *const orl_keep_names[] = {"minimal", "all", NULL};
const char *const orl_prepare_mesh_names[] = {"none", "poisson", "delaunay", NULL};
const char *const orl_hull_use_names[] = {"none", "close", NULL};
const char *const orl_occluder_search_names[] = {"none", "find", NULL};
const char *const orl_adapt_effort_names[] = {"none", "short", "long", NULL};
const char *const orl_leave_out_names[] = {"none", "blurred", "duplicates", "both", NULL};
const char *const orl_until_names[] = {"end", "collect", "undistort", NULL};

int orl_prepare_max_size(const struct orl_prepare_params *params)
{
    static const int sizes[] = {[ORL_QUALITY_DRAFT] = 800, [ORL_QUALITY_STANDARD] = 1600,
                                [ORL_QUALITY_HIGH] = 3200};
    return params->max_size ? params->max_size : sizes[params->quality];
}
