// Compressed photographs, and photographs loaded as the viewer moves past them.
#include <math.h>
#include <string.h>

#include "wall_scene.h"

static struct orl_gpu *gpu;

enum { SIDE = 64, WALL_WIDE = 480, WALL_HIGH = 32, PHOTOS = 60, SLOTS = 6 };

#define STEP 0.5f // between photographs

// Sees 1.33 units of the wall: at most 6 photographs show any of it.
static struct orl_view look(double x)
{
    return look_from(x, 0, 0, SIDE, 96);
}

static void paint(size_t index, uint8_t rgb[3])
{
    rgb[0] = (uint8_t)(20 + 37 * index % 200);
    rgb[1] = (uint8_t)(230 - 53 * index % 200);
    rgb[2] = (uint8_t)(90 + 91 * index % 160);
}

// A wall at z = 2 along x, and photographs of one colour each along it.
static void setup_row(struct fixture *f, size_t count)
{
    setup_empty(f, 2);
    struct orl_points *p = &f->scene.points;
    assert_int_equal(orl_points_init(NULL, p, WALL_WIDE * WALL_HIGH), ORL_OK);
    for (size_t i = 0; i < WALL_WIDE * WALL_HIGH; i++) {
        p->position[i][0] = ((float)(i % WALL_WIDE) - 20) * STEP * PHOTOS / (WALL_WIDE - 40);
        p->position[i][1] = ((float)(i / WALL_WIDE) / WALL_HIGH - 0.5f) * 2;
        p->position[i][2] = 2;
        p->normal[i][2] = -1;
        p->radius[i] = 0.08f;
    }
    for (size_t k = 0; k < count; k++) {
        uint8_t rgb[3];
        paint(k, rgb);
        add_photo(f, look((double)STEP * (double)k), rgb);
    }
}

static struct orl_renderer *renderer_of(const struct fixture *f,
                                        const struct orl_renderer_params *params)
{
    struct orl_renderer *renderer;
    assert_int_equal(orl_renderer_create(gpu, &f->scene, params, &renderer), ORL_OK);
    return renderer;
}

static struct orl_frame draw_at(struct orl_renderer *renderer, double x)
{
    struct orl_view view = look(x);
    struct orl_frame frame;
    assert_int_equal(orl_renderer_draw(renderer, &view, &orl_method_find(NULL, "oriel")->params,
                                       NULL, &frame), ORL_OK);
    return frame;
}

static size_t bytes_of(const char *tag)
{
    struct orl_gpu_memory rows[64];
    size_t count = orl_gpu_memory(gpu, rows, ORL_COUNT(rows)), bytes = 0;
    for (size_t i = 0; i < count; i++)
        if (strcmp(rows[i].tag, tag) == 0)
            bytes += rows[i].bytes;
    return bytes;
}

static float largest_difference(const struct orl_frame *a, const struct orl_frame *b)
{
    float largest = 0;
    for (int i = 0; i < 3 * SIDE * SIDE; i++)
        largest = fmaxf(largest, fabsf(a->color.f32[i] - b->color.f32[i]));
    return largest;
}

static bool device_has(enum orl_textures textures)
{
    return orl_textures_available(gpu, textures);
}

// Blocks of all mip levels of a photograph.
static size_t blocks_of(int side)
{
    size_t blocks = 0;
    for (; side; side /= 2)
        blocks += (size_t)((side + 3) / 4 * ((side + 3) / 4));
    return blocks;
}

static void check_flat(enum orl_textures textures, size_t block, float tolerance)
{
    struct fixture f;
    setup_row(&f, 3);
    struct orl_renderer *full = renderer_of(&f, &(struct orl_renderer_params){0});
    struct orl_frame plain = draw_at(full, 0.7);
    orl_renderer_destroy(&full);
    assert_true(bytes_of("photographs") == 0);
    struct orl_renderer *small =
        renderer_of(&f, &(struct orl_renderer_params){.textures = textures});
    struct orl_frame frame = draw_at(small, 0.7);
    assert_int_equal(bytes_of("photographs"), 3 * blocks_of(SIDE) * block);
    if (textures == ORL_TEXTURES_YCC)
        assert_int_equal(bytes_of("photograph chroma"), 3 * blocks_of(SIDE / 2) * 16);
    orl_renderer_destroy(&small);
    float off = largest_difference(&plain, &frame);
    assert_true(off > 0); // all lose something
    assert_true(off < tolerance);
    orl_frame_finish(&plain);
    orl_frame_finish(&frame);
    teardown(&f);
}

static void bc1_shows_like_colours_in_an_eighth(void **state)
{
    (void)state;
    if (!device_has(ORL_TEXTURES_BC1))
        skip();
    check_flat(ORL_TEXTURES_BC1, 8, 0.04f);
}

// Luma and chroma are rounded to 8 bits, and blue is 1.8 times its chroma.
static void ycc_shows_like_colours_in_a_fifth(void **state)
{
    (void)state;
    check_flat(ORL_TEXTURES_YCC, 8, 0.03f);
}

// The scene's own textures and depth maps are used, and a command's textures win.
static void the_scene_says_how_photographs_are_kept(void **state)
{
    (void)state;
    if (!device_has(ORL_TEXTURES_BC1))
        skip();
    struct fixture f;
    setup_row(&f, 3);
    struct orl_renderer *plain = renderer_of(&f, NULL);
    struct orl_frame wanted = draw_at(plain, 0.7);
    size_t color = bytes_of("photographs"), depth = bytes_of("photograph depth");
    orl_renderer_destroy(&plain);
    f.scene.defaults = (struct orl_scene_defaults){NULL, (char[]){"bc1"}, 2, true};
    struct orl_renderer *small = renderer_of(&f, NULL);
    struct orl_frame frame = draw_at(small, 0.7);
    assert_true(bytes_of("photographs") <= color / 7);
    assert_int_equal(bytes_of("photograph depth"), depth / 8);
    // Each photograph is in its place, so that what they are made from is not kept.
    assert_int_equal(bytes_of("photograph being loaded"), 0);
    assert_true(largest_difference(&wanted, &frame) < 0.04f);
    orl_renderer_destroy(&small);
    struct orl_renderer *full =
        renderer_of(&f, &(struct orl_renderer_params){.textures = ORL_TEXTURES_FULL});
    assert_int_equal(bytes_of("photographs"), color);
    orl_renderer_destroy(&full);
    f.scene.defaults.textures = (char[]){"of_tomorrow"};
    assert_int_equal(orl_renderer_create(gpu, &f.scene, NULL, &full), ORL_ERR_FORMAT);
    orl_frame_finish(&wanted);
    orl_frame_finish(&frame);
    teardown(&f);
}

// Depth maps kept at half the size show the same wall, and nothing is left of the whole ones that
// they are picked from: the one target is the picture's.
static void small_depth_maps_are_picked(void **state)
{
    (void)state;
    struct fixture f;
    setup_row(&f, 3);
    struct orl_renderer *full = renderer_of(&f, &(struct orl_renderer_params){0});
    struct orl_frame plain = draw_at(full, 0.7);
    size_t whole = bytes_of("photograph depth"), targets = bytes_of("proxy depth");
    orl_renderer_destroy(&full);
    f.scene.defaults.depth_divide = 2;
    f.scene.defaults.depth_half = true;
    struct orl_renderer *small = renderer_of(&f, &(struct orl_renderer_params){0});
    struct orl_frame frame = draw_at(small, 0.7);
    assert_int_equal(8 * bytes_of("photograph depth"), whole);
    assert_int_equal(2 * bytes_of("proxy depth"), targets);
    orl_renderer_destroy(&small);
    assert_true(largest_difference(&plain, &frame) < 1e-3f);
    orl_frame_finish(&plain);
    orl_frame_finish(&frame);
    teardown(&f);
}


// `auto` compresses before it halves.
static void short_of_memory_compresses_first(void **state)
{
    (void)state;
    struct fixture f;
    setup_row(&f, PHOTOS);
    struct orl_renderer *all = renderer_of(&f, &(struct orl_renderer_params){0});
    size_t plain = bytes_of("photographs"), depth = bytes_of("photograph depth");
    orl_renderer_destroy(&all);
    size_t budget = (size_t)16 << 20, bytes = plain;
    while (bytes == plain) { // until it binds
        budget -= (plain + depth) / 8;
        struct orl_renderer *small =
            renderer_of(&f, &(struct orl_renderer_params){.max_vram_bytes = budget});
        bytes = bytes_of("photographs");
        assert_int_equal(bytes_of("photograph depth"), depth); // neither smaller nor fewer
        orl_renderer_destroy(&small);
    }
    assert_true(bytes <= plain / 3);
    teardown(&f);
}

// Points are planned as they are on the device: 8.4 bytes, and 3 of their colours.
static void points_leave_room_for_photographs(void **state)
{
    (void)state;
    struct fixture f;
    setup_row(&f, PHOTOS);
    struct orl_renderer *renderer = renderer_of(&f, &(struct orl_renderer_params){0});
    size_t plain = bytes_of("photographs"), depth = (size_t)PHOTOS * SIDE * SIDE * 4;
    size_t targets = (size_t)SIDE * SIDE * (2 * 44 + 74), points = f.scene.points.count;
    orl_renderer_destroy(&renderer);
    for (size_t point_bytes = 11; point_bytes <= 12; point_bytes++) {
        renderer = renderer_of(&f, &(struct orl_renderer_params){
            .max_vram_bytes = plain + depth + targets + point_bytes * points});
        assert_int_equal(bytes_of("photographs") == plain, point_bytes == 12);
        orl_renderer_destroy(&renderer);
    }
    teardown(&f);
}

// Two colours, each in its half of the picture: luma keeps each pixel, chroma the mean of 2x2.
static void ycc_keeps_luma_and_chroma(void **state)
{
    (void)state;
    enum { W = 18, H = 7, HALF_W = 9, HALF_H = 4 }; // no multiple of a block
    struct orl_tex_params params = {.width = W, .height = H, .levels = 1,
                                    .format = GL_RGBA8, .tag = "plain"};
    struct orl_tex *from, *luma, *chroma;
    assert_int_equal(orl_tex_create(gpu, &params, &from), ORL_OK);
    params.format = GL_COMPRESSED_RED_RGTC1;
    params.layers = 1;
    assert_int_equal(orl_tex_create(gpu, &params, &luma), ORL_OK);
    params = (struct orl_tex_params){.width = HALF_W, .height = HALF_H, .levels = 1, .layers = 1,
                                     .format = GL_COMPRESSED_RG_RGTC2, .tag = "chroma"};
    assert_int_equal(orl_tex_create(gpu, &params, &chroma), ORL_OK);
    static uint8_t in[W * H][4], y[W * H][4], c[HALF_W * HALF_H][4];
    static const uint8_t colors[2][4] = {{255, 0, 0, 255}, {20, 120, 220, 255}};
    // Y, Cb and Cr of JPEG's formulas.
    static const int wanted[2][3] = {{76, 85, 255}, {102, 195, 70}};
    for (int i = 0; i < W * H; i++)
        memcpy(in[i], colors[i % W > W / 2], 4);
    orl_tex_write(from, GL_RGBA, GL_UNSIGNED_BYTE, in);
    assert_int_equal(orl_tex_compress_layer(gpu, from, luma, 0), ORL_OK);
    assert_int_equal(orl_tex_compress_layer(gpu, from, chroma, 0), ORL_OK);
    orl_tex_read(luma, 0, GL_RGBA, GL_UNSIGNED_BYTE, sizeof y, y);
    orl_tex_read(chroma, 0, GL_RGBA, GL_UNSIGNED_BYTE, sizeof c, c);
    for (int i = 0; i < W * H; i++)
        assert_true(abs(y[i][0] - wanted[i % W > W / 2][0]) <= 1);
    for (int i = 0; i < HALF_W * HALF_H; i++)
        for (int k = 0; k < 2; k++)
            assert_true(abs(c[i][k] - wanted[2 * (i % HALF_W) > W / 2][1 + k]) <= 1);
    orl_tex_destroy(gpu, &from);
    orl_tex_destroy(gpu, &luma);
    orl_tex_destroy(gpu, &chroma);
    assert_int_equal(orl_gpu_finish(gpu), ORL_OK);
}

// A renderer that has room for SLOTS photographs, by trying budgets.
static struct orl_renderer *renderer_of_few(const struct fixture *f, size_t color, size_t depth)
{
    size_t low = 0, high = (size_t)16 << 20;
    for (int i = 0; i < 24; i++) {
        size_t budget = low + (high - low) / 2;
        struct orl_renderer *renderer = renderer_of(f, &(struct orl_renderer_params){
            .textures = ORL_TEXTURES_FULL, .photo_divide = 4, .max_vram_bytes = budget});
        size_t slots = bytes_of("photographs") / color;
        if (slots == SLOTS)
            return renderer;
        orl_renderer_destroy(&renderer);
        // Once a budget binds, the one for SLOTS is known.
        if (slots > 1 && slots < PHOTOS)
            low = high = slots > SLOTS ? budget - (slots - SLOTS) * (color + depth)
                                       : budget + (SLOTS - slots) * (color + depth);
        else if (slots == 1)
            low = budget;
        else
            high = budget;
    }
    fail_msg("no budget gives %d slots", SLOTS);
    return NULL;
}

// Where no more photographs than slots see the surface, a renderer with few slots makes the
// same picture as one with room for all. (Elsewhere it paints from fewer.)
static void photographs_are_loaded_as_the_viewer_moves(void **state)
{
    (void)state;
    struct fixture f;
    setup_row(&f, PHOTOS);
    struct orl_renderer *all =
        renderer_of(&f, &(struct orl_renderer_params){.photo_divide = 4});
    size_t color = bytes_of("photographs") / PHOTOS;
    size_t depth = bytes_of("photograph depth") / PHOTOS, before = bytes_of("photographs");
    struct orl_frame frames[9];
    for (int i = 0; i < 9; i++) // to the end and back to the start
        frames[i] = draw_at(all, 0.3 + (i < 5 ? i : 8 - i) * 7.1);
    assert_true(largest_difference(&frames[0], &frames[1]) > 0.05f); // the views do differ
    orl_renderer_destroy(&all);
    assert_int_equal(before, PHOTOS * color);
    struct orl_renderer *few = renderer_of_few(&f, color, depth);
    for (int i = 0; i < 9; i++) {
        struct orl_frame frame = draw_at(few, 0.3 + (i < 5 ? i : 8 - i) * 7.1);
        assert_true(largest_difference(&frames[i], &frame) < 1e-6f);
        assert_int_equal(bytes_of("photographs"), SLOTS * color);
        orl_frame_finish(&frame);
        orl_frame_finish(&frames[i]);
    }
    orl_renderer_destroy(&few);
    teardown(&f);
}

int main(void)
{
    gpu = gpu_test_device();
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(bc1_shows_like_colours_in_an_eighth),
        cmocka_unit_test(ycc_shows_like_colours_in_a_fifth),
        cmocka_unit_test(ycc_keeps_luma_and_chroma),
        cmocka_unit_test(the_scene_says_how_photographs_are_kept),
        cmocka_unit_test(small_depth_maps_are_picked),
        cmocka_unit_test(short_of_memory_compresses_first),
        cmocka_unit_test(points_leave_room_for_photographs),
        cmocka_unit_test(photographs_are_loaded_as_the_viewer_moves),
    };
    int failed = cmocka_run_group_tests_name("textures", tests, NULL, NULL);
    orl_gpu_destroy(&gpu);
    return failed;
}
