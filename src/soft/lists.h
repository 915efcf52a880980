// Which splats each tile of a view shows, nearest first, and where each splat is listed.
#ifndef ORL_SOFT_LISTS_H
#define ORL_SOFT_LISTS_H

#include "oriel/log.h"
#include "shared/soft_blocks.h"

// Zero-initialised, it holds nothing. The memory is kept from one view to the next.
struct orl_soft_lists {
    int *listed;       // owned: of each tile the place in `listed` where its splats begin, the place behind the
                       // last one's, then the splats
    int *places;       // owned: of each splat the place in `places` where its entries begin, the place behind
                       // the last one's, then the entries: splats of `listed`, counted from its first splat
    size_t tiles;      // of the view
    size_t entries;    // splats in all lists
    size_t seen;       // splats in `order`, nearest first
    size_t listed_capacity, places_capacity, order_capacity;
    struct orl_soft_key { uint32_t depth; int splat; } *order, *spare; // owned
};

// Tiles of a picture of this size, in pixels.
size_t orl_soft_tiles(int width, int height);
// bounds: of each of `count` splats, as shaders/soft/project.comp leaves them. Equal depths keep the order of
// the splats. width, height: of the view, pixels.
enum orl_result orl_soft_lists_make(const struct orl_log *log, const uint32_t (*bounds)[ORL_SOFT_BOUND_WORDS],
                                    size_t count, int width, int height,
                                    struct orl_soft_lists *lists) ORL_CHECK_RESULT;
void orl_soft_lists_finish(struct orl_soft_lists *lists);

#endif
