// Private to src/walk: named pipes of cameras, read into folders of pictures.
#ifndef ORL_WALK_LIVE_PIPES_H
#define ORL_WALK_LIVE_PIPES_H

#include "oriel/log.h"

struct orl_live_pipes;

// Starts a thread that writes the PNG and JPEG files that follow one another in each pipe to its
// folder, FOLDER/NUMBER.picture. NUMBER is a time stamp: the milliseconds since the start at which the
// picture's first bytes came. Writers may come and go. The names must outlive the thread.
enum orl_result orl_live_pipes_start(const struct orl_log *log, const char *const *pipes,
                                     const char *const *folders, size_t count,
                                     struct orl_live_pipes **pipes_out) ORL_CHECK_RESULT;
void orl_live_pipes_stop(struct orl_live_pipes **pipes);

#endif
