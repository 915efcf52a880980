#include "oriel/hdr.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "core/memory.h"
#include "hdr/internal.h"

const char *const orl_hdr_merge_names[ORL_HDR_MERGE_COUNT + 1] = {
    ORL_HDR_MERGES(ORL_ENUM_NAME)};

// What the photographs in use have.
struct range {
    double low, high; // exposures, in stops
    bool radiance;    // at least one is radiance
};

static struct range find_range(const struct orl_scene *scene, const bool *use)
{
    struct range range = {INFINITY, -INFINITY, false};
    for (size_t i = 0; i < scene->photo_count; i++) {
        const struct orl_photo *photo = &scene->photos[i];
        if (use ? !use[i] : photo->test)
            continue;
        range.low = fmin(range.low, photo->exposure_ev);
        range.high = fmax(range.high, photo->exposure_ev);
        range.radiance = range.radiance || photo->radiance;
    }
    return range;
}

enum orl_result orl_hdr_create(struct orl_gpu *gpu, const struct orl_scene *scene,
                               const struct orl_hdr_params *params, struct orl_hdr **out)
{
    const struct orl_log *log = orl_gpu_log(gpu);
    *out = NULL;
    ORL_REQUIRE(log, params->samples >= 1 && params->samples <= 4);
    struct range range = find_range(scene, params->use);
    if (range.radiance && params->merge == ORL_HDR_SERIES)
        return orl_fail(log, ORL_ERR_ARGUMENT,
                        "%s: its photographs are radiance already: use --merge fused", scene->dir);
    struct orl_hdr *hdr = orl_array(log, 1, sizeof *hdr);
    ORL_TRY_MEMORY(hdr);
    hdr->gpu = gpu;
    hdr->scene = scene;
    hdr->params = *params;
    if (!range.radiance && !(range.high - range.low > 0.5))
        orl_logf(log, ORL_LOG_WARNING,
                 "%s: the photographs have one exposure: what it clips stays clipped", scene->dir);
    struct orl_renderer_params renderer = {.use = params->use, .radiance = true,
                                           .sensor = &params->sensor,
                                           .max_vram_bytes = params->max_vram_bytes};
    enum orl_result result =
        params->merge == ORL_HDR_FUSED ? orl_renderer_create(gpu, scene, &renderer, &hdr->fused)
                                       : orl_series_init(gpu, scene, params, &hdr->series);
    if (result == ORL_OK)
        *out = hdr;
    else
        orl_hdr_destroy(&hdr);
    return result;
}

void orl_hdr_destroy(struct orl_hdr **handle)
{
    struct orl_hdr *hdr = *handle;
    if (!hdr)
        return;
    orl_renderer_destroy(&hdr->fused);
    orl_series_finish(&hdr->series);
    free(hdr);
    *handle = NULL;
}

static enum orl_result draw(struct orl_hdr *hdr, const struct orl_view *view, const bool *skip,
                            struct orl_frame *frame)
{
    if (hdr->fused)
        return orl_renderer_draw(hdr->fused, view, &hdr->params.render, skip, frame);
    return orl_series_draw(orl_gpu_log(hdr->gpu), &hdr->series, &hdr->params, view, skip, frame);
}

enum orl_result orl_hdr_draw(struct orl_hdr *hdr, const struct orl_view *view, const bool *skip,
                             struct orl_frame *frame)
{
    int samples = hdr->params.samples;
    if (samples == 1)
        return draw(hdr, view, skip, frame);
    struct orl_view large = *view;
    struct orl_frame fine = {0};
    large.camera = orl_camera_resized(&view->camera, samples * view->camera.width,
                                      samples * view->camera.height);
    memset(frame, 0, sizeof *frame);
    enum orl_result result = draw(hdr, &large, skip, &fine);
    ORL_THEN(result, orl_frame_reduce(orl_gpu_log(hdr->gpu), &fine, samples, frame));
    orl_frame_finish(&fine);
    return result;
}
