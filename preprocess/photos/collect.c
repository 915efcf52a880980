// Collect: lists the photographs given and finds those that can be used.
#include <inttypes.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <strings.h>
#include <unistd.h>

#include "core/file.h"
#include "core/memory.h"
#include "preprocess/job/test_block.h"
#include "preprocess/job/threads.h"
#include "preprocess/photos/develop.h"
#include "preprocess/photos/doubts.h"
#include "preprocess/photos/list.h"
#include "preprocess/photos/masks.h"

static int compare_sources(const void *a, const void *b)
{
    return strcmp(((const struct orl_source *)a)->name, ((const struct orl_source *)b)->name);
}

static void drop(struct orl_job *job, struct orl_source *source, const char *name, const char *why)
{
    orl_photos_skip(job, name, why);
    orl_source_finish(source);
}

// Collects a decoder's messages, which become the reason in the report.
struct reason {
    char text[512];
};

static void keep_reason(void *priv, enum orl_log_level level, const char *message)
{
    struct reason *reason = priv;
    if (level == ORL_LOG_ERROR)
        snprintf(reason->text, sizeof reason->text, "%s", message);
}

static void skip_for(struct orl_job *job, struct orl_source *source, const struct reason *reason)
{
    // Decoders start with the file's name, which the report has already.
    size_t length = strlen(source->path);
    bool named = strncmp(reason->text, source->path, length) == 0;
    const char *why = reason->text + (named ? length : 0);
    drop(job, source, source->path, why + strspn(why, ": "));
}

// Drops unreadable photographs that stand for a JPEG of the same name, so that the JPEG is used.
static void drop_unreadable(struct orl_job *job)
{
    for (size_t i = 0; i < job->source_count; i++) {
        struct orl_source *source = &job->sources[i];
        struct reason reason = {"cannot be read"};
        struct orl_log log = {.level = ORL_LOG_ERROR, .print = keep_reason, .priv = &reason};
        struct orl_picture_info info;
        if (!orl_picture_needs_copy(source->given))
            continue;
        if (orl_picture_inspect(&log, source->path, &info) != ORL_OK)
            skip_for(job, source, &reason);
        source->width = info.width; // for orl_develop_at_once; 0 of those that are dropped
        source->height = info.height;
    }
    orl_photos_close_up(job);
}

// The RAW file beside which a camera wrote this JPEG; NULL: there is none.
static const char *raw_of(const struct orl_job *job, const char *given)
{
    size_t stem = orl_path_stem(given);
    bool may_have = orl_path_has_extension(given, "jpg jpeg");
    for (size_t k = 0; may_have && k < job->source_count; k++) {
        const char *other = job->sources[k].given;
        // Most names differ, which is seen soonest.
        if (other && strncasecmp(other, given, stem) == 0 && orl_path_stem(other) == stem &&
            orl_picture_needs_copy(other))
            return other;
    }
    return NULL;
}

// Two photographs from one place would mislead COLMAP.
static void drop_jpegs_of_raw(struct orl_job *job)
{
    for (size_t i = 0; i < job->source_count; i++) {
        struct orl_source *source = &job->sources[i];
        const char *raw = raw_of(job, source->given);
        char why[512];
        if (!raw)
            continue;
        snprintf(why, sizeof why, "%s holds more of the same photograph", raw);
        drop(job, source, source->path, why);
    }
    orl_photos_close_up(job);
}

// A file given twice counts once. Two files of one name are an error, since COLMAP cannot tell them
// apart. Folders become part of a name only below the folder that was given.
static enum orl_result drop_duplicates(struct orl_job *job)
{
    if (job->source_count)
        qsort(job->sources, job->source_count, sizeof *job->sources, compare_sources);
    const struct orl_source *last = NULL;
    for (size_t i = 0; i < job->source_count; i++) {
        struct orl_source *source = &job->sources[i];
        if (!last || strcmp(last->name, source->name) != 0) {
            last = source;
            continue;
        }
        if (strcmp(last->path, source->path) != 0 && last->clip && source->clip)
            return orl_fail(job->log, ORL_ERR_ARGUMENT, "two videos have frames of the same name, %s: rename one of "
                            "them, or where they are in different folders give the one that holds both",
                            source->name);
        if (strcmp(last->path, source->path) != 0)
            return orl_fail(job->log, ORL_ERR_ARGUMENT, "%s and %s have the same name, %s: rename one, or %s",
                            last->path, source->path, source->name,
                            strcmp(last->given, source->given) == 0 ? "give the folder that holds both"
                                                                    : "take it out of the folder");
        orl_source_finish(source);
        job->given--;
    }
    orl_photos_close_up(job);
    return ORL_OK;
}

// True when an earlier run found this file usable.
static bool known_good(const struct orl_job *job, const struct orl_source *source)
{
    const json_t *photos = json_object_get(
        json_object_get(json_object_get(job->stages, "done"), "collect"), "photographs");
    const char *hash = json_string_value(json_object_get(photos, source->name));
    char text[32];
    snprintf(text, sizeof text, "%016" PRIx64, source->hash);
    return hash && strcmp(hash, text) == 0;
}

// Returns false, with the reason, when the file cannot be used. Decodes the whole picture, as only
// this finds truncated files.
static bool inspect(const struct orl_job *job, struct orl_source *source, struct reason *reason)
{
    struct orl_log log = {.level = ORL_LOG_ERROR, .print = keep_reason, .priv = reason};
    struct orl_image image = {0};
    struct orl_picture_info info;
    if (orl_file_hash(&log, source->path, &source->hash) != ORL_OK ||
        orl_picture_inspect(&log, source->path, &info) != ORL_OK)
        return false;
    source->width = info.width;
    source->height = info.height;
    source->deep = info.bits > 8;
    source->profiled = info.profiled;
    source->unbounded = info.unbounded;
    source->gain_map = info.gain_map;
    source->exif = info.exif;
    if (info.panorama) {
        snprintf(reason->text, sizeof reason->text, "%s", ORL_PANORAMA_ADVICE);
        return false;
    }
    if (source->width < 64 || source->height < 64) {
        snprintf(reason->text, sizeof reason->text, "%dx%d pixels are too few", source->width,
                 source->height);
        return false;
    }
    if (known_good(job, source) && orl_doubts_has_look(job, source))
        return true;
    bool good = orl_picture_read(&log, source->path, 1, &image) == ORL_OK;
    if (good)
        orl_doubts_keep_look(job, source, &image);
    orl_image_finish(&image);
    return good;
}

struct inspection {
    const struct orl_job *job;
    struct reason *reasons; // of each photograph; "": it can be used
};

static enum orl_result inspect_one(void *priv, size_t item)
{
    const struct inspection *all = priv;
    struct reason reason = {"cannot be read"};
    if (!inspect(all->job, &all->job->sources[item], &reason))
        all->reasons[item] = reason;
    return ORL_OK;
}

static enum orl_result inspect_all(struct orl_job *job)
{
    size_t gain_maps = 0;
    struct inspection all = {job, orl_array(job->log, job->source_count, sizeof *all.reasons)};
    ORL_TRY_MEMORY(all.reasons);
    enum orl_result result = orl_threads_each(&(struct orl_each){
        .work = inspect_one, .priv = &all, .count = job->source_count, .threads = orl_develop_at_once(job),
        .progress = job->progress, .step = "collect", .share = 1, .total = 1});
    for (size_t i = 0; result == ORL_OK && i < job->source_count; i++) {
        if (all.reasons[i].text[0])
            skip_for(job, &job->sources[i], &all.reasons[i]);
        else
            gain_maps += job->sources[i].gain_map;
    }
    free(all.reasons);
    ORL_TRY(result);
    orl_photos_close_up(job);
    if (gain_maps)
        orl_logf(job->log, ORL_LOG_INFO, ORL_GAIN_MAP_NEWS, gain_maps, job->source_count);
    orl_progress_report(job->progress, "collect", 1, 1, NULL);
    return ORL_OK;
}

// Drops copies of photographs whose names come before. One photograph under two names (a link, a copy)
// would be matched with itself, and a held-out one would be known to the renderer.
static void drop_copies(struct orl_job *job)
{
    for (size_t i = 0; i < job->source_count; i++) {
        struct orl_source *source = &job->sources[i];
        size_t k = 0;
        char why[512];
        while (k < i && !(job->sources[k].name && job->sources[k].hash == source->hash))
            k++;
        if (k == i)
            continue;
        snprintf(why, sizeof why, "the same file as %s", job->sources[k].given);
        drop(job, source, source->given, why); // the path may be that of the other
    }
    orl_photos_close_up(job);
}

// Names blurred photographs and those that show the picture of another; leaves out those that the
// settings say.
static enum orl_result drop_doubtful(struct orl_job *job)
{
    enum orl_leave_out leave_out = job->params->leave_out;
    struct orl_doubt *doubts = orl_array(job->log, job->source_count, sizeof *doubts);
    enum orl_result result = doubts ? orl_doubts_find(job, doubts) : ORL_ERR_MEMORY;
    for (size_t i = 0; result == ORL_OK && i < job->source_count; i++) {
        struct orl_source *source = &job->sources[i];
        char why[512] = "";
        if (doubts[i].same >= 0)
            snprintf(why, sizeof why, "shows the same as %s", job->sources[doubts[i].same].given);
        else if (doubts[i].blurred)
            snprintf(why, sizeof why, "blurred");
        if ((doubts[i].same >= 0 && leave_out >= ORL_LEAVE_OUT_DUPLICATES) ||
            (doubts[i].blurred && (leave_out == ORL_LEAVE_OUT_BLURRED ||
                                   leave_out == ORL_LEAVE_OUT_BOTH)))
            drop(job, source, source->path, why);
        else if (*why)
            orl_logf(job->log, ORL_LOG_WARNING, "%s: %s (see --leave-out)", source->given, why);
    }
    orl_photos_close_up(job);
    free(doubts);
    return result;
}

static enum orl_result choose_test(struct orl_job *job)
{
    const struct orl_prepare_params *params = job->params;
    size_t held_out = 0;
    ORL_TRY(orl_test_block_check(job->log, params->test_block, job->source_count));
    for (int i = params->test_block.first; i < params->test_block.end; i++)
        job->sources[i].test = true;
    for (size_t i = 0; params->test_every && i < job->source_count; i += (size_t)params->test_every)
        job->sources[i].test = true;
    for (size_t n = 0; n < params->test_list.count; n++) {
        bool found = false;
        for (size_t i = 0; i < job->source_count; i++)
            if (orl_path_is_named(job->sources[i].name, params->test_list.items[n]) ||
                orl_path_is_named(job->sources[i].given, params->test_list.items[n]))
                found = job->sources[i].test = true;
        if (!found)
            return orl_fail(job->log, ORL_ERR_ARGUMENT,
                            "--test-list %s: no usable photograph of this name",
                            params->test_list.items[n]);
    }
    for (size_t i = 0; i < job->source_count; i++)
        held_out += job->sources[i].test;
    if (job->source_count - held_out < 2)
        return orl_fail(job->log, ORL_ERR_ARGUMENT,
                        "%zu of %zu photographs held out: at least two must remain", held_out,
                        job->source_count);
    return ORL_OK;
}

static enum orl_result link_photos(struct orl_job *job)
{
    ORL_TRY(orl_job_fresh_dir(job, ".oriel/photos"));
    for (size_t i = 0; i < job->source_count; i++)
        ORL_TRY(orl_job_link(job, job->sources[i].path, ORL_PATH(job->dir, ".oriel/photos/%s", job->sources[i].name)));
    return ORL_OK;
}

// Names the folder when the input was a folder.
static enum orl_result too_few(const struct orl_job *job)
{
    const struct orl_prepare_params *params = job->params;
    return orl_fail(job->log, ORL_ERR_DATA,
                    "%s%s: %zu usable photograph%s of %zu; at least three are needed that show "
                    "the same place from different positions", params->inputs[0],
                    params->input_count > 1 ? " and others" : "", job->source_count,
                    job->source_count == 1 ? "" : "s", job->given);
}

enum orl_result orl_stage_collect(struct orl_job *job)
{
    ORL_TRY(orl_photos_list(job));
    orl_masks_set_aside(job);
    drop_unreadable(job);
    drop_jpegs_of_raw(job);
    ORL_TRY(drop_duplicates(job));
    ORL_TRY(inspect_all(job));
    drop_copies(job);
    ORL_TRY(drop_doubtful(job));
    if (job->source_count < 3)
        return too_few(job);
    ORL_TRY(choose_test(job));
    ORL_TRY(orl_masks_find(job));
    ORL_TRY(orl_develop(job));
    return link_photos(job);
}
