#include "render/sequence.h"

#include <stdlib.h>
#include <string.h>

#include "core/file.h"
#include "core/memory.h"
#include "io/video.h"

enum orl_result orl_sequence_write_view(const struct orl_log *log, const struct orl_sequence *s,
                                        const struct orl_view *view, const char *file)
{
    struct orl_frame frame = {0};
    enum orl_result result = s->draw(s->priv, view, &frame);
    if (result == ORL_OK)
        result = orl_frame_write(log, file, view, &frame, s->output);
    orl_frame_finish(&frame);
    return result;
}

enum orl_result orl_sequence_write_dir(const struct orl_log *log, const struct orl_sequence *s,
                                       const char *dir, const char *extension)
{
    enum orl_result result = orl_dir_make(log, dir);
    for (size_t i = 0; result == ORL_OK && i < s->count; i++) {
        if (orl_progress_cancelled(s->progress))
            return ORL_ERR_CANCELLED;
        char *file = orl_format(log, "%s/%05zu.%s", dir, i, extension);
        result = file ? orl_sequence_write_view(log, s, &s->views[i], file) : ORL_ERR_MEMORY;
        free(file);
        orl_progress_report(s->progress, s->step, (double)(i + 1), (double)s->count, NULL);
    }
    return result;
}

// As DIR/NAME.exr; photographs may lie in folders.
static enum orl_result write_photo(const struct orl_log *log, const struct orl_sequence *s,
                                   const struct orl_photo *photo, const char *dir)
{
    const char *dot = strrchr(photo->name, '.');
    size_t stem = dot ? (size_t)(dot - photo->name) : strlen(photo->name);
    char *file = orl_format(log, "%s/%.*s.exr", dir, (int)stem, photo->name);
    if (!file)
        return ORL_ERR_MEMORY;
    char *slash = strrchr(file, '/');
    *slash = '\0';
    enum orl_result result = orl_dir_make(log, file);
    *slash = '/';
    if (result == ORL_OK)
        result = orl_sequence_write_view(log, s, &photo->view, file);
    free(file);
    return result;
}

enum orl_result orl_sequence_write_series(const struct orl_log *log, const struct orl_sequence *s,
                                          const struct orl_scene *scene, int series,
                                          const char *dir)
{
    size_t count = 0, done = 0;
    for (size_t i = 0; i < scene->photo_count; i++)
        count += scene->photos[i].series == series;
    if (!count)
        return orl_fail(log, ORL_ERR_NOT_FOUND, "%s has no series %d; see oriel info", scene->dir,
                        series);
    enum orl_result result = ORL_OK;
    for (size_t i = 0; result == ORL_OK && i < scene->photo_count; i++) {
        const struct orl_photo *photo = &scene->photos[i];
        if (photo->series != series)
            continue;
        if (orl_progress_cancelled(s->progress))
            return ORL_ERR_CANCELLED;
        result = write_photo(log, s, photo, dir);
        orl_progress_report(s->progress, s->step, (double)++done, (double)count, photo->name);
    }
    return result;
}

enum orl_result orl_sequence_write_video(const struct orl_log *log, const struct orl_sequence *s,
                                         const char *file, double fps)
{
    char *dir = orl_format(log, "%s.frames", file);
    if (!dir)
        return ORL_ERR_MEMORY;
    if (orl_path_is_dir(dir)) {
        free(dir);
        return orl_fail(log, ORL_ERR_ARGUMENT,
                        "%s.frames is in the way: frames are kept there meanwhile", file);
    }
    enum orl_result result = orl_sequence_write_dir(log, s, dir, "png");
    if (result == ORL_OK)
        result = orl_video_encode(log, s->progress, dir, fps, file);
    enum orl_result removed = orl_dir_remove(log, dir);
    free(dir);
    return result != ORL_OK ? result : removed;
}
