#include "preprocess/calibrate/features.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "core/memory.h"
#include "preprocess/calibrate/match.h"
#include "preprocess/job/colmap_run.h"

#define MASKS ORL_CALIBRATE_WORK "/masks"

// --- which photographs share a camera ---

static bool has_exif(const struct orl_source *s)
{
    return s->exif.make[0] || s->exif.model[0] || s->exif.focal_mm > 0 || s->exif.focal_35mm > 0;
}

static bool same_camera(const struct orl_source *a, const struct orl_source *b, bool one_size)
{
    if (a->width != b->width || a->height != b->height || has_exif(a) != has_exif(b) ||
        a->clip != b->clip)
        return false;
    if (a->clip)
        return true;
    if (!has_exif(a))
        return one_size;
    return strcmp(a->exif.make, b->exif.make) == 0 && strcmp(a->exif.model, b->exif.model) == 0 &&
           a->exif.focal_mm == b->exif.focal_mm && a->exif.focal_35mm == b->exif.focal_35mm;
}

enum orl_result orl_camera_groups_find(const struct orl_job *job,
                                       struct orl_camera_groups *groups)
{
    enum orl_camera_sharing sharing = job->params->sharing;
    *groups = (struct orl_camera_groups){
        .of = orl_array(job->log, job->source_count, sizeof *groups->of),
        .size = orl_array(job->log, job->source_count, sizeof *groups->size)};
    ORL_TRY_MEMORY(groups->of && groups->size);
    bool one_size = true;
    for (size_t i = 1; i < job->source_count; i++)
        one_size = one_size && job->sources[i].width == job->sources[0].width &&
                   job->sources[i].height == job->sources[0].height;
    if (sharing == ORL_SHARING_SINGLE && !one_size)
        return orl_fail(job->log, ORL_ERR_ARGUMENT,
                        "--camera-sharing single: the photographs have different sizes");
    for (size_t i = 0; i < job->source_count; i++) {
        int group = -1;
        for (size_t k = 0; k < i && group < 0 && sharing != ORL_SHARING_EACH; k++)
            if (sharing == ORL_SHARING_SINGLE ||
                same_camera(&job->sources[k], &job->sources[i], one_size))
                group = groups->of[k];
        groups->of[i] = group >= 0 ? group : groups->count++;
        groups->size[groups->of[i]]++;
    }
    return ORL_OK;
}

void orl_camera_groups_finish(struct orl_camera_groups *groups)
{
    free(groups->of);
    free(groups->size);
    *groups = (struct orl_camera_groups){0};
}

// --- features ---

enum orl_result orl_features_link_masks(const struct orl_job *job)
{
    if (!job->params->masks_dir)
        return ORL_OK;
    ORL_TRY(orl_job_fresh_dir(job, MASKS));
    for (size_t i = 0; i < job->source_count; i++) {
        const struct orl_source *source = &job->sources[i];
        if (source->mask)
            ORL_TRY(orl_job_link(job, source->mask, ORL_PATH(job->dir, MASKS "/%s.png", source->name)));
    }
    return ORL_OK;
}

// Larger side in pixels that features are taken at, at most, and the most features of a photograph.
static const int sizes[] = {[ORL_QUALITY_DRAFT] = 1600, [ORL_QUALITY_STANDARD] = 3200, [ORL_QUALITY_HIGH] = 3200};
static const int counts[] = {[ORL_QUALITY_DRAFT] = 4096, [ORL_QUALITY_STANDARD] = 8192, [ORL_QUALITY_HIGH] = 16384};

// Features that COLMAP extracts in one go. coarse: of large photographs, without enlarging them.
struct pass {
    const struct orl_features_run *run;
    bool coarse;
};

// Whether the photograph may have enough features without being enlarged to twice its size first.
static bool is_large(const struct orl_job *job, const struct orl_source *source)
{
    const double large = 4e6; // pixels
    double larger = source->width > source->height ? source->width : source->height;
    double scale = fmin(1, sizes[job->params->quality] / larger);
    return scale * source->width * scale * source->height >= large;
}

static void feature_settings(const struct orl_job *job, const struct pass *pass, struct orl_colmap_run *run)
{
    enum orl_quality quality = job->params->quality;
    bool costly = pass->run->costly;
    orl_colmap_arg(run, "--SiftExtraction.use_gpu", "%d", job->colmap_cuda && !costly);
    orl_colmap_arg(run, "--SiftExtraction.max_image_size", "%d", sizes[quality]);
    orl_colmap_arg(run, "--SiftExtraction.max_num_features", "%d",
                   counts[quality] * (costly ? 2 : 1));
    if (pass->coarse)
        orl_colmap_arg(run, "--SiftExtraction.first_octave", "0");
    if (costly) {
        orl_colmap_arg(run, "--SiftExtraction.estimate_affine_shape", "1");
        orl_colmap_arg(run, "--SiftExtraction.domain_size_pooling", "1");
        orl_colmap_arg(run, "--SiftExtraction.peak_threshold", "0.004");
    }
}

// Features of the photographs in `names`, which share a camera of `size` photographs in all, or have
// one each (size 1).
static enum orl_result extract(struct orl_job *job, const struct pass *pass, const struct orl_names *names,
                               int size, double done, double total)
{
    struct orl_colmap_run colmap = {.command = "feature_extractor", .step = "features", .done = done,
                                    .share = (double)names->count, .total = total};
    const char *database = pass->run->database, *list = ORL_PATH(job->dir, "%s.txt", database);
    bool normalised = orl_job_has(job, ORL_CALIBRATE_NORMALISED);
    ORL_TRY(orl_job_write_list(job, list, names));
    // More parameters need more photographs to determine them.
    bool rich = size >= 8 && job->params->quality == ORL_QUALITY_HIGH;
    orl_colmap_arg(&colmap, "--database_path", "%s/%s.db", job->dir, database);
    orl_colmap_arg(&colmap, "--image_path", "%s/%s", job->dir,
                   normalised ? ORL_CALIBRATE_NORMALISED : ".oriel/photos");
    orl_colmap_arg(&colmap, "--image_list_path", "%s", list);
    orl_colmap_arg(&colmap, "--random_seed", "%u", job->params->seed);
    orl_colmap_arg(&colmap, size > 1 ? "--ImageReader.single_camera"
                                   : "--ImageReader.single_camera_per_image", "1");
    orl_colmap_arg(&colmap, "--ImageReader.camera_model", "%s", rich ? "OPENCV" : "SIMPLE_RADIAL");
    if (job->params->masks_dir && !pass->run->whole)
        orl_colmap_arg(&colmap, "--ImageReader.mask_path", "%s/" MASKS, job->dir);
    feature_settings(job, pass, &colmap);
    return orl_job_colmap(job, &colmap);
}

// Names of the photographs of a shared camera, or of all cameras that have one photograph, that lie
// in the part; of a coarse pass the large ones. *at is the number of photographs before them in the order of cameras.
static enum orl_result collect_group(const struct orl_job *job,
                                     const struct orl_camera_groups *groups, int group, bool alone,
                                     bool coarse, size_t begin, size_t end, size_t *at,
                                     struct orl_names *names)
{
    for (size_t i = 0; i < job->source_count; i++) {
        int of = groups->of[i];
        if (alone ? groups->size[of] != 1 : of != group || groups->size[of] == 1)
            continue;
        if (*at >= begin && *at < end && (!coarse || is_large(job, &job->sources[i])))
            ORL_TRY(orl_names_add(job->log, names, job->sources[i].name));
        ++*at;
    }
    return ORL_OK;
}

// *count: photographs of the pass.
static enum orl_result extract_all(struct orl_job *job, const struct orl_camera_groups *groups,
                                   const struct pass *pass, size_t *count)
{
    const struct orl_features_run *run = pass->run;
    size_t begin = job->source_count * (size_t)run->part / (size_t)run->parts;
    size_t end = job->source_count * ((size_t)run->part + 1) / (size_t)run->parts, at = 0;
    double total = (double)(end - begin);
    enum orl_result result = ORL_OK;
    *count = 0;
    // One run a shared camera; the last one takes all that have a camera of their own.
    for (int g = 0; result == ORL_OK && g <= groups->count; g++) {
        struct orl_names names = {0};
        bool alone = g == groups->count;
        result = collect_group(job, groups, g, alone, pass->coarse, begin, end, &at, &names);
        if (result == ORL_OK && names.count)
            result = extract(job, pass, &names, alone ? 1 : groups->size[g], (double)*count, total);
        *count += names.count;
        orl_names_finish(&names);
    }
    return result;
}

static enum orl_result drop_few(const struct orl_job *job, const struct orl_features_run *run)
{
    struct orl_database *db;
    ORL_TRY(orl_database_open(job->log, ORL_PATH(job->dir, "%s.db", run->database), &db));
    enum orl_result result = orl_database_drop_features(db, counts[job->params->quality]);
    orl_database_close(&db);
    return result;
}

enum orl_result orl_features_extract(struct orl_job *job, const struct orl_camera_groups *groups,
                                     const struct orl_features_run *run)
{
    size_t count = 0;
    // COLMAP first enlarges a photograph to twice its size, which takes three quarters of the time, and keeps the features
    // of largest scale. Where the others alone are enough, the same ones remain. It passes over photographs with features.
    if (!job->colmap_cuda && !run->costly)
        ORL_TRY(extract_all(job, groups, &(struct pass){run, true}, &count));
    if (count)
        ORL_TRY(drop_few(job, run));
    ORL_TRY(extract_all(job, groups, &(struct pass){run, false}, &count));
    orl_progress_report(job->progress, "features", 1, 1, NULL);
    return ORL_OK;
}
