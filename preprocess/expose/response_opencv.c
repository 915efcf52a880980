// Response curves by OpenCV, which takes pictures of one place at several exposures. Here a picture has one
// row: the points that are known at every exposure.
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "bridge/bridge.h"
#include "core/color.h"
#include "core/memory.h"
#include "oriel/image.h"
#include "preprocess/expose/expose.h"
#include "preprocess/expose/response.h"

enum {
    POINTS_MIN = 50,
    DEBEVEC_MAX = 300, // its matrix is dense
};

struct exposures {
    int *of;    // of each photograph; -1: it takes no part
    double *ev; // of each, ascending
    int count;
};

// Sets the series of the photographs that take part, each with the exposure of its darkest photograph.
static enum orl_result find_exposures(const struct orl_log *log, const struct orl_exposed *photos,
                                      size_t photo_count, int camera, struct exposures *e)
{
    struct orl_exposed *used = orl_array(log, photo_count, sizeof *used);
    ORL_TRY_MEMORY(used);
    for (size_t i = 0; i < photo_count; i++) {
        used[i] = (struct orl_exposed){.known = photos[i].camera == camera && photos[i].known, .ev = photos[i].ev};
        e->ev[i] = INFINITY;
    }
    enum orl_result result = orl_exposures_group(log, used, photo_count, ORL_EXPOSURE_STEP_EV, true, &e->count);
    for (size_t i = 0; result == ORL_OK && i < photo_count; i++) {
        e->of[i] = used[i].known ? used[i].series : -1;
        if (used[i].known)
            e->ev[e->of[i]] = fmin(e->ev[e->of[i]], used[i].ev);
    }
    free(used);
    return result;
}

// Does sRGB have what is seen at one exposure all black, or all white, at another?
static bool clips_at(const struct orl_observation *seen, double more_ev)
{
    const float black = 2, white = 253;
    bool blacks = more_ev < 0, whites = more_ev > 0;
    for (int c = 0; c < 3; c++) {
        float value = 255 * orl_srgb_encode(orl_srgb_decode(seen->value[c] / 255) * (float)exp2(more_ev));
        blacks = blacks && value < black;
        whites = whites && value > white;
    }
    return blacks || whites;
}

// A point's first observation at each exposure; NULL where it clips, for which there is none. False: an
// exposure says nothing about it.
static bool look_up(const struct orl_samples *samples, size_t point, const struct exposures *e,
                    const struct orl_observation **seen)
{
    int least = e->count, most = -1;
    memset(seen, 0, (size_t)e->count * sizeof *seen);
    for (size_t i = samples->first[point]; i < samples->first[point + 1]; i++) {
        int of = e->of[samples->items[i].photo];
        if (of < 0 || seen[of])
            continue;
        seen[of] = &samples->items[i];
        least = of < least ? of : least;
        most = of > most ? of : most;
    }
    if (least >= most)
        return false;
    for (int k = 0; k < e->count; k++) {
        int nearest = k < least ? least : most;
        if (!seen[k] && !clips_at(seen[nearest], e->ev[k] - e->ev[nearest]))
            return false;
    }
    return true;
}

// The 8-bit value of a channel at an exposure. Where it clips, that is said by the next exposure at which it
// does not.
static uint8_t value_at(const struct orl_observation *const *seen, int count, int k, int c)
{
    for (int off = 0; off < count; off++)
        for (int side = -1; side <= 1; side += 2) {
            int at = k + side * off;
            if (at >= 0 && at < count && seen[at] && !(seen[at]->clipped & 1u << c))
                return off ? (side < 0 ? 255 : 0) : (uint8_t)lroundf(seen[at]->value[c]);
        }
    return 0;
}

// The values of every step-th point that is whole, as orl_bridge_response takes them. Without `values`
// they are only counted.
static size_t collect(const struct orl_samples *samples, const struct exposures *e, size_t step,
                      const struct orl_observation **seen, struct orl_image *values)
{
    size_t whole = 0;
    for (size_t point = 0; point < samples->point_count; point++) {
        if (!look_up(samples, point, e, seen))
            continue;
        size_t at = whole++ / step;
        if (!values || (whole - 1) % step)
            continue;
        for (int k = 0; k < e->count; k++)
            for (int c = 0; c < 3; c++)
                values->u8[3 * ((size_t)k * (size_t)values->width + at) + (size_t)c] =
                    value_at(seen, e->count, k, c);
    }
    return whole;
}

enum orl_result orl_response_opencv(const struct orl_log *log, enum orl_response_method method,
                                    const struct orl_samples *samples, const struct orl_exposed *photos,
                                    size_t photo_count, int camera, float linear[3][256], bool *found)
{
    bool is_debevec = method == ORL_RESPONSE_DEBEVEC;
    struct orl_image values = {0};
    struct exposures e = {.of = orl_array(log, photo_count, sizeof *e.of),
                          .ev = orl_array(log, photo_count, sizeof *e.ev)};
    const struct orl_observation **seen = orl_array(log, photo_count, sizeof *seen);
    enum orl_result result = e.of && e.ev && seen ? find_exposures(log, photos, photo_count, camera, &e) : ORL_ERR_MEMORY;
    size_t points = result == ORL_OK ? collect(samples, &e, 1, seen, NULL) : 0;
    size_t step = is_debevec ? (points + DEBEVEC_MAX - 1) / DEBEVEC_MAX : 1;
    *found = points >= POINTS_MIN;
    if (*found)
        result = orl_image_init(log, &values, (int)((points + step - 1) / step), e.count, 3, ORL_PIXEL_U8);
    if (*found && result == ORL_OK) {
        collect(samples, &e, step, seen, &values);
        for (int k = 0; k < e.count; k++)
            e.ev[k] = exp2(e.ev[k]);
        result = orl_bridge_response(log, is_debevec ? ORL_CALIBRATION_DEBEVEC : ORL_CALIBRATION_ROBERTSON, &values,
                                     e.ev, linear);
    }
    orl_image_finish(&values);
    free(seen);
    free(e.of);
    free(e.ev);
    return result;
}
