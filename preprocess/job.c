#include "preprocess/job.h"

#include <errno.h>
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/statvfs.h>
#include <unistd.h>

#include "core/memory.h"

char *orl_job_path(const struct orl_job *job, const char *format, ...)
{
    char name[4096];
    va_list args;
    va_start(args, format);
    int length = vsnprintf(name, sizeof name, format, args);
    va_end(args);
    if (length < 0 || (size_t)length >= sizeof name) {
        orl_logf(job->log, ORL_LOG_ERROR, "%s: a path is too long", job->dir);
        return NULL;
    }
    return orl_path_join(job->log, job->dir, name);
}

bool orl_job_has(const struct orl_job *job, const char *name)
{
    char *path = orl_job_path(job, "%s", name);
    bool there = path && access(path, F_OK) == 0;
    free(path);
    return there;
}

enum orl_result orl_job_replace(const struct orl_job *job, const char *temp, const char *name)
{
    char *from = orl_job_path(job, "%s", temp), *to = orl_job_path(job, "%s", name);
    enum orl_result result = from && to ? orl_dir_remove(job->log, to) : ORL_ERR_MEMORY;
    if (result == ORL_OK && rename(from, to) != 0)
        result = orl_fail(job->log, ORL_ERR_IO, "%s: %s", to, strerror(errno));
    free(from);
    free(to);
    return result;
}

enum orl_result orl_job_remove(const struct orl_job *job, const char *name)
{
    char *path = orl_job_path(job, "%s", name);
    enum orl_result result = path ? orl_dir_remove(job->log, path) : ORL_ERR_MEMORY;
    free(path);
    return result;
}

enum orl_result orl_job_fresh_dir(const struct orl_job *job, const char *name)
{
    char *path = orl_job_path(job, "%s", name);
    enum orl_result result = path ? orl_dir_remove(job->log, path) : ORL_ERR_MEMORY;
    if (result == ORL_OK)
        result = orl_dir_make(job->log, path);
    free(path);
    return result;
}

enum orl_result orl_job_link(const struct orl_job *job, const char *target, const char *path)
{
    if (symlink(target, path) != 0)
        return orl_fail(job->log, ORL_ERR_IO, "%s: %s", path, strerror(errno));
    return ORL_OK;
}

const struct orl_source *orl_job_find(const struct orl_job *job, const char *name)
{
    for (size_t i = 0; i < job->source_count; i++)
        if (strcmp(job->sources[i].name, name) == 0)
            return &job->sources[i];
    return NULL;
}

enum orl_result orl_job_registered(const struct orl_job *job, struct orl_names *train,
                                   struct orl_names *test)
{
    struct orl_colmap_model model = {0};
    char *path = orl_job_path(job, "sparse");
    enum orl_result result = path ? orl_colmap_read(job->log, path, &model) : ORL_ERR_MEMORY;
    free(path);
    for (size_t i = 0; result == ORL_OK && i < model.image_count; i++) {
        const struct orl_source *source = orl_job_find(job, model.images[i].name);
        struct orl_names *names = !source ? NULL : source->test ? test : train;
        if (!source)
            result = orl_fail(job->log, ORL_ERR_DATA, "%s: photograph %s was not given", job->dir,
                              model.images[i].name);
        else if (names)
            result = orl_names_add(job->log, names, source->name);
    }
    orl_colmap_finish(&model);
    if (result != ORL_OK) {
        orl_names_finish(train);
        orl_names_finish(test);
    }
    return result;
}

enum orl_result orl_job_write_list(const struct orl_job *job, const char *path,
                                   const struct orl_names *names)
{
    size_t size = 0;
    for (size_t i = 0; i < names->count; i++)
        size += strlen(names->items[i]) + 1;
    char *text = orl_array(job->log, size + 1, 1);
    if (!text)
        return ORL_ERR_MEMORY;
    char *at = text;
    for (size_t i = 0; i < names->count; i++)
        at += sprintf(at, "%s\n", names->items[i]);
    enum orl_result result = orl_file_write(job->log, path, text, size);
    free(text);
    return result;
}

void orl_job_hint_disk(const struct orl_job *job)
{
    struct statvfs fs;
    if (statvfs(job->dir, &fs) != 0)
        return;
    double mib = (double)fs.f_bavail * (double)fs.f_frsize / (1 << 20);
    if (mib < 64)
        orl_logf(job->log, ORL_LOG_ERROR, "%s: its disk has only %.1f MiB left", job->dir, mib);
}

int orl_job_max_size(const struct orl_prepare_params *params)
{
    static const int sizes[] = {[ORL_QUALITY_DRAFT] = 800, [ORL_QUALITY_STANDARD] = 1600,
                                [ORL_QUALITY_HIGH] = 3200};
    return params->max_size ? params->max_size : sizes[params->quality];
}
