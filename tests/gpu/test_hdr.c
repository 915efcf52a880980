// Radiance: known answers on a wall, and a room seen all around.
#include <math.h>
#include <string.h>

#include "core/color.h"
#include "core/order.h"
#include "gpu_test.h"
#include "oriel/hdr.h"
#include "io/exr.h"
#include "io/picture.h"
#include "scene/upright.h"
#include "shared/render_blocks.h"

static struct orl_gpu *gpu;

enum { SIDE = 64, PHOTOS_MAX = 24, GRID = 100 };

struct fixture {
    char *dir;
    struct orl_scene scene;
    struct orl_photo photos[PHOTOS_MAX];
};

// --- scenes ---

static void setup(struct fixture *f, size_t points)
{
    memset(f, 0, sizeof *f);
    f->dir = test_dir_make();
    f->scene.dir = f->dir;
    f->scene.photos = f->photos;
    f->scene.photo_distance = 4;
    static const char *const folders[] = {"images", "images_linear"};
    for (size_t i = 0; i < ORL_COUNT(folders); i++) {
        char *path = orl_path_join(NULL, f->dir, folders[i]);
        assert_int_equal(orl_dir_make(NULL, path), ORL_OK);
        free(path);
    }
    assert_int_equal(orl_points_init(NULL, &f->scene.points, points), ORL_OK);
    f->scene.points.count = 0;
}

static void teardown(struct fixture *f)
{
    for (size_t i = 0; i < f->scene.photo_count; i++)
        free(f->photos[i].name);
    orl_points_finish(&f->scene.points);
    test_dir_remove(f->dir);
}

static void add_point(struct fixture *f, const double p[3], const double n[3], double radius)
{
    struct orl_points *points = &f->scene.points;
    for (int i = 0; i < 3; i++) {
        points->position[points->count][i] = (float)p[i];
        points->normal[points->count][i] = (float)n[i];
    }
    points->radius[points->count++] = (float)radius;
}

// A wall at z = 4, 8 units wide.
static void setup_wall(struct fixture *f)
{
    setup(f, GRID * GRID);
    for (int i = 0; i < GRID * GRID; i++)
        add_point(f, (double[]){8.0 * (i % GRID + 0.5) / GRID - 4,
                                8.0 * (i / GRID + 0.5) / GRID - 4, 4},
                  (double[]){0, 0, -1}, 12.0 / GRID);
}

static struct orl_view look(double x, double y)
{
    return (struct orl_view){.camera = {SIDE, SIDE, 50, 50, 0.5 * SIDE, 0.5 * SIDE},
                             .cam_from_world = {.r = {{1, 0, 0}, {0, 1, 0}, {0, 0, 1}},
                                                .t = {-x, -y, 0}}};
}

typedef void (*light_fn)(const struct orl_view *view, int x, int y, float light[3]);

// A photograph of `light` taken `ev` above the middle exposure.
static struct orl_photo *add_photo(struct fixture *f, struct orl_view view, double ev,
                                   light_fn light)
{
    struct orl_photo *photo = &f->photos[f->scene.photo_count];
    struct orl_image image;
    *photo = (struct orl_photo){.view = view, .exposure_ev = ev, .has_exposure = true,
                                .response = -1, .series = (int)lround(ev) + 8};
    photo->name = malloc(16);
    snprintf(photo->name, 16, "%zu.png", f->scene.photo_count);
    assert_int_equal(orl_image_init(NULL, &image, view.camera.width, view.camera.height, 3,
                                    ORL_PIXEL_U8), ORL_OK);
    for (int i = 0; i < view.camera.width * view.camera.height; i++) {
        float l[3];
        light(&view, i % view.camera.width, i / view.camera.width, l);
        for (int c = 0; c < 3; c++)
            image.u8[3 * i + c] =
                (uint8_t)lrintf(255 * orl_srgb_encode(l[c] * exp2f((float)ev)));
    }
    for (int c = 0; c < 3; c++)
        photo->gain[c] = exp2f((float)-ev);
    char *path = strdup(orl_scene_file(&f->scene, f->scene.photo_count++, ORL_FILE_PHOTO).text);
    assert_int_equal(orl_png_write(NULL, path, &image), ORL_OK);
    free(path);
    orl_image_finish(&image);
    return photo;
}

static struct orl_hdr_params params_of(enum orl_hdr_merge merge, const char *method)
{
    struct orl_hdr_params params = {ORL_HDR_DEFAULTS};
    params.merge = merge;
    params.render = orl_method_find(NULL, method)->params;
    if (strcmp(method, "airieau") == 0) // no photograph outvotes all others by its place
        snprintf(params.render.weight, sizeof params.render.weight, "equal");
    return params;
}

static struct orl_frame draw(struct fixture *f, const struct orl_hdr_params *params)
{
    struct orl_hdr *hdr;
    struct orl_frame frame;
    struct orl_view view = look(0, 0);
    assert_int_equal(orl_hdr_create(gpu, &f->scene, params, &hdr), ORL_OK);
    assert_int_equal(orl_hdr_draw(hdr, &view, NULL, &frame), ORL_OK);
    orl_hdr_destroy(&hdr);
    return frame;
}

// --- one wall, one colour ---

static const float WALL[3] = {0.5f, 0.25f, 0.125f};

static void wall_light(const struct orl_view *view, int x, int y, float light[3])
{
    (void)view, (void)x, (void)y;
    memcpy(light, WALL, sizeof WALL);
}

static void white_light(const struct orl_view *view, int x, int y, float light[3])
{
    (void)view, (void)x, (void)y;
    light[0] = light[1] = light[2] = 100;
}

static void black_light(const struct orl_view *view, int x, int y, float light[3])
{
    (void)view, (void)x, (void)y;
    memset(light, 0, 3 * sizeof *light);
}

static const size_t MIDDLE = (SIDE / 2) * SIDE + SIDE / 2;

static void assert_color(const struct orl_frame *frame, size_t pixel, const float expected[3],
                         double share)
{
    for (size_t c = 0; c < 3; c++)
        assert_float_equal(frame->color.f32[3 * pixel + c], expected[c],
                           (float)share * expected[c]);
}

static void the_photograph_that_does_not_clip_decides(void **state)
{
    (void)state;
    static const char *const methods[] = {"airieau", "oriel"};
    for (int merge = 0; merge < ORL_HDR_MERGE_COUNT; merge++)
        for (size_t m = 0; m < ORL_COUNT(methods); m++) {
            struct fixture f;
            setup_wall(&f);
            add_photo(&f, look(-0.2, 0), 0, wall_light);
            add_photo(&f, look(0, 0), 3, wall_light); // nearest, but all white
            struct orl_hdr_params params = params_of((enum orl_hdr_merge)merge, methods[m]);
            struct orl_frame frame = draw(&f, &params);
            assert_color(&frame, MIDDLE, WALL, 0.01);
            assert_true(frame.confidence.f32[MIDDLE] > 0.5f);
            orl_frame_finish(&frame);
            teardown(&f);
        }
}

static void the_darkest_decides_where_all_clip(void **state)
{
    (void)state;
    for (int merge = 0; merge < ORL_HDR_MERGE_COUNT; merge++) {
        struct fixture f;
        setup_wall(&f);
        add_photo(&f, look(0.3, 0), -2, white_light);
        add_photo(&f, look(0, 0), 1, white_light);
        struct orl_hdr_params params = params_of((enum orl_hdr_merge)merge, "oriel");
        struct orl_frame frame = draw(&f, &params);
        assert_color(&frame, MIDDLE, (float[]){4, 4, 4}, 0.1);
        assert_true(frame.confidence.f32[MIDDLE] > 0 && frame.confidence.f32[MIDDLE] < 0.01f);
        orl_frame_finish(&frame);
        teardown(&f);
    }
}

// The dark photograph shows the right half; of the left half the bright one tells only that there
// was at least an eighth.
static void what_clips_is_as_bright_as_its_surroundings(void **state)
{
    (void)state;
    static const float least[3] = {0.125f, 0.125f, 0.125f};
    for (int fill = 0; fill < ORL_FILL_COUNT; fill++) {
        struct fixture f;
        setup_wall(&f);
        add_photo(&f, look(2.56, 0), 0, wall_light);
        add_photo(&f, look(0, 0), 3, wall_light);
        struct orl_hdr_params params = params_of(ORL_HDR_FUSED, "oriel");
        params.render.fill = (enum orl_fill)fill;
        struct orl_frame frame = draw(&f, &params);
        assert_color(&frame, MIDDLE + SIDE / 4, WALL, 0.01);
        assert_color(&frame, MIDDLE - SIDE / 4, fill == ORL_FILL_NONE ? least : WALL, 0.01);
        assert_float_equal(frame.coverage.f32[MIDDLE - SIDE / 4], 1, 0);
        assert_true(frame.confidence.f32[MIDDLE - SIDE / 4] < 0.01f);
        orl_frame_finish(&frame);
        teardown(&f);
    }
}

// A strip of shade from x = 0 to 0.64 in the world, on the wall.
static void shaded_strip(const struct orl_view *view, int x, int y, float light[3])
{
    (void)y;
    double right = 4 * (x + 0.5 - view->camera.cx) / view->camera.fx - view->cam_from_world.t[0];
    for (int c = 0; c < 3; c++)
        light[c] = right > 0 && right < 0.64 ? WALL[c] / 64 : WALL[c];
}

// As above, but shade lies between what clips and what tells its light; it cannot be that dark.
static void what_clips_takes_nothing_from_shade(void **state)
{
    (void)state;
    struct fixture f;
    setup_wall(&f);
    add_photo(&f, look(2.56, 0), 0, shaded_strip);
    add_photo(&f, look(0, 0), 3, shaded_strip);
    struct orl_hdr_params params = params_of(ORL_HDR_FUSED, "oriel");
    struct orl_frame frame = draw(&f, &params);
    assert_color(&frame, MIDDLE + 4, (float[]){WALL[0] / 64, WALL[1] / 64, WALL[2] / 64}, 0.05);
    assert_color(&frame, MIDDLE - 3, WALL, 0.02);
    assert_color(&frame, MIDDLE - SIDE / 4, WALL, 0.02);
    orl_frame_finish(&frame);
    teardown(&f);
}

static void shade_light(const struct orl_view *view, int x, int y, float light[3])
{
    (void)view, (void)x, (void)y;
    for (int c = 0; c < 3; c++)
        light[c] = WALL[c] / 64;
}

// A leaf before the lens of one, say. A photograph alone that clips proves less.
static void several_that_clip_outvote_a_dark_one(void **state)
{
    (void)state;
    for (int clipped = 1; clipped <= 3; clipped += 2) {
        struct fixture f;
        setup_wall(&f);
        for (int i = 0; i < clipped; i++)
            add_photo(&f, look(0.1 * (i - 1), 0), 0, white_light);
        add_photo(&f, look(0.3, 0), 0, shade_light);
        struct orl_hdr_params params = params_of(ORL_HDR_FUSED, "oriel");
        struct orl_frame frame = draw(&f, &params);
        float light = frame.color.f32[3 * MIDDLE];
        assert_true(clipped > 1 ? light > 0.8f : light < 0.01f);
        orl_frame_finish(&frame);
        teardown(&f);
    }
}

// As many as are kept, and none is better: the limit is what each of them weighs.
static void photographs_that_tie_paint(void **state)
{
    (void)state;
    struct fixture f;
    setup_wall(&f);
    for (int i = 0; i < ORL_RADIANCE_KEPT; i++)
        add_photo(&f, look(0.2, 0), 0, wall_light);
    struct orl_hdr_params params = params_of(ORL_HDR_FUSED, "oriel");
    struct orl_frame frame = draw(&f, &params);
    assert_color(&frame, MIDDLE, WALL, 0.01);
    assert_true(frame.confidence.f32[MIDDLE] > 0.5f);
    orl_frame_finish(&frame);
    teardown(&f);
}

static void brighter_light(const struct orl_view *view, int x, int y, float light[3])
{
    (void)view, (void)x, (void)y;
    for (int c = 0; c < 3; c++)
        light[c] = 1.25f * WALL[c];
}

// The last photograph that is kept has faded out: the next one to take its place makes no step.
static void the_least_of_the_best_few_counts_nothing(void **state)
{
    (void)state;
    struct fixture f;
    setup_wall(&f);
    for (int i = 1; i < ORL_RADIANCE_KEPT; i++)
        add_photo(&f, look(0.2, 0), 0, wall_light);
    add_photo(&f, look(0.3, 0), 0, brighter_light);
    struct orl_hdr_params params = params_of(ORL_HDR_FUSED, "oriel");
    struct orl_frame frame = draw(&f, &params);
    assert_color(&frame, MIDDLE, WALL, 0.01);
    orl_frame_finish(&frame);
    teardown(&f);
}

// A sample that clips in part counts by the cube of the confidence in it.
static void what_clips_in_part_counts_less(void **state)
{
    (void)state;
    const struct orl_sensor sensor = {ORL_SENSOR_DEFAULTS};
    const double ev = 0.42, peak = 1.25 * (double)WALL[0] * exp2(ev);
    struct fixture f;
    setup_wall(&f);
    add_photo(&f, look(0.8, 0), 0, wall_light);
    add_photo(&f, look(0.8, 0), ev, brighter_light);
    struct orl_hdr_params params = params_of(ORL_HDR_FUSED, "oriel");
    struct orl_frame frame = draw(&f, &params);
    double cube = pow((double)orl_clip_trust(&sensor, (float)peak, (float)ev), 3);
    double brighter = 0.25 * cube / (1 + cube);
    assert_true(brighter > 0.03 && brighter < 0.07);
    assert_float_equal(frame.color.f32[3 * MIDDLE] / WALL[0], 1 + brighter, 0.012);
    orl_frame_finish(&frame);
    teardown(&f);
}

static uint8_t grey_value;

static void grey_light(const struct orl_view *view, int x, int y, float light[3])
{
    (void)view, (void)x, (void)y;
    light[0] = light[1] = light[2] = orl_srgb_decode((float)grey_value / 255);
}

static void grey_light_of_45(const struct orl_view *view, int x, int y, float light[3])
{
    (void)view, (void)x, (void)y;
    light[0] = light[1] = light[2] = orl_srgb_decode(45 / 255.0f);
}

// The weight cos(theta) / delta of Airieau 2012 is one where a photograph is farther by a tenth of the
// view's distance, here 4, so that it stands beside noise: two photographs straight behind the view,
// farther by a twentieth and by a fifth.
static void weights_are_in_units_of_the_distance(void **state)
{
    (void)state;
    const struct orl_sensor sensor = {ORL_SENSOR_DEFAULTS};
    struct fixture f;
    struct orl_view near = look(0, 0), far = look(0, 0);
    float light[3], other[3];
    setup_wall(&f);
    near.cam_from_world.t[2] = 0.2;
    far.cam_from_world.t[2] = 0.8;
    grey_value = 40;
    add_photo(&f, near, 0, grey_light);
    add_photo(&f, far, 0, grey_light_of_45);
    struct orl_hdr_params params = params_of(ORL_HDR_FUSED, "airieau");
    snprintf(params.render.weight, sizeof params.render.weight, "airieau");
    struct orl_frame frame = draw(&f, &params);
    grey_light(NULL, 0, 0, light);
    grey_light_of_45(NULL, 0, 0, other);
    double noise = (double)orl_relative_variance(&sensor, light, true) / (sensor.model * sensor.model);
    double first = 2 / (1 + 2 * noise), second = 0.5 / (1 + noise);
    double expected = (first * (double)light[0] + second * (double)other[0]) / (first + second);
    assert_float_equal(frame.color.f32[3 * MIDDLE], expected, 0.008 * expected);
    orl_frame_finish(&frame);
    teardown(&f);
}

// By the model of src/render/photos/radiance.c, which the shaders repeat.
static void confidence_is_that_of_the_noise(void **state)
{
    (void)state;
    static const uint8_t values[] = {2, 12, 40};
    const struct orl_sensor sensor = {ORL_SENSOR_DEFAULTS};
    for (size_t i = 0; i < ORL_COUNT(values); i++) {
        struct fixture f;
        setup_wall(&f);
        grey_value = values[i];
        add_photo(&f, look(0, 0), 0, grey_light);
        struct orl_hdr_params params = params_of(ORL_HDR_FUSED, "oriel");
        struct orl_frame frame = draw(&f, &params);
        float light[3];
        grey_light(NULL, 0, 0, light);
        double model = sensor.model * sensor.model;
        double expected = model / (model + (double)orl_relative_variance(&sensor, light, true));
        assert_true(expected > 0.001 && expected < 0.8);
        assert_float_equal(frame.confidence.f32[MIDDLE], expected, 0.03 * expected);
        orl_frame_finish(&frame);
        teardown(&f);
    }
}

// A plate of 2 x 2 pixels between the points of a tile at which photographs are chosen for it: rows 34
// and 38, columns 34 and 38. One photograph stands behind it, another one shows nothing else.
static void what_is_small_in_a_tile_is_painted(void **state)
{
    (void)state;
    enum { PLATE = 20, AT = 36 };
    const double at = (AT + 0.5 - SIDE / 2) / 50 * 2; // in the world, at depth 2
    struct fixture f;
    setup(&f, GRID * GRID + PLATE * PLATE);
    for (int i = 0; i < GRID * GRID; i++)
        add_point(&f, (double[]){8.0 * (i % GRID + 0.5) / GRID - 4, 8.0 * (i / GRID + 0.5) / GRID - 4, 4},
                  (double[]){0, 0, -1}, 12.0 / GRID);
    for (int i = 0; i < PLATE * PLATE; i++)
        add_point(&f, (double[]){at + 0.004 * (i % PLATE + 0.5 - PLATE / 2),
                                 at + 0.004 * (i / PLATE + 0.5 - PLATE / 2), 2}, (double[]){0, 0, -1}, 0.006);
    struct orl_view behind = look(0, 0), alone = look(at, at);
    behind.cam_from_world.t[2] = -2.5;
    alone.camera = (struct orl_camera){20, 20, 500, 500, 10, 10};
    add_photo(&f, behind, 0, wall_light);
    add_photo(&f, alone, 0, shade_light);
    struct orl_hdr_params params = params_of(ORL_HDR_FUSED, "oriel");
    params.render.front_layer = 0;
    struct orl_frame frame = draw(&f, &params);
    assert_float_equal(frame.depth.f32[AT * SIDE + AT], 2, 0.01);
    assert_color(&frame, AT * SIDE + AT, (float[]){WALL[0] / 64, WALL[1] / 64, WALL[2] / 64}, 0.1);
    assert_color(&frame, AT * SIDE + AT + 8, WALL, 0.01);
    orl_frame_finish(&frame);
    teardown(&f);
}

static void where_all_are_black_it_is_dark(void **state)
{
    (void)state;
    struct fixture f;
    setup_wall(&f);
    add_photo(&f, look(0.3, 0), -2, black_light);
    add_photo(&f, look(0, 0), 1, black_light);
    struct orl_hdr_params params = params_of(ORL_HDR_FUSED, "oriel");
    struct orl_frame frame = draw(&f, &params);
    for (size_t i = 0; i < 3 * SIDE * SIDE; i++)
        assert_true(frame.color.f32[i] >= 0 && frame.color.f32[i] < 1e-4f);
    assert_true(frame.confidence.f32[MIDDLE] < 0.01f);
    orl_frame_finish(&frame);
    teardown(&f);
}

// Nine stops darker than the others it reads 3 of 255 by noise: thirty times the light
// there is.
static void noisy_light(const struct orl_view *view, int x, int y, float light[3])
{
    (void)view, (void)x, (void)y;
    light[0] = light[1] = light[2] = 9e-4f * 64;
}

static void dim_light(const struct orl_view *view, int x, int y, float light[3])
{
    (void)view, (void)x, (void)y;
    light[0] = light[1] = light[2] = 0.002f;
}

static void noise_does_not_outvote_light(void **state)
{
    (void)state;
    struct fixture f;
    setup_wall(&f);
    add_photo(&f, look(0, 0), -6, noisy_light);
    add_photo(&f, look(0.3, 0), 3, dim_light);
    add_photo(&f, look(-0.3, 0), 3, dim_light);
    static const enum orl_hdr_merge merges[] = {ORL_HDR_FUSED, ORL_HDR_SERIES};
    for (size_t i = 0; i < ORL_COUNT(merges); i++) {
        struct orl_hdr_params params = params_of(merges[i], "oriel");
        struct orl_frame frame = draw(&f, &params);
        assert_color(&frame, MIDDLE, (float[]){0.002f, 0.002f, 0.002f}, 0.1);
        orl_frame_finish(&frame);
    }
    teardown(&f);
}

static void bright_light(const struct orl_view *view, int x, int y, float light[3])
{
    (void)view, (void)x, (void)y;
    for (int c = 0; c < 3; c++)
        light[c] = 6 * WALL[c];
}

static void what_moved_does_not_ghost(void **state)
{
    (void)state;
    struct fixture f;
    setup_wall(&f);
    add_photo(&f, look(0.02, 0), -2, bright_light); // passed by while this one was taken
    for (int i = 0; i < 4; i++)
        add_photo(&f, look(0.3 * cos(1.57 * i), 0.3 * sin(1.57 * i)), -2 + i % 2, wall_light);
    struct orl_hdr_params params = params_of(ORL_HDR_FUSED, "airieau");
    struct orl_frame frame = draw(&f, &params);
    assert_color(&frame, MIDDLE, WALL, 0.06); // the mean would be twice as bright
    orl_frame_finish(&frame);
    teardown(&f);
}

// White right of the middle.
static void half_white(const struct orl_view *view, int x, int y, float light[3])
{
    (void)view, (void)y;
    for (int c = 0; c < 3; c++)
        light[c] = x >= SIDE / 2 ? 50 : WALL[c];
}

static void clipped_pixels_leave_no_mark(void **state)
{
    (void)state;
    struct fixture f;
    setup_wall(&f);
    add_photo(&f, look(0, 0), 0, half_white);
    struct orl_hdr_params params = params_of(ORL_HDR_FUSED, "oriel");
    struct orl_frame frame = draw(&f, &params);
    // Filtered as they are, the last pixels before the edge would be brighter.
    assert_color(&frame, MIDDLE - 1, WALL, 0.01);
    assert_color(&frame, MIDDLE - 2, WALL, 0.01);
    orl_frame_finish(&frame);
    teardown(&f);
}

// Bright where x > edge in the world, at the wall.
static void edge_light(const struct orl_view *view, int x, double edge, float light[3])
{
    double pixel = 4 / view->camera.fx; // on the wall
    double left = (x - view->camera.cx) * pixel - view->cam_from_world.t[0];
    double share = fmin(fmax((left + pixel - edge) / pixel, 0), 1);
    for (int c = 0; c < 3; c++)
        light[c] = (float)(50 * share + (double)WALL[c] / 8 * (1 - share));
}

// Within a tile, so that probes see both sides.
static const double EDGE = 0.32;

static void right_edge(const struct orl_view *view, int x, int y, float light[3])
{
    (void)y;
    edge_light(view, x, EDGE, light);
}

static void misplaced_edge(const struct orl_view *view, int x, int y, float light[3])
{
    (void)y;
    edge_light(view, x, EDGE + 0.06, light); // by three quarters of a pixel
}

static void what_clips_beside_a_sample_makes_it_doubtful(void **state)
{
    (void)state;
    struct fixture f;
    setup_wall(&f);
    add_photo(&f, look(0.04, 0), 3, misplaced_edge); // near, half of its sample clips
    add_photo(&f, look(0.35, 0), -7, right_edge);
    struct orl_hdr_params params = params_of(ORL_HDR_FUSED, "oriel");
    struct orl_frame frame = draw(&f, &params);
    // The near photograph's other half is the dark side alone, nine stops below.
    assert_true(frame.color.f32[3 * (MIDDLE + 4)] > 50.0f / 8);
    orl_frame_finish(&frame);
    teardown(&f);
}

// --- cameras that are not sRGB ---

// Linear values, and a third of the light lost in the corners.
static void vignetted_light(const struct orl_view *view, int x, int y, float light[3])
{
    const struct orl_camera *c = &view->camera;
    double dx = x + 0.5 - c->cx, dy = y + 0.5 - c->cy;
    double r2 = (dx * dx + dy * dy) / (0.25 * (c->width * c->width + c->height * c->height));
    for (int i = 0; i < 3; i++)
        light[i] = orl_srgb_decode(WALL[i] * (float)(1 - r2 / 3));
}

static void response_and_vignetting_are_undone(void **state)
{
    (void)state;
    struct fixture f;
    struct orl_response response;
    setup_wall(&f);
    for (int c = 0; c < 3; c++)
        for (int v = 0; v < 256; v++)
            response.linear[c][v] = (float)v / 255;
    f.scene.responses = &response;
    f.scene.response_count = 1;
    struct orl_photo *photo = add_photo(&f, look(0, 0), 0, vignetted_light);
    photo->response = 0;
    photo->vignette[0] = -1.0f / 3;
    struct orl_hdr_params params = params_of(ORL_HDR_FUSED, "oriel");
    struct orl_frame frame = draw(&f, &params);
    assert_color(&frame, MIDDLE, WALL, 0.02);
    assert_color(&frame, 2 * SIDE + 2, WALL, 0.02);
    assert_color(&frame, 61 * SIDE + 33, WALL, 0.02);
    orl_frame_finish(&frame);
    teardown(&f);
}

static void root_of_wall_light(const struct orl_view *view, int x, int y, float light[3])
{
    (void)view, (void)x, (void)y;
    for (int c = 0; c < 3; c++)
        light[c] = sqrtf(WALL[c]);
}

// Two cameras, of which one has values of the root of the light, took one series.
static void cameras_of_one_series_keep_their_curves(void **state)
{
    (void)state;
    struct orl_response response;
    for (int c = 0; c < 3; c++)
        for (int v = 0; v < 256; v++)
            response.linear[c][v] = powf(orl_srgb_decode((float)v / 255), 2);
    for (int merge = 0; merge < ORL_HDR_MERGE_COUNT; merge++)
        for (int first = -1; first <= 0; first++) {
            struct fixture f;
            setup_wall(&f);
            f.scene.responses = &response;
            f.scene.response_count = 1;
            add_photo(&f, look(-0.2, 0), 0, first ? wall_light : root_of_wall_light)->response = first;
            add_photo(&f, look(0.2, 0), 0, first ? root_of_wall_light : wall_light)->response = -1 - first;
            struct orl_hdr_params params = params_of((enum orl_hdr_merge)merge, "oriel");
            struct orl_frame frame = draw(&f, &params);
            assert_color(&frame, MIDDLE, WALL, 0.02);
            orl_frame_finish(&frame);
            teardown(&f);
        }
}

static void linear_files_keep_their_range(void **state)
{
    (void)state;
    struct fixture f;
    setup_wall(&f);
    struct orl_photo *photo = add_photo(&f, look(0, 0), 0, wall_light);
    static float light[3 * SIDE * SIDE];
    for (size_t i = 0; i < ORL_COUNT(light); i++)
        light[i] = i / 3 % SIDE < SIDE / 2 ? 40 : 0.001f;
    struct orl_exr_params exr = {.width = SIDE, .height = SIDE, .channel_count = 3};
    for (int c = 0; c < 3; c++)
        exr.channels[c] = (struct orl_exr_channel){{"RGB"[c]}, false, light + c, 3};
    char *path = strdup(orl_scene_file(&f.scene, 0, ORL_FILE_LINEAR).text);
    assert_int_equal(orl_exr_write(NULL, path, &exr), ORL_OK);
    free(path);
    photo->linear = true;
    struct orl_hdr_params params = params_of(ORL_HDR_FUSED, "oriel");
    struct orl_frame frame = draw(&f, &params);
    assert_color(&frame, MIDDLE - 8, (float[]){40, 40, 40}, 0.01);
    assert_color(&frame, MIDDLE + 8, (float[]){0.001f, 0.001f, 0.001f}, 0.01);
    orl_frame_finish(&frame);
    teardown(&f);
}

// --- a room, all around ---

static const double ROOM = 3; // half its side

static void room_point(const double eye[3], const double ray[3], double p[3])
{
    double t = INFINITY;
    for (int i = 0; i < 3; i++)
        if (ray[i] != 0)
            t = fmin(t, ((ray[i] > 0 ? ROOM : -ROOM) - eye[i]) / ray[i]);
    for (int i = 0; i < 3; i++)
        p[i] = eye[i] + t * ray[i];
}

// Eight stops of light from one corner to the other, no two walls alike.
static void room_radiance(const double p[3], float light[3])
{
    double ev = 0.7 * p[0] + 0.5 * p[1] + 0.3 * p[2] + 0.3 * sin(2 * p[0] + p[1] - 3 * p[2]);
    light[0] = (float)(0.2 * exp2(ev));
    light[1] = (float)(0.2 * exp2(ev + 0.2 * sin(p[1] + 2 * p[2])));
    light[2] = (float)(0.2 * exp2(ev - 0.3 * sin(p[0] - p[2])));
}

static void room_light(const struct orl_view *view, int x, int y, float light[3])
{
    const struct orl_camera *c = &view->camera;
    const struct orl_pose *pose = &view->cam_from_world;
    double eye[3], ray[3], p[3], u = (x + 0.5 - c->cx) / c->fx, v = (y + 0.5 - c->cy) / c->fy;
    for (int i = 0; i < 3; i++)
        ray[i] = pose->r[0][i] * u + pose->r[1][i] * v + pose->r[2][i];
    orl_pose_centre(pose, eye);
    room_point(eye, ray, p);
    room_radiance(p, light);
}

// World: y down, as photographs are held. One photograph per direction and exposure.
static void setup_room(struct fixture *f)
{
    setup(f, 6 * GRID * GRID);
    for (int wall = 0; wall < 6; wall++)
        for (int i = 0; i < GRID * GRID; i++) {
            double p[3], n[3] = {0};
            p[(wall + 1) % 3] = 2 * ROOM * (i % GRID + 0.5) / GRID - ROOM;
            p[(wall + 2) % 3] = 2 * ROOM * (i / GRID + 0.5) / GRID - ROOM;
            p[wall % 3] = wall < 3 ? ROOM : -ROOM;
            n[wall % 3] = wall < 3 ? -1 : 1;
            add_point(f, p, n, 9.0 / GRID);
        }
    static const double towards[6][3] = {{0, 0, 1},  {1, 0.05, 0}, {0, 0, -1},
                                         {-1, 0.02, 0}, {0, -1, 0.02}, {0, 1, 0.02}};
    for (int i = 0; i < 18; i++) {
        const double *d = towards[i / 3], ev[] = {-3, 0, 3};
        double eye[3] = {0.4 * sin(2.1 * i), 0.3 * cos(3.3 * i), 0.4 * sin(1.3 * i + 1)}, target[3];
        for (int k = 0; k < 3; k++)
            target[k] = eye[k] + d[k];
        struct orl_view view = {.camera = {128, 128, 48, 48, 64, 64}};
        view.cam_from_world = orl_pose_look_at(eye, target, (double[]){0, -1, 0.01});
        add_photo(f, view, ev[i % 3], room_light);
    }
}

static void panoramas_show_what_is_there(void **state)
{
    (void)state;
    enum { W = 128, H = 64 };
    struct fixture f;
    setup_room(&f);
    struct orl_hdr *hdr;
    struct orl_frame frame;
    struct orl_hdr_params params = params_of(ORL_HDR_FUSED, "oriel");
    struct orl_panorama p = {.position = {0.5, 0.2, -0.3}, .forward = {1, 0.3, 0},
                             .width = W, .height = H};
    orl_scene_mean_up(&f.scene, p.up);
    assert_true(p.up[1] < -0.9);
    p.up[0] = p.up[2] = 0;
    assert_int_equal(orl_hdr_create(gpu, &f.scene, &params, &hdr), ORL_OK);
    assert_int_equal(orl_hdr_draw_panorama(hdr, &p, NULL, &frame), ORL_OK);
    static float errors[W * H];
    double border = 0, inner = 0;
    int borders = 0, surfaces = 0, facing = 0;
    for (int i = 0; i < W * H; i++) {
        // The image's middle looks along +x, the world's y being down.
        double longitude = M_PI - 2 * M_PI * (i % W + 0.5) / W;
        double latitude = M_PI / 2 - M_PI * (i / W + 0.5) / H;
        double right[3], down[3] = {0, 1, 0}, forward[3] = {1, 0, 0}, ray[3], hit[3];
        for (int k = 0; k < 3; k++) // right = down x forward
            right[k] = down[(k + 1) % 3] * forward[(k + 2) % 3] -
                       down[(k + 2) % 3] * forward[(k + 1) % 3];
        for (int k = 0; k < 3; k++)
            ray[k] = forward[k] * cos(longitude) * cos(latitude) -
                     right[k] * sin(longitude) * cos(latitude) - down[k] * sin(latitude);
        float truth[3];
        room_point(p.position, ray, hit);
        room_radiance(hit, truth);
        errors[i] = fabsf(log2f(orl_luminance(frame.color.f32 + 3 * i) / orl_luminance(truth)));
        assert_true(isfinite(errors[i]));
        double far = 0;
        for (int k = 0; k < 3; k++)
            far += (hit[k] - p.position[k]) * (hit[k] - p.position[k]);
        if (frame.depth.f32[i] > 0 && errors[i] < 0.05f)
            assert_float_equal(frame.depth.f32[i], sqrt(far), 0.06 * sqrt(far));
        if (frame.depth.f32[i] > 0) { // a wall's normal, in the panorama's frame
            int wall = fabs(hit[0]) > fabs(hit[1]) ? 0 : 1;
            wall = fabs(hit[2]) > fabs(hit[wall]) ? 2 : wall;
            const double *axes[3] = {right, down, forward};
            double cosine = 0;
            for (int k = 0; k < 3; k++)
                cosine += (double)frame.normal.f32[3 * i + k] * axes[k][wall] * (hit[wall] > 0 ? -1 : 1);
            surfaces++;
            facing += cosine > 0.98;
        }
        // Within 4 degrees of a border between two of the level faces.
        double off = fabs(remainder(longitude - M_PI / 4, M_PI / 2));
        bool near_border = off < 0.07 && fabs(latitude) < 0.5;
        border += near_border ? (double)errors[i] : 0;
        borders += near_border;
        inner += near_border ? 0 : (double)errors[i];
    }
    qsort(errors, W * H, sizeof *errors, orl_order_floats);
    assert_true(errors[W * H / 2] < 0.03f);
    assert_true(errors[W * H * 95 / 100] < 0.15f);
    assert_true(facing > 0.9 * surfaces && surfaces > W * H / 2);
    assert_true(border / borders < 1.5 * inner / (W * H - borders) + 0.01);
    orl_frame_finish(&frame);
    orl_hdr_destroy(&hdr);
    teardown(&f);
}

// The photographs look at a wall. What is behind them takes its colour.
static void panoramas_are_filled_where_none_looks(void **state)
{
    (void)state;
    enum { W = 64, H = 32 };
    for (int merge = 0; merge < ORL_HDR_MERGE_COUNT; merge++) {
        struct fixture f;
        struct orl_hdr *hdr;
        struct orl_frame frame;
        setup_wall(&f);
        add_photo(&f, look(0, 0), 0, wall_light);
        add_photo(&f, look(0.1, 0), -2, wall_light);
        struct orl_hdr_params params = params_of((enum orl_hdr_merge)merge, "oriel");
        params.render.fill = ORL_FILL_NONE;
        const struct orl_panorama p = {.forward = {0, 0, 1}, .up = {0, -1, 0}, .width = W, .height = H};
        assert_int_equal(orl_hdr_create(gpu, &f.scene, &params, &hdr), ORL_OK);
        assert_int_equal(orl_hdr_draw_panorama(hdr, &p, NULL, &frame), ORL_OK);
        const size_t middle = H / 2 * W + W / 2, behind = H / 2 * W;
        assert_color(&frame, middle, WALL, 0.03);
        assert_true(frame.confidence.f32[middle] > 0.5f);
        assert_color(&frame, behind, WALL, 0.1);
        assert_float_equal(frame.confidence.f32[behind], 0, 0);
        orl_frame_finish(&frame);
        orl_hdr_destroy(&hdr);
        teardown(&f);
    }
}

// Both merges see the same room, and finer samples do not change it.
static void merges_agree(void **state)
{
    (void)state;
    enum { W = 64, H = 48 };
    struct fixture f;
    setup_room(&f);
    struct orl_view view = {.camera = {W, H, 40, 40, W / 2.0, H / 2.0}};
    view.cam_from_world = orl_pose_look_at((double[]){0.3, 0, -0.5}, (double[]){2, 0.5, 2},
                                           (double[]){0, -1, 0});
    for (int variant = 0; variant < 3; variant++) {
        struct orl_hdr *hdr;
        struct orl_frame frame;
        struct orl_hdr_params params =
            params_of(variant == 1 ? ORL_HDR_SERIES : ORL_HDR_FUSED, "oriel");
        params.samples = variant == 2 ? 2 : 1;
        assert_int_equal(orl_hdr_create(gpu, &f.scene, &params, &hdr), ORL_OK);
        assert_int_equal(orl_hdr_draw(hdr, &view, NULL, &frame), ORL_OK);
        static float errors[W * H];
        for (int i = 0; i < W * H; i++) {
            float truth[3];
            room_light(&view, i % W, i / W, truth);
            errors[i] = fabsf(log2f(orl_luminance(frame.color.f32 + 3 * i) / orl_luminance(truth)));
        }
        qsort(errors, W * H, sizeof *errors, orl_order_floats);
        assert_true(errors[W * H / 2] < 0.03f);
        assert_true(errors[W * H * 95 / 100] < 0.12f);
        orl_frame_finish(&frame);
        orl_hdr_destroy(&hdr);
    }
    teardown(&f);
}

int main(void)
{
    gpu = gpu_test_device();
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(the_photograph_that_does_not_clip_decides),
        cmocka_unit_test(the_darkest_decides_where_all_clip),
        cmocka_unit_test(what_clips_is_as_bright_as_its_surroundings),
        cmocka_unit_test(what_clips_takes_nothing_from_shade),
        cmocka_unit_test(several_that_clip_outvote_a_dark_one),
        cmocka_unit_test(photographs_that_tie_paint),
        cmocka_unit_test(the_least_of_the_best_few_counts_nothing),
        cmocka_unit_test(what_clips_in_part_counts_less),
        cmocka_unit_test(weights_are_in_units_of_the_distance),
        cmocka_unit_test(confidence_is_that_of_the_noise),
        cmocka_unit_test(what_is_small_in_a_tile_is_painted),
        cmocka_unit_test(where_all_are_black_it_is_dark),
        cmocka_unit_test(noise_does_not_outvote_light),
        cmocka_unit_test(what_moved_does_not_ghost),
        cmocka_unit_test(clipped_pixels_leave_no_mark),
        cmocka_unit_test(what_clips_beside_a_sample_makes_it_doubtful),
        cmocka_unit_test(response_and_vignetting_are_undone),
        cmocka_unit_test(cameras_of_one_series_keep_their_curves),
        cmocka_unit_test(linear_files_keep_their_range),
        cmocka_unit_test(panoramas_show_what_is_there),
        cmocka_unit_test(panoramas_are_filled_where_none_looks),
        cmocka_unit_test(merges_agree),
    };
    int failed = cmocka_run_group_tests(tests, NULL, NULL);
    orl_gpu_destroy(&gpu);
    return failed;
}
