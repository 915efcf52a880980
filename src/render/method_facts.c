// What a method asks of a scene, and what it does at each pixel, told from its row.
#include <stdio.h>
#include <string.h>

#include "render/frame/method.h"

const char *orl_method_asks(const struct orl_method *method)
{
    const struct orl_proxy_kind *kind = method->params.proxy;
    if (method->params.paint == &orl_paint_points)
        return "points";
    return kind == &orl_proxy_hull     ? "silhouettes, or a mesh, or points"
           : kind == &orl_proxy_voxels ? "silhouettes, or points"
           : kind == &orl_proxy_mesh   ? "a mesh"
                                       : "points, or a mesh";
}

static void name_photographs(const struct orl_render_params *p, char text[64])
{
    int nearest = (int)p->nearest;
    if (p->paint == &orl_paint_tiled)
        snprintf(text, 64, "%d photographs, of %d of its tile", (int)p->photos_per_pixel,
                 (int)p->photos_per_pixel + 1);
    else if (p->select == &orl_select_nearest)
        snprintf(text, 64, "%d photographs", nearest);
    else if (p->select == &orl_select_princ)
        snprintf(text, 64, "%d photographs", nearest + ORL_PRINC_EXTRAS);
    else
        snprintf(text, 64, "all photographs");
}

void orl_method_cost(const struct orl_method *method, char *text, size_t size)
{
    const struct orl_render_params *p = &method->params;
    const struct orl_painter *painter = p->paint;
    bool maps = strcmp(p->visibility, "none") != 0 && strcmp(p->visibility, "facing") != 0;
    char photographs[64], times[32] = "";
    if (p->reconstructions > 1)
        snprintf(times, sizeof times, ", %d times", (int)p->reconstructions);
    if (painter == &orl_paint_points) {
        snprintf(text, size, "no photograph");
    } else if (painter == &orl_paint_billboards) {
        snprintf(text, size, "for each voxel 2 photographs; which see it, once for each hull");
    } else {
        name_photographs(p, photographs);
        snprintf(text, size, "for each pixel %s%s%s%s", photographs, times,
                 p->combine->sweeps == 2 ? ", read twice" : "",
                 maps ? "; a depth map of each" : "");
    }
}
