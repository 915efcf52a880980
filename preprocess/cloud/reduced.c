#include "preprocess/cloud/reduced.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "bridge/bridge.h"
#include "core/memory.h"
#include "io/picture.h"
#include "scene/depth_buffer.h"

enum { POINT_REACH = 2 }; // a point covers the pixels around it as far as this

static void cover(const struct orl_points *points, struct orl_reduced *reduced)
{
    int width = reduced->picture.width, height = reduced->picture.height;
    for (size_t i = 0; i < points->count; i++) {
        double pixel[2], depth;
        if (!orl_point_project(&reduced->view, points->position[i], pixel, &depth))
            continue;
        int left = (int)fmax(pixel[0] - POINT_REACH, 0);
        int right = (int)fmin(pixel[0] + POINT_REACH, width - 1);
        int top = (int)fmax(pixel[1] - POINT_REACH, 0);
        int bottom = (int)fmin(pixel[1] + POINT_REACH, height - 1);
        for (int y = top; y <= bottom; y++)
            for (int x = left; x <= right; x++)
                reduced->open[y * width + x] = false;
    }
}

enum orl_result orl_reduced_read(const struct orl_log *log, const struct orl_scene *scene,
                                 size_t photo, int side, struct orl_reduced *out)
{
    struct orl_image picture = {0};
    const struct orl_view *view = &scene->photos[photo].view;
    const struct orl_camera *c = &view->camera;
    double scale = fmin(1, (double)side / (c->width > c->height ? c->width : c->height));
    int width = (int)fmax(1, round(c->width * scale));
    int height = (int)fmax(1, round(c->height * scale));
    size_t count = (size_t)width * (size_t)height;
    memset(out, 0, sizeof *out);
    out->view = *view;
    out->view.camera = orl_camera_resized(c, width, height);
    ORL_TRY(orl_picture_read(log, orl_scene_photo_path(scene, photo).text, 3, &picture));
    enum orl_result result = orl_bridge_resize(log, &picture, width, height, &out->picture);
    orl_image_finish(&picture);
    if (result != ORL_OK)
        return result;
    out->open = orl_array(log, count, sizeof *out->open);
    ORL_TRY_MEMORY(out->open);
    for (size_t i = 0; i < count; i++)
        out->open[i] = true;
    cover(&scene->points, out);
    return ORL_OK;
}

void orl_reduced_finish(struct orl_reduced *reduced)
{
    orl_image_finish(&reduced->picture);
    free(reduced->open);
    memset(reduced, 0, sizeof *reduced);
}
