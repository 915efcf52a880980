// Pages of points: a cut through the tree of pages for each view, and a pool of them on the device.
#include "render/proxy/splats.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "core/memory.h"

enum {
    NOWHERE = -1,
    PAGE_POINTS = ORL_LOD_BLOCKS * ORL_BLOCK_POINTS,
    // Of a page, and the list of what is drawn of it (cloud.c).
    PAGE_BYTES = sizeof(struct orl_lod_data) + ORL_LOD_BLOCKS * 4,
    LEAST_SLOTS = 16,
};
// A page is fine enough when its points' radius spans so many pixels: some seven points lie in a pixel then.
static const float enough = 0.5f;
// A page around the viewer is never fine enough.
static const float endless = 1e30f;

struct slot {
    size_t page;
    uint64_t used;  // the choice that last asked for it; 0: empty
    bool drawn;     // its blocks are listed in the chunk
    float blocks[ORL_LOD_BLOCKS][ORL_BLOCK_VEC4S][4];
};

struct candidate {
    size_t page;
    float need; // pixels that a point's radius spans
};

struct cloud_pages {
    const struct orl_lod *lod;
    struct slot *slots;
    size_t slot_count;
    int32_t *slot_of; // each page; NOWHERE: not on the device
    uint64_t choice;  // how many were made
    struct candidate *heap; // the neediest first
    size_t heap_count;
    size_t *cut;
    size_t cut_count;
    struct orl_lod_data *data; // being uploaded
};

// --- memory ---

static size_t count_slots(const struct orl_gpu *gpu, const struct orl_lod *lod, size_t max_bytes)
{
    size_t slots = orl_cloud_chunk_points(gpu) / PAGE_POINTS;
    if (max_bytes && max_bytes / PAGE_BYTES < slots)
        slots = max_bytes / PAGE_BYTES;
    slots = slots < LEAST_SLOTS ? LEAST_SLOTS : slots;
    return slots < lod->page_count ? slots : lod->page_count;
}

enum orl_result orl_cloud_pages_init(struct orl_gpu *gpu, const struct orl_lod *lod,
                                     size_t max_bytes, struct cloud *cloud)
{
    const struct orl_log *log = orl_gpu_log(gpu);
    struct cloud_pages *p = orl_array(log, 1, sizeof *p);
    memset(cloud, 0, sizeof *cloud);
    ORL_TRY_MEMORY(p);
    cloud->pages = p;
    p->lod = lod;
    p->slot_count = count_slots(gpu, lod, max_bytes);
    p->slots = orl_array(log, p->slot_count, sizeof *p->slots);
    p->slot_of = orl_array(log, lod->page_count, sizeof *p->slot_of);
    p->heap = orl_array(log, p->slot_count + ORL_LOD_CHILDREN, sizeof *p->heap);
    p->cut = orl_array(log, p->slot_count + ORL_LOD_CHILDREN, sizeof *p->cut);
    p->data = orl_array(log, 1, sizeof *p->data);
    enum orl_result result = p->slots && p->slot_of && p->heap && p->cut && p->data
                                 ? orl_cloud_empty_chunk(gpu, p->slot_count * ORL_LOD_BLOCKS, cloud)
                                 : ORL_ERR_MEMORY;
    for (size_t i = 0; result == ORL_OK && i < lod->page_count; i++)
        p->slot_of[i] = NOWHERE;
    if (result == ORL_OK)
        orl_logf(log, ORL_LOG_INFO, "%llu points in %zu pages, of which the device holds %zu",
                 (unsigned long long)lod->points, lod->page_count, p->slot_count);
    else
        orl_cloud_finish(gpu, cloud);
    return result;
}

void orl_cloud_pages_finish(struct cloud_pages **pages)
{
    struct cloud_pages *p = *pages;
    if (!p)
        return;
    free(p->slots);
    free(p->slot_of);
    free(p->heap);
    free(p->cut);
    free(p->data);
    free(p);
    *pages = NULL;
}

// --- the cut ---

static float dot3(const double a[3], const float b[3])
{
    return (float)(a[0] * (double)b[0] + a[1] * (double)b[1] + a[2] * (double)b[2]);
}

// Is the box wholly on the outer side of a plane through the eye?
static bool outside(const float middle[3], const float extent[3], float x, float y, float z)
{
    return x * middle[0] + y * middle[1] + z * middle[2] + fabsf(x) * extent[0] +
               fabsf(y) * extent[1] + fabsf(z) * extent[2] < 0;
}

// How many pixels the radius of the page's points spans at its nearest depth. False: the page is outside
// the picture, which shaders/proxy/splat_cull.comp finds likewise for blocks.
static bool find_need(const struct orl_view *view, const struct orl_lod_page *page, float *need)
{
    const struct orl_camera *c = &view->camera;
    double eye[3];
    float away[3], middle[3], extent[3];
    if (!page->count)
        return false;
    orl_pose_centre(&view->cam_from_world, eye);
    for (int k = 0; k < 3; k++)
        away[k] = (float)((double)page->middle[k] - eye[k]);
    for (int k = 0; k < 3; k++) {
        const double *axis = view->cam_from_world.r[k];
        const double across[3] = {fabs(axis[0]), fabs(axis[1]), fabs(axis[2])};
        middle[k] = dot3(axis, away);
        extent[k] = dot3(across, page->extent);
        extent[k] += 1e-5f * (fabsf(middle[k]) + extent[k]);
    }
    float fx = (float)c->fx, fy = (float)c->fy, cx = (float)c->cx, cy = (float)c->cy;
    if (middle[2] + extent[2] <= 0 || outside(middle, extent, fx, 0, cx) ||
        outside(middle, extent, -fx, 0, (float)c->width - cx) ||
        outside(middle, extent, 0, fy, cy) ||
        outside(middle, extent, 0, -fy, (float)c->height - cy))
        return false;
    float pixel = fmaxf(middle[2] - extent[2], 0) / fminf(fx, fy);
    *need = pixel * endless > page->radius ? page->radius / pixel : endless;
    return true;
}

static void push(struct cloud_pages *p, struct candidate c)
{
    size_t at = p->heap_count++;
    for (; at > 0 && p->heap[(at - 1) / 2].need < c.need; at = (at - 1) / 2)
        p->heap[at] = p->heap[(at - 1) / 2];
    p->heap[at] = c;
}

static struct candidate pop(struct cloud_pages *p)
{
    struct candidate first = p->heap[0], last = p->heap[--p->heap_count];
    size_t at = 0;
    for (size_t child; (child = 2 * at + 1) < p->heap_count; at = child) {
        if (child + 1 < p->heap_count && p->heap[child + 1].need > p->heap[child].need)
            child++;
        if (p->heap[child].need <= last.need)
            break;
        p->heap[at] = p->heap[child];
    }
    p->heap[at] = last;
    return first;
}

// Replaces the neediest page by its visible children as long as there is room for them.
static void find_cut(struct cloud_pages *p, const struct orl_view *view)
{
    const struct orl_lod *lod = p->lod;
    struct candidate c = {.page = lod->page_count - 1};
    p->heap_count = p->cut_count = 0;
    if (find_need(view, &lod->pages[c.page], &c.need))
        push(p, c);
    while (p->heap_count) {
        size_t first, count, visible = 0;
        struct candidate children[ORL_LOD_CHILDREN];
        c = pop(p);
        bool fine = c.need <= enough;
        orl_lod_children(lod, c.page, &first, &count);
        for (size_t i = 0; !fine && i < count; i++) {
            children[visible].page = first + i;
            visible += find_need(view, &lod->pages[first + i], &children[visible].need);
        }
        if (fine || !count || p->cut_count + p->heap_count + visible > p->slot_count) {
            p->cut[p->cut_count++] = c.page;
            continue;
        }
        for (size_t i = 0; i < visible; i++)
            push(p, children[i]);
    }
}

// --- the device ---

static void list_blocks(const struct point_chunk *chunk, size_t at, const struct slot *slot)
{
    static const float none[ORL_LOD_BLOCKS][ORL_BLOCK_VEC4S][4];
    orl_buf_write(chunk->blocks, at * sizeof none, sizeof none, slot->drawn ? slot->blocks : none);
}

static void upload(const struct cloud_pages *p, const struct point_chunk *chunk, size_t at)
{
    orl_buf_write(chunk->points, at * sizeof p->data->geometry, sizeof p->data->geometry, p->data->geometry);
    orl_buf_write(chunk->colors, at * sizeof p->data->colors, sizeof p->data->colors, p->data->colors);
}

// The slot that was not used for longest. There is one, since a cut has no more pages than slots.
static size_t oldest_slot(const struct cloud_pages *p)
{
    size_t oldest = 0;
    for (size_t i = 1; i < p->slot_count && p->slots[oldest].used; i++)
        if (p->slots[i].used < p->slots[oldest].used)
            oldest = i;
    return oldest;
}

static enum orl_result load(struct cloud_pages *p, const struct point_chunk *chunk, size_t page)
{
    size_t at = oldest_slot(p);
    struct slot *slot = &p->slots[at];
    ORL_TRY(orl_lod_read(p->lod, page, p->data));
    if (slot->used)
        p->slot_of[slot->page] = NOWHERE;
    p->slot_of[page] = (int32_t)at;
    slot->page = page;
    slot->used = p->choice;
    slot->drawn = true;
    memcpy(slot->blocks, p->data->blocks, sizeof slot->blocks);
    upload(p, chunk, at);
    list_blocks(chunk, at, slot);
    return ORL_OK;
}

enum orl_result orl_cloud_pages_choose(const struct cloud *cloud, const struct orl_view *view)
{
    struct cloud_pages *p = cloud->pages;
    const struct point_chunk *chunk = &cloud->chunks[0];
    find_cut(p, view);
    p->choice++;
    for (size_t i = 0; i < p->cut_count; i++)
        if (p->slot_of[p->cut[i]] != NOWHERE)
            p->slots[p->slot_of[p->cut[i]]].used = p->choice;
    for (size_t i = 0; i < p->cut_count; i++)
        if (p->slot_of[p->cut[i]] == NOWHERE)
            ORL_TRY(load(p, chunk, p->cut[i]));
    for (size_t i = 0; i < p->slot_count; i++) {
        bool drawn = p->slots[i].used == p->choice;
        if (drawn == p->slots[i].drawn)
            continue;
        p->slots[i].drawn = drawn;
        list_blocks(chunk, i, &p->slots[i]);
    }
    return ORL_OK;
}
