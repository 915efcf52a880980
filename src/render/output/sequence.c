#include "render/output/sequence.h"

#include "core/file.h"
#include "io/video.h"

enum orl_result orl_sequence_write_view(const struct orl_log *log, const struct orl_sequence *s,
                                        const struct orl_view *view, const char *file)
{
    struct orl_frame frame = {0};
    enum orl_result result = s->draw(s->priv, view, &frame);
    ORL_THEN(result, orl_frame_write(log, file, view, &frame, s->output));
    orl_frame_finish(&frame);
    return result;
}

enum orl_result orl_sequence_write_dir(const struct orl_log *log, const struct orl_sequence *s,
                                       const char *dir, const char *extension)
{
    enum orl_result result = orl_dir_make(log, dir);
    for (size_t i = s->first; result == ORL_OK && i < s->count; i++) {
        if (orl_progress_cancelled(s->progress))
            return ORL_ERR_CANCELLED;
        result = orl_sequence_write_view(log, s, &s->views[i], ORL_PATH(dir, "%05zu.%s", i, extension));
        orl_progress_report(s->progress, s->step, (double)(i + 1 - s->first),
                            (double)(s->count - s->first), NULL);
    }
    return result;
}

enum orl_result orl_sequence_write_video(const struct orl_log *log, const struct orl_sequence *s,
                                         const char *file, double fps)
{
    const char *dir = ORL_PATH("", "%s.frames", file);
    if (orl_path_is_dir(dir))
        return orl_fail(log, ORL_ERR_ARGUMENT,
                        "%s.frames is in the way: frames are kept there meanwhile", file);
    enum orl_result result = orl_sequence_write_dir(log, s, dir, "png");
    ORL_THEN(result, orl_video_encode(log, s->progress, dir, fps, file));
    enum orl_result removed = orl_dir_remove(log, dir);
    return result != ORL_OK ? result : removed;
}
