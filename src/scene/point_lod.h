// Private: SCENE/points.lod, the points of a cloud that is larger than memory, with levels of
// detail. Level 0 has all points, in blocks (point_blocks.h) along the Morton curve. A block of the
// next level has the first eighth of each of eight blocks in a row, with radii that cover what is
// left out. A page is what is read at once: ORL_LOD_BLOCKS blocks in a row. So the pages are a tree,
// with up to eight children each.
// docs/reference/files.md describes the file.
#ifndef ORL_SCENE_POINT_LOD_H
#define ORL_SCENE_POINT_LOD_H

#include "oriel/camera.h"
#include "oriel/points.h"
#include "oriel/progress.h"
#include "scene/radius_limits.h"
#include "shared/render_blocks.h"

#define ORL_LOD_NAME "points.lod"

enum {
    ORL_LOD_BLOCKS = 64,   // of a page
    ORL_LOD_CHILDREN = 8,  // of a block, and so of a page
    ORL_LOD_LEVELS_MAX = 12
};

// A page as it is stored.
struct orl_lod_data {
    float blocks[ORL_LOD_BLOCKS][ORL_BLOCK_VEC4S][4]; // all 0: no block
    uint32_t geometry[ORL_LOD_BLOCKS][ORL_BLOCK_POINTS][2]; // of struct point_code
    uint8_t colors[ORL_LOD_BLOCKS][ORL_BLOCK_POINTS][3];
};

// What is known of a page without reading it.
struct orl_lod_page {
    float middle[3], extent[3]; // of its bounds, world: centre and half size
    float radius;               // of its points, root of the mean square
    uint32_t count;             // points
    uint64_t hash;              // of the page; XXH3
};

struct orl_lod_level {
    uint32_t first, count; // pages
};

struct orl_lod {
    const struct orl_log *log;
    char *path; // owned
    int fd;
    uint64_t points; // of level 0
    int level_count;
    struct orl_lod_level levels[ORL_LOD_LEVELS_MAX]; // the last has one page
    struct orl_lod_page *pages;                      // owned; of all levels
    size_t page_count;
};

// Opens the file and reads its table of pages. ORL_ERR_FORMAT: it is damaged.
enum orl_result orl_lod_open(const struct orl_log *log, const char *path,
                             struct orl_lod **lod) ORL_CHECK_RESULT;
void orl_lod_close(struct orl_lod **lod);
// Reads a page and checks it by its hash.
enum orl_result orl_lod_read(const struct orl_lod *lod, size_t page,
                             struct orl_lod_data *data) ORL_CHECK_RESULT;
// Reads all pages.
enum orl_result orl_lod_check(const struct orl_log *log, const char *path) ORL_CHECK_RESULT;
// The level of a page, and its children: *count pages from *first on; none of level 0.
int orl_lod_children(const struct orl_lod *lod, size_t page, size_t *first, size_t *count);
// The finest level of at most `most` points as a cloud, which stands for all points where a few are
// enough; the coarsest level if it has more.
enum orl_result orl_lod_sample(const struct orl_lod *lod, size_t most,
                               struct orl_points *points) ORL_CHECK_RESULT;

struct orl_lod_params {
    size_t max_bytes;             // of memory, about; 0: half of what is free
    struct orl_radii_params radii; // where no point has a radius
    const struct orl_view *views; // of the photographs; used where points have no radius
    size_t view_count;
};
#define ORL_LOD_DEFAULTS .radii = {ORL_RADII_DEFAULTS}

// Writes the file from a binary PLY, which is sorted on disk beside it. Where no point has a radius,
// radii and missing normals are found and limited as orl_points_find_radii does with the whole cloud
// in memory. Otherwise points without a radius are dropped. Disk that is needed is told first.
enum orl_result orl_lod_write(const struct orl_log *log, const struct orl_progress *progress,
                              const struct orl_lod_params *params, const char *ply,
                              const char *path) ORL_CHECK_RESULT;
// A cloud of more points than this is not held in memory. max_bytes: as in orl_lod_params.
uint64_t orl_lod_most_in_memory(size_t max_bytes);

// The cloud of a scene's folder, for what needs no more than `most` points of it: points.ply, or
// where there is points.lod the finest level that has no more.
enum orl_result orl_lod_read_cloud(const struct orl_log *log, const char *dir, size_t most,
                                   struct orl_points *points) ORL_CHECK_RESULT;

#endif
