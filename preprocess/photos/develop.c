#include "preprocess/photos/develop.h"

#include <inttypes.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>

#include "core/color.h"
#include "core/file.h"
#include "core/memory.h"
#include "core/order.h"
#include "preprocess/job/threads.h"

enum { COPY_QUALITY = 98 };

static const float light_max = 65504; // greatest half float; infinities would spread

// --- floating point photographs: choice of white ---

// log2 of the geometric mean of all pixels that are not black.
static double log_average(const struct orl_image *image)
{
    size_t count = (size_t)image->width * (size_t)image->height;
    double sum = 0, used = 0;
    for (size_t i = 0; i < count; i++) {
        float l = orl_luminance(image->f32 + 3 * i);
        if (l > 0 && isfinite(l)) {
            sum += log2((double)l);
            used++;
        }
    }
    return used > 0 ? sum / used : 0;
}

// The result is stored beside the copies, since it takes decoding the whole file.
static enum orl_result read_light(const struct orl_job *job, const struct orl_source *source,
                                  double *light)
{
    struct orl_image image = {0};
    uint8_t *text = NULL;
    size_t size = 0;
    char line[64];
    const char *path = ORL_PATH(job->dir, ".oriel/developed/%016" PRIx64 ".light", source->hash);
    bool known = orl_path_is_file(path) && orl_file_read(NULL, path, sizeof line, &text, &size) == ORL_OK &&
                 sscanf((const char *)text, "%lf", light) == 1 && isfinite(*light);
    free(text);
    if (known)
        return ORL_OK;
    ORL_TRY(orl_picture_read_linear(job->log, source->path, &image));
    *light = log_average(&image);
    orl_image_finish(&image);
    int length = snprintf(line, sizeof line, "%a\n", *light);
    return orl_file_write(job->log, path, line, (size_t)length);
}

// Chooses one factor for all photographs, so that their brightness stays comparable: the median
// picture's average becomes middle grey. A power of two is exact in half floats.
static enum orl_result choose_scale(struct orl_job *job)
{
    double *lights = orl_array(job->log, job->source_count, sizeof *lights);
    enum orl_result result = lights ? ORL_OK : ORL_ERR_MEMORY;
    size_t count = 0;
    for (size_t i = 0; i < job->source_count && result == ORL_OK; i++)
        if (job->sources[i].unbounded)
            result = read_light(job, &job->sources[i], &lights[count++]);
    job->linear_scale = 1;
    if (result == ORL_OK && count) {
        qsort(lights, count, sizeof *lights, orl_order_doubles);
        job->linear_scale = exp2(round(log2(0.18) - lights[count / 2]));
    }
    free(lights);
    return result;
}

enum orl_result orl_develop_read(const struct orl_job *job, const struct orl_source *source,
                                 struct orl_image *image)
{
    enum orl_result result = orl_picture_read_linear(
        job->log, source->original ? source->original : source->path, image);
    size_t count = result == ORL_OK ? orl_image_bytes(image) / sizeof(float) : 0;
    float scale = source->unbounded ? (float)job->linear_scale : 1;
    for (size_t i = 0; i < count; i++) { // NaN and negative light become black
        float value = scale * image->f32[i];
        image->f32[i] = value > 0 ? fminf(value, light_max) : 0;
    }
    return result;
}

// --- 8-bit copies ---

// COLMAP reads PNG of 8 bits alone, and drops colour profiles.
static bool needs_copy(const struct orl_source *source)
{
    return orl_picture_needs_copy(source->given) || source->deep || source->profiled;
}

static enum orl_result encode(const struct orl_job *job, const struct orl_source *source, double ev,
                              struct orl_image *copy)
{
    struct orl_image linear = {0};
    enum orl_result result = orl_develop_read(job, source, &linear);
    const float factor = (float)exp2(ev);
    ORL_THEN(result, orl_image_init(job->log, copy, linear.width, linear.height, 3, ORL_PIXEL_U8));
    size_t count = result == ORL_OK ? orl_image_bytes(copy) : 0;
    for (size_t i = 0; i < count; i++)
        copy->u8[i] = (uint8_t)lrintf(255 * orl_srgb_encode(factor * linear.f32[i]));
    orl_image_finish(&linear);
    return result;
}

enum orl_result orl_develop_write(const struct orl_job *job, const struct orl_source *source, double ev,
                                  const char *path)
{
    struct orl_image copy = {0};
    // Reading a photograph of 8 bits as such takes a tenth of the time of going by light.
    enum orl_result result = ev == 0 && !source->unbounded ? orl_picture_read(job->log, source->path, 3, &copy)
                                                           : encode(job, source, ev, &copy);
    ORL_THEN(result, orl_picture_is_png(source->name)
                         ? orl_png_write(job->log, path, &copy)
                         : orl_jpeg_write(job->log, path, &copy, COPY_QUALITY, &source->exif));
    orl_image_finish(&copy);
    return result;
}

static enum orl_result develop(void *priv, size_t item)
{
    const struct orl_job *job = priv;
    struct orl_source *source = &job->sources[item];
    if (!needs_copy(source))
        return ORL_OK;
    char end[64];
    snprintf(end, sizeof end, "%s", orl_picture_is_png(source->name) ? ".png" : ".jpg");
    if (source->unbounded)
        snprintf(end, sizeof end, ".%d.jpg", (int)log2(job->linear_scale));
    const char *path = ORL_PATH(job->dir, ".oriel/developed/%016" PRIx64 "%s", source->hash, end);
    if (!orl_path_is_file(path))
        ORL_TRY(orl_develop_write(job, source, 0, path));
    char *copy = orl_strdup(job->log, path);
    ORL_TRY_MEMORY(copy);
    source->original = source->path;
    source->path = copy;
    return ORL_OK;
}

size_t orl_develop_at_once(const struct orl_job *job)
{
    // Bytes of a pixel while it is decoded and becomes one of 8 bits. RAW takes most (io/raw.c).
    enum { DEEP = 31, EIGHT = 8 };
    double most = 1;
    for (size_t i = 0; i < job->source_count; i++) {
        const struct orl_source *source = &job->sources[i];
        int bytes = orl_picture_needs_copy(source->given) || source->deep ? DEEP : EIGHT;
        most = fmax(most, (double)bytes * source->width * source->height);
    }
    double count = 0.5 * (double)orl_memory_available() / most;
    return count < 1 ? 1 : count < (double)job->source_count ? (size_t)count : job->source_count;
}

enum orl_result orl_develop(struct orl_job *job)
{
    size_t count = 0;
    for (size_t i = 0; i < job->source_count; i++)
        count += needs_copy(&job->sources[i]);
    if (!count)
        return ORL_OK;
    ORL_TRY(orl_dir_make(job->log, ORL_PATH(job->dir, ".oriel/developed")));
    ORL_TRY(choose_scale(job));
    ORL_TRY(orl_threads_each(&(struct orl_each){.work = develop, .priv = job, .count = job->source_count,
                                                .threads = orl_develop_at_once(job), .progress = job->progress,
                                                .step = "develop", .share = 1, .total = 1}));
    orl_progress_report(job->progress, "develop", 1, 1, NULL);
    return ORL_OK;
}
