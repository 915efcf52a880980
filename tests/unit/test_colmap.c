// COLMAP's models and maps: known answers, and files that are damaged or hostile.
#include <math.h>
#include <string.h>
#include <time.h>

#include "scene/colmap.h"
#include "test.h"

struct bytes {
    uint8_t data[4096];
    size_t size;
};

static void put(struct bytes *b, const void *data, size_t size)
{
    assert_true(b->size + size <= sizeof b->data);
    memcpy(b->data + b->size, data, size);
    b->size += size;
}
static void put_u32(struct bytes *b, uint32_t v) { put(b, &v, 4); }
static void put_u64(struct bytes *b, uint64_t v) { put(b, &v, 8); }
static void put_f64(struct bytes *b, double v) { put(b, &v, 8); }

static void save(const char *dir, const char *name, const struct bytes *b)
{
    char path[4096];
    snprintf(path, sizeof path, "%s/%s", dir, name);
    assert_int_equal(orl_file_write(NULL, path, b->data, b->size), ORL_OK);
}

static void save_text(const char *dir, const char *name, const char *text)
{
    char path[4096];
    snprintf(path, sizeof path, "%s/%s", dir, name);
    assert_int_equal(orl_file_write(NULL, path, text, strlen(text)), ORL_OK);
}

struct model_files {
    struct bytes cameras, images, points;
};

static void put_point(struct bytes *b, uint64_t id, double x, uint32_t track)
{
    put_u64(b, id);
    put_f64(b, x);
    put_f64(b, 2);
    put_f64(b, 3);
    put(b, "\x0a\x14\x1e", 3);
    put_f64(b, 0.25);
    put_u64(b, track);
    for (uint32_t i = 0; i < track; i++)
        put_u64(b, i);
}

static void put_image(struct bytes *b, uint32_t id, const char *name, uint64_t first_point)
{
    put_u32(b, id);
    const double quat[4] = {2, 0, 0, 0}, t[3] = {0.5, 0, -1};
    put(b, quat, sizeof quat);
    put(b, t, sizeof t);
    put_u32(b, 7);
    put(b, name, strlen(name) + 1);
    put_u64(b, 3);
    const uint64_t ids[3] = {first_point, UINT64_MAX, 30};
    for (int i = 0; i < 3; i++) {
        put_f64(b, 1.5);
        put_f64(b, 2.5);
        put_u64(b, ids[i]);
    }
}

// Two photographs (not in order of name) and three points (not in order of id).
static struct model_files sample(void)
{
    struct model_files f = {0};
    put_u64(&f.cameras, 1);
    put_u32(&f.cameras, 7);
    put_u32(&f.cameras, 2); // SIMPLE_RADIAL
    put_u64(&f.cameras, 640);
    put_u64(&f.cameras, 480);
    const double params[4] = {500, 320.5, 240.5, -0.1};
    put(&f.cameras, params, sizeof params);
    put_u64(&f.points, 3);
    put_point(&f.points, 30, 1, 2);
    put_point(&f.points, 10, 5, 1);
    put_point(&f.points, 20, 9, 0);
    put_u64(&f.images, 2);
    put_image(&f.images, 4, "b.jpg", 10);
    put_image(&f.images, 3, "a.jpg", 20);
    return f;
}

static void save_model(const char *dir, const struct model_files *f)
{
    save(dir, "cameras.bin", &f->cameras);
    save(dir, "images.bin", &f->images);
    save(dir, "points3D.bin", &f->points);
}

static void check_sample(const struct orl_colmap_model *m)
{
    assert_int_equal(m->camera_count, 1);
    assert_int_equal(m->cameras[0].id, 7);
    assert_int_equal(m->cameras[0].model, 2);
    assert_int_equal(m->cameras[0].param_count, 4);
    assert_float_equal(m->cameras[0].pinhole.fy, 500, 0);
    assert_float_equal(m->cameras[0].pinhole.cx, 320.5, 0);
    assert_float_equal(m->cameras[0].pinhole.cy, 240.5, 0);
    assert_int_equal(m->image_count, 2);
    assert_string_equal(m->images[0].name, "a.jpg");
    assert_string_equal(m->images[1].name, "b.jpg");
    assert_float_equal(m->images[0].cam_from_world.r[0][0], 1, 1e-12);
    assert_float_equal(m->images[0].cam_from_world.t[2], -1, 0);
    assert_int_equal(m->point_count, 3);
    assert_int_equal(m->images[0].point_count, 2);
    assert_int_equal(m->points[m->images[0].points[0]].id, 20);
    assert_int_equal(m->points[m->images[0].points[1]].id, 30);
    assert_int_equal(m->points[m->images[1].points[0]].id, 10);
    const struct orl_colmap_point *p = &m->points[m->images[0].points[1]];
    assert_float_equal(p->position[0], 1, 0);
    assert_int_equal(p->rgb[2], 30);
    assert_int_equal(p->track_length, 2);
    assert_float_equal(p->error_px, 0.25, 0);
    assert_non_null(orl_colmap_camera_by_id(m, 7));
    assert_null(orl_colmap_camera_by_id(m, 8));
}

static void reads_binary(void **state)
{
    (void)state;
    char *dir = test_dir_make();
    struct model_files f = sample();
    save_model(dir, &f);
    struct orl_colmap_model m;
    assert_int_equal(orl_colmap_read(NULL, dir, &m), ORL_OK);
    check_sample(&m);
    orl_colmap_finish(&m);
    test_dir_remove(dir);
}

static const char cameras_txt[] = "# comment\n7 SIMPLE_RADIAL 640 480 500 320.5 240.5 -0.1\n";
static const char points_txt[] = "30 1 2 3 10 20 30 0.25 1 0 2 0\r\n10 5 2 3 10 20 30 0.25 1 1\n\n"
                                 "20 9 2 3 10 20 30 0.25\n";
static const char images_txt[] = "# comment\n4 2 0 0 0 0.5 0 -1 7 b.jpg\n"
                                 "1.5 2.5 10 1.5 2.5 -1 1.5 2.5 30\n"
                                 "3 2 0 0 0 0.5 0 -1 7 a.jpg\n"
                                 "1.5 2.5 20 1.5 2.5 -1 1.5 2.5 30";

static void reads_text(void **state)
{
    (void)state;
    char *dir = test_dir_make();
    save_text(dir, "cameras.txt", cameras_txt);
    save_text(dir, "points3D.txt", points_txt);
    save_text(dir, "images.txt", images_txt);
    struct orl_colmap_model m;
    assert_int_equal(orl_colmap_read(NULL, dir, &m), ORL_OK);
    check_sample(&m);
    orl_colmap_finish(&m);
    // A photograph without observations has an empty second line.
    save_text(dir, "images.txt", "4 1 0 0 0 0 0 0 7 b.jpg\n\n3 1 0 0 0 0 0 0 7 a b.jpg\n");
    assert_int_equal(orl_colmap_read(NULL, dir, &m), ORL_OK);
    assert_int_equal(m.image_count, 2);
    assert_string_equal(m.images[0].name, "a b.jpg");
    assert_int_equal(m.images[0].point_count, 0);
    orl_colmap_finish(&m);
    test_dir_remove(dir);
}

// Written, a model is the same, its pixels are projections, and its tracks name an image and the
// observation's number in it.
static void writes_what_it_reads(void **state)
{
    (void)state;
    char *dir = test_dir_make();
    char path[4096];
    struct model_files f = sample();
    struct orl_colmap_model m;
    uint8_t *data;
    size_t size;
    save_model(dir, &f);
    assert_int_equal(orl_colmap_read(NULL, dir, &m), ORL_OK);
    m.points[2].position[2] = 0.5; // point 30, at (1, 2, 0.5): behind the cameras at z = 1
    assert_int_equal(orl_colmap_write(NULL, dir, &m, NULL), ORL_OK);
    orl_colmap_finish(&m);
    assert_int_equal(orl_colmap_read(NULL, dir, &m), ORL_OK);
    assert_float_equal(m.images[0].cam_from_world.t[0], 0.5, 1e-12);
    assert_int_equal(m.images[0].points[1], 2);
    orl_colmap_finish(&m);
    // a.jpg begins behind a count: its id, quaternion, place, camera and name take 70 bytes. It sees
    // point 20 at (9, 2, 3), from (-0.5, 0, 1), as r = (4.75, 1), by SIMPLE_RADIAL.
    double pixel[2], radial = 1 - 0.1 * (4.75 * 4.75 + 1);
    snprintf(path, sizeof path, "%s/images.bin", dir);
    assert_int_equal(orl_file_read(NULL, path, 4096, &data, &size), ORL_OK);
    memcpy(pixel, data + 8 + 70 + 8, sizeof pixel);
    assert_float_equal(pixel[0], 500 * 4.75 * radial + 320.5, 1e-6);
    assert_float_equal(pixel[1], 500 * radial + 240.5, 1e-6);
    memcpy(pixel, data + 8 + 70 + 8 + 24, sizeof pixel);
    assert_true(pixel[0] == 0 && pixel[1] == 0);
    free(data);
    // Point 30, the last, has a track of two: each image's second observation.
    static const uint32_t track[4] = {3, 1, 4, 1};
    snprintf(path, sizeof path, "%s/points3D.bin", dir);
    assert_int_equal(orl_file_read(NULL, path, 4096, &data, &size), ORL_OK);
    assert_memory_equal(data + size - sizeof track, track, sizeof track);
    free(data);
    test_dir_remove(dir);
}

static void refuses_bad_text(void **state)
{
    (void)state;
    static const struct {
        const char *file, *text, *why;
    } cases[] = {
        {"cameras.txt", "7 SIMPLE_RADIAL 640 480 500 320.5\n", "parameters are missing"},
        {"cameras.txt", "7 WIDE 640 480 500 320 240 0\n", "unknown camera model WIDE"},
        {"cameras.txt", "7 EQUIRECTANGULAR 640 320 640 320\n", "cut flat views"},
        {"cameras.txt", "7 PINHOLE 640 480 nan 500 320 240\n", "not finite"},
        {"cameras.txt", "7 PINHOLE 99999999999 480 500 500 320 240\n", "size is absurd"},
        {"cameras.txt", "7 PINHOLE 4294967360 480 500 500 320 240\n", "size is absurd"},
        {"cameras.txt", "7 PINHOLE 640 480 1e-300 500 320 240\n", "focal length"},
        {"cameras.txt", "7 PINHOLE 640 480 500 1e300 320 240\n", "focal length"},
        {"cameras.txt", "7 PINHOLE 640 480 500 -500 320 240\n", "focal length"},
        {"images.txt", "3 1 0 0 0 1e308 0 0 7 a.jpg\n\n", "absurdly far"},
        {"cameras.txt", "x\n", "id is missing"},
        {"points3D.txt", "30 1 2\n", "a point needs"},
        {"points3D.txt", "30 1 2 3 1 2 3 0.5 1 zwei\n", "not a number"},
        {"images.txt", "3 0 0 0 0 0 0 0 7 a.jpg\n\n", "pose is zero"},
        {"images.txt", "3 1 0 0 0 0 0 0 7 ../../a.jpg\n\n", "leads out of its folder"},
        {"images.txt", "3 1 0 0 0 0 0 0 9 a.jpg\n\n", "camera 9, which is not there"},
        {"images.txt", "3 1 0 0 0 0 0 0 7 a.jpg\n1 2\n", "an observation needs"},
        {"images.txt", "3 1 0 0 0 0 0 0 7 a.jpg\n\n4 1 0 0 0 0 0 0 7 a.jpg\n\n", "listed twice"},
    };
    for (size_t i = 0; i < ORL_COUNT(cases); i++) {
        char *dir = test_dir_make();
        save_text(dir, "cameras.txt", cameras_txt);
        save_text(dir, "points3D.txt", points_txt);
        save_text(dir, "images.txt", images_txt);
        save_text(dir, cases[i].file, cases[i].text);
        struct said said;
        struct orl_log log = log_to(&said);
        struct orl_colmap_model m;
        assert_int_equal(orl_colmap_read(&log, dir, &m), ORL_ERR_FORMAT);
        assert_null(m.images);
        if (!strstr(said.text, cases[i].why))
            fail_msg("case %zu: \"%s\" does not say \"%s\"", i, said.text, cases[i].why);
        test_dir_remove(dir);
    }
}

// Every file, cut after every byte: an error, never a crash or a model.
static void refuses_truncated_binary(void **state)
{
    (void)state;
    char *dir = test_dir_make();
    const struct model_files whole = sample();
    static const char *const names[] = {"cameras.bin", "images.bin", "points3D.bin"};
    for (int file = 0; file < 3; file++) {
        save_model(dir, &whole);
        const struct bytes *b = file == 0 ? &whole.cameras : file == 1 ? &whole.images
                                                                       : &whole.points;
        for (size_t size = 0; size < b->size; size++) {
            struct bytes cut = *b;
            cut.size = size;
            save(dir, names[file], &cut);
            struct said said;
            struct orl_log log = log_to(&said);
            struct orl_colmap_model m;
            assert_int_equal(orl_colmap_read(&log, dir, &m), ORL_ERR_FORMAT);
            assert_non_null(strstr(said.text, names[file]));
            assert_non_null(strstr(said.text, "byte "));
            assert_null(m.cameras);
        }
        struct bytes longer = *b;
        put_u32(&longer, 0);
        save(dir, names[file], &longer);
        struct orl_colmap_model m;
        assert_int_equal(orl_colmap_read(NULL, dir, &m), ORL_ERR_FORMAT);
    }
    test_dir_remove(dir);
}

// Counts of 2^60 must be found out by the file's size: allocating them would fail
// with another code, or kill the process.
static void refuses_huge_counts(void **state)
{
    (void)state;
    const uint64_t huge = (uint64_t)1 << 60;
    for (int which = 0; which < 5; which++) {
        char *dir = test_dir_make();
        struct model_files f = sample();
        struct bytes *b = which == 0 ? &f.cameras : which == 1 || which == 3 ? &f.images
                                                                             : &f.points;
        // The header's count, then an image's observations, then a point's track.
        size_t at = which < 3 ? 0 : which == 3 ? 8 + 4 + 56 + 4 + 6 : 8 + 8 + 24 + 3 + 8;
        memcpy(b->data + at, &huge, 8);
        save_model(dir, &f);
        struct said said;
        struct orl_log log = log_to(&said);
        struct orl_colmap_model m;
        assert_int_equal(orl_colmap_read(&log, dir, &m), ORL_ERR_FORMAT);
        char where[64];
        snprintf(where, sizeof where, "byte %zu: the header claims 1152921504606846976", at);
        assert_non_null(strstr(said.text, where));
        test_dir_remove(dir);
    }
}

static void drops_points_that_are_not_finite(void **state)
{
    (void)state;
    char *dir = test_dir_make();
    struct model_files f = sample();
    const double bad[2] = {NAN, INFINITY};
    memcpy(f.points.data + 8 + 8, &bad[0], 8);                   // id 30
    memcpy(f.points.data + 8 + 67 + 59 + 8 + 16, &bad[1], 8);    // id 20
    save_model(dir, &f);
    struct said said;
    struct orl_log log = log_to(&said);
    struct orl_colmap_model m;
    assert_int_equal(orl_colmap_read(&log, dir, &m), ORL_OK);
    assert_int_equal(m.point_count, 1);
    assert_int_equal(m.points[0].id, 10);
    assert_int_equal(m.images[0].point_count, 0);
    assert_int_equal(m.images[1].point_count, 1);
    assert_non_null(strstr(said.text, "2 of 3 points are not finite"));
    orl_colmap_finish(&m);
    test_dir_remove(dir);
}

static void refuses_absurd_binary(void **state)
{
    (void)state;
    const double nan = NAN;
    const uint32_t unknown = 99;
    static const char *const why[] = {"not finite", "unknown camera model 99", "pose is zero,",
                                      "leads out of its folder"};
    for (int which = 0; which < 4; which++) {
        char *dir = test_dir_make();
        struct model_files f = sample();
        if (which == 0)
            memcpy(f.cameras.data + 8 + 24, &nan, 8);
        else if (which == 1)
            memcpy(f.cameras.data + 8 + 4, &unknown, 4);
        else if (which == 2)
            memcpy(f.images.data + 8 + 4 + 32, &nan, 8);
        else
            memcpy(f.images.data + 8 + 4 + 56 + 4, "../b", 4);
        save_model(dir, &f);
        struct said said;
        struct orl_log log = log_to(&said);
        struct orl_colmap_model m;
        assert_int_equal(orl_colmap_read(&log, dir, &m), ORL_ERR_FORMAT);
        assert_non_null(strstr(said.text, "byte "));
        assert_non_null(strstr(said.text, why[which]));
        test_dir_remove(dir);
    }
}

// COLMAP 4.1's model of panoramas, the camera with the fewest parameters.
static void names_binary_panoramas(void **state)
{
    (void)state;
    char *dir = test_dir_make();
    struct model_files f = sample();
    f.cameras.size = 0;
    put_u64(&f.cameras, 1);
    put_u32(&f.cameras, 7);
    put_u32(&f.cameras, 17);
    for (int i = 0; i < 2; i++)
        put_u64(&f.cameras, 640);
    for (int i = 0; i < 2; i++)
        put_f64(&f.cameras, 640);
    save_model(dir, &f);
    struct said said;
    struct orl_log log = log_to(&said);
    struct orl_colmap_model m;
    assert_int_equal(orl_colmap_read(&log, dir, &m), ORL_ERR_FORMAT);
    assert_non_null(strstr(said.text, "unknown camera model 17; panoramas are not read: cut flat views"));
    test_dir_remove(dir);
}

static void names_a_missing_model(void **state)
{
    (void)state;
    char *dir = test_dir_make();
    struct said said;
    struct orl_log log = log_to(&said);
    struct orl_colmap_model m;
    assert_int_equal(orl_colmap_read(&log, dir, &m), ORL_ERR_NOT_FOUND);
    assert_non_null(strstr(said.text, dir));
    test_dir_remove(dir);
}

static void round_trips_maps(void **state)
{
    (void)state;
    char *dir = test_dir_make();
    char path[4096];
    snprintf(path, sizeof path, "%s/map.bin", dir);
    struct orl_image map, back;
    assert_int_equal(orl_image_init(NULL, &map, 5, 3, 3, ORL_PIXEL_F32), ORL_OK);
    for (int i = 0; i < 45; i++)
        map.f32[i] = (float)i * 0.5f;
    assert_int_equal(orl_colmap_map_write(NULL, path, &map), ORL_OK);
    // COLMAP's layout is planar: the second plane starts with channel 1 of pixel 0.
    uint8_t *data;
    size_t size;
    assert_int_equal(orl_file_read(NULL, path, 4096, &data, &size), ORL_OK);
    assert_int_equal(size, 6 + 45 * 4);
    assert_memory_equal(data, "5&3&3&", 6);
    float value;
    memcpy(&value, data + 6 + 15 * 4, 4);
    assert_float_equal(value, map.f32[1], 0);
    free(data);
    assert_int_equal(orl_colmap_map_read(NULL, path, &back), ORL_OK);
    assert_int_equal(back.width, 5);
    assert_int_equal(back.height, 3);
    assert_int_equal(back.channels, 3);
    assert_memory_equal(back.f32, map.f32, 45 * 4);
    orl_image_finish(&map);
    orl_image_finish(&back);
    test_dir_remove(dir);
}

static void refuses_bad_maps(void **state)
{
    (void)state;
    static const char *const texts[] = {
        "", "5&3", "5&3&1&abc", "0&3&1&", "5&3&9&", "99999&99999&1&", "-5&3&1&",
        "55555555555555555555555&3&1&",
        "5&3&1&0123456789012345678901234567890123456789012345678901234567890", // one byte too many
    };
    char *dir = test_dir_make();
    char path[4096];
    snprintf(path, sizeof path, "%s/map.bin", dir);
    for (size_t i = 0; i < ORL_COUNT(texts); i++) {
        save_text(dir, "map.bin", texts[i]);
        struct said said;
        struct orl_log log = log_to(&said);
        struct orl_image map;
        assert_int_equal(orl_colmap_map_read(&log, path, &map), ORL_ERR_FORMAT);
        assert_null(map.data);
        assert_non_null(strstr(said.text, "map.bin: byte "));
    }
    test_dir_remove(dir);
}

// Processor seconds of reading pictures with a camera each.
static double seconds_to_read(int count)
{
    char *dir = test_dir_make();
    FILE *cameras = test_create(dir, "cameras.txt"), *images = test_create(dir, "images.txt");
    for (int i = 0; i < count; i++) {
        fprintf(cameras, "%d SIMPLE_PINHOLE 64 48 70 32 24\n", count - i);
        fprintf(images, "%d 1 0 0 0 0 0 0 %d %d.jpg\n\n", i + 1, i + 1, i);
    }
    assert_int_equal(fclose(cameras), 0);
    assert_int_equal(fclose(images), 0);
    save_text(dir, "points3D.txt", "");
    struct orl_colmap_model m;
    clock_t start = clock();
    assert_int_equal(orl_colmap_read(NULL, dir, &m), ORL_OK);
    clock_t end = clock();
    assert_int_equal(m.image_count, count);
    orl_colmap_finish(&m);
    test_dir_remove(dir);
    return (double)(end - start) / CLOCKS_PER_SEC;
}

// Cameras are found by bisection.
static void many_cameras_take_little_time(void **state)
{
    (void)state;
    test_grows_in_proportion(seconds_to_read);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(reads_binary),
        cmocka_unit_test(reads_text),
        cmocka_unit_test(writes_what_it_reads),
        cmocka_unit_test(refuses_bad_text),
        cmocka_unit_test(refuses_truncated_binary),
        cmocka_unit_test(refuses_huge_counts),
        cmocka_unit_test(drops_points_that_are_not_finite),
        cmocka_unit_test(refuses_absurd_binary),
        cmocka_unit_test(names_binary_panoramas),
        cmocka_unit_test(names_a_missing_model),
        cmocka_unit_test(round_trips_maps),
        cmocka_unit_test(refuses_bad_maps),
        cmocka_unit_test(many_cameras_take_little_time),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
