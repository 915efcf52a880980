// Depth edges, at which colours are averaged, and specks, which take the colour around.
#include <math.h>

#include "core/color.h"
#include "wall_scene.h"

enum { SIDE = 128, PLATE_HALF_PX = 13 }; // of a plate 0.4 wide at z = 2, focal length 128
static const double FOCAL = 128, PLATE_X = 0.7;

static struct orl_gpu *gpu;

// What stands at column x, row y of a photograph from (eye, 0, 0): the plate, or the wall's upright
// stripes of green and black, 0.25 wide.
static void shade(double eye, int x, int y, int side, uint8_t rgb[3])
{
    double ray_x = (x + 0.5 - side / 2) / FOCAL, ray_y = (y + 0.5 - side / 2) / FOCAL;
    bool plate = fabs(eye + 2 * ray_x - PLATE_X) < 0.2 && fabs(2 * ray_y) < 0.2;
    bool stripe = (int)floor((eye + 4 * ray_x) / 0.25) % 2 == 0;
    memcpy(rgb, plate ? blue : stripe ? green : (const uint8_t[3]){0, 0, 0}, 3);
}

static void add_true_photo(struct fixture *f, double eye)
{
    enum { PHOTO_SIDE = 2 * SIDE };
    add_photo(f, look_from(eye, 0, 0, PHOTO_SIDE, FOCAL), green);
    struct orl_image image;
    assert_int_equal(orl_image_init(NULL, &image, PHOTO_SIDE, PHOTO_SIDE, 3, ORL_PIXEL_U8), ORL_OK);
    for (int i = 0; i < PHOTO_SIDE * PHOTO_SIDE; i++)
        shade(eye, i % PHOTO_SIDE, i / PHOTO_SIDE, PHOTO_SIDE, &image.u8[3 * i]);
    repaint_photo(f, &image);
}

// Of pixels that are `coarser` than those of the photographs.
static struct orl_frame plate(int coarser, enum orl_antialias antialias)
{
    enum { WALL = 120, PLATE = 40 };
    struct fixture f;
    setup_empty(&f, 4);
    assert_int_equal(orl_points_init(NULL, &f.scene.points, WALL * WALL + PLATE * PLATE), ORL_OK);
    set_square(&f.scene.points, 0, WALL, 6, 0, 4, green);
    set_square(&f.scene.points, WALL * WALL, PLATE, 0.4, PLATE_X, 2, blue);
    static const double eyes[] = {-0.5, -0.2, 0.3, 0.9};
    for (size_t i = 0; i < ORL_COUNT(eyes); i++)
        add_true_photo(&f, eyes[i]);
    struct orl_render_params params = orl_method_find(NULL, "oriel")->params;
    params.antialias = antialias;
    params.sampling = ORL_SAMPLING_BILINEAR; // with which specks stay
    struct orl_frame frame = draw(gpu, &f, look_from(PLATE_X, 0, 0, SIDE / coarser, FOCAL / coarser), &params, 0);
    teardown(&f);
    return frame;
}

// Coarser pixels than the photographs' hold more of what lenses blur: neighbours count less, by the
// square.
static void check_steps(int coarser)
{
    const int side = SIDE / coarser;
    const float aside = 0.35f / (float)(coarser * coarser), all = 1 + 2 * aside;
    struct orl_frame hard = plate(coarser, ORL_ANTIALIAS_OFF), soft = plate(coarser, ORL_ANTIALIAS_ON);
    assert_memory_equal(soft.depth.f32, hard.depth.f32, sizeof(float) * (size_t)(side * side));
    assert_memory_equal(soft.coverage.f32, hard.coverage.f32, sizeof(float) * (size_t)(side * side));
    int averaged = 0;
    for (int y = 1; y < side - 1; y++)
        for (int x = 1; x < side - 1; x++) {
            bool step = false;
            float sum[3] = {0};
            for (int k = 0; k < 9; k++) {
                int i = x + k % 3 - 1, j = y + k / 3 - 1;
                float weight = (i == x ? 1 : aside) * (j == y ? 1 : aside) / (all * all);
                step |= (hard.depth.f32[j * side + i] < 3) !=
                        (hard.depth.f32[y * side + x] < 3);
                for (int c = 0; c < 3; c++)
                    sum[c] += weight * sqrtf(color_at(&hard, i, j)[c]);
            }
            for (int c = 0; c < 3; c++)
                assert_float_equal(color_at(&soft, x, y)[c],
                                   step ? sum[c] * sum[c] : color_at(&hard, x, y)[c], 1e-3);
            averaged += step;
        }
    assert_true(averaged > 4 * 2 * PLATE_HALF_PX / coarser);
    orl_frame_finish(&hard);
    orl_frame_finish(&soft);
}

static void steps_are_averaged_and_nothing_else(void **state)
{
    (void)state;
    check_steps(1);
    check_steps(2);
}

// However steep: its inverse depth has no second difference.
static void planes_have_no_steps(void **state)
{
    (void)state;
    enum { WALL = 160 };
    struct fixture f;
    setup_empty(&f, 4);
    assert_int_equal(orl_points_init(NULL, &f.scene.points, WALL * WALL), ORL_OK);
    struct orl_points *points = &f.scene.points;
    set_square(points, 0, WALL, 6, 0, 4, green);
    for (size_t i = 0; i < WALL * WALL; i++) {
        points->position[i][2] += 0.5f * points->position[i][0];
        points->normal[i][0] = (float)sqrt(0.2);
        points->normal[i][2] = (float)-sqrt(0.8);
    }
    add_true_photo(&f, 0);
    struct orl_render_params params = orl_method_find(NULL, "oriel")->params;
    struct orl_frame frames[2];
    for (int i = 0; i < 2; i++) {
        params.antialias = i ? ORL_ANTIALIAS_ON : ORL_ANTIALIAS_OFF;
        frames[i] = draw(gpu, &f, look_from(0, 0, 0, SIDE, FOCAL), &params, 0);
    }
    int averaged = 0;
    for (int y = 8; y < SIDE - 8; y++)
        for (int x = 8; x < SIDE - 8; x++)
            averaged += memcmp(color_at(&frames[0], x, y), color_at(&frames[1], x, y), 3 * sizeof(float)) != 0;
    print_message("%d pixels of a plane are averaged\n", averaged);
    assert_true(averaged < SIDE * SIDE / 20); // where discs of points overlap unevenly
    orl_frame_finish(&frames[0]);
    orl_frame_finish(&frames[1]);
    teardown(&f);
}

enum wall_picture { HALVES, THIN_LINES, NOISE };
enum { DARK = 40 }; // sRGB of what is not bright

static void wall_color(enum wall_picture picture, int column, int row, uint8_t rgb[3])
{
    bool noise = ((unsigned)column * 2654435761u ^ (unsigned)row * 2246822519u) >> 16 & 1;
    bool bright = picture == HALVES ? column < 0 : picture == THIN_LINES ? column % 12 == 0 : noise;
    // Of any five rows that follow each other, the middle one of three shades is the median.
    memset(rgb, bright ? 220 : picture == HALVES ? DARK + 4 * (row % 3 - 1) : DARK, 3);
}

// A wall that one photograph shows from aside. strays: single points float before its right half, where the photograph
// shows what is nine pixels farther left. coarser: pixels of the photograph in one of the view, each way.
static struct orl_frame wall(enum wall_picture picture, bool strays, int coarser, enum orl_antialias antialias)
{
    enum { WALL = 160, STRAYS = 12, APART = 8 };
    const double eye = 0.9, pixel = 4 / FOCAL;
    struct fixture f;
    setup_empty(&f, 4);
    size_t count = WALL * WALL, more = strays ? STRAYS : 0;
    assert_int_equal(orl_points_init(NULL, &f.scene.points, count + more), ORL_OK);
    struct orl_points *points = &f.scene.points;
    set_square(points, 0, WALL, 6, 0, 4, green);
    for (size_t i = 0; i < more; i++) {
        const double ray[2] = {4.5 / FOCAL, ((double)i - STRAYS / 2) * APART / FOCAL};
        points->position[count + i][0] = (float)(3 * ray[0]);
        points->position[count + i][1] = (float)(3 * ray[1]);
        points->position[count + i][2] = 3;
        points->normal[count + i][2] = -1;
        points->radius[count + i] = 0.001f;
    }
    add_photo(&f, look_from(eye, 0, 0, SIDE, FOCAL), green);
    struct orl_image image;
    assert_int_equal(orl_image_init(NULL, &image, SIDE, SIDE, 3, ORL_PIXEL_U8), ORL_OK);
    for (int k = 0; k < SIDE * SIDE; k++)
        wall_color(picture, (int)floor(eye / pixel) + k % SIDE - SIDE / 2, k / SIDE, &image.u8[3 * k]);
    repaint_photo(&f, &image);
    struct orl_render_params params = orl_method_find(NULL, "oriel")->params;
    params.antialias = antialias;
    params.front_layer = 0; // splats that are alone stay
    struct orl_frame frame = draw(gpu, &f, look_from(0, 0, 0, SIDE / coarser, FOCAL / coarser), &params, 0);
    teardown(&f);
    return frame;
}

static float shade_at(const struct orl_frame *frame, int x, int y)
{
    return 255 * orl_srgb_encode(color_at(frame, x, y)[1]);
}

static bool stands_alone(const struct orl_frame *frame, int x, int y)
{
    int beside = 0;
    for (int k = 0; k < 9; k++)
        beside += fabsf(shade_at(frame, x + k % 3 - 1, y + k / 3 - 1) - DARK) > 6;
    return beside == 1;
}

// What is read from a wrong place stands out, though nothing does in the photograph.
static void specks_take_the_colour_around(void **state)
{
    (void)state;
    struct orl_frame off = wall(HALVES, true, 1, ORL_ANTIALIAS_OFF);
    struct orl_frame on = wall(HALVES, true, 1, ORL_ANTIALIAS_ON);
    int specks = 0, alone = 0;
    for (int y = 4; y < SIDE - 4; y++)
        for (int x = SIDE / 2 + 3; x < SIDE - 8; x++) {
            if (shade_at(&off, x, y) < 150)
                continue;
            specks++;
            assert_true(shade_at(&on, x, y) < 60);
            if (!stands_alone(&off, x, y))
                continue;
            alone++;
            assert_float_equal(shade_at(&on, x, y), DARK, 1); // the median, not the darkest or brightest
        }
    print_message("%d specks, %d of a single pixel\n", specks, alone);
    assert_true(specks >= 10 && alone >= 3);
    orl_frame_finish(&off);
    orl_frame_finish(&on);
}

// Lines of a pixel's width and noise stand out as much, but in the photograph, too.
static void what_photographs_show_is_no_speck(void **state)
{
    (void)state;
    const struct { enum wall_picture picture; int coarser; } cases[] = {{THIN_LINES, 1}, {NOISE, 1}, {NOISE, 2}};
    for (size_t i = 0; i < ORL_COUNT(cases); i++) {
        const int side = SIDE / cases[i].coarser;
        struct orl_frame off = wall(cases[i].picture, false, cases[i].coarser, ORL_ANTIALIAS_OFF);
        struct orl_frame on = wall(cases[i].picture, false, cases[i].coarser, ORL_ANTIALIAS_ON);
        int changed = 0, all = (side - 16) * (side / 2 - 8);
        for (int y = 8; y < side - 8; y++)
            for (int x = side / 2; x < side - 8; x++)
                changed += memcmp(color_at(&on, x, y), color_at(&off, x, y), 3 * sizeof(float)) != 0;
        print_message("%d of %d pixels change\n", changed, all);
        assert_int_equal(changed, 0);
        orl_frame_finish(&off);
        orl_frame_finish(&on);
    }
}

int main(void)
{
    gpu = gpu_test_device();
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(steps_are_averaged_and_nothing_else),
        cmocka_unit_test(planes_have_no_steps),
        cmocka_unit_test(specks_take_the_colour_around),
        cmocka_unit_test(what_photographs_show_is_no_speck),
    };
    int failed = cmocka_run_group_tests_name("edges", tests, NULL, NULL);
    orl_gpu_destroy(&gpu);
    return failed;
}
