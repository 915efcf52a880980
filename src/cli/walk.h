// oriel eval --walk: how steady methods are while the viewer moves.
#ifndef ORL_CLI_WALK_H
#define ORL_CLI_WALK_H

#include "core/file.h"
#include "core/progress.h"
#include "render/render.h"

struct walk_options {
    const char *json, *images;        // as of oriel eval; or NULL
    const struct orl_names *settings; // KEY=VALUE
    int frames, divide;
};
// Measures `count` methods and prints their table, or the JSON alone when that goes to
// stdout; `array`: the JSON is an array.
enum orl_result walk_run(struct orl_gpu *gpu, struct orl_renderer *renderer,
                         const struct orl_scene *scene, const struct orl_method *methods,
                         size_t count, bool array, const struct walk_options *options,
                         const struct orl_progress *progress) ORL_CHECK_RESULT;

#endif
