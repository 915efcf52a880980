#include "preprocess/photos/list.h"

#include <ctype.h>
#include <errno.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include "core/file.h"
#include "core/memory.h"
#include "io/video.h"
#include "preprocess/photos/develop.h"
#include "preprocess/photos/video_frames.h"

// --- names ---

static bool is_photo_name(const char *name)
{
    return name[0] != '.' && (orl_path_has_extension(name, "jpg jpeg png") || orl_picture_needs_copy(name));
}

// Picture formats that Oriel does not read, though a user may expect it to.
static bool is_other_photo_name(const char *name)
{
    return name[0] != '.' && orl_path_has_extension(name, "webp bmp gif jxl jp2 psd");
}

static bool is_video_name(const char *name)
{
    return name[0] != '.' && orl_video_is(name);
}

// Files made from a photograph have longer names, and file systems allow 255 bytes.
enum { NAME_MAX_BYTES = 200 };

// COLMAP's lists are lines, its stereo lists are separated by commas, and '#' starts a comment. A
// name must be valid in all of them; NULL: it is.
static const char *name_problem(const char *name)
{
    size_t length = strlen(name);
    if (name[0] == '#' || isspace((unsigned char)name[0]) ||
        isspace((unsigned char)name[length - 1]))
        return "its name starts with # or starts or ends with a space: rename it";
    for (const char *c = name; *c; c++)
        if ((unsigned char)*c < 32 || *c == ',')
            return "its name has a comma or a control character: rename it";
    if (length > NAME_MAX_BYTES)
        return "its name is longer than 200 bytes: rename it";
    json_t *text = json_string(name);
    json_decref(text);
    return text ? NULL : "its name is not UTF-8: rename it";
}

void orl_photos_skip(struct orl_job *job, const char *name, const char *why)
{
    orl_logf(job->log, ORL_LOG_WARNING, "%s: %s; skipped", name, why);
    json_t *entry = json_pack("{s:s, s:s}", "name", name, "why", why);
    if (!entry) // JSON must be UTF-8
        entry = json_pack("{s:s, s:s}", "name", "(name is not UTF-8)", "why", "cannot be used");
    json_array_append_new(job->skipped, entry);
}

void orl_photos_close_up(struct orl_job *job)
{
    size_t kept = 0;
    for (size_t i = 0; i < job->source_count; i++) {
        struct orl_source source = job->sources[i];
        memset(&job->sources[i], 0, sizeof source);
        if (source.name)
            job->sources[kept++] = source;
    }
    job->source_count = kept;
}

// --- files ---

// The scene's own name of a file at `given`, a path below a folder that was given.
static char *flat_name(const struct orl_log *log, const char *given)
{
    char *name = orl_picture_needs_copy(given)
                     ? orl_format(log, "%.*s.jpg", (int)orl_path_stem(given), given)
                     : orl_strdup(log, given);
    for (char *c = name; c && *c; c++)
        if (*c == '/')
            *c = '_';
    return name;
}

static enum orl_result add_source(struct orl_job *job, char *real, const char *name,
                                  const char *given, int clip)
{
    enum orl_result result = ORL_GROW(job->log, job->sources, job->source_capacity, job->source_count);
    if (result != ORL_OK) {
        free(real);
        return result;
    }
    struct orl_source *source = &job->sources[job->source_count++];
    *source = (struct orl_source){.name = orl_strdup(job->log, name),
                                  .given = orl_strdup(job->log, given), .path = real,
                                  .clip = clip};
    return source->name && source->given ? ORL_OK : ORL_ERR_MEMORY;
}

static enum orl_result add_photo(struct orl_job *job, const char *path, const char *given)
{
    job->given++;
    char *real = realpath(path, NULL), *name = flat_name(job->log, given);
    enum orl_result result = name ? ORL_OK : ORL_ERR_MEMORY;
    const char *problem = !real ? strerror(errno)
                          : !orl_path_is_file(real) ? "not a regular file"
                          : name ? name_problem(name) : NULL;
    if (result == ORL_OK && !problem) {
        result = add_source(job, real, name, given, 0);
        real = NULL;
    } else if (problem) {
        orl_photos_skip(job, path, problem);
    }
    free(real);
    free(name);
    return result;
}

// --- videos ---

static int clip_count(const struct orl_job *job)
{
    int count = 0;
    for (size_t i = 0; i < job->source_count; i++)
        count = job->sources[i].clip > count ? job->sources[i].clip : count;
    return count;
}

// The frames 00001.jpg, ... in `dir` of walk.mp4 become walk_00001.jpg, ...
static enum orl_result add_frames(struct orl_job *job, const char *name, const char *dir,
                                  const struct orl_names *frames)
{
    int clip = clip_count(job) + 1;
    enum orl_result result = ORL_OK;
    for (size_t i = 0; result == ORL_OK && i < frames->count; i++) {
        char *path = orl_path_join(job->log, dir, frames->items[i]);
        const char *full = ORL_PATH("", "%.*s_%s", (int)(strrchr(name, '.') - name), name, frames->items[i]);
        job->given++;
        result = path ? add_source(job, path, full, full, clip) : ORL_ERR_MEMORY;
    }
    return result;
}

// One bad video among others is no reason to stop.
static enum orl_result add_video(struct orl_job *job, const char *path, const char *given)
{
    char *dir = NULL, *name = flat_name(job->log, given); // which its frames' names begin with
    struct orl_names frames = {0};
    ORL_TRY_MEMORY(name);
    const char *problem = name_problem(name);
    enum orl_result result = problem ? ORL_OK : orl_frames_take(job, path, &dir, &frames);
    if (result == ORL_ERR_DATA || result == ORL_ERR_EXTERNAL)
        problem = "ffmpeg finds no frames in it";
    if (result == ORL_ERR_UNSUPPORTED)
        problem = "frames of it cannot be used";
    if (problem) {
        orl_photos_skip(job, path, problem);
        job->given++;
        result = ORL_OK;
    } else if (result == ORL_OK) {
        result = add_frames(job, name, dir, &frames);
    }
    orl_names_finish(&frames);
    free(dir);
    free(name);
    return result;
}

// --- folders ---

// A folder and those that it was reached through, since links may lead in circles.
struct folder {
    const char *path;  // as reached
    const char *given; // below the folder that was given; "": that folder
    char *real;        // owned; after all links
    const struct folder *up;
};

static bool is_barred(const struct orl_job *job, const struct folder *folder)
{
    char *masks = job->params->masks_dir ? realpath(job->params->masks_dir, NULL) : NULL;
    bool barred = orl_path_is_file(ORL_PATH(folder->path, "scene.json")) || strcmp(folder->real, job->dir) == 0 ||
                  (masks && strcmp(folder->real, masks) == 0);
    for (const struct folder *up = folder->up; up && !barred; up = up->up)
        barred = strcmp(up->real, folder->real) == 0;
    free(masks);
    return barred;
}

static enum orl_result add_folder(struct orl_job *job, const char *path, const char *given,
                                  const struct folder *up);

static enum orl_result add_entry(struct orl_job *job, const struct folder *folder,
                                 const char *name, bool with_videos, size_t *videos)
{
    char *path = orl_path_join(job->log, folder->path, name);
    char *given = *folder->given ? orl_path_join(job->log, folder->given, name)
                                 : orl_strdup(job->log, name);
    enum orl_result result = path && given ? ORL_OK : ORL_ERR_MEMORY;
    if (result != ORL_OK) {
        ;
    } else if (orl_path_is_dir(path)) {
        result = name[0] == '.' ? ORL_OK : add_folder(job, path, given, folder);
    } else if (is_photo_name(name)) {
        result = add_photo(job, path, given);
    } else if (is_video_name(name)) {
        *videos += !with_videos;
        result = with_videos ? add_video(job, path, given) : ORL_OK;
    } else if (is_other_photo_name(name)) {
        job->given++;
        orl_photos_skip(job, path, "not JPEG, PNG, TIFF, EXR, HEIC, AVIF or RAW");
    }
    free(path);
    free(given);
    return result;
}

static enum orl_result add_entries(struct orl_job *job, const struct folder *folder)
{
    struct orl_names names;
    size_t videos = 0;
    bool photos = false;
    enum orl_result result = orl_dir_list(job->log, folder->path, &names);
    // Beside photographs, videos are mostly what phones record with each photograph.
    for (size_t i = 0; result == ORL_OK && i < names.count; i++)
        photos = photos || is_photo_name(names.items[i]);
    for (size_t i = 0; result == ORL_OK && i < names.count; i++)
        result = add_entry(job, folder, names.items[i], !photos, &videos);
    orl_names_finish(&names);
    if (result == ORL_OK && videos)
        orl_logf(job->log, ORL_LOG_WARNING,
                 "%s: videos beside photographs are left out: %zu; name one to use it",
                 folder->path, videos);
    return result;
}

static enum orl_result add_folder(struct orl_job *job, const char *path, const char *given,
                                  const struct folder *up)
{
    struct folder folder = {path, given, realpath(path, NULL), up};
    enum orl_result result = ORL_OK;
    if (!folder.real)
        result = orl_file_failed(job->log, path);
    else if (!up || !is_barred(job, &folder))
        result = add_entries(job, &folder);
    free(folder.real);
    return result;
}

static enum orl_result add_input(struct orl_job *job, const char *input)
{
    size_t before = job->given;
    if (access(input, F_OK) != 0)
        return orl_fail(job->log, ORL_ERR_NOT_FOUND,
                        "%s: no such folder or file; give a folder of photographs", input);
    if (!orl_path_is_dir(input))
        return is_video_name(orl_path_name(input)) && orl_path_is_file(input)
                   ? add_video(job, input, orl_path_name(input))
                   : add_photo(job, input, orl_path_name(input));
    if (orl_path_is_file(ORL_PATH(input, "scene.json")))
        return orl_fail(job->log, ORL_ERR_ARGUMENT, "%s: a scene; give the photographs that it was made of, or its "
                        "folder images", input);
    ORL_TRY(add_folder(job, input, "", NULL));
    if (job->given == before)
        return orl_fail(job->log, ORL_ERR_NOT_FOUND,
                        "%s: no photograph here or in its sub-folders (JPEG, PNG, TIFF, EXR, "
                        "HEIC, AVIF or RAW files), and no video", input);
    return ORL_OK;
}

enum orl_result orl_photos_list(struct orl_job *job)
{
    for (size_t i = 0; i < job->params->input_count; i++)
        ORL_TRY(add_input(job, job->params->inputs[i]));
    return ORL_OK;
}
