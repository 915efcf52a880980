// Points as PLY, in the layout of points.ply.
#include "exchange/kinds.h"

ORL_EXPORT_WRITER(orl_export_ply)
{
    (void)progress;
    return orl_points_write(log, params->out, &scene->points, false);
}
