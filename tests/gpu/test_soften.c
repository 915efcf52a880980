// What is painted on guessed depth is blurred as far as it may be displaced; what has depth is not.
#include <math.h>
#include <string.h>

#include "core/color.h"
#include "wall_scene.h"

enum { SIDE = 512, GREY = 128, WALL_END = 352 }; // column of x = 3, z = 4, where the wall ends
static const double FOCAL = 128;

static struct orl_gpu *gpu;

// A photograph red as far as `wall_end`, then with upright stripes of blue or black, each `width`
// pixels wide; 8-bit `value`.
static void add_striped(struct fixture *f, struct orl_view view, int wall_end, int width,
                        uint8_t value)
{
    add_photo(f, view, red);
    struct orl_image image;
    int w = view.camera.width, h = view.camera.height;
    assert_int_equal(orl_image_init(NULL, &image, w, h, 3, ORL_PIXEL_U8), ORL_OK);
    for (int i = 0; i < w * h; i++) {
        int behind = i % w - wall_end;
        image.u8[3 * i] = behind < 0 ? value : 0;
        image.u8[3 * i + 1] = 0;
        image.u8[3 * i + 2] = behind >= 0 && behind / width % 2 == 0 ? value : 0;
    }
    repaint_photo(f, &image);
}

// A view of the wall's right end from x = 0, painted by one photograph from `x` with stripes of `width`
// pixels.
static struct orl_frame see_stripes(double x, int width, const struct orl_render_params *params,
                                    bool radiance)
{
    struct fixture f;
    setup(&f, false);
    struct orl_view photo = look_from(x, 0, 0, 2 * SIDE, FOCAL);
    // As radiance, white would be light without an upper bound.
    add_striped(&f, photo, SIDE + (int)lrint((3 - x) / 4 * FOCAL), width, radiance ? GREY : 255);
    struct orl_renderer_params kind = {.radiance = radiance};
    struct orl_frame frame = draw_by(gpu, &f, look_from(0, 0, 0, SIDE, FOCAL), params, &kind);
    teardown(&f);
    return frame;
}

static struct orl_frame from_aside_with(double x, float guess_blur, bool radiance)
{
    struct orl_render_params params = orl_method_find(NULL, "oriel")->params;
    params.guess_blur = guess_blur;
    params.antialias = ORL_ANTIALIAS_OFF;
    return see_stripes(x, 2, &params, radiance);
}

static struct orl_frame from_aside(double x, float guess_blur)
{
    return from_aside_with(x, guess_blur, false);
}

// Between brightest and darkest blue of 64 pixels of a row.
static double contrast_from(const struct orl_frame *frame, int first)
{
    float least = INFINITY, most = -INFINITY;
    for (int x = first; x < first + 64; x++) {
        least = fminf(least, color_at(frame, x, SIDE / 2)[2]);
        most = fmaxf(most, color_at(frame, x, SIDE / 2)[2]);
    }
    return most - least;
}

static double contrast(const struct orl_frame *frame)
{
    return contrast_from(frame, WALL_END + 16);
}

static void guesses_from_aside_blur(void **state)
{
    (void)state;
    struct orl_frame sharp = from_aside(-1.5, 0), soft = from_aside(-1.5, 0.6f);
    assert_true(contrast(&sharp) > 0.9);
    assert_true(contrast(&soft) < 0.25);
    double mean = 0;
    for (int x = WALL_END + 16; x < WALL_END + 80; x++)
        mean += color_at(&soft, x, SIDE / 2)[2] / 64.0;
    assert_float_equal(mean, 0.5, 0.05);
    orl_frame_finish(&sharp);
    orl_frame_finish(&soft);
}

static void radiance_blurs_alike(void **state)
{
    (void)state;
    const double light = (double)orl_srgb_decode(GREY / 255.0f);
    struct orl_frame sharp = from_aside_with(-1.5, 0, true);
    struct orl_frame soft = from_aside_with(-1.5, 0.6f, true);
    assert_true(contrast(&sharp) > 0.9 * light);
    assert_true(contrast(&soft) < 0.25 * light);
    for (int i = 0; i < SIDE * SIDE; i++) {
        if (soft.coverage.f32[i] > 0)
            assert_memory_equal(&soft.color.f32[3 * i], &sharp.color.f32[3 * i], 12);
        assert_float_equal(soft.confidence.f32[i], sharp.confidence.f32[i], 0);
    }
    orl_frame_finish(&sharp);
    orl_frame_finish(&soft);
}

static void surfaces_stay_sharp_and_do_not_run(void **state)
{
    (void)state;
    struct orl_frame sharp = from_aside(-1.5, 0), soft = from_aside(-1.5, 0.6f);
    for (int y = SIDE / 2 - 64; y < SIDE / 2 + 64; y++) // beside the wall
        for (int x = SIDE / 2; x < SIDE; x++) {
            int i = y * SIDE + x;
            assert_float_equal(soft.coverage.f32[i], sharp.coverage.f32[i], 0);
            if (soft.coverage.f32[i] > 0)
                assert_memory_equal(&soft.color.f32[3 * i], &sharp.color.f32[3 * i], 12);
            else
                assert_float_equal(soft.color.f32[3 * i], 0, 0.02); // of the wall's red
        }
    orl_frame_finish(&sharp);
    orl_frame_finish(&soft);
}

// Whatever its depth, what is seen from the same place is in its place.
static void a_photograph_from_here_stays_sharp(void **state)
{
    (void)state;
    struct orl_frame sharp = from_aside(0, 0), soft = from_aside(0, 0.3f);
    assert_memory_equal(soft.color.f32, sharp.color.f32, sizeof(float) * 3 * SIDE * SIDE);
    orl_frame_finish(&sharp);
    orl_frame_finish(&soft);
}

// So it is to its very border, where the photograph fades.
static void a_photograph_from_here_stays_sharp_at_its_border(void **state)
{
    (void)state;
    struct orl_frame frames[2];
    struct orl_render_params params = orl_method_find(NULL, "oriel")->params;
    params.antialias = ORL_ANTIALIAS_OFF;
    for (int i = 0; i < 2; i++) {
        struct fixture f;
        setup(&f, false);
        add_striped(&f, look_from(0, 0, 0, SIDE, FOCAL), WALL_END, 2, 255);
        params.guess_blur = i ? 0.3f : 0;
        frames[i] = draw(gpu, &f, look_from(0, 0, 0, SIDE, FOCAL), &params, 0);
        teardown(&f);
    }
    assert_memory_equal(frames[1].color.f32, frames[0].color.f32, sizeof(float) * 3 * SIDE * SIDE);
    orl_frame_finish(&frames[0]);
    orl_frame_finish(&frames[1]);
}

// Where photographs agree, depth was guessed well; where they do not, it was not.
static void agreement_keeps_sharp(void **state)
{
    (void)state;
    for (int apart = 0; apart < 2; apart++) {
        struct fixture f;
        setup(&f, false);
        // All see z = 4, where depth is guessed, or one shows the stripes elsewhere.
        for (int k = 0; k < 2; k++) {
            double x = k ? 1.5 : -1.5;
            int end = SIDE + (int)lrint((3 - x) / 4 * FOCAL);
            add_striped(&f, look_from(x, 0, 0, 2 * SIDE, FOCAL), end + 4 * apart * k, 4, 255);
        }
        struct orl_render_params params = orl_method_find(NULL, "oriel")->params;
        params.guess_blur = 0.3f;
        struct orl_frame frame = draw(gpu, &f, look_from(0, 0, 0, SIDE, FOCAL), &params, 0);
        // The middle of a stripe of 4 columns, the fifth.
        double light = color_at(&frame, WALL_END + 18, SIDE / 2)[2];
        assert_true(apart ? light > 0.2 && light < 0.8 : light > 0.95);
        orl_frame_finish(&frame);
        teardown(&f);
    }
}

int main(void)
{
    gpu = gpu_test_device();
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(guesses_from_aside_blur),
        cmocka_unit_test(radiance_blurs_alike),
        cmocka_unit_test(surfaces_stay_sharp_and_do_not_run),
        cmocka_unit_test(a_photograph_from_here_stays_sharp),
        cmocka_unit_test(a_photograph_from_here_stays_sharp_at_its_border),
        cmocka_unit_test(agreement_keeps_sharp),
    };
    int failed = cmocka_run_group_tests_name("soften", tests, NULL, NULL);
    orl_gpu_destroy(&gpu);
    return failed;
}
