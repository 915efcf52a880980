// Soft splats as files, and the lists of what a view's tiles show.
#include <math.h>
#include <unistd.h>

#include "soft/lists.h"
#include "soft/soft_ply.h"
#include "test.h"

static void test_file(void **state)
{
    (void)state;
    char *dir = test_dir_make(), path[4096];
    snprintf(path, sizeof path, "%s/soft.ply", dir);
    struct orl_soft_model model = {0}, read = {0};
    const double place[3] = {1, 2, 3};
    const float rgb[3] = {0.1f, 0.2f, 0.9f};
    assert_int_equal(orl_soft_add(NULL, &model, place, 0.5, 0.25f, rgb), ORL_OK);
    assert_int_equal(orl_soft_add(NULL, &model, place, 2, 0.001f, rgb), ORL_OK); // too faint to be read
    for (int k = 0; k < ORL_SOFT_VALUES; k++)
        if (k != ORL_SOFT_OPACITY && k < ORL_SOFT_COLOR + 3)
            model.splats[0][k] = (float)(k + 1) / 8;
    assert_int_equal(orl_soft_write(NULL, path, &model), ORL_OK);
    assert_int_equal(orl_soft_read(NULL, path, &read), ORL_OK);
    assert_int_equal(read.count, 1);
    assert_memory_equal(read.splats, model.splats, sizeof *model.splats);
    orl_soft_finish(&read);

    orl_soft_drop(&model, 0.5f);
    assert_int_equal(model.count, 0);
    assert_int_equal(orl_soft_write(NULL, path, &model), ORL_OK);
    assert_int_equal(orl_soft_read(NULL, path, &read), ORL_ERR_DATA);
    FILE *other = fopen(path, "w");
    fprintf(other, "ply\nformat ascii 1.0\nelement vertex 1\nproperty float x\nend_header\n1\n");
    assert_int_equal(fclose(other), 0);
    assert_int_equal(orl_soft_read(NULL, path, &read), ORL_ERR_FORMAT);
    orl_soft_finish(&model);
    test_dir_remove(dir);
}

// One of so many points stands for them all, and is as large.
static void test_from_points(void **state)
{
    (void)state;
    struct orl_points points;
    struct orl_soft_model all = {0}, some = {0};
    assert_int_equal(orl_points_init(NULL, &points, 4000), ORL_OK);
    for (size_t i = 0; i < points.count; i++) {
        points.radius[i] = i % 2 ? 0.5f : 0; // one without a radius is not drawn
        points.normal[i][0] = 1;
        points.color[i][2] = 255;
    }
    assert_int_equal(orl_soft_from_points(NULL, &points, 1, 7, &all), ORL_OK);
    assert_int_equal(orl_soft_from_points(NULL, &points, 4, 7, &some), ORL_OK);
    assert_int_equal(all.count, 2000);
    assert_in_range(some.count, 400, 600);
    assert_float_equal(exp((double)some.splats[0][ORL_SOFT_SIGMA]), 2 * exp((double)all.splats[0][ORL_SOFT_SIGMA]), 1e-5);
    assert_true(all.splats[0][ORL_SOFT_SIGMA + 2] < all.splats[0][ORL_SOFT_SIGMA]);
    // The third axis, turned, is the normal: q = (1, 0, 1, 0).
    assert_float_equal(all.splats[0][ORL_SOFT_TURN], 1, 1e-6);
    assert_float_equal(all.splats[0][ORL_SOFT_TURN + 2], 1, 1e-6);
    orl_soft_finish(&all);
    orl_soft_finish(&some);
    orl_points_finish(&points);
}

// A wide and a narrow triangle, across the third axis, get splats by area, within them; a flat one gets none.
static void test_from_mesh(void **state)
{
    (void)state;
    float corners[][3] = {{0, 0, 2}, {3, 0, 2}, {0, 2, 2}, {0, 0, 5}, {0, 2, 5}, {1, 0, 5}, {9, 9, 9}};
    uint32_t triangles[][3] = {{0, 1, 2}, {3, 4, 5}, {6, 6, 6}};
    const struct orl_mesh mesh = {.vertex_count = 7, .triangle_count = 3, .position = corners, .triangle = triangles};
    struct orl_soft_model model = {0};
    size_t near = 0;
    assert_int_equal(orl_soft_from_mesh(NULL, &mesh, 4000, 7, &model), ORL_OK);
    assert_in_range(model.count, 3998, 4002);
    double middle = 0;
    for (size_t i = 0; i < model.count; i++) {
        const float *s = model.splats[i];
        double width = s[2] < 3 ? 3 : 1;
        assert_true(s[0] >= 0 && s[1] >= 0 && (double)s[0] / width + (double)s[1] / 2 <= 1 + 1e-6);
        assert_true(s[2] == 2 || s[2] == 5);
        near += s[2] == 2;
        middle += s[2] == 2 ? (double)s[0] : 0;
        // The third axis stays, or turns about one across it by none.
        assert_true(s[ORL_SOFT_TURN] > 0 && s[ORL_SOFT_TURN + 1] == 0 && s[ORL_SOFT_TURN + 2] == 0);
        assert_float_equal(s[ORL_SOFT_COLOR], 0, 0);
    }
    assert_in_range(near, 2998, 3002);
    assert_float_equal(middle / (double)near, 1, 0.05);
    assert_float_equal(exp((double)model.splats[0][ORL_SOFT_SIGMA]), 0.5 * sqrt(4 / 4000.0), 1e-6);
    orl_soft_finish(&model);
}

static uint32_t bits(float depth)
{
    uint32_t word;
    memcpy(&word, &depth, sizeof word);
    return word;
}

// Three tiles side by side: nearest first, equal depths in the splats' order, unseen ones nowhere.
static void test_lists(void **state)
{
    (void)state;
    const uint32_t bounds[][ORL_SOFT_BOUND_WORDS] = {
        {bits(3), 0, 1}, {0, 0, 2}, {bits(1), 1, 2}, {bits(3), 0, 0}};
    const int listed[] = {4, 6, 8, 9, 0, 3, 2, 0, 2}, entries_of_0[] = {0, 3}, entries_of_2[] = {2, 4};
    struct orl_soft_lists lists = {0};
    for (int i = 0; i < 2; i++) { // the second time in the same memory
        assert_int_equal(orl_soft_lists_make(NULL, bounds, 4, 3 * ORL_SOFT_TILE - 1, 1, &lists), ORL_OK);
        assert_int_equal(lists.entries, 5);
        assert_int_equal(lists.seen, 3);
        assert_memory_equal(lists.listed, listed, sizeof listed);
        assert_memory_equal(lists.places + lists.places[0], entries_of_0, sizeof entries_of_0);
        assert_memory_equal(lists.places + lists.places[2], entries_of_2, sizeof entries_of_2);
        assert_int_equal(lists.places[1], lists.places[2]);
        assert_int_equal(lists.places[4] - lists.places[0], 5);
    }
    orl_soft_lists_finish(&lists);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_file),
        cmocka_unit_test(test_from_points),
        cmocka_unit_test(test_from_mesh),
        cmocka_unit_test(test_lists),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
