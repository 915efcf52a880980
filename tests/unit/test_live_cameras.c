// Pictures of cameras paired to time steps, by names alone: the files are empty.
#include <unistd.h>

#include "core/memory.h"
#include "test.h"
#include "walk/live_cameras.h"

enum { CAMERAS = 3 };

struct set {
    char *dir, *folders[CAMERAS];
    struct said said;
    struct orl_log log;
    struct orl_live_cameras cameras;
};

static int set_up(void **state)
{
    struct set *set = calloc(1, sizeof *set);
    set->dir = test_dir_make();
    set->log = log_to(&set->said);
    set->cameras = (struct orl_live_cameras){.log = &set->log, .removes = true};
    for (int i = 0; i < CAMERAS; i++) {
        set->folders[i] = orl_format(NULL, "%s/cam%02d", set->dir, i);
        assert_int_equal(orl_dir_make(NULL, set->folders[i]), ORL_OK);
        assert_int_equal(orl_live_cameras_add(&set->cameras, set->folders[i], set->folders[i]), ORL_OK);
    }
    *state = set;
    return 0;
}

static int tear_down(void **state)
{
    struct set *set = *state;
    orl_live_cameras_finish(&set->cameras);
    for (int i = 0; i < CAMERAS; i++)
        free(set->folders[i]);
    test_dir_remove(set->dir);
    free(set);
    return 0;
}

static void add(struct set *set, int camera, const char *name)
{
    fclose(test_create(set->folders[camera], name));
}

// The newest time step has these pictures; NULL: there is none.
static void expect(struct set *set, double now_s, const char *const *names)
{
    char *paths[CAMERAS];
    assert_int_equal(orl_live_cameras_look(&set->cameras, now_s, paths), ORL_OK);
    for (int i = 0; i < CAMERAS; i++) {
        if (names && paths[i])
            assert_string_equal(orl_path_name(paths[i]), names[i]);
        assert_true(!names == !paths[i]);
        if (paths[i])
            unlink(paths[i]);
        free(paths[i]);
    }
}

static void numbers_are_paired(void **state)
{
    struct set *set = *state;
    expect(set, 0, NULL);
    for (int i = 0; i < CAMERAS; i++) {
        add(set, i, "left_7.png");
        add(set, i, ".left_8.png"); // is still being written
        add(set, i, "notes.txt");
    }
    expect(set, 0, (const char *const[]){"left_7.png", "left_7.png", "left_7.png"});
    expect(set, 0, NULL);
    // Of several time steps the newest one that is whole counts, 9 and not 8; 10 may yet become so.
    for (int i = 0; i < CAMERAS; i++) {
        if (i != 1)
            add(set, i, "8.png");
        add(set, i, "9.jpg");
        if (i > 0)
            add(set, i, "10.png");
    }
    expect(set, 0, (const char *const[]){"9.jpg", "9.jpg", "9.jpg"});
    assert_non_null(strstr(set->said.text, "cam01: no picture 8"));
    assert_int_equal(set->cameras.cameras[1].missing, 1);
    assert_int_equal(set->cameras.cameras[0].missing + set->cameras.cameras[2].missing, 0);
    add(set, 0, "10.png");
    expect(set, 0, (const char *const[]){"10.png", "10.png", "10.png"});
    for (int i = 0; i < CAMERAS; i++) {
        add(set, i, "11.png");
        add(set, i, "12.png");
    }
    expect(set, 0, (const char *const[]){"12.png", "12.png", "12.png"});
    assert_int_equal(test_count_entries(set->folders[0]), 2); // what has been decided upon is removed
}

static void time_stamps_are_paired(void **state)
{
    struct set *set = *state;
    static const char *const stamps[CAMERAS][3] = {{"1000.png", "1040.png", "1080.png"},
                                                   {"1015.png", "1056.png", "1094.png"},
                                                   {"1003.png", "1061.png", "1079.png"}};
    for (int i = 0; i < CAMERAS; i++)
        add(set, i, stamps[i][0]);
    expect(set, 0, NULL); // how far apart a camera's pictures are is not known
    assert_string_equal(set->said.text, "");
    for (int i = 0; i < CAMERAS; i++)
        add(set, i, stamps[i][1]);
    // The first ones belong together; of the second, 1061 is more than half of 40 from 1040.
    expect(set, 0, (const char *const[]){"1000.png", "1015.png", "1003.png"});
    for (int i = 0; i < CAMERAS; i++)
        add(set, i, stamps[i][2]);
    expect(set, 0, (const char *const[]){"1080.png", "1094.png", "1079.png"});
    assert_non_null(strstr(set->said.text, "cam02: no picture 1040"));
}

static void standing_still_is_said(void **state)
{
    struct set *set = *state;
    add(set, 0, "1.png");
    add(set, 1, "1.png");
    expect(set, 10, NULL);
    expect(set, 10.9, NULL);
    assert_string_equal(set->said.text, "");
    expect(set, 11.1, NULL);
    expect(set, 12, NULL);
    assert_non_null(strstr(set->said.text, "cam02: no new picture"));
    assert_int_equal(set->cameras.cameras[2].late, 1);
    add(set, 2, "1.png");
    expect(set, 13, (const char *const[]){"1.png", "1.png", "1.png"});
    expect(set, 20, NULL); // nobody waits
    assert_int_equal(set->cameras.cameras[0].late + set->cameras.cameras[1].late, 0);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test_setup_teardown(numbers_are_paired, set_up, tear_down),
        cmocka_unit_test_setup_teardown(time_stamps_are_paired, set_up, tear_down),
        cmocka_unit_test_setup_teardown(standing_still_is_said, set_up, tear_down),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
