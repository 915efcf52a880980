// Synthetic monuments: is the truth true, and do the files say the same?
#include <math.h>
#include <string.h>

#include "gpu_test.h"

#include "datasets/synth.h"
#include "io/exr.h"
#include "io/picture.h"
#include "scene/colmap.h"

enum { WIDTH = 168, HEIGHT = 112, VIEW_COUNT = 14, RUN_COUNT = 3 };

static struct orl_gpu *gpu;

static struct orl_synth_params small_params(void)
{
    struct orl_synth_params params = {ORL_SYNTH_DEFAULTS};
    params.width = WIDTH;
    params.height = HEIGHT;
    params.count = VIEW_COUNT;
    return params;
}

// --- views drawn once for the tests of the truth ---

struct drawn {
    struct orl_view views[VIEW_COUNT];
    struct orl_synth_frame a, b; // of neighbouring views
    int index_a, index_b;
};

static struct drawn drawn;

static int draw_views(void **state)
{
    (void)state;
    struct orl_synth_params params = small_params();
    struct orl_synth *synth;
    drawn.index_a = VIEW_COUNT / 2;
    drawn.index_b = VIEW_COUNT / 2 + 1;
    orl_synth_views(&params, drawn.views);
    assert_int_equal(orl_synth_create(gpu, &params, &synth), ORL_OK);
    assert_int_equal(orl_synth_draw(synth, NULL, &drawn.views[drawn.index_a], &drawn.a), ORL_OK);
    assert_int_equal(orl_synth_draw(synth, NULL, &drawn.views[drawn.index_b], &drawn.b), ORL_OK);
    orl_synth_destroy(&synth);
    return 0;
}

static int finish_views(void **state)
{
    (void)state;
    orl_synth_frame_finish(&drawn.a);
    orl_synth_frame_finish(&drawn.b);
    return 0;
}

// Least and greatest depth of the pixels around a position; false if any is sky.
static bool depth_range(const struct orl_image *depth, const double pixel[2], double range[2])
{
    int x0 = (int)floor(pixel[0] - 0.5), y0 = (int)floor(pixel[1] - 0.5);
    if (x0 < 0 || y0 < 0 || x0 + 1 >= depth->width || y0 + 1 >= depth->height)
        return false;
    range[0] = INFINITY;
    range[1] = 0;
    for (int i = 0; i < 4; i++) {
        float z = depth->f32[(y0 + i / 2) * depth->width + x0 + i % 2];
        if (z <= 0)
            return false;
        range[0] = fmin(range[0], z);
        range[1] = fmax(range[1], z);
    }
    return true;
}

static void depth_agrees_between_views(void **state)
{
    (void)state;
    const struct orl_view *a = &drawn.views[drawn.index_a], *b = &drawn.views[drawn.index_b];
    int compared = 0, agree = 0, seen_through = 0;
    for (int y = 0; y < HEIGHT; y++) {
        for (int x = 0; x < WIDTH; x++) {
            double world[3], pixel[2], z, range[2];
            float depth = drawn.a.depth.f32[y * WIDTH + x];
            if (depth <= 0)
                continue;
            orl_view_unproject(a, x + 0.5, y + 0.5, depth, world);
            if (!orl_view_project(b, world, pixel, &z) ||
                !depth_range(&drawn.b.depth, pixel, range))
                continue;
            compared++;
            agree += z > range[0] * 0.995 && z < range[1] * 1.005;
            // A surface that A sees cannot be missing in B: B may only see nearer ones.
            seen_through += z < range[0] * 0.99;
        }
    }
    assert_true(compared > WIDTH * HEIGHT / 2);
    assert_true(agree > 0.75 * compared);
    assert_true(seen_through < 0.005 * compared);
}

// What faces up at the level of the square is the ground plane y = 0.
static void ground_is_flat(void **state)
{
    (void)state;
    const struct orl_view *view = &drawn.views[drawn.index_a];
    const struct orl_pose *pose = &view->cam_from_world;
    int ground = 0;
    for (int y = HEIGHT / 2; y < HEIGHT; y++) {
        for (int x = 0; x < WIDTH; x++) {
            int i = y * WIDTH + x;
            const float *n = drawn.a.normal.f32 + 3 * i;
            double up = 0, world[3];
            for (int k = 0; k < 3; k++)
                up += pose->r[k][1] * n[k];
            orl_view_unproject(view, x + 0.5, y + 0.5, drawn.a.depth.f32[i], world);
            if (up < 0.9999 || world[1] > 0.05)
                continue;
            ground++;
            // Where a solid meets it, rays may stop before: 1e-4 of depth.
            assert_true(fabs(world[1]) < 1.5e-4 * drawn.a.depth.f32[i]);
        }
    }
    assert_true(ground > WIDTH * HEIGHT / 32);
}

static void normals_face_the_camera(void **state)
{
    (void)state;
    const struct orl_camera *c = &drawn.views[drawn.index_a].camera;
    int surface = 0, sky = 0, away = 0;
    for (int y = 0; y < HEIGHT; y++) {
        for (int x = 0; x < WIDTH; x++) {
            int i = y * WIDTH + x;
            const float *n = drawn.a.normal.f32 + 3 * i;
            double length = sqrt(n[0] * n[0] + n[1] * n[1] + n[2] * n[2]);
            for (int k = 0; k < 3; k++) {
                float v = drawn.a.radiance.f32[3 * i + k];
                assert_true(isfinite(v) && v > 0);
            }
            if (drawn.a.depth.f32[i] <= 0) {
                assert_true(drawn.a.depth.f32[i] == 0 && length == 0);
                sky++;
                continue;
            }
            surface++;
            assert_true(fabs(length - 1) < 1e-3);
            double toward = n[0] * (x + 0.5 - c->cx) / c->fx + n[1] * (y + 0.5 - c->cy) / c->fy +
                            n[2];
            away += toward > 0;
        }
    }
    assert_true(sky > WIDTH * HEIGHT / 20 && surface > WIDTH * HEIGHT / 2);
    assert_true(away < 0.005 * surface); // grazing pixels at silhouettes
}

// --- exposure ---

static void expose_one(float radiance, double ev, uint8_t *value)
{
    struct orl_image in, out;
    const struct orl_synth_sensor sensor = {.exposure_ev = ev};
    assert_int_equal(orl_image_init(NULL, &in, 1, 1, 3, ORL_PIXEL_F32), ORL_OK);
    in.f32[0] = in.f32[1] = in.f32[2] = radiance;
    assert_int_equal(orl_synth_expose(NULL, &in, &sensor, &out), ORL_OK);
    *value = out.u8[1];
    orl_image_finish(&in);
    orl_image_finish(&out);
}

static void exposure_follows_the_srgb_curve(void **state)
{
    (void)state;
    static const struct {
        float radiance;
        double ev;
        uint8_t expected;
    } rows[] = {{0, 0, 0},     {0.18f, 0, 118}, {0.18f, 1, 162}, {0.72f, -2, 118}, {1, 0, 255},
                {0.5f, 1, 255}, {4, 0, 255},     {0.002f, 0, 7},  {0.125f, 3, 255}};
    for (size_t i = 0; i < ORL_COUNT(rows); i++) {
        uint8_t value;
        expose_one(rows[i].radiance, rows[i].ev, &value);
        assert_int_equal(value, rows[i].expected);
    }
}

static double linear_of(uint8_t v)
{
    double s = v / 255.0;
    return s <= 0.04045 ? s / 12.92 : pow((s + 0.055) / 1.055, 2.4);
}

static void noise_has_the_given_spread(void **state)
{
    (void)state;
    enum { SIDE = 128 };
    const double level = 0.25, sigma = 0.05;
    struct orl_image in, out, again, other;
    struct orl_synth_sensor sensor = {.noise = sigma, .key = 7};
    assert_int_equal(orl_image_init(NULL, &in, SIDE, SIDE, 3, ORL_PIXEL_F32), ORL_OK);
    for (int i = 0; i < 3 * SIDE * SIDE; i++)
        in.f32[i] = (float)level;
    assert_int_equal(orl_synth_expose(NULL, &in, &sensor, &out), ORL_OK);
    assert_int_equal(orl_synth_expose(NULL, &in, &sensor, &again), ORL_OK);
    sensor.key = 8;
    assert_int_equal(orl_synth_expose(NULL, &in, &sensor, &other), ORL_OK);
    double sum = 0, squares = 0;
    for (int i = 0; i < 3 * SIDE * SIDE; i++) {
        double v = linear_of(out.u8[i]);
        sum += v;
        squares += v * v;
    }
    double mean = sum / (3 * SIDE * SIDE), spread = sqrt(squares / (3 * SIDE * SIDE) - mean * mean);
    assert_true(fabs(mean - level) < 0.002);
    // Photon noise: at a quarter of white it is half as strong.
    assert_true(fabs(spread - 0.5 * sigma) < 0.002);
    assert_memory_equal(out.u8, again.u8, orl_image_bytes(&out));
    assert_memory_not_equal(out.u8, other.u8, orl_image_bytes(&out));
    orl_image_finish(&in);
    orl_image_finish(&out);
    orl_image_finish(&again);
    orl_image_finish(&other);
}

static void film_response_can_be_undone(void **state)
{
    (void)state;
    double last = -1;
    for (int i = 0; i <= 1000; i++) {
        double value = orl_synth_encode(ORL_SYNTH_FILM, i / 1000.0);
        assert_true(value > last);
        assert_true(fabs(orl_synth_decode(ORL_SYNTH_FILM, value) - i / 1000.0) < 1e-9);
        last = value;
    }
    assert_true(last == 1);
    // More contrast than sRGB, which has 0.4614 for middle grey.
    assert_true(fabs(orl_synth_encode(ORL_SYNTH_FILM, 0.18) - 0.4518) < 5e-4);
    assert_true(orl_synth_encode(ORL_SYNTH_FILM, 0.8) > orl_synth_encode(ORL_SYNTH_SRGB, 0.8));
}

static void lens_and_drift_are_as_asked(void **state)
{
    (void)state;
    enum { SIDE = 65 };
    struct orl_image in, out;
    assert_int_equal(orl_image_init(NULL, &in, SIDE, SIDE, 3, ORL_PIXEL_F32), ORL_OK);
    for (int i = 0; i < 3 * SIDE * SIDE; i++)
        in.f32[i] = 0.5f;
    const struct orl_synth_sensor sensor = {.vignette = 0.4, .drift_ev = {-1, 0, 0.5}};
    assert_int_equal(orl_synth_expose(NULL, &in, &sensor, &out), ORL_OK);
    const uint8_t *middle = out.u8 + 3 * (SIDE / 2 * SIDE + SIDE / 2);
    assert_true(fabs(linear_of(middle[0]) - 0.25) < 0.004);
    assert_true(fabs(linear_of(middle[1]) - 0.5) < 0.004);
    assert_true(fabs(linear_of(middle[2]) - 0.5 * sqrt(2)) < 0.004);
    assert_true(fabs(linear_of(out.u8[1]) - 0.5 * 0.6) < 0.01); // half a pixel off the corner
    orl_image_finish(&in);
    orl_image_finish(&out);
    struct orl_synth_params params = small_params();
    params.drift_ev = 1;
    double spread = 0;
    for (int i = 0; i < 100; i++) {
        struct orl_synth_sensor one = orl_synth_sensor(&params, i);
        for (int c = 0; c < 3; c++) {
            assert_true(fabs(one.drift_ev[c]) <= 1.25);
            assert_true(fabs(one.drift_ev[c] - one.drift_ev[(c + 1) % 3]) <= 0.5);
        }
        spread += fabs(one.drift_ev[1]) / 100;
    }
    assert_true(spread > 0.3 && spread < 0.7);
}

// --- files ---

struct folders {
    char *root, *photos, *truth;
};

static char *join(const char *dir, const char *name)
{
    char *path = orl_path_join(NULL, dir, name);
    assert_non_null(path);
    return path;
}

static struct folders make_folders(void)
{
    struct folders f = {.root = test_dir_make()};
    f.photos = join(f.root, "photos");
    f.truth = join(f.root, "photos-truth");
    return f;
}

static void remove_folders(struct folders *f)
{
    test_dir_remove(f->root);
    free(f->photos);
    free(f->truth);
}

static struct orl_synth_params run_params(void)
{
    struct orl_synth_params params = small_params();
    params.count = RUN_COUNT;
    params.exposures_ev[0] = -3;
    params.exposures_ev[1] = 1;
    params.exposure_count = 2;
    return params;
}

static void photograph_is_the_exposed_radiance(const struct folders *f, const char *stem, double ev)
{
    static const char *const rgb[] = {"R", "G", "B"};
    char name[64];
    struct orl_image radiance, photo, expected;
    snprintf(name, sizeof name, "radiance/%s.exr", stem);
    char *path = join(f->truth, name);
    assert_int_equal(orl_exr_read(NULL, path, rgb, 3, &radiance), ORL_OK);
    free(path);
    snprintf(name, sizeof name, "%s.jpg", stem);
    path = join(f->photos, name);
    assert_int_equal(orl_picture_read(NULL, path, 3, &photo), ORL_OK);
    assert_int_equal(orl_synth_expose(NULL, &radiance,
                                      &(struct orl_synth_sensor){.exposure_ev = ev}, &expected),
                     ORL_OK);
    double squares = 0;
    size_t count = orl_image_bytes(&photo);
    for (size_t i = 0; i < count; i++)
        squares += pow((double)photo.u8[i] - expected.u8[i], 2);
    assert_true(sqrt(squares / (double)count) < 2.5); // JPEG at quality 97
    struct orl_picture_info info;
    assert_int_equal(orl_picture_inspect(NULL, path, &info), ORL_OK);
    const struct orl_exif exif = info.exif;
    assert_string_equal(exif.make, "Oriel");
    assert_true(fabs(log2(exif.exposure_s * 250) - ev) < 0.01);
    assert_true(exif.iso == 100 && exif.aperture == 8);
    assert_true(exif.focal_35mm == ORL_SYNTH_FOCAL_35MM);
    free(path);
    orl_image_finish(&radiance);
    orl_image_finish(&photo);
    orl_image_finish(&expected);
}

static void depth_files_agree(const struct folders *f, const char *stem)
{
    static const char *const z[] = {"depth.Z"};
    char name[64];
    struct orl_image exr, map;
    snprintf(name, sizeof name, "depth/%s.exr", stem);
    char *path = join(f->truth, name);
    assert_int_equal(orl_exr_read(NULL, path, z, 1, &exr), ORL_OK);
    free(path);
    snprintf(name, sizeof name, "stereo/depth_maps/%s.jpg.geometric.bin", stem);
    path = join(f->truth, name);
    assert_int_equal(orl_colmap_map_read(NULL, path, &map), ORL_OK);
    free(path);
    assert_int_equal(orl_image_bytes(&exr), orl_image_bytes(&map));
    assert_memory_equal(exr.f32, map.f32, orl_image_bytes(&exr));
    orl_image_finish(&exr);
    orl_image_finish(&map);
}

static void cameras_are_the_plan(const struct folders *f, const struct orl_synth_params *params)
{
    struct orl_view views[RUN_COUNT];
    struct orl_colmap_model model;
    char *path = join(f->truth, "sparse");
    orl_synth_views(params, views);
    assert_int_equal(orl_colmap_read(NULL, path, &model), ORL_OK);
    assert_int_equal(model.image_count, RUN_COUNT);
    assert_true(fabs(model.cameras[0].pinhole.fx - views[0].camera.fx) < 1e-9);
    for (int i = 0; i < RUN_COUNT; i++) {
        const struct orl_pose *read = &model.images[i].cam_from_world;
        for (int k = 0; k < 9; k++)
            assert_true(fabs(read->r[k / 3][k % 3] -
                             views[i].cam_from_world.r[k / 3][k % 3]) < 1e-9);
        for (int k = 0; k < 3; k++)
            assert_true(fabs(read->t[k] - views[i].cam_from_world.t[k]) < 1e-9);
    }
    orl_colmap_finish(&model);
    free(path);
}

static void files_hold_what_was_drawn(void **state)
{
    (void)state;
    struct folders f = make_folders();
    struct orl_synth_params params = run_params();
    assert_int_equal(orl_synth_run(gpu, NULL, &params, f.photos, f.truth), ORL_OK);
    struct orl_names names;
    assert_int_equal(orl_dir_list(NULL, f.photos, &names), ORL_OK);
    assert_int_equal(names.count, RUN_COUNT); // nothing but photographs
    orl_names_finish(&names);
    photograph_is_the_exposed_radiance(&f, "0001", -3);
    photograph_is_the_exposed_radiance(&f, "0002", 1);
    photograph_is_the_exposed_radiance(&f, "0003", -3);
    depth_files_agree(&f, "0002");
    cameras_are_the_plan(&f, &params);
    remove_folders(&f);
}

static void same_bytes(const char *dir_a, const char *dir_b, int *count)
{
    struct orl_names names;
    assert_int_equal(orl_dir_list(NULL, dir_a, &names), ORL_OK);
    for (size_t i = 0; i < names.count; i++) {
        char *a = join(dir_a, names.items[i]), *b = join(dir_b, names.items[i]);
        if (orl_path_is_dir(a)) {
            same_bytes(a, b, count);
        } else {
            uint64_t hash_a, hash_b;
            assert_int_equal(orl_file_hash(NULL, a, &hash_a), ORL_OK);
            assert_int_equal(orl_file_hash(NULL, b, &hash_b), ORL_OK);
            assert_true(hash_a == hash_b);
            ++*count;
        }
        free(a);
        free(b);
    }
    orl_names_finish(&names);
}

static void same_seed_same_files(void **state)
{
    (void)state;
    struct folders f = make_folders(), g = make_folders();
    struct orl_synth_params params = run_params();
    params.width = 64;
    params.height = 72; // no multiple of a tile's or a band's size
    params.noise = 0.02;
    int count = 0;
    assert_int_equal(orl_synth_run(gpu, NULL, &params, f.photos, f.truth), ORL_OK);
    assert_int_equal(orl_synth_run(gpu, NULL, &params, g.photos, g.truth), ORL_OK);
    same_bytes(f.root, g.root, &count);
    assert_int_equal(count, 6 * RUN_COUNT + 5);
    remove_folders(&f);
    remove_folders(&g);
}

static void seeds_differ(void **state)
{
    (void)state;
    struct orl_synth_params params = small_params();
    struct orl_view a[VIEW_COUNT], b[VIEW_COUNT];
    orl_synth_views(&params, a);
    params.seed++;
    orl_synth_views(&params, b);
    assert_memory_not_equal(a, b, sizeof a);
}

// --- refusals ---

// What gloss, bars and plain walls change, and what they leave alone.
static void troubles_are_where_they_belong(void **state)
{
    (void)state;
    const struct orl_view *view = &drawn.views[drawn.index_a];
    struct orl_synth_params glossy = small_params(), barred = glossy, plain = glossy;
    const struct orl_synth_params *all[3] = {&glossy, &barred, &plain};
    struct orl_synth_frame frames[3];
    glossy.gloss = 1;
    barred.bars_m = 0.4;
    plain.plain = 1;
    for (int i = 0; i < 3; i++) {
        struct orl_synth *synth;
        assert_int_equal(orl_synth_create(gpu, all[i], &synth), ORL_OK);
        assert_int_equal(orl_synth_draw(synth, NULL, view, &frames[i]), ORL_OK);
        orl_synth_destroy(&synth);
    }
    size_t wall_pixel = 0, gloss_changes = 0, sky_changes = 0;
    for (size_t i = 0; i < (size_t)WIDTH * HEIGHT; i++) {
        bool sky = drawn.a.depth.f32[i] <= 0;
        bool changed = memcmp(&frames[0].radiance.f32[3 * i], &drawn.a.radiance.f32[3 * i],
                              3 * sizeof(float)) != 0;
        assert_float_equal(frames[0].depth.f32[i], drawn.a.depth.f32[i], 1e-3);
        gloss_changes += changed;
        sky_changes += sky && changed;
        wall_pixel += frames[2].textured.f32[i] <= 0;
        assert_true(!sky || frames[2].textured.f32[i] > 0);
    }
    assert_true(gloss_changes > WIDTH * HEIGHT / 10);
    assert_true(sky_changes < WIDTH * HEIGHT / 50); // samples of its outline
    assert_true(wall_pixel > WIDTH * HEIGHT / 5);
    assert_null(frames[0].textured.data);
    // The middle bar hides what is behind it, at its own depth.
    double pixel[2], z;
    assert_true(orl_view_project(view, (double[]){0, 2, 2.6}, pixel, &z));
    double found = (double)frames[1].depth.f32[(int)pixel[1] * WIDTH + (int)pixel[0]];
    assert_between((int)(1000 * (z - found)), 100, 300);
    for (int i = 0; i < 3; i++)
        orl_synth_frame_finish(&frames[i]);
}

// The truth tells the pixels of the vehicle from all others, which keep their surfaces.
static void a_vehicle_stands_before_the_monument(void **state)
{
    (void)state;
    struct orl_synth_params params = small_params();
    struct orl_synth *synth;
    struct orl_synth_frame frame;
    params.vehicle = true;
    assert_int_equal(orl_synth_create(gpu, &params, &synth), ORL_OK);
    assert_int_equal(orl_synth_draw(synth, NULL, &drawn.views[drawn.index_a], &frame), ORL_OK);
    orl_synth_destroy(&synth);
    size_t of_it = 0, darkest = 0, moved = 0;
    for (size_t i = 0; i < (size_t)WIDTH * HEIGHT; i++) {
        float before = drawn.a.depth.f32[i], now = frame.depth.f32[i];
        of_it += frame.vehicle.u8[i] > 0;
        if (frame.vehicle.u8[i])
            assert_true(now > 0 && (before <= 0 || now < before));
        else // a ray that grazes a surface may end elsewhere within the truth's tolerance
            moved += fabsf(now - before) > 2e-4f * before;
        darkest += frame.vehicle.u8[i] && frame.radiance.f32[3 * i + 1] < 0.02f;
    }
    assert_between((int)of_it, WIDTH * HEIGHT / 50, WIDTH * HEIGHT / 5);
    assert_true(darkest > 10); // tyres
    assert_true(moved < WIDTH * HEIGHT / 200);
    assert_null(drawn.a.vehicle.data);
    orl_synth_frame_finish(&frame);
}

static void refuses_what_is_out_of_range(void **state)
{
    (void)state;
    struct orl_synth_params good = small_params(), bad[4];
    assert_int_equal(orl_synth_check(NULL, &good), ORL_OK);
    for (size_t i = 0; i < ORL_COUNT(bad); i++)
        bad[i] = good;
    bad[0].name = "pyramid";
    bad[1].width = ORL_SYNTH_SIDE_MIN - 1;
    bad[2].height = ORL_SYNTH_SIDE_MAX + 1;
    bad[3].exposure_count = 1;
    bad[3].exposures_ev[0] = 13;
    for (size_t i = 0; i < ORL_COUNT(bad); i++)
        assert_int_equal(orl_synth_check(NULL, &bad[i]), ORL_ERR_ARGUMENT);
}

static void keeps_a_folder_that_is_not_empty(void **state)
{
    (void)state;
    struct folders f = make_folders();
    struct orl_synth_params params = run_params();
    assert_int_equal(orl_dir_make(NULL, f.photos), ORL_OK);
    char *mine = join(f.photos, "mine.jpg");
    assert_int_equal(orl_file_write(NULL, mine, "x", 1), ORL_OK);
    assert_int_equal(orl_synth_run(gpu, NULL, &params, f.photos, f.truth), ORL_ERR_ARGUMENT);
    assert_true(orl_path_is_file(mine));
    assert_false(orl_path_is_dir(f.truth));
    free(mine);
    remove_folders(&f);
}

static bool always(void *priv)
{
    (void)priv;
    return true;
}

static void interrupted_leaves_nothing(void **state)
{
    (void)state;
    struct folders f = make_folders();
    struct orl_synth_params params = run_params();
    struct orl_progress progress = {.cancelled = always};
    struct orl_names names;
    assert_int_equal(orl_synth_run(gpu, &progress, &params, f.photos, f.truth),
                     ORL_ERR_CANCELLED);
    assert_int_equal(orl_dir_list(NULL, f.root, &names), ORL_OK);
    assert_int_equal(names.count, 0);
    orl_names_finish(&names);
    remove_folders(&f);
}

int main(void)
{
    const struct CMUnitTest truth[] = {
        cmocka_unit_test(depth_agrees_between_views),
        cmocka_unit_test(ground_is_flat),
        cmocka_unit_test(normals_face_the_camera),
        cmocka_unit_test(troubles_are_where_they_belong),
        cmocka_unit_test(a_vehicle_stands_before_the_monument),
    };
    const struct CMUnitTest files[] = {
        cmocka_unit_test(exposure_follows_the_srgb_curve),
        cmocka_unit_test(film_response_can_be_undone),
        cmocka_unit_test(lens_and_drift_are_as_asked),
        cmocka_unit_test(noise_has_the_given_spread),
        cmocka_unit_test(files_hold_what_was_drawn),
        cmocka_unit_test(same_seed_same_files),
        cmocka_unit_test(seeds_differ),
        cmocka_unit_test(refuses_what_is_out_of_range),
        cmocka_unit_test(keeps_a_folder_that_is_not_empty),
        cmocka_unit_test(interrupted_leaves_nothing),
    };
    gpu = gpu_test_device();
    int failed = cmocka_run_group_tests(truth, draw_views, finish_views) +
                 cmocka_run_group_tests(files, NULL, NULL);
    orl_gpu_destroy(&gpu);
    return failed;
}
