// Frames to video through ffmpeg.
#ifndef ORL_IO_VIDEO_H
#define ORL_IO_VIDEO_H

#include "core/log.h"
#include "core/progress.h"

// Encodes FRAMES_DIR/%05d.png, from 00000.png on, to `path` (.mp4, H.264). Written whole
// or not at all. ORL_ERR_NOT_FOUND when ffmpeg is not installed.
enum orl_result orl_video_encode(const struct orl_log *log, const struct orl_progress *progress,
                                 const char *frames_dir, double fps,
                                 const char *path) ORL_CHECK_RESULT;

#endif
