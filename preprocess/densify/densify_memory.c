// Device memory of the densifier: what one photograph needs, and which settings are reduced when
// memory is short.
#include "preprocess/densify/densify_internal.h"

enum {
    SOURCES_MIN = 4, // fewer sources lose more than halving the size does
    SIDE_MIN = 16, // of any photograph, so that it has as many levels as the others
};

// Drivers refuse larger textures, or are slow with them.
static const uint64_t TEXTURE_MAX = (uint64_t)1 << 30;
// Every device of OpenGL 4.5 has textures with such sides. Those of larger ones are not used: a photograph's maps must
// be of one size on all devices, as those of parts are made on several.
enum { TEXTURE_SIDE_MAX = 16384 };

static uint64_t pixels(int width, int height, int padding)
{
    return (uint64_t)(width + 2 * padding) * (uint64_t)(height + 2 * padding);
}

int orl_densify_padding(const struct orl_densify_params *params)
{
    return 3 * params->window_radius + 2;
}

uint64_t orl_densify_bytes(const struct densify_need *need, int sources, int shrink)
{
    int width = need->width >> shrink, height = need->height >> shrink;
    uint64_t own = pixels(width, height, 0), padded = pixels(width, height, need->padding);
    // Bytes per pixel: luma and mask 2, planes 16, costs 4, costs of views 16; each source 4 (a
    // quad).
    uint64_t level = 38 * own + 4 * (uint64_t)sources * padded;
    uint64_t coarser = 38 * pixels(width / 2, height / 2, 0) +
                       4 * (uint64_t)sources * pixels(width / 2, height / 2, need->padding);
    // The coarser level is released before the maps (16 bytes) are allocated.
    uint64_t matching = level + (coarser > 16 * own ? coarser : 16 * own);
    // First and finished maps 32 bytes per pixel, the sources' depths 4 each.
    uint64_t agreeing = level + 32 * own + 4 * (uint64_t)sources * own;
    return need->geometric && agreeing > matching ? agreeing : matching;
}

bool orl_densify_fit(const struct densify_need *need, int sources, uint64_t max_bytes,
                     struct densify_budget *budget)
{
    int fewest = sources < SOURCES_MIN ? sources : SOURCES_MIN;
    for (int shrink = 0; shrink == 0 || need->min_side >> shrink >= SIDE_MIN; shrink++)
        for (int count = sources; count >= fewest; count--) {
            int width = need->width >> shrink, height = need->height >> shrink;
            int side = (width > height ? width : height) + 2 * need->padding;
            uint64_t layer = 4 * pixels(width, height, need->padding);
            *budget = (struct densify_budget){.sources = count, .shrink = shrink,
                                              .bytes = orl_densify_bytes(need, count, shrink)};
            if ((!max_bytes || budget->bytes <= max_bytes) && side <= TEXTURE_SIDE_MAX &&
                layer * (uint64_t)count <= TEXTURE_MAX)
                return true;
        }
    return false;
}
