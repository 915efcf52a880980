// Methods made of slots, against answers found by hand.
#include <math.h>
#include <string.h>

#include "render/frame/method.h"
#include "render/photos/photos.h"
#include "oriel/points.h"
#include "wall_scene.h"

enum { SIDE = 48 };

static struct orl_gpu *gpu;

// Noise, so that no two photographs and no two pixels are alike.
static void add_noise_photo(struct fixture *f, struct orl_view view, uint32_t seed)
{
    struct orl_image image;
    add_photo(f, view, red);
    assert_int_equal(orl_image_init(NULL, &image, view.camera.width, view.camera.height, 3,
                                    ORL_PIXEL_U8), ORL_OK);
    for (int i = 0; i < 3 * view.camera.width * view.camera.height; i++) {
        seed = seed * 1664525u + 1013904223u;
        image.u8[i] = (uint8_t)(seed >> 24);
    }
    repaint_photo(f, &image);
}

// Penalty of method ulr for the wall point that the middle pixel sees, of a photograph at (x, 0, z).
static double ulr_penalty(double x, double z)
{
    double there = hypot(4 - z, x), angle = atan2(fabs(x), 4 - z);
    return angle + 0.1 * fmax(1e-4, (there - 4) / there);
}

// Six photographs side by side: the four nearest paint, by 1 - p / p5.
static void the_best_four_fade_by_the_fifth(void **state)
{
    (void)state;
    static const double places[6] = {-0.2, 0.3, -0.5, 0.7, 0.9, -1.1};
    struct fixture f;
    setup(&f, false);
    // An odd size: the middle pixel looks straight ahead.
    struct orl_view view = look_from(0, 0, 0, SIDE + 1, 40);
    double sum[3] = {0}, weights = 0, fifth = ulr_penalty(places[4], 0);
    for (int i = 0; i < 6; i++) {
        const uint8_t *color = i == 0 ? red : i == 1 ? green : i < 4 ? blue : red;
        add_photo(&f, look_from(places[i], 0, 0, SIDE, 40), color);
        double weight = fmax(0, 1 - ulr_penalty(places[i], 0) / fifth);
        weights += weight;
        for (int c = 0; c < 3; c++)
            sum[c] += weight * (color[c] == 255);
    }
    struct orl_render_params params = orl_method_find(NULL, "ulr")->params;
    struct orl_frame frame = draw(gpu, &f, view, &params, 0);
    for (int c = 0; c < 3; c++)
        assert_float_equal(color_at(&frame, SIDE / 2, SIDE / 2)[c], sum[c] / weights, 2e-3);
    orl_frame_finish(&frame);
    teardown(&f);
}

// A photograph straight behind the viewer, twice as far from the wall, and one aside as far as the
// viewer count nearly alike.
static void farther_photographs_count_less(void **state)
{
    (void)state;
    static const double x[5] = {0, 0.2, 0.3, -0.3, 0.4}, z[5] = {-4, 0, 0, 0, 0};
    struct fixture f;
    setup(&f, false);
    double weight[2], fifth = ulr_penalty(x[4], z[4]);
    for (int i = 0; i < 5; i++)
        add_photo(&f, look_from(x[i], 0, z[i], SIDE, 40), i == 0 ? red : i == 1 ? green : blue);
    for (int i = 0; i < 2; i++)
        weight[i] = 1 - ulr_penalty(x[i], z[i]) / fifth;
    struct orl_render_params params = orl_method_find(NULL, "ulr")->params;
    struct orl_frame frame = draw(gpu, &f, look_from(0, 0, 0, SIDE + 1, 40), &params, 0);
    const float *middle = color_at(&frame, SIDE / 2, SIDE / 2);
    assert_float_equal(middle[0] / middle[1], weight[0] / weight[1], 0.02);
    orl_frame_finish(&frame);
    teardown(&f);
}

// Fewer than five photographs share by equal weights.
static void few_photographs_paint_too(void **state)
{
    (void)state;
    struct fixture f;
    setup(&f, false);
    struct orl_view view = look_from(0, 0, 0, SIDE, 40);
    add_photo(&f, look_from(0.5, 0, 0, SIDE, 40), green);
    add_photo(&f, look_from(-0.5, 0, 0, SIDE, 40), red);
    struct orl_render_params params = orl_method_find(NULL, "ulr")->params;
    struct orl_frame frame = draw(gpu, &f, view, &params, 0);
    const float *middle = color_at(&frame, SIDE / 2, SIDE / 2);
    assert_float_equal(middle[0], 0.5, 0.01);
    assert_float_equal(middle[1], 0.5, 0.01);
    assert_float_equal(frame.coverage.f32[SIDE / 2 * SIDE + SIDE / 2], 1, 0);
    orl_frame_finish(&frame);
    teardown(&f);
}

// The weight of each of more than four that tie, 1 - p / p5, is 0.
static void photographs_that_tie_paint(void **state)
{
    (void)state;
    struct fixture f;
    setup(&f, false);
    for (int i = 0; i < 6; i++)
        add_photo(&f, look_from(0.5, 0, 0, SIDE, 40), green);
    struct orl_render_params params = orl_method_find(NULL, "ulr")->params;
    params.fill = ORL_FILL_NONE;
    struct orl_frame frame = draw(gpu, &f, look_from(0, 0, 0, SIDE, 40), &params, 0);
    assert_float_equal(color_at(&frame, SIDE / 2, SIDE / 2)[1], 1, 1e-3);
    orl_frame_finish(&frame);
    teardown(&f);
}

// Pixel (44, 24) sees nothing, and is guessed to be at (6.8, 0, 4), beside the wall. From (-5.4, 0, 0)
// the plate, at (0.7, 0, 2), hides that place.
static void guesses_take_nothing_of_what_hides_them(void **state)
{
    (void)state;
    static const char *const visibility[] = {"hard", "shadow", "none"};
    struct fixture f;
    setup(&f, true);
    add_photo(&f, look_from(3, 0, 0, SIDE, 20), red);
    add_photo(&f, look_from(-5.4, 0, 0, 4 * SIDE, 28), green);
    for (size_t i = 0; i < ORL_COUNT(visibility); i++) {
        struct orl_render_params params = orl_method_find(NULL, "airieau")->params;
        snprintf(params.visibility, sizeof params.visibility, "%s", visibility[i]);
        snprintf(params.weight, sizeof params.weight, "equal");
        params.fill = ORL_FILL_DEPTH;
        struct orl_frame frame = draw(gpu, &f, look_from(0, 0, 0, SIDE, 12), &params, 0);
        assert_float_equal(color_at(&frame, 44, 24)[1], strcmp(visibility[i], "none") ? 0 : 0.5, 0.01);
        orl_frame_finish(&frame);
    }
    teardown(&f);
}

// Photographs that are on the device one at a time give the same bits as all at once.
static void turns_change_nothing(void **state)
{
    (void)state;
    static const char *const methods[] = {"airieau", "ulr", "orzan-surface", "princ"};
    struct fixture f;
    setup(&f, true);
    struct orl_view view = look_from(0.1, 0, 0, SIDE, 40);
    for (int i = 0; i < 7; i++)
        add_noise_photo(&f, look_from(0.35 * i - 1, 0.1 * i - 0.3, 0, SIDE, 40), (uint32_t)i);
    for (size_t m = 0; m < ORL_COUNT(methods); m++) {
        struct orl_render_params params = orl_method_find(NULL, methods[m])->params;
        // Too little memory makes photographs smaller first, as small as this.
        const struct orl_renderer_params whole = {.photo_divide = 4, .textures = ORL_TEXTURES_FULL};
        struct orl_renderer_params tight = whole;
        tight.max_vram_bytes = 1;
        struct orl_frame a = draw_by(gpu, &f, view, &params, &whole);
        struct orl_frame b = draw_by(gpu, &f, view, &params, &tight);
        assert_memory_equal(a.color.data, b.color.data, orl_image_bytes(&a.color));
        assert_memory_equal(a.coverage.data, b.coverage.data, orl_image_bytes(&a.coverage));
        orl_frame_finish(&a);
        orl_frame_finish(&b);
    }
    teardown(&f);
}

// Two photographs of other focal lengths and distances: their shares in a pixel tell the shader's
// penalties, which are those that the processor chooses photographs by.
static void both_sides_have_one_penalty(void **state)
{
    (void)state;
    static const char *const choices[] = {"weight=lumigraph", "sharpness=1", "visibility=none"};
    struct fixture f;
    setup(&f, false);
    struct orl_view view = look_from(0, 0, 0, SIDE + 1, 40);
    add_photo(&f, look_from(-0.6, 0, -1, SIDE, 25), red);
    add_photo(&f, look_from(0.4, 0.3, 0.5, SIDE, 70), green);
    struct orl_render_params params = orl_method_find(NULL, "airieau")->params;
    assert_int_equal(orl_render_params_assign(NULL, &params, choices, ORL_COUNT(choices)), ORL_OK);
    struct orl_frame frame = draw(gpu, &f, view, &params, 0);
    const float *middle = color_at(&frame, SIDE / 2, SIDE / 2);
    static const double eye[3] = {0, 0, 0}, point[3] = {0, 0, 4};
    double penalty[2];
    for (int i = 0; i < 2; i++)
        penalty[i] = orl_photo_penalty(&f.photos[i].view, eye, 40, point);
    assert_true(penalty[0] > 1.2 * penalty[1]); // coarser: it is the focal lengths that matter
    // On surfaces, the root of penalty^2 + 0.3^2.
    assert_float_equal(middle[0] / middle[1], hypot(penalty[1], 0.3) / hypot(penalty[0], 0.3),
                       1e-3);
    orl_frame_finish(&frame);
    teardown(&f);
}

// What a photograph elsewhere weighs beside one at the view's own place, in a pixel of their mean. From
// (3, 0, 0) the wall's middle is 5 away, at an angle whose cosine is 0.8; from (0, 0, -2) 6 away.
static void weights_are_those_of_their_formulas(void **state)
{
    (void)state;
    static const struct {
        const char *weight;
        double x, z, expected, own_z; // own_z: of the other photograph
    } rows[] = {
        // 1 / (angle + a tenth of how much nearer): 0.1 * 2 / 6, and the angle and 0.1 * 1 / 5.
        {"weight=ulr", 3, 0, (0.2 / 6) / (0.6435011 + 0.02), -2},
        {"weight=equal", 3, 0, 1, 0},
        {"weight=airieau", 3, 0, 0.8 / 0.25 / (1 / 0.5), -2},
        {"weight=airieau", 0, -1, 1 / 0.25 / (1 / 0.5), -2},
    };
    for (size_t i = 0; i < ORL_COUNT(rows); i++) {
        const char *const choices[] = {rows[i].weight, "visibility=none", "combine=mean"};
        struct fixture f;
        setup(&f, false);
        add_photo(&f, look_from(0, 0, rows[i].own_z, SIDE, 20), red);
        add_photo(&f, look_from(rows[i].x, 0, rows[i].z, SIDE, 20), green);
        struct orl_render_params params = orl_method_find(NULL, "airieau")->params;
        assert_int_equal(orl_render_params_assign(NULL, &params, choices, 3), ORL_OK);
        struct orl_frame frame = draw(gpu, &f, look_from(0, 0, 0, SIDE + 1, 40), &params, 0);
        const float *middle = color_at(&frame, SIDE / 2, SIDE / 2);
        assert_float_equal(middle[1] / middle[0], rows[i].expected, 0.01 * rows[i].expected);
        orl_frame_finish(&frame);
        teardown(&f);
    }
}

// PSNR of the covered pixels of a view beside the first photograph, dB.
static double likeness(struct fixture *f, struct orl_view view,
                       const struct orl_render_params *params)
{
    struct orl_frame frame = draw(gpu, f, view, params, 0);
    struct orl_image srgb, photo;
    char *path = strdup(orl_scene_file(&f->scene, 0, ORL_FILE_PHOTO).text);
    assert_int_equal(orl_tone_srgb(NULL, &frame.color, &srgb), ORL_OK);
    assert_int_equal(orl_picture_read(NULL, path, 3, &photo), ORL_OK);
    double squares = 0, count = 0;
    for (int i = 0; i < 3 * SIDE * SIDE; i++) {
        double off = (double)srgb.u8[i] - photo.u8[i];
        squares += frame.coverage.f32[i / 3] > 0 ? off * off : 0;
        count += frame.coverage.f32[i / 3] > 0;
    }
    assert_true(count > 2 * SIDE * SIDE);
    free(path);
    orl_image_finish(&srgb);
    orl_image_finish(&photo);
    orl_frame_finish(&frame);
    return 10 * log10(255 * 255 * count / squares);
}

// Airieau 2012, section 4: where the lines of sight are a photograph's own, the picture is that
// photograph.
static void at_its_own_place_a_photograph_shows(void **state)
{
    (void)state;
    struct fixture f;
    setup(&f, false);
    struct orl_view view = look_from(0, 0, 0, SIDE, 40);
    for (int i = 0; i < 5; i++)
        add_noise_photo(&f, look_from(0.3 * i, 0, -0.6 * i, SIDE, 40), (uint32_t)i);
    struct orl_render_params params = orl_method_find(NULL, "airieau")->params;
    assert_true(likeness(&f, view, &params) > 45);
    teardown(&f);
}

// A photograph whose own depth map has nothing where the point would be is rejected, unless the
// method is soft. Small splats leave holes in the depth of the photograph that stands nearer.
static void without_depth_a_photograph_is_rejected(void **state)
{
    (void)state;
    static const char *const soft[] = {"visibility=soft", "weight=equal"};
    static const char *const strict[] = {"weight=equal"};
    struct fixture f;
    setup(&f, false);
    struct orl_view view = look_from(0, 0, 0, SIDE, 40);
    add_photo(&f, view, red);
    add_photo(&f, look_from(0, 0, 3.6, SIDE, 40), green);
    struct orl_render_params params = orl_method_find(NULL, "airieau")->params;
    params.splat_scale = 0.2f;
    struct orl_render_params other = params;
    assert_int_equal(orl_render_params_assign(NULL, &params, strict, 1), ORL_OK);
    assert_int_equal(orl_render_params_assign(NULL, &other, soft, 2), ORL_OK);
    struct orl_frame a = draw(gpu, &f, view, &params, 0), b = draw(gpu, &f, view, &other, 0);
    double rejected = 0, passed = 0;
    for (int i = 0; i < SIDE * SIDE; i++) {
        rejected += a.coverage.f32[i] > 0 ? (double)a.color.f32[3 * i + 1] : 0;
        passed += b.coverage.f32[i] > 0 ? (double)b.color.f32[3 * i + 1] : 0;
    }
    assert_true(passed > 1.1 * rejected);
    orl_frame_finish(&a);
    orl_frame_finish(&b);
    teardown(&f);
}

// Every method paints radiance too.
static void every_method_gives_radiance(void **state)
{
    (void)state;
    struct fixture f;
    setup(&f, false);
    struct orl_view view = look_from(0, 0, 0, SIDE, 40);
    add_photo(&f, look_from(0.3, 0, 0, SIDE, 40), green);
    add_photo(&f, look_from(-0.3, 0, 0, SIDE, 40), green);
    for (const struct orl_method *m = orl_methods; m->name; m++) {
        const struct orl_renderer_params radiance = {.radiance = true};
        struct orl_render_params params;
        orl_render_params_tuned(NULL, m, &f.scene, &params);
        struct orl_frame frame = draw_by(gpu, &f, view, &params, &radiance);
        const float *middle = color_at(&frame, SIDE / 2, SIDE / 2);
        bool own = strcmp(m->params.paint->name, "points") == 0; // the wall's splats are red
        assert_float_equal(middle[own ? 0 : 1], 1, 0.02);
        assert_float_equal(middle[2], 0, 0.02);
        orl_frame_finish(&frame);
    }
    teardown(&f);
}

// Every file of a slot works in the generic gather, whether a method of the list names it or not.
static void every_slot_paints(void **state)
{
    (void)state;
    static const char *const slots[] = {"visibility", "weight", "combine"};
    struct fixture f;
    setup(&f, false);
    struct orl_view view = look_from(0, 0, 0, SIDE, 40);
    add_photo(&f, look_from(0.3, 0, 0, SIDE, 40), green);
    add_photo(&f, look_from(-0.3, 0, 0, SIDE, 40), green);
    for (size_t i = 0; i < ORL_COUNT(slots); i++) {
        char folder[64], assignment[128];
        snprintf(folder, sizeof folder, "gather/%s", slots[i]);
        const char *file;
        for (size_t k = 0; (file = orl_shader_file(folder, k)); k++) {
            const char *name = file + strlen(folder) + 1;
            snprintf(assignment, sizeof assignment, "%s=%.*s", slots[i], (int)strcspn(name, "."),
                     name);
            struct orl_render_params params = orl_method_find(NULL, "airieau")->params;
            if (strstr(assignment, "princ") || strstr(assignment, "selected"))
                params = orl_method_find(NULL, "princ")->params; // weights that a selection gives
            const char *const assignments[] = {assignment};
            assert_int_equal(orl_render_params_assign(NULL, &params, assignments, 1), ORL_OK);
            struct orl_frame frame = draw(gpu, &f, view, &params, 0);
            const float *middle = color_at(&frame, SIDE / 2, SIDE / 2);
            assert_float_equal(middle[1], 1, 0.02);
            assert_float_equal(middle[0] + middle[2], 0, 0.02);
            orl_frame_finish(&frame);
        }
    }
    teardown(&f);
}

int main(void)
{
    gpu = gpu_test_device();
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(the_best_four_fade_by_the_fifth),
        cmocka_unit_test(farther_photographs_count_less),
        cmocka_unit_test(few_photographs_paint_too),
        cmocka_unit_test(photographs_that_tie_paint),
        cmocka_unit_test(guesses_take_nothing_of_what_hides_them),
        cmocka_unit_test(turns_change_nothing),
        cmocka_unit_test(both_sides_have_one_penalty),
        cmocka_unit_test(weights_are_those_of_their_formulas),
        cmocka_unit_test(at_its_own_place_a_photograph_shows),
        cmocka_unit_test(without_depth_a_photograph_is_rejected),
        cmocka_unit_test(every_method_gives_radiance),
        cmocka_unit_test(every_slot_paints),
    };
    int failed = cmocka_run_group_tests_name("methods", tests, NULL, NULL);
    orl_gpu_destroy(&gpu);
    return failed;
}
