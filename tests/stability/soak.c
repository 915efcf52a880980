// soak SCENE FRAMES ROUNDS: draws FRAMES random views of a scene by one renderer, of all methods in
// turn, then opens the scene, draws one frame and closes everything once for each method and then
// ROUNDS times. Fails if memory grows from frame to frame or from opening to opening, if a pixel is
// not finite, or if objects of the device stay alive.
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include "core/memory.h"
#include "oriel/render.h"

enum { WIDTH = 96, HEIGHT = 64, DEVICES = 20 };

// What steps of the driver may look like in a few hundred frames and a few dozen openings.
static const double FRAME_KIB = 8, OPENING_KIB = 256;

struct soak {
    struct orl_log log;
    const char *dir;
    uint32_t noise;
    size_t method; // drawn last
    double sum[5]; // of x, y, xx, xy and 1, of what was measured after the first fifth
    bool failed;
};

// Resident memory of this process, KiB.
static long resident_kib(void)
{
    long pages = 0;
    FILE *file = fopen("/proc/self/statm", "r");
    if (!file || fscanf(file, "%*d %ld", &pages) != 1)
        pages = 0;
    if (file)
        fclose(file);
    return pages * (sysconf(_SC_PAGESIZE) / 1024);
}

// Uniform in [0, 1].
static double noise(struct soak *soak)
{
    soak->noise = soak->noise * 1664525u + 1013904223u;
    return (double)(soak->noise >> 8) / ((1 << 24) - 1);
}

// A place between and around the photographs, looking anywhere.
static struct orl_view random_view(struct soak *soak, const struct orl_scene *scene)
{
    size_t count = scene->photo_count;
    const struct orl_view *a = &scene->photos[(size_t)(noise(soak) * (double)(count - 1))].view;
    const struct orl_view *b = &scene->photos[(size_t)(noise(soak) * (double)(count - 1))].view;
    double eye[3], from[3], to[3], target[3];
    orl_pose_centre(&a->cam_from_world, from);
    orl_pose_centre(&b->cam_from_world, to);
    double t = 3 * noise(soak) - 1;
    for (int k = 0; k < 3; k++) {
        eye[k] = from[k] + t * (to[k] - from[k]);
        target[k] = eye[k] + (double)a->cam_from_world.r[2][k] + noise(soak) - 0.5;
    }
    struct orl_view view = {.camera = orl_camera_resized(&a->camera, WIDTH, HEIGHT)};
    view.cam_from_world = orl_pose_look_at(eye, target, (const double[3]){0, -1, 0});
    return view;
}

static enum orl_result draw(struct soak *soak, struct orl_renderer *renderer,
                            const struct orl_scene *scene)
{
    struct orl_view view = random_view(soak, scene);
    struct orl_frame frame;
    const struct orl_method *method = &orl_methods[soak->method];
    soak->method = orl_methods[soak->method + 1].name ? soak->method + 1 : 0;
    struct orl_render_params params; // as they suit the scene
    orl_render_params_tuned(&soak->log, method, scene, &params);
    enum orl_result result = orl_renderer_draw(renderer, &view, &params, NULL, &frame);
    if (result != ORL_OK)
        return result;
    for (size_t i = 0; i < 3 * (size_t)WIDTH * HEIGHT; i++)
        if (!isfinite(frame.color.f32[i]))
            result = orl_fail(&soak->log, ORL_ERR_GPU, "%s: a pixel is not finite", method->name);
    orl_frame_finish(&frame);
    return result;
}

// The slope of memory over what has been done, by least squares. A leak is a slope; what a driver
// keeps after some rare frame is a step, which matters less the more has been done.
static void check_memory(struct soak *soak, int done, int all, const char *what, double max_kib)
{
    if (done == 1)
        memset(soak->sum, 0, sizeof soak->sum);
    if (done <= all / 5)
        return;
    double x = done - 0.6 * all, y = (double)resident_kib();
    const double terms[5] = {x, y, x * x, x * y, 1};
    for (int i = 0; i < 5; i++)
        soak->sum[i] += terms[i];
    if (done != all)
        return;
    const double *s = soak->sum;
    double spread = s[4] * s[2] - s[0] * s[0];
    double slope = spread > 0 ? (s[4] * s[3] - s[0] * s[1]) / spread : 0;
    printf("soaked: %d %s, memory %+.3f KiB each\n", all, what, slope);
    soak->failed = soak->failed || slope > max_kib;
}

static enum orl_result draw_frames(struct soak *soak, struct orl_gpu *gpu, int frames,
                                   bool watched)
{
    struct orl_scene *scene = NULL;
    struct orl_renderer *renderer = NULL;
    enum orl_result result = orl_scene_open(&soak->log, soak->dir, &scene);
    if (result == ORL_OK)
        result = orl_renderer_create(gpu, scene, NULL, &renderer);
    for (int i = 1; i <= frames && result == ORL_OK; i++) {
        result = draw(soak, renderer, scene);
        if (watched)
            check_memory(soak, i, frames, "frames", FRAME_KIB);
    }
    orl_renderer_destroy(&renderer);
    orl_scene_destroy(&scene);
    return result;
}

static enum orl_result nothing_is_left(struct soak *soak, const struct orl_gpu *gpu)
{
    struct orl_gpu_memory row;
    return orl_gpu_memory(gpu, &row, 1) == 0
               ? ORL_OK
               : orl_fail(&soak->log, ORL_ERR_GPU, "%s: %u objects alive", row.tag, row.objects);
}

// The first opening by each method makes a device keep its programs, so these are not measured.
static enum orl_result open_and_close(struct soak *soak, int rounds)
{
    enum orl_result result = ORL_OK;
    struct orl_gpu *gpu = NULL;
    int first = 1;
    while (orl_methods[1 - first].name)
        first--;
    for (int i = first; i <= rounds && result == ORL_OK; i++) {
        if (!gpu)
            result = orl_gpu_create(&soak->log, NULL, &gpu);
        if (result == ORL_OK)
            result = draw_frames(soak, gpu, 1, false);
        if (result == ORL_OK)
            result = nothing_is_left(soak, gpu);
        if (i > 0)
            check_memory(soak, i, rounds, "openings", OPENING_KIB);
        if (i > 0 && i % DEVICES == 0)
            orl_gpu_destroy(&gpu);
    }
    orl_gpu_destroy(&gpu);
    return result;
}

int main(int argc, char **argv)
{
    if (argc != 4) {
        fprintf(stderr, "usage: soak SCENE FRAMES ROUNDS\n");
        return 2;
    }
    struct soak soak = {.log = orl_log_stderr(ORL_LOG_ERROR), .dir = argv[1], .noise = 1};
    struct orl_gpu *gpu = NULL;
    if (orl_gpu_create(&soak.log, NULL, &gpu) != ORL_OK)
        return 77;
    enum orl_result result = draw_frames(&soak, gpu, atoi(argv[2]), true);
    if (result == ORL_OK)
        result = nothing_is_left(&soak, gpu);
    orl_gpu_destroy(&gpu);
    if (result == ORL_OK)
        result = open_and_close(&soak, atoi(argv[3]));
    return result == ORL_OK && !soak.failed ? 0 : 1;
}
