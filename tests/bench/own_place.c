// own_place SCENE [METHOD [KEY=VALUE]..]: how close a view at a training photograph's own place comes
// to that photograph where geometry covers it (Airieau 2012, section 4). Prints the least PSNR, the
// mean, and the mean share of covered pixels, as JSON.
#include <math.h>
#include <stdio.h>

#include "eval/metrics.h"
#include "oriel/gpu.h"
#include "oriel/render.h"
#include "render/photos/photo_loader.h"

struct place {
    struct orl_scene *scene;
    struct orl_gpu *gpu;
    struct orl_renderer *renderer;
    struct orl_render_params params;
};

static enum orl_result compare(const struct orl_log *log, const struct place *p, size_t photo,
                               struct orl_metrics *metrics)
{
    struct orl_frame frame = {0};
    struct orl_image own = {0}, srgb = {0};
    enum orl_result result =
        orl_renderer_draw(p->renderer, &p->scene->photos[photo].view, &p->params, NULL, &frame);
    if (result == ORL_OK)
        result = orl_photo_read(log, p->scene, photo, false, &own);
    if (result == ORL_OK)
        result = orl_tone_srgb(log, &frame.color, &srgb);
    if (result == ORL_OK)
        result = orl_metrics_compare(log, &srgb, &own, &frame.coverage, metrics);
    orl_frame_finish(&frame);
    orl_image_finish(&own);
    orl_image_finish(&srgb);
    return result;
}

static enum orl_result measure(const struct orl_log *log, const struct place *p)
{
    double least = INFINITY, sum = 0, covered = 0;
    int count = 0;
    for (size_t i = 0; i < p->scene->photo_count; i++) {
        struct orl_metrics metrics;
        if (p->scene->photos[i].test)
            continue;
        enum orl_result result = compare(log, p, i, &metrics);
        if (result != ORL_OK)
            return result;
        least = fmin(least, metrics.psnr_covered_db);
        sum += metrics.psnr_covered_db;
        covered += metrics.coverage;
        count++;
    }
    printf("{\"scene\": \"%s\", \"min_db\": %.2f, \"mean_db\": %.2f, \"coverage\": %.4f}\n",
           p->scene->dir, least, sum / count, covered / count);
    return ORL_OK;
}

int main(int argc, char **argv)
{
    struct orl_log log = orl_log_stderr(ORL_LOG_WARNING);
    struct place p = {0};
    if (argc < 2) {
        fprintf(stderr, "usage: own_place SCENE [METHOD [KEY=VALUE]..]\n");
        return 2;
    }
    const struct orl_method *method = orl_method_find(&log, argc > 2 ? argv[2] : "airieau");
    enum orl_result result = method ? orl_scene_open(&log, argv[1], &p.scene) : ORL_ERR_ARGUMENT;
    if (result == ORL_OK) {
        p.params = method->params;
        result = orl_render_params_assign(&log, &p.params, (const char *const *)argv + 3,
                                          argc > 3 ? (size_t)argc - 3 : 0);
    }
    if (result == ORL_OK)
        result = orl_gpu_create(&log, NULL, &p.gpu);
    if (result == ORL_OK)
        result = orl_renderer_create(p.gpu, p.scene, NULL, &p.renderer);
    if (result == ORL_OK)
        result = measure(&log, &p);
    orl_renderer_destroy(&p.renderer);
    orl_gpu_destroy(&p.gpu);
    orl_scene_destroy(&p.scene);
    return result == ORL_OK ? 0 : 1;
}
