#include "test.h"

#include "oriel/scene.h"

static bool bracketed(const double *ev, const int *series, size_t count, bool test)
{
    struct orl_photo photos[8] = {0};
    struct orl_scene scene = {.photos = photos, .photo_count = count};
    for (size_t i = 0; i < count; i++) {
        photos[i].exposure_ev = ev[i];
        photos[i].series = series[i];
        photos[i].test = test && i >= 4;
    }
    return orl_scene_is_bracketed(&scene);
}

static void two_series_are(void **state)
{
    (void)state;
    assert_true(bracketed((double[]){-3, 0, -3, 0, 3}, (int[]){0, 1, 0, 1, 2}, 5, false));
}

static void close_or_single_exposures_are_not(void **state)
{
    (void)state;
    assert_false(bracketed((double[]){0, 1, 0, 1}, (int[]){0, 1, 0, 1}, 4, false));
    assert_false(bracketed((double[]){0, 0, 0, 5}, (int[]){0, 0, 0, 1}, 4, false));
    assert_false(bracketed((double[]){0, 0, 0, 0, 5, 5}, (int[]){0, 0, 0, 0, 1, 1}, 6, true));
}

// As a camera takes them that meters each photograph by itself.
static void one_series_of_varied_exposures_is_not(void **state)
{
    (void)state;
    assert_false(bracketed((double[]){-1.4, -0.7, 0, 0.7, -1.4, 0.7}, (int[]){0, 0, 0, 0, 0, 0}, 6, false));
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(two_series_are),
        cmocka_unit_test(close_or_single_exposures_are_not),
        cmocka_unit_test(one_series_of_varied_exposures_is_not),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
