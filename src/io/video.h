// Frames to video and back, through ffmpeg.
#ifndef ORL_IO_VIDEO_H
#define ORL_IO_VIDEO_H

#include "oriel/log.h"
#include "oriel/progress.h"

// True when the extension is that of a video.
bool orl_video_is(const char *path);

// A path as ffmpeg takes it, which reads 12:30.mp4 as a protocol and -a.mp4 as an option (ORL_PATH).
#define ORL_VIDEO_FILE(path) ORL_PATH("", "file:%s", path)
// The numbered pictures DIR/`numbers` (%05d.png) as ffmpeg takes them, which reads a '%' of DIR as a number, too. The
// caller frees it. NULL: no memory, logged.
char *orl_video_numbered(const struct orl_log *log, const char *dir, const char *numbers);

// What is needed to take frames out of a video.
struct orl_video {
    double seconds; // 0: not known
    // Filters of ffmpeg, each ends with a comma or is empty: to be used on all frames, and on those
    // that are taken, which become RGB frames of sRGB colours.
    char first[64], colours[512];
};
// Reads the tags of the first video stream that is no album picture. The filters deinterlace, apply
// the stream's matrix and range, bring HDR (HLG, PQ) and wide primaries to sRGB, and with `square`
// stretch frames to square pixels. Diffuse white of HDR (203 cd/m2, ITU-R BT.2408) becomes white, and
// what is brighter is clipped, which it says; so frames stay comparable with each other.
// ORL_ERR_UNSUPPORTED, with the reason: panoramas, colours that ffmpeg cannot convert.
enum orl_result orl_video_inspect(const struct orl_log *log, const struct orl_progress *progress,
                                  const char *path, bool square,
                                  struct orl_video *video) ORL_CHECK_RESULT;

// ORL_ERR_NOT_FOUND, logged: ffmpeg, which orl_video_encode needs to make `path`, is not installed.
enum orl_result orl_video_can_encode(const struct orl_log *log, const char *path) ORL_CHECK_RESULT;
// Encodes FRAMES_DIR/%05d.png, from 00000.png on, to `path` (.mp4, H.264, tagged as BT.709 with the
// curve of sRGB), which is written atomically. ORL_ERR_NOT_FOUND when ffmpeg is not installed.
enum orl_result orl_video_encode(const struct orl_log *log, const struct orl_progress *progress,
                                 const char *frames_dir, double fps,
                                 const char *path) ORL_CHECK_RESULT;

// Frames of a clip: `first`, first + step, ..., at most `count` of them (0: to the clip's end).
struct orl_frame_range {
    int first, count, step; // >= 0; >= 0; >= 1
};
// Decodes the frames in `range` to FRAMES_DIR/%05d.ppm, from 00000.ppm on, as orl_video_inspect says;
// not turned, pixels of the stored aspect.
// FRAMES_DIR must exist. ORL_ERR_DATA: the clip has none of these frames. ORL_ERR_NOT_FOUND when
// ffmpeg is not installed.
enum orl_result orl_video_decode(const struct orl_log *log, const struct orl_progress *progress,
                                 const char *path, const struct orl_frame_range *range,
                                 const char *frames_dir) ORL_CHECK_RESULT;

#endif
