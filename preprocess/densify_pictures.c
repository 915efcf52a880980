// Photographs as luma pyramids, and clean-up of finished maps.
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "core/memory.h"
#include "io/picture.h"
#include "preprocess/densify_internal.h"

static enum orl_result halve(const struct orl_log *log, const struct orl_image *fine,
                             struct orl_image *coarse)
{
    enum orl_result result = orl_image_init(log, coarse, fine->width / 2, fine->height / 2, 1,
                                            ORL_PIXEL_U8);
    if (result != ORL_OK)
        return result;
    size_t stride = (size_t)fine->width;
    for (int y = 0; y < coarse->height; y++) {
        const uint8_t *row = fine->u8 + 2 * (size_t)y * stride;
        uint8_t *out = coarse->u8 + (size_t)y * (size_t)coarse->width;
        for (int x = 0; x < coarse->width; x++, row += 2)
            out[x] = (uint8_t)((row[0] + row[1] + row[stride] + row[stride + 1] + 2) / 4);
    }
    return ORL_OK;
}

enum orl_result densify_pyramid_read(const struct orl_log *log, const char *path,
                                     const struct orl_camera *camera, int levels,
                                     struct densify_pyramid *pyramid)
{
    memset(pyramid, 0, sizeof *pyramid);
    enum orl_result result = orl_picture_read(log, path, 1, &pyramid->levels[0]);
    if (result != ORL_OK)
        return result;
    const struct orl_image *picture = &pyramid->levels[0];
    pyramid->camera = orl_camera_resized(camera, picture->width, picture->height);
    pyramid->count = 1;
    while (pyramid->count < levels && pyramid->count < DENSIFY_LEVELS_MAX &&
           pyramid->levels[pyramid->count - 1].width >= 4 &&
           pyramid->levels[pyramid->count - 1].height >= 4) {
        result = halve(log, &pyramid->levels[pyramid->count - 1], &pyramid->levels[pyramid->count]);
        if (result != ORL_OK) {
            densify_pyramid_finish(pyramid);
            return result;
        }
        pyramid->count++;
    }
    return ORL_OK;
}

void densify_pyramid_finish(struct densify_pyramid *pyramid)
{
    for (int i = 0; i < pyramid->count; i++)
        orl_image_finish(&pyramid->levels[i]);
    memset(pyramid, 0, sizeof *pyramid);
}

struct orl_camera densify_level_camera(const struct orl_camera *camera, int level)
{
    double scale = 1.0 / (double)(1 << level);
    return (struct orl_camera){.width = camera->width >> level,
                               .height = camera->height >> level,
                               .fx = camera->fx * scale,
                               .fy = camera->fy * scale,
                               .cx = camera->cx * scale,
                               .cy = camera->cy * scale};
}

void densify_maps_finish(struct densify_maps *maps)
{
    orl_image_finish(&maps->depth);
    orl_image_finish(&maps->normal);
}

// --- speckles ---

struct flood {
    const float *depth;
    uint8_t *seen;
    size_t *queue;
    int width, height;
    float tolerance;
};

static bool connected(float a, float b, float tolerance)
{
    return b > 0.0f && fabsf(a - b) < tolerance * fminf(a, b);
}

// Queues the piece that holds `start`; returns its size.
static size_t flood_from(struct flood *flood, size_t start)
{
    size_t count = 0, width = (size_t)flood->width;
    flood->queue[count++] = start;
    flood->seen[start] = 1;
    for (size_t i = 0; i < count; i++) {
        size_t at = flood->queue[i], x = at % width, y = at / width;
        size_t near[4] = {at - 1, at + 1, at - width, at + width};
        bool there[4] = {x > 0, x + 1 < width, y > 0, y + 1 < (size_t)flood->height};
        for (int k = 0; k < 4; k++) {
            if (!there[k] || flood->seen[near[k]] ||
                !connected(flood->depth[at], flood->depth[near[k]], flood->tolerance))
                continue;
            flood->seen[near[k]] = 1;
            flood->queue[count++] = near[k];
        }
    }
    return count;
}

enum orl_result densify_remove_speckles(const struct orl_log *log, struct densify_maps *maps,
                                        size_t least, float tolerance)
{
    size_t count = (size_t)maps->depth.width * (size_t)maps->depth.height;
    struct flood flood = {.depth = maps->depth.f32, .width = maps->depth.width,
                          .height = maps->depth.height, .tolerance = tolerance};
    enum orl_result result = ORL_ERR_MEMORY;
    flood.seen = orl_array(log, count, sizeof *flood.seen);
    flood.queue = orl_array(log, count, sizeof *flood.queue);
    if (!flood.seen || !flood.queue)
        goto end;
    for (size_t start = 0; start < count; start++) {
        if (flood.seen[start] || !(flood.depth[start] > 0.0f))
            continue;
        size_t piece = flood_from(&flood, start);
        for (size_t i = 0; piece < least && i < piece; i++) {
            maps->depth.f32[flood.queue[i]] = 0.0f;
            memset(&maps->normal.f32[3 * flood.queue[i]], 0, 3 * sizeof(float));
        }
    }
    result = ORL_OK;
end:
    free(flood.seen);
    free(flood.queue);
    return result;
}
