// half_pixel PHOTOGRAPH..: how close a photograph at half its size comes to another of the same thing
// whose pixels lie half a pixel aside, both ways, moved back bicubically. Both are made of one
// photograph at full size: no depth, camera, light or noise differs. It tells what resampling alone
// costs a renderer.
#include <stdio.h>

#include "core/color.h"
#include "eval/metrics.h"
#include "io/picture.h"

// Pixels that are left out all around, at half size, for the taps.
enum { RIM = 2 };

static uint8_t encoded(float light)
{
    return (uint8_t)(255 * orl_srgb_encode(light) + 0.5f);
}

// Mean light of 2x2 pixels from (x, y) on, rounded as a file would.
static float mean_light(const struct orl_image *photo, int x, int y, int channel)
{
    float sum = 0;
    for (int k = 0; k < 4; k++) {
        size_t at = (size_t)(y + k / 2) * (size_t)photo->width + (size_t)(x + k % 2);
        sum += orl_srgb_decode(photo->u8[3 * at + (size_t)channel] / 255.0f);
    }
    return orl_srgb_decode(encoded(sum / 4) / 255.0f);
}

// Half a pixel back: Catmull-Rom's weights there.
static float moved(const struct orl_image *photo, int x, int y, int channel)
{
    static const float weights[4] = {-0.0625f, 0.5625f, 0.5625f, -0.0625f};
    float sum = 0;
    for (int k = 0; k < 16; k++)
        sum += weights[k % 4] * weights[k / 4] *
               mean_light(photo, x + 2 * (k % 4 - 2) + 1, y + 2 * (k / 4 - 2) + 1, channel);
    return sum;
}

static enum orl_result run(const struct orl_log *log, const char *path)
{
    struct orl_image photo = {0}, own = {0}, other = {0}, coverage = {0};
    struct orl_metrics metrics;
    enum orl_result result = orl_picture_read(log, path, 3, &photo);
    int width = photo.width / 2 - 2 * RIM, height = photo.height / 2 - 2 * RIM;
    if (result == ORL_OK)
        result = orl_image_init(log, &own, width, height, 3, ORL_PIXEL_U8);
    if (result == ORL_OK)
        result = orl_image_init(log, &other, width, height, 3, ORL_PIXEL_U8);
    if (result == ORL_OK)
        result = orl_image_init(log, &coverage, width, height, 1, ORL_PIXEL_F32);
    for (int i = 0; result == ORL_OK && i < 3 * width * height; i++) {
        int x = 2 * (i / 3 % width + RIM), y = 2 * (i / 3 / width + RIM);
        own.u8[i] = encoded(mean_light(&photo, x, y, i % 3));
        other.u8[i] = encoded(moved(&photo, x, y, i % 3));
        coverage.f32[i / 3] = 1;
    }
    if (result == ORL_OK)
        result = orl_metrics_compare(log, &other, &own, &coverage, &metrics);
    if (result == ORL_OK)
        printf("%s: %.2f dB, SSIM %.4f\n", path, metrics.psnr_db, metrics.ssim);
    orl_image_finish(&photo);
    orl_image_finish(&own);
    orl_image_finish(&other);
    orl_image_finish(&coverage);
    return result;
}

int main(int argc, char **argv)
{
    struct orl_log log = orl_log_stderr(ORL_LOG_WARNING);
    if (argc < 2) {
        fprintf(stderr, "usage: half_pixel PHOTOGRAPH..\n");
        return 2;
    }
    enum orl_result result = ORL_OK;
    for (int i = 1; result == ORL_OK && i < argc; i++)
        result = run(&log, argv[i]);
    return result == ORL_OK ? 0 : 1;
}
