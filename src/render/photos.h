// Private to src/render: photographs and their depth maps on the device, within a budget.
#ifndef ORL_RENDER_PHOTOS_H
#define ORL_RENDER_PHOTOS_H

#include "render/frame.h"
#include "oriel/radiance.h"

// Where a photograph is stored. All photographs share two texture arrays. A slot is one layer of
// both, and holds the photograph in its top left corner.
struct photo_state {
    bool usable;
    int slot; // layer of the arrays; -1: not resident
    bool has_depth;
    uint64_t depth_key; // orl_proxy_key with which its depth was drawn
    unsigned last_use;
    float white;  // of radiance: scale of its colours on the device
    bool rounded; // its values were rounded to 8 bits
    struct orl_camera color_camera, depth_camera; // at the resident size, pixels of level 0
};

struct photos {
    const struct orl_scene *scene;
    struct photo_state *states; // per photograph of the scene
    struct orl_tex *color;      // mipmapped: sRGB, or radiance * confidence, confidence
    GLenum format;              // of color
    struct orl_tex *loading;    // a photograph before compression; NULL: no compression
    struct orl_tex *depth;      // z; < 0: estimated in a hole, 0: none
    int slot_count, divide;     // divide: photographs are loaded at 1/divide of their size
    unsigned clock;
    bool radiance;              // see struct orl_renderer_params
    struct orl_sensor sensor;
    float ev_darkest, ev_brightest; // of the photographs in use
};

// textures.c: the texture format for `textures`, if the device and the kind of pixels allow it.
GLenum orl_textures_format(const struct orl_gpu *gpu, bool radiance, enum orl_textures textures);
enum orl_result orl_photos_init(struct orl_gpu *gpu, const struct orl_scene *scene,
                                const struct orl_renderer_params *params, size_t budget_bytes,
                                struct photos *photos);
void orl_photos_finish(struct orl_gpu *gpu, struct photos *photos);
// Makes a photograph's colour resident, and its depth if asked for, drawn by the frame's proxy with
// the frame's parameters. Evicts the least recently used photograph if all slots are taken.
enum orl_result orl_photos_require(const struct frame *frame, size_t photo, bool depth);

#endif
