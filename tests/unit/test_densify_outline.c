// Depth that reaches past outlines is taken away, and nothing else is.
#include <math.h>
#include <string.h>

#include "test.h"

#include "preprocess/densify/densify_internal.h"

// A bright plate before a dark background. Its depth reaches HALO pixels past it on each side.
enum { SIDE = 96, FIRST = 32, LAST = 64, HALO = 4, BRIGHT = 200, DARK = 30 };

struct fixture {
    struct orl_camera camera;
    struct orl_image luma;
    struct densify_maps maps;
};

static bool in_square(int i, int margin)
{
    int x = i % SIDE, y = i / SIDE;
    return x >= FIRST - margin && x < LAST + margin && y >= FIRST - margin && y < LAST + margin;
}

static void set_depth(struct fixture *f, int i, float depth, float confidence)
{
    f->maps.depth.f32[i] = depth;
    f->maps.confidence.f32[i] = confidence;
    f->maps.normal.f32[3 * i + 2] = depth > 0 ? -1 : 0;
}

static int set_up(void **state)
{
    struct fixture *f = calloc(1, sizeof *f);
    assert_non_null(f);
    f->camera = (struct orl_camera){.width = SIDE, .height = SIDE, .fx = 80, .fy = 80,
                                    .cx = 0.5 * SIDE, .cy = 0.5 * SIDE};
    assert_int_equal(orl_image_init(NULL, &f->luma, SIDE, SIDE, 1, ORL_PIXEL_U8), ORL_OK);
    assert_int_equal(orl_image_init(NULL, &f->maps.depth, SIDE, SIDE, 1, ORL_PIXEL_F32), ORL_OK);
    assert_int_equal(orl_image_init(NULL, &f->maps.normal, SIDE, SIDE, 3, ORL_PIXEL_F32), ORL_OK);
    assert_int_equal(orl_image_init(NULL, &f->maps.confidence, SIDE, SIDE, 1, ORL_PIXEL_F32),
                     ORL_OK);
    for (int i = 0; i < SIDE * SIDE; i++) {
        f->luma.u8[i] = in_square(i, 0) ? BRIGHT : DARK;
        if (in_square(i, HALO))
            set_depth(f, i, 4, 0.5f);
    }
    *state = f;
    return 0;
}

static int tear_down(void **state)
{
    struct fixture *f = *state;
    orl_image_finish(&f->luma);
    orl_densify_maps_finish(&f->maps);
    free(f);
    return 0;
}

// Trims, and counts the pixels of the plate and of the halo that have depth.
static void trim(struct fixture *f, int *plate, int *halo)
{
    assert_int_equal(orl_densify_trim_outlines(NULL, &f->camera, &f->luma, &f->maps), ORL_OK);
    *plate = *halo = 0;
    for (int i = 0; i < SIDE * SIDE; i++) {
        bool kept = f->maps.depth.f32[i] > 0;
        assert_int_equal(kept, f->maps.confidence.f32[i] > 0);
        assert_int_equal(kept, f->maps.normal.f32[3 * i + 2] < 0);
        *plate += kept && in_square(i, 0);
        *halo += kept && in_square(i, HALO) && !in_square(i, 0);
    }
}

enum { PLATE = (LAST - FIRST) * (LAST - FIRST),
       AROUND = (LAST - FIRST + 2 * HALO) * (LAST - FIRST + 2 * HALO) - PLATE };

static void set_background(struct fixture *f, uint8_t luma)
{
    for (int i = 0; i < SIDE * SIDE; i++)
        if (!in_square(i, 0))
            f->luma.u8[i] = luma;
}

static void depth_ends_at_an_outline_before_nothing(void **state)
{
    int plate, halo;
    trim(*state, &plate, &halo);
    assert_int_equal(plate, PLATE);
    assert_true(halo < AROUND / 20);
}

// The plate's border is a little like the background here, but not as much as it is like the plate.
static void outlines_need_little_contrast(void **state)
{
    int plate, halo;
    set_background(*state, BRIGHT - 30);
    trim(*state, &plate, &halo);
    assert_int_equal(plate, PLATE);
    assert_true(halo < AROUND / 20);
}

static void depth_ends_at_an_outline_before_a_surface(void **state)
{
    struct fixture *f = *state;
    int plate, halo;
    for (int i = 0; i < SIDE * SIDE; i++)
        if (!in_square(i, HALO))
            set_depth(f, i, 8, 0.9f);
    trim(f, &plate, &halo);
    assert_int_equal(plate, PLATE);
    assert_true(halo < AROUND / 20);
}

static void depth_that_is_sure_stays(void **state)
{
    struct fixture *f = *state;
    int plate, halo;
    for (int i = 0; i < SIDE * SIDE; i++)
        f->maps.confidence.f32[i] *= 1.8f;
    trim(f, &plate, &halo);
    assert_int_equal(plate, PLATE);
    assert_int_equal(halo, AROUND);
}

// The photograph tells nothing where both sides look alike, or nearly so.
static void depth_stays_where_nothing_tells_the_sides_apart(void **state)
{
    for (int difference = 0; difference <= 20; difference += 20) {
        int plate, halo;
        set_background(*state, (uint8_t)(BRIGHT - difference));
        trim(*state, &plate, &halo);
        assert_int_equal(plate, PLATE);
        assert_int_equal(halo, AROUND);
    }
}

// A dark stain on the plate with a small hole in it, of less than a thousandth of the picture: what the
// hole hides is not known.
static void small_holes_show_no_background(void **state)
{
    struct fixture *f = *state;
    int plate, halo;
    for (int y = 44; y < 52; y++)
        for (int x = 44; x < 52; x++) {
            int i = y * SIDE + x;
            f->luma.u8[i] = DARK;
            if (x >= 47 && x < 50 && y >= 47 && y < 50)
                set_depth(f, i, 0, 0);
        }
    trim(f, &plate, &halo);
    assert_int_equal(plate, PLATE - 9);
}

static void set_floor(struct fixture *f)
{
    for (int i = 0; i < SIDE * SIDE; i++) {
        // 1/z = 0.05 + 0.005 y: the plane (0, 0.005 fy, 0.05 + 0.005 cy) X = 1
        double n[2] = {0.005 * f->camera.fy, 0.05 + 0.005 * f->camera.cy};
        double length = sqrt(n[0] * n[0] + n[1] * n[1]);
        set_depth(f, i, (float)(1 / (0.05 + 0.005 * (i / SIDE + 0.5))), 0.5f);
        f->maps.normal.f32[3 * i + 1] = (float)(-n[0] / length);
        f->maps.normal.f32[3 * i + 2] = (float)(-n[1] / length);
        f->luma.u8[i] = i / SIDE < SIDE / 2 ? DARK : BRIGHT;
    }
}

static void assert_all_kept(struct fixture *f)
{
    int kept = 0;
    assert_int_equal(orl_densify_trim_outlines(NULL, &f->camera, &f->luma, &f->maps), ORL_OK);
    for (int i = 0; i < SIDE * SIDE; i++)
        kept += f->maps.depth.f32[i] > 0;
    assert_int_equal(kept, SIDE * SIDE);
}

// A floor that recedes is no step, however dark its far part is.
static void slanting_surfaces_have_no_outline(void **state)
{
    set_floor(*state);
    assert_all_kept(*state);
}

// Nor is the picture's border one, where the floor would go on and be nearer.
static void slanting_surfaces_have_no_outline_at_borders(void **state)
{
    struct fixture *f = *state;
    set_floor(f);
    memset(f->luma.u8 + (SIDE - 2) * SIDE, DARK, 2 * SIDE);
    assert_all_kept(f);
}

// Where a floor, dark, ends at a bright wall, what is farther than the last of the floor is floor.
static void floors_end_at_walls(void **state)
{
    struct fixture *f = *state;
    enum { WALL = 48 };
    for (int i = 0; i < SIDE * SIDE; i++) {
        // 1/z = 0.13 + 0.0025 y up to 0.25
        double slope = i / SIDE < WALL ? 0.0025 : 0, here = 0.25 + slope * (i / SIDE + 0.5 - WALL);
        double n[2] = {slope * f->camera.fy, here - slope * (i / SIDE + 0.5 - f->camera.cy)};
        double length = sqrt(n[0] * n[0] + n[1] * n[1]);
        set_depth(f, i, (float)(1 / here), 0.5f);
        f->maps.normal.f32[3 * i + 1] = (float)(-n[0] / length);
        f->maps.normal.f32[3 * i + 2] = (float)(-n[1] / length);
        f->luma.u8[i] = i / SIDE < WALL ? DARK : BRIGHT;
    }
    assert_all_kept(f);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test_setup_teardown(outlines_need_little_contrast, set_up, tear_down),
        cmocka_unit_test_setup_teardown(floors_end_at_walls, set_up, tear_down),
        cmocka_unit_test_setup_teardown(depth_ends_at_an_outline_before_nothing, set_up, tear_down),
        cmocka_unit_test_setup_teardown(depth_ends_at_an_outline_before_a_surface, set_up,
                                        tear_down),
        cmocka_unit_test_setup_teardown(depth_that_is_sure_stays, set_up, tear_down),
        cmocka_unit_test_setup_teardown(depth_stays_where_nothing_tells_the_sides_apart, set_up,
                                        tear_down),
        cmocka_unit_test_setup_teardown(small_holes_show_no_background, set_up, tear_down),
        cmocka_unit_test_setup_teardown(slanting_surfaces_have_no_outline, set_up, tear_down),
        cmocka_unit_test_setup_teardown(slanting_surfaces_have_no_outline_at_borders, set_up,
                                        tear_down),
    };
    return cmocka_run_group_tests_name("outline", tests, NULL, NULL);
}
