// Private to point_lod*.c: the file's fixed parts, little endian.
#ifndef ORL_SCENE_POINT_LOD_INTERNAL_H
#define ORL_SCENE_POINT_LOD_INTERNAL_H

#include <assert.h>
#include <stdio.h>

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

// Fills pages with blocks in their order, and derives the coarser levels (point_lod_levels.c).
struct lod_levels;
// Pages of level 0 go to `file`, which stands at the first page; those of coarser levels wait in
// files beside `path`.
enum orl_result orl_lod_levels_begin(const struct orl_log *log, const char *path, FILE *file,
                                     struct lod_levels **levels) ORL_CHECK_RESULT;
enum orl_result orl_lod_levels_add(struct lod_levels *levels,
                                   const struct point_block *block) ORL_CHECK_RESULT;
// Appends the coarser levels and the table, and writes the header.
enum orl_result orl_lod_levels_end(struct lod_levels *levels) ORL_CHECK_RESULT;
void orl_lod_levels_destroy(struct lod_levels **levels);

static_assert(sizeof(struct orl_lod_data) == 93184, "a page has no padding");
static_assert(sizeof(struct orl_lod_page) == 40, "an entry of the table has no padding");
static_assert(sizeof(struct lod_header) <= LOD_PAGES_AT, "the header lies before the pages");

#endif
