// Private to src/walk: the files that the server sends, all of them from memory.
#ifndef ORL_WALK_CONTENT_INTERNAL_H
#define ORL_WALK_CONTENT_INTERNAL_H

#include <jansson.h>

#include "eval/choice.h"
#include "oriel/names.h"
#include "oriel/progress.h"

// A file of the published site.
struct site_file {
    uint8_t *data; // owned
    size_t size;
};

struct content {
    const struct orl_log *log;
    const struct orl_scene *scene;
    const char *title;      // that was asked for; NULL: none
    bool edits;             // clients may change the settings
    const struct orl_choice *choice; // method and options of a client that has chosen none
    json_t *settings;       // owned: settings.h
    char *index, *manifest; // owned
    size_t *photos;         // owned: index in the scene for each of the page's photographs
    size_t photo_count;
    // The data of the published site, for pages that draw by themselves; empty until a client asks for it, then it does not
    // change.
    struct orl_names site_paths; // relative to the site
    struct site_file *site;      // owned: one for each path
};

struct content_file {
    const char *type; // MIME
    uint8_t *data;    // released with free(): what it is a copy of may change while it is sent
    size_t size;
};

// title: NULL to take that of the settings. edits: clients may change the settings and choose
// methods. choice: must outlive the content.
enum orl_result orl_content_init(const struct orl_log *log, const struct orl_scene *scene,
                                 const char *title, bool edits, const struct orl_choice *choice,
                                 struct content *content) ORL_CHECK_RESULT;
// Saves settings from a client with the scene, and shows them from now on. ORL_ERR_FORMAT: they are
// not valid, and nothing has changed.
enum orl_result orl_content_change(struct content *content, json_t *settings) ORL_CHECK_RESULT;
// Publishes the scene into a private folder for temporary files, and keeps its data: manifest, shaders, points, photographs and
// their depth. The folder is gone when this returns. scene: the content's.
enum orl_result orl_content_publish(struct content *content, struct orl_gpu *gpu, struct orl_scene *scene, bool radiance,
                                    const struct orl_progress *progress) ORL_CHECK_RESULT;
void orl_content_finish(struct content *content);
// Is this the path of a file of the page, which tells nothing of the scene but its title?
bool orl_content_is_page(const char *path);
// `path` as in a request, starting with its slash. ORL_ERR_NOT_FOUND, not logged: no such file.
enum orl_result orl_content_find(const struct content *content, const char *path,
                             struct content_file *file) ORL_CHECK_RESULT;

#endif
