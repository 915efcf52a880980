// Points of two photographs beside those of three, and COLMAP's lists that tell them.
#include <math.h>
#include <string.h>

#include "scene/colmap.h"
#include "scene/thin.h"
#include "test.h"

static void line_up(struct orl_points *points, size_t count, float x, float step,
                    uint8_t photographs)
{
    assert_int_equal(orl_points_init(NULL, points, count), ORL_OK);
    for (size_t i = 0; i < count; i++) {
        points->position[i][0] = x + step * (float)i;
        points->normal[i][2] = -1;
        points->radius[i] = 0.5f;
        points->color[i][1] = (uint8_t)(10 + i);
        points->photographs[i] = photographs;
    }
}

static void adds_where_nothing_is_near(void **state)
{
    (void)state;
    // Sure points at 0 .. 9, thin ones at 5.4, 6.4, .. 14.4: all of these have a sure
    // one within 0.5 or 0.6 up to 9.4, and none from 10.4 on.
    struct orl_points sure, thin;
    line_up(&sure, 10, 0, 1, 3);
    line_up(&thin, 10, 5.4f, 1, 2);
    thin.photographs[7] = 3; // at 12.4, and not a pair
    thin.radius[6] = 3;      // at 11.4, where it is sparser: 2.4 away is near
    const struct orl_thin_params params = {ORL_THIN_DEFAULTS};
    assert_int_equal(orl_points_add_thin(NULL, &params, &thin, &sure), ORL_OK);
    assert_int_equal(sure.count, 13);
    for (size_t i = 0; i < 10; i++) {
        assert_float_equal(sure.position[i][0], i, 0);
        assert_int_equal(sure.photographs[i], 3);
    }
    static const float added[] = {10.4f, 13.4f, 14.4f};
    for (size_t i = 0; i < 3; i++) {
        assert_float_equal(sure.position[10 + i][0], added[i], 1e-5);
        assert_float_equal(sure.normal[10 + i][2], -1, 0);
        assert_int_equal(sure.color[10 + i][1], 10 + (int)(added[i] - 5));
        assert_int_equal(sure.photographs[10 + i], 2);
    }
    orl_points_finish(&sure);
    orl_points_finish(&thin);
}

static void drops_points_beyond_the_world(void **state)
{
    (void)state;
    struct orl_points sure, thin;
    line_up(&sure, 10, 0, 1, 3);
    line_up(&thin, 10, 20, 1, 2);
    sure.position[3][1] = 1e20f;
    thin.position[4][2] = -INFINITY;
    const struct orl_thin_params params = {ORL_THIN_DEFAULTS};
    assert_int_equal(orl_points_add_thin(NULL, &params, &thin, &sure), ORL_OK);
    assert_int_equal(sure.count, 18);
    orl_points_finish(&sure);
    orl_points_finish(&thin);
}

static void takes_what_there_is(void **state)
{
    (void)state;
    struct orl_points sure, thin;
    const struct orl_thin_params params = {ORL_THIN_DEFAULTS};
    line_up(&sure, 0, 0, 1, 3);
    line_up(&thin, 4, 0, 1, 2);
    assert_int_equal(orl_points_add_thin(NULL, &params, &thin, &sure), ORL_OK);
    assert_int_equal(sure.count, 4);
    orl_points_finish(&thin);
    line_up(&thin, 0, 0, 1, 2);
    assert_int_equal(orl_points_add_thin(NULL, &params, &thin, &sure), ORL_OK);
    assert_int_equal(sure.count, 4);
    orl_points_finish(&sure);
    orl_points_finish(&thin);
}

static void finds_strays(void **state)
{
    (void)state;
    // A photograph from the origin along z, its map at half the size: nothing on the left,
    // a wall at 10 on the right.
    const struct orl_view view = {{.width = 8, .height = 4, .fx = 4, .fy = 4, .cx = 4, .cy = 2},
                                  {.r = {{1, 0, 0}, {0, 1, 0}, {0, 0, 1}}}};
    struct orl_image depth;
    assert_int_equal(orl_image_init(NULL, &depth, 4, 2, 1, ORL_PIXEL_F32), ORL_OK);
    for (int i = 0; i < 8; i++)
        depth.f32[i] = i % 4 < 2 ? 0 : 10;
    static const float at[][3] = {{1, 1, 5},    // before the wall
                                  {1, 1, 5},    // but of three photographs
                                  {-1, 1, 5},   // before nothing
                                  {1, 1, 9.9f}, // on the wall
                                  {1, 1, 11},   // behind it
                                  {9, 1, 5},    // out of the picture
                                  {1, 1, -5}};
    struct orl_points points;
    uint16_t seen_past[7] = {0};
    line_up(&points, 7, 0, 1, 2);
    memcpy(points.position, at, sizeof at);
    points.photographs[1] = 3;
    orl_points_count_seen_past(&points, &view, &depth, 0.02f, seen_past);
    for (int i = 0; i < 7; i++)
        assert_int_equal(seen_past[i], i < 2);
    orl_points_drop_seen_past(seen_past, &points);
    assert_int_equal(points.count, 6);
    assert_memory_equal(points.position, at[1], 6 * sizeof at[0]);
    assert_int_equal(points.color[5][1], 16);
    // A second photograph outvotes the three.
    seen_past[0] = 2, seen_past[1] = 0;
    orl_points_drop_seen_past(seen_past, &points);
    assert_int_equal(points.count, 5);
    points.photographs[0] = 0; // not known
    orl_points_drop_seen_past(seen_past, &points);
    assert_int_equal(points.count, 5);
    orl_image_finish(&depth);
    orl_points_finish(&points);
}

static void reads_visibility(void **state)
{
    (void)state;
    char *dir, *path;
    assert_int_equal(test_file_make("fused.ply.vis", &dir, &path), 0);
    uint32_t words[300] = {3, 0, 2, 7, 8, 0, 290};
    const size_t size = (7 + 290) * sizeof *words;
    uint8_t seen[3];
    assert_int_equal(orl_file_write(NULL, path, words, size), ORL_OK);
    assert_int_equal(orl_colmap_visibility_read(NULL, path, 3, seen), ORL_OK);
    assert_int_equal(seen[0], 2);
    assert_int_equal(seen[1], 0);
    assert_int_equal(seen[2], 255);
    assert_int_equal(orl_colmap_visibility_read(NULL, path, 2, seen), ORL_ERR_FORMAT);
    // Cut anywhere, and with a list that is longer than the file.
    for (size_t cut = 0; cut < size; cut += 5) {
        assert_int_equal(orl_file_write(NULL, path, words, cut), ORL_OK);
        assert_int_equal(orl_colmap_visibility_read(NULL, path, 3, seen), ORL_ERR_FORMAT);
    }
    words[2] = UINT32_MAX;
    assert_int_equal(orl_file_write(NULL, path, words, size), ORL_OK);
    assert_int_equal(orl_colmap_visibility_read(NULL, path, 3, seen), ORL_ERR_FORMAT);
    test_file_remove(dir, path);
}

static void allows_for_flat_angles(void **state)
{
    (void)state;
    // The wall is seen 10 % farther than the points, whose surfaces face the photograph, or lie at
    // such an angle that their depth changes by 20 % (but no more than 10 % counts) or by 5 % a pixel.
    const struct orl_view view = {{.width = 4, .height = 4, .fx = 10, .fy = 10, .cx = 2, .cy = 2},
                                  {.r = {{1, 0, 0}, {0, 1, 0}, {0, 0, 1}}}};
    static const float normals[][3] = {{0, 0, -1}, {2, 0, 1}, {1, 0, 2}, {0, 0, 0}};
    static const bool past[] = {true, false, true, true};
    struct orl_image depth;
    struct orl_points points;
    uint16_t seen_past[4] = {0};
    assert_int_equal(orl_image_init(NULL, &depth, 4, 4, 1, ORL_PIXEL_F32), ORL_OK);
    for (int i = 0; i < 16; i++)
        depth.f32[i] = 11;
    line_up(&points, 4, 0, 1, 2);
    for (int i = 0; i < 4; i++) {
        memcpy(points.position[i], (float[]){0, 0, 10}, sizeof points.position[i]);
        memcpy(points.normal[i], normals[i], sizeof normals[i]);
    }
    orl_points_count_seen_past(&points, &view, &depth, 0.01f, seen_past);
    for (int i = 0; i < 4; i++)
        assert_int_equal(seen_past[i], past[i]);
    orl_image_finish(&depth);
    orl_points_finish(&points);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(adds_where_nothing_is_near),
        cmocka_unit_test(drops_points_beyond_the_world),
        cmocka_unit_test(takes_what_there_is),
        cmocka_unit_test(finds_strays),
        cmocka_unit_test(allows_for_flat_angles),
        cmocka_unit_test(reads_visibility),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
