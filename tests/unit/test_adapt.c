// What the stage adapt chooses, and how much it may render.
#include "eval/adapt.h"
#include "eval/score.h"
#include "test.h"

static void the_best_of_both_is_chosen(void **state)
{
    (void)state;
    const struct orl_trial rows[] = {{.psnr_db = 20, .ssim = 0.8}, {.psnr_db = 22, .ssim = 0.9},
                                     {.psnr_db = 21, .ssim = 0.85}};
    assert_int_equal(orl_adapt_choose(rows, 3), 1);
    assert_int_equal(orl_adapt_choose(rows, 1), 0);
}

// The second has the greatest SSIM and nearly the greatest PSNR; no other is near it in both.
static void ranks_decide_where_figures_disagree(void **state)
{
    (void)state;
    const struct orl_trial rows[] = {{.psnr_db = 22, .ssim = 0.80}, {.psnr_db = 21.9, .ssim = 0.90},
                                     {.psnr_db = 20, .ssim = 0.85}};
    assert_int_equal(orl_adapt_choose(rows, 3), 1);
    const struct orl_trial even[] = {{.psnr_db = 20, .ssim = 0.9}, {.psnr_db = 21, .ssim = 0.8}};
    assert_int_equal(orl_adapt_choose(even, 2), 1);
}

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

static void steps_are_for_most_photographs(void **state)
{
    (void)state;
    double views[5][4][2];
    const struct orl_score before = score(views[0], 20, 22, 24, 26);
    struct orl_score all = score(views[1], 20.5, 22.6, 24.4, 26.5);
    struct orl_score three = score(views[2], 20.5, 22.6, 24.9, 25.9);
    struct orl_score two = score(views[3], 20.9, 23, 24, 25.9);
    struct orl_score one = score(views[4], 30, 21.9, 23.9, 25.9);
    assert_true(orl_score_clearly_better(&all, &before, 0.15));
    assert_true(orl_score_clearly_better(&three, &before, 0.15));
    assert_false(orl_score_clearly_better(&two, &before, 0.15));
    assert_false(orl_score_clearly_better(&one, &before, 0.15));
    // Half of a gain of PSNR alone counts: 0.25 dB here.
    assert_float_equal(orl_score_gain_db(&all, &before), 0.25, 1e-9);
    assert_false(orl_score_clearly_better(&all, &before, 0.26));
    // SSIM that gets worse refuses whatever PSNR gains.
    all.ssim = 0.8999;
    assert_false(orl_score_clearly_better(&all, &before, 0.15));
    // Of the first photographs alone, while the others are not rendered.
    three.count = 2;
    assert_float_equal(orl_score_gain_db(&three, &before), 0.275, 1e-9);
}

// `count` training photographs of so many pixels, and held-out ones, which do not count.
static size_t renderings(size_t count, int width, int height)
{
    struct orl_photo photos[64] = {0};
    for (size_t i = 0; i < ORL_COUNT(photos); i++) {
        photos[i].test = i >= count;
        photos[i].view.camera.width = i < count ? width : 10000;
        photos[i].view.camera.height = i < count ? height : 10000;
    }
    const struct orl_scene scene = {.photos = photos, .photo_count = ORL_COUNT(photos)};
    return orl_adapt_renderings(&scene);
}

static void renderings_are_bounded_by_the_scene(void **state)
{
    (void)state;
    assert_int_equal(renderings(0, 1000, 1000), 0);
    assert_int_equal(renderings(10, 1000, 1000), 19);
    assert_int_equal(renderings(10, 2000, 1000), 14);
    assert_int_equal(renderings(10, 100, 100), 36);
    assert_int_equal(renderings(60, 4000, 3000), 36);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(the_best_of_both_is_chosen),
        cmocka_unit_test(ranks_decide_where_figures_disagree),
        cmocka_unit_test(steps_are_for_most_photographs),
        cmocka_unit_test(renderings_are_bounded_by_the_scene),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
