#include "preprocess/photos/masks.h"

#include <inttypes.h>
#include <stdlib.h>
#include <string.h>

#include "core/file.h"
#include "core/memory.h"
#include "io/mask.h"
#include "io/picture.h"
#include "preprocess/photos/list.h"

// --- masks among photographs ---

// Where photographs are looked for there may be their masks, too: masks/NAME.png, NAME_mask.png,
// NAME.mask.png, or dynamic_mask_NAME.png of instant-ngp. Sets the part of a mask's path that its
// photograph is named after, which may have an extension. False: this is no name of a mask.
static bool mask_stem(const char *path, const char **stem, size_t *length)
{
    static const char *const beginnings[] = {"dynamic_mask_", "mask_"}, *const endings[] = {"_mask", ".mask"};
    const char *dot = strrchr(orl_path_name(path), '.');
    bool found = strncmp(path, "masks/", 6) == 0 || strstr(path, "/masks/");
    *stem = orl_path_name(path);
    *length = dot ? (size_t)(dot - *stem) : strlen(*stem);
    for (size_t i = 0; i < ORL_COUNT(beginnings); i++) {
        size_t size = strlen(beginnings[i]);
        if (*length > size && strncmp(*stem, beginnings[i], size) == 0)
            *stem += size, *length -= size, found = true;
    }
    for (size_t i = 0; i < ORL_COUNT(endings); i++) {
        size_t size = strlen(endings[i]);
        if (*length > size && strncmp(*stem + *length - size, endings[i], size) == 0)
            *length -= size, found = true;
    }
    return found;
}

static bool is_mask(const struct orl_job *job, const char *path)
{
    const char *stem, *unused;
    size_t length, ignored;
    bool found = false;
    if (!mask_stem(path, &stem, &length))
        return false;
    for (size_t i = 0; i < job->source_count && !found; i++) {
        const char *name = job->sources[i].given ? orl_path_name(job->sources[i].given) : "";
        const char *dot = strrchr(name, '.');
        found = strncmp(name, stem, length) == 0 && (!name[length] || name + length == dot) &&
                !mask_stem(job->sources[i].given, &unused, &ignored);
    }
    return found;
}

void orl_masks_set_aside(struct orl_job *job)
{
    size_t masks = 0;
    char *first = NULL;
    for (size_t i = 0; i < job->source_count; i++) {
        struct orl_source *source = &job->sources[i];
        if (!is_mask(job, source->given))
            continue;
        if (!masks++)
            first = orl_strdup(job->log, source->given);
        orl_source_finish(source);
    }
    orl_photos_close_up(job);
    job->given -= masks;
    if (masks && !job->params->masks_dir)
        orl_logf(job->log, ORL_LOG_WARNING, "%zu masks among the photographs, as %s, are not used: --masks "
                 "names a folder of masks", masks, first ? first : "one");
    free(first);
}

// --- masks that are asked for ---

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
    source->mask = orl_strdup(job->log, ORL_PATH(job->dir, ".oriel/masks/%016" PRIx64 ".png", source->mask_hash));
    ORL_TRY_MEMORY(source->mask);
    bool made = orl_path_is_file(source->mask);
    enum orl_result result = orl_mask_read(job->log, made ? source->mask : path, false, &mask);
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
    ORL_TRY(orl_file_hash(job->log, path, &source->mask_hash));
    ORL_TRY(orl_picture_size(job->log, path, &width, &height));
    if (width != source->width || height != source->height)
        return orl_fail(job->log, ORL_ERR_DATA, "%s: %dx%d pixels, but its photograph %s has %dx%d", path,
                        width, height, source->name, source->width, source->height);
    ORL_TRY(copy_mask(job, source, path, &empty));
    counts->found++;
    if (empty && !counts->empty++)
        counts->first_empty = source->given;
    return ORL_OK;
}

// By the photograph's name in the input or in the scene.
static enum orl_result find_mask(const struct orl_job *job, struct orl_source *source,
                                 struct counts *counts)
{
    char path[ORL_PATH_SIZE];
    const char *dir = job->params->masks_dir;
    bool there = orl_mask_find(dir, source->given, path) || orl_mask_find(dir, source->name, path);
    return there ? take_mask(job, source, path, counts) : ORL_OK;
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

// Decodes one picture only: photographs of one program are alike.
static enum orl_result mention_alpha(const struct orl_job *job)
{
    struct orl_image mask = {0};
    size_t i = 0;
    while (i < job->source_count && !orl_picture_is_png(job->sources[i].given))
        i++;
    if (i == job->source_count)
        return ORL_OK;
    enum orl_result result = orl_mask_read(job->log, job->sources[i].path, true, &mask);
    if (mask.data)
        orl_logf(job->log, ORL_LOG_WARNING, "%s: its alpha is not used: give the folder of the photographs as "
                 "--masks, too, if it is their mask", job->sources[i].given);
    orl_image_finish(&mask);
    return result;
}

enum orl_result orl_masks_find(struct orl_job *job)
{
    struct counts counts = {0};
    if (!job->params->masks_dir)
        return mention_alpha(job);
    if (!orl_path_is_dir(job->params->masks_dir))
        return orl_fail(job->log, ORL_ERR_NOT_FOUND, "--masks %s: no such folder",
                        job->params->masks_dir);
    ORL_TRY(orl_dir_make(job->log, ORL_PATH(job->dir, ".oriel/masks")));
    for (size_t i = 0; i < job->source_count; i++)
        ORL_TRY(find_mask(job, &job->sources[i], &counts));
    return judge(job, &counts);
}
