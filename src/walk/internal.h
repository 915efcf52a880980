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

// What the manifests of a site and of a server have in common.
json_t *orl_walk_manifest(const struct orl_scene *scene, const char *title, size_t start);
json_t *orl_walk_photo(const struct orl_photo *photo, const struct orl_camera *camera);
// The training photograph that is nearest to all others; ORL_ERR_DATA: there is none.
enum orl_result orl_walk_start(const struct orl_log *log, const struct orl_scene *scene,
                               size_t *start);
// The folder's name, without what stands before it and a slash after it; released with free().
char *orl_walk_title(const struct orl_log *log, const struct orl_scene *scene);

// --- page (page.c) ---

// Writes the page and its modules; their bytes are needed before anything shows.
enum orl_result orl_site_page(struct site *site);
// index.html, to be released with free(); NULL, logged, on an error. poster: its file, "": none.
char *orl_walk_index(const struct orl_log *log, const char *title, const char *poster);
// The finished site as one HTML file.
enum orl_result orl_site_pack(struct site *site, const char *file);

// --- the server's frames (frames.c) ---

enum walk_layer { WALK_COLOR, WALK_DEPTH, WALK_NORMAL, WALK_COVERAGE, WALK_POINTS, WALK_LAYERS };

// What a client asks for.
struct walk_request {
    uint32_t number; // its own, to know the answer by
    struct orl_view view;
    enum walk_layer layer;
    int quality; // of JPEG
};
// From a message. False: it is none that this server answers.
bool orl_walk_request_read(const char *text, size_t size, struct walk_request *request);

enum { WALK_FRAME_HEADER = 16 }; // four 32-bit words: number, microseconds, width, height

struct walk_renderer {
    const struct orl_log *log;
    struct orl_renderer *renderer;
    const struct orl_render_params *render;
    float typical; // depth of the scene
};
// An answer, with `before` bytes of room in front of its header; released with free().
enum orl_result orl_walk_frame(const struct walk_renderer *walk, const struct walk_request *request,
                               size_t before, uint8_t **data, size_t *size);

#endif
