// Splat, pull and push on scenes of a few points, against answers found by hand.
#include <math.h>
#include <string.h>

#include "gpu_test.h"
#include "render/proxy/splats.h"

static struct orl_gpu *gpu;

enum { SIDE = 40 };

// Looks along +z from the origin; pixel (x, y) sees the ray ((x + 0.5 - 20) / 40, ..., 1).
static struct orl_view front_view(void)
{
    return (struct orl_view){.camera = {.width = SIDE, .height = SIDE, .fx = 40, .fy = 40,
                                        .cx = 20, .cy = 20},
                             .cam_from_world = {.r = {{1, 0, 0}, {0, 1, 0}, {0, 0, 1}}}};
}

struct point {
    float x, y, z, radius;
    float normal[3];
};

enum { POINTS_MAX = 2048 }; // whole blocks

struct drawn {
    float depth[SIDE * SIDE], normal[SIDE * SIDE][4];
    uint32_t bits[SIDE * SIDE], index[SIDE * SIDE];
    uint32_t listed[POINTS_MAX]; // by the index a point is drawn with: its place in the list
};

static void read_order(const struct proxy *proxy, struct drawn *out)
{
    static uint8_t colors[POINTS_MAX][3];
    struct cloud *cloud = proxy->state;
    const struct point_chunk *chunk = &cloud->chunks[0];
    assert_true(chunk->count <= POINTS_MAX);
    assert_null(chunk->colors); // until they are asked for
    assert_int_equal(orl_cloud_bring_colors(gpu, cloud), ORL_OK);
    orl_buf_read(chunk->colors, (size_t)chunk->count * sizeof *colors, colors);
    for (int i = 0; i < chunk->count; i++)
        out->listed[i] = (uint32_t)colors[i][0] | (uint32_t)colors[i][1] << 8;
}

// near: of struct orl_scene; front_layer: the option
static void draw_with(const struct point *list, size_t count, const struct orl_view *view,
                      double near, float front_layer, struct drawn *out)
{
    struct orl_points points;
    assert_int_equal(orl_points_init(NULL, &points, count), ORL_OK);
    for (size_t i = 0; i < count; i++) {
        memcpy(points.position[i], &list[i].x, sizeof points.position[i]);
        memcpy(points.normal[i], list[i].normal, sizeof points.normal[i]);
        points.color[i][0] = (uint8_t)i; // for read_order
        points.color[i][1] = (uint8_t)(i >> 8);
        points.radius[i] = list[i].radius;
    }
    const struct orl_scene scene = {.points = points, .near_distance = near};
    const struct orl_render_params params = {.splat_scale = 1, .front_layer = front_layer};
    struct proxy proxy;
    struct surface surface;
    assert_int_equal(orl_proxy_create(gpu, &scene, &orl_proxy_splats, 0, &proxy), ORL_OK);
    assert_int_equal(orl_proxy_draw(gpu, &proxy, view, &params, true, &proxy.view_target, &surface),
                     ORL_OK);
    const struct splat_target *target = proxy.view_target;
    orl_tex_read(surface.depth, 0, GL_RED, GL_FLOAT, sizeof out->depth, out->depth);
    orl_tex_read(surface.normal, 0, GL_RGBA, GL_FLOAT, sizeof out->normal, out->normal);
    orl_tex_read(target->splat_depth, 0, GL_RED_INTEGER, GL_UNSIGNED_INT, sizeof out->bits,
                 out->bits);
    orl_tex_read(target->splat_index, 0, GL_RED_INTEGER, GL_UNSIGNED_INT, sizeof out->index,
                 out->index);
    read_order(&proxy, out);
    static float without_normals[SIDE * SIDE];
    assert_int_equal(orl_proxy_draw(gpu, &proxy, view, &params, false, &proxy.view_target, &surface),
                     ORL_OK);
    orl_tex_read(surface.depth, 0, GL_RED, GL_FLOAT, sizeof without_normals, without_normals);
    for (int i = 0; i < SIDE * SIDE; i++) // compilers round two programs differently
        assert_float_equal(without_normals[i], out->depth[i], 1e-6 * out->depth[i]);
    assert_int_equal(orl_gpu_finish(gpu), ORL_OK);
    orl_proxy_finish(gpu, &proxy);
    orl_points_finish(&points);
}

static void draw(const struct point *list, size_t count, const struct orl_view *view,
                 struct drawn *out)
{
    draw_with(list, count, view, 0, 0, out);
}

static int at(int x, int y)
{
    return y * SIDE + x;
}

// World position that projects to pixel coordinates (u, v) at depth z.
static struct point seen_at(double u, double v, double z, double radius)
{
    return (struct point){.x = (float)((u - 20) / 40 * z), .y = (float)((v - 20) / 40 * z),
                          .z = (float)z, .radius = (float)radius, .normal = {0, 0, -1}};
}

static void one_point_lands_in_its_pixel(void **state)
{
    (void)state;
    struct orl_view view = front_view();
    struct point p = seen_at(12.5, 30.5, 2, 0.001);
    static struct drawn d;
    draw(&p, 1, &view, &d);
    for (int i = 0; i < SIDE * SIDE; i++) {
        bool hit = i == at(12, 30);
        assert_int_equal(d.index[i], hit ? 0 : UINT32_MAX);
        // Push closes empty pixels up to 1.5 pixels around, and no others.
        double distance = hypot(i % SIDE - 12, i / SIDE - 30);
        if (hit || distance > 1.5)
            assert_float_equal(d.depth[i], hit ? 2 : 0, 1e-5);
    }
    float z;
    memcpy(&z, &d.bits[at(12, 30)], sizeof z);
    assert_float_equal(z, 2, 1e-6);
    assert_float_equal(d.normal[at(12, 30)][2], -1, 1e-2);
}

static void behind_and_outside_are_not_drawn(void **state)
{
    (void)state;
    struct orl_view view = front_view();
    struct point p[] = {seen_at(12.5, 30.5, -2, 0.1), seen_at(-0.5, 10, 2, 0.1),
                        seen_at(10, 40.01, 2, 0.1), seen_at(1e30, 10, 2, 0.1),
                        {.x = NAN, .y = 0, .z = 1, .radius = 1}};
    static struct drawn d;
    draw(p, ORL_COUNT(p), &view, &d);
    for (int i = 0; i < SIDE * SIDE; i++)
        assert_int_equal(d.index[i], UINT32_MAX);
}

// Discs of 3 and 2 pixels, more and less than a sixteenth of 40, near and far.
static void large_splats_near_the_viewer_are_outliers(void **state)
{
    (void)state;
    struct orl_view view = front_view();
    struct point p[] = {seen_at(5.5, 5.5, 1, 3.0 / 40), seen_at(15.5, 5.5, 1, 2.0 / 40),
                        seen_at(5.5, 25.5, 4, 4 * 3.0 / 40)};
    static struct drawn d;
    draw_with(p, ORL_COUNT(p), &view, 2, 0, &d);
    assert_float_equal(d.depth[at(5, 5)], 0, 0);
    assert_float_equal(d.depth[at(15, 5)], 1, 1e-5);
    assert_float_equal(d.depth[at(5, 25)], 4, 1e-4);
    draw_with(p, ORL_COUNT(p), &view, 0.5, 0, &d);
    assert_float_equal(d.depth[at(5, 5)], 1, 1e-5);
}

static void nearest_wins_and_ties_go_to_the_lowest_index(void **state)
{
    (void)state;
    struct orl_view view = front_view();
    struct point p[] = {seen_at(5.5, 5.5, 4, 0.001), seen_at(5.5, 5.5, 3, 0.001),
                        seen_at(9.5, 5.5, 2, 0.001), seen_at(9.5, 5.5, 2, 0.001),
                        seen_at(5.5, 5.5, 5, 0.001)};
    static struct drawn d;
    draw(p, ORL_COUNT(p), &view, &d);
    assert_int_equal(d.listed[d.index[at(5, 5)]], 1);
    uint32_t lowest = 0;
    while (d.listed[lowest] != 2 && d.listed[lowest] != 3)
        lowest++;
    assert_int_equal(d.index[at(9, 5)], lowest);
    assert_float_equal(d.depth[at(5, 5)], 3, 1e-5);
}

static void the_camera_pose_is_cam_from_world(void **state)
{
    (void)state;
    // The camera at x = 10 looking along -x: world -x is its z, world z is its x.
    const double eye[3] = {10, 0, 0}, target[3] = {0, 0, 0}, up[3] = {0, -1, 0};
    struct orl_view view = front_view();
    view.cam_from_world = orl_pose_look_at(eye, target, up);
    struct point p = {.x = 6, .y = 0, .z = 0, .radius = 0.01f, .normal = {1, 0, 0}};
    static struct drawn d;
    draw(&p, 1, &view, &d);
    assert_float_equal(d.depth[at(20, 20)], 4, 1e-4);
    assert_float_equal(d.normal[at(20, 20)][2], -1, 1e-2);
}

static void a_disc_fills_its_projection(void **state)
{
    (void)state;
    // Radius 0.25 at depth 2 projects to 5 pixels.
    struct orl_view view = front_view();
    struct point p = seen_at(20.5, 20.5, 2, 0.25);
    static struct drawn d;
    draw(&p, 1, &view, &d);
    for (int y = 0; y < SIDE; y++)
        for (int x = 0; x < SIDE; x++) {
            double distance = hypot(x - 20.0, y - 20.0);
            if (distance > 5.2)
                assert_float_equal(d.depth[at(x, y)], 0, 0);
            // Push reaches what the four coarser neighbours see: not all of the rim.
            if (distance < 2.5)
                assert_float_equal(d.depth[at(x, y)], 2, 1e-4);
        }
}

static void a_slanted_disc_is_narrow_and_keeps_its_plane(void **state)
{
    (void)state;
    // Normal turned 60 degrees about y: half as wide, depth falls along x.
    struct orl_view view = front_view();
    struct point p = seen_at(20.5, 20.5, 2, 0.3);
    p.normal[0] = (float)-sin(1.0471975512);
    p.normal[2] = (float)-cos(1.0471975512);
    static struct drawn d;
    draw(&p, 1, &view, &d);
    int wide = 0, high = 0;
    for (int i = 0; i < SIDE; i++) {
        wide += d.depth[at(i, 20)] > 0;
        high += d.depth[at(20, i)] > 0;
    }
    assert_true(high > wide);
    // Plane through (0.025, 0.025, 2): z = 2 - tan(60) (x - 0.025), met by the ray of x = 21.
    double ray = (21.5 - 20) / 40, slope = tan(1.0471975512);
    double z = (2 + slope * 0.025) / (1 + slope * ray);
    assert_true(d.depth[at(21, 20)] > 0);
    assert_float_equal(d.depth[at(21, 20)], z, 0.01);
}

// A plane of discs with every other point missing comes back closed and at its depth.
static void holes_between_splats_are_pushed_shut(void **state)
{
    (void)state;
    struct orl_view view = front_view();
    static struct point p[100];
    size_t count = 0;
    for (int y = 0; y < 10; y++)
        for (int x = 0; x < 10; x++)
            p[count++] = seen_at(8.5 + 3 * x, 8.5 + 3 * y, 2, 0.15);
    static struct drawn d;
    draw(p, count, &view, &d);
    for (int y = 9; y < 35; y++)
        for (int x = 9; x < 35; x++)
            assert_float_equal(d.depth[at(x, y)], 2, 1e-3);
    assert_float_equal(d.depth[at(2, 2)], 0, 0);
}

// Two discs that count as one surface: the pixels between them have the depth of a straight line
// between the middles of the coarser pixels.
static void depths_between_splats_are_interpolated(void **state)
{
    (void)state;
    struct orl_view view = front_view();
    const struct point p[] = {seen_at(18.5, 20.5, 2, 0.15), seen_at(21.5, 20.5, 2.1, 0.15)};
    static struct drawn d;
    draw(p, 2, &view, &d);
    assert_float_equal(d.depth[at(19, 20)], 2.025, 5e-3);
    assert_float_equal(d.depth[at(20, 20)], 2.075, 5e-3);
}

// A far wall of points shows through a near plane's gaps: the push must hide it there,
// and keep it where the near plane is not.
static void occluded_points_are_replaced(void **state)
{
    (void)state;
    struct orl_view view = front_view();
    static struct point p[POINTS_MAX];
    size_t count = 0;
    for (int y = 0; y < SIDE; y++)
        for (int x = 0; x < SIDE; x++)
            p[count++] = seen_at(x + 0.5, y + 0.5, 10, 0.3);
    for (int y = 0; y < 10; y++)
        for (int x = 0; x < 5; x++)
            p[count++] = seen_at(4.5 + 2 * x, 8.5 + 2 * y, 2, 0.12);
    static struct drawn d;
    draw(p, count, &view, &d);
    for (int y = 9; y < 26; y++)
        for (int x = 5; x < 12; x++)
            assert_float_equal(d.depth[at(x, y)], 2, 1e-3);
    for (int y = 0; y < SIDE; y++)
        for (int x = 20; x < SIDE; x++)
            assert_float_equal(d.depth[at(x, y)], 10, 1e-2);
}

// A wall without one of its splats, where a splat behind it is seen, and with a gap that shows many.
static void a_splat_seen_through_a_gap_is_covered(void **state)
{
    (void)state;
    static struct point p[SIDE * SIDE];
    for (int i = 0; i < SIDE * SIDE; i++) {
        int x = i % SIDE, y = i / SIDE;
        bool behind = (x == 10 && y == 10) || (x >= 24 && x < 32 && y >= 24 && y < 32);
        p[i] = seen_at(x + 0.5, y + 0.5, behind ? 8 : 4, behind ? 0.2 : 0.08);
    }
    struct orl_view view = front_view();
    static struct drawn kept, covered;
    draw_with(p, ORL_COUNT(p), &view, 0, 0, &kept);
    draw_with(p, ORL_COUNT(p), &view, 0, 0.01f, &covered);
    assert_float_equal(kept.depth[at(10, 10)], 8, 1e-3);
    assert_float_equal(covered.depth[at(10, 10)], 4, 1e-3);
    for (int y = 26; y < 30; y++)
        for (int x = 26; x < 30; x++)
            assert_float_equal(covered.depth[at(x, y)], 8, 1e-3);
}

// Before a wall, a pixel of one splat is an outlier, and nine side by side are a surface.
static void a_small_surface_stays(void **state)
{
    (void)state;
    static struct point p[SIDE * SIDE];
    for (int i = 0; i < SIDE * SIDE; i++) {
        int x = i % SIDE, y = i / SIDE;
        bool before = (x == 30 && y == 12) || (x >= 12 && x < 15 && y >= 30 && y < 33);
        p[i] = seen_at(x + 0.5, y + 0.5, before ? 2 : 4, before ? 0.001 : 0.08);
    }
    struct orl_view view = front_view();
    static struct drawn d;
    draw_with(p, ORL_COUNT(p), &view, 0, 0.01f, &d);
    assert_float_equal(d.depth[at(30, 12)], 0, 0);
    for (int i = 0; i < 9; i++)
        assert_float_equal(d.depth[at(12 + i % 3, 30 + i / 3)], 2, 1e-5);
    draw(p, ORL_COUNT(p), &view, &d);
    assert_float_equal(d.depth[at(30, 12)], 2, 1e-5); // as the papers have it
}

// Pixels that nothing wins are worked out for some point all the same, here one in the plane of
// the eye, and what comes out is thrown away.
static void points_beside_the_eye_leave_no_mark(void **state)
{
    (void)state;
    struct orl_view view = front_view();
    struct point p[200];
    for (size_t i = 0; i < ORL_COUNT(p); i++)
        p[i] = (struct point){.x = 1, .radius = 0.1f, .normal = {0, 0, -1}};
    p[77] = seen_at(20.5, 20.5, 2, 0.25);
    static struct drawn d;
    draw(p, ORL_COUNT(p), &view, &d);
    assert_int_not_equal(d.listed[0], 77);
    for (int y = 19; y <= 21; y++)
        for (int x = 19; x <= 21; x++)
            assert_float_equal(d.depth[at(x, y)], 2, 1e-4);
}

static void odd_sizes_lose_no_pixel(void **state)
{
    (void)state;
    struct orl_points points;
    enum { W = 37, H = 23 };
    assert_int_equal(orl_points_init(NULL, &points, W * H), ORL_OK);
    for (int i = 0; i < W * H; i++) {
        points.position[i][0] = (float)((i % W + 0.5 - 18.5) / 30);
        points.position[i][1] = (float)((i / W + 0.5 - 11.5) / 30);
        points.position[i][2] = 1;
        points.radius[i] = 0.05f;
    }
    struct orl_view view = {.camera = {.width = W, .height = H, .fx = 30, .fy = 30, .cx = 18.5,
                                       .cy = 11.5},
                            .cam_from_world = {.r = {{1, 0, 0}, {0, 1, 0}, {0, 0, 1}}}};
    const struct orl_scene scene = {.points = points};
    const struct orl_render_params params = {.splat_scale = 1};
    struct proxy proxy;
    struct surface surface;
    float depth[W * H];
    assert_int_equal(orl_proxy_create(gpu, &scene, &orl_proxy_splats, 0, &proxy), ORL_OK);
    assert_int_equal(orl_proxy_draw(gpu, &proxy, &view, &params, true, &proxy.view_target, &surface),
                     ORL_OK);
    orl_tex_read(surface.depth, 0, GL_RED, GL_FLOAT, sizeof depth, depth);
    for (int i = 0; i < W * H; i++)
        assert_float_equal(depth[i], 1, 1e-4);
    orl_proxy_finish(gpu, &proxy);
    orl_points_finish(&points);
}

int main(void)
{
    gpu = gpu_test_device();
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(one_point_lands_in_its_pixel),
        cmocka_unit_test(behind_and_outside_are_not_drawn),
        cmocka_unit_test(large_splats_near_the_viewer_are_outliers),
        cmocka_unit_test(nearest_wins_and_ties_go_to_the_lowest_index),
        cmocka_unit_test(the_camera_pose_is_cam_from_world),
        cmocka_unit_test(a_disc_fills_its_projection),
        cmocka_unit_test(a_slanted_disc_is_narrow_and_keeps_its_plane),
        cmocka_unit_test(holes_between_splats_are_pushed_shut),
        cmocka_unit_test(depths_between_splats_are_interpolated),
        cmocka_unit_test(occluded_points_are_replaced),
        cmocka_unit_test(a_splat_seen_through_a_gap_is_covered),
        cmocka_unit_test(a_small_surface_stays),
        cmocka_unit_test(points_beside_the_eye_leave_no_mark),
        cmocka_unit_test(odd_sizes_lose_no_pixel),
    };
    int failed = cmocka_run_group_tests_name("proxy", tests, NULL, NULL);
    orl_gpu_destroy(&gpu);
    return failed;
}
