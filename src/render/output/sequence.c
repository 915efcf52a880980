#include "render/output/sequence.h"

#include "core/file.h"
#include "core/new_dir.h"
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

bool orl_sequence_is_video(const char *out)
{
    return orl_path_has_extension(out, "mp4");
}

enum orl_result orl_sequence_check_out(const struct orl_log *log, const char *out, bool beside, bool layers)
{
    if (orl_sequence_is_video(out))
        return layers ? orl_fail(log, ORL_ERR_ARGUMENT, "--out %s: a video has no --layers; a folder of frames "
                                 "has them", out)
                      : orl_video_can_encode(log, out);
    if (orl_video_is(out) || orl_path_has_extension(out, "avif bmp exr gif hdr heic jpeg jpg png tif tiff webp"))
        return orl_fail(log, ORL_ERR_ARGUMENT, "--out %s: a path needs a folder or an .mp4 file", out);
    return beside ? ORL_OK : orl_new_dir_refuse_used(log, out);
}

static enum orl_result write_dir(const struct orl_log *log, const struct orl_sequence *s, const char *dir,
                                 const char *extension)
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

static enum orl_result write_video(const struct orl_log *log, const struct orl_sequence *s, const char *file,
                                   double fps)
{
    const char *dir = ORL_PATH("", "%s.frames", file);
    if (orl_path_is_dir(dir))
        return orl_fail(log, ORL_ERR_ARGUMENT,
                        "%s.frames is in the way: frames are kept there meanwhile", file);
    enum orl_result result = write_dir(log, s, dir, "png");
    ORL_THEN(result, orl_video_encode(log, s->progress, dir, fps, file));
    enum orl_result removed = orl_dir_remove(log, dir);
    return result != ORL_OK ? result : removed;
}

enum orl_result orl_sequence_write(const struct orl_log *log, const struct orl_sequence *s, const char *out,
                                   const char *extension, double fps)
{
    return orl_sequence_is_video(out) ? write_video(log, s, out, fps) : write_dir(log, s, out, extension);
}
