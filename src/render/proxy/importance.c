#include "render/proxy/importance.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "core/memory.h"
#include "render/proxy/proxy.h"
#include "render/proxy/splats.h"
#include "scene/point_blocks.h"

struct orl_importance {
    struct orl_gpu *gpu;
    struct proxy proxy;
    uint32_t *points; // per point on the device: its index in the scene
    size_t count;
};

enum orl_result orl_importance_create(struct orl_gpu *gpu, const struct orl_scene *scene,
                                      struct orl_importance **out)
{
    struct orl_importance *c = orl_array(orl_gpu_log(gpu), 1, sizeof *c);
    *out = c;
    ORL_TRY_MEMORY(c);
    c->gpu = gpu;
    enum orl_result result = orl_proxy_create(gpu, scene, &orl_proxy_splats, 0, &c->proxy);
    ORL_THEN(result, orl_point_order(orl_gpu_log(gpu), &scene->points, NULL, ORL_BLOCK_POINTS, &c->points,
                                     &c->count));
    if (result != ORL_OK)
        orl_importance_destroy(out);
    return result;
}

void orl_importance_destroy(struct orl_importance **importance)
{
    struct orl_importance *c = *importance;
    if (!c)
        return;
    orl_proxy_finish(c->gpu, &c->proxy);
    free(c->points);
    free(c);
    *importance = NULL;
}

// Reads which points won, and turns the bits of their depths into numbers.
static enum orl_result read_back(const struct orl_importance *c,
                                 struct orl_nearest_points *nearest)
{
    const struct splat_target *target = c->proxy.view_target;
    size_t count = (size_t)nearest->width * (size_t)nearest->height, size = count * 4;
    orl_tex_read(target->splat_index, 0, GL_RED_INTEGER, GL_UNSIGNED_INT, size, nearest->point);
    orl_tex_read(target->splat_depth, 0, GL_RED_INTEGER, GL_UNSIGNED_INT, size, nearest->depth);
    for (size_t i = 0; i < count; i++) {
        bool won = nearest->point[i] < c->count;
        nearest->point[i] = won ? c->points[nearest->point[i]] : UINT32_MAX;
        if (!won)
            nearest->depth[i] = INFINITY;
    }
    return orl_gpu_finish(c->gpu);
}

enum orl_result orl_importance_draw(struct orl_importance *c, const struct orl_view *view,
                                    struct orl_nearest_points *nearest)
{
    const struct orl_log *log = orl_gpu_log(c->gpu);
    const struct orl_camera *camera = &view->camera;
    struct orl_render_params params = orl_methods[0].params;
    struct surface surface;
    size_t count = (size_t)camera->width * (size_t)camera->height;
    *nearest = (struct orl_nearest_points){camera->width, camera->height, NULL, NULL};
    nearest->point = orl_array(log, count, sizeof *nearest->point);
    nearest->depth = orl_array(log, count, sizeof *nearest->depth);
    enum orl_result result = nearest->point && nearest->depth ? ORL_OK : ORL_ERR_MEMORY;
    ORL_THEN(result, orl_proxy_draw(c->gpu, &c->proxy, view, &params, false, &c->proxy.view_target, &surface));
    ORL_THEN(result, read_back(c, nearest));
    if (result != ORL_OK)
        orl_nearest_points_finish(nearest);
    return result;
}

void orl_nearest_points_finish(struct orl_nearest_points *nearest)
{
    free(nearest->point);
    free(nearest->depth);
    memset(nearest, 0, sizeof *nearest);
}
