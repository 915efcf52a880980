// Private to src/walk: a site while it is written.
#ifndef ORL_WALK_INTERNAL_H
#define ORL_WALK_INTERNAL_H

#include <jansson.h>

#include "walk/publish.h"

struct site {
    const struct orl_log *log;
    const struct orl_scene *scene;
    const struct orl_publish_params *params;
    struct orl_gpu *gpu;
    struct orl_renderer *renderer;
    struct orl_render_params render; // of method oriel, as tuned for the scene
    char *dir;                       // that is written into, owned
    size_t start;                    // photograph that the walk begins at
    struct orl_publish_report *report;
};

// A file of the site as its manifest names it: {"file", "bytes"}. NULL, logged, when it is not
// there. `path` is relative to the site.
json_t *orl_site_file(struct site *site, const char *path);
enum orl_result orl_site_write(struct site *site, const char *path, const void *data, size_t size);
// Released with free(); NULL, logged, when memory runs out.
char *orl_site_path(const struct site *site, const char *path);

// --- points (cells.c) ---

// Writes points/ and sets *points to the manifest's part about it.
enum orl_result orl_site_points(struct site *site, json_t **points);

// --- photographs (site_photos.c) ---

// Writes photos/, depth/, thumbs/; *photos: the manifest's array.
enum orl_result orl_site_photos(struct site *site, json_t **photos);
// Writes poster.jpg: the start view by the renderer itself.
enum orl_result orl_site_poster(struct site *site);

// --- manifest (site_manifest.c) ---

// Takes over both parts.
enum orl_result orl_site_manifest(struct site *site, json_t *points, json_t *photos);

// --- page (page.c) ---

// Writes the page and its modules; their bytes are needed before anything shows.
enum orl_result orl_site_page(struct site *site);
// The finished site as one HTML file.
enum orl_result orl_site_pack(struct site *site, const char *file);

#endif
