// Radii and normals against brute force and known surfaces.
#include <math.h>
#include <string.h>
#include <time.h>

#include "core/order.h"
#include "scene/nearest_points.h"
#include "scene/radius_limits.h"
#include "test.h"

static double random_unit(uint32_t *state)
{
    *state = *state * 1664525u + 1013904223u;
    return (*state >> 8) / 16777216.0;
}

static struct orl_view view_from(const double eye[3])
{
    struct orl_view view = {.cam_from_world.r = {{1, 0, 0}, {0, 1, 0}, {0, 0, 1}}};
    orl_pose_set_centre(&view.cam_from_world, eye);
    return view;
}

static double distance(const float a[3], const float b[3])
{
    double d2 = 0;
    for (int k = 0; k < 3; k++)
        d2 += ((double)a[k] - (double)b[k]) * ((double)a[k] - (double)b[k]);
    return sqrt(d2);
}

static void agrees_with_brute_force(void **state)
{
    (void)state;
    enum { COUNT = 400, K = 6 };
    struct orl_points points;
    assert_int_equal(orl_points_init(NULL, &points, COUNT), ORL_OK);
    uint32_t seed = 7;
    for (int i = 0; i < COUNT; i++)
        for (int k = 0; k < 3; k++)
            points.position[i][k] = (float)random_unit(&seed);
    const struct orl_radii_params params = {.neighbours = K, .overlap = 1.5f};
    assert_int_equal(orl_points_set_radii(NULL, NULL, &params, NULL, 0, &points), ORL_OK);
    for (int i = 0; i < COUNT; i++) {
        double all[COUNT];
        for (int j = 0; j < COUNT; j++)
            all[j] = distance(points.position[i], points.position[j]);
        qsort(all, COUNT, sizeof *all, orl_order_doubles); // the point itself is all[0]
        assert_float_equal(points.radius[i], 1.5 * all[K], 1e-5);
    }
    orl_points_finish(&points);
}

static void of_a_heap_a_few_are_searched(void **state)
{
    (void)state;
    static const int kept[5] = {0, 1, 2, 3, 9}; // three at the origin, and the two others
    struct orl_points points;
    struct few_alike few;
    assert_int_equal(orl_points_init(NULL, &points, 10), ORL_OK);
    points.position[3][1] = points.position[9][2] = 1;
    assert_int_equal(orl_points_few_alike(NULL, &points, 3, &few), ORL_OK);
    assert_int_equal(few.count, 5);
    for (int i = 0; i < 5; i++) {
        assert_int_equal(few.index[i], kept[i]);
        assert_memory_equal(few.position[i], points.position[kept[i]], sizeof few.position[i]);
    }
    orl_few_alike_finish(&few);
    orl_points_finish(&points);
}

// Depth cameras write a miss as 0, 0, 0. The search is exact beside such a heap, also for those
// that coincide with fewer points than they have neighbours.
static void a_heap_changes_no_other_radius(void **state)
{
    (void)state;
    enum { COUNT = 300, HEAP = 5000, K = 6 };
    struct orl_points alone, points;
    assert_int_equal(orl_points_init(NULL, &alone, COUNT), ORL_OK);
    assert_int_equal(orl_points_init(NULL, &points, COUNT + HEAP), ORL_OK);
    uint32_t seed = 7;
    for (int i = 0; i < COUNT; i++)
        for (int k = 0; k < 3; k++)
            alone.position[i][k] = points.position[HEAP + i][k] = (float)random_unit(&seed) + 9;
    for (int i = 1; i < 6; i++) { // six at one place
        memcpy(alone.position[i], alone.position[0], sizeof alone.position[0]);
        memcpy(points.position[HEAP + i], alone.position[0], sizeof alone.position[0]);
    }
    points.position[3][0] = -0.0f;
    const struct orl_radii_params params = {.neighbours = K, .overlap = 1};
    assert_int_equal(orl_points_set_radii(NULL, NULL, &params, NULL, 0, &alone), ORL_OK);
    assert_int_equal(orl_points_set_radii(NULL, NULL, &params, NULL, 0, &points), ORL_OK);
    for (int i = 0; i < COUNT; i++)
        assert_float_equal(points.radius[HEAP + i], alone.radius[i], 1e-6);
    for (int i = 6; i < COUNT; i++) { // each has a plane of its own
        double cosine = 0;
        for (int k = 0; k < 3; k++)
            cosine += (double)points.normal[HEAP + i][k] * (double)alone.normal[i][k];
        assert_float_equal(fabs(cosine), 1, 1e-3);
    }
    int found[COUNT];
    float dist2[COUNT];
    assert_int_equal(orl_points_nearest(NULL, &points, &alone, found, dist2), ORL_OK);
    for (int i = 0; i < COUNT; i++)
        assert_int_equal(found[i], HEAP + (i < 6 ? 0 : i));
    assert_true(points.radius[HEAP] > 0 && points.radius[0] > 0);
    orl_points_finish(&alone);
    orl_points_finish(&points);
}

static double seconds_of_a_heap(int count)
{
    struct orl_points heap, queries;
    struct timespec from, to;
    int *found = calloc((size_t)count, sizeof *found);
    float *dist2 = calloc((size_t)count, sizeof *dist2);
    assert_true(found && dist2);
    assert_int_equal(orl_points_init(NULL, &heap, (size_t)count), ORL_OK);
    assert_int_equal(orl_points_init(NULL, &queries, (size_t)count), ORL_OK);
    clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &from);
    assert_int_equal(orl_points_set_radii(NULL, NULL, &(struct orl_radii_params){ORL_RADII_DEFAULTS},
                                          NULL, 0, &heap), ORL_OK);
    assert_int_equal(orl_points_nearest(NULL, &heap, &queries, found, dist2), ORL_OK);
    clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &to);
    orl_points_finish(&heap);
    orl_points_finish(&queries);
    free(found);
    free(dist2);
    return (double)(to.tv_sec - from.tv_sec) + 1e-9 * (double)(to.tv_nsec - from.tv_nsec);
}

static void identical_points_take_their_number(void **state)
{
    (void)state;
    test_grows_in_proportion(seconds_of_a_heap);
}

// Planes across each axis.
static void normals_of_upright_planes(void **state)
{
    (void)state;
    enum { SIDE = 8 };
    for (int axis = 0; axis < 3; axis++) {
        struct orl_points points;
        double eye[3] = {3, 3, 3};
        eye[axis] = 20;
        const struct orl_view view = view_from(eye);
        assert_int_equal(orl_points_init(NULL, &points, SIDE * SIDE), ORL_OK);
        for (int i = 0; i < SIDE * SIDE; i++) {
            points.position[i][(axis + 1) % 3] = (float)(i % SIDE);
            points.position[i][(axis + 2) % 3] = (float)(i / SIDE);
        }
        const struct orl_radii_params params = {ORL_RADII_DEFAULTS};
        assert_int_equal(orl_points_set_radii(NULL, NULL, &params, &view, 1, &points), ORL_OK);
        for (int i = 0; i < SIDE * SIDE; i++)
            assert_float_equal(points.normal[i][axis], 1, 1e-5);
        orl_points_finish(&points);
    }
}

// A tilted plane: each missing normal is its own, towards the nearest viewer; one
// that is there stays.
static void fits_normals(void **state)
{
    (void)state;
    enum { SIDE = 20 };
    struct orl_points points;
    assert_int_equal(orl_points_init(NULL, &points, SIDE * SIDE), ORL_OK);
    const double n[3] = {0.6, 0, -0.8};
    for (int i = 0; i < SIDE * SIDE; i++) {
        double u = i % SIDE, v = (double)(i / SIDE);
        points.position[i][0] = (float)(0.8 * u + 100);
        points.position[i][1] = (float)v;
        points.position[i][2] = (float)(0.6 * u);
    }
    points.normal[5][1] = 1;
    const struct orl_view views[2] = {view_from((double[]){108 + 30 * n[0], 10, 6 + 30 * n[2]}),
                                      view_from((double[]){108 - 900 * n[0], 10, 6 - 900 * n[2]})};
    const struct orl_radii_params params = {ORL_RADII_DEFAULTS};
    assert_int_equal(orl_points_set_radii(NULL, NULL, &params, views, 2, &points), ORL_OK);
    for (int i = 0; i < SIDE * SIDE; i++) {
        if (i == 5)
            continue;
        double cosine = 0;
        for (int k = 0; k < 3; k++)
            cosine += n[k] * (double)points.normal[i][k];
        assert_float_equal(cosine, 1, 1e-5);
    }
    assert_float_equal(points.normal[5][1], 1, 0);
    // Inside the grid of unit spacing the sixth neighbour is a diagonal one.
    assert_float_equal(points.radius[SIDE * 10 + 10], sqrt(2), 1e-4);
    orl_points_finish(&points);
}

static void gives_coinciding_points_the_median(void **state)
{
    (void)state;
    enum { PILE = 10, LINE = 21 };
    struct orl_points points;
    assert_int_equal(orl_points_init(NULL, &points, PILE + LINE), ORL_OK);
    for (int i = 0; i < LINE; i++)
        points.position[PILE + i][0] = 1000 + (float)i;
    const struct orl_radii_params params = {.neighbours = 2, .overlap = 1};
    assert_int_equal(orl_points_set_radii(NULL, NULL, &params, NULL, 0, &points), ORL_OK);
    for (int i = 0; i < PILE; i++)
        assert_float_equal(points.radius[i], 1, 0);
    orl_points_finish(&points);
}

// FLANN would read an index that it never wrote.
static void drops_points_beyond_the_world(void **state)
{
    (void)state;
    const float far[] = {1e19f, -3e38f, INFINITY, NAN};
    for (size_t f = 0; f < ORL_COUNT(far); f++) {
        struct orl_points points;
        struct said said;
        struct orl_log log = log_to(&said);
        assert_int_equal(orl_points_init(NULL, &points, 40), ORL_OK);
        for (size_t i = 0; i < 40; i++)
            points.position[i][0] = i % 4 == 3 ? far[f] : (float)i;
        const struct orl_radii_params params = {ORL_RADII_DEFAULTS};
        assert_int_equal(orl_points_set_radii(&log, NULL, &params, NULL, 0, &points), ORL_OK);
        assert_int_equal(points.count, 30);
        assert_non_null(strstr(said.text, "10 of 40 points"));
        for (size_t i = 0; i < points.count; i++)
            assert_true(points.radius[i] > 0 && points.radius[i] < 20);
        orl_points_finish(&points);
    }
}

static void takes_few_points(void **state)
{
    (void)state;
    const struct orl_radii_params params = {ORL_RADII_DEFAULTS};
    const struct orl_view view = view_from((double[]){0, 0, -10});
    for (size_t count = 0; count < 4; count++) {
        struct orl_points points;
        assert_int_equal(orl_points_init(NULL, &points, count), ORL_OK);
        for (size_t i = 0; i < count; i++)
            points.position[i][0] = 3 * (float)i;
        assert_int_equal(orl_points_set_radii(NULL, NULL, &params, &view, 1, &points), ORL_OK);
        for (size_t i = 0; i < count; i++) {
            assert_true(points.radius[i] > 0 && isfinite(points.radius[i]));
            double length = 0;
            for (int k = 0; k < 3; k++)
                length += (double)points.normal[i][k] * (double)points.normal[i][k];
            assert_float_equal(length, 1, 1e-5);
        }
        if (count == 2) // the only neighbour counts when there are not six
            assert_float_equal(points.radius[0], 3, 1e-6);
        orl_points_finish(&points);
    }
}

static void limits_radii_by_pixels(void **state)
{
    (void)state;
    // Seen from 1 and 4 units away with a focal length of 100: a radius of 0.1 is ten
    // pixels in the nearer photograph.
    struct orl_view views[2] = {{{64, 64, 100, 100, 32, 32}, {{{1, 0, 0}, {0, 1, 0}, {0, 0, 1}},
                                                              {0, 0, 1}}},
                                {{64, 64, 100, 100, 32, 32}, {{{1, 0, 0}, {0, 1, 0}, {0, 0, 1}},
                                                              {0, 0, 4}}}};
    struct orl_points points;
    enum { FINE = 10 }; // points of the cloud that the others are judged by, one pixel each
    assert_int_equal(orl_points_init(NULL, &points, 5 + FINE), ORL_OK);
    for (int i = 5; i < 5 + FINE; i++)
        points.radius[i] = 0.01f;
    const float radii[5] = {0.05f, 0.1f, 0.3f, 0.07f, 500};
    for (int i = 0; i < 5; i++) {
        points.radius[i] = radii[i];
        points.color[i][0] = (uint8_t)(10 + i);
    }
    points.position[4][0] = 1000; // in no photograph's frame
    const struct orl_radii_limits limits = {.largest_px = 6, .isolated_px = 20};
    assert_int_equal(orl_points_limit_radii(NULL, &limits, views, 2, &points), ORL_OK);
    assert_int_equal(points.count, 4 + FINE);
    const float expected[4] = {0.05f, 0.06f, 0.06f, 500};
    const uint8_t colors[4] = {10, 11, 13, 14};
    for (int i = 0; i < 4; i++) {
        assert_float_equal(points.radius[i], expected[i], 1e-6);
        assert_int_equal(points.color[i][0], colors[i]);
    }
    orl_points_finish(&points);
}

// A cloud of one point for every hundred pixels is thin, not made of outliers.
static void a_sparse_cloud_stays(void **state)
{
    (void)state;
    enum { POINTS = 50 };
    const struct orl_view view = {{64, 64, 100, 100, 32, 32},
                                  {{{1, 0, 0}, {0, 1, 0}, {0, 0, 1}}, {0, 0, 1}}};
    const struct orl_radii_limits limits = {ORL_RADII_LIMITS_DEFAULTS};
    struct orl_points points;
    assert_int_equal(orl_points_init(NULL, &points, POINTS), ORL_OK);
    for (int i = 0; i < POINTS; i++)
        points.radius[i] = 0.2f; // 20 pixels
    points.radius[0] = 5;
    assert_int_equal(orl_points_limit_radii(NULL, &limits, &view, 1, &points), ORL_OK);
    assert_int_equal(points.count, POINTS - 1);
    for (size_t i = 0; i < points.count; i++)
        assert_float_equal(points.radius[i], 0.2f, 1e-6);
    orl_points_finish(&points);
}

// A wall of points a unit apart, seen at five pixels to the unit, and one point before it.
static void set_wall(const struct orl_radii_params *params, struct orl_points *points)
{
    enum { SIDE = 12 };
    const struct orl_view view = {{64, 64, 100, 100, 2, 2},
                                  {{{1, 0, 0}, {0, 1, 0}, {0, 0, 1}}, {0, 0, 20}}};
    const struct orl_radii_limits limits = orl_radii_limits_of(params);
    assert_int_equal(orl_points_init(NULL, points, SIDE * SIDE + 1), ORL_OK);
    for (int i = 0; i < SIDE * SIDE; i++) {
        points->position[i][0] = (float)(i % SIDE);
        points->position[i][1] = (float)(i / SIDE);
    }
    points->position[SIDE * SIDE][2] = -10;
    assert_int_equal(orl_points_set_radii(NULL, NULL, params, NULL, 0, points), ORL_OK);
    assert_int_equal(orl_points_limit_radii(NULL, &limits, &view, 1, points), ORL_OK);
    assert_int_equal(points->count, SIDE * SIDE); // the one before it stands alone
}

// The overlap and the neighbours change sizes, not which points are isolated.
// In a cloud whose points are large, as the median of their sizes tells, larger ones stay.
static void limits_follow_the_median(void **state)
{
    (void)state;
    const struct orl_view view = {{64, 64, 100, 100, 32, 32},
                                  {{{1, 0, 0}, {0, 1, 0}, {0, 0, 1}}, {0, 0, 1}}};
    const struct orl_radii_limits limits = {.largest_px = 6, .isolated_px = 20, .typical = 3};
    struct orl_points points;
    assert_int_equal(orl_points_init(NULL, &points, 7), ORL_OK);
    for (int i = 0; i < 7; i++)
        points.radius[i] = i == 0 ? 0.001f : i == 6 ? 0.25f : 0.1f; // 0.1, 10 and 25 pixels
    assert_int_equal(orl_points_limit_radii(NULL, &limits, &view, 1, &points), ORL_OK);
    assert_int_equal(points.count, 7);
    assert_float_equal(points.radius[6], 0.25, 1e-6); // up to 3 times the median of 10
    orl_points_finish(&points);
}

static void limits_follow_the_overlap(void **state)
{
    (void)state;
    const struct orl_radii_params usual = {ORL_RADII_DEFAULTS};
    const struct orl_radii_limits limits = orl_radii_limits_of(&usual);
    assert_float_equal(limits.largest_px, 9, 0);
    assert_float_equal(limits.isolated_px, 16, 0);
    const struct orl_radii_limits wide = orl_radii_limits_of(
        &(struct orl_radii_params){4 * usual.neighbours, 3 * usual.overlap, false});
    assert_float_equal(wide.largest_px, 2 * 3 * 9, 1e-4);
    assert_float_equal(wide.isolated_px, 2 * 3 * 16, 1e-4);
    const float overlaps[] = {0.25f, 1, 4};
    struct orl_points all;
    set_wall(&usual, &all);
    for (size_t n = 0; n < ORL_COUNT(overlaps); n++) {
        struct orl_points points;
        set_wall(&(struct orl_radii_params){usual.neighbours, overlaps[n], false}, &points);
        for (size_t i = 0; i < points.count; i++)
            assert_float_equal(points.radius[i], overlaps[n] * all.radius[i], 0);
        orl_points_finish(&points);
    }
    struct orl_points points;
    set_wall(&(struct orl_radii_params){24, 1, false}, &points); // five by five points of the grid
    assert_float_equal(points.radius[12 * 6 + 6], 2 * sqrt(2), 1e-5);
    orl_points_finish(&points);
    orl_points_finish(&all);
}

static bool always(void *priv)
{
    (void)priv;
    return true;
}

static void stops_when_cancelled(void **state)
{
    (void)state;
    struct orl_points points;
    assert_int_equal(orl_points_init(NULL, &points, 10), ORL_OK);
    const struct orl_radii_params params = {ORL_RADII_DEFAULTS};
    const struct orl_progress progress = {.cancelled = always};
    assert_int_equal(orl_points_set_radii(NULL, &progress, &params, NULL, 0, &points),
                     ORL_ERR_CANCELLED);
    orl_points_finish(&points);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(of_a_heap_a_few_are_searched),
        cmocka_unit_test(agrees_with_brute_force),
        cmocka_unit_test(a_heap_changes_no_other_radius),
        cmocka_unit_test(identical_points_take_their_number),
        cmocka_unit_test(fits_normals),
        cmocka_unit_test(normals_of_upright_planes),
        cmocka_unit_test(limits_follow_the_median),
        cmocka_unit_test(gives_coinciding_points_the_median),
        cmocka_unit_test(drops_points_beyond_the_world),
        cmocka_unit_test(takes_few_points),
        cmocka_unit_test(limits_radii_by_pixels),
        cmocka_unit_test(a_sparse_cloud_stays),
        cmocka_unit_test(limits_follow_the_overlap),
        cmocka_unit_test(stops_when_cancelled),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
