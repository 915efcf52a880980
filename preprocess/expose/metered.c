#include "preprocess/expose/metered.h"

#include "core/color.h"
#include "core/file.h"
#include "io/picture.h"
#include "scene/meter.h"

enum { SAMPLES_ACROSS = 256 }; // of the longer side; more do not change a mean

enum orl_result orl_photo_metered(const struct orl_log *log, const char *dir, struct orl_exposed *photo,
                                  const float gain[3])
{
    struct orl_image image = {0};
    struct orl_meter meter = {0};
    enum orl_result result = orl_picture_read(log, ORL_PATH(dir, "%s", photo->name), 3, &image);
    int longer = image.width > image.height ? image.width : image.height;
    int step = longer > SAMPLES_ACROSS ? longer / SAMPLES_ACROSS : 1;
    for (int y = step / 2; y < image.height; y += step)
        for (int x = step / 2; x < image.width; x += step) {
            const uint8_t *v = image.u8 + 3 * ((size_t)y * (size_t)image.width + (size_t)x);
            float rgb[3];
            float dimmed = orl_illumination(photo->vignette, &photo->view.camera, x + 0.5, y + 0.5);
            for (int c = 0; c < 3; c++)
                rgb[c] = orl_light_aligned(gain[c] / dimmed, orl_srgb_decode((float)v[c] / 255));
            orl_meter_add(&meter, rgb, x + 0.5, y + 0.5, image.width, image.height);
        }
    orl_image_finish(&image);
    photo->light = orl_meter_log2(&meter);
    return result;
}

// The slope is by least squares.
bool orl_exposures_are_metered(const struct orl_exposed *photos, size_t count)
{
    double mean_ev = 0, mean_light = 0, spread = 0, both = 0;
    for (size_t i = 0; i < count; i++) {
        mean_ev += photos[i].ev / (double)count;
        mean_light += photos[i].light / (double)count;
    }
    for (size_t i = 0; i < count; i++) {
        spread += (photos[i].ev - mean_ev) * (photos[i].ev - mean_ev);
        both += (photos[i].ev - mean_ev) * (photos[i].light - mean_light);
    }
    return 4 * both < spread;
}
