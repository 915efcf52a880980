// Points as Gaussians: their shape, and colours fitted to photographs.
#include <math.h>
#include <stdio.h>
#include <string.h>

#include "exchange/gaussians.h"
#include "io/picture.h"
#include "test.h"

enum { PHOTOS = 9, SIDE = 32 };

// Rotates the third axis.
static void rotated_z(const float q[4], double out[3])
{
    double w = (double)q[0], x = (double)q[1], y = (double)q[2], z = (double)q[3];
    out[0] = 2 * (x * z + w * y);
    out[1] = 2 * (y * z - w * x);
    out[2] = 1 - 2 * (x * x + y * y);
}

static void turns_the_third_axis_to_the_normal(void **state)
{
    (void)state;
    struct orl_points points;
    struct orl_gaussian shape;
    static const float normals[][3] = {{0, 0, 1}, {0, 0, -1}, {1, 0, 0}, {0.6f, -0.48f, -0.64f}};
    assert_int_equal(orl_points_init(NULL, &points, 5), ORL_OK);
    for (size_t i = 0; i < 4; i++)
        memcpy(points.normal[i], normals[i], sizeof normals[i]);
    const struct orl_gaussians g = {.points = &points};
    for (size_t i = 0; i < 5; i++) {
        points.radius[i] = 2;
        orl_gaussian_shape(&g, i, &shape);
        assert_float_equal(shape.scale[0], shape.scale[1], 0);
        if (i == 4) { // without a normal: a ball
            assert_float_equal(shape.scale[2], shape.scale[0], 0);
            continue;
        }
        double z[3], along = 0;
        rotated_z(shape.rotation_wxyz, z);
        for (int k = 0; k < 3; k++)
            along += z[k] * (double)normals[i][k];
        assert_float_equal(fabs(along), 1, 1e-6); // either side of a disc will do
        assert_true(shape.scale[2] < 0.1f * shape.scale[0]);
    }
    orl_points_finish(&points);
}

static void is_as_opaque_as_photographs_agree(void **state)
{
    (void)state;
    struct orl_points points;
    struct orl_gaussian shape;
    static const struct {
        uint8_t photographs;
        double opacity;
    } known[] = {{0, 0.99}, {2, 0.75}, {3, 0.875}, {255, 0.99}}; // 0: unknown
    assert_int_equal(orl_points_init(NULL, &points, ORL_COUNT(known)), ORL_OK);
    const struct orl_gaussians g = {.points = &points};
    for (size_t i = 0; i < ORL_COUNT(known); i++) {
        points.photographs[i] = known[i].photographs;
        orl_gaussian_shape(&g, i, &shape);
        assert_float_equal(shape.opacity, known[i].opacity, 1e-6);
    }
    orl_points_finish(&points);
}

// --- colours ---

// Photographs on an arc before a point at the origin, each of one colour.
struct made {
    char *dir;
    struct orl_photo photos[PHOTOS];
    char names[PHOTOS][16];
    struct orl_scene scene;
    double direction[PHOTOS][3]; // from each to the point
};

static void add_photo(struct made *m, int i, uint8_t grey)
{
    double angle = (i - PHOTOS / 2) * 0.15;
    const double eye[3] = {5 * sin(angle), 0, -5 * cos(angle)}, up[3] = {0, -1, 0};
    struct orl_image image;
    char path[4096];
    snprintf(m->names[i], sizeof m->names[i], "%d.png", i);
    m->photos[i] = (struct orl_photo){
        .name = m->names[i], .gain = {1, 1, 1}, .response = -1,
        .view = {{SIDE, SIDE, SIDE, SIDE, SIDE / 2.0, SIDE / 2.0},
                 orl_pose_look_at(eye, (double[3]){0}, up)}};
    for (int k = 0; k < 3; k++)
        m->direction[i][k] = -eye[k] / 5;
    assert_int_equal(orl_image_init(NULL, &image, SIDE, SIDE, 3, ORL_PIXEL_U8), ORL_OK);
    memset(image.u8, grey, orl_image_bytes(&image));
    snprintf(path, sizeof path, "%s/images/%s", m->dir, m->names[i]);
    assert_int_equal(orl_png_write(NULL, path, &image), ORL_OK);
    orl_image_finish(&image);
}

static void make(struct made *m, const uint8_t grey[PHOTOS])
{
    char path[4096];
    memset(m, 0, sizeof *m);
    m->dir = test_dir_make();
    snprintf(path, sizeof path, "%s/images", m->dir);
    assert_int_equal(orl_dir_make(NULL, path), ORL_OK);
    for (int i = 0; i < PHOTOS; i++)
        add_photo(m, i, grey[i]);
    m->scene = (struct orl_scene){.dir = m->dir, .photos = m->photos, .photo_count = PHOTOS,
                                  .frame = -1};
    assert_int_equal(orl_points_init(NULL, &m->scene.points, 2), ORL_OK);
    memcpy(m->scene.points.normal[0], (float[3]){0, 0, -1}, 12);
    m->scene.points.radius[0] = 0.05f;
    memset(m->scene.points.color[0], 128, 3);
    // Before the point and out of the way, until a test moves it.
    memcpy(m->scene.points.position[1], (float[3]){0, 20, 0}, 12);
    memset(m->scene.points.color[1], 9, 3);
    m->scene.points.radius[1] = 0.2f;
}

static void finish(struct made *m)
{
    orl_points_finish(&m->scene.points);
    test_dir_remove(m->dir);
}

// The fitted colour of point 0 in direction of photograph i, 8 bits.
static double seen(const struct made *m, const struct orl_gaussians *g, int i)
{
    double y[ORL_HARMONICS_MAX], value = 0.5;
    orl_harmonics(m->direction[i], g->terms, y);
    for (int k = 0; k < g->terms; k++)
        value += y[k] * (double)g->harmonics[k * 3];
    return 255 * value;
}

static void follows_the_direction(void **state)
{
    (void)state;
    static const uint8_t grey[PHOTOS] = {100, 107, 114, 121, 128, 135, 142, 149, 156};
    struct made m;
    double worst[2] = {0};
    make(&m, grey);
    for (int degree = 0; degree < 2; degree++) {
        struct orl_gaussians g;
        assert_int_equal(orl_gaussians_fit(NULL, NULL, &m.scene, degree, &g), ORL_OK);
        for (int i = 0; i < PHOTOS; i++)
            worst[degree] = fmax(worst[degree], fabs(seen(&m, &g, i) - grey[i]));
        // What no photograph sees keeps its colour.
        assert_float_equal(255 * (0.5 + 0.28209479 * (double)g.harmonics[3 * g.terms]), 9, 0.01);
        orl_gaussians_finish(&g);
    }
    assert_float_equal(worst[0], 28, 1); // the mean
    assert_true(worst[1] < 10);
    finish(&m);
}

// Held-out photographs, and those that something hides the point from, take no part.
static void asks_only_those_that_see(void **state)
{
    (void)state;
    static const uint8_t grey[PHOTOS] = {128, 128, 128, 128, 200, 128, 128, 128, 128};
    struct made m;
    struct orl_gaussians g;
    make(&m, grey);
    for (int hidden = 0; hidden < 3; hidden++) {
        const float z = hidden == 1 ? -2 : 0, y = hidden == 1 ? 0 : 20;
        memcpy(m.scene.points.position[1], (float[3]){0, y, z}, 12);
        m.photos[PHOTOS / 2].test = hidden == 2;
        assert_int_equal(orl_gaussians_fit(NULL, NULL, &m.scene, 0, &g), ORL_OK);
        if (hidden)
            assert_float_equal(seen(&m, &g, 0), 128, 0.1);
        else
            assert_true(seen(&m, &g, 0) > 130);
        orl_gaussians_finish(&g);
    }
    finish(&m);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(turns_the_third_axis_to_the_normal),
        cmocka_unit_test(is_as_opaque_as_photographs_agree),
        cmocka_unit_test(follows_the_direction),
        cmocka_unit_test(asks_only_those_that_see),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
