// Private to src/walk: the data of the published site in memory, for pages that draw by themselves.
#ifndef ORL_WALK_SITE_TABLE_H
#define ORL_WALK_SITE_TABLE_H

#include "oriel/gpu.h"
#include "oriel/progress.h"
#include "oriel/scene.h"

struct site_file {
    char *path;    // owned: relative to the site
    uint8_t *data; // owned
    size_t size;
};
struct site_table {
    struct site_file *files; // owned
    size_t count, capacity;
};

// Publishes the scene into a private folder for temporary files, and keeps its data: manifest,
// shaders, points, photographs and their depth. The folder is gone when this returns.
enum orl_result orl_site_table_make(struct orl_gpu *gpu, struct orl_scene *scene, bool radiance,
                                    const struct orl_progress *progress,
                                    struct site_table *table) ORL_CHECK_RESULT;
void orl_site_table_finish(struct site_table *table);
// NULL: the site has no such file.
const struct site_file *orl_site_table_find(const struct site_table *table, const char *path);

#endif
