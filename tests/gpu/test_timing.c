// How frames are timed: what is drawn how often, and which of the times is the median.
#include <unistd.h>

#include "eval/timing.h"
#include "gpu_test.h"

static struct orl_gpu *gpu;

enum { SHORT_US = 2000, LONG_US = 30000 };

struct drawn {
    size_t frames, of_view[2];
    size_t slow; // this frame takes long; counted over all
    bool fails;
};

static enum orl_result draw(void *priv, size_t number)
{
    struct drawn *drawn = priv;
    orl_pass_begin(gpu, "sleep");
    usleep(++drawn->frames == drawn->slow ? LONG_US : SHORT_US);
    orl_pass_end(gpu);
    drawn->of_view[number % 2]++;
    return drawn->fails ? ORL_ERR_GPU : ORL_OK;
}

static void known_frames(void **state)
{
    (void)state;
    struct drawn drawn = {.slow = 7}; // the third timed one, after four to warm up
    struct orl_timing timing;
    const struct orl_timing_params params = {.draw = draw, .priv = &drawn, .views = 2,
                                             .warm_up = 2, .frames_max = 5, .seconds = 100,
                                             .pass_frames = 2};
    assert_int_equal(orl_timing_take(gpu, &params, &timing), ORL_OK);
    assert_int_equal(timing.frames, 5);
    assert_int_equal(drawn.frames, 4 + 5 + 2);
    assert_true(timing.median_ms >= 1e-3 * SHORT_US && timing.median_ms < 1e-3 * LONG_US);
    assert_true(timing.slowest_ms >= 1e-3 * LONG_US);
    assert_int_equal(timing.pass_count, 1);
    assert_string_equal(timing.passes[0].name, "sleep");
}

static void views_take_turns_and_seconds_end_it(void **state)
{
    (void)state;
    struct drawn drawn = {0};
    struct orl_timing timing;
    const struct orl_timing_params params = {.draw = draw, .priv = &drawn, .views = 2,
                                             .frames_max = 100};
    assert_int_equal(orl_timing_take(gpu, &params, &timing), ORL_OK);
    assert_int_equal(timing.frames, 4); // at least three, each view as often
    assert_int_equal(drawn.of_view[0], drawn.of_view[1]);
    assert_int_equal(timing.pass_count, 0); // none were asked for
    drawn.fails = true;
    assert_int_equal(orl_timing_take(gpu, &params, &timing), ORL_ERR_GPU);
}

static void medians(void **state)
{
    (void)state;
    double odd[] = {5, 1, 3}, even[] = {4, 1, 3, 2};
    assert_float_equal(orl_median(odd, 3), 3, 0);
    assert_float_equal(orl_median(even, 4), 2.5, 0);
    assert_float_equal(orl_median(NULL, 0), 0, 0);
}

static int set_up(void **state)
{
    (void)state;
    gpu = gpu_test_device();
    return 0;
}

static int tear_down(void **state)
{
    (void)state;
    orl_gpu_destroy(&gpu);
    return 0;
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(known_frames),
        cmocka_unit_test(views_take_turns_and_seconds_end_it),
        cmocka_unit_test(medians),
    };
    return cmocka_run_group_tests(tests, set_up, tear_down);
}
