// Which regions of a photograph that differ from renderings of its view are occluders.
#include "eval/occluder_masks.h"
#include "test.h"

#include <string.h>

enum { WIDTH = 240, HEIGHT = 160, PIXELS = WIDTH * HEIGHT };

// A rectangle of pixels: from left, top to right, bottom.
struct part {
    int left, top, right, bottom;
};

static bool is_in(const struct part *part, int i)
{
    int x = i % WIDTH, y = i / WIDTH;
    return x >= part->left && x < part->right && y >= part->top && y < part->bottom;
}

static void fill(struct orl_image *image, const struct part *part, uint8_t value)
{
    for (int i = 0; i < PIXELS; i++)
        if (is_in(part, i))
            memset(&image->u8[3 * i], value, 3);
}

// Surfaces everywhere, and grey pictures that agree.
static struct orl_occluder_pictures make_pictures(void)
{
    struct orl_occluder_pictures p;
    struct orl_image *grey[] = {&p.photo, &p.rendered[0], &p.rendered[1], &p.rendered[2]};
    for (int k = 0; k < 4; k++) {
        assert_int_equal(orl_image_init(NULL, grey[k], WIDTH, HEIGHT, 3, ORL_PIXEL_U8), ORL_OK);
        memset(grey[k]->u8, 160, orl_image_bytes(grey[k]));
    }
    assert_int_equal(orl_image_init(NULL, &p.covered, WIDTH, HEIGHT, 1, ORL_PIXEL_F32), ORL_OK);
    for (int i = 0; i < PIXELS; i++)
        p.covered.f32[i] = 1;
    return p;
}

static void finish(struct orl_occluder_pictures *p)
{
    orl_image_finish(&p->photo);
    for (int k = 0; k < ORL_OCCLUDER_RENDERINGS; k++)
        orl_image_finish(&p->rendered[k]);
    orl_image_finish(&p->covered);
}

// Finds what there is, finishes the pictures, and returns the share.
static double share_of(struct orl_occluder_pictures *pictures, struct orl_image *mask)
{
    double share;
    assert_int_equal(orl_occluder_mask(NULL, pictures, mask, &share), ORL_OK);
    assert_true((share > 0) == (mask->width > 0));
    finish(pictures);
    return share;
}

static double share_alone(struct orl_occluder_pictures *pictures)
{
    struct orl_image mask;
    double share = share_of(pictures, &mask);
    orl_image_finish(&mask);
    return share;
}

static const struct part branch = {20, 10, 80, 60};

static void what_nobody_else_shows_is_an_occluder(void **state)
{
    (void)state;
    struct orl_occluder_pictures p = make_pictures();
    struct orl_image mask;
    fill(&p.photo, &branch, 20);
    double share = share_of(&p, &mask);
    // All of it, and not much beside it: what the filter blurs, and what is grown.
    const struct part wider = {branch.left - 8, branch.top - 8, branch.right + 8, branch.bottom + 8};
    for (int i = 0; i < PIXELS; i++) {
        if (is_in(&branch, i))
            assert_int_equal(mask.u8[i], 255);
        if (!is_in(&wider, i))
            assert_int_equal(mask.u8[i], 0);
    }
    assert_between((int)(1000 * share), 1000 * 60 * 50 / PIXELS, 1000 * 76 * 66 / PIXELS);
    orl_image_finish(&mask);
}

// It goes on before the sky, where no surface tells.
static void an_occluder_goes_on_where_depth_is_guessed(void **state)
{
    (void)state;
    struct orl_occluder_pictures p = make_pictures();
    const struct part whole = {20, 10, 200, 60};
    struct orl_image mask;
    fill(&p.photo, &whole, 20);
    for (int i = 0; i < PIXELS; i++)
        p.covered.f32[i] = i % WIDTH < 80;
    share_of(&p, &mask);
    for (int i = 0; i < PIXELS; i++)
        if (is_in(&whole, i))
            assert_int_equal(mask.u8[i], 255);
    orl_image_finish(&mask);
}

static void guesses_alone_prove_nothing(void **state)
{
    (void)state;
    struct orl_occluder_pictures p = make_pictures();
    fill(&p.photo, &branch, 20);
    for (int i = 0; i < PIXELS; i++)
        p.covered.f32[i] = i / WIDTH > 100;
    assert_float_equal(share_alone(&p), 0, 0);
}

// The nearest photographs show the same: the consensus is wrong there, not this photograph.
static void what_neighbours_show_too_is_no_occluder(void **state)
{
    (void)state;
    struct orl_occluder_pictures p = make_pictures();
    fill(&p.photo, &branch, 20);
    fill(&p.rendered[ORL_OCCLUDER_NEAREST], &branch, 20);
    assert_float_equal(share_alone(&p), 0, 0);
}

// A wall that this photograph alone shows from the front: its points are known, though others show
// something else there.
static void what_its_points_show_too_is_no_occluder(void **state)
{
    (void)state;
    struct orl_occluder_pictures p = make_pictures();
    fill(&p.photo, &branch, 20);
    fill(&p.rendered[ORL_OCCLUDER_POINTS], &branch, 40);
    assert_float_equal(share_alone(&p), 0, 0);
}

// Stripes, as bricks.
static void add_stripes(struct orl_image *image, const struct part *part, uint8_t dark,
                        uint8_t bright)
{
    for (int i = 0; i < PIXELS; i++)
        if (is_in(part, i))
            memset(&image->u8[3 * i], (i % WIDTH + i / WIDTH) / 4 % 2 ? dark : bright, 3);
}

static struct orl_occluder_pictures make_bricks(void)
{
    static const struct part all = {0, 0, WIDTH, HEIGHT};
    struct orl_occluder_pictures p = make_pictures();
    add_stripes(&p.photo, &all, 140, 220);
    add_stripes(&p.rendered[ORL_OCCLUDER_CONSENSUS], &all, 140, 220);
    add_stripes(&p.rendered[ORL_OCCLUDER_NEAREST], &all, 140, 220);
    return p;
}

static void a_surface_in_the_shade_is_no_occluder(void **state)
{
    (void)state;
    struct orl_occluder_pictures p = make_bricks();
    add_stripes(&p.photo, &branch, 20, 60);
    assert_float_equal(share_alone(&p), 0, 0);
    p = make_bricks();
    fill(&p.photo, &branch, 40);
    assert_true(share_alone(&p) > 0);
}

static void small_and_faint_differences_are_none(void **state)
{
    (void)state;
    static const struct part crumb = {50, 50, 62, 62};
    struct orl_occluder_pictures p = make_pictures();
    fill(&p.photo, &crumb, 20);
    assert_float_equal(share_alone(&p), 0, 0);
    p = make_pictures();
    fill(&p.photo, &branch, 140);
    assert_float_equal(share_alone(&p), 0, 0);
}

static void another_light_is_no_occluder(void **state)
{
    (void)state;
    struct orl_occluder_pictures p = make_pictures();
    memset(p.photo.u8, 20, orl_image_bytes(&p.photo));
    assert_float_equal(share_alone(&p), 0, 0);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(what_nobody_else_shows_is_an_occluder),
        cmocka_unit_test(an_occluder_goes_on_where_depth_is_guessed),
        cmocka_unit_test(guesses_alone_prove_nothing),
        cmocka_unit_test(what_neighbours_show_too_is_no_occluder),
        cmocka_unit_test(what_its_points_show_too_is_no_occluder),
        cmocka_unit_test(a_surface_in_the_shade_is_no_occluder),
        cmocka_unit_test(small_and_faint_differences_are_none),
        cmocka_unit_test(another_light_is_no_occluder),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
