// Private to src/walk: time steps as fixed, synchronised cameras deliver them (Li 2003, section 3).
#ifndef ORL_WALK_LIVE_H
#define ORL_WALK_LIVE_H

#include "oriel/scene.h"

struct live;

// Starts to watch DIR/NAME, NAME being the scene's photograph without its ending, for each camera that
// is not held out: a folder of pictures (live_cameras.h), or a pipe (live_pipes.h) if all are. The newest
// time step counts that all cameras have; older ones that were not shown by then are left out.
// Silhouettes are what differs from the scene's pictures of the empty place. ORL_ERR_DATA: the scene has
// no silhouettes or no such pictures. orl_live_stop is needed even after an error.
enum orl_result orl_live_start(const struct orl_log *log, struct orl_scene *scene, const char *dir,
                               struct live **live) ORL_CHECK_RESULT;
// Says what came and what was missing.
void orl_live_stop(struct live **live);
// Lets the scene have the newest time step, and returns its number; -1: none has come yet.
int orl_live_take(struct live *live);
// A frame of what was taken last is drawn.
void orl_live_drawn(struct live *live);

#endif
