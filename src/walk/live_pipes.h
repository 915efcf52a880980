// Private to src/walk: named pipes of cameras, read into folders of pictures.
#ifndef ORL_WALK_LIVE_PIPES_H
#define ORL_WALK_LIVE_PIPES_H

#include "walk/live_cameras.h"

struct orl_live_pipes;

// Starts a thread that writes the PNG and JPEG files that follow one another in each camera's pipe, which is its name, to
// its folder, FOLDER/NUMBER.picture. NUMBER is a time stamp: the milliseconds since the start at which the
// picture's first bytes came. Writers may come and go. The cameras must outlive the thread.
// orl_live_pipes_stop is needed even after an error.
enum orl_result orl_live_pipes_start(const struct orl_live_cameras *cameras,
                                     struct orl_live_pipes **pipes) ORL_CHECK_RESULT;
void orl_live_pipes_stop(struct orl_live_pipes **pipes);

#endif
