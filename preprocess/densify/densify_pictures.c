// Photographs as luma pyramids, decoded once while memory lasts, and clean-up of finished maps.
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "bridge/bridge.h"
#include "core/memory.h"
#include "io/picture.h"
#include "preprocess/densify/densify_internal.h"

static enum orl_result halve(const struct orl_log *log, const struct orl_image *fine,
                             struct orl_image *coarse)
{
    ORL_TRY(orl_image_init(log, coarse, fine->width / 2, fine->height / 2, 1, ORL_PIXEL_U8));
    size_t stride = (size_t)fine->width;
    for (int y = 0; y < coarse->height; y++) {
        const uint8_t *row = fine->u8 + 2 * (size_t)y * stride;
        uint8_t *out = coarse->u8 + (size_t)y * (size_t)coarse->width;
        for (int x = 0; x < coarse->width; x++, row += 2)
            out[x] = (uint8_t)((row[0] + row[1] + row[stride] + row[stride + 1] + 2) / 4);
    }
    return ORL_OK;
}

int orl_densify_side(int side, int shrink)
{
    return side >> shrink << shrink;
}

static enum orl_result read_whole(const struct orl_log *log, const char *path, int shrink,
                                  struct orl_image *picture)
{
    struct orl_image stored = {0};
    ORL_TRY(orl_picture_read(log, path, 1, &stored));
    int width = orl_densify_side(stored.width, shrink), height = orl_densify_side(stored.height, shrink);
    if (width == stored.width && height == stored.height) {
        *picture = stored;
        return ORL_OK;
    }
    enum orl_result result = orl_bridge_resize(log, &stored, width, height, picture);
    orl_image_finish(&stored);
    return result;
}

// `pyramid` is zeroed. On success and failure alike, the caller must call orl_densify_pyramid_finish.
static enum orl_result read_pyramid(const struct orl_log *log, const char *path, int shrink,
                                    const struct orl_camera *camera,
                                    struct densify_pyramid *pyramid)
{
    ORL_TRY(read_whole(log, path, shrink, &pyramid->levels[0]));
    const struct orl_image *picture = &pyramid->levels[0];
    pyramid->camera = orl_camera_resized(camera, picture->width, picture->height);
    pyramid->count = 1;
    for (; pyramid->count < DENSIFY_LEVELS_MAX && picture->width >= 4 && picture->height >= 4; picture++)
        ORL_TRY(halve(log, picture, &pyramid->levels[pyramid->count++]));
    return ORL_OK;
}

void orl_densify_pyramid_finish(struct densify_pyramid *pyramid)
{
    for (int i = 0; i < pyramid->count; i++)
        orl_image_finish(&pyramid->levels[i]);
    memset(pyramid, 0, sizeof *pyramid);
}

struct orl_camera orl_densify_level_camera(const struct orl_camera *camera, int level)
{
    double scale = 1.0 / (double)(1 << level);
    return (struct orl_camera){.width = camera->width >> level,
                               .height = camera->height >> level,
                               .fx = camera->fx * scale,
                               .fy = camera->fy * scale,
                               .cx = camera->cx * scale,
                               .cy = camera->cy * scale};
}

enum orl_result orl_densify_maps_init(const struct orl_log *log, int width, int height,
                                      struct densify_maps *maps)
{
    ORL_TRY(orl_image_init(log, &maps->depth, width, height, 1, ORL_PIXEL_F32));
    ORL_TRY(orl_image_init(log, &maps->normal, width, height, 3, ORL_PIXEL_F32));
    return orl_image_init(log, &maps->confidence, width, height, 1, ORL_PIXEL_F32);
}

void orl_densify_maps_finish(struct densify_maps *maps)
{
    orl_image_finish(&maps->depth);
    orl_image_finish(&maps->normal);
    orl_image_finish(&maps->confidence);
}

// --- decoded photographs: each is the source of several, and serves every pass ---

// Above this size, only the pyramids of the current photograph are kept.
static const size_t BYTES_MAX = (size_t)256 << 20;

struct densify_cache_entry {
    struct densify_pyramid pyramid; // count 0: not loaded
    uint64_t turn;                  // turn of the last request
};

void orl_densify_cache_finish(struct densify_cache *cache)
{
    for (size_t i = 0; cache->entries && i < cache->photos->count; i++)
        orl_densify_pyramid_finish(&cache->entries[i].pyramid);
    free(cache->entries);
    cache->entries = NULL;
}

static size_t pyramid_bytes(const struct densify_pyramid *pyramid)
{
    size_t bytes = 0;
    for (int i = 0; i < pyramid->count; i++)
        bytes += (size_t)pyramid->levels[i].width * (size_t)pyramid->levels[i].height;
    return bytes;
}

// Drops the least recently used pyramids until the rest fits, but none of the current turn.
static void make_room(struct densify_cache *cache)
{
    while (cache->bytes > BYTES_MAX) {
        struct densify_cache_entry *oldest = NULL;
        for (size_t i = 0; i < cache->photos->count; i++) {
            struct densify_cache_entry *entry = &cache->entries[i];
            if (entry->pyramid.count && entry->turn < cache->turn &&
                (!oldest || entry->turn < oldest->turn))
                oldest = entry;
        }
        if (!oldest)
            return;
        cache->bytes -= pyramid_bytes(&oldest->pyramid);
        orl_densify_pyramid_finish(&oldest->pyramid);
    }
}

enum orl_result orl_densify_cache_get(struct densify_cache *cache, size_t photo,
                                      const struct densify_pyramid **pyramid)
{
    if (!cache->entries)
        cache->entries = orl_array(cache->log, cache->photos->count, sizeof *cache->entries);
    ORL_TRY_MEMORY(cache->entries);
    struct densify_cache_entry *entry = &cache->entries[photo];
    if (!entry->pyramid.count) {
        ORL_TRY(read_pyramid(
            cache->log, ORL_PATH(cache->images_dir, "%s", densify_photo_name(cache->photos, photo)),
            cache->shrink, &cache->photos->views[photo].camera, &entry->pyramid));
        cache->bytes += pyramid_bytes(&entry->pyramid);
    }
    entry->turn = cache->turn;
    *pyramid = &entry->pyramid;
    make_room(cache);
    return ORL_OK;
}

// --- speckles ---

enum { REACH = 2 }; // greatest step within a piece, pixels: pinholes do not cut it
static const float TOLERANCE = 0.01f;

struct flood {
    const struct densify_maps *maps;
    const struct orl_camera *camera;
    uint8_t *seen;
    size_t *queue;
};

// True when a pixel is off the other's plane by less than TOLERANCE of its depth. Depths alone
// are too strict: on ground seen at a grazing angle they differ by several percent from row to row.
static bool connected(const struct flood *flood, size_t from, size_t to)
{
    const struct orl_camera *c = flood->camera;
    const float *depth = flood->maps->depth.f32, *n = &flood->maps->normal.f32[3 * from];
    size_t width = (size_t)flood->maps->depth.width;
    float off = 0.0f, point[2][3];
    for (int k = 0; k < 2; k++) {
        size_t at = k ? to : from;
        float z = depth[at];
        point[k][0] = z * (float)(((double)(at % width) + 0.5 - c->cx) / c->fx);
        point[k][1] = z * (float)(((double)(at / width) + 0.5 - c->cy) / c->fy);
        point[k][2] = z;
    }
    for (int i = 0; i < 3; i++)
        off += n[i] * (point[1][i] - point[0][i]);
    return depth[to] > 0.0f && fabsf(off) < TOLERANCE * depth[from];
}

// Queues the piece that holds `start`; returns its size.
static size_t flood_from(struct flood *flood, size_t start)
{
    int width = flood->maps->depth.width, height = flood->maps->depth.height;
    size_t count = 0;
    flood->queue[count++] = start;
    flood->seen[start] = 1;
    for (size_t i = 0; i < count; i++) {
        size_t at = flood->queue[i];
        int x = (int)(at % (size_t)width), y = (int)(at / (size_t)width);
        int left = x > REACH ? x - REACH : 0, top = y > REACH ? y - REACH : 0;
        for (int v = top; v <= y + REACH && v < height; v++)
            for (int u = left; u <= x + REACH && u < width; u++) {
                size_t near = (size_t)v * (size_t)width + (size_t)u;
                if (flood->seen[near] || !connected(flood, at, near))
                    continue;
                flood->seen[near] = 1;
                flood->queue[count++] = near;
            }
    }
    return count;
}

enum orl_result orl_densify_remove_speckles(const struct orl_log *log,
                                            const struct orl_camera *camera,
                                            struct densify_maps *maps, size_t least)
{
    size_t count = (size_t)maps->depth.width * (size_t)maps->depth.height;
    struct flood flood = {.maps = maps, .camera = camera};
    flood.seen = orl_array(log, count, sizeof *flood.seen);
    flood.queue = orl_array(log, count, sizeof *flood.queue);
    enum orl_result result = flood.seen && flood.queue ? ORL_OK : ORL_ERR_MEMORY;
    for (size_t start = 0; result == ORL_OK && start < count; start++) {
        if (flood.seen[start] || !(maps->depth.f32[start] > 0.0f))
            continue;
        size_t piece = flood_from(&flood, start);
        for (size_t i = 0; piece < least && i < piece; i++) {
            maps->depth.f32[flood.queue[i]] = 0.0f;
            maps->confidence.f32[flood.queue[i]] = 0.0f;
            memset(&maps->normal.f32[3 * flood.queue[i]], 0, 3 * sizeof(float));
        }
    }
    free(flood.seen);
    free(flood.queue);
    return result;
}
