// What gets worse about photographs.
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "core/color.h"
#include "core/memory.h"
#include "eval/stress_internal.h"

static uint8_t to_byte(double value)
{
    return (uint8_t)(value <= 0 ? 0 : value >= 255 ? 255 : value + 0.5);
}

static size_t pixels_of(const struct orl_image *image)
{
    return (size_t)image->width * (size_t)image->height;
}

// --- exposure and colour ---

// Numbers from -1/2 to 1/2, evenly spread over the photographs in a random order.
static double spread_over(const struct stress_case *c, size_t photo, uint64_t seed)
{
    double rank = 0, count = 0, own = orl_stress_uniform(seed, photo, 0);
    for (size_t i = 0; i < c->scene.photo_count; i++) {
        if (c->scene.photos[i].test)
            continue;
        rank += orl_stress_uniform(seed, i, 0) < own;
        count++;
    }
    return count > 1 ? rank / (count - 1) - 0.5 : 0;
}

// Multiplies linear light, as a camera's exposure does: what is too bright is clipped.
static void expose(struct orl_image *image, const double ev[3])
{
    uint8_t table[3][256];
    for (int k = 0; k < 3; k++)
        for (int v = 0; v < 256; v++) {
            double light = (double)orl_srgb_decode((float)v / 255) * exp2(ev[k]);
            table[k][v] = to_byte(255 * (double)orl_srgb_encode((float)light));
        }
    for (size_t i = 0; i < pixels_of(image); i++)
        for (size_t k = 0; k < 3; k++)
            image->u8[3 * i + k] = table[k][image->u8[3 * i + k]];
}

enum orl_result orl_stress_exposure(struct stress_case *c, double level, uint64_t seed)
{
    for (size_t i = 0; i < c->scene.photo_count; i++) {
        double ev = level * spread_over(c, i, seed);
        if (!c->scene.photos[i].test)
            expose(&c->photos[i], (double[]){ev, ev, ev});
    }
    return ORL_OK;
}

// The same, and the scene knows it: the gains undo it, but for what is clipped or rounded.
enum orl_result orl_stress_aligned_exposure(struct stress_case *c, double level, uint64_t seed)
{
    for (size_t i = 0; i < c->scene.photo_count; i++)
        for (int k = 0; k < 3 && !c->scene.photos[i].test; k++)
            c->scene.photos[i].gain[k] *= (float)exp2(-level * spread_over(c, i, seed));
    return orl_stress_exposure(c, level, seed);
}

enum orl_result orl_stress_white_balance(struct stress_case *c, double level, uint64_t seed)
{
    for (size_t i = 0; i < c->scene.photo_count; i++) {
        double ev = level * spread_over(c, i, seed);
        if (!c->scene.photos[i].test)
            expose(&c->photos[i], (double[]){0.5 * ev, 0, -0.5 * ev});
    }
    return ORL_OK;
}

// --- sharpness and noise ---

// Mean of linear light along a segment of `length` pixels; outside, the border is repeated.
static double along(const struct orl_image *image, const float linear[256], int x, int y,
                    size_t channel, double length, const double way[2])
{
    int steps = (int)ceil(2 * length) + 1;
    double step = steps > 1 ? length / (steps - 1) : 0;
    double sum = 0;
    for (int s = 0; s < steps; s++) {
        double at = step * s - 0.5 * length;
        int u = (int)lround(x + at * way[0]), v = (int)lround(y + at * way[1]);
        u = u < 0 ? 0 : u >= image->width ? image->width - 1 : u;
        v = v < 0 ? 0 : v >= image->height ? image->height - 1 : v;
        size_t pixel = (size_t)v * (size_t)image->width + (size_t)u;
        sum += (double)linear[image->u8[3 * pixel + channel]];
    }
    return sum / steps;
}

// The camera moves by `level` pixels in another direction in each photograph.
enum orl_result orl_stress_blur(struct stress_case *c, double level, uint64_t seed)
{
    static const double pi = 3.141592653589793;
    float linear[256];
    for (int v = 0; v < 256; v++)
        linear[v] = orl_srgb_decode((float)v / 255);
    for (size_t i = 0; i < c->scene.photo_count; i++) {
        struct orl_image sharp = c->photos[i], *image = &c->photos[i];
        double angle = pi * orl_stress_uniform(seed, i, 0);
        const double way[2] = {cos(angle), sin(angle)};
        if (c->scene.photos[i].test)
            continue;
        enum orl_result result = orl_image_init(orl_gpu_log(c->gpu), image, sharp.width,
                                                sharp.height, 3, ORL_PIXEL_U8);
        for (size_t p = 0; result == ORL_OK && p < 3 * pixels_of(&sharp); p++) {
            int x = (int)(p / 3) % sharp.width, y = (int)(p / 3) / sharp.width;
            double light = along(&sharp, linear, x, y, p % 3, level, way);
            image->u8[p] = to_byte(255 * (double)orl_srgb_encode((float)light));
        }
        orl_image_finish(&sharp);
        if (result != ORL_OK)
            return result;
    }
    return ORL_OK;
}

// Adds normal noise of standard deviation `level` to the 8-bit values.
enum orl_result orl_stress_noise(struct stress_case *c, double level, uint64_t seed)
{
    for (size_t i = 0; i < c->scene.photo_count; i++)
        for (size_t p = 0; !c->scene.photos[i].test && p < 3 * pixels_of(&c->photos[i]); p++)
            c->photos[i].u8[p] =
                to_byte(c->photos[i].u8[p] + level * orl_stress_normal(seed, i, p));
    return ORL_OK;
}

enum orl_result orl_stress_jpeg(struct stress_case *c, double level, uint64_t seed)
{
    (void)seed;
    c->jpeg_quality = (int)level;
    return ORL_OK;
}

// --- passers-by ---

enum { PEOPLE_MAX = 60 };

struct person {
    double x, feet, height; // pixels
    uint8_t coat[3], legs[3];
};

static struct person make_person(const struct orl_image *image, size_t photo, int number,
                                 uint64_t seed)
{
    uint64_t at = 16 * (uint64_t)number;
    double small = orl_stress_uniform(seed, photo, at);
    struct person person = {
        .x = image->width * orl_stress_uniform(seed, photo, at + 1),
        .height = image->height * (0.3 + 0.25 * small),
    };
    person.feet = image->height * (0.75 + 0.25 * small);
    for (uint64_t k = 0; k < 3; k++) {
        person.coat[k] = (uint8_t)(30 + 200 * orl_stress_uniform(seed, photo, at + 2 + k));
        person.legs[k] = (uint8_t)(20 + 80 * orl_stress_uniform(seed, photo, at + 5 + k));
    }
    return person;
}

// The person's colour at a pixel; NULL: beside the person.
static const uint8_t *color_at(const struct person *person, int x, int y)
{
    static const uint8_t skin[3] = {205, 160, 130};
    double up = (person->feet - y) / person->height, aside = fabs(x - person->x) / person->height;
    if (up < 0 || up > 1)
        return NULL;
    if (up > 0.86)
        return hypot(aside, up - 0.93) < 0.07 ? skin : NULL;
    if (up > 0.45)
        return aside < 0.13 ? person->coat : NULL;
    return aside < 0.1 && aside > 0.02 * (0.45 - up) ? person->legs : NULL;
}

static enum orl_result paint_people(const struct orl_log *log, struct orl_image *image,
                                    size_t photo, size_t wanted, uint64_t seed)
{
    bool *taken = orl_array(log, pixels_of(image), sizeof *taken);
    size_t covered = 0;
    if (!taken)
        return ORL_ERR_MEMORY;
    for (int n = 0; n < PEOPLE_MAX && covered < wanted; n++) {
        struct person person = make_person(image, photo, n, seed);
        for (size_t p = pixels_of(image); p-- > 0 && covered < wanted;) {
            const uint8_t *color = color_at(&person, (int)(p % (size_t)image->width),
                                            (int)(p / (size_t)image->width));
            if (!color || taken[p])
                continue;
            memcpy(&image->u8[3 * p], color, 3);
            taken[p] = true;
            covered++;
        }
    }
    free(taken);
    return ORL_OK;
}

// Other people stand in each photograph, over `level` percent of its area.
enum orl_result orl_stress_passers_by(struct stress_case *c, double level, uint64_t seed)
{
    enum orl_result result = ORL_OK;
    for (size_t i = 0; result == ORL_OK && i < c->scene.photo_count; i++)
        if (!c->scene.photos[i].test)
            result = paint_people(orl_gpu_log(c->gpu), &c->photos[i], i,
                                  (size_t)(level / 100 * (double)pixels_of(&c->photos[i])), seed);
    return result;
}

// --- silhouettes ---

// Grows the subject, or its surroundings, by a disc.
static enum orl_result grow(const struct orl_log *log, struct orl_image *mask, double radius,
                            uint8_t value)
{
    struct orl_image old = *mask;
    enum orl_result result =
        orl_image_init(log, mask, old.width, old.height, 1, ORL_PIXEL_U8);
    int reach = (int)floor(radius);
    for (int p = 0; result == ORL_OK && p < old.width * old.height; p++) {
        bool found = old.u8[p] == value;
        for (int q = 0; !found && q < (2 * reach + 1) * (2 * reach + 1); q++) {
            int dx = q % (2 * reach + 1) - reach, dy = q / (2 * reach + 1) - reach;
            int x = p % old.width + dx, y = p / old.width + dy;
            found = dx * dx + dy * dy <= radius * radius && x >= 0 && y >= 0 && x < old.width &&
                    y < old.height && old.u8[y * old.width + x] == value;
        }
        mask->u8[p] = found ? value : old.u8[p];
    }
    orl_image_finish(&old);
    return result;
}

static void blacken(const struct orl_image *mask, struct orl_image *picture)
{
    for (size_t p = 0; p < pixels_of(picture); p++)
        if (!mask->u8[p])
            memset(&picture->u8[3 * p], 0, 3);
}

// Each photograph's silhouette is `level` pixels too wide or too narrow. The subject stands on
// black in all pictures, those to compare with included, as hulls have no surroundings.
enum orl_result orl_stress_silhouettes(struct stress_case *c, double level, uint64_t seed)
{
    enum orl_result result = ORL_OK;
    for (size_t i = 0; result == ORL_OK && i < c->scene.photo_count; i++) {
        if (c->scene.photos[i].test || !c->masks[i].data)
            continue;
        blacken(&c->masks[i], &c->photos[i]);
        c->scene.photos[i].masked = true;
        result = grow(orl_gpu_log(c->gpu), &c->masks[i], level,
                      orl_stress_uniform(seed, i, 0) < 0.5 ? 255 : 0);
    }
    for (size_t i = 0; result == ORL_OK && i < c->view_count; i++)
        if (c->masks[c->views[i].photo].data)
            blacken(&c->masks[c->views[i].photo], &c->views[i].picture);
    return result;
}

enum orl_result orl_stress_hull_cameras(struct stress_case *c, double level, uint64_t seed)
{
    enum orl_result result = orl_stress_silhouettes(c, 0, seed);
    return result == ORL_OK ? orl_stress_fewer_photos(c, level, seed) : result;
}
