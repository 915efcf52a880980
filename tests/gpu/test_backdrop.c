// A plate on a turntable before something that rests, and one that photographs walk around.
#include <math.h>

#include "eval/search.h"
#include "wall_scene.h"

enum { SIDE = 128, SQUARE = 12, EYES = 7 };
static const double FOCAL = 128, PLATE_Z = 4, PLATE_HALF = 0.6, HOLE_HALF = 0.08, PI = 3.14159265358979;

static struct orl_gpu *gpu;

// From a circle around the plate, at this many degrees.
static struct orl_view view_at(double degrees)
{
    struct orl_view view = look_from(0, 0, 0, SIDE, FOCAL);
    double a = degrees * PI / 180;
    const double eye[3] = {PLATE_Z * sin(a), 0, PLATE_Z - PLATE_Z * cos(a)};
    const double target[3] = {0, 0, PLATE_Z}, up[3] = {0, -1, 0};
    view.cam_from_world = orl_pose_look_at(eye, target, up);
    return view;
}

static uint8_t pattern(int column, int row)
{
    uint32_t h = (uint32_t)column * 2654435761u ^ (uint32_t)row * 40503u;
    h = (h ^ h >> 15) * 2246822519u;
    return (uint8_t)(h >> 24);
}

// What a view shows at a pixel: the green plate, or squares of random brightness that rest in the
// picture, or else in the world, far away.
static void shade(const struct orl_view *view, bool rests, int x, int y, uint8_t rgb[3])
{
    const struct orl_pose *pose = &view->cam_from_world;
    const double ray[3] = {(x + 0.5 - SIDE / 2) / FOCAL, (y + 0.5 - SIDE / 2) / FOCAL, 1};
    double along[3], eye[3];
    orl_pose_centre(pose, eye);
    for (int k = 0; k < 3; k++)
        along[k] = pose->r[0][k] * ray[0] + pose->r[1][k] * ray[1] + pose->r[2][k] * ray[2];
    double to_plate = (PLATE_Z - eye[2]) / along[2];
    bool plate = fabs(eye[0] + to_plate * along[0]) < PLATE_HALF &&
                 fabs(eye[1] + to_plate * along[1]) < PLATE_HALF;
    int azimuth = (int)floor(FOCAL * atan2(along[0], along[2]) / SQUARE);
    int height = (int)floor(FOCAL * along[1] / hypot(along[0], along[2]) / SQUARE);
    uint8_t grey = rests ? pattern(x / SQUARE, y / SQUARE) : pattern(azimuth, height);
    memcpy(rgb, plate ? green : (const uint8_t[3]){grey, grey, grey}, 3);
}

// Photographs from so many degrees apart.
static void set_up(struct fixture *f, bool rests, double apart)
{
    enum { PLATE = 60 };
    struct orl_points *points = &f->scene.points;
    size_t kept = 0;
    setup_empty(f, PLATE_Z);
    assert_int_equal(orl_points_init(NULL, points, PLATE * PLATE), ORL_OK);
    set_square(points, 0, PLATE, 2 * PLATE_HALF, 0, (float)PLATE_Z, green);
    for (size_t i = 0; i < PLATE * PLATE; i++) { // but for a hole in its middle
        const float *at = points->position[i];
        if (fabs((double)at[0]) < HOLE_HALF && fabs((double)at[1]) < HOLE_HALF)
            continue;
        memcpy(points->position[kept++], at, sizeof points->position[0]);
    }
    points->count = kept;
    for (int k = 0; k < EYES; k++) {
        struct orl_view view = view_at(apart * (k - EYES / 2));
        struct orl_image image;
        add_photo(f, view, green);
        assert_int_equal(orl_image_init(NULL, &image, SIDE, SIDE, 3, ORL_PIXEL_U8), ORL_OK);
        for (int i = 0; i < SIDE * SIDE; i++)
            shade(&view, rests, i % SIDE, i / SIDE, &image.u8[3 * i]);
        repaint_photo(f, &image);
    }
}

static bool found(bool rests, double apart)
{
    struct fixture f;
    set_up(&f, rests, apart);
    const struct orl_search_params search = {.size_divide = 1, .gain_db = 0.05};
    struct orl_renderer *renderer = NULL;
    struct orl_choice choice;
    assert_int_equal(orl_renderer_create(gpu, &f.scene, NULL, &renderer), ORL_OK);
    assert_int_equal(orl_choice_make(NULL, NULL, ORL_SAMPLE_SRGB, "oriel", &(struct orl_names){0}, &choice), ORL_OK);
    assert_int_equal(orl_search_backdrop(NULL, renderer, &f.scene, &search, &choice), ORL_OK);
    bool found = f.scene.backdrop_rests;
    orl_renderer_destroy(&renderer);
    teardown(&f);
    return found;
}

static void photographs_tell_whether_it_rests(void **state)
{
    (void)state;
    assert_true(found(true, 10));
    assert_false(found(false, 10));
    // From nearly one place, what is far away is at the same place of the picture, too.
    assert_false(found(false, 0.1));
}

// Mean absolute error of the picture beside the plate, in roots of light; *hole: the green of the
// middle of the plate.
static double error_with(bool rests, double *hole)
{
    struct fixture f;
    struct orl_view view = view_at(5);
    set_up(&f, true, 10);
    f.scene.backdrop_rests = rests;
    struct orl_render_params params = orl_method_find(NULL, "oriel")->params;
    params.guess_blur = 0;
    struct orl_frame frame = draw(gpu, &f, view, &params, 0);
    double sum = 0;
    int count = 0;
    for (int y = 8; y < SIDE - 8; y++)
        for (int x = 8; x < SIDE - 8; x++) {
            uint8_t truth[3];
            shade(&view, true, x, y, truth);
            if (abs(x - SIDE / 2) < 30 && abs(y - SIDE / 2) < 30)
                continue;
            sum += fabs(sqrt((double)color_at(&frame, x, y)[1]) - pow(truth[1] / 255.0, 1.1));
            count++;
        }
    *hole = (double)color_at(&frame, SIDE / 2, SIDE / 2)[1];
    orl_frame_finish(&frame);
    teardown(&f);
    return sum / count;
}

static void a_backdrop_that_rests_is_painted_in_place(void **state)
{
    (void)state;
    double hole, moved = error_with(false, &hole), still = error_with(true, &hole);
    print_message("mean error: moves %.3f, rests %.3f; hole %.3f\n", moved, still, hole);
    assert_true(still < 0.02);
    assert_true(moved > 2 * still);
    assert_true(hole > 0.9); // the plate's own colour, not the backdrop's
}

int main(void)
{
    gpu = gpu_test_device();
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(photographs_tell_whether_it_rests),
        cmocka_unit_test(a_backdrop_that_rests_is_painted_in_place),
    };
    int failed = cmocka_run_group_tests_name("backdrop", tests, NULL, NULL);
    orl_gpu_destroy(&gpu);
    return failed;
}
