// Points as they are stored on the device.
#include <math.h>
#include <string.h>

#include "scene/point_blocks.h"
#include "scene/point_code.h"
#include "test.h"

static double random_value(uint32_t *state)
{
    *state = *state * 1664525u + 1013904223u;
    return (*state >> 8) * (1.0 / 16777216);
}

static void positions_and_normals_come_back(void **state)
{
    (void)state;
    enum { COUNT = 128 };
    float position[COUNT][3];
    uint32_t seed = 1;
    struct point_range range = orl_point_range_none();
    for (int i = 0; i < COUNT; i++) {
        for (int k = 0; k < 3; k++)
            position[i][k] = (float)(1000 + (k + 1) * random_value(&seed));
        orl_point_range_add(&range, position[i], 0.1f);
    }
    assert_true(orl_point_range_is_precise(&range));
    const struct point_frame frame = orl_point_frame(&range);
    assert_true(frame.step < 3.0f / 8191 * 1.05f);
    for (int i = 0; i < COUNT; i++) {
        double length = 0;
        float normal[3], back[3];
        for (int k = 0; k < 3; k++) {
            normal[k] = (float)(random_value(&seed) - 0.5);
            length += (double)(normal[k] * normal[k]);
        }
        const uint8_t color[3] = {(uint8_t)i, 255, (uint8_t)(2 * i)};
        struct point_code code = orl_point_encode(&frame, position[i], normal, color, 0.1f);
        assert_true(orl_point_decode_position(&frame, code.geometry, back));
        for (int k = 0; k < 3; k++) // a float at 1000 has steps of 6e-5
            assert_float_equal(back[k], position[i][k], 0.5f * frame.step + 6e-5f);
        assert_memory_equal(code.color, color, sizeof color);
        // Decodes as octahedron.glsl.
        double x = (int8_t)(code.geometry[1] >> 16) / 127.0;
        double y = (int8_t)(code.geometry[1] >> 24) / 127.0;
        double z = 1 - fabs(x) - fabs(y), fold = fmax(-z, 0);
        x -= x >= 0 ? fold : -fold;
        y -= y >= 0 ? fold : -fold;
        double along = (x * (double)normal[0] + y * (double)normal[1] + z * (double)normal[2]) /
                       sqrt(length * (x * x + y * y + z * z));
        assert_true(along > cos(0.017)); // a degree
    }
}

// Equal radii, as a tiny scene has them, are kept exactly; others to 2.2 %.
static void radii_come_back(void **state)
{
    (void)state;
    const float at[3] = {1, 2, 3}, far[3] = {1.5f, 2, 3}, normal[3] = {0, 0, 1};
    const uint8_t color[3] = {0};
    for (float most = 0.011f; most < 0.3f; most *= 1.7f) {
        struct point_range range = orl_point_range_none();
        orl_point_range_add(&range, at, most);
        orl_point_range_add(&range, far, 0.01f);
        const struct point_frame frame = orl_point_frame(&range);
        for (float radius = most; radius >= 0.01f; radius *= 0.9f) {
            struct point_code code = orl_point_encode(&frame, at, normal, color, radius);
            float back = orl_point_decode_radius(&frame, code.geometry);
            assert_float_equal(back, radius, (radius < most ? 0.022f : 1e-6f) * radius);
        }
        struct point_code none = orl_point_encode(&frame, at, normal, color, 0);
        assert_true(orl_point_decode_radius(&frame, none.geometry) == 0);
    }
    struct point_range one = orl_point_range_none();
    orl_point_range_add(&one, at, 0.25f); // a block without extent
    const struct point_frame frame = orl_point_frame(&one);
    struct point_code code = orl_point_encode(&frame, at, normal, color, 0.25f);
    float back[3];
    assert_true(orl_point_decode_position(&frame, code.geometry, back));
    assert_memory_equal(back, at, sizeof at);
    assert_float_equal(orl_point_decode_radius(&frame, code.geometry), 0.25, 1e-6);
}

static void far_points_need_a_block_of_their_own(void **state)
{
    (void)state;
    struct point_range range = orl_point_range_none();
    orl_point_range_add(&range, (const float[3]){0, 0, 0}, 0.01f);
    orl_point_range_add(&range, (const float[3]){1, 0, 0}, 0.01f);
    assert_true(orl_point_range_is_precise(&range));
    struct point_range far = range, wide = range;
    orl_point_range_add(&far, (const float[3]){1e30f, 0, 0}, 0.01f);
    assert_false(orl_point_range_is_precise(&far));
    orl_point_range_add(&wide, (const float[3]){1, 1, 0}, 1000);
    assert_false(orl_point_range_is_precise(&wide));
}

static void no_point_is_no_point(void **state)
{
    (void)state;
    float back[3];
    assert_false(orl_point_decode_position(&(struct point_frame){{0}, 1},
                                           orl_point_code_none.geometry, back));
}

// What a block does not say must not be what memory held before: blocks are written to files.
static void blocks_hold_nothing_else(void **state)
{
    (void)state;
    struct orl_points points;
    assert_int_equal(orl_points_init(NULL, &points, 3), ORL_OK);
    points.count = 3;
    uint32_t order[ORL_BLOCK_POINTS];
    for (size_t i = 0; i < ORL_BLOCK_POINTS; i++)
        order[i] = i < points.count ? (uint32_t)i : UINT32_MAX;
    for (size_t i = 0; i < points.count; i++) {
        points.position[i][0] = (float)i;
        points.normal[i][2] = points.radius[i] = 1;
    }
    struct point_block one, other;
    memset(&one, 0x11, sizeof one);
    memset(&other, 0x77, sizeof other);
    orl_point_block_make(&points, order, &one);
    orl_point_block_make(&points, order, &other);
    assert_memory_equal(&one, &other, sizeof one);
    orl_points_finish(&points);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(positions_and_normals_come_back),
        cmocka_unit_test(radii_come_back),
        cmocka_unit_test(far_points_need_a_block_of_their_own),
        cmocka_unit_test(no_point_is_no_point),
        cmocka_unit_test(blocks_hold_nothing_else),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
