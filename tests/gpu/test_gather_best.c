// Choice and weights of blend=best on a wall seen by one-coloured photographs.
#include <math.h>
#include <string.h>

#include "core/color.h"
#include "wall_scene.h"

static struct orl_gpu *gpu;

static struct orl_view look(double x, double y, double z)
{
    return look_from(x, y, z, 48, 40);
}

static struct orl_render_params best(void)
{
    struct orl_render_params params = orl_method_find(NULL, "oriel")->params;
    params.outliers = 0; // these photographs disagree on purpose
    params.antialias = ORL_ANTIALIAS_OFF; // and what the best one alone does not show is a speck
    return params;
}

// Penalty of shaders/gather/penalty.glsl on known surfaces, for the wall point at pixel (x, y), cameras side by
// side.
static double penalty(double eye, double photo, int x, int y)
{
    double px = (x + 0.5 - 24) / 40 * 4 + eye, py = (y + 0.5 - 24) / 40 * 4;
    double a[3] = {eye - px, -py, -4}, b[3] = {photo - px, -py, -4}, aa = 0, bb = 0, ab = 0;
    for (int k = 0; k < 3; k++) {
        aa += a[k] * a[k];
        bb += b[k] * b[k];
        ab += a[k] * b[k];
    }
    double coarser = sqrt(bb / aa) - 1;
    return hypot(acos(ab / sqrt(aa * bb)) + 0.1 * fmax(coarser, 0) + 0.005, 0.3);
}

static void weights_fade_to_zero_at_the_first_left_out(void **state)
{
    (void)state;
    struct fixture f;
    setup(&f, true);
    const double x[3] = {-0.2, 0.5, -1.0};
    add_photo(&f, look(x[0], 0, 0), red);
    add_photo(&f, look(x[1], 0, 0), green);
    add_photo(&f, look(x[2], 0, 0), blue);
    struct orl_render_params params = best();
    params.photos_per_pixel = 2;
    struct orl_frame frame = draw(gpu, &f, look(0, 0, 0), &params, 0);
    double p[3], w[2];
    for (int i = 0; i < 3; i++)
        p[i] = penalty(0, x[i], 18, 26);
    for (int i = 0; i < 2; i++)
        w[i] = pow(p[0] / p[i], (double)params.sharpness) * fmin(1, 4 * (1 - p[i] / p[2]));
    const float *c = color_at(&frame, 18, 26);
    assert_float_equal(c[0], w[0] / (w[0] + w[1]), 4e-3);
    assert_float_equal(c[1], w[1] / (w[0] + w[1]), 4e-3);
    assert_float_equal(c[2], 0, 1e-6);
    orl_frame_finish(&frame);
    teardown(&f);
}

static void hidden_photographs_do_not_paint(void **state)
{
    (void)state;
    struct fixture f;
    setup(&f, true);
    add_photo(&f, look(-0.4, 0, 0), red);
    add_photo(&f, look(1.2, 0, 0), green);
    struct orl_render_params params = best();
    struct orl_frame frame = draw(gpu, &f, look(0, 0, 0), &params, 0);
    // From x = 1.2 the plate (0.7, z 2) hides the wall around x = 0.2: pixel 24 + 10 * 0.2.
    const float *hidden = color_at(&frame, 26, 24), *open = color_at(&frame, 18, 24);
    assert_float_equal(hidden[1], 0, 1e-4);
    assert_float_equal(hidden[0], 1, 1e-4);
    assert_true(open[1] > 0.01);
    orl_frame_finish(&frame);
    teardown(&f);
}

// With as many photographs as may be blended, a hair's move must not swap one for another
// by a jump. airieau would pass too; a hard choice of the best few would not.
static void a_small_move_changes_little(void **state)
{
    (void)state;
    struct fixture f;
    setup(&f, true);
    for (int i = 0; i < 7; i++)
        add_photo(&f, look(-1.5 + 0.5 * i, 0.1 * (i % 3), 0),
                  (uint8_t[3]){(uint8_t)(i * 40), (uint8_t)(255 - i * 35),
                               (uint8_t)(i % 2 * 255)});
    struct orl_render_params params = best();
    float largest = 0, spread = 0;
    struct orl_frame last = draw(gpu, &f, look(-0.3, 0, 0), &params, 0);
    for (int i = 1; i <= 6; i++) {
        struct orl_frame frame = draw(gpu, &f, look(-0.3 + i * 0.01, 0, 0), &params, 0);
        for (int k = 0; k < 3; k++) { // in the open part of the wall
            float now = color_at(&frame, 12, 24)[k], before = color_at(&last, 12, 24)[k];
            largest = fmaxf(largest, fabsf(now - before));
        }
        orl_frame_finish(&last);
        last = frame;
    }
    struct orl_frame first = draw(gpu, &f, look(-1.2, 0, 0), &params, 0);
    for (int k = 0; k < 3; k++)
        spread = fmaxf(spread, fabsf(color_at(&first, 12, 24)[k] - color_at(&last, 12, 24)[k]));
    orl_frame_finish(&first);
    orl_frame_finish(&last);
    assert_true(spread > 0.1); // the photographs do differ
    assert_true(largest < 0.06);
    teardown(&f);
}

// A plate of 3 x 3 pixels beside the middle of a tile of 16. The red photograph stands behind the plate,
// and the green one shows little more than it, and nothing of the tile's middle.
static void what_is_small_in_a_tile_is_painted(void **state)
{
    (void)state;
    enum { WALL = 120, PLATE = 12, AT = 18 };
    struct fixture f;
    setup_empty(&f, 4);
    assert_int_equal(orl_points_init(NULL, &f.scene.points, WALL * WALL + PLATE * PLATE), ORL_OK);
    double x = (AT + 0.5 - 24) / 40 * 2;
    set_square(&f.scene.points, 0, WALL, 6, 0, 4, red);
    set_square(&f.scene.points, WALL * WALL, PLATE, 0.15, x, 2, blue);
    add_photo(&f, look_from(0, 0, 2.5, 48, 20), red);
    struct orl_view crop = look_from(0, 0, 0, 10, 40);
    crop.camera.cx -= 40 * x / 2;
    add_photo(&f, crop, green);
    struct orl_render_params params = best();
    params.front_layer = 0; // with which such plates are covered
    struct orl_frame frame = draw(gpu, &f, look(0, 0, 0), &params, 0);
    assert_float_equal(frame.depth.f32[24 * 48 + AT], 2, 0.01);
    assert_float_equal(color_at(&frame, AT, 24)[1], 1, 1e-3);
    assert_float_equal(frame.coverage.f32[24 * 48 + AT], 1, 0);
    assert_float_equal(color_at(&frame, 30, 24)[0], 1, 1e-3);
    orl_frame_finish(&frame);
    teardown(&f);
}

// A plate hides all of a tile's wall from the green photographs, which are nearer to the view. A pixel that blends one
// photograph asks the two best of a list: the red one, which sees the wall, must be among them.
static void a_tile_lists_a_photograph_that_sees_it(void **state)
{
    (void)state;
    enum { WALL = 120, PLATE = 40, TILE = 16 };
    struct fixture f;
    setup_empty(&f, 4);
    assert_int_equal(orl_points_init(NULL, &f.scene.points, WALL * WALL + PLATE * PLATE), ORL_OK);
    set_square(&f.scene.points, 0, WALL, 6, 0, 4, red);
    // The tile shows the wall from -0.8 to 0.8, and the view shows the plate right of it.
    set_square(&f.scene.points, WALL * WALL, PLATE, 1, 1, 2, blue);
    add_photo(&f, look_from(2, 0, 0, 96, 40), green);
    add_photo(&f, look_from(2, 0.1, 0, 96, 40), green);
    add_photo(&f, look_from(-2.6, 0, 0, 96, 40), red);
    struct orl_render_params params = best();
    params.photos_per_pixel = 1;
    params.fill = ORL_FILL_NONE;
    struct orl_frame frame = draw(gpu, &f, look(0, 0, 0), &params, 0);
    for (int i = TILE; i < 2 * TILE; i++) {
        assert_float_equal(color_at(&frame, i, i)[0], 1, 1e-3);
        assert_float_equal(frame.coverage.f32[i * 48 + i], 1, 0);
    }
    orl_frame_finish(&frame);
    teardown(&f);
}

// The same beside a wall, where the depth is a guess: the nearer photographs are listed although the plate hides the point.
// So the red photograph from far aside does not paint the point, which takes the colours around it: of the plate, and of
// the wall, which a blue photograph shows.
static void what_hides_a_guess_is_no_reason_to_ask_others(void **state)
{
    (void)state;
    enum { WALL = 80, PLATE = 40, TILE = 16 };
    struct fixture f;
    setup_empty(&f, 4);
    assert_int_equal(orl_points_init(NULL, &f.scene.points, WALL * WALL + PLATE * PLATE), ORL_OK);
    set_square(&f.scene.points, 0, WALL, 1.8, -2.1, 4, red);
    set_square(&f.scene.points, WALL * WALL, PLATE, 1, 1, 2, blue);
    struct orl_view wall = look_from(-0.2, 0, 0, 96, 40);
    wall.camera.cx = 103; // the tile begins at -0.8, 97 pixels from the left
    add_photo(&f, wall, blue);
    add_photo(&f, look_from(2, 0, 0, 96, 40), green);
    add_photo(&f, look_from(2, 0.1, 0, 96, 40), green);
    add_photo(&f, look_from(-2.6, 0, 0, 96, 40), red);
    struct orl_render_params params = best();
    params.photos_per_pixel = 1;
    params.guess_depths = 0;
    struct orl_frame frame = draw(gpu, &f, look(0, 0, 0), &params, 0);
    assert_float_equal(color_at(&frame, 24, 24)[0], 0, 0.01);
    orl_frame_finish(&frame);
    teardown(&f);
}

// The best photograph begins in the middle of four pixels that are made at once. The second one paints those that it
// does not show.
static void each_pixel_gets_its_photographs(void **state)
{
    (void)state;
    enum { FIRST = 17 }; // column that the best photograph shows
    struct fixture f;
    setup(&f, false);
    struct orl_view crop = look(0, 0, 0);
    crop.camera.cx -= FIRST;
    add_photo(&f, crop, red);
    add_photo(&f, look(0.4, 0, 0), green);
    struct orl_render_params params = best();
    params.photos_per_pixel = 1;
    params.fill = ORL_FILL_NONE;
    struct orl_frame frame = draw(gpu, &f, look(0, 0, 0), &params, 0);
    for (int y = 18; y < 30; y++) {
        assert_float_equal(color_at(&frame, FIRST - 1, y)[1], 1, 1e-3);
        assert_float_equal(color_at(&frame, FIRST + 2, y)[0], 1, 1e-3); // it fades in over two pixels
    }
    orl_frame_finish(&frame);
    teardown(&f);
}

// The last photograph becomes black but for a line, one pixel wide: a column, or with `across` a row.
static void paint_line(struct fixture *f, bool across, int at, const uint8_t color[3])
{
    const struct orl_camera *camera = &f->photos[f->scene.photo_count - 1].view.camera;
    struct orl_image image;
    assert_int_equal(orl_image_init(NULL, &image, camera->width, camera->height, 3, ORL_PIXEL_U8), ORL_OK);
    memset(image.u8, 0, (size_t)(3 * camera->width * camera->height));
    for (int i = 0; i < camera->width * camera->height; i++)
        if ((across ? i / camera->width : i % camera->width) == at)
            memcpy(&image.u8[3 * i], color, 3);
    repaint_photo(f, &image);
}

static double light(double srgb)
{
    return (double)orl_srgb_decode((float)srgb);
}

// The view's pixel lies a tenth of a pixel beside a line in each of three photographs. The Catmull-Rom filter, with
// which the best one is read, gives the line more weight there than the bilinear one. The others show as much more.
static void check_detail(bool across)
{
    enum { AT = 18, OTHER = 26 };
    static const uint8_t white[3] = {255, 255, 255};
    const uint8_t *const colors[3] = {white, green, blue};
    struct fixture f;
    setup(&f, false);
    double x[3], w[3], sum = 0;
    struct orl_render_params params = best();
    for (int i = 0; i < 3; i++) {
        x[i] = -0.01 - 0.1 * i; // 0.1 on the wall is a pixel
        add_photo(&f, look(across ? 0 : x[i], across ? x[i] : 0, 0), colors[i]);
        paint_line(&f, across, AT + i, colors[i]);
        w[i] = pow(penalty(0, x[0], AT, OTHER) / penalty(0, x[i], AT, OTHER), (double)params.sharpness);
        sum += w[i];
    }
    const double sharp = light(1 + 0.1 * 0.1 * (-2.5 + 1.5 * 0.1)), shares[3] = {w[0], w[0] + w[1], w[0] + w[2]};
    struct orl_frame frame = draw(gpu, &f, look(0, 0, 0), &params, 0);
    for (int c = 0; c < 3; c++)
        assert_float_equal(color_at(&frame, across ? OTHER : AT, across ? AT : OTHER)[c], sharp * shares[c] / sum, 4e-3);
    orl_frame_finish(&frame);
    teardown(&f);
}

static void the_best_lends_its_detail(void **state)
{
    (void)state;
    check_detail(false);
    check_detail(true);
}

// The last photograph becomes black left of a column and has this colour from there on.
static void paint_edge(struct fixture *f, int from, const uint8_t color[3])
{
    const struct orl_camera *camera = &f->photos[f->scene.photo_count - 1].view.camera;
    struct orl_image image;
    assert_int_equal(orl_image_init(NULL, &image, camera->width, camera->height, 3, ORL_PIXEL_U8), ORL_OK);
    for (int i = 0; i < camera->width * camera->height; i++)
        for (int c = 0; c < 3; c++)
            image.u8[3 * i + c] = i % camera->width < from ? 0 : color[c];
    repaint_photo(f, &image);
}

// A tenth of a pixel from the black side of an edge, the Catmull-Rom filter shows half of what the bilinear one does, and
// the other photographs lose as much. A best photograph that is far from the consensus lends next to nothing.
static void what_an_edge_loses_is_lent(void **state)
{
    (void)state;
    enum { AT = 18 };
    static const uint8_t white[3] = {255, 255, 255};
    struct fixture f;
    setup(&f, false);
    struct orl_view view = look(-0.01, 0, 0), beside = look(-0.4, 0, 0);
    add_photo(&f, view, white);
    paint_edge(&f, AT + 1, white);
    add_photo(&f, beside, white);
    add_photo(&f, beside, white);
    struct orl_render_params params = best();
    struct orl_frame frame = draw(gpu, &f, look(0, 0, 0), &params, 0);
    params.outliers = 0.01f;
    struct orl_frame robust = draw(gpu, &f, look(0, 0, 0), &params, 0);
    const double sharp = light(0.1 * (0.5 + 0.1 * (2 - 1.5 * 0.1)) + 0.01 * (-0.5 + 0.5 * 0.1));
    const double other = 2 * pow(penalty(0, -0.01, AT, 26) / penalty(0, -0.4, AT, 26), (double)params.sharpness);
    assert_float_equal(color_at(&frame, AT, 26)[0], (sharp + sharp / light(0.1) * other) / (1 + other), 4e-3);
    const double votes = 2 * sqrt(other / 2), mean = (sqrt(sharp) + votes) / (1 + votes);
    const double first = 1 / (1 + 1e4 * pow(sqrt(sharp) - mean, 2)), rest = other / (1 + 1e4 * pow(1 - mean, 2));
    assert_float_equal(color_at(&robust, AT, 26)[0], (first * sharp + rest) / (first + rest), 4e-3);
    orl_frame_finish(&frame);
    orl_frame_finish(&robust);
    teardown(&f);
}

// A photograph that is `finer` times as fine as the view, with a line of one pixel. The centre of the
// view's pixel LINE_AT is at the line's.
enum { LINE_AT = 24, LINE = 110, FINE_SIDE = 192 };

static void add_fine_photo(struct fixture *f, double finer)
{
    struct orl_view view = look_from(0, 0, 0, FINE_SIDE, 40 * finer);
    view.camera.cx = LINE + 0.5 - finer * (LINE_AT + 0.5 - 24);
    add_photo(f, view, blue);
    paint_line(f, false, LINE, blue);
}

// sRGB at the line, in the level of pixels that are twice as large: the line is half of the light of such a pixel, whose
// centre is a quarter of it away. In the next level it is a quarter, and the centre an eighth away.
static double line_of_two(void)
{
    return 0.75 * (double)orl_srgb_encode(1 / 2.0f);
}

static double line_of_four(void)
{
    return 0.875 * (double)orl_srgb_encode(1 / 4.0f);
}

// In a view that is coarser than the photographs the second best is read from the level of which one sample is
// about as wide as a pixel of the view, and brought to the scene's exposure as the best is.
static void the_second_is_read_from_one_level(void **state)
{
    (void)state;
    struct fixture f;
    setup(&f, false);
    static const uint8_t black[3] = {0, 0, 0};
    add_photo(&f, look_from(0, 0, 0, FINE_SIDE, 180), black);
    add_fine_photo(&f, 4.5); // log2 is 2.17
    for (int c = 0; c < 3; c++)
        f.photos[1].gain[c] = 0.5f;
    struct orl_render_params params = best();
    params.alignment = ORL_ALIGNMENT_ON;
    struct orl_frame frame = draw(gpu, &f, look(0, 0, 0), &params, 0);
    double c = light(line_of_two()), aligned = 0.5 * c / (1 - 0.5 * c * c * c); // see srgb.glsl
    assert_float_equal(color_at(&frame, LINE_AT, 24)[2], aligned / 2, 2e-3);
    orl_frame_finish(&frame);
    teardown(&f);
}

// Where a pixel of the view is two of the best photograph wide, that one is the mean of an area, and lends nothing.
static void an_area_lends_nothing(void **state)
{
    (void)state;
    static const uint8_t white[3] = {255, 255, 255};
    struct fixture f;
    setup(&f, false);
    add_fine_photo(&f, 2);
    struct orl_view view = f.photos[0].view;
    add_photo(&f, view, white);
    struct orl_render_params params = best();
    struct orl_frame frame = draw(gpu, &f, look(0, 0, 0), &params, 0);
    const double mean = light(1 - sqrt((2 * 2 - 1) / 12.0 - 1 / 6.0));
    assert_float_equal(color_at(&frame, LINE_AT, 24)[2], (mean + 1) / 2, 4e-3);
    orl_frame_finish(&frame);
    teardown(&f);
}

// With the bilinear filter, levels are mixed where the right one is four fifths of the way to the next.
static void the_bilinear_filter_mixes_levels(void **state)
{
    (void)state;
    struct fixture f;
    setup(&f, false);
    add_fine_photo(&f, pow(2, 1.8));
    struct orl_render_params params = best();
    params.sampling = ORL_SAMPLING_BILINEAR;
    struct orl_frame frame = draw(gpu, &f, look(0, 0, 0), &params, 0);
    assert_float_equal(color_at(&frame, LINE_AT, 24)[2], light((line_of_two() + line_of_four()) / 2), 0.01);
    orl_frame_finish(&frame);
    teardown(&f);
}

// Two of three agree: the third, though no worse, loses weight.
static void outliers_lose(void **state)
{
    (void)state;
    struct fixture f;
    setup(&f, true);
    add_photo(&f, look(-0.2, 0, 0), red);
    add_photo(&f, look(0.2, 0, 0), green);
    add_photo(&f, look(-0.22, 0, 0), green);
    struct orl_render_params params = best();
    struct orl_frame all = draw(gpu, &f, look(0, 0, 0), &params, 0);
    params.outliers = 0.2f;
    struct orl_frame robust = draw(gpu, &f, look(0, 0, 0), &params, 0);
    assert_true(color_at(&robust, 16, 24)[0] < 0.7f * color_at(&all, 16, 24)[0]);
    assert_true(color_at(&robust, 16, 24)[1] > color_at(&all, 16, 24)[1]);
    orl_frame_finish(&all);
    orl_frame_finish(&robust);
    teardown(&f);
}

// More photographs than a frame may use, or than fit: the near ones are taken.
static void many_photographs_leave_the_best(void **state)
{
    (void)state;
    struct fixture f;
    setup(&f, true);
    for (int i = 0; i < PHOTOS_MAX; i++) {
        bool near = i == 70;
        add_photo(&f, look(near ? 0.05 : 1.6 + 0.01 * i, 0, 0), near ? red : blue);
    }
    struct orl_render_params params = best();
    params.photos_per_pixel = 1;
    for (int budget = 0; budget < 2; budget++) {
        struct orl_frame frame = draw(gpu, &f, look(0, 0, 0), &params, (size_t)budget);
        assert_true(color_at(&frame, 16, 24)[0] > 0.9f);
        orl_frame_finish(&frame);
    }
    teardown(&f);
}

// Beside the only photograph pixels are left, in many work groups of a row and none in others.
static void what_no_photograph_shows_is_filled(void **state)
{
    (void)state;
    struct fixture f;
    setup(&f, false);
    add_photo(&f, look(0, 0, 0), red);
    struct orl_view view = look(0, 0, 0);
    view.camera.width = 461;
    view.camera.cx = 240;
    view.camera.height = 67;
    view.camera.cy = 16;
    struct orl_render_params params = best();
    struct orl_frame frame = draw(gpu, &f, view, &params, 0);
    for (int i = 0; i < view.camera.width * view.camera.height; i++)
        assert_float_equal(frame.color.f32[3 * i], 1, 1e-3);
    orl_frame_finish(&frame);
    teardown(&f);
}

// 2x2 pixels are made at once: the last row and column of odd pictures too, and nothing beside.
static void odd_sizes_lose_no_pixel(void **state)
{
    (void)state;
    struct fixture f;
    setup(&f, true);
    for (int i = 0; i < 3; i++) // wider than the view
        add_photo(&f, look_from(0.1 * i, 0, 0, 64, 40), red);
    struct orl_view view = look(0.05, 0, 0);
    view.camera.width = 37;
    view.camera.height = 33;
    for (int kept = 2; kept <= 4; kept += 2) {
        struct orl_render_params params = best();
        params.photos_per_pixel = (float)kept;
        struct orl_frame frame = draw(gpu, &f, view, &params, 0);
        for (int i = 0; i < 37 * 33; i++) {
            assert_float_equal(frame.color.f32[3 * i], 1, 1e-3); // of half floats
            assert_float_equal(frame.color.f32[3 * i + 1], 0, 1e-3);
            assert_float_equal(frame.coverage.f32[i], 1, 0);
        }
        orl_frame_finish(&frame);
    }
    teardown(&f);
}

// What no photograph sees takes its neighbours' colour, and is no surface of theirs.
static void unseen_pixels_are_filled(void **state)
{
    (void)state;
    struct fixture f;
    setup(&f, false);
    add_photo(&f, look_from(-1.2, 0, 0, 48, 80), green); // sees x from -2.4 to 0
    struct orl_render_params params = best();
    struct orl_frame frame = draw(gpu, &f, look(0, 0, 0), &params, 0);
    for (int x = 2; x < 46; x++) {
        assert_float_equal(color_at(&frame, x, 24)[1], 1, 1e-3);
        assert_float_equal(color_at(&frame, x, 24)[0], 0, 1e-4);
        assert_float_equal(frame.coverage.f32[24 * 48 + x], x < 23 ? 1 : 0, x > 20 && x < 26);
    }
    params.fill = ORL_FILL_NONE;
    struct orl_frame open = draw(gpu, &f, look(0, 0, 0), &params, 0);
    assert_float_equal(color_at(&open, 40, 24)[1], 0, 0);
    assert_float_equal(color_at(&open, 12, 24)[1], 1, 1e-3);
    orl_frame_finish(&frame);
    orl_frame_finish(&open);
    teardown(&f);
}

// What is no wall is ground: another photograph sees it there than at the wall's depth.
static void guesses_end_at_the_ground(void **state)
{
    (void)state;
    struct fixture f;
    setup(&f, false);
    struct orl_view view = look_from(0, 0, 0, 48, 12);
    // Row 44 looks down at 1.71 of its depth: it meets y = 3 at depth 1.76, and y = 6.8 at the
    // wall's depth, 4.
    add_photo(&f, look_from(0, 2, -1, 48, 30), red);
    add_photo(&f, look_from(0, 4.6, 0, 48, 30), green);
    const struct orl_ground none = {.height = 0};
    const struct orl_ground floor = {.plane = {0, -1, 0, 3}, .height = 2};
    const struct orl_ground overhead = {.plane = {0, -1, 0, -1}, .height = 2};
    const struct orl_ground grazed = {.plane = {0, -1, 0, 3}, .height = 0.05};
    const struct { struct orl_ground ground; enum orl_fill fill; bool meets; } cases[] = {
        {none, ORL_FILL_GROUND, false},     {floor, ORL_FILL_DEPTH, false},
        {floor, ORL_FILL_GROUND, true},     {overhead, ORL_FILL_GROUND, false},
        {grazed, ORL_FILL_GROUND, false},
    };
    for (size_t i = 0; i < ORL_COUNT(cases); i++) {
        struct orl_render_params params = best();
        params.fill = cases[i].fill;
        f.scene.ground = cases[i].ground;
        struct orl_frame frame = draw(gpu, &f, view, &params, 0);
        assert_float_equal(color_at(&frame, 24, 44)[0], cases[i].meets, 1e-3);
        assert_float_equal(color_at(&frame, 24, 44)[1], !cases[i].meets, 1e-3);
        assert_float_equal(frame.coverage.f32[44 * 48 + 24], 0, 0);
        orl_frame_finish(&frame);
    }
    teardown(&f);
}

// Beside the wall depth is guessed. A photograph may paint it from 16 degrees aside, and from 88 where no other
// can. As radiance, too.
static void guesses_are_seen_from_the_side_if_by_nothing_else(void **state)
{
    (void)state;
    static const struct { double x; bool other; } cases[] = {{3, false}, {9, false}, {9, true}};
    static const uint8_t dim_red[3] = {128, 0, 0}, dim_green[3] = {0, 128, 0}, dim_blue[3] = {0, 0, 128}; // nothing clips
    const double light = (double)orl_srgb_decode(128 / 255.0f);
    for (size_t i = 0; i < 2 * ORL_COUNT(cases); i++) {
        const size_t k = i / 2;
        struct fixture f;
        setup(&f, false);
        add_photo(&f, look_from(0, 0, 0, 48, 20), dim_red); // the wall alone
        add_photo(&f, look_from(cases[k].x, 0, 0, 48, 20), dim_green);
        if (cases[k].other)
            add_photo(&f, look_from(3, 0, 0, 48, 20), dim_blue);
        struct orl_render_params params = best();
        struct orl_renderer_params kind = {.radiance = i % 2 == 1};
        struct orl_frame frame = draw_by(gpu, &f, look_from(0, 0, 0, 48, 12), &params, &kind);
        const float *c = color_at(&frame, 44, 24); // of (6.8, 0, 4)
        assert_float_equal(c[cases[k].other ? 2 : 1], light, cases[k].other ? 2e-3 : 1e-3);
        assert_float_equal(c[cases[k].other ? 1 : 0], 0, 2e-3);
        orl_frame_finish(&frame);
        teardown(&f);
    }
}

// Between two photographs that see it equally well, the better one would be none.
static void photographs_that_tie_paint(void **state)
{
    (void)state;
    struct fixture f;
    setup(&f, false);
    add_photo(&f, look(-0.5, 0, 0), green);
    add_photo(&f, look(-0.5, 0, 0), green);
    struct orl_render_params params = best();
    params.photos_per_pixel = 1;
    params.fill = ORL_FILL_NONE;
    struct orl_frame frame = draw(gpu, &f, look(0, 0, 0), &params, 0);
    assert_float_equal(color_at(&frame, 20, 24)[1], 1, 1e-3);
    assert_float_equal(frame.coverage.f32[24 * 48 + 20], 1, 0);
    orl_frame_finish(&frame);
    teardown(&f);
}

int main(void)
{
    gpu = gpu_test_device();
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(weights_fade_to_zero_at_the_first_left_out),
        cmocka_unit_test(hidden_photographs_do_not_paint),
        cmocka_unit_test(a_small_move_changes_little),
        cmocka_unit_test(what_is_small_in_a_tile_is_painted),
        cmocka_unit_test(a_tile_lists_a_photograph_that_sees_it),
        cmocka_unit_test(what_hides_a_guess_is_no_reason_to_ask_others),
        cmocka_unit_test(each_pixel_gets_its_photographs),
        cmocka_unit_test(the_best_lends_its_detail),
        cmocka_unit_test(what_an_edge_loses_is_lent), cmocka_unit_test(an_area_lends_nothing),
        cmocka_unit_test(the_second_is_read_from_one_level),
        cmocka_unit_test(the_bilinear_filter_mixes_levels),
        cmocka_unit_test(outliers_lose),
        cmocka_unit_test(many_photographs_leave_the_best),
        cmocka_unit_test(what_no_photograph_shows_is_filled),
        cmocka_unit_test(odd_sizes_lose_no_pixel),
        cmocka_unit_test(unseen_pixels_are_filled),
        cmocka_unit_test(guesses_end_at_the_ground),
        cmocka_unit_test(guesses_are_seen_from_the_side_if_by_nothing_else),
        cmocka_unit_test(photographs_that_tie_paint),
    };
    int failed = cmocka_run_group_tests_name("gather best", tests, NULL, NULL);
    orl_gpu_destroy(&gpu);
    return failed;
}
