// Private to src/walk: paths that a client has the server render, into SCENE/renders.
#ifndef ORL_WALK_RENDERING_H
#define ORL_WALK_RENDERING_H

#include <jansson.h>

#include "oriel/progress.h"
#include "oriel/render.h"

struct walk_rendering {
    const struct orl_log *log;
    const struct orl_scene *scene;
    struct orl_renderer *renderer;
    const struct orl_render_params *render;
    const struct orl_progress *progress;
    // Called before each frame, and once with done == total. file: what is written.
    void (*report)(void *priv, size_t done, size_t total, const char *file);
    void *priv;
};

// Is this a message {"render": keyframes, "format": "mp4" | "png" | "exr"}, with "ev" and "tone" as
// of frames, which EXR files do without?
bool orl_walk_rendering_asked(const json_t *message);
// Renders what such a message asks for into files of the next free number: NNN.path.json, the keyframes, and NNN.mp4 or a
// folder NNN of pictures. ORL_ERR_FORMAT: the path is not valid, and nothing is left of it.
enum orl_result orl_walk_rendering_run(const struct walk_rendering *rendering,
                                       const json_t *message) ORL_CHECK_RESULT;

#endif
