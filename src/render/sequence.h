// Views drawn into files, one after another.
#ifndef ORL_RENDER_SEQUENCE_H
#define ORL_RENDER_SEQUENCE_H

#include "oriel/progress.h"
#include "render/output.h"

struct orl_sequence {
    const struct orl_view *views;
    size_t count;
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
// All views as DIR/00000.EXTENSION and on; the folder is made if need be.
enum orl_result orl_sequence_write_dir(const struct orl_log *log, const struct orl_sequence *s,
                                       const char *dir, const char *extension) ORL_CHECK_RESULT;
// Airieau 2012, section 4: what each photograph of one series would have been if all the range of
// the scene fitted into it: the views of these photographs, as DIR/NAME.exr. s->views is not read.
enum orl_result orl_sequence_write_series(const struct orl_log *log, const struct orl_sequence *s,
                                          const struct orl_scene *scene, int series,
                                          const char *dir) ORL_CHECK_RESULT;
// All views as a video. Frames are kept in FILE.frames meanwhile, which must not be there.
enum orl_result orl_sequence_write_video(const struct orl_log *log, const struct orl_sequence *s,
                                         const char *file, double fps) ORL_CHECK_RESULT;

#endif
