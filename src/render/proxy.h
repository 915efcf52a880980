// Private to src/render: what stands for the scene's surfaces, and draws them for any camera.
#ifndef ORL_RENDER_PROXY_H
#define ORL_RENDER_PROXY_H

#include "render/render.h"

// What all passes after the proxy see of it.
struct surface {
    int width, height;
    struct orl_tex *depth;  // R32F: z in camera space, 0: none, < 0: guessed
    struct orl_tex *normal; // RGBA16F: camera frame, 0: none; w: 1 where the proxy itself shows
};

// One kind of proxy. `state` is its data on the device, `target` its memory for one picture size.
struct proxy_kind {
    const char *name;
    enum orl_result (*create)(struct orl_gpu *gpu, const struct orl_scene *scene, void **state);
    void (*destroy)(struct orl_gpu *gpu, void **state);
    // Makes `target` (NULL at first) fit the size; does nothing when it does.
    enum orl_result (*resize)(struct orl_gpu *gpu, const void *state, int width, int height,
                              void **target);
    void (*free_target)(struct orl_gpu *gpu, void **target);
    // Bytes of a target of this size.
    size_t (*target_bytes)(const void *state, int width, int height);
    // Draws the surface that `view` sees; its textures are the target's. `normals`: else the normal
    // is left as it was, which saves a tenth of a software renderer's time.
    void (*draw)(struct orl_gpu *gpu, const void *state, const struct orl_view *view,
                 const struct orl_render_params *params, bool normals, void *target,
                 struct surface *surface);
    // Its own colours where it shows in a target that was drawn, linear, 1 as weight, into `color`
    // (GL_RGBA32F); other pixels stay as they are. NULL: it has none.
    void (*color)(struct orl_gpu *gpu, const void *state, const struct orl_view *view,
                  const void *target, struct orl_tex *color);
};
extern const struct proxy_kind orl_proxy_splats; // splats.c

// A proxy of the scene, with a target for views and one for photographs.
struct proxy {
    const struct proxy_kind *kind;
    void *state, *view_target, *photo_target;
};

enum orl_result orl_proxy_create(struct orl_gpu *gpu, const struct orl_scene *scene,
                                 const struct proxy_kind *kind, struct proxy *proxy);
void orl_proxy_finish(struct orl_gpu *gpu, struct proxy *proxy);
// Draws into *target, one of the proxy's own, which is made as large as the view.
enum orl_result orl_proxy_draw(struct orl_gpu *gpu, const struct proxy *proxy,
                               const struct orl_view *view,
                               const struct orl_render_params *params, bool normals,
                               void **target, struct surface *surface);
// What a surface of this proxy with these parameters follows from: equal keys, equal surfaces.
uint64_t orl_proxy_key(const struct proxy *proxy, const struct orl_render_params *params);

#endif
