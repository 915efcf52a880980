// How large Li 2003's packed texture is (5.3), what of the first N photographs goes to the device, and
// what a frame of method li has there, packed and whole.
#include <stdio.h>
#include <stdlib.h>

#include "core/memory.h"
#include "oriel/render.h"
#include "render/method.h"
#include "render/packing.h"
#include "render/photos.h"

struct figures {
    int width, height; // of the regions of all photographs; 0: they are whole
    size_t uploaded;   // bytes of photographs
    size_t device;     // bytes of everything of a frame
};

// What is packed, without the frame around it.
static enum orl_result find_size(struct orl_gpu *gpu, const struct orl_scene *scene,
                                 const struct orl_renderer_params *limits,
                                 const struct orl_render_params *params, struct figures *figures)
{
    struct photos photos;
    struct proxy proxy = {0};
    enum orl_result result = orl_photos_init(gpu, scene, limits, 0, &photos);
    if (result != ORL_OK)
        return result;
    result = orl_proxy_create(gpu, scene, &orl_proxy_hull, 0, &proxy);
    struct frame frame = {.gpu = gpu, .scene = scene, .params = params, .proxy = &proxy,
                          .photos = &photos};
    if (result == ORL_OK)
        result = orl_proxy_update(&frame);
    if (result == ORL_OK)
        result = orl_packing_update(&frame);
    if (result == ORL_OK && frame.packs) {
        figures->width = photos.packing->color->params.width;
        figures->height = photos.packing->color->params.height;
    }
    orl_proxy_finish(gpu, &proxy);
    orl_photos_finish(gpu, &photos);
    return result;
}

static enum orl_result measure(struct orl_gpu *gpu, const struct orl_scene *scene,
                               const struct orl_renderer_params *limits, const char *packing,
                               struct figures *figures)
{
    struct orl_render_params params = orl_method_find(NULL, "li")->params;
    struct orl_renderer *renderer = NULL;
    struct orl_frame frame;
    *figures = (struct figures){0};
    enum orl_result result = orl_render_params_set(orl_gpu_log(gpu), &params, packing);
    if (result == ORL_OK)
        result = find_size(gpu, scene, limits, &params, figures);
    if (result == ORL_OK)
        result = orl_renderer_create(gpu, scene, limits, &renderer);
    if (result == ORL_OK)
        result = orl_renderer_draw(renderer, &scene->photos[0].view, &params, NULL, &frame);
    if (result == ORL_OK) {
        figures->device = orl_gpu_bytes(gpu);
        figures->uploaded = orl_renderer_uploaded(renderer);
        orl_frame_finish(&frame);
    }
    orl_renderer_destroy(&renderer);
    return result;
}

static enum orl_result compare(const struct orl_log *log, struct orl_gpu *gpu,
                               const struct orl_scene *scene)
{
    bool *use = orl_array(log, scene->photo_count, sizeof *use);
    enum orl_result result = use ? ORL_OK : ORL_ERR_MEMORY;
    const struct orl_renderer_params limits = {.use = use, .textures = ORL_TEXTURES_FULL};
    double pixels = 0;
    int count = 0;
    printf("%-12s %-10s %7s  %-21s %s\n", "photographs", "packed", "of all",
           "uploaded MB: packed, whole", "on the device MB: packed, whole");
    for (size_t i = 0; result == ORL_OK && i < scene->photo_count; i++) {
        const struct orl_camera *c = &scene->photos[i].view.camera;
        struct figures packed, whole;
        if (!scene->photos[i].masked || scene->photos[i].test)
            continue;
        use[i] = true;
        pixels += (double)c->width * c->height;
        if (++count < 2)
            continue;
        result = measure(gpu, scene, &limits, "packing=on", &packed);
        if (result == ORL_OK)
            result = measure(gpu, scene, &limits, "packing=off", &whole);
        char size[32];
        snprintf(size, sizeof size, "%dx%d", packed.width, packed.height);
        if (result == ORL_OK)
            printf("%-12d %-10s %6.1f%%  %17.2f %8.2f %21.1f %6.1f\n", count, size,
                   100.0 * packed.width * packed.height / pixels, 1e-6 * (double)packed.uploaded,
                   1e-6 * (double)whole.uploaded, 1e-6 * (double)packed.device,
                   1e-6 * (double)whole.device);
    }
    free(use);
    return result;
}

int main(int argc, char **argv)
{
    struct orl_scene *scene = NULL;
    struct orl_gpu *gpu = NULL;
    struct orl_log log = orl_log_stderr(ORL_LOG_WARNING);
    if (argc != 2) {
        fprintf(stderr, "usage: %s SCENE\n", argv[0]);
        return 2;
    }
    enum orl_result result = orl_scene_open(&log, argv[1], &scene);
    if (result == ORL_OK)
        result = orl_gpu_create(&log, NULL, &gpu);
    if (result == ORL_OK)
        result = compare(&log, gpu, scene);
    orl_gpu_destroy(&gpu);
    orl_scene_destroy(&scene);
    return result == ORL_OK ? 0 : 1;
}
