#include "scene/radius_limits.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "core/memory.h"
#include "scene/depth_buffer.h"

// Sizes that agree in the upper bits of their float32 are counted together: to one part in 2048.
enum { SIZE_SHIFT = 12, SIZE_COUNT = 1 << (31 - SIZE_SHIFT) };

struct orl_radii_limits orl_radii_limits_of(const struct orl_radii_params *params)
{
    const struct orl_radii_params usual = {ORL_RADII_DEFAULTS};
    const struct orl_radii_limits dense = {ORL_RADII_LIMITS_DENSE};
    struct orl_radii_limits limits = {ORL_RADII_LIMITS_DEFAULTS};
    if (params->dense)
        limits = dense;
    float scale = params->overlap / usual.overlap *
                  sqrtf((float)params->neighbours / (float)usual.neighbours);
    limits.largest_px *= scale;
    limits.isolated_px *= scale;
    return limits;
}

// --- sizes ---

enum orl_result orl_disc_sizes_init(const struct orl_log *log, struct orl_disc_sizes *sizes)
{
    *sizes = (struct orl_disc_sizes){.counts = orl_array(log, SIZE_COUNT, sizeof *sizes->counts)};
    return sizes->counts ? ORL_OK : ORL_ERR_MEMORY;
}

void orl_disc_sizes_finish(struct orl_disc_sizes *sizes)
{
    free(sizes->counts);
    *sizes = (struct orl_disc_sizes){0};
}

static float finest_scale(const struct orl_view *views, size_t view_count, const float p[3])
{
    double finest = 0;
    for (size_t i = 0; i < view_count; i++) {
        double pixel[2], depth;
        if (orl_point_project(&views[i], p, pixel, &depth))
            finest = fmax(finest, views[i].camera.fx / depth);
    }
    return (float)fmin(finest, (double)HUGE_VALF);
}

void orl_disc_sizes_add(struct orl_disc_sizes *sizes, const struct orl_view *views,
                        size_t view_count, const struct orl_points *points, float *scales)
{
    for (size_t i = 0; i < points->count; i++) {
        uint32_t bits;
        scales[i] = finest_scale(views, view_count, points->position[i]);
        float size = scales[i] * points->radius[i];
        if (!(size > 0)) // seen by none
            continue;
        memcpy(&bits, &size, sizeof bits);
        sizes->counts[bits >> SIZE_SHIFT]++;
        sizes->total++;
    }
}

static double median(const struct orl_disc_sizes *sizes)
{
    uint64_t below = 0;
    uint32_t at = 0;
    float size;
    while (at + 1 < SIZE_COUNT && below + sizes->counts[at] <= sizes->total / 2)
        below += sizes->counts[at++];
    uint32_t bits = at << SIZE_SHIFT | 1u << (SIZE_SHIFT - 1); // the middle of what counts as one
    memcpy(&size, &bits, sizeof size);
    return sizes->total && isfinite(size) ? (double)size : 0;
}

// --- limits ---

struct orl_radii_limits orl_radii_limits_widened(const struct orl_radii_limits *limits,
                                                 const struct orl_disc_sizes *sizes)
{
    double wider = fmax(1, (double)limits->typical * median(sizes) / (double)limits->largest_px);
    return (struct orl_radii_limits){.largest_px = (float)(wider * (double)limits->largest_px),
                                     .isolated_px = (float)(wider * (double)limits->isolated_px),
                                     .typical = limits->typical};
}

void orl_points_apply_limits(const struct orl_radii_limits *limits, const float *scales,
                             struct orl_points *points)
{
    size_t kept = 0;
    for (size_t i = 0; i < points->count; i++) {
        float size_px = scales[i] * points->radius[i];
        if (size_px > limits->isolated_px)
            continue;
        if (size_px > limits->largest_px)
            points->radius[i] = limits->largest_px / scales[i];
        orl_points_copy(points, i, points, kept++);
    }
    points->count = kept;
}

enum orl_result orl_points_limit_radii(const struct orl_log *log,
                                       const struct orl_radii_limits *limits,
                                       const struct orl_view *views, size_t view_count,
                                       struct orl_points *points)
{
    ORL_REQUIRE(log, limits->largest_px > 0 && limits->isolated_px >= limits->largest_px);
    struct orl_disc_sizes sizes;
    size_t all = points->count;
    float *scales = orl_array(log, all, sizeof *scales);
    enum orl_result result = orl_disc_sizes_init(log, &sizes);
    if (result == ORL_OK && !scales)
        result = ORL_ERR_MEMORY;
    if (result == ORL_OK) {
        orl_disc_sizes_add(&sizes, views, view_count, points, scales);
        const struct orl_radii_limits widened = orl_radii_limits_widened(limits, &sizes);
        orl_points_apply_limits(&widened, scales, points);
    }
    free(scales);
    orl_disc_sizes_finish(&sizes);
    if (points->count < all)
        orl_logf(log, ORL_LOG_INFO, "%zu of %zu points stand alone: dropped", all - points->count,
                 all);
    return result;
}

enum orl_result orl_points_find_radii(const struct orl_log *log, const struct orl_progress *progress,
                                      const struct orl_radii_params *params, const struct orl_view *views,
                                      size_t view_count, struct orl_points *points)
{
    const struct orl_radii_limits limits = orl_radii_limits_of(params);
    ORL_TRY(orl_points_set_radii(log, progress, params, views, view_count, points));
    return orl_points_limit_radii(log, &limits, views, view_count, points);
}
