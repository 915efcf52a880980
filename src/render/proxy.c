#include "render/proxy.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>
#include <xxhash.h>

#include "render/frame.h"
#include "render/method.h"

static void find_extent(struct proxy *proxy)
{
    struct proxy_extent *extent = &proxy->extent;
    for (int k = 0; k < 3; k++) {
        double low = INFINITY, high = -INFINITY, sum = 0;
        for (size_t i = 0; i < proxy->vertex_count; i++) {
            double x = (double)proxy->vertices[i][k];
            low = x < low ? x : low;
            high = x > high ? x : high;
            sum += x;
        }
        if (!(low <= high))
            continue;
        extent->low[k] = low;
        extent->high[k] = high;
        extent->centroid[k] = sum / (double)proxy->vertex_count;
    }
}

static void find_vertices(struct proxy *proxy, const struct orl_scene *scene)
{
    proxy->kind->vertices(proxy->state, scene, &proxy->vertices, &proxy->vertex_count);
    memset(&proxy->extent, 0, sizeof proxy->extent);
    find_extent(proxy);
    free(proxy->aspects);
    proxy->aspects = NULL;
}

enum orl_result orl_proxy_create(struct orl_gpu *gpu, const struct orl_scene *scene,
                                 const struct proxy_kind *kind, size_t most_bytes,
                                 struct proxy *proxy)
{
    *proxy = (struct proxy){.kind = kind};
    enum orl_result result = kind->create(gpu, scene, most_bytes, &proxy->state);
    if (result == ORL_OK)
        find_vertices(proxy, scene);
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
        find_vertices(proxy, frame->scene);
    }
    return result;
}

void orl_proxy_free_photo_target(struct orl_gpu *gpu, struct proxy *proxy)
{
    proxy->kind->free_target(gpu, &proxy->photo_target);
}

void orl_proxy_finish(struct orl_gpu *gpu, struct proxy *proxy)
{
    if (!proxy->kind)
        return;
    proxy->kind->free_target(gpu, &proxy->view_target);
    proxy->kind->free_target(gpu, &proxy->photo_target);
    proxy->kind->free_target(gpu, &proxy->coarse_target);
    proxy->kind->destroy(gpu, &proxy->state);
    free(proxy->aspects);
    memset(proxy, 0, sizeof *proxy);
}

enum orl_result orl_proxy_draw(struct orl_gpu *gpu, const struct proxy *proxy,
                               const struct orl_view *view,
                               const struct orl_render_params *params, bool normals,
                               void **target, struct surface *surface)
{
    enum orl_result result = proxy->kind->resize(gpu, proxy->state, view->camera.width,
                                                 view->camera.height, target);
    if (result == ORL_OK && proxy->kind->bring)
        result = proxy->kind->bring(proxy->state, view, params);
    if (result == ORL_OK)
        proxy->kind->draw(gpu, proxy->state, view, params, normals, *target, surface);
    return result;
}

enum orl_result orl_proxy_color(const struct frame *frame, const struct paint_into *into)
{
    const struct proxy *proxy = frame->proxy;
    const struct proxy_kind *kind = proxy->kind;
    enum orl_result result =
        kind->bring_colors ? kind->bring_colors(frame->gpu, proxy->state) : ORL_OK;
    if (result == ORL_OK)
        kind->color(frame->gpu, proxy->state, frame->view, proxy->view_target, into);
    return result;
}

// True if this option belongs to the proxy.
static bool is_read_by(const struct orl_render_option *option, const struct proxy_kind *kind)
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
    for (const struct orl_render_option *o = orl_render_options; o->key; o++) {
        char text[ORL_OPTION_NAME_BYTES];
        if (!is_read_by(o, proxy->kind))
            continue;
        orl_render_option_print(o, params, text, sizeof text);
        key = XXH3_64bits_withSeed(text, strlen(text), key);
    }
    return key;
}
