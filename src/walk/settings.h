// Private to src/walk: SCENE/walk.json, what its maker says about a walk (docs/reference/files.md):
// title, attribution, start view, allowed modes, annotations.
#ifndef ORL_WALK_SETTINGS_H
#define ORL_WALK_SETTINGS_H

#include <jansson.h>

#include "oriel/scene.h"

// What settings hold at most, and their bytes as JSON: with a backslash before every character of a text.
enum {
    WALK_TITLE_MAX = 500,
    WALK_TEXT_MAX = 4000,
    WALK_NOTES_MAX = 200,
    WALK_TOUR_VIEWS_MAX = 2000,
    WALK_VIEW_BYTES = 600,
    WALK_SETTINGS_MAX = 4 * WALK_TITLE_MAX + WALK_NOTES_MAX * (2 * (WALK_TITLE_MAX + WALK_TEXT_MAX) + WALK_VIEW_BYTES) +
                        WALK_TOUR_VIEWS_MAX * WALK_VIEW_BYTES,
};

// Something in the scene that a walk reads or writes by its name. ORL_ERR_DATA: it is a symbolic link out of the scene,
// which its maker may have put there.
enum orl_result orl_walk_check_inside(const struct orl_log *log, const struct orl_scene *scene,
                                      const char *path) ORL_CHECK_RESULT;
// Checks settings that came from `where`, a file or a client. ORL_ERR_FORMAT, logged: what is wrong.
enum orl_result orl_walk_settings_check(const struct orl_log *log, const char *where,
                                        const json_t *settings) ORL_CHECK_RESULT;
// Reads the scene's settings, released with json_decref even after an error; an empty object if it has none.
enum orl_result orl_walk_settings_read(const struct orl_log *log, const struct orl_scene *scene,
                                       json_t **settings) ORL_CHECK_RESULT;
// Writes settings that have been checked, atomically.
enum orl_result orl_walk_settings_write(const struct orl_log *log, const struct orl_scene *scene,
                                        const json_t *settings) ORL_CHECK_RESULT;
// The start view with this camera's size and principal point. Returns false, and leaves the view as
// it is, if none is set or such a camera cannot have it.
bool orl_walk_settings_start(const json_t *settings, const struct orl_camera *camera,
                             struct orl_view *view);

#endif
