// Aligning photographs, guessing the gain of others, reading lists of exposures: known
// answers on samples that were made up.
#include <math.h>

#include "core/color.h"
#include "preprocess/expose/align.h"
#include "preprocess/expose/gain_guess.h"
#include "preprocess/job/exposure_list.h"
#include "preprocess/expose/metered.h"
#include "preprocess/expose/response.h"
#include "preprocess/expose/samples.h"
#include "io/picture.h"
#include "scene/meter.h"
#include "test.h"

enum { PHOTOS = 6, POINTS = 3000, SEEN = 4 };

static uint32_t word(uint32_t *state)
{
    *state = *state * 747796405u + 2891336453u;
    uint32_t w = ((*state >> ((*state >> 28) + 4)) ^ *state) * 277803737u;
    return (w >> 22) ^ w;
}

static double uniform(uint32_t *state)
{
    return word(state) * 0x1p-32;
}

// Roughly normal, variance 1.
static double normal(uint32_t *state)
{
    double sum = 0;
    for (int i = 0; i < 4; i++)
        sum += uniform(state) - 0.5;
    return sum * sqrt(3.0);
}

// What the photographs are like.
struct camera {
    double exposure[3]; // factor on linear light
    double vignette;    // light lost in the corners
    double corner;      // light lost there that grows with r^4
    bool film;          // response with more contrast than sRGB
};

static double encode(bool film, double light)
{
    double v = (double)orl_srgb_encode((float)light);
    return film ? v + 0.5 * (v * v * (3 - 2 * v) - v) : v;
}

// Points of random colour, each seen by SEEN photographs in a row, as 8-bit values; what
// would be clipped is left out. A share of `outliers` shows something else.
static struct orl_samples make_samples(const struct camera *cameras, double outliers,
                                       double darkest_ev, double brightest_ev)
{
    static struct orl_observation items[POINTS * SEEN];
    struct orl_samples samples;
    uint32_t state = 1;
    size_t count = 0;
    for (uint32_t p = 0; p < POINTS; p++) {
        double light[3], all = darkest_ev + (brightest_ev - darkest_ev) * uniform(&state);
        for (int c = 0; c < 3; c++)
            light[c] = exp2(all + uniform(&state) - 0.5);
        uint32_t first = word(&state) % (PHOTOS - SEEN + 1);
        for (uint32_t k = 0; k < SEEN; k++) {
            const struct camera *camera = &cameras[first + k];
            struct orl_observation item = {.point = p, .photo = first + k,
                                           .r2 = (float)uniform(&state)};
            double other = uniform(&state) < outliers ? 3 * uniform(&state) : 1;
            bool good = true;
            for (int c = 0; c < 3; c++) {
                double v = light[c] * camera->exposure[c] * other *
                           (1 - camera->vignette * (double)item.r2 -
                            camera->corner * (double)item.r2 * (double)item.r2) *
                           exp(0.03 * normal(&state));
                item.value[c] = (float)round(255 * encode(camera->film, v));
                good = good && item.value[c] > 1 && item.value[c] < 254;
            }
            items[count] = item;
            count += good;
        }
    }
    assert_int_equal(orl_samples_collect(NULL, items, count, &samples), ORL_OK);
    return samples;
}

static void samples_keep_points_seen_twice(void **state)
{
    (void)state;
    enum { MANY = 100 };
    struct orl_observation items[MANY + 4];
    struct orl_samples samples;
    for (uint32_t i = 0; i < MANY + 4; i++)
        items[i] = (struct orl_observation){.point = i < MANY ? 2 : i < MANY + 1 ? 0 : 1, .photo = i};
    assert_int_equal(orl_samples_collect(NULL, items, MANY + 4, &samples), ORL_OK);
    assert_int_equal(samples.point_count, 2);
    assert_int_equal(samples.first[1], 3); // of the point seen three times
    assert_int_equal(samples.count, 3 + 32);
    for (size_t i = 1; i < samples.count; i++)
        assert_true(i == 3 || samples.items[i].photo > samples.items[i - 1].photo);
    // Evenly spread over all that see it.
    assert_true(samples.items[3].photo < 5 && samples.items[34].photo >= 95);
    orl_samples_finish(&samples);
}

static const struct camera uneven[PHOTOS] = {
    {.exposure = {1, 1, 1}},       {.exposure = {0.7, 0.75, 0.8}}, {.exposure = {1.4, 1.3, 1.2}},
    {.exposure = {0.5, 0.5, 0.5}}, {.exposure = {1.8, 2, 1.9}},    {.exposure = {1, 0.9, 1.1}}};

// Gains times exposure are the same for all photographs, whatever the reference is.
static void check_gains(const struct orl_exposed *photos, const struct camera *cameras,
                        double tolerance_ev)
{
    for (int c = 0; c < 3; c++) {
        double first = log2((double)photos[0].gain[c] * cameras[0].exposure[c]);
        for (int i = 1; i < PHOTOS; i++)
            assert_true(fabs(log2((double)photos[i].gain[c] * cameras[i].exposure[c]) - first) <
                        tolerance_ev);
    }
}

static void gains_undo_exposure_and_colour(void **state)
{
    (void)state;
    struct orl_samples samples = make_samples(uneven, 0.1, -4, -1.5);
    struct orl_exposed photos[PHOTOS] = {0};
    struct orl_alignment alignment;
    assert_int_equal(orl_align(NULL, &samples, photos, PHOTOS, PHOTOS, &alignment), ORL_OK);
    check_gains(photos, uneven, 0.02);
    for (int c = 0; c < 3; c++) {
        double sum = 0;
        for (int i = 0; i < PHOTOS; i++)
            sum += log2((double)photos[i].gain[c]);
        assert_true(fabs(sum) < 1e-4); // the reference: geometric mean 1
    }
    assert_true(alignment.spread_before_ev > 0.5 && alignment.spread_after_ev < 0.1);
    assert_float_equal(photos[0].vignette[0], 0, 0); // nothing to explain
    orl_samples_finish(&samples);
}

static void known_exposures_set_the_reference(void **state)
{
    (void)state;
    struct orl_samples samples = make_samples(uneven, 0, -4, -1.5);
    struct orl_exposed photos[PHOTOS] = {0};
    struct orl_alignment alignment;
    double sum = 0;
    for (int i = 0; i < 3; i++) {
        photos[i].known = true;
        photos[i].ev = log2(uneven[i].exposure[1]) + 2;
    }
    assert_int_equal(orl_align(NULL, &samples, photos, PHOTOS, PHOTOS, &alignment), ORL_OK);
    check_gains(photos, uneven, 0.03);
    for (int i = 0; i < 3; i++)
        sum += log2((double)photos[i].gain[1]) + photos[i].ev;
    assert_true(fabs(sum) < 1e-4);
    orl_samples_finish(&samples);
}

static void vignetting_is_found(void **state)
{
    (void)state;
    struct camera cameras[PHOTOS];
    memcpy(cameras, uneven, sizeof cameras);
    for (int i = 0; i < PHOTOS; i++)
        cameras[i].vignette = 0.4;
    struct orl_samples samples = make_samples(cameras, 0.05, -4, -1.5);
    struct orl_exposed photos[PHOTOS] = {0};
    struct orl_alignment alignment;
    assert_int_equal(orl_align(NULL, &samples, photos, PHOTOS, PHOTOS, &alignment), ORL_OK);
    const float *v = photos[0].vignette;
    for (int i = 1; i <= 10; i++) {
        double r2 = 0.1 * i;
        double light = 1 + r2 * ((double)v[0] + r2 * ((double)v[1] + r2 * (double)v[2]));
        assert_true(fabs(light - (1 - 0.4 * r2)) < 0.015);
    }
    check_gains(photos, cameras, 0.03);
    orl_samples_finish(&samples);
}

// Two photographs of one exposure. In the dark, where a step of the values is a third of the light,
// they differ by one, and elsewhere not: their gains differ by less than a tenth of a stop.
static void dark_samples_have_little_say(void **state)
{
    (void)state;
    enum { EACH = 200 };
    static struct orl_observation items[4 * EACH];
    struct orl_samples samples;
    struct orl_exposed photos[2] = {0};
    struct orl_alignment alignment;
    for (uint32_t i = 0; i < 4 * EACH; i++) {
        float value = i / 2 < EACH ? 200 : i % 2 ? 4 : 3;
        items[i] = (struct orl_observation){.point = i / 2, .photo = i % 2, .value = {value, value, value}};
    }
    assert_int_equal(orl_samples_collect(NULL, items, 4 * EACH, &samples), ORL_OK);
    assert_int_equal(orl_align(NULL, &samples, photos, 2, 2, &alignment), ORL_OK);
    assert_true(fabs(log2((double)photos[0].gain[1] / (double)photos[1].gain[1])) < 0.1);
    orl_samples_finish(&samples);
}

static void implausible_gains_are_refused(void **state)
{
    (void)state;
    struct orl_samples samples = make_samples(uneven, 0, -4, -1.5);
    struct orl_exposed photos[PHOTOS] = {0};
    struct orl_alignment alignment;
    for (int i = 0; i < PHOTOS; i++) {
        photos[i].known = true;
        photos[i].ev = log2(uneven[i].exposure[1]) + (i == 2 ? 6 : 0);
    }
    assert_int_equal(orl_align(NULL, &samples, photos, PHOTOS, PHOTOS, &alignment), ORL_OK);
    for (int i = 0; i < PHOTOS; i++)
        assert_int_equal(photos[i].refused, i == 2);
    assert_float_equal(photos[2].gain[0], exp2(-photos[2].ev), 1e-6);
    assert_true(fabs(log2((double)photos[4].gain[1]) + photos[4].ev) < 0.1);
    orl_samples_finish(&samples);
}

// --- response ---

static const struct camera bracket[PHOTOS] = {
    {.exposure = {0.125, 0.125, 0.125}, .film = true}, {.exposure = {1, 1, 1}, .film = true},
    {.exposure = {8, 8, 8}, .film = true},             {.exposure = {0.14, 0.14, 0.14}, .film = true},
    {.exposure = {0.9, 0.9, 0.9}, .film = true},       {.exposure = {8, 8, 8}, .film = true}};

// Pictures of three exposures, of which EXIF says that they are the same.
static void wrong_exposures_are_noticed(void **state)
{
    (void)state;
    struct camera cameras[PHOTOS];
    struct orl_exposed photos[PHOTOS] = {0};
    for (int i = 0; i < PHOTOS; i++) {
        double factor = exp2(1.5 * (i % 3 - 1));
        cameras[i] = (struct camera){.exposure = {factor, factor, factor}};
    }
    struct orl_samples samples = make_samples(cameras, 0.05, -4, -2);
    for (int told = 0; told < 2; told++) {
        struct orl_alignment alignment;
        for (int i = 0; i < PHOTOS; i++)
            photos[i] = (struct orl_exposed){.known = true, .ev = told ? 1.5 * (i % 3 - 1) : 0};
        assert_int_equal(orl_align(NULL, &samples, photos, PHOTOS, PHOTOS, &alignment), ORL_OK);
        assert_int_equal(orl_align_contradicts(photos, PHOTOS), !told);
    }
    orl_samples_finish(&samples);
}

static void tell_exposures(struct orl_exposed photos[PHOTOS])
{
    // As a camera tells them: what differs slightly from series to series stays untold.
    for (int i = 0; i < PHOTOS; i++)
        photos[i] = (struct orl_exposed){.known = true, .ev = 3 * (i % 3 - 1)};
}

static void response_is_found(void **state)
{
    (void)state;
    struct orl_samples samples = make_samples(bracket, 0.1, -9, 1);
    struct orl_exposed photos[PHOTOS];
    struct orl_response response;
    struct orl_response_fit fit;
    tell_exposures(photos);
    assert_int_equal(orl_response_fit(NULL, ORL_RESPONSE_POLYNOMIAL, &samples, photos, PHOTOS, 0, &response, &fit), ORL_OK);
    assert_int_equal(fit.outcome, ORL_RESPONSE_FOUND);
    for (int c = 0; c < 3; c++) {
        double squares = 0, scale = 0, norm = 0, truth[256];
        int v = 0;
        for (int i = 0; i <= 100000; i++) { // the curve turned round
            while (v < 256 && 255 * encode(true, i / 100000.0) >= v - 1e-9)
                truth[v++] = i / 100000.0;
        }
        assert_int_equal(v, 256);
        for (v = 0; v < 256; v++) {
            assert_true(v == 0 || response.linear[c][v] > response.linear[c][v - 1]);
            scale += truth[v] * (double)response.linear[c][v];
            norm += (double)response.linear[c][v] * (double)response.linear[c][v];
        }
        for (v = 0; v < 256; v++)
            squares += pow(scale / norm * (double)response.linear[c][v] - truth[v], 2);
        if (sqrt(squares / 256) >= 0.01)
            fail_msg("channel %d: RMS %g", c, sqrt(squares / 256));
        assert_float_equal(response.linear[c][255], 1, 0);
    }
    orl_samples_finish(&samples);
}

// The residuals are those of the noise, 3 % of the light, whatever a photograph's corners lost.
static void vignetting_of_every_order_is_undone(void **state)
{
    (void)state;
    struct camera cameras[PHOTOS];
    memcpy(cameras, bracket, sizeof cameras);
    for (int i = 0; i < PHOTOS; i++)
        cameras[i].corner = 0.6;
    struct orl_samples samples = make_samples(cameras, 0, -9, 1);
    struct orl_exposed photos[PHOTOS];
    struct orl_response response;
    struct orl_response_fit fit;
    tell_exposures(photos);
    for (int i = 0; i < PHOTOS; i++)
        photos[i].vignette[1] = -0.6f;
    assert_int_equal(orl_response_fit(NULL, ORL_RESPONSE_POLYNOMIAL, &samples, photos, PHOTOS, 0, &response, &fit), ORL_OK);
    assert_int_equal(fit.outcome, ORL_RESPONSE_FOUND);
    print_message("spread %g EV\n", fit.spread_ev);
    assert_true(fit.spread_ev < 0.08);
    orl_samples_finish(&samples);
}

// The brighter half of the light has values that fall with it, as those of a solarised negative. A
// curve always rises.
static void curves_never_fall(void **state)
{
    (void)state;
    struct camera cameras[PHOTOS];
    memcpy(cameras, bracket, sizeof cameras);
    for (int i = 0; i < PHOTOS; i++)
        cameras[i].film = false;
    struct orl_samples samples = make_samples(cameras, 0, -9, 1);
    struct orl_exposed photos[PHOTOS];
    struct orl_response response;
    struct orl_response_fit fit;
    tell_exposures(photos);
    for (size_t i = 0; i < samples.count; i++)
        for (int c = 0; c < 3; c++)
            if (samples.items[i].value[c] > 128)
                samples.items[i].value[c] = 128 + 0.9f * (255 - samples.items[i].value[c]);
    assert_int_equal(orl_response_fit(NULL, ORL_RESPONSE_POLYNOMIAL, &samples, photos, PHOTOS, 0, &response, &fit), ORL_OK);
    assert_int_equal(fit.outcome, ORL_RESPONSE_FOUND);
    for (int c = 0; c < 3; c++)
        for (int v = 1; v < 256; v++)
            assert_true(response.linear[c][v] > response.linear[c][v - 1]);
    orl_samples_finish(&samples);
}

// Exposures that EXIF rounds, and corners that are darker than known, bend the samples of sRGB
// photographs. A curve that follows them would be worse than sRGB.
static void response_of_srgb_is_srgb(void **state)
{
    (void)state;
    for (int worse = 0; worse < 4; worse++) {
        struct camera cameras[PHOTOS];
        struct orl_exposed photos[PHOTOS];
        struct orl_response response;
        struct orl_response_fit fit;
        memcpy(cameras, bracket, sizeof cameras);
        for (int i = 0; i < PHOTOS; i++) {
            cameras[i].film = false;
            cameras[i].corner = 0.2 * worse;
            for (int c = 0; c < 3; c++)
                cameras[i].exposure[c] *= exp2(0.05 * worse * (i % 2 ? 1 : -1));
        }
        struct orl_samples samples = make_samples(cameras, 0.1, -9, 1);
        tell_exposures(photos);
        assert_int_equal(orl_response_fit(NULL, ORL_RESPONSE_POLYNOMIAL, &samples, photos, PHOTOS, 0, &response,
                                          &fit), ORL_OK);
        assert_int_equal(fit.outcome, ORL_RESPONSE_SRGB);
        orl_samples_finish(&samples);
    }
}

static void response_stays_srgb_without_reason(void **state)
{
    (void)state;
    struct camera cameras[PHOTOS];
    memcpy(cameras, bracket, sizeof cameras);
    for (int i = 0; i < PHOTOS; i++) {
        cameras[i].film = false;
        for (int c = 0; c < 3; c++)
            cameras[i].exposure[c] = exp2(3 * (i % 3 - 1));
    }
    struct orl_samples samples = make_samples(cameras, 0.1, -9, 1);
    struct orl_exposed photos[PHOTOS];
    struct orl_response response;
    struct orl_response_fit fit;
    tell_exposures(photos);
    assert_int_equal(orl_response_fit(NULL, ORL_RESPONSE_POLYNOMIAL, &samples, photos, PHOTOS, 0, &response, &fit), ORL_OK);
    assert_int_equal(fit.outcome, ORL_RESPONSE_SRGB);
    assert_float_equal(response.linear[1][128], orl_srgb_decode(128 / 255.0f), 1e-6);
    for (int i = 0; i < PHOTOS; i++)
        photos[i].ev = 0.1 * i;
    assert_int_equal(orl_response_fit(NULL, ORL_RESPONSE_POLYNOMIAL, &samples, photos, PHOTOS, 0, &response, &fit), ORL_OK);
    assert_int_equal(fit.outcome, ORL_RESPONSE_FEW_SAMPLES);
    for (int i = 0; i < PHOTOS; i++)
        photos[i].ev = 0.05 * i;
    assert_int_equal(orl_response_fit(NULL, ORL_RESPONSE_POLYNOMIAL, &samples, photos, PHOTOS, 0, &response, &fit), ORL_OK);
    assert_int_equal(fit.outcome, ORL_RESPONSE_ONE_EXPOSURE);
    orl_samples_finish(&samples);
}

// --- samples of photographs ---

enum { SIDE = 64 };

// A ramp of grey, white above and, below, an edge in the middle.
static void write_ramp(const char *path)
{
    struct orl_image image;
    assert_int_equal(orl_image_init(NULL, &image, SIDE, SIDE, 3, ORL_PIXEL_U8), ORL_OK);
    for (int y = 0; y < SIDE; y++)
        for (int x = 0; x < SIDE; x++)
            memset(&image.u8[3 * (SIDE * y + x)],
                   y < 16 ? 255 : y < 48 ? 40 + 2 * x : x < SIDE / 2 ? 60 : 220, 3);
    assert_int_equal(orl_png_write(NULL, path, &image), ORL_OK);
    orl_image_finish(&image);
}

// Of six points that both photographs look at, two are fit to compare them: the others lie where all is
// white, on an edge, on a surface that faces away, and behind the last point.
static void samples_show_what_photographs_have_in_common(void **state)
{
    (void)state;
    static const float places[6][3] = {{0, 0, 4}, {0, -3, 4}, {0, 3, 4}, {-2, 0, 4}, {2, 0, 4}, {1.5f, 0, 3}};
    struct orl_exposed photos[2];
    struct orl_points points;
    struct orl_samples samples;
    char *dir, *path;
    assert_int_equal(test_file_make("ramp.png", &dir, &path), 0);
    write_ramp(path);
    for (int i = 0; i < 2; i++)
        photos[i] = (struct orl_exposed){
            .name = "ramp.png", .view = {{SIDE, SIDE, 32, 32, SIDE / 2, SIDE / 2},
                   {{{1, 0, 0}, {0, 1, 0}, {0, 0, 1}}, {-0.2 * i, 0, 0}}}};
    assert_int_equal(orl_points_init(NULL, &points, 6), ORL_OK);
    for (int i = 0; i < 6; i++) {
        memcpy(points.position[i], places[i], sizeof places[i]);
        points.normal[i][2] = i == 3 ? 1 : -1;
        points.radius[i] = i == 5 ? 0.4f : 0.05f;
    }
    assert_int_equal(orl_samples_take(NULL, NULL, dir, photos, 2, &points, &samples), ORL_OK);
    assert_int_equal(samples.point_count, 2);
    assert_int_equal(samples.count, 4);
    // At columns 32 and 30.4 of the ramp, and at 48 and 45.9, in the middle row.
    static const double expected[4] = {103, 99.8, 135, 130.7};
    for (int i = 0; i < 4; i++) {
        assert_int_equal(samples.items[i].photo, i % 2);
        assert_int_equal(samples.items[i].clipped, 0);
        assert_float_equal(samples.items[i].value[1], expected[i], 1);
    }
    assert_float_equal(samples.items[0].r2, 0, 1e-6);
    assert_float_equal(samples.items[2].r2, 0.125, 1e-6); // 16 pixels of 45.25
    orl_samples_finish(&samples);
    orl_points_finish(&points);
    test_dir_remove(dir);
    free(path);
}

// Pictures of three exposures, of a bright and of a dark half of the place: a bracket, whose bright parts clip,
// and what a camera takes that meters by itself.
static void metered_exposures_are_no_bracket(void **state)
{
    (void)state;
    static const double light[2][6] = {{-3, -2, -1, -5, -4, -2.5}, {-2.3, -2, -2.1, -2, -2.2, -1.9}};
    for (int metered = 0; metered < 2; metered++) {
        struct orl_exposed photos[6];
        for (int i = 0; i < 6; i++)
            photos[i] = (struct orl_exposed){.ev = 2 * (i % 3 - 1), .light = light[metered][i]};
        assert_int_equal(orl_exposures_are_metered(photos, 6), metered);
    }
}

// The light before the lens, which its borders darken.
static void light_is_metered_without_vignetting(void **state)
{
    (void)state;
    struct orl_exposed photo = {.name = "wall.png", .vignette = {-0.6f, 0, 0},
                                .view.camera = {SIDE, SIDE, 32, 32, SIDE / 2, SIDE / 2}};
    const float gain[3] = {1, 1, 1};
    struct orl_image image;
    char *dir, *path;
    assert_int_equal(test_file_make("wall.png", &dir, &path), 0);
    assert_int_equal(orl_image_init(NULL, &image, SIDE, SIDE, 3, ORL_PIXEL_U8), ORL_OK);
    for (int i = 0; i < SIDE * SIDE; i++)
        memset(&image.u8[3 * i],
               (int)lrintf(255 * orl_srgb_encode(0.25f * orl_illumination(photo.vignette, &photo.view.camera,
                                                                          i % SIDE + 0.5, (int)(i / SIDE) + 0.5))), 3);
    assert_int_equal(orl_png_write(NULL, path, &image), ORL_OK);
    assert_int_equal(orl_photo_metered(NULL, dir, &photo, gain), ORL_OK);
    assert_float_equal(photo.light, -2, 0.02);
    orl_image_finish(&image);
    test_dir_remove(dir);
    free(path);
}

// --- guesses ---

// Views in a row, each sharing points with its neighbours.
static void make_row(struct orl_exposed views[7], uint32_t shared[7 * 6], uint32_t own[7])
{
    memset(views, 0, 7 * sizeof *views);
    for (int i = 0; i < 7; i++) {
        double at = i < 6 ? i : 2.5; // the last one is to be guessed
        views[i].view.cam_from_world = (struct orl_pose){{{1, 0, 0}, {0, 1, 0}, {0, 0, 1}}, {-at, 0, 0}};
        own[i] = 100;
        for (int k = 0; k < 6; k++)
            shared[6 * i + k] = (uint32_t)fmax(0, 100 - 30 * fabs(at - k));
    }
}

static void guesses_follow_what_predicts(void **state)
{
    (void)state;
    struct orl_exposed views[7];
    uint32_t shared[7 * 6], own[7];
    double metering[2];
    // A trend along the row: neighbours tell.
    make_row(views, shared, own);
    for (int i = 0; i < 6; i++)
        for (int c = 0; c < 3; c++)
            views[i].gain[c] = (float)exp2(0.3 * (i - 2.5));
    assert_int_equal(orl_gains_guess(views, 6, 7, shared, own, metering), ORL_GUESS_NEIGHBOURS);
    assert_true(fabs(log2((double)views[6].gain[1])) < 0.05);
    // By the square of what is in common over that of the distance.
    double sum = 0, weights = 0;
    views[6].view.cam_from_world.t[0] = -1.2;
    for (int k = 0; k < 6; k++) {
        shared[6 * 6 + k] = (uint32_t)(20 + 10 * k);
        double weight = pow((21 + 10 * k) / 101.0 / (1.2 - k), 2);
        sum += weight * 0.3 * (k - 2.5);
        weights += weight;
    }
    assert_int_equal(orl_gains_guess(views, 6, 7, shared, own, metering), ORL_GUESS_NEIGHBOURS);
    assert_float_equal(log2((double)views[6].gain[1]), sum / weights, 1e-5);
    // Without rhyme or reason: the reference.
    const float odd[6] = {1.5f, 0.6f, 1.6f, 0.5f, 1.4f, 0.7f};
    for (int i = 0; i < 6; i++)
        for (int c = 0; c < 3; c++)
            views[i].gain[c] = odd[i];
    assert_int_equal(orl_gains_guess(views, 6, 7, shared, own, metering), ORL_GUESS_REFERENCE);
    assert_float_equal(views[6].gain[0], 1, 0);
    // EXIF tells them.
    for (int i = 0; i < 6; i++) {
        views[i].known = true;
        views[i].ev = -log2((double)odd[i]);
    }
    views[6].known = true;
    views[6].ev = 1.5;
    enum orl_gain_guess guess = orl_gains_guess(views, 6, 7, shared, own, metering);
    assert_true(guess == ORL_GUESS_EXPOSURE || guess == ORL_GUESS_BOTH);
    assert_float_equal(views[6].gain[2], exp2(-1.5), 1e-5);
    assert_float_equal(metering[0], 0, 0);
}

// A camera that evens out four fifths of the differences of light, over a trend along the row that
// the neighbours tell.
static void guesses_follow_automatic_exposure(void **state)
{
    (void)state;
    static const double light[6] = {-3, -1.2, -2.9, -0.8, -3.1, -1};
    struct orl_exposed views[7];
    uint32_t shared[7 * 6], own[7];
    double metering[2], mean = -2;
    make_row(views, shared, own);
    for (int i = 0; i < 6; i++) {
        views[i].light = light[i];
        for (int c = 0; c < 3; c++)
            views[i].gain[c] = (float)exp2(0.8 * (light[i] - mean) + 0.1 * c);
    }
    assert_int_equal(orl_gains_guess(views, 6, 7, shared, own, metering),
                     ORL_GUESS_METER);
    assert_float_equal(metering[0], 0.8, 1e-5);
    assert_float_equal(metering[1], mean, 1e-9);
    for (int c = 0; c < 3; c++)
        assert_float_equal(views[6].gain[c], exp2(0.1 * c), 1e-5);
    for (int i = 0; i < 6; i++) // no camera evens out more than all
        for (int c = 0; c < 3; c++)
            views[i].gain[c] = (float)exp2(1.2 * (light[i] - mean));
    assert_int_equal(orl_gains_guess(views, 6, 7, shared, own, metering), ORL_GUESS_METER);
    assert_float_equal(metering[0], 1, 0);
    for (int i = 0; i < 6; i++)
        for (int c = 0; c < 3; c++)
            views[i].gain[c] = (float)exp2(0.8 * (light[i] - mean) + 0.1 * c);
    for (int i = 0; i < 6; i++)
        for (int c = 0; c < 3; c++)
            views[i].gain[c] *= (float)exp2(0.2 * (i - 2.5));
    assert_int_equal(orl_gains_guess(views, 6, 7, shared, own, metering),
                     ORL_GUESS_METER_NEAR);
    assert_true(fabs(log2((double)views[6].gain[0])) < 0.05);
}

// --- lists ---

static void lists_are_read(void **state)
{
    (void)state;
    char *dir, *path;
    assert_int_equal(test_file_make("list.csv", &dir, &path), 0);
    const char text[] = "\xEF\xBB\xBFname,time,aperture,iso\na.jpg, 1/250, f/8, 100\r\n\nb,0.5,8,100\n";
    struct orl_exposure_list list;
    assert_int_equal(orl_file_write(NULL, path, text, sizeof text - 1), ORL_OK);
    assert_int_equal(orl_exposure_list_read(NULL, path, &list), ORL_OK);
    assert_int_equal(list.count, 2);
    const struct orl_listed_exposure *a = orl_exposure_list_find(&list, "a.jpg");
    const struct orl_listed_exposure *b = orl_exposure_list_find(&list, "b.png");
    assert_true(a && b && a->absolute && !orl_exposure_list_find(&list, "c.jpg"));
    assert_float_equal(a->ev, log2(1.0 / 250 / 64), 1e-9);
    assert_float_equal(b->ev - a->ev, log2(125), 1e-9);
    orl_exposure_list_finish(&list);
    const char marked[] = "\xEF\xBB\xBF" "a.jpg,1\nb.jpg,2\n";
    assert_int_equal(orl_file_write(NULL, path, marked, sizeof marked - 1), ORL_OK);
    assert_int_equal(orl_exposure_list_read(NULL, path, &list), ORL_OK);
    assert_int_equal(list.count, 2);
    assert_non_null(orl_exposure_list_find(&list, "a.jpg"));
    orl_exposure_list_finish(&list);
    static const struct {
        const char *text, *why;
    } bad[] = {{"a.jpg,1,2\n", "line 1"},
               {"name,ev\na.jpg,one\n", "line 2"},
               {"a.jpg,1\nb.jpg,1/0\n", "line 2"},
               {"a.jpg,-1,8,100\n", "line 1"},
               {"a.jpg,3\nb.jpg,1,8,100\n", "another kind"},
               {"a.jpg,l/250,f/8,100\nb.jpg,1,8,100\n", "line 1"}, // a typo is no title
               {"a.jpg,one\nb.jpg,1\n", "line 1"},
               {"name,ev\n", "no exposure"}};
    for (size_t i = 0; i < ORL_COUNT(bad); i++) {
        struct said said;
        struct orl_log log = log_to(&said);
        assert_int_equal(orl_file_write(NULL, path, bad[i].text, strlen(bad[i].text)), ORL_OK);
        if (orl_exposure_list_read(&log, path, &list) != ORL_ERR_FORMAT ||
            !strstr(said.text, bad[i].why))
            fail_msg("case %zu: \"%s\"", i, said.text);
        assert_null(list.items);
    }
    test_file_remove(dir, path);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(samples_keep_points_seen_twice),
        cmocka_unit_test(gains_undo_exposure_and_colour),
        cmocka_unit_test(known_exposures_set_the_reference),
        cmocka_unit_test(vignetting_is_found),
        cmocka_unit_test(dark_samples_have_little_say),
        cmocka_unit_test(implausible_gains_are_refused),
        cmocka_unit_test(wrong_exposures_are_noticed),
        cmocka_unit_test(response_is_found),
        cmocka_unit_test(vignetting_of_every_order_is_undone),
        cmocka_unit_test(curves_never_fall),
        cmocka_unit_test(response_of_srgb_is_srgb),
        cmocka_unit_test(response_stays_srgb_without_reason),
        cmocka_unit_test(samples_show_what_photographs_have_in_common),
        cmocka_unit_test(metered_exposures_are_no_bracket),
        cmocka_unit_test(light_is_metered_without_vignetting),
        cmocka_unit_test(guesses_follow_what_predicts),
        cmocka_unit_test(guesses_follow_automatic_exposure),
        cmocka_unit_test(lists_are_read),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
