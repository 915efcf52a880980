// Photographs out of a video: the sharpest frame of each stretch of time, through ffmpeg.
#ifndef ORL_PREPROCESS_VIDEO_FRAMES_H
#define ORL_PREPROCESS_VIDEO_FRAMES_H

#include "preprocess/job/job.h"

// Takes frames of the video at `path` by the job's `fps` or `frames`. Frames that show the same
// picture as the one before are left out, so that a camera that stands still gives one. *dir, owned
// by the caller, is the folder that holds them: *names, in order of time. They stay for later runs.
// ORL_ERR_EXTERNAL, ORL_ERR_DATA: ffmpeg finds no frames. ORL_ERR_NOT_FOUND: there is no ffmpeg.
enum orl_result orl_frames_take(struct orl_job *job, const char *path, char **dir,
                                struct orl_names *names) ORL_CHECK_RESULT;

// The index of the sharpest of each `stretch` frames, among the first two thirds of them, so that
// no two are neighbours. blur: per frame, more is worse. Returns how many; `chosen` has room for
// count / stretch + 1.
size_t orl_frames_choose(const float *blur, size_t count, size_t stretch, size_t *chosen);

#endif
