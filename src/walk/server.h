// A scene on this machine, walked through in a browser: frames of the renderer over a WebSocket.
#ifndef ORL_WALK_SERVER_H
#define ORL_WALK_SERVER_H

#include "oriel/progress.h"
#include "oriel/render.h"

struct orl_walk_params {
    const char *host;  // address to listen on; any but 127.0.0.1 asks for a token
    int port;          // 0: any that is free
    const char *title; // of the page
    const struct orl_render_params *render;
    const struct orl_progress *progress; // the server stops once it is cancelled
    // Called once the server listens, with the address of the page.
    void (*ready)(void *priv, const char *address);
    void *priv;
};

// Serves until it is cancelled, which is ORL_OK. The page's files and messages come from memory:
// no path of a request reaches the file system.
enum orl_result orl_walk_serve(struct orl_gpu *gpu, struct orl_renderer *renderer,
                               const struct orl_scene *scene,
                               const struct orl_walk_params *params) ORL_CHECK_RESULT;

#endif
