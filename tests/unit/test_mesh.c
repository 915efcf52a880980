// Meshes: both formats by hand, damaged files, surfaces of fields.
#include <math.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

#include "mesh_help.h"
#include "scene/isosurface.h"
#include "scene/mesh.h"
#include "test.h"

static char *dir, *file;

static int set_up(void **state)
{
    (void)state;
    return test_file_make("mesh", &dir, &file); // the reader goes by content
}

static int tear_down(void **state)
{
    (void)state;
    return test_file_remove(dir, file);
}

static enum orl_result read_bytes(const struct orl_log *log, const void *data, size_t size,
                                  struct orl_mesh *mesh)
{
    assert_int_equal(orl_file_write(NULL, file, data, size), ORL_OK);
    return orl_mesh_read(log, file, NULL, mesh);
}

static enum orl_result read_text(const struct orl_log *log, const char *text,
                                 struct orl_mesh *mesh)
{
    return read_bytes(log, text, strlen(text), mesh);
}

static void check_triangle(const struct orl_mesh *mesh, size_t i, uint32_t a, uint32_t b,
                           uint32_t c)
{
    assert_int_equal(mesh->triangle[i][0], a);
    assert_int_equal(mesh->triangle[i][1], b);
    assert_int_equal(mesh->triangle[i][2], c);
}

#define SQUARE "ply\nformat ascii 1.0\nelement vertex 4\nproperty float x\nproperty float y\n" \
               "property float z\nproperty uchar red\nproperty uchar green\nproperty uchar blue\n" \
               "element edge 1\nproperty int a\nproperty int b\n" \
               "element face 1\nproperty uchar group\nproperty list uchar int vertex_indices\n" \
               "end_header\n0 0 0 1 2 3\n1 0 0 4 5 6\n1 1 0 7 8 9\n0 1 0 10 11 12\n0 1\n9 4 0 1 2 3\n"

static void reads_ply(void **state)
{
    (void)state;
    struct orl_mesh mesh;
    assert_int_equal(read_text(NULL, SQUARE, &mesh), ORL_OK);
    assert_int_equal(mesh.vertex_count, 4);
    assert_int_equal(mesh.triangle_count, 2); // the polygon's fan
    check_triangle(&mesh, 0, 0, 1, 2);
    check_triangle(&mesh, 1, 0, 2, 3);
    assert_float_equal(mesh.position[2][1], 1, 0);
    assert_int_equal(mesh.color[3][2], 12);
    assert_null(mesh.normal);
    orl_mesh_finish(&mesh);
}

static void reads_obj(void **state)
{
    (void)state;
    struct orl_mesh mesh;
    assert_int_equal(read_text(NULL, "# a square\nmtllib x.mtl\nv 0 0 0\nv 1 0 0 \nvn 0 0 1\n"
                                     "vt 0 0\nv 1 1 0\nv 0 1 0\r\no thing\n"
                                     "f 1/1/1 2//1 3/1 4\nf -1 -2 -3\n", &mesh), ORL_OK);
    assert_int_equal(mesh.vertex_count, 4);
    assert_int_equal(mesh.triangle_count, 3);
    check_triangle(&mesh, 1, 0, 2, 3);
    check_triangle(&mesh, 2, 3, 2, 1); // from the last vertex back
    assert_null(mesh.color);
    orl_mesh_finish(&mesh);
    assert_int_equal(read_text(NULL, "v 0 0 0 1 0.5 0\nv 1 0 0 0 0 0\nv 1 1 0 2 0 0\nf 1 2 3\n",
                               &mesh), ORL_OK);
    assert_int_equal(mesh.color[0][1], 128);
    assert_int_equal(mesh.color[2][0], 255);
    orl_mesh_finish(&mesh);
}

static void round_trips(void **state)
{
    (void)state;
    struct orl_mesh mesh, again;
    assert_int_equal(read_text(NULL, SQUARE, &mesh), ORL_OK);
    assert_int_equal(orl_mesh_set_normals(NULL, &mesh), ORL_OK);
    assert_float_equal(mesh.normal[1][2], 1, 1e-6);
    assert_int_equal(orl_mesh_write(NULL, file, &mesh), ORL_OK);
    assert_int_equal(orl_mesh_read(NULL, file, NULL, &again), ORL_OK);
    assert_memory_equal(mesh.position, again.position, 4 * sizeof *mesh.position);
    assert_memory_equal(mesh.normal, again.normal, 4 * sizeof *mesh.normal);
    assert_memory_equal(mesh.color, again.color, 4 * sizeof *mesh.color);
    assert_memory_equal(mesh.triangle, again.triangle, 2 * sizeof *mesh.triangle);
    // Cut off anywhere it is refused.
    uint8_t *data;
    size_t size;
    assert_int_equal(orl_file_read(NULL, file, SIZE_MAX / 2, &data, &size), ORL_OK);
    for (size_t cut = 0; cut < size; cut++) {
        struct orl_mesh part;
        assert_int_not_equal(read_bytes(NULL, data, cut, &part), ORL_OK);
        assert_null(part.position);
    }
    free(data);
    orl_mesh_finish(&mesh);
    orl_mesh_finish(&again);
}

#define HEAD "ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\nproperty float y\n" \
             "property float z\n"
#define VERTICES "0 0 0\n1 0 0\n0 1 0\n"

static void refuses_damage(void **state)
{
    (void)state;
    static const struct {
        const char *text, *why;
    } cases[] = {
        {"", "no faces"},
        {"v 0 0 0\n", "no faces"},
        {"v 0 0\n", "line 1 (byte "},
        {"v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2\n", "line 4 (byte "},
        {"v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 4\n", "a vertex that is not there"},
        {"v 0 0 0\nv 1 0 0\nv 0 1 0\nf 0 1 2\n", "a vertex that is not there"},
        {"v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 -4\n", "a vertex that is not there"},
        {"v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3x\n", "a vertex that is not there"},
        {"v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 99999999999999999999\n", "a vertex that is not there"},
        {"v 0 0 0\nv 1 0 0\nv nan 1 0\nf 1 2 3\n", "vertex 2 is not finite"},
        {HEAD "end_header\n" VERTICES, "no faces after the vertices"},
        {HEAD "element face 1\nproperty uchar a\nend_header\n" VERTICES "1\n",
         "lack a list of vertex_indices"},
        {HEAD "element face 1\nproperty list uchar int vertex_indices\nend_header\n" VERTICES
         "3 0 1 3\n", "a vertex that is not there"},
        {HEAD "element face 1\nproperty list uchar int vertex_indices\nend_header\n" VERTICES
         "3 0 1 -1\n", "a vertex that is not there"},
        {HEAD "element face 1\nproperty list uchar int vertex_indices\nend_header\n" VERTICES
         "3 0 1\n", "missing or not a number"},
        {HEAD "element face 1\nproperty list uchar int vertex_indices\nend_header\n" VERTICES
         "4000000000 0 1 2\n", "a list is larger than the file"},
        {HEAD "element face 1000000000000\nproperty list uchar int vertex_indices\nend_header\n"
         VERTICES "3 0 1 2\n", "claims 1000000000000 records of face"},
        {HEAD "element face 1\nproperty list float int vertex_indices\nend_header\n" VERTICES
         "3 0 1 2\n", "unknown type"},
        {"ply\nformat ascii 1.0\nelement vertex 99999999999\nproperty float x\nproperty float y\n"
         "property float z\nend_header\n0 0 0\n", "claims 99999999999 records of vertex"},
    };
    for (size_t i = 0; i < ORL_COUNT(cases); i++) {
        struct said said;
        struct orl_log log = log_to(&said);
        struct orl_mesh mesh;
        enum orl_result result = read_text(&log, cases[i].text, &mesh);
        if (result != ORL_ERR_FORMAT || !strstr(said.text, cases[i].why) ||
            !strstr(said.text, file))
            fail_msg("case %zu: %s: \"%s\" does not say \"%s\"", i, orl_result_name(result),
                     said.text, cases[i].why);
        assert_null(mesh.position);
    }
    struct orl_mesh mesh;
    assert_int_equal(orl_mesh_read(NULL, "/nowhere/x.ply", NULL, &mesh), ORL_ERR_NOT_FOUND);
}

// --- surfaces ---

enum { N = 40 };

// A ball of this radius around the middle of a grid over [-1, 1]^3.
static struct orl_mesh ball(double radius)
{
    static float value[N * N * N];
    struct orl_grid grid = {.size = {N, N, N}, .origin = {-1, -1, -1}, .spacing = 2.0 / (N - 1),
                            .value = value};
    for (int i = 0; i < N * N * N; i++) {
        double x = -1 + grid.spacing * (i % N), y = -1 + grid.spacing * (i / N % N);
        double z = -1 + grid.spacing * (i / N / N);
        value[i] = (float)(sqrt(x * x + y * y + z * z) - radius);
    }
    struct orl_mesh mesh;
    assert_int_equal(orl_isosurface(NULL, &grid, &mesh), ORL_OK);
    return mesh;
}

// Every edge of a closed surface belongs to two triangles, once each way.
static void check_closed(const struct orl_mesh *mesh)
{
    size_t n = mesh->vertex_count;
    int8_t *balance = calloc(n * n, 1);
    assert_non_null(balance);
    for (size_t i = 0; i < mesh->triangle_count; i++)
        for (int k = 0; k < 3; k++) {
            size_t a = mesh->triangle[i][k], b = mesh->triangle[i][(k + 1) % 3];
            balance[a < b ? a * n + b : b * n + a] += a < b ? 1 : -1;
        }
    for (size_t i = 0; i < n * n; i++)
        assert_int_equal(balance[i], 0);
    free(balance);
}

static void waits_for_no_fifo(void **state)
{
    (void)state;
    char *path = test_path(dir, "fifo");
    struct orl_mesh mesh;
    assert_int_equal(mkfifo(path, 0600), 0);
    alarm(20);
    assert_int_equal(orl_mesh_read(NULL, path, NULL, &mesh), ORL_ERR_IO);
    alarm(0);
    unlink(path);
    free(path);
}

static void finds_surfaces(void **state)
{
    (void)state;
    const double radius = 0.8, volume = 4.0 / 3 * 3.14159265358979 * radius * radius * radius;
    struct orl_mesh mesh = ball(radius);
    check_closed(&mesh);
    // Euler's formula for a sphere, whose edges are 3/2 of its triangles.
    assert_int_equal((long)mesh.vertex_count - (long)mesh.triangle_count / 2, 2);
    assert_float_equal(mesh_volume(&mesh), volume, 0.01 * volume); // positive: facing outward
    for (size_t i = 0; i < mesh.vertex_count; i++) {
        const float *p = mesh.position[i];
        assert_float_equal(sqrtf(p[0] * p[0] + p[1] * p[1] + p[2] * p[2]), radius, 0.01);
    }
    orl_mesh_finish(&mesh);
}

static void refuses_open_fields(void **state)
{
    (void)state;
    float value[8] = {-1, 1, 1, 1, 1, 1, 1, 1};
    struct orl_grid grid = {.size = {2, 2, 2}, .spacing = 1, .value = value};
    struct orl_mesh mesh;
    assert_int_equal(orl_isosurface(NULL, &grid, &mesh), ORL_ERR_DATA);
    assert_null(mesh.position);
}

static void decimates(void **state)
{
    (void)state;
    const double volume = 4.0 / 3 * 3.14159265358979 * 0.512;
    struct orl_mesh mesh = ball(0.8);
    assert_int_equal(orl_mesh_set_normals(NULL, &mesh), ORL_OK);
    assert_true(mesh.triangle_count > 4000);
    assert_int_equal(orl_mesh_decimate(NULL, 1000, &mesh), ORL_OK);
    assert_between(mesh.triangle_count, 900, 1000);
    assert_between(mesh.vertex_count, 450, 510); // no unused ones
    check_closed(&mesh);
    assert_float_equal(mesh_volume(&mesh), volume, 0.03 * volume);
    for (size_t i = 0; i < mesh.vertex_count; i++) // normals went with their vertices
        for (int k = 0; k < 3; k++)
            assert_float_equal(mesh.normal[i][k], mesh.position[i][k] / 0.8f, 0.1);
    orl_mesh_finish(&mesh);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(reads_ply), cmocka_unit_test(reads_obj), cmocka_unit_test(round_trips),
        cmocka_unit_test(refuses_damage), cmocka_unit_test(waits_for_no_fifo),
        cmocka_unit_test(finds_surfaces), cmocka_unit_test(refuses_open_fields), cmocka_unit_test(decimates),
    };
    return cmocka_run_group_tests(tests, set_up, tear_down);
}
