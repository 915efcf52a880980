#include "compare.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "core/file.h"
#include "core/memory.h"
#include "io/exr.h"

bool golden_compare(const struct orl_image *actual, const struct orl_image *expected,
                    const struct golden_tolerance *tolerance, struct golden_report *report)
{
    memset(report, 0, sizeof *report);
    if (actual->width != expected->width || actual->height != expected->height ||
        actual->channels != expected->channels || actual->type != ORL_PIXEL_F32 ||
        expected->type != ORL_PIXEL_F32)
        return false;
    report->pixels = (size_t)actual->width * (size_t)actual->height;
    size_t channels = (size_t)actual->channels;
    bool finite = true;
    for (size_t i = 0; i < report->pixels; i++) {
        bool agrees = true;
        for (size_t c = 0; c < channels; c++) {
            double a = actual->f32[i * channels + c], e = expected->f32[i * channels + c];
            double difference = isfinite(a) && isfinite(e) ? fabs(a - e) : INFINITY;
            finite = finite && isfinite(difference);
            agrees = agrees && difference <= tolerance->absolute + tolerance->relative * fabs(e);
            if (difference > report->worst) {
                report->worst = difference;
                report->x = (int)(i % (size_t)actual->width);
                report->y = (int)(i / (size_t)actual->width);
            }
        }
        report->wrong += !agrees;
    }
    return finite && (double)report->wrong <= tolerance->fraction * (double)report->pixels &&
           (tolerance->outlier <= 0 || report->worst <= tolerance->outlier);
}

static bool write_exr(const char *dir, const char *name, const char *kind,
                      const char *const *channels, const struct orl_image *image)
{
    struct orl_log log = orl_log_stderr(ORL_LOG_WARNING);
    struct orl_exr_params params = {.width = image->width, .height = image->height,
                                    .channel_count = image->channels};
    for (int c = 0; c < image->channels; c++) {
        struct orl_exr_channel *channel = &params.channels[c];
        snprintf(channel->name, sizeof channel->name, "%s", channels[c]);
        channel->data = image->f32 + c;
        channel->stride = (size_t)image->channels;
    }
    char *path = orl_format(&log, "%s/%s%s.exr", dir, name, kind);
    bool ok = path && orl_dir_make(&log, dir) == ORL_OK &&
              orl_exr_write(&log, path, &params) == ORL_OK;
    if (ok)
        fprintf(stderr, "wrote %s\n", path);
    free(path);
    return ok;
}

static void write_failure(const char *out_dir, const char *name, const char *const *channels,
                          const struct orl_image *actual, const struct orl_image *expected)
{
    write_exr(out_dir, name, ".actual", channels, actual);
    struct orl_image diff = {0};
    if (expected->width != actual->width || expected->height != actual->height ||
        orl_image_init(NULL, &diff, actual->width, actual->height, actual->channels,
                       ORL_PIXEL_F32) != ORL_OK)
        return;
    size_t samples = orl_image_bytes(&diff) / sizeof *diff.f32;
    for (size_t i = 0; i < samples; i++)
        diff.f32[i] = fabsf(actual->f32[i] - expected->f32[i]);
    write_exr(out_dir, name, ".diff", channels, &diff);
    orl_image_finish(&diff);
}

static bool read_golden(const char *dir, const char *name, const char *driver,
                        const char *const *channels, int count, struct orl_image *image)
{
    struct orl_log log = orl_log_stderr(ORL_LOG_WARNING);
    char *own = orl_format(&log, "%s/%s.%s.exr", dir, name, driver);
    char *common = orl_format(&log, "%s/%s.exr", dir, name);
    bool ok = own && common &&
              orl_exr_read(&log, orl_path_is_file(own) ? own : common, channels, count, image) ==
                  ORL_OK;
    free(own);
    free(common);
    return ok;
}

bool golden_check(const char *dir, const char *out_dir, const char *name, const char *driver,
                  const char *const *channels, const struct orl_image *actual,
                  const struct golden_tolerance *tolerance)
{
    const char *update = getenv("ORIEL_UPDATE_GOLDEN");
    if (update && strcmp(update, "1") == 0)
        return write_exr(dir, name, "", channels, actual);
    struct orl_image expected;
    struct golden_report report;
    if (!read_golden(dir, name, driver, channels, actual->channels, &expected))
        return false;
    bool ok = golden_compare(actual, &expected, tolerance, &report);
    if (!ok) {
        fprintf(stderr, "%s: %zu of %zu pixels differ, worst by %g at (%d, %d); "
                        "ORIEL_UPDATE_GOLDEN=1 accepts the new picture\n",
                name, report.wrong, report.pixels, report.worst, report.x, report.y);
        write_failure(out_dir, name, channels, actual, &expected);
    }
    orl_image_finish(&expected);
    return ok;
}
