// Photographs that are evenly chosen of those that are held out, or of the others.
#include "test.h"

#include "eval/heldout.h"

enum { COUNT = 8 };

// Which photographs are chosen, as digits.
static void assert_chosen(bool test, size_t most, const char *wanted)
{
    struct orl_photo photos[COUNT] = {0};
    const struct orl_scene scene = {.photos = photos, .photo_count = COUNT};
    char chosen[COUNT + 1] = "";
    photos[2].test = photos[5].test = photos[7].test = true;
    for (size_t i = 0, at = 0; i < COUNT; i++)
        if (orl_heldout_chosen(&scene, test, most, i))
            chosen[at++] = (char)('0' + i);
    assert_string_equal(chosen, wanted);
}

static void photographs_are_evenly_chosen(void **state)
{
    (void)state;
    assert_chosen(false, 0, "01346");
    assert_chosen(false, 9, "01346");
    assert_chosen(false, 5, "01346");
    assert_chosen(false, 2, "36");
    assert_chosen(false, 1, "6");
    assert_chosen(true, 0, "257");
    assert_chosen(true, 2, "57");
}

int main(void)
{
    const struct CMUnitTest tests[] = {cmocka_unit_test(photographs_are_evenly_chosen)};
    return cmocka_run_group_tests_name("heldout", tests, NULL, NULL);
}
