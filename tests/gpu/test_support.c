// Outliers are dropped, notches and pinholes closed, and corners and gaps left alone.
#include <math.h>

#include "gpu_test.h"

#include "shared/render_blocks.h"

enum { SIDE = 13 };

static struct orl_gpu *gpu;

static void support(float *depth)
{
    struct orl_tex *in, *out, *normal;
    struct orl_tex_params params = {.width = SIDE, .height = SIDE, .format = GL_R32F,
                                    .tag = "test depth"};
    struct orl_tex_params normal_params = params;
    normal_params.format = GL_RGBA16F;
    struct pyramid_block block = {.level_size = {SIDE, SIDE}};
    assert_int_equal(orl_tex_create(gpu, &params, &in), ORL_OK);
    assert_int_equal(orl_tex_create(gpu, &params, &out), ORL_OK);
    assert_int_equal(orl_tex_create(gpu, &normal_params, &normal), ORL_OK);
    orl_tex_write(in, GL_RED, GL_FLOAT, depth);
    struct orl_dispatch d = {.prog = orl_prog_get(gpu, "proxy/support.comp", NULL, "NORMALS"),
                             ORL_PARAMS(block), .images = {in, out, normal},
                             .size = {(SIDE + 1) / 2, (SIDE + 1) / 2}};
    orl_gpu_dispatch(gpu, &d);
    orl_tex_read(out, 0, GL_RED, GL_FLOAT, sizeof(float) * SIDE * SIDE, depth);
    assert_int_equal(orl_gpu_finish(gpu), ORL_OK);
    orl_tex_destroy(gpu, &in);
    orl_tex_destroy(gpu, &out);
    orl_tex_destroy(gpu, &normal);
}

static void fill(float *depth, int right, float z)
{
    for (int i = 0; i < SIDE * SIDE; i++)
        depth[i] = i % SIDE < right ? z : 0;
}

static void outliers_go(void **state)
{
    (void)state;
    float depth[SIDE * SIDE];
    fill(depth, 0, 0);
    depth[6 * SIDE + 6] = depth[6 * SIDE + 7] = 2;
    support(depth);
    for (int i = 0; i < SIDE * SIDE; i++)
        assert_float_equal(depth[i], 0, 0);
}

static void a_straight_edge_stays(void **state)
{
    (void)state;
    float depth[SIDE * SIDE];
    fill(depth, 6, 4);
    support(depth);
    for (int i = 0; i < SIDE * SIDE; i++)
        assert_float_equal(depth[i], (i % SIDE < 6 ? 4 : 0), 0);
}

static void a_notch_is_closed(void **state)
{
    (void)state;
    float depth[SIDE * SIDE];
    fill(depth, 6, 4);
    for (int i = 0; i < SIDE * SIDE; i++)
        depth[i] *= i / SIDE > 6 ? 1.02f : 1; // a little farther below
    depth[6 * SIDE + 5] = depth[6 * SIDE + 4] = depth[1 * SIDE + 2] = 0;
    support(depth);
    assert_float_equal(depth[1 * SIDE + 2], 4, 1e-5);
    // Of the 25 around, 7 at depth 4 and 6 at 4.08 remain, just enough. Means are of the 6x6
    // around four pixels: 10 and 12.
    assert_float_equal(depth[6 * SIDE + 5], (10 * 4.0 + 12 * 4.08) / 22, 1e-4);
    assert_float_equal(depth[6 * SIDE + 6], 0, 0);
}

// A hole through which something behind may be seen.
static void two_depths_close_nothing(void **state)
{
    (void)state;
    float depth[SIDE * SIDE];
    fill(depth, SIDE, 4);
    for (int i = 0; i < SIDE * SIDE; i++)
        depth[i] = i % SIDE < 6 ? 4 : 6;
    depth[6 * SIDE + 6] = 0;
    support(depth);
    assert_float_equal(depth[6 * SIDE + 6], 0, 0);
}

int main(void)
{
    gpu = gpu_test_device();
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(outliers_go),
        cmocka_unit_test(a_straight_edge_stays),
        cmocka_unit_test(a_notch_is_closed),
        cmocka_unit_test(two_depths_close_nothing),
    };
    int failed = cmocka_run_group_tests_name("support", tests, NULL, NULL);
    orl_gpu_destroy(&gpu);
    return failed;
}
