#include "scene/remap.h"

#include <string.h>

#include "bridge/bridge.h"

static enum orl_result make_map(const struct orl_log *log, const struct orl_colmap_camera *from,
                                const struct orl_camera *to, struct orl_image *map)
{
    enum orl_result result = orl_image_init(log, map, to->width, to->height, 2, ORL_PIXEL_F32);
    for (int y = 0; result == ORL_OK && y < to->height; y++) {
        float *at = map->f32 + 2 * (size_t)y * (size_t)to->width;
        for (int x = 0; x < to->width; x++, at += 2) {
            const double ray[2] = {(x + 0.5 - to->cx) / to->fx, (y + 0.5 - to->cy) / to->fy};
            double pixel[2];
            orl_colmap_camera_project(from, ray, pixel);
            at[0] = (float)(pixel[0] - 0.5);
            at[1] = (float)(pixel[1] - 0.5);
        }
    }
    return result;
}

enum orl_result orl_undistort(const struct orl_log *log, const struct orl_colmap_camera *from,
                              const struct orl_camera *to, const struct orl_image *image,
                              struct orl_image *undistorted)
{
    memset(undistorted, 0, sizeof *undistorted);
    struct orl_image map = {0}, warped = {0};
    const struct orl_camera *size = &from->pinhole;
    if (image->width != size->width || image->height != size->height)
        return orl_fail(log, ORL_ERR_DATA, "a picture of %dx%d pixels, but its camera has %dx%d",
                        image->width, image->height, size->width, size->height);
    // One resampling suffices unless the picture shrinks.
    bool shrinks = to->fx < 0.999 * size->fx || to->fy < 0.999 * size->fy;
    struct orl_camera full = shrinks ? orl_camera_resized(to, size->width, size->height) : *to;
    enum orl_result result = make_map(log, from, &full, &map);
    ORL_THEN(result, orl_bridge_remap(log, image, &map, &warped));
    if (result == ORL_OK && (to->width != full.width || to->height != full.height))
        result = orl_bridge_reduce(log, &warped, to->width, to->height, undistorted);
    else if (result == ORL_OK) {
        *undistorted = warped;
        memset(&warped, 0, sizeof warped);
    }
    orl_image_finish(&map);
    orl_image_finish(&warped);
    return result;
}
