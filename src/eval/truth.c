#include "eval/truth.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "core/file.h"
#include "core/json.h"
#include "core/memory.h"
#include "io/exr.h"
#include "io/picture.h"
#include "scene/colmap.h"

static bool same_stem(const char *a, const char *b)
{
    size_t length = orl_path_stem(a);
    return length == orl_path_stem(b) && strncmp(a, b, length) == 0;
}

static enum orl_result take_exposures(const struct orl_log *log, const char *path,
                                      const json_t *root, struct orl_truth *truth)
{
    const json_t *photos = json_object_get(root, "photographs");
    for (size_t i = 0; i < truth->scene->photo_count; i++) {
        const char *name = truth->scene->photos[i].name;
        bool found = false;
        for (size_t k = 0; k < json_array_size(photos) && !found; k++) {
            const json_t *entry = json_array_get(photos, k);
            const char *photo = orl_json_text(entry, "photo");
            const json_t *ev = json_object_get(entry, "exposure_ev");
            found = photo && same_stem(photo, name) && json_is_number(ev);
            if (found)
                truth->ev[i] = json_number_value(ev);
        }
        if (!found)
            return orl_fail(log, ORL_ERR_NOT_FOUND, "%s: says nothing of photograph %s", path,
                            name);
    }
    return ORL_OK;
}

static enum orl_result read_summary(const struct orl_log *log, struct orl_truth *truth)
{
    json_t *root = NULL;
    const char *path = ORL_PATH(truth->dir, "synth.json");
    enum orl_result result = orl_json_read(log, path, &root);
    ORL_THEN(result, take_exposures(log, path, root, truth));
    json_decref(root);
    return result;
}

enum orl_result orl_truth_open(const struct orl_log *log, const struct orl_scene *scene,
                               const char *dir, struct orl_truth *truth)
{
    memset(truth, 0, sizeof *truth);
    truth->scene = scene;
    truth->dir = orl_strdup(log, dir);
    truth->ev = orl_array(log, scene->photo_count, sizeof *truth->ev);
    const char *model = ORL_PATH(scene->dir, ".oriel/calibrate/model");
    truth->vehicle = orl_path_is_dir(ORL_PATH(dir, "vehicle"));
    enum orl_result result = truth->dir && truth->ev ? read_summary(log, truth) : ORL_ERR_MEMORY;
    if (result == ORL_OK && orl_path_is_dir(model))
        result = orl_colmap_read(log, model, &truth->model);
    else if (result == ORL_OK)
        orl_logf(log, ORL_LOG_WARNING, "%s: no such folder; photographs are taken to have had no "
                 "distortion", model);
    if (result != ORL_OK)
        orl_truth_finish(truth);
    return result;
}

void orl_truth_finish(struct orl_truth *truth)
{
    free(truth->dir);
    free(truth->ev);
    orl_colmap_finish(&truth->model);
    memset(truth, 0, sizeof *truth);
}

// Undistorts what was seen from the pixels of the photograph as taken to those of the scene.
static enum orl_result bring_to_pixels(const struct orl_log *log, const struct orl_truth *truth,
                                       const struct orl_photo *photo, const char *path,
                                       struct orl_image *seen, struct orl_image *out)
{
    const struct orl_camera *to = &photo->view.camera;
    if (truth->model.image_count) {
        const struct orl_colmap_image *image = orl_colmap_image_by_name(&truth->model, photo->name);
        const struct orl_colmap_camera *from = image ? orl_colmap_camera_by_id(&truth->model, image->camera_id) : NULL;
        return from ? orl_undistort(log, from, to, seen, out)
                    : orl_fail(log, ORL_ERR_DATA, "%s: not in the calibrated model", photo->name);
    }
    if (seen->width != to->width || seen->height != to->height)
        return orl_fail(log, ORL_ERR_DATA, "%s: %dx%d pixels, but the photograph has %dx%d", path,
                        seen->width, seen->height, to->width, to->height);
    *out = *seen;
    memset(seen, 0, sizeof *seen);
    return ORL_OK;
}

enum orl_result orl_truth_read(const struct orl_log *log, const struct orl_truth *truth,
                               size_t index, struct orl_image *radiance)
{
    static const char *const rgb[] = {"R", "G", "B"};
    memset(radiance, 0, sizeof *radiance);
    const struct orl_photo *photo = &truth->scene->photos[index];
    struct orl_image seen = {0};
    const char *path = ORL_PATH(truth->dir, "radiance/%.*s.exr", (int)orl_path_stem(photo->name), photo->name);
    enum orl_result result = orl_exr_read(log, path, rgb, 3, &seen);
    ORL_THEN(result, bring_to_pixels(log, truth, photo, path, &seen, radiance));
    // A photograph of exposure e shows radiance times 2^e. The scene's unit does so at its middle
    // exposure, which is exposure_ev below e.
    float scale = (float)exp2(truth->ev[index] - photo->exposure_ev);
    size_t count = result == ORL_OK ? orl_image_bytes(radiance) / sizeof(float) : 0;
    for (size_t i = 0; i < count; i++)
        radiance->f32[i] *= scale;
    orl_image_finish(&seen);
    return result;
}

enum orl_result orl_truth_vehicle(const struct orl_log *log, const struct orl_truth *truth,
                                  size_t index, struct orl_image *vehicle)
{
    memset(vehicle, 0, sizeof *vehicle);
    const struct orl_photo *photo = &truth->scene->photos[index];
    struct orl_image mask = {0}, seen = {0};
    const char *path = ORL_PATH(truth->dir, "vehicle/%.*s.png", (int)orl_path_stem(photo->name), photo->name);
    enum orl_result result = orl_picture_read(log, path, 1, &mask);
    ORL_THEN(result, orl_image_init(log, &seen, mask.width, mask.height, 1, ORL_PIXEL_F32));
    for (size_t i = 0; result == ORL_OK && i < orl_image_bytes(&mask); i++)
        seen.f32[i] = (float)mask.u8[i] / 255;
    ORL_THEN(result, bring_to_pixels(log, truth, photo, path, &seen, vehicle));
    orl_image_finish(&mask);
    orl_image_finish(&seen);
    return result;
}
