// How large Li 2003's packed texture would be (5.3): the boxes around the silhouettes of the first N
// photographs of a scene, side by side, with room to grow.
#include <stdio.h>
#include <stdlib.h>

#include "render/photos.h"

enum { RESERVE = 20 }; // pixels, each way

struct box {
    int width, height;
};

static struct box around(const struct orl_image *mask)
{
    int x0 = mask->width, x1 = -1, y0 = mask->height, y1 = -1;
    for (int i = 0; i < mask->width * mask->height; i++) {
        int x = i % mask->width, y = i / mask->width;
        if (!mask->u8[i])
            continue;
        x0 = x < x0 ? x : x0;
        x1 = x > x1 ? x : x1;
        y0 = y < y0 ? y : y0;
        y1 = y > y1 ? y : y1;
    }
    return x1 < 0 ? (struct box){0, 0} : (struct box){x1 - x0 + 1, y1 - y0 + 1};
}

static enum orl_result measure(const struct orl_log *log, const struct orl_scene *scene)
{
    struct box packed = {RESERVE, RESERVE};
    double pixels = 0;
    int count = 0;
    printf("%-12s %-12s %10s\n", "photographs", "packed", "of all");
    for (size_t i = 0; i < scene->photo_count; i++) {
        struct orl_image mask;
        if (!scene->photos[i].masked)
            continue;
        enum orl_result result = orl_photo_mask_read(log, scene, i, &mask);
        if (result != ORL_OK)
            return result;
        struct box box = around(&mask);
        packed.width += box.width;
        if (box.height + RESERVE > packed.height)
            packed.height = box.height + RESERVE;
        pixels += (double)mask.width * mask.height;
        char size[32];
        snprintf(size, sizeof size, "%dx%d", packed.width, packed.height);
        printf("%-12d %-12s %9.1f%%\n", ++count, size,
               100.0 * packed.width * packed.height / pixels);
        orl_image_finish(&mask);
    }
    return ORL_OK;
}

int main(int argc, char **argv)
{
    struct orl_scene *scene = NULL;
    struct orl_log log = orl_log_stderr(ORL_LOG_WARNING);
    if (argc != 2) {
        fprintf(stderr, "usage: %s SCENE\n", argv[0]);
        return 2;
    }
    enum orl_result result = orl_scene_open(&log, argv[1], &scene);
    if (result == ORL_OK)
        result = measure(&log, scene);
    orl_scene_destroy(&scene);
    return result == ORL_OK ? 0 : 1;
}
