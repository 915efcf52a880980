#include "preprocess/photos/masks.h"

#include <inttypes.h>
#include <stdlib.h>

#include "core/file.h"
#include "io/mask.h"
#include "io/picture.h"

// The masks of a job, counted.
struct counts {
    size_t found, empty;
    const char *first_empty; // name of its photograph
};

// Writes the copy of the mask at `path`, unless an earlier run has.
static enum orl_result copy_mask(const struct orl_job *job, struct orl_source *source,
                                 const char *path, bool *empty)
{
    struct orl_image mask = {0};
    source->mask = orl_job_path(job, ".oriel/masks/%016" PRIx64 ".png", source->mask_hash);
    if (!source->mask)
        return ORL_ERR_MEMORY;
    bool made = orl_path_is_file(source->mask);
    enum orl_result result = orl_mask_read(job->log, made ? source->mask : path, &mask);
    *empty = result == ORL_OK && !orl_mask_count(&mask);
    if (result == ORL_OK && !made)
        result = orl_png_write(job->log, source->mask, &mask);
    orl_image_finish(&mask);
    return result;
}

static enum orl_result take_mask(const struct orl_job *job, struct orl_source *source,
                                 const char *path, struct counts *counts)
{
    int width, height;
    bool empty;
    enum orl_result result = orl_file_hash(job->log, path, &source->mask_hash);
    if (result == ORL_OK)
        result = orl_picture_size(job->log, path, &width, &height);
    if (result == ORL_OK && (width != source->width || height != source->height))
        result = orl_fail(job->log, ORL_ERR_DATA, "%s: %dx%d pixels, but its photograph %s has "
                          "%dx%d", path, width, height, source->name, source->width,
                          source->height);
    if (result == ORL_OK)
        result = copy_mask(job, source, path, &empty);
    if (result != ORL_OK)
        return result;
    counts->found++;
    if (empty && !counts->empty++)
        counts->first_empty = source->given;
    return ORL_OK;
}

// By the photograph's name in the input or in the scene.
static enum orl_result find_mask(const struct orl_job *job, struct orl_source *source,
                                 struct counts *counts)
{
    char *path = NULL;
    enum orl_result result = orl_mask_find(job->log, job->params->masks_dir, source->given, &path);
    if (result == ORL_OK && !path)
        result = orl_mask_find(job->log, job->params->masks_dir, source->name, &path);
    if (result == ORL_OK && path)
        result = take_mask(job, source, path, counts);
    free(path);
    return result;
}

static enum orl_result judge(const struct orl_job *job, const struct counts *counts)
{
    const char *dir = job->params->masks_dir;
    if (!counts->found)
        return orl_fail(job->log, ORL_ERR_NOT_FOUND,
                        "--masks %s: no mask for any photograph (NAME.png or NAME.EXT.png)", dir);
    if (counts->empty == counts->found)
        return orl_fail(job->log, ORL_ERR_DATA, "--masks %s: all of its %zu masks are black, and "
                        "black pixels are ignored: nothing is left of the photographs", dir,
                        counts->found);
    if (counts->empty)
        orl_logf(job->log, ORL_LOG_WARNING, "%zu of %zu masks are black, as that of %s: nothing of "
                 "these photographs is used", counts->empty, counts->found, counts->first_empty);
    if (counts->found < job->source_count)
        orl_logf(job->log, ORL_LOG_WARNING, "%zu of %zu photographs have no mask: used whole",
                 job->source_count - counts->found, job->source_count);
    return ORL_OK;
}

enum orl_result orl_masks_find(struct orl_job *job)
{
    struct counts counts = {0};
    if (!job->params->masks_dir)
        return ORL_OK;
    if (!orl_path_is_dir(job->params->masks_dir))
        return orl_fail(job->log, ORL_ERR_NOT_FOUND, "--masks %s: no such folder",
                        job->params->masks_dir);
    char *copies = orl_job_path(job, ".oriel/masks");
    enum orl_result result = copies ? orl_dir_make(job->log, copies) : ORL_ERR_MEMORY;
    for (size_t i = 0; result == ORL_OK && i < job->source_count; i++)
        result = find_mask(job, &job->sources[i], &counts);
    free(copies);
    return result == ORL_OK ? judge(job, &counts) : result;
}
