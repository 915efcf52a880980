// Points as PLY, in the layout of points.ply, in the coordinates that were imported.
#include "exchange/kinds.h"

ORL_EXPORT_WRITER(orl_export_ply)
{
    (void)progress;
    return orl_points_write_from(log, params->out, &scene->points, scene->origin);
}
