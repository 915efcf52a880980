// Response curves from stacks of photographs from one place: known answers, and what OpenCV
// makes of the same samples.
#include <math.h>

#include "core/color.h"
#include "core/order.h"
#include "oriel/image.h"
#include "io/picture.h"
#include "preprocess/expose/response.h"
#include "test.h"

enum {
    SIDE = 64,      // of the made-up photographs
    PHOTOS_MAX = 16,
};

// Photographs of one place: side x side pixels of RGB each.
struct stack {
    int photos, side;
    double ev[PHOTOS_MAX];
    uint8_t *pixels; // owned
};

static uint8_t *pixel(const struct stack *stack, int photo, int at)
{
    return stack->pixels + 3 * ((size_t)photo * (size_t)(stack->side * stack->side) + (size_t)at);
}

static double uniform(uint32_t *state)
{
    *state = *state * 747796405u + 2891336453u;
    uint32_t w = ((*state >> ((*state >> 28) + 4)) ^ *state) * 277803737u;
    return ((w >> 22) ^ w) * 0x1p-32;
}

// Roughly normal, variance 1.
static double normal(uint32_t *state)
{
    double sum = 0;
    for (int i = 0; i < 4; i++)
        sum += uniform(state) - 0.5;
    return sum * sqrt(3.0);
}

// --- made-up stacks, whose curve is known ---

// Light in [0, 1] to value in [0, 1] with more contrast than sRGB.
static double film(double light)
{
    double v = (double)orl_srgb_encode((float)light);
    return v + 0.5 * (v * v * (3 - 2 * v) - v);
}

// Light of each value, above a black of `black`.
static void make_truth(double black, double truth[256])
{
    int v = 0;
    for (int i = 0; i <= 100000; i++)
        while (v < 256 && black + (255 - black) * film(i / 100000.0) >= v - 1e-9)
            truth[v++] = i / 100000.0;
    assert_int_equal(v, 256);
}

// Radiance over 10 EV, colours up to 2.5 EV apart: channels clip alone.
static struct stack make_stack(int photos, double step_ev, double black)
{
    struct stack stack = {.photos = photos, .side = SIDE};
    stack.pixels = calloc((size_t)photos, 3 * (size_t)SIDE * SIDE);
    assert_non_null(stack.pixels);
    uint32_t state = 7;
    for (int at = 0; at < SIDE * SIDE; at++) {
        double all = -8 + 10 * uniform(&state), light[3];
        for (int c = 0; c < 3; c++)
            light[c] = exp2(all + 2.5 * (uniform(&state) - 0.5));
        for (int i = 0; i < photos; i++) {
            stack.ev[i] = step_ev * (i - photos / 2);
            for (int c = 0; c < 3; c++) {
                double value = black + (255 - black) * film(fmin(light[c] * exp2(stack.ev[i]), 1));
                value += 0.7 * normal(&state);
                pixel(&stack, i, at)[c] = (uint8_t)lround(fmin(fmax(value, 0), 255));
            }
        }
    }
    return stack;
}

// --- fits ---

static struct orl_samples samples_of(const struct stack *stack)
{
    size_t count = 0, points = (size_t)(stack->side * stack->side);
    struct orl_observation *items = calloc(points * (size_t)stack->photos, sizeof *items);
    struct orl_samples samples;
    assert_non_null(items);
    for (uint32_t at = 0; at < points; at++)
        for (int i = 0; i < stack->photos; i++) {
            struct orl_observation *item = &items[count];
            *item = (struct orl_observation){.point = at, .photo = (uint32_t)i};
            for (int c = 0; c < 3; c++) {
                uint8_t value = pixel(stack, i, (int)at)[c];
                bool clipped = value < 1 || value > 253;
                item->value[c] = clipped ? 100 : value; // means nothing
                item->clipped |= (uint8_t)(clipped << c);
            }
            count += item->clipped != 7;
        }
    assert_int_equal(orl_samples_collect(NULL, items, count, &samples), ORL_OK);
    free(items);
    return samples;
}

static void fit(enum orl_response_method method, const struct stack *stack, struct orl_response *response)
{
    struct orl_exposed photos[PHOTOS_MAX] = {0};
    struct orl_response_fit found;
    struct orl_samples samples = samples_of(stack);
    for (int i = 0; i < stack->photos; i++)
        photos[i] = (struct orl_exposed){.known = true, .ev = stack->ev[i]};
    assert_int_equal(orl_response_fit(NULL, method, &samples, photos, (size_t)stack->photos, 0, response,
                                      &found), ORL_OK);
    assert_int_equal(found.outcome, ORL_RESPONSE_FOUND);
    for (int c = 0; c < 3; c++)
        for (int v = 1; v < 256; v++)
            assert_true(response->linear[c][v] > response->linear[c][v - 1]);
    orl_samples_finish(&samples);
}

// RMS of `curve` from `truth` in [first, last], scaled to fit, by the truth's largest.
static double rms(const float *curve, const double *truth, int first, int last)
{
    double scale = 0, norm = 0, squares = 0;
    for (int v = first; v <= last; v++) {
        scale += truth[v] * (double)curve[v];
        norm += (double)curve[v] * (double)curve[v];
    }
    for (int v = first; v <= last; v++)
        squares += pow(scale / norm * (double)curve[v] - truth[v], 2);
    return sqrt(squares / (last - first + 1)) / truth[last];
}

static void channels_clip_alone(void **state)
{
    (void)state;
    struct stack stack = make_stack(5, 2, 0);
    struct orl_response response, debevec, robertson;
    double truth[256];
    make_truth(0, truth);
    fit(ORL_RESPONSE_POLYNOMIAL, &stack, &response);
    fit(ORL_RESPONSE_DEBEVEC, &stack, &debevec);
    fit(ORL_RESPONSE_ROBERTSON, &stack, &robertson);
    // OpenCV gives clipped values weight; the second time the ends are left out for its sake.
    const int first[] = {1, 16}, last[] = {254, 240};
    for (int k = 0; k < 2; k++) {
        double sum[3] = {0}; // of squares: ours, Debevec's, Robertson's
        for (int c = 0; c < 3; c++) {
            double ours = rms(response.linear[c], truth, first[k], last[k]);
            assert_true(ours < 0.005);
            sum[0] += ours * ours;
            sum[1] += pow(rms(debevec.linear[c], truth, first[k], last[k]), 2);
            sum[2] += pow(rms(robertson.linear[c], truth, first[k], last[k]), 2);
        }
        print_message("%d to %d: RMS %.4f, OpenCV's Debevec %.4f, Robertson %.4f\n", first[k],
                      last[k], sqrt(sum[0] / 3), sqrt(sum[1] / 3), sqrt(sum[2] / 3));
        assert_true(sum[0] <= sum[1] && sum[0] <= sum[2]);
    }
    // Which light is 255 is extrapolated; it must not differ by colour.
    for (int c = 0; c < 3; c++) {
        double scale = (double)response.linear[c][128] / truth[128];
        assert_true(fabs(scale - 1) < 0.04);
        assert_true(fabs(scale - (double)response.linear[1][128] / truth[128]) < 0.005);
    }
    free(stack.pixels);
}

static void a_floor_has_no_say(void **state)
{
    (void)state;
    enum { BLACK = 14 };
    struct stack stack = make_stack(7, 1.5, BLACK);
    struct orl_response response;
    double truth[256];
    make_truth(BLACK, truth);
    fit(ORL_RESPONSE_POLYNOMIAL, &stack, &response);
    for (int c = 0; c < 3; c++) {
        double ours = rms(response.linear[c], truth, BLACK + 4, 254);
        if (!(ours < 0.003))
            fail_msg("channel %d: RMS %g", c, ours);
    }
    free(stack.pixels);
}

// --- samples of a bracket from a tripod ---

static struct orl_points make_wall(void)
{
    struct orl_points points;
    assert_int_equal(orl_points_init(NULL, &points, 24 * 24), ORL_OK);
    for (int i = 0; i < 24 * 24; i++) {
        points.position[i][0] = 0.07f * ((float)(i % 24) - 11.5f);
        points.position[i][1] = 0.07f * ((float)(i / 24) - 11.5f);
        points.position[i][2] = 2;
        points.normal[i][2] = -1;
        points.radius[i] = 0.04f;
    }
    return points;
}

// Light from left to right over 8 EV, blue twice of red and green.
static double wall_value(int x, int channel, double ev)
{
    double light = exp2(8.0 * x / (SIDE - 1) - 6 + ev) * (channel == 2 ? 2 : 1);
    return round(255 * (double)orl_srgb_encode((float)fmin(light, 1)));
}

static void one_viewpoint_gives_samples(void **state)
{
    (void)state;
    enum { COUNT = 3 };
    char *dir = test_dir_make(), names[COUNT][16];
    struct orl_exposed photos[COUNT];
    struct orl_samples samples;
    for (int i = 0; i < COUNT; i++) {
        struct orl_image image;
        snprintf(names[i], sizeof names[i], "%d.png", i);
        assert_int_equal(orl_image_init(NULL, &image, SIDE, SIDE, 3, ORL_PIXEL_U8), ORL_OK);
        for (int k = 0; k < 3 * SIDE * SIDE; k++)
            image.u8[k] = (uint8_t)wall_value(k / 3 % SIDE, k % 3, 2 * (i - 1));
        assert_int_equal(orl_png_write(NULL, ORL_PATH(dir, "%s", names[i]), &image), ORL_OK);
        orl_image_finish(&image);
        photos[i] = (struct orl_exposed){
            .name = names[i], .view = {{SIDE, SIDE, SIDE, SIDE, SIDE / 2.0, SIDE / 2.0},
                       {{{1, 0, 0}, {0, 1, 0}, {0, 0, 1}}, {0}}}};
    }
    struct orl_points points = make_wall();
    assert_int_equal(orl_samples_take(NULL, NULL, dir, photos, COUNT, &points, &samples), ORL_OK);
    size_t thrice = 0, blue_alone = 0;
    for (size_t p = 0; p < samples.point_count; p++)
        thrice += samples.first[p + 1] - samples.first[p] == COUNT;
    for (size_t i = 0; i < samples.count; i++) {
        assert_true(samples.items[i].clipped < 7);
        blue_alone += samples.items[i].clipped == 4;
    }
    assert_true(thrice > 24 * 24 / 4 && blue_alone > 20);
    // What is not clipped follows exposure.
    for (size_t p = 0; p < samples.point_count; p++)
        for (size_t i = samples.first[p]; i + 1 < samples.first[p + 1]; i++) {
            const struct orl_observation *a = &samples.items[i], *b = a + 1;
            for (int c = 0; c < 3; c++) {
                if ((a->clipped | b->clipped) & 1u << c || a->value[c] < 20)
                    continue;
                double ev = log2((double)orl_srgb_decode(b->value[c] / 255) /
                                 (double)orl_srgb_decode(a->value[c] / 255));
                assert_true(fabs(ev - 2.0 * ((int)b->photo - (int)a->photo)) < 0.15);
            }
        }
    orl_samples_finish(&samples);
    orl_points_finish(&points);
    test_dir_remove(dir);
}

// --- the church of Debevec and Malik ---

static bool read_church(struct stack *stack)
{
    const char *base = getenv("ORL_DATASETS");
    if (!base || !*base)
        base = SOURCE_DIR "/../shared/datasets";
    *stack = (struct stack){.photos = 16, .side = 80};
    stack->pixels = calloc(16, 3 * 80 * 80);
    assert_non_null(stack->pixels);
    for (int i = 0; i < 16; i++) {
        char path[4096];
        struct orl_image image = {0};
        snprintf(path, sizeof path, "%s/memorial-exposures/images/memorial%04d.png", base, 61 + i);
        if (orl_picture_read(NULL, path, 3, &image) != ORL_OK) {
            free(stack->pixels);
            return false;
        }
        stack->ev[i] = 5 - i;
        for (int at = 0; at < 80 * 80; at++) {
            // Borders were made when the photographs were registered.
            int x = 60 + at % 80 * (image.width - 120) / 80;
            int y = 60 + at / 80 * (image.height - 120) / 80;
            size_t from = 3 * ((size_t)y * (size_t)image.width + (size_t)x);
            memcpy(pixel(stack, i, at), image.u8 + from, 3);
        }
        orl_image_finish(&image);
    }
    return true;
}

// Median error of light's ratio between neighbouring exposures, in EV, of values within
// [40, 215] in both.
static double ratio_error(const struct stack *stack, float linear[3][256])
{
    size_t count = 0, most = 3 * (size_t)stack->photos * (size_t)(stack->side * stack->side);
    float *errors = calloc(most, sizeof *errors);
    assert_non_null(errors);
    for (int i = 0; i + 1 < stack->photos; i++)
        for (int at = 0; at < stack->side * stack->side; at++)
            for (int c = 0; c < 3; c++) {
                uint8_t a = pixel(stack, i, at)[c], b = pixel(stack, i + 1, at)[c];
                if (a < 40 || a > 215 || b < 40 || b > 215)
                    continue;
                errors[count++] = fabsf(log2f(linear[c][a] / linear[c][b]) -
                                        (float)(stack->ev[i] - stack->ev[i + 1]));
            }
    assert_true(count > 1000);
    qsort(errors, count, sizeof *errors, orl_order_floats);
    double median = (double)errors[count / 2];
    free(errors);
    return median;
}

static void the_church_agrees_with_opencv(void **state)
{
    (void)state;
    struct stack stack;
    if (!read_church(&stack)) {
        print_message("no memorial-exposures below ORL_DATASETS: skipped\n");
        skip();
    }
    struct orl_response response, debevec, robertson;
    double theirs[256];
    fit(ORL_RESPONSE_POLYNOMIAL, &stack, &response);
    fit(ORL_RESPONSE_DEBEVEC, &stack, &debevec);
    fit(ORL_RESPONSE_ROBERTSON, &stack, &robertson);
    double ratio = ratio_error(&stack, response.linear);
    print_message("ratio: %.3f EV, OpenCV's Debevec %.3f, Robertson %.3f\n", ratio,
                  ratio_error(&stack, debevec.linear), ratio_error(&stack, robertson.linear));
    assert_true(ratio < 0.1);
    for (int c = 0; c < 3; c++) {
        for (int v = 0; v < 256; v++)
            theirs[v] = (double)debevec.linear[c][v];
        double from_debevec = rms(response.linear[c], theirs, 32, 224);
        for (int v = 0; v < 256; v++)
            theirs[v] = (double)robertson.linear[c][v];
        double from_robertson = rms(response.linear[c], theirs, 32, 224);
        print_message("channel %d: RMS %.4f from OpenCV's Debevec, %.4f from Robertson\n", c,
                      from_debevec, from_robertson);
        assert_true(from_debevec < 0.025 && from_robertson < 0.035);
    }
    free(stack.pixels);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(channels_clip_alone),
        cmocka_unit_test(a_floor_has_no_say),
        cmocka_unit_test(one_viewpoint_gives_samples),
        cmocka_unit_test(the_church_agrees_with_opencv),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
