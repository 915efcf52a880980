// A site's soft splats: what the page draws of them, and what they show in the photographs.
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "core/memory.h"
#include "io/picture.h"
#include "render/paint/paint.h"
#include "shared/constants.h"
#include "soft/soft_ply.h"
#include "walk/internal.h"

// As web/shaders/soft.vert reads it. What lies beyond the range of a fraction becomes its end.
struct record {
    float place[3];
    uint16_t sigma[3];   // logarithms of the standard deviations, as ORL_SOFT_SIGMA_LOG has them
    uint8_t opacity;
    uint8_t pixel;       // its logarithm, within the range of all splats
    int8_t turn[4];      // unit quaternion
    int8_t color[4];     // coefficients, of up to ORL_SOFT_COLOR_MOST; 0
};
_Static_assert(sizeof(struct record) == 28, "the page's layout");

// Of the sizes of a photograph's pixel that are known.
struct range {
    double least, octaves;
};

static struct range pixel_range(const struct orl_soft_model *model)
{
    double least = INFINITY, most = 0;
    for (size_t i = 0; i < model->count; i++) {
        double pixel = (double)model->splats[i][ORL_SOFT_PIXEL];
        least = pixel > 0 ? fmin(least, pixel) : least;
        most = fmax(most, pixel);
    }
    return most > 0 ? (struct range){least, log2(most / least)} : (struct range){1, 0};
}

// x of [0, 1] or [-1, 1], in steps of 1 / most.
static long fraction(double x, double least, int most)
{
    return lrint(fmin(fmax(x, least), 1) * most);
}

static struct record pack(const float s[ORL_SOFT_VALUES], const struct range *pixels)
{
    struct record r = {.opacity = (uint8_t)fraction(1 / (1 + exp(-(double)s[ORL_SOFT_OPACITY])), 0, 255)};
    double octave = s[ORL_SOFT_PIXEL] > 0 ? log2((double)s[ORL_SOFT_PIXEL] / pixels->least) : 0, length = 1e-12;
    memcpy(r.place, s + ORL_SOFT_PLACE, sizeof r.place);
    r.pixel = (uint8_t)fraction(octave / fmax(pixels->octaves, 1e-12), 0, 255);
    for (int k = 0; k < 3; k++)
        r.sigma[k] = (uint16_t)fraction((double)s[ORL_SOFT_SIGMA + k] / (2 * ORL_SOFT_SIGMA_LOG) + 0.5, 0, UINT16_MAX);
    for (int k = 0; k < 4; k++)
        length = hypot(length, (double)s[ORL_SOFT_TURN + k]);
    for (int k = 0; k < 4; k++)
        r.turn[k] = (int8_t)fraction((double)s[ORL_SOFT_TURN + k] / length, -1, 127);
    for (int k = 0; k < 3; k++)
        r.color[k] = (int8_t)fraction((double)s[ORL_SOFT_COLOR + k] / ORL_SOFT_COLOR_MOST, -1, 127);
    return r;
}

static enum orl_result write_splats(struct site *site, const struct orl_soft_model *model, json_t **out)
{
    static const char path[] = "soft/splats.bin";
    const struct range pixels = pixel_range(model);
    struct record *records = orl_array(site->log, model->count, sizeof *records);
    enum orl_result result = records ? ORL_OK : ORL_ERR_MEMORY;
    for (size_t i = 0; result == ORL_OK && i < model->count; i++)
        records[i] = pack(model->splats[i], &pixels);
    ORL_THEN(result, orl_site_write(site, path, records, model->count * sizeof *records));
    free(records);
    json_t *file = result == ORL_OK ? orl_site_file(site, path) : NULL;
    if (file)
        json_object_set_new(file, "pixel", json_pack("[f,f]", pixels.least, pixels.octaves));
    *out = file;
    return result == ORL_OK && !file ? ORL_ERR_IO : result;
}

enum orl_result orl_site_soft(struct site *site, json_t **soft)
{
    struct orl_soft_model model = {0};
    if (!(site->render.soft > 0) || site->params->radiance || site->carves)
        return ORL_OK;
    enum orl_result result = orl_dir_make(site->log, ORL_PATH(site->dir, "soft"));
    ORL_THEN(result, orl_soft_read_scene(site->log, site->scene->dir, &model));
    ORL_THEN(result, orl_soft_raster_init(site->gpu, &model, &site->soft));
    ORL_THEN(result, write_splats(site, &model, soft));
    orl_soft_finish(&model);
    return result;
}

enum orl_result orl_site_soft_photo(struct site *site, const struct orl_view *view, const char *path)
{
    const struct orl_tex_params params = {.width = view->camera.width, .height = view->camera.height, .layers = 1,
                                          .format = GL_R8, .owner = ORL_OWNER_PHOTOGRAPHS,
                                          .tag = "soft splats in a photograph"};
    struct orl_image shown = {0};
    struct orl_tex *slot = NULL;
    enum orl_result result = orl_tex_create(site->gpu, &params, &slot);
    ORL_THEN(result, orl_image_init(site->log, &shown, params.width, params.height, 1, ORL_PIXEL_U8));
    ORL_THEN(result, orl_soft_layer_keep(site->gpu, &site->soft, view, slot, 0));
    if (result == ORL_OK) {
        orl_tex_read(slot, 0, GL_RED, GL_UNSIGNED_BYTE, orl_image_bytes(&shown), shown.u8);
        result = orl_gpu_finish(site->gpu);
    }
    ORL_THEN(result, orl_jpeg_write(site->log, ORL_PATH(site->dir, "%s", path), &shown, site->params->jpeg_quality,
                                    NULL));
    orl_tex_destroy(site->gpu, &slot);
    orl_image_finish(&shown);
    return result;
}
