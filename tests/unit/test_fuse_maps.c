// Points from depth maps: cameras in a row that look along z, at a wall and at a box before it.
#include <math.h>
#include <stdlib.h>

#include "preprocess/cloud/fuse_maps.h"
#include "test.h"

enum { WIDTH = 64, HEIGHT = 48 };
static const float WALL = 8, BOX = 4;

// A camera at x = `at`, with focal length 64 pixels for pictures of this width.
static struct orl_depth_map make_map(double at, int divide)
{
    double f = 64.0 / divide;
    struct orl_depth_map map = {.view = {
        {WIDTH / divide, HEIGHT / divide, f, f, 0.5 * WIDTH / divide, 0.5 * HEIGHT / divide},
        {{{1, 0, 0}, {0, 1, 0}, {0, 0, 1}}, {-at, 0, 0}}}};
    assert_int_equal(orl_image_init(NULL, &map.depth, WIDTH / divide, HEIGHT / divide, 1,
                                    ORL_PIXEL_F32), ORL_OK);
    return map;
}

// Draws the wall, or nothing, and before it a box of x and y from -0.5 to 0.5.
static void draw(struct orl_depth_map *map, float wall, bool box)
{
    const struct orl_camera *c = &map->view.camera;
    for (int y = 0; y < c->height; y++)
        for (int x = 0; x < c->width; x++) {
            double at_x = (x + 0.5 - c->cx) / c->fx * BOX - map->view.cam_from_world.t[0];
            double at_y = (y + 0.5 - c->cy) / c->fy * BOX;
            bool on = box && fabs(at_x) < 0.5 && fabs(at_y) < 0.5;
            map->depth.f32[y * c->width + x] = on ? BOX : wall;
        }
}

static void find(const struct orl_depth_map *maps, size_t which, size_t count,
                 struct orl_fused_pixels *found)
{
    uint32_t others[8];
    size_t other_count = 0;
    for (uint32_t i = 0; i < count; i++)
        if (i != which)
            others[other_count++] = i;
    assert_int_equal(orl_fuse_pixels_find(NULL, maps, which, others, other_count, found), ORL_OK);
}

// What the first of two maps of the wall gives.
static void find_on_wall(struct orl_depth_map maps[2], struct orl_fused_pixels *found)
{
    draw(&maps[0], WALL, false);
    draw(&maps[1], WALL, false);
    find(maps, 0, 2, found);
}

// Of a smooth wall every second pixel each way, where the other camera sees it.
static void a_wall_needs_every_second_pixel(void **state)
{
    struct orl_depth_map maps[] = {make_map(0, 1), make_map(1, 1)};
    struct orl_fused_pixels found;
    (void)state;
    find_on_wall(maps, &found);
    // One unit to the side is 8 pixels at this depth: x from 8 on is common to both.
    assert_int_equal(found.count, (WIDTH - 8) / 2 * (HEIGHT / 2));
    for (size_t i = 0; i < found.count; i++) {
        assert_true(found.pixel[i] % WIDTH % 2 == 1 && found.pixel[i] / WIDTH % 2 == 1);
        assert_true(found.pixel[i] % WIDTH >= 8);
        assert_int_equal(found.agree[i], 2);
    }
    orl_fused_pixels_finish(&found);
    for (int i = 0; i < 2; i++)
        orl_image_finish(&maps[i].depth);
}

// The other picture begins 9.25 pixels to the right, so that it shows the middle of pixel 9, but not
// its left half.
static void pixels_are_asked_for_at_their_middles(void **state)
{
    struct orl_depth_map maps[] = {make_map(0, 1), make_map(9.25 / 8, 1)};
    struct orl_fused_pixels found;
    (void)state;
    find_on_wall(maps, &found);
    assert_int_equal(found.count, (WIDTH - 8) / 2 * (HEIGHT / 2));
    orl_fused_pixels_finish(&found);
    for (int i = 0; i < 2; i++)
        orl_image_finish(&maps[i].depth);
}

// Around the outline of the box all pixels become points.
static void outlines_have_all_pixels(void **state)
{
    struct orl_depth_map maps[] = {make_map(0, 1), make_map(0.25, 1), make_map(-0.25, 1)};
    struct orl_fused_pixels found;
    size_t box = 0, far = 0;
    (void)state;
    for (int i = 0; i < 3; i++)
        draw(&maps[i], WALL, true);
    find(maps, 0, 3, &found);
    for (size_t i = 0; i < found.count; i++) {
        int x = (int)(found.pixel[i] % WIDTH), y = (int)(found.pixel[i] / WIDTH);
        box += maps[0].depth.f32[found.pixel[i]] < 5;
        // The box is 16 pixels wide, from 24 to 40 and from 16 to 32.
        bool near = x >= 19 && x < 45 && y >= 11 && y < 37;
        far += !near;
        assert_true(near || (x % 2 == 1 && y % 2 == 1));
    }
    assert_true(far > 0);
    assert_true(box > 16 * 16 - 8 * 8); // nearly all but what is inside and every second pixel there
    orl_fused_pixels_finish(&found);
    for (int i = 0; i < 3; i++)
        orl_image_finish(&maps[i].depth);
}

// A box that one map alone has, or that a third of the others see past, is no surface.
static void what_others_see_past_goes(void **state)
{
    struct orl_depth_map maps[] = {make_map(0, 1), make_map(0.25, 1), make_map(-0.25, 1),
                                   make_map(0.5, 1)};
    struct orl_fused_pixels found;
    (void)state;
    for (int with = 1; with <= 4; with++) { // how many maps have the box
        size_t box = 0;
        for (int i = 0; i < 4; i++)
            draw(&maps[i], WALL, i < with);
        find(maps, 0, 4, &found);
        for (size_t i = 0; i < found.count; i++)
            box += maps[0].depth.f32[found.pixel[i]] < 5;
        assert_true(with >= 3 ? box > 150 : box == 0); // three agree for one that sees past
        orl_fused_pixels_finish(&found);
    }
    for (int i = 0; i < 4; i++)
        orl_image_finish(&maps[i].depth);
}

// Depths agree within a hundredth, and a map sees past what lies two hundredths before its own depth.
// Cameras stand close, so that pixels do not decide.
static void depths_agree_within_a_hundredth(void **state)
{
    static const struct {
        float second, third; // walls; 0: no depth
        bool stays;
    } rows[] = {{1.008f, 0, true}, {1.03f, 0, false}, {1, 1.015f, true}, {1, 1.03f, false}};
    struct orl_depth_map maps[] = {make_map(0, 1), make_map(0.05, 1), make_map(-0.05, 1)};
    (void)state;
    for (size_t r = 0; r < ORL_COUNT(rows); r++) {
        struct orl_fused_pixels found;
        draw(&maps[0], WALL, false);
        draw(&maps[1], rows[r].second * WALL, false);
        draw(&maps[2], rows[r].third * WALL, false);
        find(maps, 0, 3, &found);
        assert_int_equal(found.count > 0, rows[r].stays);
        orl_fused_pixels_finish(&found);
    }
    for (int i = 0; i < 3; i++)
        orl_image_finish(&maps[i].depth);
}

// A step is a twentieth of the depth, not a hundredth.
static void small_steps_are_outlines_too(void **state)
{
    struct orl_depth_map maps[] = {make_map(0, 1), make_map(0.02, 1)};
    (void)state;
    for (int step = 0; step < 2; step++) {
        struct orl_fused_pixels found;
        size_t between = 0; // pixels that are not every second one
        for (int i = 0; i < 2; i++)
            draw(&maps[i], step ? 1.05f * BOX : 1.01f * BOX, true);
        find(maps, 0, 2, &found);
        for (size_t i = 0; i < found.count; i++)
            between += !(found.pixel[i] % WIDTH % 2 == 1 && found.pixel[i] / WIDTH % 2 == 1);
        assert_int_equal(between > 0, step);
        orl_fused_pixels_finish(&found);
    }
    for (int i = 0; i < 2; i++)
        orl_image_finish(&maps[i].depth);
}

// The map with the finer pixels keeps the points; the coarser one those that the finer lacks.
static void the_finer_photograph_keeps_the_points(void **state)
{
    struct orl_depth_map maps[] = {make_map(0, 1), make_map(0.25, 2), make_map(-0.25, 2)};
    struct orl_fused_pixels fine, coarse;
    (void)state;
    for (int i = 0; i < 3; i++)
        draw(&maps[i], WALL, false);
    for (int y = 0; y < HEIGHT; y++)
        for (int x = 0; x < WIDTH / 2; x++)
            maps[0].depth.f32[y * WIDTH + x] = 0;
    find(maps, 0, 3, &fine);
    find(maps, 1, 3, &coarse);
    assert_true(fine.count > 0 && coarse.count > 0);
    for (size_t i = 0; i < fine.count; i++)
        assert_true(fine.pixel[i] % WIDTH >= WIDTH / 2);
    for (size_t i = 0; i < coarse.count; i++) // its x = 15 is where the finer map begins
        assert_true(coarse.pixel[i] % (WIDTH / 2) <= WIDTH / 4);
    orl_fused_pixels_finish(&fine);
    orl_fused_pixels_finish(&coarse);
    for (int i = 0; i < 3; i++)
        orl_image_finish(&maps[i].depth);
}

// Two photographs of one place that stand 45 degrees apart, with a long lens: what is within 1 % in
// depth is 6 pixels off in the other picture, and that is not agreement.
static void far_photographs_agree_by_pixels(void **state)
{
    enum { FOCAL = 1024 };
    struct orl_depth_map maps[] = {make_map(0, 1), make_map(0, 1)};
    const double eye[3] = {WALL, 0, 0}, target[3] = {0, 0, WALL}, up[3] = {0, -1, 0};
    (void)state;
    maps[0].view.camera.fx = maps[0].view.camera.fy = FOCAL;
    maps[1].view.camera = maps[0].view.camera;
    maps[1].view.cam_from_world = orl_pose_look_at(eye, target, up);
    for (int wrong = 0; wrong <= 1; wrong++) {
        struct orl_fused_pixels found;
        draw(&maps[0], WALL, false);
        for (int y = 0; y < HEIGHT; y++) // the same wall, z = 8, from the other eye
            for (int x = 0; x < WIDTH; x++) {
                double at[3];
                orl_view_unproject(&maps[1].view, x + 0.5, y + 0.5, 1, at);
                maps[1].depth.f32[y * WIDTH + x] = (float)((double)WALL / at[2]) *
                                                   (wrong ? 1.006f : 1);
            }
        find(maps, 0, 2, &found);
        assert_true(wrong ? found.count == 0 : found.count > 100);
        orl_fused_pixels_finish(&found);
    }
    for (int i = 0; i < 2; i++)
        orl_image_finish(&maps[i].depth);
}

// Positions, normals and colours in the world's frame, of a camera that looks along -z.
static void points_are_in_the_world(void **state)
{
    struct orl_depth_map map = make_map(0, 1);
    struct orl_image normal, picture;
    struct orl_points points;
    uint32_t pixels[] = {10 * WIDTH + 40};
    uint8_t agree[] = {5};
    const struct orl_fused_pixels found = {1, pixels, agree};
    (void)state;
    map.view.cam_from_world = (struct orl_pose){{{1, 0, 0}, {0, -1, 0}, {0, 0, -1}}, {0, 0, 2}};
    draw(&map, WALL, false);
    assert_int_equal(orl_image_init(NULL, &normal, WIDTH, HEIGHT, 3, ORL_PIXEL_F32), ORL_OK);
    assert_int_equal(orl_image_init(NULL, &picture, WIDTH, HEIGHT, 3, ORL_PIXEL_U8), ORL_OK);
    normal.f32[3 * pixels[0] + 2] = -1;
    picture.u8[3 * pixels[0] + 1] = 77;
    assert_int_equal(orl_points_init(NULL, &points, 2), ORL_OK);
    orl_fuse_pixels_write(&map, &found, &normal, &picture, 1, &points);
    assert_float_equal(points.position[1][0], (40.5 - 32) / 64 * 8, 1e-5);
    assert_float_equal(points.position[1][1], -(10.5 - 24) / 64 * 8, 1e-5);
    assert_float_equal(points.position[1][2], 2 - 8, 1e-5);
    assert_float_equal(points.normal[1][2], 1, 1e-6); // towards the camera
    assert_int_equal(points.color[1][1], 77);
    assert_int_equal(points.photographs[1], 5);
    orl_points_finish(&points);
    orl_image_finish(&normal);
    orl_image_finish(&picture);
    orl_image_finish(&map.depth);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_wall_needs_every_second_pixel),
        cmocka_unit_test(pixels_are_asked_for_at_their_middles),
        cmocka_unit_test(outlines_have_all_pixels),
        cmocka_unit_test(what_others_see_past_goes),
        cmocka_unit_test(depths_agree_within_a_hundredth),
        cmocka_unit_test(small_steps_are_outlines_too),
        cmocka_unit_test(the_finer_photograph_keeps_the_points),
        cmocka_unit_test(far_photographs_agree_by_pixels),
        cmocka_unit_test(points_are_in_the_world),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
