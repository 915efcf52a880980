// merge_time SCENE [ROUNDS]: processor time and device memory of both merges of a scene of several
// exposures, seen from its held-out photographs, in turn in one process after a first draw of each.
// Mean of the rounds. A scene of radiance photographs has only the first merge.
#include <stdio.h>
#include <stdlib.h>

#include "core/process.h"
#include "oriel/hdr.h"

static enum orl_result time_view(struct orl_hdr *const hdr[ORL_HDR_MERGE_COUNT],
                                 const struct orl_view *view, int rounds,
                                 double seconds[ORL_HDR_MERGE_COUNT])
{
    enum orl_result result = ORL_OK;
    for (int i = 0; i <= rounds; i++)
        for (int m = 0; result == ORL_OK && m < ORL_HDR_MERGE_COUNT && hdr[m]; m++) {
            struct orl_frame frame = {0};
            double start = orl_cpu_time_s();
            result = orl_hdr_draw(hdr[m], view, NULL, &frame);
            seconds[m] += i ? (orl_cpu_time_s() - start) / rounds : 0;
            orl_frame_finish(&frame);
        }
    return result;
}

static enum orl_result run(struct orl_gpu *gpu, const struct orl_scene *scene, int rounds)
{
    struct orl_hdr *hdr[ORL_HDR_MERGE_COUNT] = {0};
    double seconds[ORL_HDR_MERGE_COUNT] = {0};
    size_t bytes[ORL_HDR_MERGE_COUNT] = {0};
    int views = 0, merges = ORL_HDR_MERGE_COUNT;
    enum orl_result result = ORL_OK;
    for (size_t i = 0; i < scene->photo_count; i++)
        if (scene->photos[i].radiance)
            merges = ORL_HDR_FUSED + 1;
    for (int m = 0; result == ORL_OK && m < merges; m++) {
        size_t before = orl_gpu_owner_bytes(gpu, ORL_OWNER_PHOTOGRAPHS);
        struct orl_hdr_params params = {ORL_HDR_DEFAULTS};
        params.merge = (enum orl_hdr_merge)m;
        params.render = orl_method_find(orl_gpu_log(gpu), "oriel")->params;
        result = orl_hdr_create(gpu, scene, &params, &hdr[m]);
        bytes[m] = orl_gpu_owner_bytes(gpu, ORL_OWNER_PHOTOGRAPHS) - before;
    }
    for (size_t i = 0; result == ORL_OK && i < scene->photo_count; i++)
        if (scene->photos[i].test) {
            result = time_view(hdr, &scene->photos[i].view, rounds, seconds);
            views++;
        }
    if (result == ORL_OK && !views)
        result = orl_fail(orl_gpu_log(gpu), ORL_ERR_DATA, "no photograph is held out");
    for (int m = 0; result == ORL_OK && m < merges; m++)
        printf("%s %.3f s of the processor a view, photographs %.1f MiB\n", orl_hdr_merge_names[m],
               seconds[m] / views, (double)bytes[m] / (1 << 20));
    for (int m = 0; m < ORL_HDR_MERGE_COUNT; m++)
        orl_hdr_destroy(&hdr[m]);
    return result;
}

int main(int argc, char **argv)
{
    struct orl_log log = orl_log_stderr(ORL_LOG_WARNING);
    struct orl_scene *scene = NULL;
    struct orl_gpu *gpu = NULL;
    int rounds = argc > 2 ? atoi(argv[2]) : 6;
    if (argc < 2 || argc > 3 || rounds < 1) {
        fprintf(stderr, "usage: merge_time SCENE [ROUNDS]\n");
        return 2;
    }
    enum orl_result result = orl_scene_open(&log, argv[1], &scene);
    if (result == ORL_OK)
        result = orl_gpu_create(&log, NULL, &gpu);
    if (result == ORL_OK)
        result = run(gpu, scene, rounds);
    orl_gpu_destroy(&gpu);
    orl_scene_destroy(&scene);
    return result == ORL_OK ? 0 : 1;
}
