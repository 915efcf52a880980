#include "preprocess/job/job.h"

#include <errno.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/statvfs.h>
#include <unistd.h>

#include "core/file.h"
#include "core/json.h"
#include "core/lock.h"
#include "core/memory.h"
#include "oriel/scene.h"

// --- the folder ---

static enum orl_result fail_there(const struct orl_job *job)
{
    return orl_fail(job->log, ORL_ERR_ARGUMENT,
                    "%s: there already; go on with --resume or choose another folder", job->dir);
}

// Accepts a new or empty folder, or with --resume a folder that prepare made. Other folders are
// left untouched.
static enum orl_result claim_folder(const struct orl_job *job, bool *empty)
{
    struct orl_names names = {0};
    ORL_TRY(orl_dir_list(job->log, job->dir, &names));
    bool ours = orl_names_contain(&names, ".oriel");
    enum orl_result result = ORL_OK;
    if (names.count && !ours)
        result = orl_fail(job->log, ORL_ERR_ARGUMENT,
                          "%s: not empty, and not made by oriel prepare; choose another folder",
                          job->dir);
    else if (ours && !job->params->resume)
        result = fail_there(job);
    *empty = names.count == 0;
    orl_names_finish(&names);
    return result;
}

// The folder's state must be read with the lock held: another prepare may have used the folder and
// finished since.
static enum orl_result lock_folder(struct orl_job *job, bool empty)
{
    bool taken = false;
    ORL_TRY(orl_lock(job->log, ORL_PATH(job->dir, ".oriel/lock"), false, &job->lock_fd, &taken));
    bool begun = orl_job_has(job, ".oriel/stages.json");
    if (taken)
        return orl_fail(job->log, ORL_ERR_ARGUMENT, "%s: another oriel prepare is at work here", job->dir);
    if (begun && !job->params->resume)
        return fail_there(job);
    job->fresh = empty && !begun;
    return ORL_OK;
}

enum orl_result orl_job_open(struct orl_job *job, const struct orl_log *log,
                             const struct orl_prepare_params *params,
                             const struct orl_progress *progress)
{
    static const char *const dirs[] = {".oriel", "logs"};
    *job = (struct orl_job){.log = log, .params = params, .progress = progress, .lock_fd = -1,
                            .linear_scale = 1, .skipped = json_array()};
    ORL_TRY(job->skipped ? orl_dir_make(log, params->out) : ORL_ERR_MEMORY);
    job->dir = realpath(params->out, NULL);
    if (!job->dir)
        return orl_file_failed(log, params->out);
    bool empty = false;
    ORL_TRY(claim_folder(job, &empty));
    for (size_t i = 0; i < ORL_COUNT(dirs); i++)
        ORL_TRY(orl_dir_make(log, ORL_PATH(job->dir, "%s", dirs[i])));
    return lock_folder(job, empty);
}

// The model's images are sorted by name, as sources are.
enum orl_result orl_job_take_sources(struct orl_job *job)
{
    struct orl_names train = {0};
    const struct orl_colmap_model *model = &job->sparse;
    enum orl_result result = orl_colmap_read(job->log, ORL_PATH(job->dir, "sparse"), &job->sparse);
    ORL_THEN(result, orl_file_read_names(job->log, ORL_PATH(job->dir, "stereo/fusion.cfg"), &train));
    if (result == ORL_OK)
        job->sources = orl_array(job->log, model->image_count + 1, sizeof *job->sources);
    if (result == ORL_OK && !job->sources)
        result = ORL_ERR_MEMORY;
    for (size_t i = 0; result == ORL_OK && i < model->image_count; i++) {
        struct orl_source *source = &job->sources[job->source_count++];
        source->name = orl_strdup(job->log, model->images[i].name);
        source->test = !orl_names_contain(&train, model->images[i].name);
        result = source->name ? ORL_OK : ORL_ERR_MEMORY;
    }
    orl_names_finish(&train);
    return result;
}

enum orl_result orl_job_attach(struct orl_job *job, const struct orl_log *log,
                               const struct orl_prepare_params *params,
                               const struct orl_progress *progress)
{
    bool taken = false;
    *job = (struct orl_job){.log = log, .params = params, .progress = progress, .lock_fd = -1,
                            .linear_scale = 1, .dir = realpath(params->out, NULL)};
    if (!job->dir)
        return orl_fail(log, ORL_ERR_NOT_FOUND, "%s: %s", params->out, strerror(errno));
    if (!orl_job_has(job, ".oriel"))
        return orl_fail(log, ORL_ERR_DATA, "%s: not made by oriel prepare", job->dir);
    enum orl_result result = orl_lock(log, ORL_PATH(job->dir, ".oriel/lock"), true, &job->lock_fd, &taken);
    if (result == ORL_OK && taken)
        result = orl_fail(log, ORL_ERR_ARGUMENT, "%s: oriel prepare is at work here", job->dir);
    return result;
}

void orl_job_leave(const struct orl_job *job)
{
    if (job->fresh && orl_job_remove(job, ".oriel") == ORL_OK &&
        orl_job_remove(job, "logs") == ORL_OK)
        rmdir(job->dir);
}

void orl_source_finish(struct orl_source *source)
{
    free(source->name);
    free(source->given);
    free(source->path);
    free(source->original);
    free(source->mask);
    memset(source, 0, sizeof *source);
}

void orl_job_close(struct orl_job *job)
{
    for (size_t i = 0; i < job->source_count; i++)
        orl_source_finish(&job->sources[i]);
    free(job->sources);
    orl_exposure_list_finish(&job->exposures);
    orl_colmap_finish(&job->calibrated);
    orl_colmap_finish(&job->sparse);
    json_decref(job->skipped);
    json_decref(job->stages);
    json_decref(job->programs);
    orl_gpu_destroy(&job->own_gpu);
    orl_unlock(&job->lock_fd);
    free(job->dir);
}

enum orl_result orl_job_gpu(struct orl_job *job, struct orl_gpu **gpu)
{
    const struct orl_gpu_params params = {.shader_dir = job->params->shader_dir};
    if (!job->params->gpu && !job->own_gpu)
        ORL_TRY(orl_gpu_create(job->log, &params, &job->own_gpu));
    *gpu = job->params->gpu ? job->params->gpu : job->own_gpu;
    return ORL_OK;
}

// --- files in the scene ---

bool orl_job_has(const struct orl_job *job, const char *name)
{
    return access(ORL_PATH(job->dir, "%s", name), F_OK) == 0;
}

bool orl_job_has_key(const struct orl_job *job, enum orl_stage_id stage, const char *name)
{
    uint8_t *data = NULL;
    size_t size;
    bool same = orl_file_read(NULL, ORL_PATH(job->dir, "%s", name), 64, &data, &size) == ORL_OK &&
                strcmp((const char *)data, job->keys[stage]) == 0;
    free(data);
    return same;
}

enum orl_result orl_job_write_key(const struct orl_job *job, enum orl_stage_id stage, const char *name)
{
    const char *key = job->keys[stage];
    return orl_file_write(job->log, ORL_PATH(job->dir, "%s", name), key, strlen(key));
}

enum orl_result orl_job_replace(const struct orl_job *job, const char *temp, const char *name)
{
    const char *from = ORL_PATH(job->dir, "%s", temp), *to = ORL_PATH(job->dir, "%s", name);
    ORL_TRY(orl_dir_remove(job->log, to));
    return rename(from, to) == 0 ? ORL_OK : orl_file_failed(job->log, to);
}

enum orl_result orl_job_remove(const struct orl_job *job, const char *name)
{
    return orl_dir_remove(job->log, ORL_PATH(job->dir, "%s", name));
}

enum orl_result orl_job_fresh_dir(const struct orl_job *job, const char *name)
{
    ORL_TRY(orl_job_remove(job, name));
    return orl_dir_make(job->log, ORL_PATH(job->dir, "%s", name));
}

enum orl_result orl_job_link(const struct orl_job *job, const char *target, const char *path)
{
    if (symlink(target, path) == 0)
        return ORL_OK;
    bool unknown = errno == EPERM || errno == ENOTSUP || errno == ENOSYS || errno == EINVAL;
    return unknown ? orl_file_copy(job->log, target, path) : orl_file_failed(job->log, path);
}

enum orl_result orl_job_save_stages(const struct orl_job *job)
{
    return orl_json_write(job->log, ORL_PATH(job->dir, ".oriel/stages.json"), job->stages);
}

enum orl_result orl_job_write_list(const struct orl_job *job, const char *path,
                                   const struct orl_names *names)
{
    struct orl_atomic_file file;
    ORL_TRY(orl_atomic_open(job->log, path, &file));
    for (size_t i = 0; i < names->count; i++)
        fprintf(file.stream, "%s\n", names->items[i]);
    return orl_atomic_commit(job->log, &file);
}

// Negative: unknown.
static double free_mib(const struct orl_job *job)
{
    struct statvfs fs;
    return statvfs(job->dir, &fs) == 0 ? (double)fs.f_bavail * (double)fs.f_frsize / (1 << 20) : -1;
}

enum orl_result orl_job_need_disk(const struct orl_job *job, const char *stage, double bytes)
{
    double need = bytes / (1 << 20), have = free_mib(job);
    if (have >= 0 && need > have)
        return orl_fail(job->log, ORL_ERR_IO, "%s: %s writes about %.0f MiB and the disk has %.0f "
                        "MiB left: make room and go on with --resume, or use another disk or a "
                        "smaller --max-size", job->dir, stage, need, have);
    orl_logf(job->log, need > 0.5 * have ? ORL_LOG_INFO : ORL_LOG_DEBUG,
             "%s: writes about %.0f MiB; %.0f MiB are free", stage, need, have);
    return ORL_OK;
}

void orl_job_hint_disk(const struct orl_job *job)
{
    double mib = free_mib(job);
    if (mib >= 0 && mib < 64)
        orl_logf(job->log, ORL_LOG_ERROR, "%s: its disk has only %.1f MiB left", job->dir, mib);
}

// --- photographs and their model ---

static int compare_source(const void *name, const void *source)
{
    return strcmp(name, ((const struct orl_source *)source)->name);
}

const struct orl_source *orl_job_find(const struct orl_job *job, const char *name)
{
    return job->source_count ? bsearch(name, job->sources, job->source_count,
                                       sizeof *job->sources, compare_source)
                             : NULL;
}

enum orl_exposure_source orl_source_exposure(const struct orl_job *job,
                                             const struct orl_source *source, double *ev)
{
    const struct orl_exposure_list *list = &job->exposures;
    const struct orl_listed_exposure *listed = orl_exposure_list_find(list, source->name);
    if (!listed && source->given)
        listed = orl_exposure_list_find(list, source->given);
    if (listed) {
        *ev = listed->ev;
        return ORL_EXPOSURE_LIST;
    }
    bool comparable = list->count == 0 || list->items[0].absolute;
    return comparable && orl_exif_exposure_ev(&source->exif, ev) ? ORL_EXPOSURE_EXIF : ORL_EXPOSURE_UNKNOWN;
}

static enum orl_result read_model(const struct orl_job *job, const char *name,
                                  struct orl_colmap_model *model)
{
    if (model->image_count)
        return ORL_OK;
    enum orl_result result = orl_colmap_read(job->log, ORL_PATH(job->dir, "%s", name), model);
    for (size_t i = 0; result == ORL_OK && i < model->image_count; i++)
        if (!orl_job_find(job, model->images[i].name))
            result = orl_fail(job->log, ORL_ERR_DATA, "%s/%s: photograph %s was not given",
                              job->dir, name, model->images[i].name);
    if (result != ORL_OK)
        orl_colmap_finish(model);
    return result;
}

enum orl_result orl_job_calibrated(struct orl_job *job, const struct orl_colmap_model **model)
{
    *model = &job->calibrated;
    return read_model(job, ".oriel/calibrate/model", &job->calibrated);
}

enum orl_result orl_job_sparse(struct orl_job *job, const struct orl_colmap_model **model)
{
    *model = &job->sparse;
    return read_model(job, "sparse", &job->sparse);
}

enum orl_result orl_job_open_scene(struct orl_job *job, struct orl_scene **scene)
{
    const struct orl_colmap_model *model;
    struct orl_names test = {0};
    enum orl_result result = orl_job_sparse(job, &model);
    for (size_t i = 0; result == ORL_OK && i < job->source_count; i++)
        if (job->sources[i].test)
            result = orl_names_add(job->log, &test, job->sources[i].name);
    ORL_THEN(result, orl_scene_open_unfinished(job->log, job->dir, model, &test, scene));
    orl_names_finish(&test);
    return result;
}

enum orl_result orl_job_set_sparse(struct orl_job *job, const char *name,
                                   const struct orl_colmap_model **model)
{
    orl_colmap_finish(&job->sparse);
    *model = &job->sparse;
    return read_model(job, name, &job->sparse);
}

enum orl_result orl_job_train_names(struct orl_job *job, struct orl_names *names)
{
    const struct orl_colmap_model *model;
    enum orl_result result = orl_job_sparse(job, &model);
    for (size_t i = 0; result == ORL_OK && i < model->image_count; i++)
        if (!orl_job_find(job, model->images[i].name)->test)
            result = orl_names_add(job->log, names, model->images[i].name);
    if (result != ORL_OK)
        orl_names_finish(names);
    return result;
}
