// Takes depths that the stereo is not sure of out of a scene's maps: what is below a confidence
// becomes 0. For tests/bench/confidence.sh.
// usage: bench_cut_depths SCENE CONFIDENCE
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "core/file.h"
#include "core/memory.h"
#include "scene/colmap.h"

static enum orl_result cut(const char *scene, const char *name, double least)
{
    struct orl_image depth = {0}, confidence = {0};
    char *depths = orl_format(NULL, "%s/stereo/depth_maps/%s", scene, name);
    char *confidences = orl_format(NULL, "%s/stereo/confidence_maps/%s", scene, name);
    enum orl_result result = depths && confidences ? orl_colmap_map_read(NULL, depths, &depth)
                                                   : ORL_ERR_MEMORY;
    if (result == ORL_OK)
        result = orl_colmap_map_read(NULL, confidences, &confidence);
    size_t count = result == ORL_OK ? (size_t)depth.width * (size_t)depth.height : 0;
    size_t had = 0, left = 0;
    for (size_t i = 0; i < count; i++) {
        had += depth.f32[i] > 0;
        if ((double)confidence.f32[i] < least)
            depth.f32[i] = 0;
        left += depth.f32[i] > 0;
    }
    if (result == ORL_OK)
        result = orl_colmap_map_write(NULL, depths, &depth);
    printf("%s: %zu of %zu depths left\n", name, left, had);
    orl_image_finish(&depth);
    orl_image_finish(&confidence);
    free(depths);
    free(confidences);
    return result;
}

int main(int argc, char **argv)
{
    struct orl_names names = {0};
    char *dir = argc == 3 ? orl_path_join(NULL, argv[1], "stereo/confidence_maps") : NULL;
    enum orl_result result = dir ? orl_dir_list(NULL, dir, &names) : ORL_ERR_ARGUMENT;
    for (size_t i = 0; result == ORL_OK && i < names.count; i++)
        if (strstr(names.items[i], ".geometric.bin"))
            result = cut(argv[1], names.items[i], atof(argv[2]));
    if (result != ORL_OK)
        fprintf(stderr, "usage: bench_cut_depths SCENE CONFIDENCE, a scene of prepare --keep all\n");
    orl_names_finish(&names);
    free(dir);
    return result != ORL_OK;
}
