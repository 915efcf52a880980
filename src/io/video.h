// Frames to video and back, through ffmpeg.
#ifndef ORL_IO_VIDEO_H
#define ORL_IO_VIDEO_H

#include "oriel/log.h"
#include "oriel/progress.h"

// Encodes FRAMES_DIR/%05d.png, from 00000.png on, to `path` (.mp4, H.264), which is written
// atomically. ORL_ERR_NOT_FOUND when ffmpeg is not installed.
enum orl_result orl_video_encode(const struct orl_log *log, const struct orl_progress *progress,
                                 const char *frames_dir, double fps,
                                 const char *path) ORL_CHECK_RESULT;

// Frames of a clip: `first`, first + step, ..., at most `count` of them (0: to the clip's end).
struct orl_frame_range {
    int first, count, step; // >= 0; >= 0; >= 1
};
// Decodes the frames in `range` to FRAMES_DIR/%05d.ppm, from 00000.ppm on, pixels as stored.
// FRAMES_DIR must exist. ORL_ERR_DATA: the clip has none of these frames. ORL_ERR_NOT_FOUND when
// ffmpeg is not installed.
enum orl_result orl_video_decode(const struct orl_log *log, const struct orl_progress *progress,
                                 const char *path, const struct orl_frame_range *range,
                                 const char *frames_dir) ORL_CHECK_RESULT;

#endif
