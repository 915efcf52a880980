// What the densifier gives up when the device's memory is short.
#include "test.h"

#include "preprocess/densify/densify_internal.h"

static const uint64_t MIB = (uint64_t)1 << 20;

static struct densify_need photographs(int width, int height)
{
    const struct orl_densify_params params = {ORL_DENSIFY_DEFAULTS};
    return (struct densify_need){.width = width, .height = height, .min_side = height,
                                 .padding = orl_densify_padding(&params), .geometric = true};
}

// Any number of 12-megapixel photographs: only one and its sources are on the device.
static void test_twelve_megapixels_on_4_gib(void **state)
{
    (void)state;
    const struct densify_need need = photographs(4000, 3000);
    struct densify_budget budget;
    assert_true(orl_densify_fit(&need, 8, 4096 * MIB, &budget));
    assert_int_equal(budget.sources, 8);
    assert_int_equal(budget.shrink, 0);
    // 70 + 8 sources * 8 bytes a pixel, and the padding of the sources.
    assert_between(budget.bytes, 12000000ull * 134, 12000000ull * 136);
    assert_true(orl_densify_fit(&need, 16, 4096 * MIB, &budget));
    assert_int_equal(budget.sources, 16);
    assert_int_equal(budget.shrink, 0);
}

static void test_sources_go_first(void **state)
{
    (void)state;
    const struct densify_need need = photographs(4000, 3000);
    struct densify_budget budget;
    assert_true(orl_densify_fit(&need, 8, 1400 * MIB, &budget));
    assert_between(budget.sources, 4, 7);
    assert_int_equal(budget.shrink, 0);
    assert_true(budget.bytes <= 1400 * MIB);
    assert_true(orl_densify_bytes(&need, budget.sources + 1, 0) > 1400 * MIB);
}

static void test_then_size_with_all_sources_again(void **state)
{
    (void)state;
    const struct densify_need need = photographs(4000, 3000);
    struct densify_budget budget;
    assert_true(orl_densify_fit(&need, 8, 1000 * MIB, &budget));
    assert_int_equal(budget.sources, 8);
    assert_int_equal(budget.shrink, 1);
    assert_true(budget.bytes <= 1000 * MIB);
    assert_true(orl_densify_bytes(&need, 4, 0) > 1000 * MIB);
    // Asked for fewer than four: none are given up.
    assert_true(orl_densify_fit(&need, 2, 900 * MIB, &budget));
    assert_int_equal(budget.sources, 2);
}

// Without a limit too, an array of sources must be one that drivers accept.
static void test_large_textures(void **state)
{
    (void)state;
    const struct densify_need need = photographs(6000, 4000);
    struct densify_budget budget;
    assert_true(orl_densify_fit(&need, 8, 0, &budget));
    assert_int_equal(budget.sources, 8);
    assert_int_equal(budget.shrink, 0);
    assert_true(orl_densify_fit(&need, 16, 0, &budget));
    assert_between(budget.sources, 9, 11);
    assert_int_equal(budget.shrink, 0);
}

// A wide panorama is halved until a source, with its padding, is no wider than any device's textures.
static void test_wide_textures(void **state)
{
    (void)state;
    struct densify_need need = photographs(16384 - 2 * 17, 500);
    struct densify_budget budget;
    assert_int_equal(need.padding, 17);
    assert_true(orl_densify_fit(&need, 8, 0, &budget));
    assert_int_equal(budget.shrink, 0);
    need.width++;
    assert_true(orl_densify_fit(&need, 8, 0, &budget));
    assert_int_equal(budget.sources, 8);
    assert_int_equal(budget.shrink, 1);
    need = photographs(500, 40000);
    need.min_side = 500;
    assert_true(orl_densify_fit(&need, 8, 0, &budget));
    assert_int_equal(budget.shrink, 2);
    need.min_side = 40; // cannot be halved twice
    assert_false(orl_densify_fit(&need, 8, 0, &budget));
}

static void test_nothing_fits(void **state)
{
    (void)state;
    const struct densify_need need = photographs(4000, 3000);
    struct densify_budget budget;
    assert_false(orl_densify_fit(&need, 8, 1000, &budget));
    assert_true(budget.bytes > 1000);
    // A tiny photograph among them cannot be halved.
    struct densify_need mixed = need;
    mixed.min_side = 24;
    assert_false(orl_densify_fit(&mixed, 8, 500 * MIB, &budget));
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_twelve_megapixels_on_4_gib),
        cmocka_unit_test(test_sources_go_first),
        cmocka_unit_test(test_then_size_with_all_sources_again),
        cmocka_unit_test(test_large_textures),
        cmocka_unit_test(test_wide_textures),
        cmocka_unit_test(test_nothing_fits),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
