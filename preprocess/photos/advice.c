#include "preprocess/photos/advice.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>
#include <strings.h>

#include "core/file.h"
#include "core/memory.h"
#include "preprocess/photos/develop.h"

#define TAKE_FRAMES                                                                               \
    "take frames out of one whose camera moved, and the scene did not, and give their folder: "  \
    "ffmpeg -i VIDEO -vf fps=2 FRAMES/%%05d.png"

bool orl_has_extension(const char *name, const char *const *extensions)
{
    const char *dot = strrchr(name, '.');
    for (; dot && *extensions; extensions++)
        if (strcasecmp(dot + 1, *extensions) == 0)
            return true;
    return false;
}

bool orl_is_photo_name(const char *name)
{
    static const char *const known[] = {"jpg", "jpeg", "png", NULL};
    return name[0] != '.' && (orl_has_extension(name, known) || orl_develop_wanted(name));
}

bool orl_is_video_name(const char *name)
{
    static const char *const known[] = {"avi", "mp4", "m4v", "mov", "mkv", "webm", "mpg", "mpeg",
                                        "mts", "m2ts", "wmv", "3gp", "ogv", "insv", NULL};
    return name[0] != '.' && orl_has_extension(name, known);
}

enum orl_result orl_fail_video(const struct orl_job *job, const char *path)
{
    return orl_fail(job->log, ORL_ERR_DATA, "%s: a video, not a photograph: " TAKE_FRAMES, path);
}

// --- a folder without photographs ---

struct contents {
    bool photos;
    char *video; // owned; the path of one video, NULL: none
    struct orl_names folders;
};

static void finish_contents(struct contents *contents)
{
    free(contents->video);
    orl_names_finish(&contents->folders);
}

static enum orl_result look_into(const struct orl_job *job, const char *dir,
                                 struct contents *contents)
{
    struct orl_names names;
    enum orl_result result = orl_dir_list(job->log, dir, &names);
    for (size_t i = 0; result == ORL_OK && i < names.count; i++) {
        char *path = orl_path_join(job->log, dir, names.items[i]);
        if (!path) {
            result = ORL_ERR_MEMORY;
        } else if (orl_path_is_dir(path)) {
            result = orl_names_add(job->log, &contents->folders, names.items[i]);
        } else if (!contents->video && orl_is_video_name(names.items[i])) {
            contents->video = path;
            continue; // `path` is handed over
        } else {
            contents->photos = contents->photos || orl_is_photo_name(names.items[i]);
        }
        free(path);
    }
    orl_names_finish(&names);
    return result;
}

// Looks into the folders below `dir`: adds those with photographs to `with`, keeps one video's
// path.
static enum orl_result look_below(const struct orl_job *job, const char *dir,
                                  struct contents *contents, struct orl_names *with)
{
    enum orl_result result = ORL_OK;
    for (size_t i = 0; result == ORL_OK && i < contents->folders.count; i++) {
        struct contents below = {0};
        char *path = orl_path_join(job->log, dir, contents->folders.items[i]);
        result = path ? look_into(job, path, &below) : ORL_ERR_MEMORY;
        if (result == ORL_OK && below.photos)
            result = orl_names_add(job->log, with, path);
        if (!contents->video) {
            contents->video = below.video;
            below.video = NULL;
        }
        finish_contents(&below);
        free(path);
    }
    return result;
}

enum orl_result orl_fail_no_photos(const struct orl_job *job, const char *dir)
{
    struct contents contents = {0};
    struct orl_names with = {0};
    enum orl_result result = look_into(job, dir, &contents);
    if (result == ORL_OK)
        result = look_below(job, dir, &contents, &with);
    if (result != ORL_OK)
        goto end;
    if (with.count)
        result = orl_fail(job->log, ORL_ERR_NOT_FOUND,
                          "%s: no photograph here (JPEG, PNG, TIFF, EXR or RAW files); name %s%s "
                          "instead, which has some", dir, with.items[0],
                          with.count > 1 ? ", or another of its folders," : "");
    else if (contents.video)
        result = orl_fail(job->log, ORL_ERR_NOT_FOUND,
                          "%s: no photograph here, but videos, such as %s: " TAKE_FRAMES, dir,
                          contents.video);
    else
        result = orl_fail(job->log, ORL_ERR_NOT_FOUND,
                          "%s: no photograph here (JPEG, PNG, TIFF, EXR or RAW files)", dir);
end:
    finish_contents(&contents);
    orl_names_finish(&with);
    return result;
}

// --- photographs of one view ---

enum { BLOCK = 8, ACROSS = 12, DOWN = 9, BLOCKS = ACROSS * DOWN };

// A photograph at a small size: blocks of pixels minus their means.
struct thumb {
    float pixels[BLOCKS][BLOCK * BLOCK];
    float energy[BLOCKS]; // sum of squares
};

// Mean luma of the pixels that fall into pixel (x, y) of the small picture.
static float box_mean(const struct orl_image *image, int x, int y)
{
    int left = x * image->width / (ACROSS * BLOCK), top = y * image->height / (DOWN * BLOCK);
    int right = (x + 1) * image->width / (ACROSS * BLOCK);
    int bottom = (y + 1) * image->height / (DOWN * BLOCK);
    right = right > left ? right : left + 1;
    bottom = bottom > top ? bottom : top + 1;
    double sum = 0;
    for (int v = top; v < bottom; v++)
        for (int u = left; u < right; u++)
            sum += image->u8[(size_t)v * (size_t)image->width + (size_t)u];
    return (float)(sum / (right - left) / (bottom - top));
}

static void make_thumb(const struct orl_image *image, struct thumb *thumb)
{
    for (int b = 0; b < BLOCKS; b++) {
        float mean = 0, *pixels = thumb->pixels[b];
        for (int i = 0; i < BLOCK * BLOCK; i++) {
            pixels[i] = box_mean(image, b % ACROSS * BLOCK + i % BLOCK,
                                 b / ACROSS * BLOCK + i / BLOCK);
            mean += pixels[i] / (BLOCK * BLOCK);
        }
        thumb->energy[b] = 0;
        for (int i = 0; i < BLOCK * BLOCK; i++) {
            pixels[i] -= mean;
            thumb->energy[b] += pixels[i] * pixels[i];
        }
    }
}

// True when most blocks with texture look alike at any exposure. For a camera that stood still
// nearly all do; for photographs of a turntable 16 degrees apart, half do.
static bool same_view(const struct thumb *a, const struct thumb *b)
{
    const float textured = 16.0f * BLOCK * BLOCK;
    int seen = 0, alike = 0;
    for (int k = 0; k < BLOCKS; k++) {
        if (fmaxf(a->energy[k], b->energy[k]) < textured)
            continue;
        float product = 0;
        for (int i = 0; i < BLOCK * BLOCK; i++)
            product += a->pixels[k][i] * b->pixels[k][i];
        seen++;
        alike += product > 0.9f * sqrtf(a->energy[k] * b->energy[k]);
    }
    return seen && 5 * alike >= 4 * seen;
}

enum orl_result orl_count_views(const struct orl_job *job, size_t enough, size_t *views)
{
    struct thumb *thumbs = orl_array(job->log, enough + 1, sizeof *thumbs);
    enum orl_result result = thumbs ? ORL_OK : ORL_ERR_MEMORY;
    *views = 0;
    for (size_t i = 0; result == ORL_OK && *views < enough && i < job->source_count; i++) {
        struct orl_image image = {0};
        if (orl_progress_cancelled(job->progress))
            result = ORL_ERR_CANCELLED;
        else
            result = orl_picture_read(job->log, job->sources[i].path, 1, &image);
        if (result == ORL_OK) {
            struct thumb *thumb = &thumbs[*views];
            bool known = false;
            make_thumb(&image, thumb);
            for (size_t k = 0; k < *views && !known; k++)
                known = same_view(&thumbs[k], thumb);
            *views += !known;
        }
        orl_image_finish(&image);
    }
    free(thumbs);
    return result;
}
