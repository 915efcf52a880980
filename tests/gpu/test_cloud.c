// Which points of a cloud are drawn: culling by blocks, and levels of detail.
#include <math.h>
#include <string.h>

#include "gpu_test.h"
#include "scene/point_code.h"
#include "scene/point_lod.h"
#include "test.h"
#include "render/proxy/splats.h"

static struct orl_gpu *gpu;

enum {
    SIDE = 64, COUNT = 50000,
    CLOSE = 2, // the front view enlarged so far has 16 points of the wall in a pixel, and two of the next level
};

// Looks along +z from the origin, 90 degrees wide.
static const struct orl_view front_view = {
    .camera = {.width = SIDE, .height = SIDE, .fx = SIDE / 2, .fy = SIDE / 2, .cx = SIDE / 2,
               .cy = SIDE / 2},
    .cam_from_world = {.r = {{1, 0, 0}, {0, 1, 0}, {0, 0, 1}}}};

static double random_value(uint32_t *state)
{
    *state = *state * 1664525u + 1013904223u;
    return (*state >> 8) * (1.0 / 16777216);
}

struct scene {
    struct orl_points points;
    struct proxy proxy;
    struct surface surface;
};

static const struct cloud *cloud_of(const struct scene *s)
{
    return s->proxy.state;
}

static void open_scene(struct scene *s)
{
    const struct orl_scene scene = {.points = s->points};
    assert_int_equal(orl_proxy_create(gpu, &scene, &orl_proxy_splats, 0, &s->proxy), ORL_OK);
}

static void close_scene(struct scene *s)
{
    orl_proxy_finish(gpu, &s->proxy);
    orl_points_finish(&s->points);
}

// The front view with so many pixels for each of its own.
static void draw(struct scene *s, int enlarged)
{
    const struct orl_render_params params = {.splat_scale = 1, .front_layer = 0.01f};
    struct orl_view view = front_view;
    view.camera.width *= enlarged;
    view.camera.height *= enlarged;
    view.camera.fx *= enlarged;
    view.camera.fy *= enlarged;
    view.camera.cx *= enlarged;
    view.camera.cy *= enlarged;
    assert_int_equal(orl_proxy_draw(gpu, &s->proxy, &view, &params, true, &s->proxy.view_target,
                                    &s->surface), ORL_OK);
    assert_int_equal(orl_gpu_finish(gpu), ORL_OK);
}

// Blocks listed by the last draw; marks them.
static size_t read_list(const struct scene *s, bool *listed, size_t capacity)
{
    const struct point_chunk *chunk = &cloud_of(s)->chunks[0];
    uint32_t args[4];
    static uint32_t blocks[COUNT];
    orl_buf_read(chunk->args, sizeof args, args);
    assert_between(args[3], 0, COUNT);
    assert_int_equal(args[0], (args[3] + ORL_SPLAT_POINTS - 1) / ORL_SPLAT_POINTS);
    orl_buf_read(chunk->list, args[3] * sizeof *blocks, blocks);
    memset(listed, 0, capacity);
    for (uint32_t i = 0; i < args[3]; i++) {
        assert_true(blocks[i] < capacity);
        assert_false(listed[blocks[i]]);
        listed[blocks[i]] = true;
    }
    return args[3];
}

enum { CAPACITY = COUNT + 64 * ORL_BLOCK_POINTS };

// Positions as the device has them.
static void read_positions(const struct point_chunk *chunk, float (*positions)[3], bool *exists)
{
    static uint32_t codes[CAPACITY][2];
    static float blocks[CAPACITY / ORL_BLOCK_POINTS][ORL_BLOCK_VEC4S][4];
    assert_between(chunk->count, 1, CAPACITY);
    orl_buf_read(chunk->points, (size_t)chunk->count * sizeof *codes, codes);
    orl_buf_read(chunk->blocks, (size_t)chunk->block_count * sizeof *blocks, blocks);
    for (int i = 0; i < chunk->count; i++) {
        const float *corner = blocks[i / ORL_BLOCK_POINTS][2];
        const struct point_frame frame = {{corner[0], corner[1], corner[2]}, corner[3]};
        exists[i] = orl_point_decode_position(&frame, codes[i], positions[i]);
    }
}

// Points all around the viewer: all of those in the picture are listed, and far from all of
// the others.
static void blocks_outside_are_skipped(void **state)
{
    (void)state;
    struct scene s = {0};
    uint32_t seed = 1;
    assert_int_equal(orl_points_init(NULL, &s.points, COUNT), ORL_OK);
    for (size_t i = 0; i < COUNT; i++) {
        for (int k = 0; k < 3; k++)
            s.points.position[i][k] = (float)(10 * random_value(&seed) - 5);
        s.points.radius[i] = 0.01f;
    }
    s.points.position[7][0] = NAN; // dropped
    s.points.position[9][2] = 1e30f;
    open_scene(&s);
    draw(&s, 1);
    const struct point_chunk *chunk = &cloud_of(&s)->chunks[0];
    static bool listed[COUNT];
    size_t blocks = read_list(&s, listed, COUNT);
    static float positions[CAPACITY][3];
    static bool exists[CAPACITY];
    read_positions(chunk, positions, exists);
    size_t seen = 0, stored = 0;
    for (int i = 0; i < chunk->count; i++) {
        const float *p = positions[i];
        stored += exists[i];
        if (exists[i] && p[2] > 0 && fabsf(p[0]) < p[2] && fabsf(p[1]) < p[2]) {
            seen++;
            assert_true(listed[i / ORL_BLOCK_POINTS]);
        }
    }
    assert_int_equal(stored, COUNT - 1);
    assert_true(seen > COUNT / 8);
    assert_true(blocks * ORL_BLOCK_POINTS < 2 * seen);
    close_scene(&s);
}

// A wall of 64 points to a pixel, with some depth noise.
static void make_wall(struct scene *s)
{
    enum { ROW = 8 * SIDE };
    uint32_t seed = 1;
    assert_int_equal(orl_points_init(NULL, &s->points, ROW * ROW), ORL_OK);
    for (size_t i = 0; i < ROW * ROW; i++) {
        double z = 2 + 0.001 * random_value(&seed);
        s->points.position[i][0] = (float)(((double)(i % ROW) + 0.5) / ROW * 2 * z - z);
        s->points.position[i][1] = (float)(((double)(i / ROW) + 0.5) / ROW * 2 * z - z);
        s->points.position[i][2] = (float)z;
        s->points.normal[i][2] = -1;
        s->points.radius[i] = 4.0f / ROW;
    }
}

static void a_wall_has_no_holes(void **state)
{
    (void)state;
    struct scene s = {0};
    static bool listed[COUNT];
    static float depth[SIDE * SIDE];
    make_wall(&s);
    open_scene(&s);
    draw(&s, 1);
    assert_int_equal(read_list(&s, listed, sizeof listed) * ORL_BLOCK_POINTS, 64 * SIDE * SIDE);
    orl_tex_read(s.surface.depth, 0, GL_RED, GL_FLOAT, sizeof depth, depth);
    for (int i = 0; i < SIDE * SIDE; i++)
        assert_float_equal(depth[i], 2.0005, 0.001);
    close_scene(&s);
}

// The list is made in any order; the frame is the same to the bit.
static void runs_are_the_same(void **state)
{
    (void)state;
    struct scene s = {0};
    static float depth[2][SIDE * SIDE], normal[2][SIDE * SIDE * 4];
    make_wall(&s);
    open_scene(&s);
    for (int run = 0; run < 5; run++) {
        int to = run > 0 ? 1 : 0;
        draw(&s, 1);
        orl_tex_read(s.surface.depth, 0, GL_RED, GL_FLOAT, sizeof depth[to], depth[to]);
        orl_tex_read(s.surface.normal, 0, GL_RGBA, GL_FLOAT, sizeof normal[to], normal[to]);
        if (run == 0)
            continue;
        assert_memory_equal(depth[0], depth[1], sizeof depth[0]);
        assert_memory_equal(normal[0], normal[1], sizeof normal[0]);
    }
    close_scene(&s);
}

// Clouds larger than a buffer may be are drawn in chunks: no pixel differs.
static void chunks_draw_as_one(void **state)
{
    (void)state;
    struct orl_gpu_caps *caps = (struct orl_gpu_caps *)(uintptr_t)orl_gpu_caps(gpu);
    int texels = caps->max_buffer_texels;
    static float depth[2][SIDE * SIDE], normal[2][SIDE * SIDE * 4];
    for (int run = 0; run < 2; run++) {
        struct scene s = {0};
        make_wall(&s);
        caps->max_buffer_texels = run ? 150000 : texels;
        open_scene(&s);
        assert_int_equal(cloud_of(&s)->chunk_count, run ? 6 : 1);
        draw(&s, 1);
        orl_tex_read(s.surface.depth, 0, GL_RED, GL_FLOAT, sizeof depth[run], depth[run]);
        orl_tex_read(s.surface.normal, 0, GL_RGBA, GL_FLOAT, sizeof normal[run], normal[run]);
        close_scene(&s);
    }
    caps->max_buffer_texels = texels;
    assert_memory_equal(depth[0], depth[1], sizeof depth[0]);
    assert_memory_equal(normal[0], normal[1], sizeof normal[0]);
}

// A scene whose points are drawn from a file.
struct paged {
    struct scene s;
    struct orl_lod *lod;
    char *dir, *ply, *file;
};

static void open_pages(struct paged *p, size_t max_bytes)
{
    static const struct orl_lod_params params = {ORL_LOD_DEFAULTS};
    make_wall(&p->s);
    assert_int_equal(test_file_make("points.ply", &p->dir, &p->ply), 0);
    p->file = orl_path_join(NULL, p->dir, ORL_LOD_NAME);
    assert_int_equal(orl_points_write(NULL, p->ply, &p->s.points, false, NULL), ORL_OK);
    assert_int_equal(orl_lod_write(NULL, NULL, &params, p->ply, p->file), ORL_OK);
    assert_int_equal(orl_lod_open(NULL, p->file, &p->lod), ORL_OK);
    const struct orl_scene scene = {.points = p->s.points, .lod = p->lod};
    assert_int_equal(orl_proxy_create(gpu, &scene, &orl_proxy_splats, max_bytes, &p->s.proxy),
                     ORL_OK);
}

static void close_pages(struct paged *p)
{
    close_scene(&p->s);
    orl_lod_close(&p->lod);
    assert_int_equal(orl_dir_remove(NULL, p->dir), ORL_OK);
    free(p->dir);
    free(p->ply);
    free(p->file);
}

// Where a view needs all points, or all that the device can hold, it gets what it gets of a cloud
// that is on the device as a whole.
static void pages_draw_as_the_whole(void **state)
{
    (void)state;
    static float depth[2][CLOSE * SIDE * CLOSE * SIDE], normal[2][CLOSE * SIDE * CLOSE * SIDE * 4];
    for (int run = 0; run < 2; run++) {
        struct paged p = {0};
        if (run == 0) {
            make_wall(&p.s);
            open_scene(&p.s);
        } else {
            open_pages(&p, 0);
        }
        draw(&p.s, CLOSE);
        orl_tex_read(p.s.surface.depth, 0, GL_RED, GL_FLOAT, sizeof depth[run], depth[run]);
        orl_tex_read(p.s.surface.normal, 0, GL_RGBA, GL_FLOAT, sizeof normal[run], normal[run]);
        if (run == 0)
            close_scene(&p.s);
        else
            close_pages(&p);
    }
    assert_memory_equal(depth[0], depth[1], sizeof depth[0]);
    assert_memory_equal(normal[0], normal[1], sizeof normal[0]);
}

// What is planned for a cloud is what it takes with its colours.
static void bytes_are_those_on_the_device(void **state)
{
    (void)state;
    struct scene whole = {0};
    struct paged pages = {0};
    make_wall(&whole);
    const struct orl_scene scene = {.points = whole.points};
    assert_int_equal(orl_proxy_create(gpu, &scene, &orl_proxy_splats, 0, &whole.proxy), ORL_OK);
    size_t bytes = orl_cloud_bytes(cloud_of(&whole));
    assert_int_equal(orl_gpu_owner_bytes(gpu, ORL_OWNER_POINTS), bytes - 3 * whole.points.count);
    assert_int_equal(orl_cloud_bring_colors(gpu, whole.proxy.state), ORL_OK);
    assert_int_equal(orl_gpu_owner_bytes(gpu, ORL_OWNER_POINTS), bytes);
    close_scene(&whole);
    open_pages(&pages, 1);
    assert_int_equal(orl_gpu_owner_bytes(gpu, ORL_OWNER_POINTS), orl_cloud_bytes(cloud_of(&pages.s)));
    close_pages(&pages);
}

// With room for half of the pages, and for coarse levels where a few points are enough, the wall has
// no hole; and what was drawn before does not matter.
static void few_pages_leave_no_hole(void **state)
{
    (void)state;
    struct paged p = {0};
    static float depth[3][CLOSE * SIDE * CLOSE * SIDE];
    open_pages(&p, 1); // the least: 16 pages; the wall's finest level has 32
    assert_true(p.lod->levels[0].count > 16);
    for (int run = 0; run < 3; run++) {
        const int side = (run == 1 ? 1 : CLOSE) * SIDE;
        const size_t bytes = (size_t)side * (size_t)side * sizeof **depth;
        draw(&p.s, side / SIDE);
        orl_tex_read(p.s.surface.depth, 0, GL_RED, GL_FLOAT, bytes, depth[run]);
        for (int i = 0; i < side * side; i++)
            assert_float_equal(depth[run][i], 2.0005, 0.002);
    }
    assert_memory_equal(depth[0], depth[2], sizeof depth[0]);
    close_pages(&p);
}

static void no_points_are_no_depth(void **state)
{
    (void)state;
    struct scene s = {0};
    static float depth[SIDE * SIDE];
    assert_int_equal(orl_points_init(NULL, &s.points, 1), ORL_OK);
    s.points.position[0][1] = INFINITY;
    open_scene(&s);
    draw(&s, 1);
    orl_tex_read(s.surface.depth, 0, GL_RED, GL_FLOAT, sizeof depth, depth);
    for (int i = 0; i < SIDE * SIDE; i++)
        assert_float_equal(depth[i], 0, 0);
    close_scene(&s);
}

int main(void)
{
    gpu = gpu_test_device();
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(blocks_outside_are_skipped),
        cmocka_unit_test(a_wall_has_no_holes),
        cmocka_unit_test(runs_are_the_same),
        cmocka_unit_test(chunks_draw_as_one),
        cmocka_unit_test(pages_draw_as_the_whole),
        cmocka_unit_test(bytes_are_those_on_the_device),
        cmocka_unit_test(few_pages_leave_no_hole),
        cmocka_unit_test(no_points_are_no_depth),
    };
    int failed = cmocka_run_group_tests_name("cloud", tests, NULL, NULL);
    orl_gpu_destroy(&gpu);
    return failed;
}
