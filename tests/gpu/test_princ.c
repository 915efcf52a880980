// The method of Princ 2014 against answers found by hand.
#include <math.h>

#include "oriel/points.h"
#include "wall_scene.h"

enum { SIDE = 48, MIDDLE = SIDE / 2, GRID = 60 };

static struct orl_gpu *gpu;

// A wall at z = 4 and a floor at y = 1 before it, 4 units each way.
static void setup_corner(struct fixture *f)
{
    setup_empty(f, 4);
    struct orl_points *points = &f->scene.points;
    assert_int_equal(orl_points_init(NULL, points, 2 * GRID * GRID), ORL_OK);
    set_square(points, 0, GRID, 4, 0, 4, red);
    for (size_t i = 0; i < GRID * GRID; i++) {
        size_t to = GRID * GRID + i;
        points->position[to][0] = points->position[i][0];
        points->position[to][1] = 1;
        points->position[to][2] = 3 + points->position[i][1] / 2;
        points->normal[to][1] = -1;
        points->radius[to] = points->radius[i];
    }
}

// Looks straight down from above.
static struct orl_view from_above(void)
{
    struct orl_view view = look_from(0, 0, 0, SIDE, 20);
    view.cam_from_world = (struct orl_pose){.r = {{1, 0, 0}, {0, 0, -1}, {0, 1, 0}},
                                            .t = {0, 3, 3}};
    return view;
}

static struct orl_frame draw_from(struct fixture *f, struct orl_view view,
                                  const char *const *settings, size_t count)
{
    struct orl_render_params params = orl_method_find(NULL, "princ")->params;
    assert_int_equal(orl_render_params_assign(NULL, &params, settings, count), ORL_OK);
    return draw(gpu, f, view, &params, 0);
}

static struct orl_frame draw_with(struct fixture *f, const char *const *settings, size_t count)
{
    return draw_from(f, look_from(0, 0, 0, SIDE, 40), settings, count);
}

// No pixel mixes photographs.
static void one_photograph_paints_a_pixel(void **state)
{
    (void)state;
    struct fixture f;
    setup(&f, true);
    for (int i = 0; i < 5; i++)
        add_photo(&f, look_from(0.5 * i - 1, 0.2 * i, 0, SIDE, 40), i % 2 ? red : green);
    struct orl_frame frame = draw_with(&f, NULL, 0);
    int painted[2] = {0};
    for (int i = 0; i < SIDE * SIDE; i++) {
        const float *c = &frame.color.f32[3 * i];
        if (frame.coverage.f32[i] == 0)
            continue;
        assert_true((c[0] > 0.99f && c[1] < 0.01f) || (c[0] < 0.01f && c[1] > 0.99f));
        painted[c[1] > 0.5f]++;
    }
    assert_true(painted[0] + painted[1] > SIDE * SIDE / 2);
    orl_frame_finish(&frame);
    teardown(&f);
}

// What the nearest photograph sees along its surface is left to one that looks down on it, and to
// nobody where there is none. Pixel (24, 44) sees the floor, (24, 24) the wall.
static void extras_paint_oblique_surfaces(void **state)
{
    (void)state;
    static const char *const one[] = {"nearest=1", "fill=none"};
    struct fixture f;
    setup_corner(&f);
    add_photo(&f, look_from(0, 0, -0.1, SIDE, 40), red);
    struct orl_frame few = draw_with(&f, one, 2);
    add_photo(&f, from_above(), green);
    struct orl_frame more = draw_with(&f, one, 2);
    size_t floor = 44 * SIDE + 24, wall = 24 * SIDE + 24;
    assert_true(few.depth.f32[floor] > 0);
    assert_float_equal(few.coverage.f32[floor], 0, 0);
    assert_float_equal(more.coverage.f32[floor], 1, 0);
    assert_float_equal(more.color.f32[3 * floor + 1], 1, 1e-3);
    assert_float_equal(few.color.f32[3 * wall], 1, 1e-3);
    assert_float_equal(more.color.f32[3 * wall], 1, 1e-3);
    orl_frame_finish(&few);
    orl_frame_finish(&more);
    teardown(&f);
}

// s of equation 2.8 is an area: of two photographs alike, the one of twice as many pixels each way has
// four times the weight.
static void a_larger_photograph_weighs_more(void **state)
{
    (void)state;
    static const char *const mean[] = {"combine=mean"};
    struct fixture f;
    setup(&f, false);
    add_photo(&f, look_from(0, 0, -8, SIDE, 40), red);
    add_photo(&f, look_from(0, 0, -8, 2 * SIDE, 80), green);
    struct orl_frame frame = draw_with(&f, mean, 1);
    const float *middle = color_at(&frame, MIDDLE, MIDDLE);
    assert_float_equal(middle[1] / middle[0], 4, 0.05);
    orl_frame_finish(&frame);
    teardown(&f);
}

// An extra photograph that also sees the wall, larger than the nearest does, paints the floor alone.
static void extras_give_way(void **state)
{
    (void)state;
    static const char *const one[] = {"nearest=1", "fill=none"};
    const double h = sqrt(0.5);
    struct fixture f;
    setup_corner(&f);
    add_photo(&f, look_from(0, 0, -0.1, SIDE, 10), red);
    struct orl_view aslant = look_from(0, 0, 0, SIDE, 30); // at the corner from 4 away, down by 45 degrees
    aslant.cam_from_world = (struct orl_pose){.r = {{1, 0, 0}, {0, h, -h}, {0, h, h}},
                                              .t = {0, 3 * h, 4 - 5 * h}};
    add_photo(&f, aslant, green);
    struct orl_frame frame = draw_with(&f, one, 2);
    assert_float_equal(color_at(&frame, 24, 38)[1], 1, 1e-3);
    assert_float_equal(color_at(&frame, 24, 24)[0], 1, 1e-3);
    assert_float_equal(color_at(&frame, 24, 24)[1], 0, 1e-3);
    orl_frame_finish(&frame);
    teardown(&f);
}

// From outside, the photograph is taken that looks as one would look at the model's middle, not as
// the view does, which looks 30 degrees aside, as the other photograph does.
static void outside_the_middle_decides(void **state)
{
    (void)state;
    static const char *const one[] = {"nearest=1", "fill=none"};
    const double c = cos(0.5235987755982988), s = 0.5;
    const struct orl_pose aside = {.r = {{c, 0, -s}, {0, 1, 0}, {s, 0, c}}};
    struct fixture f;
    setup(&f, false);
    struct orl_view view = look_from(0, 0, 0, SIDE, 40);
    view.cam_from_world = aside;
    add_photo(&f, view, green);
    add_photo(&f, look_from(0, 0, 0, SIDE, 20), red);
    struct orl_frame frame = draw_from(&f, view, one, 2);
    assert_float_equal(color_at(&frame, MIDDLE, MIDDLE)[0], 1, 1e-3);
    assert_float_equal(color_at(&frame, MIDDLE, MIDDLE)[1], 0, 1e-3);
    orl_frame_finish(&frame);
    teardown(&f);
}

// Between two walls, the photograph is taken that looks as the view does. The other one looks as one
// would look at the model's middle, and shows this place, too.
static void inside_the_axis_decides(void **state)
{
    (void)state;
    static const char *const one[] = {"nearest=1", "fill=none"};
    const double c = cos(0.5235987755982988), s = 0.5;
    struct fixture f;
    setup_empty(&f, 4);
    assert_int_equal(orl_points_init(NULL, &f.scene.points, 2 * GRID * GRID), ORL_OK);
    set_square(&f.scene.points, 0, GRID, 6, 0, 4, red);
    set_square(&f.scene.points, GRID * GRID, GRID, 6, 0, -4, red);
    for (size_t i = GRID * GRID; i < 2 * GRID * GRID; i++)
        f.scene.points.normal[i][2] = 1;
    struct orl_view aside = look_from(0, 0, 0, SIDE, 40);
    aside.cam_from_world = (struct orl_pose){.r = {{c, 0, -s}, {0, 1, 0}, {s, 0, c}}};
    add_photo(&f, aside, green);
    add_photo(&f, look_from(0, 0, 0, SIDE, 20), red);
    struct orl_frame frame = draw_from(&f, look_from(-1, 0, -1.73, SIDE, 40), one, 2);
    assert_float_equal(color_at(&frame, 41, MIDDLE)[0], 1, 1e-3);
    assert_float_equal(color_at(&frame, 41, MIDDLE)[1], 0, 1e-3);
    orl_frame_finish(&frame);
    teardown(&f);
}

// A photograph covers nothing beside its picture: what lies there is left to an extra one.
static void a_photograph_ends_at_its_border(void **state)
{
    (void)state;
    static const char *const one[] = {"nearest=1", "fill=none"};
    struct fixture f;
    setup(&f, false);
    struct orl_view half = look_from(0, 0, 0, SIDE, 40);
    half.camera.cx = SIDE; // what is left of the middle
    add_photo(&f, half, red);
    half.camera.cx = 0;
    add_photo(&f, half, green);
    struct orl_frame frame = draw_with(&f, one, 2);
    assert_float_equal(color_at(&frame, MIDDLE - 12, MIDDLE)[0], 1, 1e-3);
    assert_float_equal(color_at(&frame, MIDDLE + 12, MIDDLE)[1], 1, 1e-3);
    orl_frame_finish(&frame);
    teardown(&f);
}

// Of normals that no photograph covers, each direction gets an extra one: the floor, too, though most
// normals are the wall's and others would do for the mean of both.
static void every_direction_gets_an_extra(void **state)
{
    (void)state;
    static const char *const one[] = {"nearest=1", "fill=none"};
    enum { TINY = 4 }; // pixels of photographs that show a small part of the wall
    const double h = sqrt(0.5);
    struct fixture f;
    setup_corner(&f);
    for (int i = 0; i < 3; i++)
        add_photo(&f, look_from(0.1 * i - 0.1, 0, 0, TINY, 40), red);
    struct orl_view aslant = look_from(0, 0, 0, TINY, 40);
    aslant.cam_from_world = (struct orl_pose){.r = {{1, 0, 0}, {0, h, -h}, {0, h, h}},
                                              .t = {0, 3 * h, 4 - 5 * h}};
    add_photo(&f, aslant, blue);
    add_photo(&f, from_above(), green);
    struct orl_frame frame = draw_with(&f, one, 2);
    assert_float_equal(color_at(&frame, 24, 44)[1], 1, 1e-3);
    orl_frame_finish(&frame);
    teardown(&f);
}

// Looks from `distance` at the wall's middle, `degrees` aside, as a normal turned by as much looks back.
static struct orl_view aside_by(double degrees, double distance, int side, double focal)
{
    double c = cos(degrees * 3.141592653589793 / 180), s = sin(degrees * 3.141592653589793 / 180);
    struct orl_view view = look_from(0, 0, 0, side, focal);
    view.cam_from_world = (struct orl_pose){.r = {{c, 0, s}, {0, 1, 0}, {-s, 0, c}},
                                            .t = {-4 * s, 0, distance - 4 * c}};
    return view;
}

// 2.3.2: an extra photograph for each mean of a cluster of normals. They turn from -40 degrees on the
// left to 40 on the right, so that the three means lie at about -27, 0 and 27. Photographs that look
// at the outermost normals, between the means or from farther aside are not taken.
static void extras_look_at_the_means_of_clusters(void **state)
{
    (void)state;
    static const char *const one[] = {"nearest=1", "fill=none", "combine=mean"}; // shows all that are taken
    static const double means[] = {-27, 0, 27}, others[] = {-60, -50, -40, -14, 14, 40, 50, 60};
    enum { TINY = 4 }; // pixels of a photograph that shows the middle alone
    struct fixture f;
    setup(&f, false);
    for (size_t i = 0; i < f.scene.points.count; i++) {
        double turn = (double)f.scene.points.position[i][0] / 3 * 40 * 3.141592653589793 / 180;
        f.scene.points.normal[i][0] = (float)sin(turn);
        f.scene.points.normal[i][2] = (float)-cos(turn);
    }
    add_photo(&f, aside_by(0, 4, TINY, 40), green);
    for (size_t i = 0; i < ORL_COUNT(others); i++)
        add_photo(&f, aside_by(others[i], 40, SIDE, 240), red);
    for (size_t i = 0; i < ORL_COUNT(means); i++)
        add_photo(&f, aside_by(means[i], 40, SIDE, 240), green);
    struct orl_frame frame = draw_from(&f, look_from(0, 0, 0, SIDE, 32), one, 3);
    int painted = 0;
    for (int i = 0; i < SIDE * SIDE; i++) {
        painted += frame.coverage.f32[i] > 0;
        assert_float_equal(frame.color.f32[3 * i], 0, 1e-3);
    }
    assert_true(painted > SIDE * SIDE / 2);
    orl_frame_finish(&frame);
    teardown(&f);
}

// Equation 2.8: 4.04 for a frontal photograph, 3.04 at 70 degrees. By the mean of all, the shares of
// two photographs in a pixel are their weights; both show the whole wall in as large a part.
static void weights_are_those_of_the_equation(void **state)
{
    (void)state;
    static const char *const mean[] = {"combine=mean"};
    const double angle = 60 * 3.141592653589793 / 180, c = cos(angle), s = sin(angle);
    struct fixture f;
    setup(&f, false);
    add_photo(&f, look_from(0, 0, -8, SIDE, 40), red);
    // From the side at as far from the wall's middle, looking at it.
    struct orl_view side = look_from(0, 0, 0, SIDE, 40);
    side.cam_from_world = (struct orl_pose){.r = {{c, 0, s}, {0, 1, 0}, {-s, 0, c}},
                                            .t = {-4 * s, 0, 12 - 4 * c}};
    add_photo(&f, side, green);
    struct orl_frame frame = draw_with(&f, mean, 1);
    const float *middle = color_at(&frame, MIDDLE, MIDDLE);
    const double limit = 1 - cos(70 * 3.141592653589793 / 180);
    double front = (1 + 1) / limit + 1;
    assert_float_equal(front, 4.04, 0.005);
    assert_float_equal((1 + cos(70 * 3.141592653589793 / 180)) / limit + 1, 3.04, 0.005);
    // The wall is 6 x 6 units, 12 away: 20 x 20 pixels from the front; from the side its outline is
    // a trapezium, whose area projective geometry gives.
    double area = 0, middle_x = 0, corners[4][2];
    static const double at[4][2] = {{-3, -3}, {3, -3}, {3, 3}, {-3, 3}};
    for (int i = 0; i < 4; i++) {
        double x = at[i][0] * c, z = 12 - at[i][0] * s;
        corners[i][0] = 40 * x / z;
        corners[i][1] = 40 * at[i][1] / z;
        middle_x += corners[i][0] / 4 / 40;
    }
    for (int i = 0; i < 4; i++)
        area += 0.5 * (corners[i][0] * corners[(i + 1) % 4][1] -
                       corners[(i + 1) % 4][0] * corners[i][1]);
    // Its direction is that to the middle of the corners, as it shows them.
    double agrees = (middle_x * s + c) / hypot(middle_x, 1);
    double oblique = agrees * ((1 + agrees) / limit + 1);
    double expected = oblique * area / (front * 400);
    assert_float_equal(middle[1] / middle[0], expected, 0.03 * expected);
    orl_frame_finish(&frame);
    teardown(&f);
}

// Photographs have no depth maps until a method with a shadow test asks for them.
static void depth_maps_take_no_memory(void **state)
{
    (void)state;
    struct fixture f;
    setup(&f, false);
    for (int i = 0; i < 3; i++)
        add_photo(&f, look_from(0.5 * i, 0, 0, SIDE, 40), red);
    struct orl_renderer *renderer;
    struct orl_view view = look_from(0, 0, 0, SIDE, 40);
    assert_int_equal(orl_renderer_create(gpu, &f.scene, NULL, &renderer), ORL_OK);
    size_t bytes[2];
    const char *const names[2] = {"princ", "airieau"};
    for (int i = 0; i < 2; i++) {
        const struct orl_method *method = orl_method_find(NULL, names[i]);
        assert_int_equal(orl_renderer_draw(renderer, &view, &method->params, NULL, NULL), ORL_OK);
        bytes[i] = orl_gpu_owner_bytes(gpu, ORL_OWNER_PHOTOGRAPHS);
    }
    assert_int_equal(bytes[1] - bytes[0], 3 * SIDE * SIDE * 4);
    orl_renderer_destroy(&renderer);
    teardown(&f);
}

int main(void)
{
    gpu = gpu_test_device();
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_larger_photograph_weighs_more),
        cmocka_unit_test(one_photograph_paints_a_pixel),
        cmocka_unit_test(extras_paint_oblique_surfaces),
        cmocka_unit_test(extras_give_way),
        cmocka_unit_test(outside_the_middle_decides),
        cmocka_unit_test(inside_the_axis_decides),
        cmocka_unit_test(a_photograph_ends_at_its_border),
        cmocka_unit_test(every_direction_gets_an_extra),
        cmocka_unit_test(extras_look_at_the_means_of_clusters),
        cmocka_unit_test(weights_are_those_of_the_equation),
        cmocka_unit_test(depth_maps_take_no_memory),
    };
    int failed = cmocka_run_group_tests_name("Princ", tests, NULL, NULL);
    orl_gpu_destroy(&gpu);
    return failed;
}
