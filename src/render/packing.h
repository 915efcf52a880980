// Private to src/render: the parts of the photographs that show the subject, side by side in one
// texture (Li 2003, 5.3).
#ifndef ORL_RENDER_PACKING_H
#define ORL_RENDER_PACKING_H

#include "render/frame.h"
#include "shared/render_blocks.h"

// The part of a photograph that shows the proxy and some pixels around it, which may lie outside of
// the photograph: these repeat its border.
struct packed_region {
    int x, y, width, height; // pixels of the photograph; no width: the photograph does not show it
    int place;               // x of its left border in the packed texture
};

struct packing {
    struct orl_tex *color;         // an array of one layer, sRGB, mipmapped
    struct packed_region *regions; // owned, one per photograph of the scene
    int width, height;             // of all regions together
    uint64_t key;                  // of what is packed; 0: nothing
};

// Sets frame->packs if the frame asks for packed photographs and can be painted from them, and
// brings them to the device if they are not there. The frame's proxy must be up to date.
enum orl_result orl_packing_update(struct frame *frame);
void orl_packing_destroy(struct orl_gpu *gpu, struct packing **packing);
// Fills in where a photograph lies in the packed texture.
void orl_packing_describe(const struct packing *packing, size_t photo, struct photo_data *data);

#endif
