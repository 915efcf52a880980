// Private to src/walk: what the server answers requests for files with, all of it from memory.
#ifndef ORL_WALK_CONTENT_INTERNAL_H
#define ORL_WALK_CONTENT_INTERNAL_H

#include "oriel/log.h"
#include "oriel/scene.h"

struct content {
    const struct orl_log *log;
    const struct orl_scene *scene;
    char *index, *manifest; // owned
    size_t *photos;         // owned: of the scene, by the page's number
    size_t photo_count;
};

struct content_file {
    const char *type;      // MIME
    const uint8_t *data;
    size_t size;
    uint8_t *owned;        // to be released with free(), may be NULL
    bool is_private;       // of the scene, not of the page alone
};

enum orl_result orl_content_init(const struct orl_log *log, const struct orl_scene *scene,
                             const char *title, struct content *content) ORL_CHECK_RESULT;
void orl_content_finish(struct content *content);
// `path` as of a request, from its slash on. ORL_ERR_NOT_FOUND, not logged: there is no such file.
enum orl_result orl_content_find(const struct content *content, const char *path,
                             struct content_file *file) ORL_CHECK_RESULT;

#endif
