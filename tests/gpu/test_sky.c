// A plate below skies of different days: what photographs tell of their skies, and the plain one of a
// view.
#include <math.h>

#include "core/color.h"
#include "preprocess/cloud/sky_stage.h"
#include "scene/sky.h"
#include "wall_scene.h"

enum { SIDE = 128, EYES = 4 };
static const double FOCAL = 128, PLATE_Z = 4, PLATE_HALF = 0.6;
static const uint8_t ground[3] = {60, 50, 40}, crown[3] = {20, 60, 20};
static const uint8_t skies[EYES][3] = {{250, 250, 250}, {130, 130, 140}, {110, 150, 230},
                                       {200, 180, 170}};

static struct orl_gpu *gpu;

// What a view shows at a pixel: the plate, the crown of a tree over it, the sky above the horizon.
static const uint8_t *shade(const struct orl_view *view, const uint8_t sky[3], int x, int y)
{
    const struct orl_pose *pose = &view->cam_from_world;
    const double ray[3] = {(x + 0.5 - SIDE / 2) / FOCAL, (y + 0.5 - SIDE / 2) / FOCAL, 1};
    double along[3], eye[3];
    orl_pose_centre(pose, eye);
    for (int k = 0; k < 3; k++)
        along[k] = pose->r[0][k] * ray[0] + pose->r[1][k] * ray[1] + pose->r[2][k] * ray[2];
    double far = (PLATE_Z - eye[2]) / along[2];
    double at_x = eye[0] + far * along[0], at_y = eye[1] + far * along[1];
    if (fabs(at_x) < PLATE_HALF && fabs(at_y) < PLATE_HALF)
        return green;
    if (fabs(at_x - 1) < 0.4 && fabs(at_y + 1.2) < 0.3)
        return crown;
    return along[1] < 0 ? sky : ground;
}

static void add_day(struct fixture *f, struct orl_view view, const uint8_t sky[3])
{
    struct orl_image image;
    add_photo(f, view, green);
    assert_int_equal(orl_image_init(NULL, &image, SIDE, SIDE, 3, ORL_PIXEL_U8), ORL_OK);
    for (int i = 0; i < SIDE * SIDE; i++)
        memcpy(&image.u8[3 * i], shade(&view, sky, i % SIDE, i / SIDE), 3);
    repaint_photo(f, &image);
}

static void set_up(struct fixture *f)
{
    enum { PLATE = 60 };
    setup_empty(f, PLATE_Z);
    assert_int_equal(orl_points_init(NULL, &f->scene.points, PLATE * PLATE), ORL_OK);
    set_square(&f->scene.points, 0, PLATE, 2 * PLATE_HALF, 0, (float)PLATE_Z, green);
    for (int k = 0; k < EYES; k++)
        add_day(f, look_from(0.2 * k - 0.3, 0, 0, SIDE, FOCAL), skies[k]);
}

// The same view from a camera that lies on its side.
static struct orl_view laid(struct orl_view view)
{
    struct orl_pose old = view.cam_from_world;
    for (int k = 0; k < 3; k++) {
        view.cam_from_world.r[0][k] = old.r[1][k];
        view.cam_from_world.r[1][k] = -old.r[0][k];
    }
    view.cam_from_world.t[0] = old.t[1];
    view.cam_from_world.t[1] = -old.t[0];
    return view;
}

static void photographs_tell_their_skies(void **state)
{
    (void)state;
    static const uint8_t night[3] = {10, 10, 10};
    struct fixture f;
    set_up(&f);
    add_day(&f, laid(look_from(0, 0, 0, SIDE, FOCAL)), skies[2]);
    add_day(&f, look_from(0, 0, 0, SIDE, FOCAL), night);
    f.photos[1].test = true;
    assert_int_equal(orl_skies_find(NULL, &f.scene), ORL_OK);
    assert_false(f.photos[1].has_sky); // held out
    assert_false(f.photos[EYES + 1].has_sky);
    for (int i = 0; i <= EYES; i++)
        for (int c = 0; i != 1 && c < 3; c++) {
            float light = orl_srgb_decode(skies[i < EYES ? i : 2][c] / 255.0f);
            assert_true(f.photos[i].has_sky);
            assert_float_equal(f.photos[i].sky[c], light, 1e-3);
            assert_true(f.photos[i].sky_spread < 1e-3f);
        }
    teardown(&f);
}

static void cameras_tell_upwards(void **state)
{
    (void)state;
    static const double eyes[][3] = {{3, 0, 0}, {0, 0, -3}, {-2, 0.3, -2}, {2, 0.1, -2}};
    struct fixture f = {0};
    double up[3];
    f.scene.photos = f.photos;
    f.scene.photo_count = ORL_COUNT(eyes);
    for (size_t i = 0; i < ORL_COUNT(eyes); i++) { // all look up, at a tower's top
        const double target[3] = {0, -2, 0}, skywards[3] = {0, -1, 0};
        f.photos[i].view.cam_from_world = orl_pose_look_at(eyes[i], target, skywards);
    }
    f.photos[1].view = laid(f.photos[1].view);
    orl_scene_upwards(&f.scene, up);
    assert_true(up[1] < -0.999);
    f.scene.ground = (struct orl_ground){.plane = {0, 0, 1, 0}, .height = 1};
    orl_scene_upwards(&f.scene, up);
    assert_float_equal(up[2], 1, 0);
}

static void skies_of_one_day_do_not_differ(void **state)
{
    (void)state;
    struct fixture f;
    set_up(&f);
    assert_int_equal(orl_skies_find(NULL, &f.scene), ORL_OK);
    assert_true(orl_skies_differ(&f.scene));
    for (int i = 1; i < EYES; i++)
        memcpy(f.photos[i].sky, f.photos[0].sky, sizeof f.photos[0].sky);
    assert_false(orl_skies_differ(&f.scene));
    teardown(&f);
}

static struct orl_frame draw_with(float plain_sky, bool lies)
{
    struct fixture f;
    struct orl_view view = look_from(0, 0, 0, SIDE, FOCAL);
    set_up(&f);
    assert_int_equal(orl_skies_find(NULL, &f.scene), ORL_OK);
    struct orl_render_params params = orl_method_find(NULL, "oriel")->params;
    params.plain_sky = plain_sky;
    params.guess_blur = 0;
    struct orl_frame frame = draw(gpu, &f, lies ? laid(view) : view, &params, 0);
    teardown(&f);
    return frame;
}

static void expect_same(const struct orl_frame *a, const struct orl_frame *b, int x, int y)
{
    for (int c = 0; c < 3; c++)
        assert_float_equal(color_at(a, x, y)[c], color_at(b, x, y)[c], 0);
}

static void the_sky_is_the_mean_of_all(void **state)
{
    (void)state;
    struct orl_frame plain = draw_with(1, false), own = draw_with(0, false);
    struct orl_frame lies = draw_with(1, true);
    for (int c = 0; c < 3; c++) {
        float root = 0;
        for (int k = 0; k < EYES; k++)
            root += sqrtf(orl_srgb_decode(skies[k][c] / 255.0f)) / EYES;
        for (int x = 16; x < SIDE - 48; x += 8)
            assert_float_equal(color_at(&plain, x, 20)[c], root * root, 0.01);
        assert_float_equal(color_at(&lies, 20, SIDE - 1 - 48)[c], root * root, 0.01);
    }
    expect_same(&plain, &own, SIDE / 2, SIDE / 2);      // the plate
    expect_same(&plain, &own, SIDE / 2, SIDE - 16);     // below it
    expect_same(&plain, &own, 16, SIDE - 40);           // below the horizon
    expect_same(&plain, &own, SIDE / 2 + 32, SIDE / 2 - 38); // the crown
    assert_true(color_at(&plain, SIDE / 2 + 32, SIDE / 2 - 38)[0] < 0.1f);
    orl_frame_finish(&plain);
    orl_frame_finish(&own);
    orl_frame_finish(&lies);
}

int main(void)
{
    gpu = gpu_test_device();
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(photographs_tell_their_skies),
        cmocka_unit_test(cameras_tell_upwards),
        cmocka_unit_test(skies_of_one_day_do_not_differ),
        cmocka_unit_test(the_sky_is_the_mean_of_all),
    };
    int failed = cmocka_run_group_tests_name("sky", tests, NULL, NULL);
    orl_gpu_destroy(&gpu);
    return failed;
}
