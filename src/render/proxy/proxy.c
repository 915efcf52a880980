#include "render/proxy/proxy.h"

#include <stdlib.h>
#include <string.h>
#include <xxhash.h>

#include "core/memory.h"
#include "core/order.h"

enum orl_result orl_vertices_range(const struct orl_log *log, const float (*vertices)[3],
                                   size_t vertex_count, double share, double low[3],
                                   double high[3])
{
    size_t step = vertex_count / 100000 + 1, count = (vertex_count + step - 1) / step;
    size_t out = (size_t)(share * (double)count);
    float *along = orl_array(log, count + 1, sizeof *along);
    ORL_TRY_MEMORY(along);
    for (int k = 0; count && k < 3; k++) {
        for (size_t i = 0; i < count; i++)
            along[i] = vertices[i * step][k];
        qsort(along, count, sizeof *along, orl_order_floats);
        low[k] = (double)along[out];
        high[k] = (double)along[count - 1 - out];
    }
    free(along);
    return ORL_OK;
}

static enum orl_result find_extent(const struct orl_log *log, struct proxy *proxy)
{
    struct proxy_extent *extent = &proxy->extent;
    size_t within = 0;
    enum orl_result result = orl_vertices_range(log, proxy->vertices, proxy->vertex_count, 0.02,
                                                extent->low, extent->high);
    for (size_t i = 0; result == ORL_OK && i < proxy->vertex_count; i++) {
        double at[3];
        bool inside = true;
        for (int k = 0; k < 3; k++) {
            at[k] = (double)proxy->vertices[i][k];
            inside = inside && at[k] >= extent->low[k] && at[k] <= extent->high[k];
        }
        within += inside;
        for (int k = 0; inside && k < 3; k++)
            extent->centroid[k] += (at[k] - extent->centroid[k]) / (double)within;
    }
    return result;
}

static enum orl_result find_vertices(const struct orl_log *log, struct proxy *proxy,
                                     const struct orl_scene *scene)
{
    proxy->kind->vertices(proxy->state, scene, &proxy->vertices, &proxy->vertex_count);
    memset(&proxy->extent, 0, sizeof proxy->extent);
    free(proxy->aspects);
    proxy->aspects = NULL;
    return find_extent(log, proxy);
}

enum orl_result orl_proxy_create(struct orl_gpu *gpu, const struct orl_scene *scene,
                                 const struct orl_proxy_kind *kind, size_t max_bytes,
                                 struct proxy *proxy)
{
    const struct orl_log *log = orl_gpu_log(gpu);
    *proxy = (struct proxy){.kind = kind, .state = orl_array(log, 1, kind->state_size)};
    enum orl_result result = proxy->state ? ORL_OK : ORL_ERR_MEMORY;
    if (result == ORL_OK && kind->init)
        result = kind->init(gpu, scene, max_bytes, proxy->state);
    ORL_THEN(result, find_vertices(log, proxy, scene));
    if (result != ORL_OK)
        orl_proxy_finish(gpu, proxy);
    return result;
}

enum orl_result orl_proxy_update(const struct frame *frame)
{
    struct proxy *proxy = frame->proxy;
    bool changed = false;
    if (!proxy->kind->update)
        return ORL_OK;
    enum orl_result result = proxy->kind->update(frame, proxy->state, &changed);
    if (result == ORL_OK && changed) {
        proxy->version++;
        result = find_vertices(orl_gpu_log(frame->gpu), proxy, frame->scene);
    }
    return result;
}

static void free_target(struct orl_gpu *gpu, const struct orl_proxy_kind *kind, void **target)
{
    struct surface *surface = *target;
    if (!surface)
        return;
    void *own = surface + 1;
    const size_t count = (kind->target_size - sizeof *surface) / sizeof(struct orl_tex *);
    for (size_t i = 0; i < count; i++)
        orl_tex_destroy(gpu, (struct orl_tex **)own + i);
    orl_tex_destroy(gpu, &surface->depth);
    orl_tex_destroy(gpu, &surface->normal);
    free(surface);
    *target = NULL;
}

void orl_proxy_free_photo_target(struct orl_gpu *gpu, struct proxy *proxy)
{
    free_target(gpu, proxy->kind, &proxy->photo_target);
}

void orl_proxy_finish(struct orl_gpu *gpu, struct proxy *proxy)
{
    if (!proxy->kind)
        return;
    free_target(gpu, proxy->kind, &proxy->view_target);
    free_target(gpu, proxy->kind, &proxy->photo_target);
    free_target(gpu, proxy->kind, &proxy->coarse_target);
    if (proxy->state)
        proxy->kind->finish(gpu, proxy->state);
    free(proxy->state);
    free(proxy->aspects);
    memset(proxy, 0, sizeof *proxy);
}

// Makes *target fit the size.
static enum orl_result resize(struct orl_gpu *gpu, const struct proxy *proxy, int width, int height, void **target)
{
    struct surface *surface = *target;
    if (surface && surface->width == width && surface->height == height)
        return ORL_OK;
    free_target(gpu, proxy->kind, target);
    *target = surface = orl_array(orl_gpu_log(gpu), 1, proxy->kind->target_size);
    ORL_TRY_MEMORY(surface);
    surface->width = width;
    surface->height = height;
    const struct orl_tex_row rows[] = {{"proxy depth", GL_R32F, &surface->depth},
                                       {"proxy normal", GL_RGBA16F, &surface->normal}};
    enum orl_result result = orl_tex_create_rows(gpu, width, height, rows, ORL_COUNT(rows));
    ORL_THEN(result, proxy->kind->make_target(gpu, proxy->state, surface));
    if (result != ORL_OK)
        free_target(gpu, proxy->kind, target);
    return result;
}

enum orl_result orl_proxy_draw(struct orl_gpu *gpu, const struct proxy *proxy,
                               const struct orl_view *view,
                               const struct orl_render_params *params, bool normals,
                               void **target, struct surface *surface)
{
    ORL_TRY(resize(gpu, proxy, view->camera.width, view->camera.height, target));
    if (proxy->kind->bring)
        ORL_TRY(proxy->kind->bring(proxy->state, view));
    proxy->kind->draw(gpu, proxy->state, view, params, normals, *target);
    *surface = *(const struct surface *)*target;
    return ORL_OK;
}

enum orl_result orl_proxy_color(const struct frame *frame, const struct paint_into *into)
{
    const struct proxy *proxy = frame->proxy;
    const struct orl_proxy_kind *kind = proxy->kind;
    ORL_TRY(kind->bring_colors ? kind->bring_colors(frame->gpu, proxy->state) : ORL_OK);
    kind->color(frame->gpu, proxy->state, frame->view, proxy->view_target, into);
    return ORL_OK;
}

bool orl_proxy_reads(const struct orl_option *option, const struct orl_proxy_kind *kind)
{
    size_t length = strlen(kind->name);
    for (const char *at = option->readers; (at = strstr(at, "proxy=")); at++)
        if (strncmp(at + strlen("proxy="), kind->name, length) == 0)
            return true;
    return false;
}

uint64_t orl_proxy_key(const struct proxy *proxy, const struct orl_render_params *params)
{
    uint64_t key = XXH3_64bits_withSeed(proxy->kind->name, strlen(proxy->kind->name),
                                        proxy->version);
    for (const struct orl_option *o = orl_render_options(); o->name; o++) {
        char text[ORL_OPTION_TEXT];
        if (!orl_proxy_reads(o, proxy->kind))
            continue;
        orl_option_print(o, params, text);
        key = XXH3_64bits_withSeed(text, strlen(text), key);
    }
    return key;
}
