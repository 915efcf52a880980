// Undistortion against known answers and against COLMAP's own.
#include "test.h"

#include <math.h>

#include "core/process.h"
#include "io/picture.h"
#include "scene/colmap.h"

static char *dir;

static int set_up(void **state)
{
    (void)state;
    dir = test_dir_make();
    return dir ? 0 : -1;
}

static int tear_down(void **state)
{
    (void)state;
    test_dir_remove(dir);
    return 0;
}

static const char *in_dir(char path[4096], const char *name)
{
    snprintf(path, 4096, "%s/%s", dir, name);
    return path;
}

enum { W = 240, H = 160 };

static const struct camera_case {
    const char *model, *params;
    double ray[2], pixel[2]; // by hand, with f 200, centre (121, 79)
} cases[] = {
    {"SIMPLE_PINHOLE", "200 121 79", {0.3, 0.4}, {181, 159}},
    {"PINHOLE", "200 210 121 79", {0.3, 0.4}, {181, 163}},
    // r^2 = 0.25: 1 + 0.1 * 0.25 = 1.025
    {"SIMPLE_RADIAL", "200 121 79 0.1", {0.3, 0.4}, {182.5, 161}},
    // 1 + 0.1 * 0.25 - 0.2 * 0.0625 = 1.0125
    {"RADIAL", "200 121 79 0.1 -0.2", {0.3, 0.4}, {181.75, 160}},
    // + 2 p1 u v + p2 (r2 + 2 u^2) = 0.00240 + 0.00860; 2 p2 u v + p1 (r2 + 2 v^2)
    // = 0.00480 + 0.00570
    {"OPENCV", "200 210 121 79 0.1 -0.2 0.01 0.02", {0.3, 0.4}, {183.95, 166.255}},
    // tan(45 degrees) off the axis: theta = pi / 4
    {"OPENCV_FISHEYE", "200 200 121 79 0 0 0 0", {1, 0}, {278.0796, 79}},
    {"SIMPLE_RADIAL_FISHEYE", "200 121 79 0.1", {1, 0}, {287.7692, 79}},
    {"RADIAL_FISHEYE", "200 121 79 0.1 0.1", {1, 0}, {293.7462, 79}},
    // (1 + 0.025) / (1 + 0.1 * 0.25) = 1
    {"FULL_OPENCV", "200 200 121 79 0.1 0 0 0 0 0.1 0 0", {0.3, 0.4}, {181, 159}},
    // atan(2 tan(0.5)) = 0.829623
    {"FOV", "200 200 121 79 1", {1, 0}, {286.9246, 79}},
    // fisheye first: u = pi / 4, then sx1 r^2 = 0.01 * 0.61685
    {"THIN_PRISM_FISHEYE", "200 200 121 79 0 0 0 0 0 0 0.01 0", {1, 0}, {279.3133, 79}},
    // u = (pi / 4) (1 + 0.1 (pi / 4)^2) = 0.833846, r^2 = 0.695298, r^4 = 0.483440; x: 2 p0 u^2 + (p0 +
    // s0) r^2 + s1 r^4; y: (p1 + s2) r^2 + s3 r^4
    {"RAD_TAN_THIN_PRISM_FISHEYE", "200 200 121 79 0.1 0 0 0 0 0 0.01 0.02 0.03 0.04 0.05 0.06", {1, 0},
     {299.9802, 94.5355}},
    // d / (1 - 0.1 d^2) = 1: d = 0.916080
    {"SIMPLE_DIVISION", "200 121 79 -0.1", {1, 0}, {304.2160, 79}},
    {"DIVISION", "200 100 121 79 -0.1", {0, 1}, {121, 170.6080}},
    {"SIMPLE_FISHEYE", "200 121 79", {1, 0}, {278.0796, 79}},
    {"FISHEYE", "200 100 121 79", {0, 1}, {121, 157.5398}},
    // 1 / (0.5 sqrt(1.2 + 1) + 0.5) = 0.805399
    {"EUCM", "200 100 121 79 0.5 1.2", {1, 0}, {282.0799, 79}},
};

static void write_model(const char *to, const struct camera_case *c)
{
    assert_int_equal(orl_dir_make(NULL, to), ORL_OK);
    FILE *file = test_create(to, "cameras.txt");
    fprintf(file, "1 %s %d %d %s\n", c->model, W, H, c->params);
    fclose(file);
    file = test_create(to, "images.txt");
    fprintf(file, "1 1 0 0 0 0 0 0 1 a.png\n\n2 1 0 0 0 1 0 0 1 b.png\n\n");
    fclose(file);
    fclose(test_create(to, "points3D.txt"));
}

static void each_model_by_hand(void **state)
{
    (void)state;
    char path[4096];
    for (size_t i = 0; i < ORL_COUNT(cases); i++) {
        struct orl_colmap_model model = {0};
        double pixel[2];
        write_model(in_dir(path, "model"), &cases[i]);
        assert_int_equal(orl_colmap_read(NULL, path, &model), ORL_OK);
        orl_colmap_camera_project(&model.cameras[0], cases[i].ray, pixel);
        assert_float_equal(pixel[0], cases[i].pixel[0], 1e-3);
        assert_float_equal(pixel[1], cases[i].pixel[1], 1e-3);
        orl_colmap_camera_project(&model.cameras[0], (const double[2]){0, 0}, pixel);
        assert_float_equal(pixel[0], 121, 1e-9);
        assert_float_equal(pixel[1], 79, 1e-9);
        orl_colmap_finish(&model);
    }
}

// A corner at a tangent of r is reached while r + k r^3 rises so far: with k = -0.3 it turns back at
// 1.05, where it is 0.70.
static void bent_cameras_do_not_reach_corners(void **state)
{
    (void)state;
    const struct {
        double focal, k;
        bool reaches;
    } cameras[] = {{100, 0, true}, {100, 0.3, true}, {150, -0.3, true}, {138, -0.3, false},
                   {100, -2, false}};
    for (size_t i = 0; i < ORL_COUNT(cameras); i++) {
        double f = cameras[i].focal;
        const struct orl_colmap_camera camera = {
            .model = 2, .pinhole = {.width = 160, .height = 120, .fx = f, .fy = f, .cx = 80,
                                    .cy = 60},
            .params = {f, 80, 60, cameras[i].k}, .param_count = 4};
        assert_int_equal(orl_colmap_camera_reaches_corners(&camera), cameras[i].reaches);
    }
}

static struct orl_image pattern(void)
{
    struct orl_image image;
    assert_int_equal(orl_image_init(NULL, &image, W, H, 3, ORL_PIXEL_U8), ORL_OK);
    for (int y = 0; y < H; y++)
        for (int x = 0; x < W; x++)
            for (int c = 0; c < 3; c++)
                image.u8[3 * (y * W + x) + c] =
                    (uint8_t)(128 + 70 * sin(0.35 * x + c) + 50 * cos(0.27 * y + 0.05 * x * c));
    return image;
}

// Mean difference over pixels that are not black in either.
static double difference(const struct orl_image *a, const struct orl_image *b)
{
    double sum = 0, count = 0;
    assert_int_equal(a->width, b->width);
    assert_int_equal(a->height, b->height);
    for (size_t i = 0; i < orl_image_bytes(a); i++)
        if (a->u8[i] && b->u8[i]) {
            sum += abs(a->u8[i] - b->u8[i]);
            count++;
        }
    assert_true(count > 0.95 * (double)orl_image_bytes(a));
    return sum / count;
}

// False when COLMAP is not installed.
static bool colmap_undistorts(const char *max_size)
{
    char images[4096], model[4096], out[4096], log[4096];
    in_dir(out, "out");
    assert_int_equal(orl_dir_remove(NULL, out), ORL_OK);
    assert_int_equal(orl_dir_make(NULL, out), ORL_OK);
    const char *const argv[] = {"colmap", "image_undistorter", "--image_path",
                                in_dir(images, "images"), "--input_path", in_dir(model, "model"),
                                "--output_path", out, "--max_image_size", max_size, NULL};
    const char *const env[] = {"QT_QPA_PLATFORM=offscreen", NULL};
    enum orl_result result = orl_process_run(
        NULL, &(struct orl_process_params){.argv = argv, .env = env,
                                           .log_path = in_dir(log, "log")}, NULL);
    if (result == ORL_ERR_NOT_FOUND)
        return false;
    assert_int_equal(result, ORL_OK);
    return true;
}

static void compare_with_colmap(const struct camera_case *c, const char *max_size, double limit)
{
    char path[4096];
    struct orl_image image = pattern(), ours, theirs;
    struct orl_colmap_model from = {0}, to = {0};
    assert_int_equal(orl_dir_make(NULL, in_dir(path, "images")), ORL_OK);
    assert_int_equal(orl_png_write(NULL, in_dir(path, "images/a.png"), &image), ORL_OK);
    assert_int_equal(orl_png_write(NULL, in_dir(path, "images/b.png"), &image), ORL_OK);
    write_model(in_dir(path, "model"), c);
    if (!colmap_undistorts(max_size)) {
        printf("skipped: COLMAP is not installed\n");
        skip();
    }
    assert_int_equal(orl_colmap_read(NULL, in_dir(path, "model"), &from), ORL_OK);
    assert_int_equal(orl_colmap_read(NULL, in_dir(path, "out/sparse"), &to), ORL_OK);
    assert_int_equal(orl_undistort(NULL, &from.cameras[0], &to.cameras[0].pinhole, &image, &ours),
                     ORL_OK);
    assert_int_equal(orl_picture_read(NULL, in_dir(path, "out/images/a.png"), 3, &theirs), ORL_OK);
    double mean = difference(&ours, &theirs);
    printf("%s to %dx%d: %.3f of 255\n", c->model, ours.width, ours.height, mean);
    assert_true(mean < limit);
    orl_colmap_finish(&from);
    orl_colmap_finish(&to);
    orl_image_finish(&image);
    orl_image_finish(&ours);
    orl_image_finish(&theirs);
}

static void as_colmap_does(void **state)
{
    (void)state;
    const struct camera_case some[] = {
        {"SIMPLE_RADIAL", "200 121 79 -0.08", {0}, {0}},
        {"OPENCV", "200 205 121 79 -0.1 0.05 0.003 -0.002", {0}, {0}},
        {"RADIAL_FISHEYE", "200 121 79 0.02 0.01", {0}, {0}},
    };
    for (size_t i = 0; i < ORL_COUNT(some); i++)
        compare_with_colmap(&some[i], "-1", 1);
    // Their filter for smaller pictures is another.
    compare_with_colmap(&some[0], "150", 4);
}

// Stripes of one and a half new pixels, which these cannot hold, become grey: plain averages of 8 pixels would
// leave an amplitude of 41 of 100, as coarser stripes that nobody photographed. The mean light stays.
static void reduces_without_aliasing(void **state)
{
    (void)state;
    enum { SCALE = 8, WIDTH = 40 * SCALE, HEIGHT = 6 * SCALE };
    const struct orl_camera whole = {WIDTH, HEIGHT, 200, 200, WIDTH / 2, HEIGHT / 2};
    const struct orl_camera to = orl_camera_resized(&whole, WIDTH / SCALE, HEIGHT / SCALE);
    const struct orl_colmap_camera from = {.model = 1, .pinhole = whole, .param_count = 4,
                                           .params = {200, 200, WIDTH / 2, HEIGHT / 2}};
    struct orl_image stripes, reduced;
    double sum = 0;
    assert_int_equal(orl_image_init(NULL, &stripes, WIDTH, HEIGHT, 1, ORL_PIXEL_U8), ORL_OK);
    for (int i = 0; i < WIDTH * HEIGHT; i++)
        stripes.u8[i] = (uint8_t)lrint(128 + 100 * sin(2 * M_PI / 12 * (i % WIDTH)));
    assert_int_equal(orl_undistort(NULL, &from, &to, &stripes, &reduced), ORL_OK);
    for (int x = 2; x < to.width - 2; x++) {
        assert_float_equal(reduced.u8[3 * to.width + x], 128, 25);
        sum += reduced.u8[3 * to.width + x];
    }
    assert_float_equal(sum / (to.width - 4), 128, 0.5);
    orl_image_finish(&stripes);
    orl_image_finish(&reduced);
}

static void floats_as_bytes(void **state)
{
    (void)state;
    struct orl_colmap_model model = {0};
    char path[4096];
    write_model(in_dir(path, "model"), &cases[2]);
    assert_int_equal(orl_colmap_read(NULL, path, &model), ORL_OK);
    const struct orl_camera to = {200, 140, 210, 210, 100, 70};
    struct orl_image image = pattern(), light, a, b;
    assert_int_equal(orl_image_init(NULL, &light, W, H, 3, ORL_PIXEL_F32), ORL_OK);
    for (size_t i = 0; i < orl_image_bytes(&image); i++)
        light.f32[i] = image.u8[i];
    assert_int_equal(orl_undistort(NULL, &model.cameras[0], &to, &image, &a), ORL_OK);
    assert_int_equal(orl_undistort(NULL, &model.cameras[0], &to, &light, &b), ORL_OK);
    for (size_t i = 0; i < orl_image_bytes(&a); i++)
        assert_true(fabs(a.u8[i] - (double)b.f32[i]) < 2);
    orl_image_finish(&a);
    orl_image_finish(&b);
    const struct orl_image wrong = {.width = W - 1, .height = H, .channels = 3};
    assert_int_equal(orl_undistort(NULL, &model.cameras[0], &to, &wrong, &a), ORL_ERR_DATA);
    orl_image_finish(&image);
    orl_image_finish(&light);
    orl_colmap_finish(&model);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(each_model_by_hand),
        cmocka_unit_test(bent_cameras_do_not_reach_corners),
        cmocka_unit_test(as_colmap_does),
        cmocka_unit_test(reduces_without_aliasing),
        cmocka_unit_test(floats_as_bytes),
    };
    return cmocka_run_group_tests(tests, set_up, tear_down);
}
