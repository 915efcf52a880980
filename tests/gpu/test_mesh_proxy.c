// A mesh as the proxy: depth, normals and the depth test of triangles whose answers are known, and
// photographs painted on them.
#include <math.h>

#include "mesh_help.h"
#include "render/frame/method.h"
#include "render/proxy/proxy.h"
#include "scene/mesh.h"
#include "wall_scene.h"

enum { W = 40, H = 30 };

static struct orl_gpu *gpu;

// A slanted square through (0, 0, 4) whose depth grows by half a unit per unit of x, and a small
// triangle at z = 2 before its middle, listed first and last so that order does not matter. All
// is green; with `colored` the square is red on the left and blue on the right.
static void write_mesh(const char *dir, bool colored)
{
    static const float square[4][3] = {{-3, -3, 2.5f}, {3, -3, 5.5f}, {3, 3, 5.5f}, {-3, 3, 2.5f}};
    static const float small[3][3] = {{-0.2f, -0.2f, 2}, {0.2f, -0.2f, 2}, {0, 0.2f, 2}};
    static const uint32_t faces[3][3] = {{4, 5, 6}, {0, 1, 2}, {0, 2, 3}};
    struct orl_mesh mesh;
    mesh = mesh_of(7, 3);
    memcpy(mesh.position, square, sizeof square);
    memcpy(mesh.position + 4, small, sizeof small);
    memcpy(mesh.triangle, faces, sizeof faces);
    mesh.color = calloc(mesh.vertex_count, sizeof *mesh.color);
    assert_non_null(mesh.color);
    for (size_t i = 0; i < mesh.vertex_count; i++)
        mesh.color[i][!colored || i >= 4 ? 1 : i % 4 == 0 || i == 3 ? 0 : 2] = 255;
    char *path = orl_path_join(NULL, dir, "mesh.ply");
    assert_int_equal(orl_mesh_write(NULL, path, &mesh), ORL_OK);
    free(path);
    orl_mesh_finish(&mesh);
}

static struct orl_view view_of(void)
{
    struct orl_view view = look_from(0, 0, 0, W, 20);
    view.camera.height = H;
    view.camera.cy = 0.5 * H;
    return view;
}

static void triangles_have_their_depth_and_normal(void **state)
{
    (void)state;
    struct fixture f;
    setup_empty(&f, 4);
    write_mesh(f.dir, false);
    struct orl_view view = view_of();
    struct orl_render_params params = orl_method_find(NULL, "airieau")->params;
    struct proxy proxy;
    struct surface surface;
    static float depth[W * H], normal[W * H][4];
    assert_int_equal(orl_proxy_create(gpu, &f.scene, &orl_proxy_mesh, 0, &proxy), ORL_OK);
    assert_int_equal(proxy.vertex_count, 7);
    assert_float_equal(proxy.extent.low[2], 2, 0);
    assert_float_equal(proxy.extent.high[0], 3, 0);
    assert_int_equal(orl_proxy_draw(gpu, &proxy, &view, &params, true, &proxy.view_target, &surface),
                     ORL_OK);
    orl_tex_read(surface.depth, 0, GL_RED, GL_FLOAT, sizeof depth, depth);
    orl_tex_read(surface.normal, 0, GL_RGBA, GL_FLOAT, sizeof normal, normal);
    assert_int_equal(orl_gpu_finish(gpu), ORL_OK);
    // A ray (u, v, 1) meets z = 4 + x / 2 at z = 4 / (1 - u / 2).
    for (int y = 2; y < H - 2; y++)
        for (int x = 2; x < W - 2; x++) {
            double u = (x + 0.5 - W / 2) / 20, v = (y + 0.5 - H / 2) / 20, z = 4 / (1 - u / 2);
            const float *n = normal[y * W + x];
            if (fabs(u * z) > 2.9 || fabs(v * z) > 2.9 || hypot(u, v) < 0.15)
                continue;
            assert_float_equal(depth[y * W + x], z, 1e-4 * z);
            assert_float_equal(n[0], 0.5 / hypot(0.5, 1), 2e-3);
            assert_float_equal(n[2], -1 / hypot(0.5, 1), 2e-3);
            assert_float_equal(n[3], 1, 0);
        }
    assert_float_equal(depth[H / 2 * W + W / 2], 2, 1e-4);
    orl_proxy_finish(gpu, &proxy);
    teardown(&f);
}

static void nothing_is_where_no_triangle_is(void **state)
{
    (void)state;
    struct fixture f;
    setup_empty(&f, 4);
    write_mesh(f.dir, false);
    struct orl_view view = view_of();
    view.cam_from_world = (struct orl_pose){.r = {{-1, 0, 0}, {0, 1, 0}, {0, 0, -1}}};
    struct orl_render_params params = orl_method_find(NULL, "airieau")->params;
    struct proxy proxy;
    struct surface surface;
    static float depth[W * H];
    assert_int_equal(orl_proxy_create(gpu, &f.scene, &orl_proxy_mesh, 0, &proxy), ORL_OK);
    assert_int_equal(orl_proxy_draw(gpu, &proxy, &view, &params, true, &proxy.view_target, &surface),
                     ORL_OK);
    orl_tex_read(surface.depth, 0, GL_RED, GL_FLOAT, sizeof depth, depth);
    for (int i = 0; i < W * H; i++)
        assert_float_equal(depth[i], 0, 0);
    orl_proxy_finish(gpu, &proxy);
    teardown(&f);
}

// The small triangle hides the square from one photograph, which does not paint it there.
static void every_method_paints_a_mesh(void **state)
{
    (void)state;
    struct fixture f;
    setup_empty(&f, 4);
    write_mesh(f.dir, false);
    add_photo(&f, look_from(0.3, 0, 0, W, 20), green);
    add_photo(&f, look_from(-0.3, 0, 0, W, 20), green);
    for (const struct orl_method *m = orl_methods; m->name; m++) {
        struct orl_render_params params = m->params;
        if (params.paint->needs[0] && strcmp(params.paint->name, "tiled") != 0)
            continue; // goes with a proxy of its own
        assert_int_equal(orl_render_params_set(NULL, &params, "proxy=mesh"), ORL_OK);
        struct orl_frame frame = draw(gpu, &f, view_of(), &params, 0);
        assert_float_equal(color_at(&frame, 10, H / 2)[1], 1, 0.01);
        assert_float_equal(frame.coverage.f32[H / 2 * W + 10], 1, 0);
        assert_float_equal(frame.depth.f32[H / 2 * W + W / 2], 2, 1e-3);
        orl_frame_finish(&frame);
    }
    teardown(&f);
}

// Light is interpolated over the square, in perspective, and the triangle hides it.
static void points_shows_the_colours_of_vertices(void **state)
{
    (void)state;
    struct fixture f;
    setup_empty(&f, 4);
    write_mesh(f.dir, true);
    struct orl_render_params params = orl_method_find(NULL, "points")->params;
    assert_int_equal(orl_render_params_set(NULL, &params, "proxy=mesh"), ORL_OK);
    struct orl_frame frame = draw(gpu, &f, view_of(), &params, 0);
    for (int x = 8; x < W - 8; x++) {
        double u = (x + 0.5 - W / 2) / 20, z = 4 / (1 - u / 2), share = (u * z + 3) / 6;
        const float *c = color_at(&frame, x, 4);
        if (fabs(u * z) > 2.9)
            continue;
        assert_float_equal(c[0], 1 - share, 0.01);
        assert_float_equal(c[1], 0, 0.01);
        assert_float_equal(c[2], share, 0.01);
    }
    assert_float_equal(color_at(&frame, W / 2, H / 2)[1], 1, 0.01);
    orl_frame_finish(&frame);
    teardown(&f);
}

static void a_scene_without_mesh_says_so(void **state)
{
    (void)state;
    struct fixture f;
    setup_empty(&f, 4);
    struct orl_renderer *renderer;
    struct orl_render_params params = orl_method_find(NULL, "airieau")->params;
    struct orl_view view = view_of();
    struct orl_frame frame;
    assert_int_equal(orl_render_params_set(NULL, &params, "proxy=mesh"), ORL_OK);
    add_photo(&f, view, red);
    assert_int_equal(orl_renderer_create(gpu, &f.scene, NULL, &renderer), ORL_OK);
    assert_int_equal(orl_renderer_draw(renderer, &view, &params, NULL, &frame), ORL_ERR_NOT_FOUND);
    orl_renderer_destroy(&renderer);
    teardown(&f);
}

// A time step whose mesh is not there fails in every frame, and the next one that has a mesh is drawn.
static void a_mesh_that_was_not_there_is_asked_for_again(void **state)
{
    (void)state;
    struct fixture f;
    setup_empty(&f, 4);
    write_mesh(f.dir, false);
    struct orl_renderer *renderer;
    struct orl_render_params params = orl_method_find(NULL, "points")->params;
    struct orl_view view = view_of();
    struct orl_frame frame;
    char *path = orl_path_join(NULL, f.dir, "mesh.ply");
    assert_int_equal(orl_render_params_set(NULL, &params, "proxy=mesh"), ORL_OK);
    add_photo(&f, view, red);
    assert_int_equal(orl_renderer_create(gpu, &f.scene, NULL, &renderer), ORL_OK);
    assert_int_equal(orl_renderer_draw(renderer, &view, &params, NULL, NULL), ORL_OK);
    assert_int_equal(remove(path), 0);
    f.scene.frame++;
    for (int i = 0; i < 2; i++)
        assert_int_equal(orl_renderer_draw(renderer, &view, &params, NULL, NULL), ORL_ERR_NOT_FOUND);
    write_mesh(f.dir, false);
    assert_int_equal(orl_renderer_draw(renderer, &view, &params, NULL, &frame), ORL_OK);
    assert_float_equal(frame.depth.f32[H / 2 * W + W / 2], 2, 1e-3);
    orl_frame_finish(&frame);
    orl_renderer_destroy(&renderer);
    free(path);
    teardown(&f);
}

// Two strays of two hundred vertices, far away, move neither the box nor the centre.
static void the_extent_leaves_strays_out(void **state)
{
    (void)state;
    enum { COUNT = 200 };
    struct fixture f;
    struct orl_mesh mesh;
    struct proxy proxy;
    const uint32_t face[3] = {0, 1, 2};
    setup_empty(&f, 4);
    mesh = mesh_of(COUNT, 1);
    memcpy(mesh.triangle[0], face, sizeof face);
    for (int i = 0; i < COUNT; i++)
        for (int k = 0; k < 3; k++)
            mesh.position[i][k] = i < 2 ? 1000 : (float)((i * (k + 3)) % COUNT) / COUNT;
    char *path = orl_path_join(NULL, f.dir, "mesh.ply");
    assert_int_equal(orl_mesh_write(NULL, path, &mesh), ORL_OK);
    assert_int_equal(orl_proxy_create(gpu, &f.scene, &orl_proxy_mesh, 0, &proxy), ORL_OK);
    for (int k = 0; k < 3; k++) {
        assert_true(proxy.extent.low[k] >= 0 && proxy.extent.low[k] < 0.05);
        assert_true(proxy.extent.high[k] > 0.95 && proxy.extent.high[k] < 1);
        assert_float_equal(proxy.extent.centroid[k], 0.5, 0.05);
    }
    orl_proxy_finish(gpu, &proxy);
    orl_mesh_finish(&mesh);
    free(path);
    teardown(&f);
}

int main(void)
{
    gpu = gpu_test_device();
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(the_extent_leaves_strays_out),
        cmocka_unit_test(triangles_have_their_depth_and_normal),
        cmocka_unit_test(nothing_is_where_no_triangle_is),
        cmocka_unit_test(every_method_paints_a_mesh),
        cmocka_unit_test(points_shows_the_colours_of_vertices),
        cmocka_unit_test(a_scene_without_mesh_says_so),
        cmocka_unit_test(a_mesh_that_was_not_there_is_asked_for_again),
    };
    int failed = cmocka_run_group_tests_name("mesh proxy", tests, NULL, NULL);
    orl_gpu_destroy(&gpu);
    return failed;
}
