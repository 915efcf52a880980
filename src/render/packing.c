// Li 2003, 5.3: "we just take the ROIs from the source images and concatenate them into the packed
// image along the horizontal direction". The paper finds regions around silhouettes; here they lie
// around the projections of the proxy's vertices, so that nothing that is painted is missing.
#include "render/packing.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>
#include <xxhash.h>

#include "core/memory.h"
#include "render/prefetch.h"
#include "render/gather.h"
#include "render/method.h"
#include "render/photos.h"

enum {
    RESERVE = 20, // the texture changes when the regions' size has changed by more pixels
    // Regions start and end at multiples of this, so that the first two coarser levels have the same
    // texels as the photograph's.
    ALIGN = 4,
    AROUND = 6, // pixels around the subject: what the bicubic filter reads of the next level
    FILTER = 2, // pixels that the bicubic filter reads on either side
};

void orl_packing_destroy(struct orl_gpu *gpu, struct packing **handle)
{
    struct packing *packing = *handle;
    if (!packing)
        return;
    orl_tex_destroy(gpu, &packing->color);
    free(packing->regions);
    free(packing);
    *handle = NULL;
}

void orl_packing_describe(const struct packing *packing, size_t photo, struct photo_data *data)
{
    const struct packed_region *region = &packing->regions[photo];
    data->offset[0] = (float)(region->place - region->x);
    data->offset[1] = (float)-region->y;
    data->region[0] = (float)(region->place + FILTER);
    data->region[1] = (float)FILTER;
    data->region[2] = (float)(region->place + region->width - FILTER);
    data->region[3] = (float)(region->height - FILTER);
}

// --- regions ---

// Widens [low, high] to aligned pixels around it, within a photograph of `size` pixels and what is
// around it. Leaves *count if the photograph shows nothing of it.
static void take_side(double low, double high, int size, int *first, int *count)
{
    if (!(low < size && high > 0))
        return;
    int from = (int)floor(fmax(low, 0)) - AROUND, to = (int)ceil(fmin(high, size)) + AROUND;
    from = (from + ALIGN * AROUND) / ALIGN * ALIGN - ALIGN * AROUND; // `from` may be negative
    *first = from;
    *count = (to - from + ALIGN - 1) / ALIGN * ALIGN;
}

// All of the photograph if a vertex lies behind its camera.
static struct packed_region find_region(const struct proxy *proxy, const struct orl_view *photo)
{
    const struct orl_camera *c = &photo->camera;
    struct packed_region region = {0};
    double low[2] = {INFINITY, INFINITY}, high[2] = {-INFINITY, -INFINITY};
    for (size_t i = 0; i < proxy->vertex_count; i++) {
        double at[3], q[3];
        for (int k = 0; k < 3; k++)
            at[k] = (double)proxy->vertices[i][k];
        orl_pose_apply(&photo->cam_from_world, at, q);
        bool before = q[2] > 0;
        double x = c->fx * q[0] / q[2] + c->cx, y = c->fy * q[1] / q[2] + c->cy;
        low[0] = fmin(low[0], before ? x : 0);
        low[1] = fmin(low[1], before ? y : 0);
        high[0] = fmax(high[0], before ? x : c->width);
        high[1] = fmax(high[1], before ? y : c->height);
    }
    take_side(low[0], high[0], c->width, &region.x, &region.width);
    take_side(low[1], high[1], c->height, &region.y, &region.height);
    if (region.width == 0 || region.height == 0)
        region = (struct packed_region){0};
    return region;
}

static void find_regions(const struct frame *frame, struct packing *packing)
{
    const struct photos *photos = frame->photos;
    packing->width = packing->height = 0;
    for (size_t i = 0; i < frame->scene->photo_count; i++) {
        struct packed_region *region = &packing->regions[i];
        *region = (struct packed_region){0};
        if (photos->states[i].usable)
            *region = find_region(frame->proxy, &frame->scene->photos[i].view);
        region->place = packing->width;
        packing->width += region->width;
        packing->height = region->height > packing->height ? region->height : packing->height;
    }
}

// --- the texture ---

// Texture and regions differ by less than the reserve more or less.
static bool fits(int side, int needed)
{
    return needed <= side && side - needed <= 2 * RESERVE;
}

static enum orl_result fit_texture(struct orl_gpu *gpu, const struct photos *photos,
                                   struct packing *packing)
{
    struct orl_tex *old = packing->color;
    struct orl_tex_params params = photos->color_params;
    if (old && fits(old->params.width, packing->width) &&
        fits(old->params.height, packing->height)) {
        orl_tex_clear(old, 0); // coarse levels must not depend on what was there before
        return ORL_OK;
    }
    orl_tex_destroy(gpu, &packing->color);
    params.width = packing->width + RESERVE;
    params.height = packing->height + RESERVE;
    params.layers = 1;
    params.levels = 1;
    while (params.width >> params.levels || params.height >> params.levels)
        params.levels++;
    params.tag = "packed photographs";
    return orl_tex_create(gpu, &params, &packing->color);
}

// The region of the picture, whose border is repeated around it.
static enum orl_result cut(const struct orl_log *log, const struct orl_image *image,
                           const struct packed_region *region, struct orl_image *out)
{
    enum orl_result result =
        orl_image_init(log, out, region->width, region->height, 3, ORL_PIXEL_U8);
    if (result != ORL_OK)
        return result;
    for (int row = 0; row < region->height; row++) {
        int y = region->y + row;
        y = y < 0 ? 0 : y < image->height ? y : image->height - 1;
        const uint8_t *from = image->u8 + 3 * (size_t)y * (size_t)image->width;
        uint8_t *to = out->u8 + 3 * (size_t)row * (size_t)region->width;
        for (int column = 0; column < region->width; column++) {
            int x = region->x + column;
            x = x < 0 ? 0 : x < image->width ? x : image->width - 1;
            memcpy(to + 3 * column, from + 3 * x, 3);
        }
    }
    return ORL_OK;
}

static enum orl_result upload(const struct frame *frame, size_t photo,
                              const struct packed_region *region)
{
    const struct orl_log *log = orl_gpu_log(frame->gpu);
    struct photos *photos = frame->photos;
    struct orl_image image = {0}, part = {0};
    enum orl_result result = ORL_OK;
    if (orl_progress_cancelled(photos->progress))
        return ORL_ERR_CANCELLED;
    if (!orl_prefetch_take_photo(frame->prefetch, photo, &image))
        result = orl_photo_read(log, frame->scene, photo, false, &image);
    if (result == ORL_OK)
        result = cut(log, &image, region, &part);
    if (result == ORL_OK) {
        orl_tex_write_part(photos->packing->color, 0, 0, region->place, 0, region->width,
                           region->height, GL_RGB, GL_UNSIGNED_BYTE, part.data);
        photos->uploaded += orl_image_bytes(&part);
    }
    orl_image_finish(&part);
    orl_image_finish(&image);
    return result;
}

// --- a frame ---

// True if the photographs can be packed and nothing asks for what is outside of the regions.
static bool may_pack(const struct frame *frame)
{
    const struct photos *photos = frame->photos;
    int usable = 0;
    for (size_t i = 0; i < frame->scene->photo_count; i++)
        usable += photos->states[i].usable;
    return frame->params->packing == ORL_PACKING_ON && frame->proxy->kind == &orl_proxy_hull &&
           frame->params->paint == &orl_paint_gather && !frame->radiance &&
           !frame->progressive && !orl_frame_guesses(frame) &&
           (frame->params->fill != ORL_FILL_ROOM || photos->places) &&
           photos->format == GL_SRGB8_ALPHA8 && photos->divide == 1 &&
           usable <= photos->slot_count;
}

static uint64_t key_of(const struct frame *frame)
{
    uint64_t key = orl_proxy_key(frame->proxy, frame->params);
    return XXH3_64bits_withSeed(&frame->scene->frame, sizeof frame->scene->frame, key) | 1;
}

static enum orl_result make(struct orl_gpu *gpu, struct photos *photos)
{
    const struct orl_log *log = orl_gpu_log(gpu);
    if (photos->packing)
        return ORL_OK;
    struct packing *packing = orl_array(log, 1, sizeof *packing);
    if (!packing)
        return ORL_ERR_MEMORY;
    packing->regions = orl_array(log, photos->scene->photo_count, sizeof *packing->regions);
    photos->packing = packing;
    if (packing->regions)
        return ORL_OK;
    orl_packing_destroy(gpu, &photos->packing);
    return ORL_ERR_MEMORY;
}

enum orl_result orl_packing_update(struct frame *frame)
{
    struct photos *photos = frame->photos;
    int side = orl_gpu_caps(frame->gpu)->max_texture_size;
    if (!may_pack(frame))
        return ORL_OK;
    enum orl_result result = make(frame->gpu, photos);
    struct packing *packing = photos->packing;
    uint64_t key = key_of(frame);
    if (result != ORL_OK || packing->key == key) {
        frame->packs = result == ORL_OK;
        return result;
    }
    packing->key = 0;
    find_regions(frame, packing);
    if (packing->width > side - RESERVE || packing->height > side - RESERVE)
        return ORL_OK; // whole photographs are in layers instead
    orl_pass_begin(frame->gpu, "pack");
    result = fit_texture(frame->gpu, photos, packing);
    for (size_t i = 0; result == ORL_OK && i < frame->scene->photo_count; i++)
        if (packing->regions[i].width > 0)
            result = upload(frame, i, &packing->regions[i]);
    if (result == ORL_OK) {
        orl_tex_make_mipmaps(packing->color, 0);
        packing->key = key;
        frame->packs = true;
    }
    orl_pass_end(frame->gpu);
    return result;
}
