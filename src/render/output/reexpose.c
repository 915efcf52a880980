#include "render/output/reexpose.h"

#include <math.h>
#include <string.h>

#include "core/color.h"
#include "scene/meter.h"

// The 8-bit value to which the curve gives the nearest exposure. The curve increases.
static uint8_t nearest_value(const float curve[256], float exposure)
{
    int low = 0, high = 255;
    if (!(exposure > curve[0])) // includes NaN
        return 0;
    if (exposure >= curve[255])
        return 255;
    while (high - low > 1) {
        int middle = (low + high) / 2;
        if (curve[middle] <= exposure)
            low = middle;
        else
            high = middle;
    }
    return (uint8_t)(exposure - curve[low] < curve[high] - exposure ? low : high);
}

// Relative illumination of a pixel of a picture of any size.
static float illumination(const struct orl_photo *photo, const struct orl_image *light, int x,
                          int y)
{
    const struct orl_camera seen =
        orl_camera_resized(&photo->view.camera, light->width, light->height);
    return orl_illumination(photo->vignette, &seen, x + 0.5, y + 0.5);
}

// The gain of the photograph for a picture of this light: its own if it has no metering.
static void metered_gain(const struct orl_photo *photo, const struct orl_image *color,
                         float gain[3])
{
    double stops = photo->metering == 0 ? 0
                                        : orl_picture_metered(color) - (double)photo->metered_ev;
    for (int c = 0; c < 3; c++)
        gain[c] = photo->gain[c] * (float)exp2((double)photo->metering * stops);
}

enum orl_result orl_photo_expose(const struct orl_log *log, const struct orl_scene *scene,
                                 size_t index, const struct orl_image *light,
                                 struct orl_image *picture)
{
    memset(picture, 0, sizeof *picture);
    ORL_REQUIRE(log, index < scene->photo_count);
    ORL_REQUIRE(log, light->data && light->type == ORL_PIXEL_F32 && light->channels == 3);
    const struct orl_photo *photo = &scene->photos[index];
    const struct orl_response *response =
        photo->response >= 0 ? &scene->responses[photo->response] : NULL;
    float gain[3];
    metered_gain(photo, light, gain);
    bool vignetted = photo->vignette[0] != 0 || photo->vignette[1] != 0 || photo->vignette[2] != 0;
    enum orl_result result = orl_image_init(log, picture, light->width, light->height, 3,
                                            ORL_PIXEL_U8);
    for (int y = 0; result == ORL_OK && y < light->height; y++)
        for (int x = 0; x < light->width; x++) {
            size_t at = 3 * ((size_t)y * (size_t)light->width + (size_t)x);
            float dimmed = vignetted ? illumination(photo, light, x, y) : 1;
            for (size_t c = 0; c < 3; c++) {
                float exposure = light->f32[at + c] / gain[c] * dimmed;
                picture->u8[at + c] =
                    response ? nearest_value(response->linear[c], exposure)
                             : (uint8_t)lrintf(255 * orl_srgb_encode(exposure));
            }
        }
    return result;
}

// Solves y = orl_light_aligned(gain, x) for x by bisection, since the right side increases. It is
// multiplied by its denominator, as there are many pixels.
static float unaligned(float gain, float y)
{
    float third = fminf(gain - 1, 0.5f), low = 0, high = 1;
    float linear = gain - y * (gain - 1 - third), cubic = y * third;
    if (y >= 1)
        return y;
    for (int i = 0; i < 20; i++) {
        float x = 0.5f * (low + high);
        if (x * (linear - cubic * x * x) < y)
            low = x;
        else
            high = x;
    }
    return 0.5f * (low + high);
}

void orl_photo_unalign(const struct orl_photo *photo, struct orl_image *color)
{
    float gain[3];
    metered_gain(photo, color, gain);
    for (int y = 0; y < color->height; y++)
        for (int x = 0; x < color->width; x++) {
            float dimmed = illumination(photo, color, x, y);
            float *pixel =
                color->f32 + 3 * ((size_t)y * (size_t)color->width + (size_t)x);
            for (int c = 0; c < 3; c++)
                pixel[c] = unaligned(gain[c] / dimmed, pixel[c]);
        }
}
