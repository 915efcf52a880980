#include "oriel/hdr.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "bridge/bridge.h"
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

// --- supersampled frames ---

// Takes the median, since a mean of two depths at an edge would lie on neither surface.
static void reduce_depth(const struct orl_image *fine, int factor, struct orl_image *out)
{
    float found[16];
    for (int y = 0; y < out->height; y++)
        for (int x = 0; x < out->width; x++) {
            int count = 0;
            for (int k = 0; k < factor * factor; k++) {
                float z = fine->f32[(size_t)(y * factor + k / factor) * (size_t)fine->width +
                                    (size_t)(x * factor + k % factor)];
                int at = count;
                if (!(z > 0))
                    continue;
                for (; at > 0 && found[at - 1] > z; at--)
                    found[at] = found[at - 1];
                found[at] = z;
                count++;
            }
            out->f32[(size_t)y * (size_t)out->width + (size_t)x] =
                count ? found[(count - 1) / 2] : 0;
        }
}

static void normalize(struct orl_image *normals)
{
    size_t count = (size_t)normals->width * (size_t)normals->height;
    for (size_t i = 0; i < count; i++) {
        float *n = normals->f32 + 3 * i;
        float length = sqrtf(n[0] * n[0] + n[1] * n[1] + n[2] * n[2]);
        for (int c = 0; c < 3 && length > 0; c++)
            n[c] /= length;
    }
}

// Averages factor x factor pixels; the images of `fine` are that many times as large. Depth is the
// median of the pixels that have one. Normals keep their length.
static enum orl_result reduce(const struct orl_log *log, const struct orl_frame *fine, int factor,
                              struct orl_frame *frame)
{
    const int width = fine->color.width / factor, height = fine->color.height / factor;
    ORL_TRY(orl_bridge_resize(log, &fine->color, width, height, &frame->color));
    ORL_TRY(orl_bridge_resize(log, &fine->normal, width, height, &frame->normal));
    ORL_TRY(orl_bridge_resize(log, &fine->coverage, width, height, &frame->coverage));
    ORL_TRY(orl_bridge_resize(log, &fine->confidence, width, height, &frame->confidence));
    ORL_TRY(orl_image_init(log, &frame->depth, width, height, 1, ORL_PIXEL_F32));
    reduce_depth(&fine->depth, factor, &frame->depth);
    normalize(&frame->normal);
    return ORL_OK;
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
    ORL_THEN(result, reduce(orl_gpu_log(hdr->gpu), &fine, samples, frame));
    orl_frame_finish(&fine);
    if (result != ORL_OK)
        orl_frame_finish(frame);
    return result;
}
