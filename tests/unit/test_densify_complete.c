// Completion of depth maps: holes in a wall take the wall's plane where no edge parts them from it.
#include <math.h>
#include <string.h>

#include "test.h"

#include "preprocess/densify/densify_internal.h"

enum { WIDTH = 96, HEIGHT = 64, LEFT = 42, RIGHT = 50, TOP = 28, BOTTOM = 36, WALL = 120 };

struct fixture {
    struct densify_pyramid picture;
    struct densify_job job;
    struct densify_maps maps;
};

static double wall_depth(int x, int y)
{
    return 1.0 / (0.2 + 0.0004 * (x + 0.5) - 0.0002 * (y + 0.5));
}

static bool in_hole(int x, int y)
{
    return x >= LEFT && x < RIGHT && y >= TOP && y < BOTTOM;
}

// A wall without texture and all its depth but the hole's.
static int set_up(void **state)
{
    struct fixture *f = calloc(1, sizeof *f);
    struct orl_camera camera = {.width = WIDTH, .height = HEIGHT, .fx = 80, .fy = 80, .cx = 48,
                                .cy = 32};
    struct orl_view view = {camera, {.r = {{1, 0, 0}, {0, 1, 0}, {0, 0, 1}}}};
    assert_non_null(f);
    f->picture.camera = camera;
    f->picture.count = 1;
    f->job = (struct densify_job){.view = view, .reference = &f->picture};
    assert_int_equal(orl_image_init(NULL, &f->picture.levels[0], WIDTH, HEIGHT, 1, ORL_PIXEL_U8),
                     ORL_OK);
    assert_int_equal(orl_image_init(NULL, &f->maps.depth, WIDTH, HEIGHT, 1, ORL_PIXEL_F32), ORL_OK);
    assert_int_equal(orl_image_init(NULL, &f->maps.normal, WIDTH, HEIGHT, 3, ORL_PIXEL_F32),
                     ORL_OK);
    assert_int_equal(orl_image_init(NULL, &f->maps.confidence, WIDTH, HEIGHT, 1, ORL_PIXEL_F32),
                     ORL_OK);
    // 1/z = a + b u + c v at pixels is the plane (b fx, c fy, a + b cx + c cy) X = 1.
    double n[3] = {0.0004 * camera.fx, -0.0002 * camera.fy,
                   0.2 + 0.0004 * camera.cx - 0.0002 * camera.cy};
    double length = sqrt(n[0] * n[0] + n[1] * n[1] + n[2] * n[2]);
    memset(f->picture.levels[0].data, WALL, (size_t)WIDTH * HEIGHT);
    for (int y = 0; y < HEIGHT; y++)
        for (int x = 0; x < WIDTH; x++) {
            size_t at = (size_t)y * WIDTH + (size_t)x;
            if (in_hole(x, y))
                continue;
            f->maps.depth.f32[at] = (float)wall_depth(x, y);
            f->maps.confidence.f32[at] = 0.9f;
            for (int i = 0; i < 3; i++)
                f->maps.normal.f32[3 * at + (size_t)i] = (float)(-n[i] / length);
        }
    *state = f;
    return 0;
}

static int tear_down(void **state)
{
    struct fixture *f = *state;
    orl_densify_pyramid_finish(&f->picture);
    orl_densify_maps_finish(&f->maps);
    free(f);
    return 0;
}

static int filled(struct fixture *f)
{
    int count = 0;
    assert_int_equal(orl_densify_complete(NULL, &f->job, &f->maps), ORL_OK);
    for (int y = TOP; y < BOTTOM; y++)
        for (int x = LEFT; x < RIGHT; x++)
            count += f->maps.depth.f32[y * WIDTH + x] > 0.0f;
    return count;
}

static void assert_completed(const struct fixture *f, int x, int y)
{
    size_t at = (size_t)y * WIDTH + (size_t)x;
    const float *n = &f->maps.normal.f32[3 * at], *around = f->maps.normal.f32;
    assert_float_equal(f->maps.depth.f32[at], wall_depth(x, y), 1e-3 * wall_depth(x, y));
    assert_true(f->maps.confidence.f32[at] > 0.0f && f->maps.confidence.f32[at] < 0.5f);
    for (int i = 0; i < 3; i++)
        assert_float_equal(n[i], around[i], 1e-3);
}

static void test_plain_hole(void **state)
{
    struct fixture *f = *state;
    assert_int_equal(filled(f), (RIGHT - LEFT) * (BOTTOM - TOP));
    for (int y = TOP; y < BOTTOM; y++)
        for (int x = LEFT; x < RIGHT; x++)
            assert_completed(f, x, y);
}

// A line of print stays open, and both sides of it are completed.
static void test_print(void **state)
{
    struct fixture *f = *state;
    int print = (TOP + BOTTOM) / 2;
    memset(f->picture.levels[0].u8 + print * WIDTH + LEFT, WALL - 90, RIGHT - LEFT);
    assert_int_equal(filled(f), (RIGHT - LEFT) * (BOTTOM - TOP - 1));
    for (int x = LEFT; x < RIGHT; x++) {
        assert_true(f->maps.depth.f32[print * WIDTH + x] == 0.0f);
        assert_completed(f, x, print - 1);
        assert_completed(f, x, print + 1);
    }
}

// The outermost two pixels of depth around the hole are wrong, as they are around objects before the sky.
static void test_rim_of_depth(void **state)
{
    struct fixture *f = *state;
    for (int y = TOP - 2; y < BOTTOM + 2; y++)
        for (int x = LEFT - 2; x < RIGHT + 2; x++)
            f->maps.depth.f32[y * WIDTH + x] *= 0.5f;
    assert_int_equal(filled(f), (RIGHT - LEFT) * (BOTTOM - TOP));
    assert_completed(f, LEFT, TOP);
}

// A window: its panes are plain too, but there is an edge around them.
static void test_hole_of_another_colour(void **state)
{
    struct fixture *f = *state;
    for (int y = TOP; y < BOTTOM; y++)
        memset(f->picture.levels[0].u8 + y * WIDTH + LEFT, WALL - 30, RIGHT - LEFT);
    assert_int_equal(filled(f), 0);
}

// The pane has the wall's colour, but its frame has not.
static void test_hole_within_a_frame(void **state)
{
    struct fixture *f = *state;
    for (int y = TOP; y < BOTTOM; y++)
        for (int x = LEFT; x < RIGHT; x++)
            if (y < TOP + 2 || y >= BOTTOM - 2 || x < LEFT + 2 || x >= RIGHT - 2)
                f->picture.levels[0].u8[y * WIDTH + x] = WALL - 30;
    assert_int_equal(filled(f), 0);
}

// Nothing to the right: a plain sky beside a wall.
static void test_surface_on_one_side(void **state)
{
    struct fixture *f = *state;
    for (int y = 0; y < HEIGHT; y++)
        for (int x = LEFT; x < WIDTH; x++)
            f->maps.depth.f32[y * WIDTH + x] = 0.0f;
    assert_int_equal(filled(f), 0);
}

// A small hole darkens towards its middle without an edge: another thing out of focus.
static void test_hole_that_fades_to_another_colour(void **state)
{
    struct fixture *f = *state;
    int x_middle = (LEFT + RIGHT) / 2, y_middle = (TOP + BOTTOM) / 2;
    for (int y = TOP; y < BOTTOM; y++)
        for (int x = LEFT; x < RIGHT; x++) {
            size_t at = (size_t)y * WIDTH + (size_t)x;
            int across = abs(x - x_middle), down = abs(y - y_middle), side = across > down ? across : down;
            f->picture.levels[0].u8[at] = (uint8_t)(WALL - 3 * (5 - side));
            f->maps.depth.f32[at] = side > 1 ? (float)wall_depth(x, y) : 0.0f;
        }
    filled(f);
    assert_true(f->maps.depth.f32[y_middle * WIDTH + x_middle] == 0.0f);
}

// The wall stands twice as far on the right of the hole.
static void test_surfaces_that_disagree(void **state)
{
    struct fixture *f = *state;
    for (int y = 0; y < HEIGHT; y++)
        for (int x = RIGHT; x < WIDTH; x++)
            f->maps.depth.f32[y * WIDTH + x] *= 2.0f;
    assert_int_equal(filled(f), 0);
}

static void test_doubtful_surface(void **state)
{
    struct fixture *f = *state;
    for (int i = 0; i < WIDTH * HEIGHT; i++)
        f->maps.confidence.f32[i] *= 0.5f;
    assert_int_equal(filled(f), 0);
}

static void test_mask(void **state)
{
    struct fixture *f = *state;
    assert_int_equal(orl_image_init(NULL, &f->job.mask, WIDTH, HEIGHT, 1, ORL_PIXEL_U8), ORL_OK);
    assert_int_equal(filled(f), 0);
    orl_image_finish(&f->job.mask);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test_setup_teardown(test_plain_hole, set_up, tear_down),
        cmocka_unit_test_setup_teardown(test_print, set_up, tear_down),
        cmocka_unit_test_setup_teardown(test_rim_of_depth, set_up, tear_down),
        cmocka_unit_test_setup_teardown(test_hole_of_another_colour, set_up, tear_down),
        cmocka_unit_test_setup_teardown(test_hole_within_a_frame, set_up, tear_down),
        cmocka_unit_test_setup_teardown(test_surface_on_one_side, set_up, tear_down),
        cmocka_unit_test_setup_teardown(test_hole_that_fades_to_another_colour, set_up, tear_down),
        cmocka_unit_test_setup_teardown(test_surfaces_that_disagree, set_up, tear_down),
        cmocka_unit_test_setup_teardown(test_doubtful_surface, set_up, tear_down),
        cmocka_unit_test_setup_teardown(test_mask, set_up, tear_down),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
