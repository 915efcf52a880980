#include "oriel/prepare_params.h"

ORL_OPTION_ROWS(orl_prepare_options, orl_prepare_params, ORL_PREPARE_OPTIONS)

const char *const orl_quality_names[] = {ORL_QUALITIES(ORL_ENUM_NAME)};
const char *const orl_matching_names[] = {ORL_MATCHINGS(ORL_ENUM_NAME)};
const char *const orl_mapper_names[] = {ORL_MAPPERS(ORL_ENUM_NAME)};
const char *const orl_prepare_mesh_names[] = {ORL_PREPARE_MESHES(ORL_ENUM_NAME)};

int orl_prepare_max_size(const struct orl_prepare_params *params)
{
    static const int sizes[] = {[ORL_QUALITY_DRAFT] = 800, [ORL_QUALITY_STANDARD] = 1600,
                                [ORL_QUALITY_HIGH] = 3200};
    return params->max_size ? params->max_size : sizes[params->quality];
}
