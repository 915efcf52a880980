#include "scene/light.h"

#include <math.h>

#include "core/color.h"

enum orl_result orl_scene_set_light(const struct orl_log *log, struct orl_scene *scene,
                                    const char *photo)
{
    if (!photo)
        return ORL_OK;
    int index = orl_scene_find_photo(scene, photo);
    if (index < 0)
        return orl_fail(log, ORL_ERR_ARGUMENT, "--light %s: there is no such photograph", photo);
    if (scene->photos[index].test)
        return orl_fail(log, ORL_ERR_ARGUMENT, "--light %s: this photograph is held out", photo);
    float light[3];
    for (int c = 0; c < 3; c++)
        light[c] = scene->photos[index].gain[c];
    // Renderings become darker by this, and what meters them follows.
    float darker_ev = log2f(orl_luminance(light));
    for (size_t i = 0; i < scene->photo_count; i++) {
        for (int c = 0; c < 3; c++)
            scene->photos[i].gain[c] /= light[c];
        scene->photos[i].metered_ev -= darker_ev;
    }
    return ORL_OK;
}
