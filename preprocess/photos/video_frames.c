#include "preprocess/photos/video_frames.h"

#include <inttypes.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <unistd.h>

#include "core/file.h"
#include "core/memory.h"
#include "core/process.h"
#include "io/picture.h"
#include "io/video.h"
#include "preprocess/photos/look.h"

enum {
    STRETCH = 6, // frames looked at for each that is taken
    VERSION = 2, // raised when the same video gives other frames
    RUN_MAX = 5000, // frames that one run of ffmpeg writes: an argument has at most 128 KiB
};
static const double FPS = 2; // frames taken of a second

// --- running ffmpeg ---

struct clip {
    struct orl_job *job;
    const char *path;
    struct orl_video video;
    double rate;  // frames looked at, of a second
    float *blur;  // owned; per frame looked at
    size_t count, capacity;
    enum orl_result result; // of the callbacks
};

static enum orl_result run_tool(const struct clip *clip, const char *const *argv,
                                void (*line)(void *priv, const char *line))
{
    return orl_process_run(clip->job->log, &(struct orl_process_params){
        .argv = argv, .progress = clip->job->progress, .line = line,
        .line_priv = (void *)clip}, NULL);
}

// ffmpeg prints a line with the frame's number, then one with its blur; a frame without edges has
// none or NaN.
static void take_blur(void *priv, const char *line)
{
    struct clip *clip = priv;
    size_t frame;
    float blur;
    if (sscanf(line, "frame:%zu", &frame) == 1 && frame == clip->count &&
        clip->result == ORL_OK) {
        clip->result = ORL_GROW(clip->job->log, clip->blur, clip->capacity, frame);
        if (clip->result == ORL_OK)
            clip->blur[clip->count++] = INFINITY;
        orl_progress_report(clip->job->progress, "frames", 0.8 * (double)frame,
                            clip->video.seconds * clip->rate, NULL);
    }
    if (sscanf(line, "lavfi.blur=%f", &blur) == 1 && isfinite(blur) && clip->count)
        clip->blur[clip->count - 1] = blur;
}

static enum orl_result measure_blur(struct clip *clip)
{
    char *filter = orl_format(clip->job->log, "%sfps=%.6f,scale='min(960,iw)':-2,blurdetect,"
                              "metadata=mode=print:key=lavfi.blur:file=-", clip->video.first,
                              clip->rate);
    const char *const argv[] = {"ffmpeg", "-nostdin", "-loglevel", "error", "-i", ORL_VIDEO_FILE(clip->path),
                                "-map", "0:V:0", "-vf", filter, "-f", "null", "/dev/null", NULL};
    enum orl_result result = filter ? run_tool(clip, argv, take_blur) : ORL_ERR_MEMORY;
    free(filter);
    ORL_THEN(result, clip->result);
    if (result == ORL_OK && !clip->count)
        result = orl_fail(clip->job->log, ORL_ERR_DATA, "%s: no frame can be decoded", clip->path);
    return result;
}

size_t orl_frames_choose(const float *blur, size_t count, size_t stretch, size_t *chosen)
{
    size_t found = 0, within = (2 * stretch + 2) / 3;
    for (size_t first = 0; first < count; first += stretch) {
        size_t best = first;
        for (size_t i = first; i < count && i < first + within; i++)
            if (blur[i] < blur[best])
                best = i;
        chosen[found++] = best;
    }
    return found;
}

// Writes chosen[from] to chosen[to - 1] as JPEG files whose names are their numbers, from 1 on.
static enum orl_result write_frames(const struct clip *clip, const size_t *chosen, size_t from,
                                    size_t to, const char *dir)
{
    char number[24], *filter = orl_array(clip->job->log, 64 + sizeof clip->video + 32 * (to - from), 1);
    ORL_TRY_MEMORY(filter);
    char *frames = orl_video_numbered(clip->job->log, dir, "%05d.jpg");
    snprintf(number, sizeof number, "%zu", from + 1);
    char *end = filter + sprintf(filter, "%sfps=%.6f,select='", clip->video.first, clip->rate);
    for (size_t i = from; i < to; i++)
        end += sprintf(end, "%seq(n,%zu)", i > from ? "+" : "", chosen[i]);
    sprintf(end, "',%snull", clip->video.colours);
    const char *const argv[] = {"ffmpeg", "-nostdin", "-loglevel", "error", "-i", ORL_VIDEO_FILE(clip->path),
                                "-map", "0:V:0", "-vf", filter, "-fps_mode", "passthrough",
                                "-start_number", number, "-q:v", "1", "-qmin", "1",
                                frames, NULL};
    enum orl_result result = frames ? run_tool(clip, argv, NULL) : ORL_ERR_MEMORY;
    free(filter);
    free(frames);
    return result;
}

// --- a camera that stands still ---

static enum orl_result drop_still(const struct clip *clip, const char *dir)
{
    const struct orl_log *log = clip->job->log;
    struct orl_names names;
    struct orl_look last = {0};
    size_t dropped = 0;
    enum orl_result result = orl_dir_list(log, dir, &names);
    for (size_t i = 0; result == ORL_OK && i < names.count; i++) {
        struct orl_image luma = {0};
        struct orl_look look;
        const char *path = ORL_PATH(dir, "%s", names.items[i]);
        result = orl_picture_read(log, path, 1, &luma);
        ORL_THEN(result, orl_look_make(log, &luma, &look));
        if (result == ORL_OK && i && orl_look_same_picture(&last, &look)) {
            dropped += unlink(path) == 0;
        } else if (result == ORL_OK) {
            last = look;
        }
        orl_image_finish(&luma);
    }
    orl_names_finish(&names);
    if (dropped)
        orl_logf(log, ORL_LOG_INFO, "%s: the camera stands still in %zu frames, which are left out",
                 clip->path, dropped);
    return result;
}

// --- all of it ---

static enum orl_result make_frames(struct clip *clip, const char *dir)
{
    ORL_TRY(orl_video_inspect(clip->job->log, clip->job->progress, clip->path, true, &clip->video));
    if (!(clip->video.seconds > 0))
        return orl_fail(clip->job->log, ORL_ERR_DATA, "%s: its length is not known", clip->path);
    const struct orl_prepare_params *params = clip->job->params;
    double fps = params->frames ? params->frames / clip->video.seconds
                 : params->fps > 0 ? params->fps : FPS;
    clip->rate = fps * STRETCH;
    ORL_TRY(measure_blur(clip));
    size_t *chosen = orl_array(clip->job->log, clip->count / STRETCH + 1, sizeof *chosen);
    ORL_TRY_MEMORY(chosen);
    size_t count = orl_frames_choose(clip->blur, clip->count, STRETCH, chosen);
    // The last stretch may be a rest.
    if (params->frames && count > (size_t)params->frames)
        count = (size_t)params->frames;
    enum orl_result result = ORL_OK;
    for (size_t from = 0, to; result == ORL_OK && from < count; from = to) {
        to = count - from < RUN_MAX ? count : from + RUN_MAX;
        result = write_frames(clip, chosen, from, to, dir);
    }
    free(chosen);
    return result == ORL_OK ? drop_still(clip, dir) : result;
}

// The folder of the frames that this video gives with these settings.
static enum orl_result name_folder(const struct orl_job *job, const char *path, char **dir)
{
    uint64_t hash;
    ORL_TRY(orl_file_hash(job->log, path, &hash));
    *dir = orl_strdup(job->log, job->params->frames
               ? ORL_PATH(job->dir, ".oriel/frames/%016" PRIx64 "-%d-n%d", hash, VERSION,
                          job->params->frames)
               : ORL_PATH(job->dir, ".oriel/frames/%016" PRIx64 "-%d-f%g", hash, VERSION,
                          job->params->fps > 0 ? job->params->fps : FPS));
    return *dir ? ORL_OK : ORL_ERR_MEMORY;
}

enum orl_result orl_frames_take(struct orl_job *job, const char *path, char **dir,
                                struct orl_names *names)
{
    struct clip clip = {.job = job, .path = path};
    *dir = NULL;
    *names = (struct orl_names){0};
    enum orl_result result = name_folder(job, path, dir);
    if (result == ORL_OK && !orl_path_is_dir(*dir)) {
        static const char temp[] = ".oriel/frames.tmp";
        const char *made = ORL_PATH(job->dir, "%s", temp);
        result = orl_dir_make(job->log, ORL_PATH(job->dir, ".oriel/frames"));
        ORL_THEN(result, orl_job_fresh_dir(job, temp));
        ORL_THEN(result, make_frames(&clip, made));
        // A full disk is no fault of the video's.
        if (result == ORL_ERR_EXTERNAL && orl_job_need_disk(job, "frames", 64 << 20) != ORL_OK)
            result = ORL_ERR_IO;
        ORL_THEN(result, orl_flush(job->log, made)); // ffmpeg does not
        if (result == ORL_OK && rename(made, *dir) != 0)
            result = orl_fail(job->log, ORL_ERR_IO, "%s: cannot be renamed to %s", made, *dir);
        orl_progress_report(job->progress, "frames", 1, 1, NULL);
    }
    ORL_THEN(result, orl_dir_list(job->log, *dir, names));
    free(clip.blur);
    return result;
}
