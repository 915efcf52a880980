// Private to src/walk: the pictures that fixed cameras write into folders, paired to time steps.
#ifndef ORL_WALK_LIVE_CAMERAS_H
#define ORL_WALK_LIVE_CAMERAS_H

#include "scene/silhouette.h"

enum { ORL_LIVE_INTERVALS = 15 };

struct orl_live_picture {
    int64_t number; // its time step, or its time stamp of any unit
    char *path;     // owned
};

struct orl_live_camera {
    char *name, *folder;              // owned: what it is called in messages; where its pictures are
    size_t photo;                     // of the scene: its own
    struct orl_background background; // owned: what it shows of the empty place
    // Pictures that are newer than `last`, by their numbers.
    struct orl_live_picture *pictures;
    size_t count, capacity;
    size_t decided;                          // how many of them have been decided upon
    const struct orl_live_picture *oldest;   // of the others, for the time step that is looked at; NULL: none
    int64_t last, newest;                    // decided upon last; ever seen; -1: none
    int64_t intervals[ORL_LIVE_INTERVALS];   // between its latest pictures
    size_t interval_count;                   // ever
    double waits_since_s;                    // others have pictures that wait for it; 0: none
    bool is_late;
    size_t missing, late;                    // pictures that it lacks and others have; long waits for it
};

struct orl_live_cameras {
    const struct orl_log *log;
    struct orl_live_camera *cameras;
    size_t count, capacity;
    bool removes; // pictures that have been decided upon
};

// Adds a camera to a struct that was zero but for its log. Folders may appear later. A picture's number is the one that
// ends its name before the ending; names that begin with a dot are of files that are still being written.
enum orl_result orl_live_cameras_add(struct orl_live_cameras *cameras, const char *name,
                                     const char *folder) ORL_CHECK_RESULT;
void orl_live_cameras_finish(struct orl_live_cameras *cameras);

// Looks for new pictures. Those that are less than half an interval between a camera's pictures apart
// are a time step; numbers of time steps are so when they are equal. Gives the newest time step that
// all cameras have, a path of each to be freed; older ones are left out. paths[0] NULL: there is none.
// Says which camera lacks a picture that others have, and which one keeps others waiting.
enum orl_result orl_live_cameras_look(struct orl_live_cameras *cameras, double now_s,
                                      char **paths) ORL_CHECK_RESULT;

#endif
