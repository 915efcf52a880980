// Photographs and their depth maps on the device, within a budget.
#include <stdlib.h>
#include <string.h>

#include "core/memory.h"
#include "io/picture.h"
#include "render/internal.h"

enum { DIVIDE_MAX = 4 };

static int divided(int side, int divide)
{
    int small = side / divide;
    return small > 1 ? small : 1;
}

// Colour with mipmaps, and depth.
static size_t photo_bytes(const struct orl_photo *photo, int divide)
{
    const struct orl_camera *c = &photo->view.camera;
    size_t pixels = (size_t)divided(c->width, divide) * (size_t)divided(c->height, divide);
    return pixels * 4 + pixels * 4 / 3 + pixels * 4;
}

static void plan(const struct orl_log *log, struct photos *photos)
{
    size_t total = 0, largest = 0, count = 0;
    for (;;) {
        total = 0, largest = 0, count = 0;
        for (size_t i = 0; i < photos->scene->photo_count; i++) {
            if (!photos->slots[i].usable)
                continue;
            size_t bytes = photo_bytes(&photos->scene->photos[i], photos->divide);
            total += bytes;
            largest = bytes > largest ? bytes : largest;
            count++;
        }
        if (!photos->budget_bytes || total <= photos->budget_bytes ||
            photos->divide >= DIVIDE_MAX)
            break;
        photos->divide *= 2;
    }
    if (photos->divide > 1)
        orl_logf(log, ORL_LOG_WARNING,
                 "photographs do not fit in %zu MiB of device memory: using them at 1/%d size",
                 photos->budget_bytes >> 20, photos->divide);
    if (photos->budget_bytes && total > photos->budget_bytes)
        orl_logf(log, ORL_LOG_WARNING,
                 "keeping about %zu of %zu photographs on the device at once; frames get slower",
                 largest ? photos->budget_bytes / largest : 0, count);
}

enum orl_result orl_photos_init(struct orl_gpu *gpu, const struct orl_scene *scene, const bool *use,
                                size_t budget_bytes, struct photos *photos)
{
    memset(photos, 0, sizeof *photos);
    photos->scene = scene;
    photos->divide = 1;
    photos->budget_bytes = budget_bytes;
    photos->slots = orl_array(orl_gpu_log(gpu), scene->photo_count, sizeof *photos->slots);
    if (!photos->slots)
        return ORL_ERR_MEMORY;
    for (size_t i = 0; i < scene->photo_count; i++)
        photos->slots[i].usable = use ? use[i] : !scene->photos[i].test;
    plan(orl_gpu_log(gpu), photos);
    return ORL_OK;
}

static void evict(struct orl_gpu *gpu, struct photo_slot *slot)
{
    orl_tex_destroy(gpu, &slot->color);
    orl_tex_destroy(gpu, &slot->depth);
}

void orl_photos_finish(struct orl_gpu *gpu, struct photos *photos)
{
    for (size_t i = 0; photos->slots && i < photos->scene->photo_count; i++)
        evict(gpu, &photos->slots[i]);
    free(photos->slots);
    orl_proxy_target_finish(gpu, &photos->target);
    memset(photos, 0, sizeof *photos);
}

// Evicts the least recently used photographs until `bytes` more fit.
static void make_room(struct orl_gpu *gpu, struct photos *photos, size_t bytes)
{
    while (photos->budget_bytes) {
        size_t resident = 0;
        struct photo_slot *oldest = NULL;
        for (size_t i = 0; i < photos->scene->photo_count; i++) {
            struct photo_slot *slot = &photos->slots[i];
            if (!slot->color)
                continue;
            resident += photo_bytes(&photos->scene->photos[i], photos->divide);
            if (!oldest || slot->last_use < oldest->last_use)
                oldest = slot;
        }
        if (!oldest || resident + bytes <= photos->budget_bytes)
            return;
        evict(gpu, oldest);
    }
}

static int mip_levels(int width, int height)
{
    int levels = 1;
    for (int side = width > height ? width : height; side > 1; side /= 2)
        levels++;
    return levels;
}

static enum orl_result load_color(struct orl_gpu *gpu, const struct photos *photos, size_t index,
                                  struct photo_slot *slot)
{
    const struct orl_log *log = orl_gpu_log(gpu);
    const struct orl_camera *c = &photos->scene->photos[index].view.camera;
    struct orl_image image = {0};
    struct orl_tex *full = NULL;
    char *path = orl_scene_photo_path(log, photos->scene, index);
    enum orl_result result =
        path ? orl_picture_read(log, path, 3, &image) : ORL_ERR_MEMORY;
    if (result == ORL_OK && (image.width != c->width || image.height != c->height))
        result = orl_fail(log, ORL_ERR_FORMAT, "%s: %dx%d pixels, but its camera has %dx%d", path,
                          image.width, image.height, c->width, c->height);
    if (result != ORL_OK)
        goto end;
    // A smaller photograph is a mip level of the full one: box filtered in linear light.
    int level = 0;
    while (1 << level < photos->divide)
        level++;
    struct orl_tex_params params = {.width = image.width, .height = image.height,
                                    .levels = mip_levels(image.width, image.height),
                                    .format = GL_SRGB8_ALPHA8, .linear = true,
                                    .tag = "photograph"};
    result = orl_tex_create(gpu, &params, &full);
    if (result != ORL_OK)
        goto end;
    orl_tex_write(full, 0, 0, GL_RGB, GL_UNSIGNED_BYTE, image.u8);
    orl_tex_make_mipmaps(full);
    if (level == 0) {
        slot->color = full;
        full = NULL;
        goto end;
    }
    result = orl_tex_copy_levels(gpu, full, level, &slot->color);
end:
    orl_tex_destroy(gpu, &full);
    orl_image_finish(&image);
    free(path);
    return result;
}

static enum orl_result make_depth(struct orl_gpu *gpu, struct photos *photos,
                                  const struct proxy *proxy, size_t index,
                                  struct photo_slot *slot, const struct proxy_options *options)
{
    struct orl_view view = photos->scene->photos[index].view;
    view.camera = orl_camera_resized(&view.camera, divided(view.camera.width, photos->divide),
                                     divided(view.camera.height, photos->divide));
    enum orl_result result = orl_proxy_target_resize(gpu, &photos->target, view.camera.width,
                                                     view.camera.height);
    if (result != ORL_OK)
        return result;
    if (!slot->depth) {
        struct orl_tex_params params = photos->target.depth->params;
        params.tag = "photograph depth";
        result = orl_tex_create(gpu, &params, &slot->depth);
        if (result != ORL_OK)
            return result;
    }
    // The proxy draws into the target's depth; trade textures instead of copying.
    orl_proxy_draw(gpu, proxy, &view, options, &photos->target);
    struct orl_tex *made = photos->target.depth;
    photos->target.depth = slot->depth;
    slot->depth = made;
    slot->depth_options = *options;
    return ORL_OK;
}

static bool same_options(const struct proxy_options *a, const struct proxy_options *b)
{
    return a->splat_scale == b->splat_scale && a->front_layer == b->front_layer;
}

enum orl_result orl_photos_require(struct orl_gpu *gpu, struct photos *photos,
                                   const struct proxy *proxy, size_t photo,
                                   const struct proxy_options *depth_options)
{
    struct photo_slot *slot = &photos->slots[photo];
    slot->last_use = ++photos->clock;
    enum orl_result result = ORL_OK;
    if (!slot->color) {
        make_room(gpu, photos, photo_bytes(&photos->scene->photos[photo], photos->divide));
        result = load_color(gpu, photos, photo, slot);
    }
    if (result == ORL_OK && depth_options &&
        (!slot->depth || !same_options(&slot->depth_options, depth_options)))
        result = make_depth(gpu, photos, proxy, photo, slot, depth_options);
    return result;
}
