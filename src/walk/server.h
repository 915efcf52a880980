// A scene on this machine, walked through in a browser. The renderer's frames go over a WebSocket.
#ifndef ORL_WALK_SERVER_H
#define ORL_WALK_SERVER_H

#include "eval/choice.h"
#include "oriel/progress.h"

struct orl_walk_params {
    const char *host;  // address to listen on; any other than 127.0.0.1 requires a token
    int port;          // 0: any free port
    const char *title; // title of the page; NULL: as the scene's settings say
    bool edits;        // clients may change the settings; on 127.0.0.1 they always may
    bool radiance;     // the renderer's
    const char *embed_in; // origins whose pages may frame the walk, with spaces between; NULL: none
    const char *live;     // where pictures come from (live.h); NULL: the scene is what it is
    const struct orl_choice *choice; // method and options of a client that has chosen none
    const struct orl_progress *progress; // the server stops when this is cancelled
    // Called with the address of the page once the server listens.
    void (*ready)(void *priv, const char *address);
    void *priv;
};

// Serves until it is cancelled, which returns ORL_OK. All files and messages come from memory: no
// path of a request reaches the file system.
enum orl_result orl_walk_serve(struct orl_gpu *gpu, struct orl_renderer *renderer,
                               struct orl_scene *scene,
                               const struct orl_walk_params *params) ORL_CHECK_RESULT;

#endif
