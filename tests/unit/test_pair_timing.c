// Two ways to draw a frame, timed by a clock whose noise is known.
#include "eval/timing.h"

#include <math.h>

#include "test.h"

// True times of both ways, and noise that makes a frame longer by a share of up to `noise`.
struct clock {
    double ms[2], noise, drift; // drift: every frame takes this share longer than the one before
    double slow_share, slow;    // so large a share of frames takes so many times as long
    uint32_t random;
    size_t frames;
};

static double next(struct clock *clock)
{
    clock->random = clock->random * 1664525u + 1013904223u;
    return (clock->random >> 8) / 16777216.0;
}

static enum orl_result tick(void *priv, bool second, double *ms)
{
    struct clock *clock = priv;
    *ms = clock->ms[second] * (1 + clock->noise * next(clock)) *
          (1 + clock->drift * (double)clock->frames++);
    if (next(clock) < clock->slow_share)
        *ms *= clock->slow;
    return ORL_OK;
}

enum { TRIALS = 200 };

// Of many comparisons, those that find the second clearly slower than the limit.
static int refused(struct clock clock, double limit, double *rounds)
{
    int count = 0;
    *rounds = 0;
    for (int i = 0; i < TRIALS; i++) {
        struct orl_pair_timing timing;
        const struct orl_pair_timing_params params = {
            .time = tick, .priv = &clock, .limit = limit, .rounds_max = ORL_PAIR_ROUNDS_MAX};
        clock.frames = 0;
        assert_int_equal(orl_pair_timing_take(&params, &timing), ORL_OK);
        count += orl_pair_timing_above(&timing, limit);
        *rounds += (double)timing.rounds / TRIALS;
    }
    return count;
}

static void equal_times_are_accepted(void **state)
{
    (void)state;
    double rounds;
    assert_true(refused((struct clock){.ms = {100, 100}, .noise = 0.3}, 1.02, &rounds) <=
                TRIALS / 50);
    // Every tenth frame takes three times as long.
    assert_true(refused((struct clock){.ms = {100, 100}, .noise = 0.1, .slow_share = 0.1,
                                       .slow = 3}, 1.02, &rounds) <= TRIALS / 50);
}

static void slower_ones_are_refused(void **state)
{
    (void)state;
    double rounds;
    assert_true(refused((struct clock){.ms = {100, 110}, .noise = 0.3}, 1.02, &rounds) >=
                TRIALS - TRIALS / 50);
    assert_true(refused((struct clock){.ms = {100, 130}, .noise = 0.1, .slow_share = 0.1,
                                       .slow = 3}, 1.02, &rounds) >= TRIALS - TRIALS / 20);
}

// Few rounds are enough where the answer is plain, and more are taken where it is not.
static void doubt_takes_more_rounds(void **state)
{
    (void)state;
    double plain, doubtful;
    assert_int_equal(refused((struct clock){.ms = {100, 80}, .noise = 0.05}, 1.02, &plain), 0);
    assert_true(plain < ORL_PAIR_ROUNDS_MIN + 0.1);
    refused((struct clock){.ms = {100, 102}, .noise = 0.05}, 1.02, &doubtful);
    assert_true(doubtful > 0.8 * ORL_PAIR_ROUNDS_MAX);
}

// A machine that becomes slower all the time favours neither.
static void drift_cancels(void **state)
{
    (void)state;
    struct clock clock = {.ms = {100, 100}, .drift = 0.01};
    struct orl_pair_timing timing;
    const struct orl_pair_timing_params params = {.time = tick, .priv = &clock, .limit = 1.02,
                                                  .error = 1e-6, .rounds_max = 10};
    assert_int_equal(orl_pair_timing_take(&params, &timing), ORL_OK);
    assert_float_equal(timing.ratio, 1, 1e-3);
    assert_int_equal(timing.rounds, 10); // so small an error is not reached
    assert_true(log(1.02 / timing.ratio) > 3 * timing.error);
    assert_true(orl_pair_timing_above(&timing, 0.98));
}

static enum orl_result fails(void *priv, bool second, double *ms)
{
    (void)priv;
    *ms = 1;
    return second ? ORL_ERR_GPU : ORL_OK;
}

static void a_frame_that_fails_ends_it(void **state)
{
    (void)state;
    struct orl_pair_timing timing;
    const struct orl_pair_timing_params params = {.time = fails, .limit = 1, .rounds_max = 10};
    assert_int_equal(orl_pair_timing_take(&params, &timing), ORL_ERR_GPU);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(equal_times_are_accepted), cmocka_unit_test(slower_ones_are_refused),
        cmocka_unit_test(doubt_takes_more_rounds),  cmocka_unit_test(drift_cancels),
        cmocka_unit_test(a_frame_that_fails_ends_it),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
