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
// The views as DIR/00000.EXTENSION and on, by their index; the folder is made if need be.
enum orl_result orl_sequence_write_dir(const struct orl_log *log, const struct orl_sequence *s,
                                       const char *dir, const char *extension) ORL_CHECK_RESULT;
// All views as a video. Frames are kept in FILE.frames meanwhile, which must not be there.
enum orl_result orl_sequence_write_video(const struct orl_log *log, const struct orl_sequence *s,
                                         const char *file, double fps) ORL_CHECK_RESULT;

#endif
