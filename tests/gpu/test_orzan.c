// The methods of Orzan 2005 against answers found by hand.
#include <math.h>

#include "core/color.h"
#include "oriel/points.h"
#include "wall_scene.h"

enum { SIDE = 48, MIDDLE = SIDE / 2 };

static struct orl_gpu *gpu;

static struct orl_frame draw_with(struct fixture *f, const char *method, const char *const *settings,
                                  size_t count)
{
    struct orl_render_params params = orl_method_find(NULL, method)->params;
    assert_int_equal(orl_render_params_assign(NULL, &params, settings, count), ORL_OK);
    return draw(gpu, f, look_from(0, 0, 0, SIDE, 40), &params, 0);
}

// What photographs of these colours, side by side, make of the middle of the wall. No weight but
// the test's own.
static void blend(const uint8_t (*colors)[3], int count, float out[3], float *coverage)
{
    static const char *const equal[] = {"weight=equal"};
    struct fixture f;
    setup(&f, false);
    for (int i = 0; i < count; i++)
        add_photo(&f, look_from(0.2 * i - 0.3, 0, 0, SIDE, 40), colors[i]);
    struct orl_frame frame = draw_with(&f, "orzan-surface", equal, 1);
    memcpy(out, color_at(&frame, MIDDLE, MIDDLE), 3 * sizeof *out);
    *coverage = frame.coverage.f32[MIDDLE * SIDE + MIDDLE];
    orl_frame_finish(&frame);
    teardown(&f);
}

static void assert_gray(const float color[3], int value)
{
    for (int c = 0; c < 3; c++)
        assert_float_equal(color[c], orl_srgb_decode((float)value / 255), 1e-3);
}

// The deviation of {a, a, b} is 0.471 of their difference, so that b lies 1.41 deviations away.
static void one_of_three_is_an_outlier(void **state)
{
    (void)state;
    static const uint8_t colors[3][3] = {{200, 200, 200}, {60, 60, 60}, {60, 60, 60}};
    float color[3], coverage;
    blend(colors, 3, color, &coverage);
    assert_gray(color, 60);
    assert_float_equal(coverage, 1, 0);
}

// Of three evenly spaced values both extremes lie 1.22 deviations away.
static void extremes_of_three_go(void **state)
{
    (void)state;
    static const uint8_t colors[3][3] = {{50, 50, 50}, {100, 100, 100}, {150, 150, 150}};
    float color[3], coverage;
    blend(colors, 3, color, &coverage);
    assert_gray(color, 100);
}

// One channel is enough to be an outlier.
static void every_channel_is_tested(void **state)
{
    (void)state;
    static const uint8_t colors[3][3] = {{90, 90, 90}, {90, 90, 90}, {90, 200, 90}};
    float color[3], coverage;
    blend(colors, 3, color, &coverage);
    assert_gray(color, 90);
}

static void two_against_two_stay(void **state)
{
    (void)state;
    static const uint8_t colors[4][3] = {{255, 0, 0}, {0, 255, 0}, {255, 0, 0}, {0, 255, 0}};
    float color[3], coverage;
    blend(colors, 4, color, &coverage);
    assert_float_equal(color[0], 0.5, 1e-3);
    assert_float_equal(color[1], 0.5, 1e-3);
}

// Of four against three, the three lie 1.155 deviations from the mean.
static void three_against_four_stay(void **state)
{
    (void)state;
    uint8_t colors[7][3] = {{0}};
    float color[3], coverage;
    for (int i = 0; i < 7; i++)
        colors[i][i % 2] = 255;
    blend(colors, 7, color, &coverage);
    assert_float_equal(color[0], 4.0 / 7, 1e-3);
    assert_float_equal(color[1], 3.0 / 7, 1e-3);
}

static void fewer_than_three_stay(void **state)
{
    (void)state;
    static const uint8_t colors[2][3] = {{255, 255, 255}, {0, 0, 0}};
    float color[3], coverage;
    blend(colors, 2, color, &coverage);
    for (int c = 0; c < 3; c++)
        assert_float_equal(color[c], 0.5, 1e-3);
}

// Red, green and blue are outliers of each other: nothing is left, and so nothing is covered.
static void where_none_is_left_nothing_paints(void **state)
{
    (void)state;
    static const uint8_t colors[3][3] = {{255, 0, 0}, {0, 255, 0}, {0, 0, 255}};
    float color[3], coverage;
    blend(colors, 3, color, &coverage);
    assert_float_equal(coverage, 0, 0);
}

// Two of three photographs are nearest; each weighs 1 - p / p3, angles being those at the wall's
// middle, which is the middle of the bounding box.
static void the_nearest_fade_by_the_next(void **state)
{
    (void)state;
    static const char *const two[] = {"nearest=2"};
    struct fixture f;
    setup(&f, false);
    add_photo(&f, look_from(0.9, 0, 0, SIDE, 40), blue);
    add_photo(&f, look_from(-0.2, 0, 0, SIDE, 40), red);
    add_photo(&f, look_from(0.5, 0, 0, SIDE, 40), green);
    struct orl_frame frame = draw_with(&f, "orzan-view", two, 1);
    const float *middle = color_at(&frame, MIDDLE, MIDDLE);
    double limit = atan2(0.9, 4), a = 1 - atan2(0.2, 4) / limit, b = 1 - atan2(0.5, 4) / limit;
    assert_float_equal(middle[0], a / (a + b), 2e-3);
    assert_float_equal(middle[1], b / (a + b), 2e-3);
    assert_float_equal(middle[2], 0, 1e-6);
    orl_frame_finish(&frame);
    teardown(&f);
}

// A photograph from behind the wall paints only where nobody asks which way the surface faces: with
// equal weights, too, while the weights of the methods themselves are 0 there.
static void what_faces_away_is_not_seen(void **state)
{
    (void)state;
    static const char *const blind[] = {"weight=equal", "visibility=none"};
    struct fixture f;
    setup(&f, false);
    add_photo(&f, look_from(0.1, 0, 0, SIDE, 40), red);
    struct orl_view behind = look_from(0, 0, 0, SIDE, 40);
    behind.cam_from_world = (struct orl_pose){.r = {{-1, 0, 0}, {0, 1, 0}, {0, 0, -1}},
                                              .t = {0, 0, 8}};
    add_photo(&f, behind, green);
    static const char *const methods[] = {"orzan-surface", "orzan-shadow"};
    for (size_t m = 0; m < 2 * ORL_COUNT(methods); m++) {
        struct orl_frame facing = draw_with(&f, methods[m / 2], blind, m % 2);
        assert_float_equal(color_at(&facing, MIDDLE, MIDDLE)[1], 0, 1e-6);
        assert_float_equal(color_at(&facing, MIDDLE, MIDDLE)[0], 1, 1e-4);
        orl_frame_finish(&facing);
    }
    struct orl_frame all = draw_with(&f, "orzan-surface", blind, 2);
    assert_float_equal(color_at(&all, MIDDLE, MIDDLE)[1], 0.5, 1e-3);
    orl_frame_finish(&all);
    teardown(&f);
}

// The plate stands between the wall's middle and a photograph, which only a shadow map tells.
static void shadow_maps_see_what_stands_between(void **state)
{
    (void)state;
    static const char *const equal[] = {"weight=equal", "fill=none"};
    struct fixture f;
    setup(&f, true);
    add_photo(&f, look_from(1.4, 0, 0, SIDE, 20), red);
    add_photo(&f, look_from(-0.5, 0, 0, SIDE, 20), green);
    struct orl_frame facing = draw_with(&f, "orzan-surface", equal, 2);
    struct orl_frame shadow = draw_with(&f, "orzan-shadow", equal, 2);
    assert_float_equal(color_at(&facing, MIDDLE, MIDDLE)[0], 0.5, 1e-3);
    assert_float_equal(color_at(&shadow, MIDDLE, MIDDLE)[0], 0, 1e-6);
    assert_float_equal(color_at(&shadow, MIDDLE, MIDDLE)[1], 1, 1e-3);
    orl_frame_finish(&facing);
    orl_frame_finish(&shadow);
    teardown(&f);
}

// A photograph so fine that it sees the wall between the plate's points: what it shows there is not
// the plate, which is whole in the view.
static void shadow_maps_see_past_what_is_thin(void **state)
{
    (void)state;
    enum { PLATE = 20, FINER = 20 };
    static const char *const plain[] = {"weight=equal", "fill=none", "median=off"};
    struct fixture f;
    setup(&f, true);
    struct orl_points *points = &f.scene.points;
    for (size_t i = points->count - PLATE * PLATE; i < points->count; i++)
        points->radius[i] = 0.001f;
    add_photo(&f, look_from(0, 0, 0, FINER * SIDE, FINER * 40), green);
    struct orl_frame frame = draw_with(&f, "orzan-shadow", plain, 3);
    int plate = 0, painted = 0;
    for (int i = 0; i < SIDE * SIDE; i++) {
        bool on = frame.depth.f32[i] > 0 && frame.depth.f32[i] < 3;
        plate += on;
        painted += on && frame.coverage.f32[i] > 0;
    }
    print_message("%d of %d pixels are painted\n", painted, plate);
    assert_true(plate > 30 && 3 * painted < 2 * plate);
    orl_frame_finish(&frame);
    teardown(&f);
}

// Of six photographs, five paint.
static void shadow_asks_the_best_five(void **state)
{
    (void)state;
    static const char *const mean[] = {"combine=mean"};
    struct fixture f;
    setup(&f, false);
    for (int i = 0; i < 5; i++)
        add_photo(&f, look_from(0.1 * i - 0.2, 0, 0, SIDE, 20), red);
    add_photo(&f, look_from(1.5, 0, 0, SIDE, 20), blue);
    struct orl_frame frame = draw_with(&f, "orzan-shadow", mean, 1);
    assert_float_equal(color_at(&frame, MIDDLE, MIDDLE)[0], 1, 1e-3);
    assert_float_equal(color_at(&frame, MIDDLE, MIDDLE)[2], 0, 1e-6);
    orl_frame_finish(&frame);
    teardown(&f);
}

// The cosine to the normal: a photograph 45 degrees aside weighs 0.71 of one straight before.
static void weights_follow_the_normal(void **state)
{
    (void)state;
    struct fixture f;
    setup(&f, false);
    add_photo(&f, look_from(0.05, 0, 0, SIDE, 40), red);
    add_photo(&f, look_from(4, 0, 0, SIDE, 20), green);
    struct orl_frame frame = draw_with(&f, "orzan-surface", NULL, 0);
    const float *middle = color_at(&frame, MIDDLE, MIDDLE);
    assert_float_equal(middle[1] / middle[0], sqrt(0.5), 0.01);
    orl_frame_finish(&frame);
    teardown(&f);
}

static bool is_green_beside(const struct orl_frame *frame, int x, int y)
{
    for (int j = y - 1; j <= y + 1; j++)
        for (int i = x - 1; i <= x + 1; i++)
            if (i >= 0 && j >= 0 && i < SIDE && j < SIDE && color_at(frame, i, j)[1] > 0.5f)
                return true;
    return false;
}

// What the plate hides from every photograph that looks past it takes the colours within two pixels.
static void medians_fill_small_holes(void **state)
{
    (void)state;
    static const char *const none[] = {"median=off", "fill=none"}, *const holes[] = {"fill=none"};
    struct fixture f;
    setup(&f, true);
    add_photo(&f, look_from(1.2, 0, 0, SIDE, 40), green);
    struct orl_frame open = draw_with(&f, "orzan-shadow", none, 2);
    struct orl_frame filled = draw_with(&f, "orzan-shadow", holes, 1);
    int more = 0, farther = 0;
    for (int i = 0; i < SIDE * SIDE; i++) {
        bool was = open.color.f32[3 * i + 1] > 0.5f, is = filled.color.f32[3 * i + 1] > 0.5f;
        assert_true(is || !was);
        more += is && !was;
        farther += is && !is_green_beside(&open, i % SIDE, i / SIDE);
    }
    assert_true(more > 10 && farther > 0);
    orl_frame_finish(&open);
    orl_frame_finish(&filled);
    teardown(&f);
}

// Where two colours meet at a hole, a filled pixel has one of them: a mean would have both. The
// photograph's rows are the view's.
static void medians_mix_no_colours(void **state)
{
    (void)state;
    static const char *const none[] = {"median=off", "fill=none"}, *const holes[] = {"fill=none"};
    struct fixture f;
    setup(&f, true);
    add_photo(&f, look_from(1.2, 0, 0, SIDE, 40), red);
    struct orl_image image;
    assert_int_equal(orl_image_init(NULL, &image, SIDE, SIDE, 3, ORL_PIXEL_U8), ORL_OK);
    for (int i = 0; i < SIDE * SIDE; i++)
        image.u8[3 * i + (i / SIDE < MIDDLE ? 0 : 1)] = 255;
    image.u8[3 * (10 * SIDE + 10) + 2] = 255; // 12 pixels to the left of where the view has it
    repaint_photo(&f, &image);
    struct orl_frame open = draw_with(&f, "orzan-shadow", none, 2);
    struct orl_frame filled = draw_with(&f, "orzan-shadow", holes, 1);
    int more = 0;
    for (int y = MIDDLE - 2; y < MIDDLE + 2; y++)
        for (int x = 0; x < SIDE; x++) {
            const float *before = color_at(&open, x, y), *c = color_at(&filled, x, y);
            if (before[0] + before[1] > 0 || !(c[0] + c[1] > 0))
                continue;
            assert_true(c[0] > 0.99f || c[1] > 0.99f);
            assert_true(c[0] < 0.01f || c[1] < 0.01f);
            more++;
        }
    assert_true(more >= 4);
    assert_float_equal(color_at(&filled, 22, 10)[2], 1, 0.01); // what is painted stays
    orl_frame_finish(&open);
    orl_frame_finish(&filled);
    teardown(&f);
}

// A single pixel of another colour goes, and a straight edge stays.
static void medians_keep_edges(void **state)
{
    (void)state;
    static const char *const off[] = {"median=off"}, *const all[] = {"median=all"};
    struct fixture f;
    setup(&f, false);
    add_photo(&f, look_from(0, 0, 0, SIDE, 40), red);
    struct orl_image image;
    assert_int_equal(orl_image_init(NULL, &image, SIDE, SIDE, 3, ORL_PIXEL_U8), ORL_OK);
    for (int i = 0; i < SIDE * SIDE; i++)
        image.u8[3 * i + (i % SIDE < MIDDLE ? 0 : 1)] = 255;
    image.u8[3 * (10 * SIDE + 10) + 2] = 255;
    repaint_photo(&f, &image);
    struct orl_frame raw = draw_with(&f, "orzan-surface", off, 1);
    struct orl_frame filtered = draw_with(&f, "orzan-surface", all, 1);
    assert_true(color_at(&raw, 10, 10)[2] > 0.9f);
    assert_float_equal(color_at(&filtered, 10, 10)[2], 0, 1e-3);
    for (int y = 12; y < 36; y++) {
        assert_float_equal(color_at(&filtered, MIDDLE - 1, y)[0], 1, 1e-2);
        assert_float_equal(color_at(&filtered, MIDDLE, y)[1], 1, 1e-2);
    }
    orl_frame_finish(&raw);
    orl_frame_finish(&filtered);
    teardown(&f);
}

int main(void)
{
    gpu = gpu_test_device();
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(one_of_three_is_an_outlier),
        cmocka_unit_test(extremes_of_three_go),
        cmocka_unit_test(every_channel_is_tested),
        cmocka_unit_test(two_against_two_stay),
        cmocka_unit_test(three_against_four_stay),
        cmocka_unit_test(fewer_than_three_stay),
        cmocka_unit_test(where_none_is_left_nothing_paints),
        cmocka_unit_test(the_nearest_fade_by_the_next),
        cmocka_unit_test(what_faces_away_is_not_seen),
        cmocka_unit_test(weights_follow_the_normal),
        cmocka_unit_test(medians_fill_small_holes),
        cmocka_unit_test(medians_mix_no_colours),
        cmocka_unit_test(shadow_maps_see_what_stands_between),
        cmocka_unit_test(shadow_maps_see_past_what_is_thin),
        cmocka_unit_test(shadow_asks_the_best_five),
        cmocka_unit_test(medians_keep_edges),
    };
    int failed = cmocka_run_group_tests_name("Orzan", tests, NULL, NULL);
    orl_gpu_destroy(&gpu);
    return failed;
}
