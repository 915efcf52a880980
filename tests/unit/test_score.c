// When oriel tune takes a value for better.
#include "eval/validation.h"
#include "test.h"

// Scores of four photographs, each by its PSNR; SSIM is the same for all.
static struct orl_score score(double views[4][2], double a, double b, double c, double d)
{
    const double psnr[] = {a, b, c, d};
    struct orl_score v = {.views = views, .count = 4, .ssim = 0.9};
    for (int i = 0; i < 4; i++) {
        views[i][0] = psnr[i];
        views[i][1] = 0.9;
        v.psnr_db += psnr[i] / 4;
    }
    return v;
}

static void a_gain_is_one_of_the_photographs_together(void **state)
{
    (void)state;
    double views[4][4][2];
    const struct orl_score before = score(views[0], 20, 22, 24, 26);
    struct orl_score all = score(views[1], 20.5, 22.6, 24.4, 26.5);
    struct orl_score one = score(views[2], 24, 22, 24, 26);
    struct orl_score worse = score(views[3], 19.9, 22, 24, 26);
    // Half of a gain of PSNR alone counts: 0.25 dB here.
    assert_true(orl_score_better(&all, &before, 0.24));
    assert_false(orl_score_better(&all, &before, 0.26));
    // What one photograph gains alone is no larger than its standard error.
    assert_false(orl_score_better(&one, &before, 0.01));
    assert_false(orl_score_better(&worse, &before, 0));
    // SSIM that gets worse refuses whatever PSNR gains.
    all.views[0][1] = 0.8999;
    assert_false(orl_score_better(&all, &before, 0.01));
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_gain_is_one_of_the_photographs_together),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
