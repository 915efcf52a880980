// Private to src/render: photographs and their depth maps on the device, within a budget.
#ifndef ORL_RENDER_PHOTOS_H
#define ORL_RENDER_PHOTOS_H

#include "render/frame.h"
#include "render/radiance.h"

// Where a photograph is kept. All photographs share two arrays: one layer is one slot, the
// photograph in its top left corner.
struct photo_state {
    bool usable;
    int slot; // -1: not resident
    bool has_depth;
    uint64_t depth_key; // orl_proxy_key that its depth was made with
    unsigned last_use;
    float white;  // of radiance: what its colours on the device are multiplied by
    bool rounded; // to 8 bits
    struct orl_camera color_camera, depth_camera; // as resident, in pixels of level 0
};

struct photos {
    const struct orl_scene *scene;
    struct photo_state *states; // per photograph of the scene
    struct orl_tex *color;      // mipmapped: sRGB, or radiance * trust and trust
    GLenum format;              // of color
    struct orl_tex *loading;    // a photograph before it is compressed; NULL: format is not
    struct orl_tex *depth;      // z; < 0: guessed in a hole, 0: none
    int slot_count, divide;     // photographs are loaded at 1/divide of their size
    unsigned clock;
    bool radiance;              // see struct orl_renderer_params
    struct orl_sensor sensor;
    float ev_darkest, ev_brightest; // of the photographs in use
};

// textures.c: the format that is asked for, if the device and the pixels allow it.
GLenum orl_textures_format(const struct orl_gpu *gpu, bool radiance, enum orl_textures textures);
enum orl_result orl_photos_init(struct orl_gpu *gpu, const struct orl_scene *scene,
                                const struct orl_renderer_params *params, size_t budget_bytes,
                                struct photos *photos);
void orl_photos_finish(struct orl_gpu *gpu, struct photos *photos);
// Makes colour resident, and depth if asked for, as the frame's proxy draws it for its parameters;
// evicts the least recently used when all slots are taken.
enum orl_result orl_photos_require(const struct frame *frame, size_t photo, bool depth);

#endif
