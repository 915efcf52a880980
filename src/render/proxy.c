#include "render/proxy.h"

#include <string.h>
#include <xxhash.h>

#include "render/method.h"

enum orl_result orl_proxy_create(struct orl_gpu *gpu, const struct orl_scene *scene,
                                 const struct proxy_kind *kind, struct proxy *proxy)
{
    *proxy = (struct proxy){.kind = kind};
    return kind->create(gpu, scene, &proxy->state);
}

void orl_proxy_finish(struct orl_gpu *gpu, struct proxy *proxy)
{
    if (!proxy->kind)
        return;
    proxy->kind->free_target(gpu, &proxy->view_target);
    proxy->kind->free_target(gpu, &proxy->photo_target);
    proxy->kind->destroy(gpu, &proxy->state);
    memset(proxy, 0, sizeof *proxy);
}

enum orl_result orl_proxy_draw(struct orl_gpu *gpu, const struct proxy *proxy,
                               const struct orl_view *view,
                               const struct orl_render_params *params, bool normals,
                               void **target, struct surface *surface)
{
    enum orl_result result = proxy->kind->resize(gpu, proxy->state, view->camera.width,
                                                 view->camera.height, target);
    if (result == ORL_OK)
        proxy->kind->draw(gpu, proxy->state, view, params, normals, *target, surface);
    return result;
}

// True if this option belongs to the proxy.
static bool is_read_by(const struct orl_render_option *option, const struct proxy_kind *kind)
{
    const char *reader = strstr(option->readers, "proxy=");
    size_t length = strlen(kind->name);
    return reader && strncmp(reader + strlen("proxy="), kind->name, length) == 0;
}

uint64_t orl_proxy_key(const struct proxy *proxy, const struct orl_render_params *params)
{
    uint64_t key = XXH3_64bits(proxy->kind->name, strlen(proxy->kind->name));
    for (const struct orl_render_option *o = orl_render_options; o->key; o++) {
        char text[ORL_OPTION_NAME_BYTES];
        if (!is_read_by(o, proxy->kind))
            continue;
        orl_render_option_print(o, params, text, sizeof text);
        key = XXH3_64bits_withSeed(text, strlen(text), key);
    }
    return key;
}
