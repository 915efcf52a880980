// Visibility, weights, fill and budget on a wall seen by a few one-coloured photographs.
#include <math.h>
#include <string.h>

#include "core/color.h"
#include "render/output/reexpose.h"
#include "wall_scene.h"

static struct orl_gpu *gpu;

enum { SIDE = 48 };

static struct orl_render_params airieau(void)
{
    return orl_method_find(NULL, "airieau")->params;
}

// The weights of Airieau 2012, 5.3, for the wall point that pixel (x, y) sees.
static double weight(const struct orl_view *view, const struct orl_view *photo, int x, int y,
                     double floor_fraction)
{
    double a[3], b[3], p[3], da = 0, db = 0, dot = 0;
    orl_pose_centre(&view->cam_from_world, a);
    orl_pose_centre(&photo->cam_from_world, b);
    double z = 4 - a[2];
    p[0] = (x + 0.5 - view->camera.cx) / view->camera.fx * z + a[0];
    p[1] = (y + 0.5 - view->camera.cy) / view->camera.fy * z + a[1];
    p[2] = 4;
    for (int i = 0; i < 3; i++) {
        da += (a[i] - p[i]) * (a[i] - p[i]);
        db += (b[i] - p[i]) * (b[i] - p[i]);
        dot += (a[i] - p[i]) * (b[i] - p[i]);
    }
    da = sqrt(da), db = sqrt(db);
    return dot / (da * db) / (fabs(da - db) / da + floor_fraction);
}

static void weights_are_cosine_over_distance_difference(void **state)
{
    (void)state;
    struct fixture f;
    setup(&f, false);
    struct orl_view view = look_from(0, 0, 0, SIDE, 40);
    add_photo(&f, look_from(-0.5, 0.2, 0, SIDE, 40), red);
    add_photo(&f, look_from(0.8, 0, 1.5, 64, 30), green); // other size and focal length
    struct orl_render_params params = airieau();
    struct orl_frame frame = draw(gpu, &f, view, &params, 0);
    const int pixels[][2] = {{24, 24}, {15, 30}, {30, 18}};
    for (size_t i = 0; i < ORL_COUNT(pixels); i++) {
        int x = pixels[i][0], y = pixels[i][1];
        double wr = weight(&view, &f.photos[0].view, x, y, 1e-6);
        double wg = weight(&view, &f.photos[1].view, x, y, 1e-6);
        const float *c = color_at(&frame, x, y);
        assert_float_equal(c[0], wr / (wr + wg), 2e-3);
        assert_float_equal(c[1], wg / (wr + wg), 2e-3);
        assert_float_equal(c[0] + c[1] + c[2], 1, 1e-5); // weights sum to 1
    }
    orl_frame_finish(&frame);
    teardown(&f);
}

// The wall point behind the plate as photograph 1 sees it must not take its colour.
static void occluded_photographs_are_rejected(void **state)
{
    (void)state;
    struct fixture f;
    setup(&f, true);
    struct orl_view view = look_from(0, 0, 0, SIDE, 40);
    add_photo(&f, look_from(-0.4, 0, 0, SIDE, 40), red);
    add_photo(&f, look_from(1.2, 0, 0, SIDE, 40), green);
    struct orl_render_params params = airieau();
    // Both photographs have a part in what both see.
    assert_int_equal(orl_render_params_set(NULL, &params, "weight=equal"), ORL_OK);
    struct orl_frame frame = draw(gpu, &f, view, &params, 0);
    // From x = 1.2 the plate (0.7, z 2) hides the wall around x = 0.2: pixel 24 + 10 * 0.2.
    const float *hidden = color_at(&frame, 26, 24), *open = color_at(&frame, 18, 24);
    assert_float_equal(frame.depth.f32[24 * SIDE + 26], 4, 0.02);
    assert_float_equal(hidden[1], 0, 1e-6);
    assert_float_equal(hidden[0], 1, 1e-5);
    assert_true(open[0] > 0.2 && open[1] > 0.2);
    assert_int_equal(orl_render_params_set(NULL, &params, "visibility=none"), ORL_OK);
    struct orl_frame all = draw(gpu, &f, view, &params, 0);
    assert_true(color_at(&all, 26, 24)[1] > 0.2);
    orl_frame_finish(&frame);
    orl_frame_finish(&all);
    teardown(&f);
}

// A view of half the photograph's resolution, whose pixels lie across those of the mip level: a white
// column of the photograph fills half of one pixel, and the pixels beside it stay black. The four samples of sRGB stand
// half a pixel of the photograph beside the column's centre, and a little to each side.
static void small_views_show_the_mean_of_an_area(void **state)
{
    (void)state;
    enum { FINE = 64, COLUMN = 33, PIXEL = 17, ROW = 16 };
    struct fixture f;
    struct orl_image image;
    setup(&f, false);
    add_photo(&f, look_from(0, 0, 0, FINE, 80), red);
    assert_int_equal(orl_image_init(NULL, &image, FINE, FINE, 3, ORL_PIXEL_U8), ORL_OK);
    for (int i = 0; i < FINE * FINE; i++)
        memset(image.u8 + 3 * i, i % FINE == COLUMN ? 255 : 0, 3);
    repaint_photo(&f, &image);
    struct orl_view view = look_from(0, 0, 0, FINE / 2, 40);
    view.camera.cx += 0.5;
    struct orl_render_params params = airieau();
    params.sampling = ORL_SAMPLING_BICUBIC;
    struct orl_frame frame = draw(gpu, &f, view, &params, 0);
    const double apart = sqrt((2 * 2 - 1) / 12.0 - 1 / 6.0), near = 0.5 + apart, far = 0.5 - apart;
    const float light = orl_srgb_decode((float)sqrt((near * near + far * far) / 2));
    for (int x = PIXEL - 2; x <= PIXEL + 2; x++)
        assert_float_equal(frame.color.f32[3 * (ROW * FINE / 2 + x)], x == PIXEL ? light : 0, 0.01);
    orl_frame_finish(&frame);
    teardown(&f);
}

static void check_colors(const struct orl_image *image, const uint8_t color[3])
{
    for (int i = 0; i < SIDE * SIDE; i++)
        for (int c = 0; c < 3; c++)
            assert_float_equal(image->f32[3 * i + c], orl_srgb_decode(color[c] / 255.0f), 5e-3);
}

// Gains and vignetting are undone by the shader, and that again for a photograph's own look.
static void photographs_are_aligned(void **state)
{
    (void)state;
    static const uint8_t color[3] = {60, 120, 230}, white[3] = {255, 255, 255};
    struct fixture f;
    setup(&f, false);
    struct orl_view view = look_from(0, 0, 0, SIDE, 40);
    add_photo(&f, view, color);
    memcpy(f.photos[0].gain, (float[3]){0.5f, 1.2f, 1.6f}, sizeof f.photos[0].gain);
    memcpy(f.photos[0].vignette, (float[3]){-0.3f, 0.1f, 0}, sizeof f.photos[0].vignette);
    struct orl_render_params params = airieau();
    params.alignment = ORL_ALIGNMENT_ON;
    struct orl_frame frame = draw(gpu, &f, view, &params, 0);
    double r2 = 0.5 * 0.5 * 2 / (0.5 * SIDE * SIDE), light = 1 - 0.3 * r2 + 0.1 * r2 * r2;
    for (int c = 0; c < 3; c++) {
        double x = (double)orl_srgb_decode(color[c] / 255.0f);
        double gain = (double)f.photos[0].gain[c] / light;
        double third = gain > 1.5 ? 0.5 : gain - 1, first = gain - 1 - third;
        assert_float_equal(color_at(&frame, SIDE / 2, SIDE / 2)[c],
                           gain * x / (1 + first * x + third * x * x * x), 2e-3);
    }
    // In the corner 0.8 of the light, and so more gain.
    assert_true(color_at(&frame, 0, 0)[0] > 1.15f * color_at(&frame, SIDE / 2, SIDE / 2)[0]);
    orl_photo_unalign(&f.photos[0], &frame.color);
    check_colors(&frame.color, color);
    orl_frame_finish(&frame);
    params.alignment = ORL_ALIGNMENT_OFF;
    frame = draw(gpu, &f, view, &params, 0);
    check_colors(&frame.color, color);
    orl_frame_finish(&frame);
    teardown(&f);
    // White stays white, whatever the gain.
    setup(&f, false);
    add_photo(&f, view, white);
    memcpy(f.photos[0].gain, (float[3]){0.5f, 1.2f, 1.6f}, sizeof f.photos[0].gain);
    params.alignment = ORL_ALIGNMENT_ON;
    frame = draw(gpu, &f, view, &params, 0);
    check_colors(&frame.color, white);
    orl_frame_finish(&frame);
    teardown(&f);
}

static void held_out_photographs_are_never_used(void **state)
{
    (void)state;
    struct fixture f;
    setup(&f, false);
    struct orl_view view = look_from(0, 0, 0, SIDE, 40);
    add_photo(&f, view, green);
    add_photo(&f, look_from(0.5, 0, 0, SIDE, 40), red);
    f.photos[0].test = true;
    struct orl_render_params params = airieau();
    struct orl_frame frame = draw(gpu, &f, view, &params, 0);
    for (int i = 0; i < SIDE * SIDE; i++)
        assert_float_equal(frame.color.f32[3 * i + 1], 0, 0);
    assert_float_equal(color_at(&frame, 24, 24)[0], 1, 1e-5);
    orl_frame_finish(&frame);
    teardown(&f);
}

static void holes_are_filled_but_not_covered(void **state)
{
    (void)state;
    struct fixture f;
    setup(&f, false);
    struct orl_view view = look_from(0, 0, 0, SIDE, 12); // sees far past the wall's edge
    add_photo(&f, look_from(0.1, 0, 0, 64, 16), green);
    struct orl_render_params params = airieau();
    struct orl_frame filled = draw(gpu, &f, view, &params, 0);
    params.fill = ORL_FILL_NONE;
    struct orl_frame open = draw(gpu, &f, view, &params, 0);
    assert_float_equal(open.coverage.f32[24 * SIDE + 24], 1, 0);
    assert_float_equal(open.coverage.f32[0], 0, 0);
    assert_float_equal(open.depth.f32[0], 0, 0);
    assert_float_equal(filled.coverage.f32[0], 0, 0);
    assert_float_equal(filled.depth.f32[0], 0, 0);
    assert_float_equal(color_at(&open, 0, 0)[1], 0, 0);
    assert_float_equal(color_at(&filled, 0, 0)[1], 1, 1e-4);
    orl_frame_finish(&filled);
    orl_frame_finish(&open);
    teardown(&f);
}

static void points_show_their_own_color(void **state)
{
    (void)state;
    struct fixture f;
    setup(&f, true);
    struct orl_view view = look_from(0, 0, 0, SIDE, 40);
    add_photo(&f, view, green);
    struct orl_frame frame = draw(gpu, &f, view, &orl_method_find(NULL, "points")->params, 0);
    const float *wall = color_at(&frame, 10, 24), *plate = color_at(&frame, 38, 24);
    assert_float_equal(wall[0], 1, 1e-4);
    assert_float_equal(plate[2], 1, 1e-4);
    assert_float_equal(plate[0] + plate[1], 0, 1e-4);
    orl_frame_finish(&frame);
    teardown(&f);
}

static void the_same_input_gives_the_same_bits(void **state)
{
    (void)state;
    struct fixture f;
    setup(&f, true);
    struct orl_view view = look_from(0.3, -0.2, 0.5, SIDE, 30);
    add_photo(&f, look_from(-0.4, 0, 0, SIDE, 40), red);
    add_photo(&f, look_from(1.2, 0, 0, SIDE, 40), green);
    struct orl_render_params params = airieau();
    struct orl_frame a = draw(gpu, &f, view, &params, 0), b = draw(gpu, &f, view, &params, 0);
    assert_memory_equal(a.color.data, b.color.data, orl_image_bytes(&a.color));
    assert_memory_equal(a.depth.data, b.depth.data, orl_image_bytes(&a.depth));
    orl_frame_finish(&a);
    orl_frame_finish(&b);
    teardown(&f);
}

// A budget for no photograph at all still renders, with smaller photographs one by one. They are
// compressed to luma and chroma of 8 bits, of which saturated colours come back within a hundredth.
static void a_small_budget_plans_instead_of_failing(void **state)
{
    (void)state;
    struct fixture f;
    setup(&f, false);
    struct orl_view view = look_from(0, 0, 0, SIDE, 40);
    add_photo(&f, look_from(-0.5, 0, 0, SIDE, 40), red);
    add_photo(&f, look_from(0.5, 0, 0, SIDE, 40), green);
    struct orl_render_params params = airieau();
    struct orl_frame whole = draw(gpu, &f, view, &params, 0);
    struct orl_frame tight = draw(gpu, &f, view, &params, 1);
    for (int i = 0; i < 3; i++)
        assert_float_equal(color_at(&whole, 24, 24)[i], color_at(&tight, 24, 24)[i], 5e-3);
    assert_true(tight.coverage.f32[24 * SIDE + 24] > 0);
    orl_frame_finish(&whole);
    orl_frame_finish(&tight);
    teardown(&f);
}

static void unknown_names_and_values_are_refused(void **state)
{
    (void)state;
    struct orl_render_params params = airieau();
    assert_null(orl_method_find(NULL, "nonsense"));
    assert_int_equal(orl_render_params_set(NULL, &params, "nonsense=1"), ORL_ERR_ARGUMENT);
    assert_int_equal(orl_render_params_set(NULL, &params, "fill"), ORL_ERR_ARGUMENT);
    assert_int_equal(orl_render_params_set(NULL, &params, "fill=foo"), ORL_ERR_ARGUMENT);
    assert_int_equal(orl_render_params_set(NULL, &params, "splat_scale=0"), ORL_ERR_ARGUMENT);
    assert_int_equal(orl_render_params_set(NULL, &params, "splat_scale=nan"), ORL_ERR_ARGUMENT);
    assert_int_equal(orl_render_params_set(NULL, &params, "splat_scale=1x"), ORL_ERR_ARGUMENT);
    assert_int_equal(orl_render_params_set(NULL, &params, "splat_scale=2"), ORL_OK);
    assert_float_equal(params.splat_scale, 2, 0);
    assert_int_equal(orl_render_params_set(NULL, &params, "visibility=none"), ORL_OK);
    assert_string_equal(params.visibility, "none");
}

static void layers_can_be_left_out(void **state)
{
    (void)state;
    struct fixture f;
    setup(&f, false);
    add_photo(&f, look_from(0, 0, 0, SIDE, 40), red);
    struct orl_render_params params = airieau();
    struct orl_frame all = draw(gpu, &f, look_from(0, 0, 0, SIDE, 40), &params, 0);
    params.leave_out = ORL_LAYER_DEPTH | ORL_LAYER_NORMAL;
    struct orl_frame some = draw(gpu, &f, look_from(0, 0, 0, SIDE, 40), &params, 0);
    params.leave_out = ORL_LAYER_COVERAGE;
    struct orl_frame others = draw(gpu, &f, look_from(0, 0, 0, SIDE, 40), &params, 0);
    assert_null(some.depth.data);
    assert_null(some.normal.data);
    assert_null(others.coverage.data);
    assert_memory_equal(some.color.f32, all.color.f32, orl_image_bytes(&all.color));
    assert_memory_equal(some.coverage.f32, all.coverage.f32, orl_image_bytes(&all.coverage));
    assert_memory_equal(others.color.f32, all.color.f32, orl_image_bytes(&all.color));
    assert_memory_equal(others.depth.f32, all.depth.f32, orl_image_bytes(&all.depth));
    assert_memory_equal(others.normal.f32, all.normal.f32, orl_image_bytes(&all.normal));
    orl_frame_finish(&all);
    orl_frame_finish(&some);
    orl_frame_finish(&others);
    teardown(&f);
}

static void absurd_cameras_and_wrong_photographs_are_refused(void **state)
{
    (void)state;
    struct fixture f;
    setup(&f, false);
    add_photo(&f, look_from(0, 0, 0, SIDE, 40), red);
    struct orl_renderer *renderer;
    struct orl_frame frame;
    struct orl_render_params params = airieau();
    assert_int_equal(orl_renderer_create(gpu, &f.scene, NULL, &renderer), ORL_OK);
    struct orl_view view = look_from(0, 0, 0, SIDE, NAN);
    assert_int_equal(orl_renderer_draw(renderer, &view, &params, NULL, &frame),
                     ORL_ERR_ARGUMENT);
    view = look_from(0, 0, 0, SIDE, 40);
    f.photos[0].view.camera.width = SIDE + 1; // not what the file holds
    assert_int_equal(orl_renderer_draw(renderer, &view, &params, NULL, &frame), ORL_ERR_FORMAT);
    assert_null(frame.color.data);
    orl_renderer_destroy(&renderer);
    teardown(&f);
}

static bool is_cancelled(void *priv)
{
    return (*(int *)priv)-- <= 0;
}

// A frame of many photographs ends between two of them, and can be drawn again.
static void a_frame_can_be_cancelled(void **state)
{
    (void)state;
    struct fixture f;
    struct orl_renderer *renderer;
    struct orl_frame frame;
    struct orl_view view = look_from(0, 0, 0, SIDE, 40);
    int left = 2;
    struct orl_progress progress = {.cancelled = is_cancelled, .priv = &left};
    setup(&f, false);
    for (int i = 0; i < 4; i++)
        add_photo(&f, look_from(0.1 * i, 0, 0, SIDE, 40), green);
    assert_int_equal(orl_renderer_create(gpu, &f.scene,
                                         &(struct orl_renderer_params){.progress = &progress},
                                         &renderer), ORL_OK);
    const struct orl_render_params *params = &orl_method_find(NULL, "airieau")->params;
    assert_int_equal(orl_renderer_draw(renderer, &view, params, NULL, &frame),
                     ORL_ERR_CANCELLED);
    assert_null(frame.color.data);
    assert_int_equal(left, -1); // two were loaded, the third was asked for
    left = 100;
    assert_int_equal(orl_renderer_draw(renderer, &view, params, NULL, &frame), ORL_OK);
    assert_float_equal(color_at(&frame, SIDE / 2, SIDE / 2)[1], 1, 0.02);
    orl_frame_finish(&frame);
    orl_renderer_destroy(&renderer);
    teardown(&f);
}

int main(void)
{
    gpu = gpu_test_device();
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(weights_are_cosine_over_distance_difference),
        cmocka_unit_test(occluded_photographs_are_rejected),
        cmocka_unit_test(small_views_show_the_mean_of_an_area),
        cmocka_unit_test(photographs_are_aligned),
        cmocka_unit_test(held_out_photographs_are_never_used),
        cmocka_unit_test(holes_are_filled_but_not_covered),
        cmocka_unit_test(points_show_their_own_color),
        cmocka_unit_test(the_same_input_gives_the_same_bits),
        cmocka_unit_test(a_small_budget_plans_instead_of_failing),
        cmocka_unit_test(unknown_names_and_values_are_refused),
        cmocka_unit_test(layers_can_be_left_out),
        cmocka_unit_test(absurd_cameras_and_wrong_photographs_are_refused),
        cmocka_unit_test(a_frame_can_be_cancelled),
    };
    int failed = cmocka_run_group_tests_name("gather", tests, NULL, NULL);
    orl_gpu_destroy(&gpu);
    return failed;
}
