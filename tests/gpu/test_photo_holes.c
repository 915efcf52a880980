// Holes of a photograph's depth: guessed inside a surface, and nowhere else.
#include <math.h>

#include "gpu_test.h"

#include "shared/render_blocks.h"

enum { WIDTH = 240, HEIGHT = 160, LEFT = 100, RIGHT = 112, TOP = 70, BOTTOM = 82 };

static struct orl_gpu *gpu;

static bool in_hole(int x, int y)
{
    return x >= LEFT && x < RIGHT && y >= TOP && y < BOTTOM;
}

static void guess(float *depth)
{
    struct orl_tex *tex, *guessed;
    struct orl_tex_params params = {.width = WIDTH, .height = HEIGHT, .format = GL_R32F,
                                    .tag = "test depth"};
    struct depth_map_block block = {.drawn_size = {WIDTH, HEIGHT}, .kept_size = {WIDTH, HEIGHT}};
    assert_int_equal(orl_tex_create(gpu, &params, &tex), ORL_OK);
    assert_int_equal(orl_tex_create(gpu, &params, &guessed), ORL_OK);
    orl_tex_write(tex, GL_RED, GL_FLOAT, depth);
    struct orl_dispatch d = {.prog = orl_prog_get(gpu, "proxy/photo_holes.comp", NULL, NULL),
                             ORL_PARAMS(block), .images = {tex, guessed}, .size = {WIDTH, HEIGHT}};
    orl_gpu_dispatch(gpu, &d);
    orl_tex_read(guessed, 0, GL_RED, GL_FLOAT, sizeof(float) * WIDTH * HEIGHT, depth);
    assert_int_equal(orl_gpu_finish(gpu), ORL_OK);
    orl_tex_destroy(gpu, &tex);
    orl_tex_destroy(gpu, &guessed);
}

static void test_hole_in_a_surface(void **state)
{
    (void)state;
    static float depth[WIDTH * HEIGHT];
    for (int y = 0; y < HEIGHT; y++)
        for (int x = 0; x < WIDTH; x++)
            depth[y * WIDTH + x] = in_hole(x, y) ? 0.0f : 4.0f;
    guess(depth);
    for (int y = 0; y < HEIGHT; y++)
        for (int x = 0; x < WIDTH; x++)
            assert_float_equal(depth[y * WIDTH + x], in_hole(x, y) ? -4.0f : 4.0f, 1e-5f);
}

// A hole between a column and a wall far behind: near the column as near, near the wall as far.
static void test_hole_between_two(void **state)
{
    (void)state;
    static float depth[WIDTH * HEIGHT];
    for (int y = 0; y < HEIGHT; y++)
        for (int x = 0; x < WIDTH; x++)
            depth[y * WIDTH + x] = in_hole(x, y) ? 0.0f : x < LEFT ? 2.0f : 20.0f;
    guess(depth);
    float left = -depth[(TOP + 6) * WIDTH + LEFT], right = -depth[(TOP + 6) * WIDTH + RIGHT - 1];
    assert_true(left > 2.0f && left < right && right < 20.0f);
}

static void test_sky_beside_a_wall(void **state)
{
    (void)state;
    static float depth[WIDTH * HEIGHT];
    for (int y = 0; y < HEIGHT; y++)
        for (int x = 0; x < WIDTH; x++)
            depth[y * WIDTH + x] = x < WIDTH / 2 ? 4.0f : 0.0f;
    guess(depth);
    for (int y = 0; y < HEIGHT; y++)
        for (int x = 0; x < WIDTH; x++)
            assert_float_equal(depth[y * WIDTH + x], x < WIDTH / 2 ? 4.0f : 0.0f, 0.0f);
}

// Wider than is looked: what may be there is not known.
static void test_wide_hole(void **state)
{
    (void)state;
    static float depth[WIDTH * HEIGHT];
    for (int y = 0; y < HEIGHT; y++)
        for (int x = 0; x < WIDTH; x++)
            depth[y * WIDTH + x] = x > 60 && x < 180 && y > 30 && y < 130 ? 0.0f : 4.0f;
    guess(depth);
    assert_float_equal(depth[80 * WIDTH + 120], 0.0f, 0.0f);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_hole_in_a_surface),
        cmocka_unit_test(test_hole_between_two),
        cmocka_unit_test(test_sky_beside_a_wall),
        cmocka_unit_test(test_wide_hole),
    };
    gpu = gpu_test_device();
    int failed = cmocka_run_group_tests(tests, NULL, NULL);
    assert_int_equal(orl_gpu_finish(gpu), ORL_OK);
    orl_gpu_destroy(&gpu);
    return failed;
}
