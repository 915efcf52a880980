// Which method prepare --adapt chooses.
#include "eval/adapt.h"
#include "test.h"

static void the_best_of_both_is_chosen(void **state)
{
    (void)state;
    const struct orl_adapt_row rows[] = {{NULL, 20, 0.8}, {NULL, 22, 0.9}, {NULL, 21, 0.85}};
    assert_int_equal(orl_adapt_choose(rows, 3), 1);
    assert_int_equal(orl_adapt_choose(rows, 1), 0);
}

// The second has the greatest SSIM and nearly the greatest PSNR; no other is near it in both.
static void ranks_decide_where_figures_disagree(void **state)
{
    (void)state;
    const struct orl_adapt_row rows[] = {{NULL, 22, 0.80}, {NULL, 21.9, 0.90}, {NULL, 20, 0.85}};
    assert_int_equal(orl_adapt_choose(rows, 3), 1);
    const struct orl_adapt_row even[] = {{NULL, 20, 0.9}, {NULL, 21, 0.8}};
    assert_int_equal(orl_adapt_choose(even, 2), 1);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(the_best_of_both_is_chosen),
        cmocka_unit_test(ranks_decide_where_figures_disagree),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
