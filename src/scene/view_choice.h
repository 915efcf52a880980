// Selection of views: those of one photograph, one camera or a path.
#ifndef ORL_SCENE_VIEW_CHOICE_H
#define ORL_SCENE_VIEW_CHOICE_H

#include "core/file.h"
#include "oriel/path.h"

struct orl_view_choice {
    const char *at;     // a photograph's name; or
    const char *camera; // a file with one camera; or
    const char *path;   // a file with cameras, "photos": a path past all photographs, or "circle":
                        // a path around what they look at
    int frames;         // length of the paths "photos" and "circle"
    int width, height;  // picture size in pixels; 0 0: that of the cameras
};
// Makes the chosen path of at least one view. Errors name what is missing.
enum orl_result orl_views_choose(const struct orl_log *log, const struct orl_scene *scene,
                                 const struct orl_view_choice *choice,
                                 struct orl_path *path) ORL_CHECK_RESULT;
// One flag per photograph of the scene, true when it is named; released with free().
enum orl_result orl_photos_named(const struct orl_log *log, const struct orl_scene *scene,
                                 const struct orl_names *names, bool **named) ORL_CHECK_RESULT;

#endif
