// PLY: known answers, and files that are damaged or hostile.
#include <math.h>
#include <signal.h>
#include <string.h>
#include <sys/resource.h>

#include "oriel/points.h"
#include "scene/point_stream.h"
#include "test.h"

static void save(const char *path, const void *data, size_t size)
{
    assert_int_equal(orl_file_write(NULL, path, data, size), ORL_OK);
}

static void make_points(struct orl_points *points, size_t count)
{
    assert_int_equal(orl_points_init(NULL, points, count), ORL_OK);
    for (size_t i = 0; i < count; i++) {
        points->position[i][0] = (float)i;
        points->position[i][1] = 0.5f;
        points->position[i][2] = -3;
        points->normal[i][i % 3] = i % 2 ? -1.0f : 1.0f;
        points->radius[i] = 0.25f + (float)i;
        points->color[i][0] = (uint8_t)i;
        points->color[i][2] = 255;
        points->photographs[i] = (uint8_t)(40 * i);
    }
}

static void round_trips(void **state)
{
    (void)state;
    char *dir = test_dir_make(), path[4096];
    snprintf(path, sizeof path, "%s/points.ply", dir);
    struct orl_points points, back;
    make_points(&points, 7);
    assert_int_equal(orl_points_write(NULL, path, &points, false, NULL), ORL_OK);
    assert_int_equal(orl_points_read(NULL, path, NULL, &back), ORL_OK);
    assert_int_equal(back.count, 7);
    assert_memory_equal(back.position, points.position, 7 * sizeof *points.position);
    assert_memory_equal(back.normal, points.normal, 7 * sizeof *points.normal);
    assert_memory_equal(back.radius, points.radius, 7 * sizeof *points.radius);
    assert_memory_equal(back.color, points.color, 7 * sizeof *points.color);
    assert_memory_equal(back.photographs, points.photographs, 7);
    orl_points_finish(&points);
    orl_points_finish(&back);
    test_dir_remove(dir);
}

static void reads_ascii(void **state)
{
    (void)state;
    char *dir = test_dir_make(), path[4096];
    snprintf(path, sizeof path, "%s/points.ply", dir);
    // Any order, other elements before and after, other properties, float colours,
    // a normal to be made unit length, carriage returns.
    static const char text[] =
        "ply\r\nformat ascii 1.0\ncomment hello\nelement camera 2\nproperty list uchar int idx\n"
        "element vertex 2\nproperty double z\nproperty int x\nproperty float quality\n"
        "property float y\nproperty float nx\nproperty float ny\nproperty float nz\n"
        "property float green\nproperty float red\nproperty float blue\n"
        "element face 1\nproperty list uchar int vertex_indices\nend_header\n"
        "2 1 2\n1 5\n"
        "3 1 99 2  0 0 4  0.5 1 0\n"
        "-3 -1 99 -2.5  0 0 0  0 0 2\n3 0 1 1\n";
    save(path, text, sizeof text - 1);
    struct orl_points points;
    assert_int_equal(orl_points_read(NULL, path, NULL, &points), ORL_OK);
    assert_int_equal(points.count, 2);
    const float expected[2][3] = {{1, 2, 3}, {-1, -2.5f, -3}};
    assert_memory_equal(points.position, expected, sizeof expected);
    const float normals[2][3] = {{0, 0, 1}, {0, 0, 0}};
    assert_memory_equal(points.normal, normals, sizeof normals);
    const uint8_t colors[2][3] = {{255, 128, 0}, {0, 0, 255}};
    assert_memory_equal(points.color, colors, sizeof colors);
    assert_float_equal(points.radius[0], 0, 0);
    assert_int_equal(points.photographs[0], 0);
    orl_points_finish(&points);
    test_dir_remove(dir);
}

// OpenMVS writes which views see a point as lists between the numbers.
static void skips_lists_of_vertices(void **state)
{
    (void)state;
    char *dir = test_dir_make(), path[4096];
    static const char text[] = "ply\nformat ascii 1.0\nelement vertex 2\nproperty float x\nproperty float y\n"
                               "property float z\nproperty list uchar uint view_indices\n"
                               "property list uchar float view_weights\nproperty float nx\nproperty float ny\n"
                               "property float nz\nend_header\n1 2 3 2 0 5 2 0.5 1 0 0 2\n4 5 6 0 0 0 1 0\n";
    struct orl_points points;
    snprintf(path, sizeof path, "%s/points.ply", dir);
    save(path, text, sizeof text - 1);
    assert_int_equal(orl_points_read(NULL, path, NULL, &points), ORL_OK);
    assert_int_equal(points.count, 2);
    const float positions[2][3] = {{1, 2, 3}, {4, 5, 6}}, normals[2][3] = {{0, 0, 1}, {0, 1, 0}};
    assert_memory_equal(points.position, positions, sizeof positions);
    assert_memory_equal(points.normal, normals, sizeof normals);
    orl_points_finish(&points);
    test_dir_remove(dir);
}

// By the greatest value of the file, whatever the type is called, under the names that are in use.
static void scales_colours_of_other_types(void **state)
{
    (void)state;
    static const struct {
        const char *type, *colours, *names[3];
    } cases[] = {{"ushort", "65535 32896 0", {"red", "green", "blue"}},
                 {"ushort", "255 128 0", {"diffuse_red", "diffuse_green", "diffuse_blue"}},
                 {"float", "255 128 0", {"r", "g", "b"}}, {"double", "1 0.50196 0", {"red", "green", "blue"}},
                 {"int", "255 128 0", {"red", "green", "blue"}}, {"uchar", "255 128 0", {"r", "g", "b"}}};
    const uint8_t want[3] = {255, 128, 0};
    char *dir = test_dir_make(), path[4096], text[1024];
    snprintf(path, sizeof path, "%s/points.ply", dir);
    for (size_t i = 0; i < ORL_COUNT(cases); i++) {
        struct orl_points points;
        const char *t = cases[i].type;
        int length = snprintf(text, sizeof text, "ply\nformat ascii 1.0\nelement vertex 1\n"
                              "property float x\nproperty float y\nproperty float z\n"
                              "property %s %s\nproperty %s %s\nproperty %s %s\nend_header\n"
                              "1 2 3 %s\n", t, cases[i].names[0], t, cases[i].names[1], t,
                              cases[i].names[2], cases[i].colours);
        save(path, text, (size_t)length);
        assert_int_equal(orl_points_read(NULL, path, NULL, &points), ORL_OK);
        assert_int_equal(points.count, 1);
        assert_memory_equal(points.color[0], want, 3);
        assert_float_equal(points.position[0][2], 3, 0);
        orl_points_finish(&points);
    }
    test_dir_remove(dir);
}

// Also where it is read a part at a time: the greatest value is that of the file, in its last part here.
static void scales_colours_of_parts(void **state)
{
    (void)state;
    static const char header[] = "ply\nformat binary_little_endian 1.0\nelement vertex 2\n"
                                 "property float x\nproperty float y\nproperty float z\n"
                                 "property ushort red\nproperty ushort green\nproperty ushort blue\nend_header\n";
    const float position[3] = {1, 2, 3};
    const uint8_t want[2][3] = {{128, 1, 0}, {255, 128, 0}};
    char *dir = test_dir_make(), path[4096];
    snprintf(path, sizeof path, "%s/points.ply", dir);
    for (unsigned factor = 1; factor <= 257; factor += 256) { // 8 or 16 bits
        uint8_t file[512];
        size_t size = sizeof header - 1, read;
        uint64_t total;
        struct orl_point_stream *stream;
        struct orl_points points;
        memcpy(file, header, size);
        for (int i = 0; i < 2; i++) {
            memcpy(file + size, position, sizeof position);
            size += sizeof position;
            for (int c = 0; c < 3; c++, size += 2)
                memcpy(file + size, &(uint16_t){(uint16_t)(factor * want[i][c])}, 2);
        }
        save(path, file, size);
        assert_int_equal(orl_points_init(NULL, &points, 1), ORL_OK);
        assert_int_equal(orl_point_stream_open(NULL, path, &stream, &total), ORL_OK);
        assert_int_equal(total, 2);
        for (int i = 0; i < 2; i++) {
            assert_int_equal(orl_point_stream_next(stream, 1, &points, &read), ORL_OK);
            assert_int_equal(points.count, 1);
            assert_memory_equal(points.color[0], want[i], 3);
        }
        orl_point_stream_close(&stream);
        orl_points_finish(&points);
    }
    test_dir_remove(dir);
}

static void says_that_there_are_no_colours(void **state)
{
    (void)state;
    char *dir = test_dir_make(), path[4096];
    static const char text[] = "ply\nformat ascii 1.0\nelement vertex 1\nproperty float x\nproperty float y\n"
                               "property float z\nproperty float intensity\nend_header\n1 2 3 4\n";
    snprintf(path, sizeof path, "%s/points.ply", dir);
    save(path, text, sizeof text - 1);
    struct said said;
    struct orl_log log = log_to(&said);
    struct orl_points points;
    assert_int_equal(orl_points_read(&log, path, NULL, &points), ORL_OK);
    assert_non_null(strstr(said.text, "no colours"));
    orl_points_finish(&points);
    test_dir_remove(dir);
}

static void refuses_bad_headers(void **state)
{
    (void)state;
    static const struct {
        const char *text, *why;
    } cases[] = {
        {"", "byte 0: not a PLY file"},
        {"plx\n", "not a PLY file"},
        {"ply\nformat ascii 1.0\nelement vertex 1\n", "byte 38: the header does not end"},
        {"ply\nformat binary_big_endian 1.0\nend_header\n", "byte 4: the format is neither"},
        {"ply\nformat ascii 1.0\nend_header\n", "no vertices"},
        {"ply\nformat ascii 1.0\nelement vertex 0\nproperty float x\nproperty float y\n"
         "end_header\n", "lack x, y or z"},
        {"ply\nformat ascii 1.0\nelement vertex 1\nproperty list uchar int x\nend_header\n1 5\n",
         "lists are not supported"},
        {"ply\nformat ascii 1.0\nelement vertex 1\nproperty float x\nproperty float x\n",
         "given twice"},
        {"ply\nformat ascii 1.0\nelement vertex -1\nend_header\n", "needs a name and a count"},
        {"ply\nformat ascii 1.0\nelement vertex 1\nproperty quaternion x\n", "unknown type"},
        {"ply\nformat ascii 1.0\nelement vertex 1152921504606846976\nproperty float x\n"
         "property float y\nproperty float z\nend_header\n1 2 3\n",
         "claims 1152921504606846976 records of vertex"},
        {"ply\nformat binary_little_endian 1.0\nelement vertex 1152921504606846976\n"
         "property float x\nproperty float y\nproperty float z\nend_header\n123456789012",
         "claims 1152921504606846976 records of vertex"},
        {"ply\nformat binary_little_endian 1.0\nelement a 18446744073709551615\n"
         "property double q\nelement vertex 1\nproperty float x\nproperty float y\n"
         "property float z\nend_header\n123456789012", "an element is larger than the file"},
        {"ply\nformat ascii 1.0\nelement vertex 2\nproperty float x\nproperty float y\n"
         "property float z\nend_header\n1 2 3\n4 5 six 7 8 9", "missing or not a number"},
    };
    char *dir = test_dir_make(), path[4096];
    snprintf(path, sizeof path, "%s/points.ply", dir);
    for (size_t i = 0; i < ORL_COUNT(cases); i++) {
        save(path, cases[i].text, strlen(cases[i].text));
        struct said said;
        struct orl_log log = log_to(&said);
        struct orl_points points;
        assert_int_equal(orl_points_read(&log, path, NULL, &points), ORL_ERR_FORMAT);
        assert_null(points.position);
        if (!strstr(said.text, cases[i].why) || !strstr(said.text, "points.ply: byte "))
            fail_msg("case %zu: \"%s\" does not say \"%s\"", i, said.text, cases[i].why);
    }
    test_dir_remove(dir);
}

static void refuses_truncated(void **state)
{
    (void)state;
    char *dir = test_dir_make(), path[4096];
    snprintf(path, sizeof path, "%s/points.ply", dir);
    struct orl_points points;
    make_points(&points, 3);
    assert_int_equal(orl_points_write(NULL, path, &points, false, NULL), ORL_OK);
    orl_points_finish(&points);
    uint8_t *data;
    size_t whole;
    assert_int_equal(orl_file_read(NULL, path, 4096, &data, &whole), ORL_OK);
    for (size_t size = 0; size < whole; size++) {
        save(path, data, size);
        assert_int_equal(orl_points_read(NULL, path, NULL, &points), ORL_ERR_FORMAT);
        assert_null(points.position);
    }
    free(data);
    test_dir_remove(dir);
}

static void drops_what_is_not_finite(void **state)
{
    (void)state;
    char *dir = test_dir_make(), path[4096];
    snprintf(path, sizeof path, "%s/points.ply", dir);
    struct orl_points points;
    make_points(&points, 6);
    points.position[1][2] = NAN;
    points.position[4][0] = -INFINITY;
    points.radius[2] = -1;
    points.radius[3] = NAN;
    points.normal[5][0] = NAN;
    assert_int_equal(orl_points_write(NULL, path, &points, false, NULL), ORL_OK);
    orl_points_finish(&points);
    struct said said;
    struct orl_log log = log_to(&said);
    assert_int_equal(orl_points_read(&log, path, NULL, &points), ORL_OK);
    assert_int_equal(points.count, 4);
    assert_float_equal(points.position[1][0], 2, 0);
    assert_float_equal(points.radius[1], 0, 0);
    assert_float_equal(points.radius[2], 0, 0);
    assert_float_equal(points.normal[3][0] + points.normal[3][1] + points.normal[3][2], 0, 0);
    assert_non_null(strstr(said.text, "2 of 6 points are not finite"));
    assert_non_null(strstr(said.text, "2 radii are negative or not finite"));
    orl_points_finish(&points);
    test_dir_remove(dir);
}

// A full disk, played by a limit on the size of files.
// What 3D Gaussian splatting writes: one opaque Gaussian, one transparent. Spherical harmonics,
// scales and opacity are encoded.
static void reads_gaussians_as_discs(void **state)
{
    (void)state;
    char *dir = test_dir_make(), path[4096];
    snprintf(path, sizeof path, "%s/points.ply", dir);
    static const char text[] =
        "ply\nformat ascii 1.0\nelement vertex 2\nproperty float x\nproperty float y\n"
        "property float z\nproperty float nx\nproperty float ny\nproperty float nz\n"
        "property float f_dc_0\nproperty float f_dc_1\nproperty float f_dc_2\n"
        "property float f_rest_0\nproperty float opacity\nproperty float scale_0\n"
        "property float scale_1\nproperty float scale_2\nproperty float rot_0\n"
        "property float rot_1\nproperty float rot_2\nproperty float rot_3\nend_header\n"
        "1 2 3 0 0 0 1.7724539 0 -9 0.5 2 -1 -5 -3 1 0 0 0\n"
        "4 5 6 0 0 0 0 0 0 0.5 -2 -1 -5 -3 1 0 0 0\n";
    save(path, text, sizeof text - 1);
    struct orl_points points;
    assert_int_equal(orl_points_read(NULL, path, NULL, &points), ORL_OK);
    assert_int_equal(points.count, 1);
    assert_float_equal(points.position[0][2], 3, 0);
    assert_int_equal(points.color[0][0], 255); // 0.5 + 0.2821 * 1.7725
    assert_int_equal(points.color[0][1], 128);
    assert_int_equal(points.color[0][2], 0);
    assert_float_equal(points.radius[0], exp(-2), 1e-6); // of exp(-1) and exp(-3)
    orl_points_finish(&points);
    test_dir_remove(dir);
}

// 2D Gaussians have two scales. A radius, which oriel export adds, is exact.
static void reads_gaussian_discs(void **state)
{
    (void)state;
    char *dir = test_dir_make(), path[4096], text[1024];
    snprintf(path, sizeof path, "%s/points.ply", dir);
    for (int has_radius = 0; has_radius < 2; has_radius++) {
        snprintf(text, sizeof text,
                 "ply\nformat ascii 1.0\nelement vertex 1\nproperty float x\nproperty float y\n"
                 "property float z\nproperty float f_dc_0\nproperty float f_dc_1\n"
                 "property float f_dc_2\nproperty float opacity\nproperty float scale_0\n"
                 "property float scale_1\n%send_header\n1 2 3 1.7724539 0 -9 2 -1 -3 %s\n",
                 has_radius ? "property float radius\n" : "", has_radius ? "7" : "");
        save(path, text, strlen(text));
        struct orl_points points;
        assert_int_equal(orl_points_read(NULL, path, NULL, &points), ORL_OK);
        assert_int_equal(points.count, 1);
        assert_int_equal(points.color[0][0], 255);
        assert_float_equal(points.radius[0], has_radius ? 7 : exp(-2), 1e-6);
        orl_points_finish(&points);
    }
    test_dir_remove(dir);
}

static void leaves_nothing_when_the_disk_is_full(void **state)
{
    (void)state;
    char *dir = test_dir_make(), path[4096];
    snprintf(path, sizeof path, "%s/points.ply", dir);
    struct orl_points points;
    make_points(&points, 1000);
    signal(SIGXFSZ, SIG_IGN);
    struct rlimit old, small;
    assert_int_equal(getrlimit(RLIMIT_FSIZE, &old), 0);
    small = old;
    small.rlim_cur = 8192;
    assert_int_equal(setrlimit(RLIMIT_FSIZE, &small), 0);
    enum orl_result result = orl_points_write(NULL, path, &points, false, NULL);
    assert_int_equal(setrlimit(RLIMIT_FSIZE, &old), 0);
    assert_int_equal(result, ORL_ERR_IO);
    struct orl_names names;
    assert_int_equal(orl_dir_list(NULL, dir, &names), ORL_OK);
    assert_int_equal(names.count, 0);
    orl_names_finish(&names);
    // Below a regular file nothing can be written, not even by root.
    save(path, "x", 1);
    strcat(path, "/points.ply");
    assert_int_equal(orl_points_write(NULL, path, &points, false, NULL), ORL_ERR_IO);
    orl_points_finish(&points);
    test_dir_remove(dir);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(round_trips),
        cmocka_unit_test(reads_ascii),
        cmocka_unit_test(skips_lists_of_vertices),
        cmocka_unit_test(scales_colours_of_other_types), cmocka_unit_test(scales_colours_of_parts),
        cmocka_unit_test(says_that_there_are_no_colours),
        cmocka_unit_test(refuses_bad_headers),
        cmocka_unit_test(refuses_truncated),
        cmocka_unit_test(drops_what_is_not_finite),
        cmocka_unit_test(reads_gaussians_as_discs),
        cmocka_unit_test(reads_gaussian_discs),
        cmocka_unit_test(leaves_nothing_when_the_disk_is_full),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
