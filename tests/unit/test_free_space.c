// Points in mid-air, which photographs look through.
#include <string.h>
#include <time.h>

#include "scene/free_space.h"
#include "test.h"

enum { SIDE = 40, POLE = 60, STRAYS = 5, VIEWS = 4 };

// Cameras side by side that look along z.
static void place(struct orl_view views[VIEWS])
{
    for (int i = 0; i < VIEWS; i++)
        views[i] = (struct orl_view){
            .camera = {.width = 128, .height = 96, .fx = 100, .fy = 100, .cx = 64, .cy = 48},
            .cam_from_world = {.r = {{1, 0, 0}, {0, 1, 0}, {0, 0, 1}}, .t = {0.2 * i - 0.3, 0, 0}}};
}

static void add(struct orl_points *points, double x, double y, double z, uint8_t what)
{
    float *to = points->position[points->count];
    to[0] = (float)x;
    to[1] = (float)y;
    to[2] = (float)z;
    points->color[points->count++][0] = what;
}

// A wall (1), a thin pole before it (2), and single points in mid-air (3).
static void make(struct orl_points *points)
{
    assert_int_equal(orl_points_init(NULL, points, SIDE * SIDE + POLE + STRAYS), ORL_OK);
    points->count = 0;
    for (int i = 0; i < SIDE * SIDE; i++)
        add(points, 0.1 * (i % SIDE) - 2, 0.1 * (i / SIDE) - 2, 4, 1);
    for (int i = 0; i < POLE; i++)
        add(points, 0.5, 0.05 * i - 1.5, 3, 2);
    for (int i = 0; i < STRAYS; i++)
        add(points, 0.25 * i - 0.5, 0.2 * i - 0.4, 1.5 + 0.2 * i, 3);
}

static size_t count(const struct orl_points *points, uint8_t what)
{
    size_t sum = 0;
    for (size_t i = 0; i < points->count; i++)
        sum += points->color[i][0] == what;
    return sum;
}

static void drops_what_photographs_look_through(void **state)
{
    (void)state;
    struct orl_view views[VIEWS];
    struct orl_points points;
    place(views);
    make(&points);
    assert_int_equal(orl_points_drop_in_free_space(NULL, NULL, views, VIEWS, &points), ORL_OK);
    assert_int_equal(count(&points, 1), SIDE * SIDE);
    assert_int_equal(count(&points, 2), POLE);
    assert_int_equal(count(&points, 3), 0);
    orl_points_finish(&points);
}

// Fusion has compared with depth maps what it knows the photographs of.
static void keeps_what_photographs_agree_on(void **state)
{
    (void)state;
    struct orl_view views[VIEWS];
    struct orl_points points;
    place(views);
    make(&points);
    size_t all = points.count;
    memset(points.photographs, 2, all - 1);
    assert_int_equal(orl_points_drop_in_free_space(NULL, NULL, views, VIEWS, &points), ORL_OK);
    assert_int_equal(points.count, all - 1);
    assert_int_equal(count(&points, 3), STRAYS - 1);
    orl_points_finish(&points);
}

// One photograph is no proof, a sparse cloud shows nothing behind a point, and what no photograph
// has in its frame stays.
static void keeps_what_it_cannot_tell(void **state)
{
    (void)state;
    struct orl_view views[VIEWS];
    struct orl_points points;
    place(views);
    make(&points);
    size_t all = points.count;
    assert_int_equal(orl_points_drop_in_free_space(NULL, NULL, views, 1, &points), ORL_OK);
    assert_int_equal(points.count, all);
    for (int i = 0; i < VIEWS; i++)
        views[i].cam_from_world.t[2] = -10; // beyond all points
    assert_int_equal(orl_points_drop_in_free_space(NULL, NULL, views, VIEWS, &points), ORL_OK);
    assert_int_equal(points.count, all);
    points.count = 0;
    place(views);
    for (int i = 0; i < 7; i++)
        add(&points, 0.1 * i, 0, 4, 1);
    add(&points, 0, 0, 2, 3);
    assert_int_equal(orl_points_drop_in_free_space(NULL, NULL, views, VIEWS, &points), ORL_OK);
    assert_int_equal(points.count, 8);
    points.count = 0;
    assert_int_equal(orl_points_drop_in_free_space(NULL, NULL, views, VIEWS, &points), ORL_OK);
    orl_points_finish(&points);
}

static bool always(void *priv)
{
    (void)priv;
    return true;
}

static void stops_when_asked(void **state)
{
    (void)state;
    const struct orl_progress progress = {.cancelled = always};
    struct orl_view views[VIEWS];
    struct orl_points points;
    place(views);
    make(&points);
    size_t all = points.count;
    assert_int_equal(orl_points_drop_in_free_space(NULL, &progress, views, VIEWS, &points),
                     ORL_ERR_CANCELLED);
    assert_int_equal(points.count, all);
    orl_points_finish(&points);
}

// Points that crowd in one pixel take time as their number.
static double seconds_of_a_crowd(int count)
{
    struct orl_view views[VIEWS];
    struct orl_points points;
    struct timespec from, to;
    place(views);
    assert_int_equal(orl_points_init(NULL, &points, (size_t)count), ORL_OK);
    points.count = 0;
    for (int i = 0; i < count; i++)
        add(&points, 0, 0, 4, 1);
    clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &from);
    assert_int_equal(orl_points_drop_in_free_space(NULL, NULL, views, VIEWS, &points), ORL_OK);
    clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &to);
    assert_int_equal(points.count, count);
    orl_points_finish(&points);
    return (double)(to.tv_sec - from.tv_sec) + 1e-9 * (double)(to.tv_nsec - from.tv_nsec);
}

static void crowds_take_their_number(void **state)
{
    (void)state;
    test_grows_in_proportion(seconds_of_a_crowd);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(drops_what_photographs_look_through),
        cmocka_unit_test(keeps_what_photographs_agree_on),
        cmocka_unit_test(keeps_what_it_cannot_tell),
        cmocka_unit_test(stops_when_asked),
        cmocka_unit_test(crowds_take_their_number),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
