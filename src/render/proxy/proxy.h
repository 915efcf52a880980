// Private to src/render: the geometric proxy, which draws the scene's surfaces for any camera.
#ifndef ORL_RENDER_PROXY_H
#define ORL_RENDER_PROXY_H

#include "render/frame/frame.h"
#include "render/frame/method.h"

// A picture that receives the proxy's own colours (shaders/shared/pixel.glsl). Other pixels are
// left unchanged.
struct paint_into {
    struct orl_tex *picture; // GL_RGBA32F; GL_RGBA16F with `seeds`
    struct orl_tex *seeds;   // of a painter that finishes pixels: sums over 2x2 pixels, which are
                             // increased by the new colours; NULL: the pixels are blended ones
    bool only_unpainted;     // pixels with a sample keep it
};

// One kind of proxy. `state`: its data on the device; `target`: its textures for one picture size, in a struct that
// consists of the struct surface that is drawn and of other textures.
struct orl_proxy_kind {
    const char *name;
    size_t state_size;
    // Fills the state, zeros at first. max_bytes: of device memory that a proxy keeps to which can; 0: as it needs.
    // NULL: update does.
    enum orl_result (*init)(struct orl_gpu *gpu, const struct orl_scene *scene, size_t max_bytes, void *state);
    // Brings what depends on the frame's photographs and options up to date; *changed: the surfaces
    // are others now. NULL: nothing does.
    enum orl_result (*update)(const struct frame *frame, void *state, bool *changed);
    // Its vertices, which live as long as the state and the scene.
    void (*vertices)(const void *state, const struct orl_scene *scene, const float (**vertices)[3],
                     size_t *count);
    void (*finish)(struct orl_gpu *gpu, void *state); // also after a failure of init
    size_t target_size; // of the struct
    // Creates the other textures of a target, whose surface is made.
    enum orl_result (*make_target)(struct orl_gpu *gpu, const void *state, void *target);
    // Brings the data that `view` shows to the device. NULL: it is there.
    enum orl_result (*bring)(const void *state, const struct orl_view *view);
    // Draws the surface that `view` sees. Without `normals` the normal is left unchanged, which saves a tenth of a
    // software renderer's time.
    void (*draw)(struct orl_gpu *gpu, const void *state, const struct orl_view *view,
                 const struct orl_render_params *params, bool normals, void *target);
    // Brings to the device what `color` reads. NULL: it is there.
    enum orl_result (*bring_colors)(struct orl_gpu *gpu, void *state);
    // Writes the proxy's own colours, linear with weight 1, where its primitives are visible in a
    // target that was drawn with normals. NULL: it has no colours.
    void (*color)(struct orl_gpu *gpu, const void *state, const struct orl_view *view,
                  const void *target, const struct paint_into *into);
};

// Extent of the proxy's vertices, world. A cloud has single points hundreds of times as far away as its
// subject, and the box of all of them has its centre anywhere.
struct proxy_extent {
    double low[3], high[3]; // along each axis from the 2nd to the 98th percentile; 0 without vertices
    double centroid[3];     // mean of the vertices in this box
};

// The values along each axis between which all vertices lie but a share of them at either end. Unchanged
// without vertices.
enum orl_result orl_vertices_range(const struct orl_log *log, const float (*vertices)[3],
                                   size_t vertex_count, double share, double low[3],
                                   double high[3]) ORL_CHECK_RESULT;

// What a photograph shows of the proxy (Princ 2014, 2.3.2).
struct photo_aspect {
    double direction[3]; // world, unit length: through the middle of the vertices' convex hull
    double area_px;      // of this hull in the photograph, pixels
};

// A proxy of the scene, with one target for views and one for photographs.
struct proxy {
    const struct orl_proxy_kind *kind;
    const float (*vertices)[3]; // world; owned by the state or the scene
    size_t vertex_count;
    struct proxy_extent extent;
    struct photo_aspect *aspects; // owned, one per photograph; NULL until princ.c needs them
    void *state, *view_target, *photo_target;
    void *coarse_target; // for coarse depth of photographs; NULL until progressive.c needs it
    uint64_t version; // how often it changed
};

// True if this option belongs to proxies of the kind.
bool orl_proxy_reads(const struct orl_option *option, const struct orl_proxy_kind *kind);
enum orl_result orl_proxy_create(struct orl_gpu *gpu, const struct orl_scene *scene,
                                 const struct orl_proxy_kind *kind, size_t max_bytes,
                                 struct proxy *proxy);
void orl_proxy_finish(struct orl_gpu *gpu, struct proxy *proxy);
// Frees what photographs' depth maps are drawn into, until the next one is drawn.
void orl_proxy_free_photo_target(struct orl_gpu *gpu, struct proxy *proxy);
// Brings the frame's proxy up to date, before its key is asked for.
enum orl_result orl_proxy_update(const struct frame *frame);
// Draws into *target, one of the proxy's own targets, which is resized to the view. Its textures are the surface's.
enum orl_result orl_proxy_draw(struct orl_gpu *gpu, const struct proxy *proxy,
                               const struct orl_view *view,
                               const struct orl_render_params *params, bool normals,
                               void **target, struct surface *surface);
// Writes the colours of the proxy's kind, which has some, where the view's surface is visible.
enum orl_result orl_proxy_color(const struct frame *frame,
                                const struct paint_into *into) ORL_CHECK_RESULT;
// A hash of everything that determines a surface of this proxy. Equal keys mean equal surfaces.
uint64_t orl_proxy_key(const struct proxy *proxy, const struct orl_render_params *params);

#endif
