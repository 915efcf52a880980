// photographs SCENE WxH [METHOD]..: what a frame costs with every photograph of the scene
// and with 20 of them, spread evenly, in CPU time. The least of several draws in
// turn, without reading back, standing still halfway between two photographs (`still`), and the
// mean along a short walk there, for the first time, when photographs that come into question
// are read and their depth is drawn (`first`), and again (`walk`).
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "core/memory.h"
#include "core/process.h"
#include "oriel/render.h"
#include "oriel/path.h"

enum { FEW = 20, ROUNDS = 7, STEPS = 12 };

static enum orl_result draw(struct orl_renderer *renderer, const struct orl_view *view,
                            const struct orl_render_params *params, double *ms)
{
    double start = orl_cpu_time_s();
    enum orl_result result = orl_renderer_draw(renderer, view, params, NULL, NULL);
    *ms = 1e3 * (orl_cpu_time_s() - start);
    return result;
}

struct costs {
    double still[2], first[2], walk[2]; // few, all
};

static enum orl_result measure(struct orl_renderer *const renderers[2],
                               const struct orl_view ends[2],
                               const struct orl_render_params *params, struct costs *costs)
{
    enum orl_result result = ORL_OK;
    double ms;
    memset(costs, 0, sizeof *costs);
    struct orl_view middle = orl_view_interpolate(&ends[0], &ends[1], 0.5);
    for (int i = 0; i < 2 * (ROUNDS + 2) && result == ORL_OK; i++) {
        double *least = &costs->still[i % 2];
        result = draw(renderers[i % 2], &middle, params, &ms);
        if (i / 2 >= 2 && (*least == 0 || ms < *least)) // after two to warm up
            *least = ms;
    }
    for (int i = 0; i < 4 * STEPS && result == ORL_OK; i++) {
        int step = i / 2 % STEPS;
        struct orl_view view = orl_view_interpolate(&ends[0], &ends[1], (step + 0.5) / STEPS);
        result = draw(renderers[i % 2], &view, params, &ms);
        double *walk = i < 2 * STEPS ? costs->first : costs->walk;
        walk[i % 2] += ms / STEPS;
    }
    return result;
}

static void print_pair(const double ms[2])
{
    printf(" %8.1f %8.1f %6.2f ", ms[0], ms[1], ms[1] / ms[0]);
}

int main(int argc, char **argv)
{
    struct orl_log log = orl_log_stderr(ORL_LOG_WARNING);
    struct orl_scene *scene = NULL;
    struct orl_gpu *gpu = NULL;
    struct orl_renderer *renderers[2] = {NULL, NULL};
    bool *use = NULL;
    int width = 0, height = 0;
    if (argc < 3 || sscanf(argv[2], "%dx%d", &width, &height) != 2) {
        fprintf(stderr, "usage: photographs SCENE WxH [METHOD]..\n");
        return 2;
    }
    enum orl_result result = orl_scene_open(&log, argv[1], &scene);
    if (result == ORL_OK && scene->photo_count < 2 * FEW)
        result = orl_fail(&log, ORL_ERR_DATA, "%s: %d photographs are needed", argv[1], 2 * FEW);
    if (result == ORL_OK)
        result = orl_gpu_create(&log, &(struct orl_gpu_params){0}, &gpu);
    if (result != ORL_OK)
        goto end;
    use = orl_array(&log, scene->photo_count, sizeof *use);
    if (!use) {
        result = ORL_ERR_MEMORY;
        goto end;
    }
    for (size_t i = 0; i < FEW; i++)
        use[i * scene->photo_count / FEW] = true;
    for (int i = 0; i < 2 && result == ORL_OK; i++)
        result = orl_renderer_create(gpu, scene,
                                     &(struct orl_renderer_params){.use = i ? NULL : use},
                                     &renderers[i]);
    // Between the tenth and the eleventh of the few: both renderers have these.
    struct orl_view ends[2];
    for (size_t i = 0; i < 2; i++) {
        ends[i] = scene->photos[(FEW / 2 - 1 + i) * scene->photo_count / FEW].view;
        ends[i].camera = orl_camera_reframed(&ends[i].camera, width, height);
    }
    if (result == ORL_OK)
        printf("%zu points, %dx%d, %s; CPU ms a frame with %d and with %zu photographs\n"
               "%-12s %8s %8s %6s  %8s %8s %6s  %8s %8s %6s\n", scene->points.count, width,
               height, orl_gpu_caps(gpu)->renderer, FEW, scene->photo_count, "method", "still",
               "", "ratio", "walk", "", "ratio", "first", "", "ratio");
    for (const struct orl_method *m = orl_methods; m->name && result == ORL_OK; m++) {
        bool asked = argc == 3;
        for (int i = 3; i < argc; i++)
            asked = asked || strcmp(argv[i], m->name) == 0;
        if (!asked)
            continue;
        struct costs c;
        result = measure(renderers, ends, &m->params, &c);
        if (result != ORL_OK)
            break;
        printf("%-12s", m->name);
        print_pair(c.still);
        print_pair(c.walk);
        print_pair(c.first);
        printf("\n");
        fflush(stdout);
    }
end:
    orl_renderer_destroy(&renderers[0]);
    orl_renderer_destroy(&renderers[1]);
    orl_gpu_destroy(&gpu);
    orl_scene_destroy(&scene);
    free(use);
    return result == ORL_OK ? 0 : 1;
}
