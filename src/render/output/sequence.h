// Views drawn into files, one after another.
#ifndef ORL_RENDER_SEQUENCE_H
#define ORL_RENDER_SEQUENCE_H

#include "oriel/progress.h"
#include "render/output/output.h"

struct orl_sequence {
    const struct orl_view *views;
    size_t first, count; // views first to count - 1 are drawn
    enum orl_result (*draw)(void *priv, const struct orl_view *view, struct orl_frame *frame);
    void *priv;
    const struct orl_frame_output *output;
    const char *step; // name for the progress report
    const struct orl_progress *progress;
};

// One view; the extension of `file` says how (output.h).
enum orl_result orl_sequence_write_view(const struct orl_log *log, const struct orl_sequence *s,
                                        const struct orl_view *view,
                                        const char *file) ORL_CHECK_RESULT;
// True for an .mp4 file.
bool orl_sequence_is_video(const char *out);
// ORL_ERR_ARGUMENT, logged: `out` is neither an .mp4 file nor a folder for frames, or it is a folder with
// something in it and `beside` is false, or layers are wanted of a video. ORL_ERR_NOT_FOUND: a video needs
// ffmpeg, which is not installed.
enum orl_result orl_sequence_check_out(const struct orl_log *log, const char *out, bool beside,
                                       bool layers) ORL_CHECK_RESULT;
// All views as a video, or as OUT/00000.EXTENSION and on, by their index; the folder is made if need be.
// Frames of a video are kept in OUT.frames meanwhile, which must not be there.
enum orl_result orl_sequence_write(const struct orl_log *log, const struct orl_sequence *s,
                                   const char *out, const char *extension, double fps) ORL_CHECK_RESULT;

#endif
