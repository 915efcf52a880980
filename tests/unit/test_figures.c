// The figure: what is drawn, its mesh and its description are the same shape.
#include <math.h>
#include <string.h>

#include "datasets/figures.h"
#include "mesh_help.h"
#include "test.h"

static const struct orl_figures_params small = {.cameras = 5, .frames = 1, .width = 80,
                                                .height = 60};

static void knows_its_distance(void **state)
{
    (void)state;
    struct orl_figure figure;
    memset(&figure, 0, sizeof figure);
    for (int i = 0; i < ORL_FIGURE_PARTS; i++)
        figure.parts[i] = (struct orl_figure_part){.a = {9, 9, 9}, .b = {9, 9, 9}, .radius = 0.1};
    figure.parts[3] = (struct orl_figure_part){.a = {0, 0, 0}, .b = {0, 2, 0}, .radius = 0.5};
    int part = -1;
    assert_float_equal(orl_figure_distance(&figure, (double[]){2, 1, 0}, &part), 1.5, 1e-12);
    assert_int_equal(part, 3);
    assert_float_equal(orl_figure_distance(&figure, (double[]){0, -3, 4}, NULL), 4.5, 1e-12);
    assert_float_equal(orl_figure_distance(&figure, (double[]){0, 1.5, 0}, NULL), -0.5, 1e-12);
}

// Depth of the figure lies on its surface, a ray that misses comes nowhere near it, and the mask
// says which is which.
static void draws_its_shape(void **state)
{
    (void)state;
    struct orl_view views[5];
    struct orl_figure figure;
    orl_figures_views(&small, views);
    orl_figure_pose(7, &figure);
    for (int c = 0; c < small.cameras; c++) {
        struct orl_figures_picture picture, room;
        size_t seen = 0;
        assert_int_equal(orl_figures_draw(NULL, &figure, &views[c], &picture), ORL_OK);
        assert_int_equal(orl_figures_draw(NULL, NULL, &views[c], &room), ORL_OK);
        assert_null(room.mask.u8);
        for (int y = 0; y < small.height; y++)
            for (int x = 0; x < small.width; x++) {
                size_t i = (size_t)(y * small.width + x);
                double at[3], depth = (double)picture.depth.f32[i];
                orl_view_unproject(&views[c], x + 0.5, y + 0.5, depth, at);
                double off = orl_figure_distance(&figure, at, NULL);
                if (picture.mask.u8[i]) {
                    assert_float_equal(off, 0, 1e-5);
                    assert_true(picture.depth.f32[i] < room.depth.f32[i]);
                    seen++;
                    // Whole in the picture.
                    assert_true(x > 0 && y > 0 && x + 1 < small.width && y + 1 < small.height);
                } else {
                    assert_true(off > 0);
                    assert_float_equal(picture.depth.f32[i], room.depth.f32[i], 0);
                }
            }
        assert_between(seen, 150, 1500);
        orl_figures_picture_finish(&picture);
        orl_figures_picture_finish(&room);
    }
}

static void meshes_its_shape(void **state)
{
    (void)state;
    struct orl_figure figure;
    struct orl_mesh mesh;
    orl_figure_pose(3, &figure);
    assert_int_equal(orl_figure_mesh(NULL, &figure, 0.03, &mesh), ORL_OK);
    for (size_t i = 0; i < mesh.vertex_count; i++) {
        const double at[3] = {(double)mesh.position[i][0], (double)mesh.position[i][1],
                              (double)mesh.position[i][2]};
        assert_float_equal(orl_figure_distance(&figure, at, NULL), 0, 1e-5);
    }
    // By counting points inside: the mesh is inscribed, so it holds a little less.
    size_t inside = 0;
    const double step = 0.02;
    for (double z = -1.3; z < 1.3; z += step)
        for (double y = 0; y < 2; y += step)
            for (double x = -1.3; x < 1.3; x += step)
                inside += orl_figure_distance(&figure, (double[]){x, y, z}, NULL) < 0;
    double volume = (double)inside * step * step * step;
    assert_float_equal(mesh_volume(&mesh), volume, 0.05 * volume);
    orl_mesh_finish(&mesh);
}

static void moves(void **state)
{
    (void)state;
    struct orl_figure a, b, again;
    orl_figure_pose(0, &a);
    orl_figure_pose(5, &b);
    orl_figure_pose(5, &again);
    assert_memory_equal(&b, &again, sizeof b);
    double most = 0, lowest = INFINITY;
    for (int i = 0; i < ORL_FIGURE_PARTS; i++)
        for (int k = 0; k < 3; k++)
            most = fmax(most, fabs(a.parts[i].b[k] - b.parts[i].b[k]));
    assert_true(most > 0.05 && most < 0.6);
    for (int frame = 0; frame < 60; frame++) {
        orl_figure_pose(frame, &a);
        for (int i = 0; i < ORL_FIGURE_PARTS; i++)
            lowest = fmin(lowest, fmin(a.parts[i].a[1], a.parts[i].b[1]) - a.parts[i].radius);
    }
    assert_true(lowest >= 0); // above the floor
}

static void checks_its_settings(void **state)
{
    (void)state;
    static const struct orl_figures_params bad[] = {{8, 1, 8, 64}, {8, 1, 64, 9999}};
    for (size_t i = 0; i < ORL_COUNT(bad); i++)
        assert_int_equal(orl_figures_check(NULL, &bad[i]), ORL_ERR_ARGUMENT);
    char *dir = test_dir_make();
    FILE *taken = test_create(dir, "taken");
    fclose(taken);
    assert_int_equal(orl_figures_run(NULL, NULL, &small, dir), ORL_ERR_ARGUMENT);
    test_dir_remove(dir);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(knows_its_distance), cmocka_unit_test(draws_its_shape),
        cmocka_unit_test(meshes_its_shape), cmocka_unit_test(moves),
        cmocka_unit_test(checks_its_settings),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
