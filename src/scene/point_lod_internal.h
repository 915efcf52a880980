// Private to point_lod*.c: the file's fixed parts, little endian.
#ifndef ORL_SCENE_POINT_LOD_INTERNAL_H
#define ORL_SCENE_POINT_LOD_INTERNAL_H

#include <assert.h>

#include "scene/point_blocks.h"
#include "scene/point_lod.h"

#define LOD_MAGIC "ORLLOD5\n"
enum { LOD_PAGES_AT = 4096 };

struct lod_header {
    char magic[8];
    uint32_t block_points, page_blocks, children, level_count;
    uint64_t points, page_count;
    uint64_t table_at, table_hash; // of page_count entries; XXH3
    struct orl_lod_level levels[ORL_LOD_LEVELS_MAX];
};

// Decodes point i of block b behind the cloud's points, without counting it. False: there is none.
bool orl_lod_decode(const struct orl_lod_data *page, size_t b, size_t i, struct orl_points *points);

static_assert(sizeof(struct orl_lod_data) == 93184, "a page has no padding");
static_assert(sizeof(struct orl_lod_page) == 40, "an entry of the table has no padding");
static_assert(sizeof(struct lod_header) <= LOD_PAGES_AT, "the header lies before the pages");

#endif
