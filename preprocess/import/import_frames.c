// Pictures of a folder or a clip, in their order.
#include <stdlib.h>

#include "core/memory.h"
#include "preprocess/import/import_internal.h"

enum orl_result orl_import_frames_open(const struct import_job *job, const struct import_found *found,
                                       const struct orl_frame_range *range,
                                       struct import_frames *frames)
{
    *frames = (struct import_frames){.step = 1};
    frames->temporary = found->kind == IMPORT_CLIP;
    frames->dir = orl_strdup(job->log, frames->temporary ? ORL_PATH(job->dir, "clip.tmp") : found->path);
    ORL_TRY_MEMORY(frames->dir);
    enum orl_result result = ORL_OK;
    if (frames->temporary) {
        result = orl_dir_make(job->log, frames->dir);
        ORL_THEN(result, orl_video_decode(job->log, job->progress, found->path, range, frames->dir));
    } else {
        frames->first = (size_t)range->first;
        frames->step = (size_t)range->step;
    }
    ORL_THEN(result, orl_import_list_pictures(job->log, frames->dir, &frames->names));
    if (result == ORL_OK && frames->names.count <= frames->first)
        result = orl_fail(job->log, ORL_ERR_DATA, "%s: %zu pictures, but the first frame asked for "
                          "is %zu", frames->dir, frames->names.count, frames->first);
    if (result == ORL_OK) {
        frames->count = (frames->names.count - frames->first + frames->step - 1) / frames->step;
        if (range->count && frames->count > (size_t)range->count)
            frames->count = (size_t)range->count;
    } else {
        orl_import_frames_close(job, frames);
    }
    return result;
}

void orl_import_frames_close(const struct import_job *job, struct import_frames *frames)
{
    if (frames->temporary && frames->dir && orl_dir_remove(job->log, frames->dir) != ORL_OK)
        orl_logf(job->log, ORL_LOG_WARNING, "%s is left over", frames->dir);
    free(frames->dir);
    orl_names_finish(&frames->names);
    *frames = (struct import_frames){0};
}
