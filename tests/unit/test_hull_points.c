// The visual hull closes what stereo leaves open: photographs around a ball, three quarters of which
// have points.
#include <math.h>

#include "preprocess/cloud/hull_points.h"
#include "test.h"

enum { SIDE = 96, RING = 12, ABOVE = 6, PHOTOS = RING + 2 * ABOVE };
static const double AWAY = 6, PIXELS = 200, TAU = 6.283185307179586;

struct fixture {
    struct orl_silhouette silhouettes[PHOTOS];
    struct orl_points points;
};

static double distance(const float a[3], double x, double y, double z)
{
    return sqrt(((double)a[0] - x) * ((double)a[0] - x) + ((double)a[1] - y) * ((double)a[1] - y) +
                ((double)a[2] - z) * ((double)a[2] - z));
}

// Marks the pixels whose rays meet a ball.
static void add_ball(struct orl_silhouette *s, double x, double y, double z, double radius)
{
    double eye[3], ray[3];
    orl_pose_centre(&s->view.cam_from_world, eye);
    const double to[3] = {x - eye[0], y - eye[1], z - eye[2]};
    for (int i = 0; i < SIDE * SIDE; i++) {
        orl_view_unproject(&s->view, i % SIDE + 0.5, (int)(i / SIDE) + 0.5, 1, ray);
        double along = 0, ray2 = 0, to2 = 0;
        for (int k = 0; k < 3; k++) {
            ray[k] -= eye[k];
            along += ray[k] * to[k];
            ray2 += ray[k] * ray[k];
            to2 += to[k] * to[k];
        }
        if (to2 - along * along / ray2 <= radius * radius)
            s->mask.u8[i] = 255;
    }
}

static void add_point(struct orl_points *points, double x, double y, double z)
{
    points->photographs[points->count] = 2;
    float *p = points->position[points->count++];
    p[0] = (float)x, p[1] = (float)y, p[2] = (float)z;
}

// The upper three quarters of the ball, in steps that are finer than the voxels and a pixel within
// the outlines.
static int set_up(void **state)
{
    enum { STEPS = 160 };
    struct fixture *f = calloc(1, sizeof *f);
    assert_non_null(f);
    for (int i = 0; i < PHOTOS; i++) {
        double turn = TAU * i / (i < RING ? RING : ABOVE);
        double high = i < RING ? 0 : i < RING + ABOVE ? 0.7 : -0.7;
        const double eye[3] = {AWAY * cos(turn) * cos(high), AWAY * sin(turn) * cos(high),
                               AWAY * sin(high)};
        struct orl_silhouette *s = &f->silhouettes[i];
        s->view = (struct orl_view){{SIDE, SIDE, PIXELS, PIXELS, 0.5 * SIDE, 0.5 * SIDE},
                                    orl_pose_look_at(eye, (double[3]){0}, (double[3]){0, 0, 1})};
        assert_int_equal(orl_image_init(NULL, &s->mask, SIDE, SIDE, 1, ORL_PIXEL_U8), ORL_OK);
        add_ball(s, 0, 0, 0, 1);
    }
    assert_int_equal(orl_points_init(NULL, &f->points, STEPS * STEPS), ORL_OK);
    f->points.count = 0;
    for (int i = -STEPS / 12; i < STEPS / 4; i++)
        for (int k = 0; k < STEPS; k++) {
            double up = 0.25 * TAU * i / (0.25 * STEPS), turn = TAU * k / STEPS;
            add_point(&f->points, 0.95 * cos(turn) * cos(up), 0.95 * sin(turn) * cos(up),
                      0.95 * sin(up));
        }
    *state = f;
    return 0;
}

static int tear_down(void **state)
{
    struct fixture *f = *state;
    for (int i = 0; i < PHOTOS; i++)
        orl_image_finish(&f->silhouettes[i].mask);
    orl_points_finish(&f->points);
    free(f);
    return 0;
}

static void begin(const struct fixture *f, struct orl_hull_points *hull)
{
    assert_int_equal(orl_hull_points_begin(NULL, f->silhouettes, PHOTOS, &f->points, 0, hull),
                     ORL_OK);
}

// Closes the points without depth maps; the first new point.
static size_t close_points(struct fixture *f)
{
    struct orl_hull_points hull;
    size_t added;
    begin(f, &hull);
    assert_int_equal(orl_hull_points_end(NULL, &hull, &f->points, &added), ORL_OK);
    orl_hull_points_finish(&hull);
    return added;
}

static void the_open_part_is_closed(void **state)
{
    struct fixture *f = *state;
    size_t before = f->points.count, first = close_points(f);
    assert_int_equal(first, before);
    assert_true(f->points.count > first + 500);
    double sum[2] = {0};
    for (size_t i = first; i < f->points.count; i++) {
        const float *p = f->points.position[i], *n = f->points.normal[i];
        double from = distance(p, 0, 0, 0);
        sum[0] += (double)p[0];
        sum[1] += (double)p[1];
        // The hull of these cameras reaches 9 % past the ball at most, and voxels are 0.06 wide.
        assert_true(from > 0.94 && from < 1.15);
        assert_true((double)(p[0] * n[0] + p[1] * n[1] + p[2] * n[2]) > 0.8 * from);
    }
    // Mirrored at x = 0 or at y = 0, ball and cameras are the same.
    assert_float_equal(sum[0], 0, 1e-3);
    assert_float_equal(sum[1], 0, 1e-3);
    for (int k = 0; k < 24; k++) {
        double nearest = INFINITY, turn = TAU * k / 24, up = -0.6 - 0.03 * k;
        for (size_t i = first; i < f->points.count; i++)
            nearest = fmin(nearest, distance(f->points.position[i], cos(turn) * cos(up),
                                             sin(turn) * cos(up), sin(up)));
        assert_true(nearest < 0.15);
    }
}

static void strays_go_and_what_stands_apart_stays(void **state)
{
    struct fixture *f = *state;
    add_point(&f->points, 0, 0, 1.2); // a stray above the ball
    add_point(&f->points, 0, 2, -0.5); // what stands beside it: seen, outside all silhouettes
    size_t first = close_points(f), strays = 0, apart = 0;
    for (size_t i = 0; i < f->points.count; i++) {
        strays += distance(f->points.position[i], 0, 0, 1.2) < 1e-3;
        apart += distance(f->points.position[i], 0, 2, -0.5) < 1e-3 && i < first;
    }
    assert_int_equal(strays, 0);
    assert_int_equal(apart, 1);
}

// The camera at +x sees a hole into the ball, as deep as its middle.
static void what_a_map_sees_through_is_not_closed(void **state)
{
    struct fixture *f = *state;
    struct orl_hull_points hull;
    size_t added, before = 0, after = 0;
    struct orl_depth_map map = {.view = f->silhouettes[0].view};
    assert_int_equal(orl_image_init(NULL, &map.depth, SIDE, SIDE, 1, ORL_PIXEL_F32), ORL_OK);
    for (int i = 0; i < SIDE * SIDE; i++) {
        double across = hypot(i % SIDE + 0.5 - 0.5 * SIDE, (int)(i / SIDE) + 0.5 - 0.5 * SIDE);
        map.depth.f32[i] = across < 12 ? (float)AWAY : 0;
    }
    begin(f, &hull);
    orl_hull_points_see(&hull, 0, &map);
    assert_int_equal(orl_hull_points_end(NULL, &hull, &f->points, &added), ORL_OK);
    orl_hull_points_finish(&hull);
    for (size_t i = added; i < f->points.count; i++) { // within 0.2 of the hole's axis
        const float *p = f->points.position[i];
        bool hole = hypot((double)p[1], (double)p[2]) < 0.2;
        before += hole && p[0] > 0.5f;
        after += hole && fabs((double)p[0]) < 0.2;
    }
    assert_int_equal(before, 0);
    assert_true(after > 4);
    orl_image_finish(&map.depth);
}

// The points of the hull that belong to a small ball beside the large one.
static size_t count_beside(const struct fixture *f, size_t first)
{
    size_t count = 0;
    for (size_t i = first; i < f->points.count; i++)
        count += distance(f->points.position[i], 1.05, 0, 1.05) < 0.3;
    return count;
}

// A second part in all silhouettes, of which stereo has found nothing, may be chance.
static void parts_without_points_are_left_out(void **state)
{
    struct fixture *f = *state;
    for (int i = 0; i < PHOTOS; i++)
        add_ball(&f->silhouettes[i], 1.05, 0, 1.05, 0.2);
    size_t first = close_points(f);
    assert_true(f->points.count > first);
    assert_int_equal(count_beside(f, first), 0);
}

// With a point of its own it stays.
static void parts_with_points_are_closed(void **state)
{
    struct fixture *f = *state;
    for (int i = 0; i < PHOTOS; i++)
        add_ball(&f->silhouettes[i], 1.05, 0, 1.05, 0.2);
    add_point(&f->points, 1.05, 0, 1.05);
    assert_true(count_beside(f, close_points(f)) > 20);
}

static void points_that_silhouettes_exclude_make_no_hull(void **state)
{
    struct fixture *f = *state;
    struct orl_hull_points hull;
    size_t before = f->points.count;
    begin(f, &hull);
    assert_true(hull.outside_share < 0.01);
    orl_hull_points_finish(&hull);
    memset(f->silhouettes[3].mask.u8, 0, SIDE * SIDE);
    begin(f, &hull);
    assert_true(hull.outside_share > 0.99);
    orl_hull_points_finish(&hull);
    memset(f->points.photographs, 1, before);
    begin(f, &hull);
    assert_true(hull.outside_share < 0.01); // on which no second photograph agrees
    orl_hull_points_finish(&hull);
    memset(f->points.photographs, 2, before);
    assert_int_equal(close_points(f), before);
    assert_int_equal(f->points.count, before);
}

// Two beads of a pixel and a half: voxels of them are left, but no surface once these are smoothed.
static void what_is_thinner_than_the_voxels_stays_as_it_is(void **state)
{
    struct fixture *f = *state;
    f->points.count = 0;
    for (int side = -1; side <= 1; side += 2)
        add_point(&f->points, 0.69 * side, 0, 0);
    for (int i = 0; i < PHOTOS; i++) {
        memset(f->silhouettes[i].mask.u8, 0, SIDE * SIDE);
        add_ball(&f->silhouettes[i], 0.69, 0, 0, 0.05);
        add_ball(&f->silhouettes[i], -0.69, 0, 0, 0.05);
    }
    assert_int_equal(close_points(f), 2);
    assert_int_equal(f->points.count, 2);
}

static void voxels_fit_in_memory(void **state)
{
    const struct fixture *f = *state;
    struct orl_hull_points hull;
    assert_int_equal(orl_hull_points_begin(NULL, f->silhouettes, PHOTOS, &f->points,
                                           (size_t)14 * 40 * 40 * 40, &hull), ORL_OK);
    assert_true(hull.cube.side >= 39 && hull.cube.side <= 40);
    orl_hull_points_finish(&hull);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test_setup_teardown(the_open_part_is_closed, set_up, tear_down),
        cmocka_unit_test_setup_teardown(strays_go_and_what_stands_apart_stays, set_up, tear_down),
        cmocka_unit_test_setup_teardown(what_a_map_sees_through_is_not_closed, set_up, tear_down),
        cmocka_unit_test_setup_teardown(parts_without_points_are_left_out, set_up, tear_down),
        cmocka_unit_test_setup_teardown(parts_with_points_are_closed, set_up, tear_down),
        cmocka_unit_test_setup_teardown(voxels_fit_in_memory, set_up, tear_down),
        cmocka_unit_test_setup_teardown(what_is_thinner_than_the_voxels_stays_as_it_is, set_up,
                                        tear_down),
        cmocka_unit_test_setup_teardown(points_that_silhouettes_exclude_make_no_hull, set_up,
                                        tear_down),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
