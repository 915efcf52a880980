#include "scene/silhouette.h"

#include <math.h>
#include <string.h>

#include "bridge/bridge.h"

// Pieces and holes smaller than this fraction of the picture are specks. Before a dark background
// larger ones count too: glints of the background, and shadows, which would harm a hull.
static const double SPECK_SHARE = 0.0005, DARK_SPECK_SHARE = 0.003;

void orl_silhouette_mark_edges(struct orl_image *mask)
{
    int w = mask->width, h = mask->height;
    size_t row = (size_t)w;
    // All inside pixels become IN first; the edge test below then asks only for OUT (0).
    for (size_t i = 0; i < row * (size_t)h; i++)
        mask->u8[i] = mask->u8[i] ? ORL_ALPHA_IN : ORL_ALPHA_OUT;
    for (int y = 0; y < h; y++)
        for (int x = 0; x < w; x++) {
            uint8_t *at = mask->u8 + (size_t)y * row + (size_t)x;
            // Pixels beyond the picture's border are unknown and mark no edge.
            bool edge = (x > 0 && !at[-1]) || (x + 1 < w && !at[1]) ||
                        (y > 0 && !*(at - row)) || (y + 1 < h && !at[row]);
            if (*at && edge)
                *at = ORL_ALPHA_EDGE;
        }
}

static enum orl_result clean(const struct orl_log *log, int open_px, int close_px, double share,
                             struct orl_image *mask)
{
    int speck = (int)(share * mask->width * mask->height) + 1;
    struct orl_image cleaned;
    enum orl_result result = orl_bridge_clean_mask(
        log, mask, &(struct orl_mask_cleaning){open_px, close_px, speck, speck}, &cleaned);
    orl_image_finish(mask);
    *mask = cleaned;
    return result;
}

// Diameter in pixels of the disc that a mask is opened with: 3 at VGA; 1 (no opening) for small
// pictures, where limbs may be that thin.
static int disc_of(const struct orl_image *picture)
{
    return picture->height > 1000 ? 5 : picture->height > 300 ? 3 : 1;
}

// --- dark background ---

// Levels of the square root of the greatest channel. The square root equalises the noise of dark
// and bright pixels.
enum { STEPS = 64 };
static int step_of(int value)
{
    return (int)(sqrt(value / 255.0) * (STEPS - 1) + 0.5);
}

// The threshold that maximises the variance between the two classes (Otsu 1979).
static int otsu(const size_t histogram[STEPS])
{
    double total = 0, sum = 0, below = 0, sum_below = 0, best = -1;
    int at = 0;
    for (int i = 0; i < STEPS; i++) {
        total += (double)histogram[i];
        sum += (double)i * (double)histogram[i];
    }
    for (int i = 0; i < STEPS - 1; i++) {
        below += (double)histogram[i];
        sum_below += (double)i * (double)histogram[i];
        if (!(below > 0) || !(total - below > 0))
            continue;
        double apart = sum_below / below - (sum - sum_below) / (total - below);
        double between = below * (total - below) * apart * apart;
        if (between > best) {
            best = between;
            at = i;
        }
    }
    double root = (at + 0.5) / (STEPS - 1);
    return (int)(255 * root * root);
}

enum orl_result orl_silhouette_dark(const struct orl_log *log, const struct orl_image *picture,
                                    int threshold, int *used, struct orl_image *mask)
{
    memset(mask, 0, sizeof *mask);
    ORL_REQUIRE(log, picture->type == ORL_PIXEL_U8 && picture->channels == 3 && threshold < 255);
    ORL_TRY(orl_image_init(log, mask, picture->width, picture->height, 1, ORL_PIXEL_U8));
    size_t histogram[STEPS] = {0}, count = orl_image_bytes(mask);
    for (size_t i = 0; i < count; i++) {
        const uint8_t *rgb = picture->u8 + 3 * i;
        uint8_t most = rgb[0] > rgb[1] ? rgb[0] : rgb[1];
        mask->u8[i] = most > rgb[2] ? most : rgb[2];
        histogram[step_of(mask->u8[i])]++;
    }
    *used = threshold >= 0 ? threshold : otsu(histogram);
    for (size_t i = 0; i < count; i++)
        mask->u8[i] = mask->u8[i] > *used ? 255 : 0;
    return clean(log, disc_of(picture), 2 * disc_of(picture) + 1, DARK_SPECK_SHARE, mask);
}

// --- difference from the background ---

// Updates the mean and the variance by Welford's method.
enum orl_result orl_background_add(const struct orl_log *log, struct orl_background *b,
                                   const struct orl_image *picture)
{
    ORL_REQUIRE(log, picture->type == ORL_PIXEL_U8 && picture->channels == 3);
    if (!b->count) {
        ORL_TRY(orl_image_init(log, &b->mean, picture->width, picture->height, 3, ORL_PIXEL_F32));
        ORL_TRY(orl_image_init(log, &b->deviation, picture->width, picture->height, 3, ORL_PIXEL_F32));
    }
    if (picture->width != b->mean.width || picture->height != b->mean.height)
        return orl_fail(log, ORL_ERR_DATA, "a background picture of %dx%d pixels among those of "
                        "%dx%d", picture->width, picture->height, b->mean.width, b->mean.height);
    float n = (float)++b->count;
    size_t count = orl_image_bytes(picture);
    for (size_t i = 0; i < count; i++) {
        float value = (float)picture->u8[i], off = value - b->mean.f32[i];
        b->mean.f32[i] += off / n;
        // Updates the variance of n - 1 pictures to that of n.
        b->deviation.f32[i] += (off * (value - b->mean.f32[i]) - b->deviation.f32[i]) / n;
    }
    return ORL_OK;
}

void orl_background_finish(struct orl_background *background)
{
    orl_image_finish(&background->mean);
    orl_image_finish(&background->deviation);
    background->count = 0;
}

static bool is_subject(const float mean[3], const float variance[3], const uint8_t pixel[3],
                       const struct orl_difference_params *p)
{
    double weight[3], along = 0, square = 0, colour = 0, brightness = 0;
    for (int c = 0; c < 3; c++) {
        double deviation = fmax(sqrt((double)variance[c]), p->deviation_min);
        weight[c] = 1 / (deviation * deviation);
        along += weight[c] * (double)mean[c] * pixel[c];
        square += weight[c] * (double)mean[c] * (double)mean[c];
    }
    // The factor that brings the background's colour nearest to the pixel's (its brightness).
    double alpha = square > 0 ? along / square : 1;
    for (int c = 0; c < 3; c++) {
        double off = pixel[c] - alpha * (double)mean[c], step = (alpha - 1) * (double)mean[c];
        colour += weight[c] * off * off;
        brightness += weight[c] * step * step;
    }
    if (colour > p->sigmas * p->sigmas)
        return true;
    return brightness > p->sigmas * p->sigmas && (alpha < p->shadow || alpha > p->light);
}

enum orl_result orl_silhouette_difference(const struct orl_log *log,
                                          const struct orl_background *background,
                                          const struct orl_difference_params *params,
                                          const struct orl_image *picture, struct orl_image *mask)
{
    memset(mask, 0, sizeof *mask);
    ORL_REQUIRE(log, background->count > 0 && picture->type == ORL_PIXEL_U8 &&
                         picture->channels == 3);
    if (picture->width != background->mean.width || picture->height != background->mean.height)
        return orl_fail(log, ORL_ERR_DATA, "a picture of %dx%d pixels, but its background has "
                        "%dx%d", picture->width, picture->height, background->mean.width,
                        background->mean.height);
    ORL_TRY(orl_image_init(log, mask, picture->width, picture->height, 1, ORL_PIXEL_U8));
    size_t count = orl_image_bytes(mask);
    for (size_t i = 0; i < count; i++)
        mask->u8[i] = is_subject(background->mean.f32 + 3 * i, background->deviation.f32 + 3 * i,
                                 picture->u8 + 3 * i, params) ? 255 : 0;
    return clean(log, disc_of(picture), disc_of(picture) + 2, SPECK_SHARE, mask);
}
