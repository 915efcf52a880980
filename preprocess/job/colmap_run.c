#include "preprocess/job/colmap_run.h"

#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "core/process.h"

// Qt would look for a display without this variable.
static const char *const env[] = {"QT_QPA_PLATFORM=offscreen", NULL};

void orl_colmap_arg(struct orl_colmap_run *run, const char *name, const char *format, ...)
{
    size_t room = sizeof run->text - run->used;
    va_list list;
    va_start(list, format);
    int length = vsnprintf(run->text + run->used, room, format, list);
    va_end(list);
    if (length < 0 || (size_t)length >= room || run->arg_count + 2 > ORL_COLMAP_ARGS_MAX) {
        run->failed = true;
        return;
    }
    run->args[run->arg_count++] = name;
    run->args[run->arg_count++] = run->text + run->used;
    run->used += (size_t)length + 1;
}

double orl_colmap_line_progress(const char *line, double total)
{
    unsigned a, b;
    if (sscanf(line, "Registering image #%u (%u)", &a, &b) == 2 && total > 0)
        return b / total;
    bool counted = sscanf(line, "Processed file [%u/%u]", &a, &b) == 2 ||
                   sscanf(line, "Matching block [%u/%u]", &a, &b) == 2 ||
                   sscanf(line, "Undistorting image [%u/%u]", &a, &b) == 2 ||
                   sscanf(line, "Processing view %u / %u", &a, &b) == 2;
    if (counted && b)
        return (double)a / b;
    return -1;
}

// Options that COLMAP 4 calls by another name, for features of any kind and for seeds.
static const char *current_name(const struct orl_job *job, const char *name)
{
    static const char *const renamed[][2] = {
        {"--SiftExtraction.use_gpu", "--FeatureExtraction.use_gpu"},
        {"--SiftExtraction.max_image_size", "--FeatureExtraction.max_image_size"},
        {"--SiftExtraction.num_threads", "--FeatureExtraction.num_threads"},
        {"--SiftMatching.use_gpu", "--FeatureMatching.use_gpu"},
        {"--SiftMatching.guided_matching", "--FeatureMatching.guided_matching"},
    };
    for (size_t i = 0; job->colmap_features && i < ORL_COUNT(renamed); i++)
        if (strcmp(name, renamed[i][0]) == 0)
            return renamed[i][1];
    return job->colmap_seed && strcmp(name, "--random_seed") == 0 ? "--default_random_seed" : name;
}

struct watch {
    const struct orl_job *job;
    const struct orl_colmap_run *run;
    bool tolerated;
    char error[4096]; // held back until it is clear whether the failure is tolerated
};

static void hold_error(void *priv, enum orl_log_level level, const char *message)
{
    struct watch *watch = priv;
    if (level == ORL_LOG_ERROR)
        snprintf(watch->error, sizeof watch->error, "%s", message);
}

static void watch_line(void *priv, const char *line)
{
    struct watch *watch = priv;
    const struct orl_colmap_run *run = watch->run;
    for (size_t i = 0; i < sizeof run->tolerated / sizeof *run->tolerated; i++)
        if (run->tolerated[i] && strstr(line, run->tolerated[i]))
            watch->tolerated = true;
    double part = orl_colmap_line_progress(line, run->share);
    if (part < 0)
        return;
    double done = run->done + run->share * (part < 1 ? part : 1);
    // Only the callers of orl_job_colmap know when a step is complete.
    double limit = 0.999 * run->total;
    orl_progress_report(watch->job->progress, run->step, done < limit ? done : limit, run->total,
                        NULL);
}

static enum orl_result advise_missing(const struct orl_job *job)
{
    return orl_fail(job->log, ORL_ERR_EXTERNAL,
                    "COLMAP is needed: install it (Debian: apt install colmap) or name its "
                    "program in ORIEL_COLMAP");
}

static void add_usage(struct orl_job *job, const char *command,
                      const struct orl_process_usage *usage)
{
    job->child_cpu_s += usage->cpu_s;
    if (usage->peak_rss_bytes > job->child_peak_bytes)
        job->child_peak_bytes = usage->peak_rss_bytes;
    char key[64];
    snprintf(key, sizeof key, "%s_s", command);
    double before = json_number_value(json_object_get(job->programs, key));
    if (job->programs)
        json_object_set_new(job->programs, key, json_real(before + usage->cpu_s));
}

enum orl_result orl_job_colmap(struct orl_job *job, struct orl_colmap_run *run)
{
    const char *argv[ORL_COLMAP_ARGS_MAX + 3] = {job->colmap, run->command};
    if (run->failed)
        return orl_fail(job->log, ORL_ERR_MEMORY, "COLMAP %s: arguments too long, or no memory for them",
                        run->command);
    if (!run->total)
        run->share = run->total = 1;
    for (size_t i = 0; i < run->arg_count; i++)
        argv[2 + i] = i % 2 ? run->args[i] : current_name(job, run->args[i]);
    const char *log_path = ORL_PATH(job->dir, "logs/colmap.log");
    struct watch watch = {.job = job, .run = run};
    struct orl_log held = {.level = ORL_LOG_ERROR, .print = hold_error, .priv = &watch};
    struct orl_process_params params = {.argv = argv, .log_path = log_path,
                                        .progress = job->progress, .line = watch_line,
                                        .line_priv = &watch, .env = env};
    struct orl_process_usage usage = {0};
    if (run->done == 0)
        orl_progress_report(job->progress, run->step, 0, run->total, NULL);
    enum orl_result result = orl_process_run(&held, &params, &usage);
    if (result == ORL_ERR_EXTERNAL && watch.tolerated)
        result = ORL_OK;
    else if (watch.error[0])
        orl_logf(job->log, ORL_LOG_ERROR, "%s", watch.error);
    add_usage(job, run->command, &usage);
    if (result == ORL_ERR_NOT_FOUND) {
        result = advise_missing(job);
    } else if (result == ORL_ERR_EXTERNAL) {
        if (job->lock_fd >= 0) // else it is an import's, which is removed when it fails
            orl_logf(job->log, ORL_LOG_ERROR, "all of COLMAP's output is in %s", log_path);
        orl_job_hint_disk(job);
    }
    return result;
}

static void find_version(void *priv, const char *line)
{
    struct orl_job *job = priv;
    if (strncmp(line, "COLMAP ", 7) == 0 && !job->colmap_version[0])
        snprintf(job->colmap_version, sizeof job->colmap_version, "%.*s",
                 (int)strcspn(line + 7, " "), line + 7);
    if (strstr(line, "with CUDA"))
        job->colmap_cuda = true;
    if (strstr(line, "global_mapper"))
        job->colmap_global = true;
}

static void find_options(void *priv, const char *line)
{
    struct orl_job *job = priv;
    job->colmap_features |= strstr(line, "--FeatureExtraction.use_gpu") != NULL;
    job->colmap_seed |= strstr(line, "--default_random_seed") != NULL;
}

enum orl_result orl_job_find_colmap(struct orl_job *job)
{
    if (job->colmap_known)
        return ORL_OK;
    const char *chosen = getenv("ORIEL_COLMAP");
    job->colmap = chosen && *chosen ? chosen : "colmap";
    const char *const argv[] = {job->colmap, "help", NULL};
    const char *const options[] = {job->colmap, "feature_extractor", "--help", NULL};
    struct orl_process_params params = {.argv = argv, .progress = job->progress,
                                        .line = find_version, .line_priv = job, .env = env};
    enum orl_result result = orl_process_run(job->log, &params, NULL);
    if (result == ORL_ERR_NOT_FOUND)
        return advise_missing(job);
    ORL_TRY(result);
    // Some builds end this help with a status of failure; what it printed counts.
    params.argv = options;
    params.line = find_options;
    if (orl_process_run(NULL, &params, NULL) == ORL_ERR_CANCELLED)
        return ORL_ERR_CANCELLED;
    job->colmap_known = true;
    orl_logf(job->log, ORL_LOG_DEBUG, "COLMAP %s, %s CUDA", job->colmap_version,
             job->colmap_cuda ? "with" : "without");
    return ORL_OK;
}
