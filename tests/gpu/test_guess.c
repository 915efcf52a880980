// Depth where the surface has none: it continues the surfaces around, moves behind what photographs
// see past, and never comes nearer.
#include <math.h>

#include "wall_scene.h"

enum { SIDE = 128, INNER = 20 };
static const double FOCAL = 128, WALL_Z = 4, BEHIND_Z = 8, BEFORE_Z = 3;

static struct orl_gpu *gpu;
static const double opening = 1.1; // half its side
static const struct orl_ground no_ground = {.height = 0};

// Squares of random brightness, half a unit wide, in 8 bits.
static uint8_t squares(double x, double y)
{
    uint32_t h = (uint32_t)(int)floor(2 * x) * 2654435761u ^ (uint32_t)(int)floor(2 * y) * 40503u;
    h = (h ^ h >> 15) * 2246822519u;
    return (uint8_t)(h >> 24);
}

// What a photograph from (eye, 0, 0) shows at a pixel: the green wall, or in its opening the
// squares in the plane z.
static void shade(double eye, double z, int i, int side, uint8_t rgb[3])
{
    double x = (i % side + 0.5 - side / 2) / FOCAL, y = (i / side + 0.5 - side / 2) / FOCAL;
    bool open = fabs(eye + WALL_Z * x) < opening && fabs(WALL_Z * y) < opening;
    uint8_t grey = squares(eye + z * x, z * y);
    memcpy(rgb, open ? (const uint8_t[3]){grey, grey, grey} : green, 3);
}

static void add_true_photo(struct fixture *f, double eye, double z)
{
    enum { PHOTO_SIDE = 2 * SIDE };
    add_photo(f, look_from(eye, 0, 0, PHOTO_SIDE, FOCAL), green);
    struct orl_image image;
    assert_int_equal(orl_image_init(NULL, &image, PHOTO_SIDE, PHOTO_SIDE, 3, ORL_PIXEL_U8), ORL_OK);
    for (int i = 0; i < PHOTO_SIDE * PHOTO_SIDE; i++)
        shade(eye, z, i, PHOTO_SIDE, &image.u8[3 * i]);
    repaint_photo(f, &image);
}

// The wall's points without those of the opening.
static void make_wall(struct orl_points *points)
{
    enum { WALL = 128 };
    size_t kept = 0;
    assert_int_equal(orl_points_init(NULL, points, WALL * WALL), ORL_OK);
    set_square(points, 0, WALL, 6, 0, (float)WALL_Z, green);
    for (size_t i = 0; i < WALL * WALL; i++) {
        const float *at = points->position[i];
        if (fabs((double)at[0]) < opening && fabs((double)at[1]) < opening)
            continue;
        memcpy(points->position[kept], at, sizeof points->position[kept]);
        kept++; // everything else is the same for all
    }
    points->count = kept;
}

// Photographs from four places, side by side.
static const double around[4] = {-0.7, -0.4, 0.3, 0.6};

// Options of oriel that try so many depths.
static struct orl_render_params with_depths(float depths)
{
    struct orl_render_params params = orl_method_find(NULL, "oriel")->params;
    params.guess_depths = depths;
    params.antialias = ORL_ANTIALIAS_OFF; // specks stay
    return params;
}

// Mean absolute error of the picture in the middle columns of some rows, with the squares in the plane z.
static double error_in_rows(const double eyes[4], float depths, double z, int first, int end,
                            const struct orl_ground *ground)
{
    struct fixture f;
    setup_empty(&f, WALL_Z);
    make_wall(&f.scene.points);
    f.scene.ground = *ground;
    for (size_t i = 0; i < 4; i++)
        add_true_photo(&f, eyes[i], z);
    struct orl_render_params params = with_depths(depths);
    params.guess_blur = 0;
    struct orl_frame frame = draw(gpu, &f, look_from(0, 0, 0, SIDE, FOCAL), &params, 0);
    double sum = 0;
    for (int y = first; y < end; y++)
        for (int x = SIDE / 2 - INNER; x < SIDE / 2 + INNER; x++) {
            uint8_t truth[3];
            shade(0, z, y * SIDE + x, SIDE, truth);
            sum += fabs(sqrt((double)color_at(&frame, x, y)[1]) -
                        pow(truth[1] / 255.0, 1.1)); // sRGB is about a power of 2.2
        }
    orl_frame_finish(&frame);
    teardown(&f);
    return sum / ((end - first) * 2 * INNER);
}

// The same in the middle of the opening.
static double error_with(const double eyes[4], float depths, double z)
{
    return error_in_rows(eyes, depths, z, SIDE / 2 - INNER, SIDE / 2 + INNER, &no_ground);
}

static void check_better(double rim, double tried)
{
    print_message("mean error: depth of the rim %.3f, depths tried %.3f\n", rim, tried);
    assert_true(rim > 0.1);
    assert_true(tried < 0.8 * rim);
}

static void photographs_tell_the_depth_behind_an_opening(void **state)
{
    (void)state;
    double rim = error_with(around, 0, BEHIND_Z), tried = error_with(around, 16, BEHIND_Z);
    check_better(rim, tried);
    assert_true(tried < 0.35 * rim); // neighbours help: a cell alone is farther off
}

// From far aside the wall hides the squares in the middle. What these photographs show instead is no
// reason to doubt the depth at which the others agree.
static void photographs_that_see_the_wall_have_no_say(void **state)
{
    (void)state;
    static const double eyes[4] = {-2.6, -0.4, 0.4, 2.6};
    double rim = error_with(eyes, 0, BEHIND_Z), tried = error_with(eyes, 16, BEHIND_Z);
    check_better(rim, tried);
    assert_true(tried < 0.3 * rim);
}

// The lowest cells of the opening have no neighbours below. Those beside and above them tell that the
// depth is worth leaving the rim's.
static void cells_at_the_rim_learn_from_all_sides(void **state)
{
    (void)state;
    const int end = SIDE / 2 + (int)(opening * FOCAL / WALL_Z) - 1, first = end - 4;
    check_better(error_in_rows(around, 0, BEHIND_Z, first, end, &no_ground),
                 error_in_rows(around, 16, BEHIND_Z, first, end, &no_ground));
}

// What photographs show behind the ground is not there: they agree at 8, and the ground lies at 5, as a wall.
static void nothing_moves_behind_the_ground(void **state)
{
    (void)state;
    const struct orl_ground wall = {.plane = {0, 0, -1, 5}, .height = 1};
    const int first = SIDE / 2 - INNER, end = SIDE / 2 + INNER;
    double before = error_in_rows(around, 16, BEHIND_Z, first, end, &wall), open = error_with(around, 16, BEHIND_Z);
    print_message("mean error: %.3f, before the ground %.3f\n", open, before);
    assert_true(before > 0.1 && before > 2 * open);
}

// The surfaces around an opening are its nearest background. Photographs that agree before it show
// something plain, or all the same thing by chance.
static void nothing_comes_before_the_background(void **state)
{
    (void)state;
    double rim = error_with(around, 0, BEFORE_Z), tried = error_with(around, 16, BEFORE_Z);
    print_message("mean error: depth of the rim %.4f, depths tried %.4f\n", rim, tried);
    assert_true(rim > 0.05);
    assert_float_equal(tried, rim, 0.1 * rim);
}

// A near plate in the middle and a far wall on the right, beside and above which a photograph from
// aside shows a ramp of grey. The depth there is a guess. It may change anywhere, but not in a line,
// as where a block of the pyramid ends that spreads it: the ramp moves on from pixel to pixel.
static void guesses_change_without_a_line(void **state)
{
    (void)state;
    enum { POINTS = 64, WIDE = 512, VIEW = 256, ROWS = 64 }; // the plate begins at row 89
    struct fixture f;
    setup_empty(&f, WALL_Z);
    assert_int_equal(orl_points_init(NULL, &f.scene.points, 2 * POINTS * POINTS), ORL_OK);
    set_square(&f.scene.points, 0, POINTS, 2.4, -0.6, (float)WALL_Z, green);
    set_square(&f.scene.points, POINTS * POINTS, POINTS, 40, 50, (float)(10 * WALL_Z), green);
    add_photo(&f, look_from(1, 0, 0, WIDE, FOCAL), green);
    struct orl_image image;
    assert_int_equal(orl_image_init(NULL, &image, WIDE, WIDE, 3, ORL_PIXEL_U8), ORL_OK);
    for (int i = 0; i < 3 * WIDE * WIDE; i++)
        image.u8[i] = (uint8_t)(i / 3 % WIDE / 2);
    repaint_photo(&f, &image);
    struct orl_render_params params = with_depths(16);
    params.guess_blur = 0;
    struct orl_frame frame = draw(gpu, &f, look_from(0, 0, 0, VIEW, FOCAL), &params, 0);
    double most = 0;
    for (int y = 0; y < ROWS; y++)
        for (int x = 0; x + 1 < VIEW; x++) {
            double here = pow((double)color_at(&frame, x, y)[1], 1 / 2.2);
            double next = pow((double)color_at(&frame, x + 1, y)[1], 1 / 2.2);
            most = fmax(most, fabs(next - here));
        }
    orl_frame_finish(&frame);
    teardown(&f);
    print_message("largest step: %.1f of 255\n", 255 * most);
    assert_true(most < 6.0 / 255); // a jump between the two depths: 14
}

// Mean error, in square roots of light, of a picture whose right part continues a slanting wall that
// has points on its left alone. A photograph from aside shows squares all over it. normals: the points
// have the wall's normals, else ones that face the view.
static double error_beside_slanting_wall(bool normals)
{
    enum { POINTS = 128, WIDE = 512, BESIDE = 12 };
    const double slope = 0.6, at_eye = 5, edge = -0.5, eye = 0.8; // z = at_eye + slope * x
    struct fixture f;
    setup_empty(&f, at_eye);
    assert_int_equal(orl_points_init(NULL, &f.scene.points, POINTS * POINTS), ORL_OK);
    struct orl_points *points = &f.scene.points;
    set_square(points, 0, POINTS, 6, -3 + edge, 0, green);
    for (size_t i = 0; i < POINTS * POINTS; i++) {
        points->position[i][2] = (float)(at_eye + slope * (double)points->position[i][0]);
        if (normals) {
            points->normal[i][0] = (float)(slope / sqrt(1 + slope * slope));
            points->normal[i][2] = (float)(-1 / sqrt(1 + slope * slope));
        }
    }
    add_photo(&f, look_from(eye, 0, 0, WIDE, FOCAL), green);
    struct orl_image image;
    assert_int_equal(orl_image_init(NULL, &image, WIDE, WIDE, 3, ORL_PIXEL_U8), ORL_OK);
    for (int i = 0; i < WIDE * WIDE; i++) {
        double x = (i % WIDE + 0.5 - WIDE / 2) / FOCAL, y = (i / WIDE + 0.5 - WIDE / 2) / FOCAL;
        double z = (at_eye + slope * eye) / (1 - slope * x);
        memset(&image.u8[3 * i], squares(eye + z * x, z * y), 3);
    }
    repaint_photo(&f, &image);
    struct orl_render_params params = with_depths(16);
    params.guess_blur = 0;
    struct orl_frame frame = draw(gpu, &f, look_from(0, 0, 0, SIDE, FOCAL), &params, 0);
    double sum = 0;
    for (int y = SIDE / 2 - INNER; y < SIDE / 2 + INNER; y++)
        for (int k = SIDE / 2; k < SIDE / 2 + BESIDE; k++) { // the points end at column 50
            double x = (k + 0.5 - SIDE / 2) / FOCAL, z = at_eye / (1 - slope * x);
            double truth = squares(z * x, z * (y + 0.5 - SIDE / 2) / FOCAL) / 255.0;
            sum += fabs(sqrt((double)color_at(&frame, k, y)[1]) - pow(truth, 1.1));
        }
    orl_frame_finish(&frame);
    teardown(&f);
    return sum / (2 * INNER * BESIDE);
}

static void guesses_continue_slanting_surfaces(void **state)
{
    (void)state;
    double flat = error_beside_slanting_wall(false), slanting = error_beside_slanting_wall(true);
    print_message("mean error: flat %.3f, slanting %.3f\n", flat, slanting);
    assert_true(flat > 0.05);
    assert_true(slanting < 0.75 * flat);
}

// Beside a plate its depth is guessed. There a photograph from aside sees a red wall far behind, which
// the plate hides from the view, so that nothing is at the guess. At greater depths it shows what is
// beside that wall, blue.
static void guesses_move_behind_what_photographs_see_past(void **state)
{
    (void)state;
    enum { POINTS = 96, WIDE = 512, AT = SIDE / 2 + 12 };
    const double eye = 3, wall_z = 12, wall_edge = -1;
    struct fixture f;
    setup_empty(&f, WALL_Z);
    assert_int_equal(orl_points_init(NULL, &f.scene.points, 2 * POINTS * POINTS), ORL_OK);
    set_square(&f.scene.points, 0, POINTS, 5, -2.5, (float)WALL_Z, green);
    set_square(&f.scene.points, POINTS * POINTS, POINTS, 20, wall_edge - 10, (float)wall_z, red);
    add_photo(&f, look_from(eye, 0, 0, WIDE, FOCAL), green);
    struct orl_image image;
    assert_int_equal(orl_image_init(NULL, &image, WIDE, WIDE, 3, ORL_PIXEL_U8), ORL_OK);
    for (int i = 0; i < WIDE * WIDE; i++) {
        double x = (i % WIDE + 0.5 - WIDE / 2) / FOCAL, y = (i / WIDE + 0.5 - WIDE / 2) / FOCAL;
        bool plate = eye + WALL_Z * x < 0 && fabs(WALL_Z * y) < 2.5;
        bool wall = eye + wall_z * x < wall_edge && fabs(wall_z * y) < 10;
        memcpy(&image.u8[3 * i], plate ? green : wall ? red : blue, 3);
    }
    repaint_photo(&f, &image);
    float seen[2][3];
    for (int moved = 0; moved < 2; moved++) {
        const struct orl_render_params params = with_depths(moved ? 16 : 0);
        struct orl_frame frame = draw(gpu, &f, look_from(0, 0, 0, SIDE, FOCAL), &params, 0);
        memcpy(seen[moved], color_at(&frame, AT, SIDE / 2), sizeof seen[moved]);
        orl_frame_finish(&frame);
    }
    teardown(&f);
    print_message("guess: red %.2f, blue %.2f; moved: red %.2f, blue %.2f\n", (double)seen[0][0],
                  (double)seen[0][2], (double)seen[1][0], (double)seen[1][2]);
    assert_true(seen[0][0] > 0.9f && seen[0][2] < 0.1f);
    assert_true(seen[1][2] > 0.9f && seen[1][0] < 0.1f);
}

// The share of dim green above a plate, at a column of the view, where depth is a guess. Two photographs from one
// place paint there: a red one with the view's axis, and a green one, which ends at column 96.
static double green_above_plate(int column)
{
    enum { POINTS = 64, WIDE = 2 * SIDE, END = 96 };
    static const uint8_t dim_red[3] = {128, 0, 0}, dim_green[3] = {0, 128, 0};
    struct fixture f;
    setup_empty(&f, WALL_Z);
    assert_int_equal(orl_points_init(NULL, &f.scene.points, POINTS * POINTS), ORL_OK);
    set_square(&f.scene.points, 0, POINTS, 2.4, -0.6, (float)WALL_Z, blue);
    struct orl_view left = look_from(0.2, 0, 0, WIDE, FOCAL);
    left.camera.cx = WIDE - (END - SIDE / 2);
    add_photo(&f, look_from(0.2, 0, 0, WIDE, FOCAL), dim_red);
    add_photo(&f, left, dim_green);
    struct orl_render_params params = with_depths(0);
    params.guess_blur = 0;
    struct orl_frame frame = draw(gpu, &f, look_from(0.2, 0, 0, SIDE, FOCAL), &params, 0);
    const float *seen = color_at(&frame, column, 8);
    double share = (double)(seen[1] / (seen[0] + seen[1]));
    orl_frame_finish(&frame);
    teardown(&f);
    return share;
}

static void guesses_are_feathered(void **state)
{
    (void)state;
    double inside = green_above_plate(10), at_border = green_above_plate(88);
    print_message("green: %.2f, eight pixels from the border %.2f\n", inside, at_border);
    assert_true(inside > 0.4 && inside < 0.7);
    assert_true(at_border > 0.02 && at_border < 0.8 * inside);
}

// A green plate at the lower left before blue, in a photograph of the lower half of the view. What is above is not in
// any photograph, and is background nearly always: the share of blue there, at the centre of the left.
static void what_no_photograph_shows_is_background(void **state)
{
    (void)state;
    enum { POINTS = 64, HALF = SIDE / 2 };
    struct fixture f;
    setup_empty(&f, WALL_Z);
    assert_int_equal(orl_points_init(NULL, &f.scene.points, POINTS * POINTS), ORL_OK);
    set_square(&f.scene.points, 0, POINTS, 2, -1, (float)WALL_Z, green);
    for (size_t i = 0; i < POINTS * POINTS; i++)
        f.scene.points.position[i][1] += 1;
    struct orl_view lower = look_from(0, 0, 0, SIDE, FOCAL);
    lower.camera.cy = 0;
    add_photo(&f, lower, blue);
    struct orl_image image;
    assert_int_equal(orl_image_init(NULL, &image, SIDE, SIDE, 3, ORL_PIXEL_U8), ORL_OK);
    for (int i = 0; i < SIDE * SIDE; i++)
        memcpy(&image.u8[3 * i], i % SIDE < HALF && i / SIDE < HALF ? green : blue, 3);
    repaint_photo(&f, &image);
    const struct orl_render_params params = with_depths(0);
    struct orl_frame frame = draw(gpu, &f, look_from(0, 0, 0, SIDE, FOCAL), &params, 0);
    const float *seen = color_at(&frame, SIDE / 4, SIDE / 4);
    double share = (double)(seen[2] / (seen[1] + seen[2]));
    orl_frame_finish(&frame);
    teardown(&f);
    print_message("blue: %.2f\n", share);
    assert_true(share > 0.7);
}

int main(void)
{
    gpu = gpu_test_device();
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(photographs_tell_the_depth_behind_an_opening),
        cmocka_unit_test(photographs_that_see_the_wall_have_no_say),
        cmocka_unit_test(cells_at_the_rim_learn_from_all_sides),
        cmocka_unit_test(nothing_moves_behind_the_ground),
        cmocka_unit_test(nothing_comes_before_the_background),
        cmocka_unit_test(guesses_change_without_a_line),
        cmocka_unit_test(guesses_continue_slanting_surfaces),
        cmocka_unit_test(guesses_move_behind_what_photographs_see_past),
        cmocka_unit_test(guesses_are_feathered),
        cmocka_unit_test(what_no_photograph_shows_is_background),
    };
    int failed = cmocka_run_group_tests_name("guess", tests, NULL, NULL);
    orl_gpu_destroy(&gpu);
    return failed;
}
