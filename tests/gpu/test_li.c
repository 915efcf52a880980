// Li 2003: the hull as a mesh, blending by 1/N and by its recurrence, shadow maps without leaks, and
// the room, against answers found by hand and on a figure whose shape is exact.
#include <math.h>

#include "figure_scene.h"
#include "render/mesh_proxy.h"
#include "render/method.h"
#include "render/packing.h"
#include "render/photos.h"

enum { SIDE = 64 };

static struct orl_gpu *gpu;

static struct orl_render_params params_of(const char *const *choices, size_t count)
{
    struct orl_render_params params = orl_method_find(NULL, "li")->params;
    assert_int_equal(orl_render_params_assign(NULL, &params, choices, count), ORL_OK);
    return params;
}

// --- section 4: the hull ---

enum { RING = 6 };

// Photographs of a ball of radius 0.5 at the origin, 4 away, and one of them from above.
static void setup_ball(struct fixture *f)
{
    static const uint8_t *const colors[] = {red, green, blue};
    double radius = 60 * tan(asin(0.5 / 4)), middle = 0.5 * SIDE;
    setup_empty(f, 4);
    for (int i = 0; i < RING; i++)
        add_disc_photo(f, look_around(1.0472 * i, 4, SIDE, 60), colors[i % 3], middle, middle,
                       radius);
    struct orl_view above = look_around(0, 4, SIDE, 60);
    above.cam_from_world =
        (struct orl_pose){.r = {{1, 0, 0}, {0, 0, -1}, {0, 1, 0}}, .t = {0, 0, 4}};
    add_disc_photo(f, above, red, middle, middle, radius);
}

static struct proxy *hull_of(struct fixture *f, const struct orl_render_params *params,
                             struct proxy *proxy, struct photos *photos)
{
    const struct orl_renderer_params none = {0};
    assert_int_equal(orl_photos_init(gpu, &f->scene, &none, 0, photos), ORL_OK);
    assert_int_equal(orl_proxy_create(gpu, &f->scene, &orl_proxy_hull, 0, proxy), ORL_OK);
    struct frame frame = {.gpu = gpu, .scene = &f->scene, .params = params, .proxy = proxy,
                          .photos = photos};
    assert_int_equal(orl_proxy_update(&frame), ORL_OK);
    return proxy;
}

// The hull touches the cones: with voxels of 3.2 pixels, and with silhouettes that are known to a
// pixel, its vertices lie within that of the ball's or outside of it, and few far outside.
static void the_hull_lies_on_the_cones(void **state)
{
    (void)state;
    static const char *const fine[] = {"hull_side=24"};
    struct fixture f;
    struct proxy proxy;
    struct photos photos;
    setup_ball(&f);
    struct orl_render_params params = params_of(fine, 1);
    hull_of(&f, &params, &proxy, &photos);
    const double pixel = 4.0 / 60;
    double worst = 0;
    for (size_t i = 0; i < proxy.vertex_count; i++) {
        double cone = -INFINITY; // distance to the nearest cone, pixels, positive outside
        for (size_t k = 0; k < f.scene.photo_count; k++) {
            double q[3], at[3];
            for (int c = 0; c < 3; c++)
                at[c] = (double)proxy.vertices[i][c];
            orl_pose_apply(&f.photos[k].view.cam_from_world, at, q);
            cone = fmax(cone, hypot(60 * q[0] / q[2], 60 * q[1] / q[2]) -
                                  60 * tan(asin(0.5 / 4)));
        }
        worst = fmax(worst, fabs(cone));
        assert_true(hypot(hypot((double)proxy.vertices[i][0], (double)proxy.vertices[i][1]),
                          (double)proxy.vertices[i][2]) > 0.5 - 1.5 * pixel);
    }
    assert_true(proxy.vertex_count > 500 && worst < 1.6);
    orl_proxy_finish(gpu, &proxy);
    orl_photos_finish(gpu, &photos);
    teardown(&f);
}

// "A tunable parameter for controlling the precision": the paper's hulls have 400 to 500 triangles.
static void precision_can_be_tuned(void **state)
{
    (void)state;
    static const char *const sets[] = {"hull_triangles=0", "hull_triangles=500"};
    struct fixture f;
    size_t triangles[2];
    double volumes[2];
    setup_ball(&f);
    for (int i = 0; i < 2; i++) {
        struct orl_render_params params = params_of(&sets[i], 1);
        struct proxy proxy;
        struct photos photos;
        hull_of(&f, &params, &proxy, &photos);
        const struct mesh_state *mesh = proxy.state;
        triangles[i] = mesh->mesh.triangle_count;
        volumes[i] = orl_mesh_volume(&mesh->mesh);
        orl_proxy_finish(gpu, &proxy);
        orl_photos_finish(gpu, &photos);
    }
    assert_true(triangles[0] > 5000 && triangles[1] <= 550);
    assert_float_equal(volumes[1] / volumes[0], 1, 0.05);
    assert_true(volumes[0] > 4.18879 * 0.125 * 0.9);
    teardown(&f);
}

// 5.2.3: the range of depths is that of the bounding box.
static void near_and_far_are_tight(void **state)
{
    (void)state;
    struct mesh_state mesh = {.low = {-1, -1, -0.5f}, .high = {1, 1, 0.5f}};
    struct orl_view view = look_from(0, 0, -4, SIDE, 60);
    float near, far;
    orl_mesh_range(&mesh, &view, &near, &far);
    assert_float_equal(near, 3.5, 0.01);
    assert_float_equal(far, 4.5, 0.01);
    view = look_from(0, 0, 0, SIDE, 60); // within the box
    orl_mesh_range(&mesh, &view, &near, &far);
    assert_true(near > 0 && near < 0.001 && far > 0.5);
}

// --- section 5.1.2: blending ---

// Three photographs see the middle: a third of each. By the recurrence, with A = 1, 0.56 and 0.34:
// the first 0.44 * 0.66, the second 0.56 * 0.66, the third 0.34.
static void photographs_count_alike(void **state)
{
    (void)state;
    static const char *const sets[] = {"combine=mean", "combine=recurrence"};
    static const double expected[2][3] = {{1 / 3.0, 1 / 3.0, 1 / 3.0}, {0.290, 0.370, 0.34}};
    struct fixture f;
    setup_ball(&f); // before photograph 0, the first, the second and the last see the middle
    for (int i = 0; i < 2; i++) {
        struct orl_render_params params = params_of(&sets[i], 1);
        struct orl_frame frame = draw(gpu, &f, look_around(0, 4, SIDE, 60), &params, 0);
        const float *c = color_at(&frame, SIDE / 2, SIDE / 2);
        for (int k = 0; k < 3; k++)
            assert_float_equal(c[k], expected[i][k], 0.01);
        assert_float_equal(frame.coverage.f32[SIDE / 2 * SIDE + SIDE / 2], 1, 0);
        orl_frame_finish(&frame);
    }
    teardown(&f);
}

// --- section 5.2.2: shadow leak ---

enum { W = 160, H = 120, FINER = 8 };

// Depth of the figure's mesh in a camera that is `factor` times as fine.
static float *depth_of(struct proxy *proxy, struct orl_view view, int factor,
                       const struct orl_render_params *params)
{
    struct surface surface;
    view.camera = orl_camera_resized(&view.camera, factor * view.camera.width,
                                     factor * view.camera.height);
    size_t bytes = (size_t)view.camera.width * (size_t)view.camera.height * sizeof(float);
    float *depth = malloc(bytes);
    assert_int_equal(orl_proxy_draw(gpu, proxy, &view, params, false, &proxy->view_target,
                                    &surface), ORL_OK);
    orl_tex_read(surface.depth, 0, GL_RED, GL_FLOAT, bytes, depth);
    return depth;
}

// Pixels of the view that photograph 0 paints although another part of the figure is in between.
static int count_leaks(struct fixture *f, const struct orl_view *view, const char *fat,
                       int *painted)
{
    const char *const choices[] = {"proxy=mesh", "fill=none", fat};
    struct orl_render_params params = params_of(choices, 3);
    struct proxy proxy;
    assert_int_equal(orl_proxy_create(gpu, &f->scene, &orl_proxy_mesh, 0, &proxy), ORL_OK);
    const struct orl_view *photo = &f->photos[0].view;
    float *here = depth_of(&proxy, *view, 1, &params), *there = depth_of(&proxy, *photo, FINER,
                                                                         &params);
    struct orl_frame frame = draw(gpu, f, *view, &params, 0);
    int leaks = 0;
    *painted = 0;
    for (int i = 0; i < W * H; i++) {
        double world[3], q[3];
        if (!(here[i] > 0) || !(frame.coverage.f32[i] > 0))
            continue;
        orl_view_unproject(view, i % W + 0.5, i / W + 0.5, (double)here[i], world);
        orl_pose_apply(&photo->cam_from_world, world, q);
        int x = (int)(FINER * (photo->camera.fx * q[0] / q[2] + photo->camera.cx));
        int y = (int)(FINER * (photo->camera.fy * q[1] / q[2] + photo->camera.cy));
        if (x < 0 || y < 0 || x >= FINER * W || y >= FINER * H)
            continue;
        float nearest = there[y * FINER * W + x];
        ++*painted;
        leaks += nearest > 0 && (double)nearest < q[2] - 0.1;
    }
    free(here);
    free(there);
    orl_frame_finish(&frame);
    orl_proxy_finish(gpu, &proxy);
    return leaks;
}

// Figure 5: rendered from a single photograph, outlines leak onto what is behind, and with fattened
// outlines in the shadow map they do not.
static void fat_outlines_stop_leaks(void **state)
{
    (void)state;
    const struct orl_figures_params places = {8, 1, W, H};
    struct orl_view views[8];
    struct orl_figure figure;
    struct orl_mesh mesh;
    struct fixture f;
    int leaks[2] = {0}, painted[2] = {0};
    setup_empty(&f, 4);
    orl_figures_views(&places, views);
    orl_figure_pose(0, &figure);
    add_photo(&f, views[0], green);
    assert_int_equal(orl_figure_mesh(NULL, &figure, 0.02, &mesh), ORL_OK);
    char *path = orl_path_join(NULL, f.dir, "mesh.ply");
    assert_int_equal(orl_mesh_write(NULL, path, &mesh), ORL_OK);
    for (int i = 1; i < 8; i++) {
        int of_view;
        leaks[0] += count_leaks(&f, &views[i], "fatten_px=0", &of_view);
        painted[0] += of_view;
        leaks[1] += count_leaks(&f, &views[i], "fatten_px=2", &of_view);
        painted[1] += of_view;
    }
    print_message("leaked pixels: %d of %d, with fat outlines %d of %d\n", leaks[0], painted[0],
                  leaks[1], painted[1]);
    assert_true(leaks[0] > 20 && 10 * leaks[1] <= leaks[0]);
    assert_true(painted[1] > 0.8 * painted[0]); // the rest of the surface keeps its colours
    free(path);
    orl_mesh_finish(&mesh);
    teardown(&f);
}

// --- section 5.1: the room ---

// A white ball in a room, photographed from two sides, and with `count` 3 from the other one, from
// nearby; the pictures of the empty room are red, green and blue.
static void setup_room(struct fixture *f, int count)
{
    static const uint8_t *const colors[] = {red, green, blue};
    static const double turns[] = {0.3, -0.3, 3.14159265}, distances[] = {4, 4, 2};
    setup_empty(f, 4);
    f->scene.room = (struct orl_room){{-6, -3, -6}, {6, 3, 6}, true};
    double middle = 0.5 * SIDE;
    char *folder = orl_path_join(NULL, f->dir, "background");
    assert_int_equal(orl_dir_make(NULL, folder), ORL_OK);
    for (int i = 0; i < count; i++) {
        struct orl_image background;
        add_disc_photo(f, look_around(turns[i], distances[i], SIDE, 60),
                       (uint8_t[3]){255, 255, 255}, middle, middle,
                       60 * tan(asin(0.5 / distances[i])));
        assert_int_equal(orl_image_init(NULL, &background, SIDE, SIDE, 3, ORL_PIXEL_U8), ORL_OK);
        for (int p = 0; p < SIDE * SIDE; p++)
            memcpy(&background.u8[3 * p], colors[i], 3);
        char *path = orl_scene_background_path(NULL, &f->scene, (size_t)i);
        assert_int_equal(orl_png_write(NULL, path, &background), ORL_OK);
        orl_image_finish(&background);
        free(path);
    }
    free(folder);
}

// The walls show the pictures without the subject: where two see a wall the mean, else the one, and
// a camera projects nothing behind itself.
static void the_room_has_its_pictures(void **state)
{
    (void)state;
    struct fixture f;
    setup_room(&f, 3);
    struct orl_render_params params = params_of(NULL, 0);
    struct orl_view view = look_around(0, 4, SIDE, 30); // wider than the photographs
    struct orl_frame frame = draw(gpu, &f, view, &params, 0);
    const float *both = color_at(&frame, SIDE / 2, SIDE / 2 - 9), *ball = color_at(&frame, 32, 32);
    assert_float_equal(both[0], 0.5, 0.01);
    assert_float_equal(both[1], 0.5, 0.01);
    assert_float_equal(both[2], 0, 0.01); // the third looks the other way
    // 4 behind the third camera, where its picture would show it mirrored.
    assert_float_equal(color_at(&frame, SIDE / 2, SIDE / 2 - 5)[2], 0, 0.01);
    assert_float_equal(ball[0] + ball[1] + ball[2], 3, 0.03);
    // The wall at z = 6 from x = -6 to 6: the first camera sees its left.
    double x = -5, left = 30 * x / 10 + 32;
    const float *one = color_at(&frame, (int)left, SIDE / 2), *other = color_at(&frame, 63 - (int)left, SIDE / 2);
    assert_float_equal(one[0] + one[1], 1, 0.01);
    assert_true(fabsf(one[0] - other[1]) < 0.01 && fabsf(one[0] - one[1]) > 0.98f);
    assert_float_equal(frame.coverage.f32[SIDE / 2 * SIDE + (int)left], 0, 0);
    orl_frame_finish(&frame);
    teardown(&f);
}

// Seen from aside, where no photograph shows all of the ball nor all of the walls: neither takes
// colours of the other.
static void unseen_places_take_colors_of_their_own(void **state)
{
    (void)state;
    struct fixture f;
    setup_room(&f, 2);
    struct orl_render_params params = params_of(NULL, 0);
    struct orl_view view = look_around(2.2, 4, SIDE, 60);
    struct orl_frame frame = draw(gpu, &f, view, &params, 0);
    int ball = 0, unseen = 0, walls = 0;
    for (int i = 0; i < SIDE * SIDE; i++) {
        const float *c = &frame.color.f32[3 * i];
        bool on_ball = frame.depth.f32[i] > 0;
        ball += on_ball;
        walls += !on_ball;
        unseen += on_ball && frame.coverage.f32[i] == 0;
        assert_float_equal(c[2], on_ball ? 1 : 0, 0.03); // the walls are red and green
        assert_float_equal(c[0] + c[1], on_ball ? 2 : 1, 0.06);
    }
    print_message("%d pixels of the ball, %d of them unseen; %d of walls\n", ball, unseen, walls);
    assert_true(unseen > ball / 10 && unseen < ball && walls > SIDE * SIDE / 2);
    orl_frame_finish(&frame);
    teardown(&f);
}

// Without pictures of the empty place the photographs are projected, but not their subject.
static void the_subject_is_not_on_the_walls(void **state)
{
    (void)state;
    struct fixture f;
    setup_figure(&f, 6, 96, 72);
    f.scene.room = orl_figures_room;
    struct orl_figure figure;
    struct orl_render_params params = params_of(NULL, 0);
    struct orl_view view = f.photos[0].view;
    view.cam_from_world.t[2] += 0.3;
    struct orl_figures_picture empty, with;
    orl_figure_pose(0, &figure);
    assert_int_equal(orl_figures_draw(NULL, NULL, &view, &empty), ORL_OK);
    assert_int_equal(orl_figures_draw(NULL, &figure, &view, &with), ORL_OK);
    struct orl_frame frame = draw(gpu, &f, view, &params, 0);
    struct orl_image srgb;
    assert_int_equal(orl_tone_srgb(NULL, &frame.color, &srgb), ORL_OK);
    double squares = 0;
    int count = 0;
    for (int i = 0; i < 96 * 72; i++) {
        if (frame.depth.f32[i] > 0 || with.mask.u8[i])
            continue;
        // Shadows of the figure are in the photographs; its clothes are red and blue.
        for (int c = 0; c < 3; c++)
            squares += pow((double)srgb.u8[3 * i + c] - with.photo.u8[3 * i + c], 2);
        count += 3;
    }
    assert_true(count > 3 * 96 * 60);
    assert_true(10 * log10(255 * 255 * count / squares) > 26);
    orl_image_finish(&srgb);
    orl_frame_finish(&frame);
    orl_figures_picture_finish(&empty);
    orl_figures_picture_finish(&with);
    teardown(&f);
}

// Photographs that are on the device one at a time give the same bits.
static void turns_change_nothing(void **state)
{
    (void)state;
    static const char *const sets[] = {"combine=mean", "combine=recurrence"};
    struct fixture f;
    setup_figure(&f, 4, 96, 72);
    for (int i = 0; i < 2; i++) {
        struct orl_render_params params = params_of(&sets[i], 1);
        const struct orl_renderer_params whole = {.photo_divide = 4, .textures = ORL_TEXTURES_FULL};
        struct orl_renderer_params tight = whole;
        tight.max_vram_bytes = 1;
        struct orl_frame a = draw_by(gpu, &f, f.photos[0].view, &params, &whole);
        struct orl_frame b = draw_by(gpu, &f, f.photos[0].view, &params, &tight);
        assert_memory_equal(a.color.data, b.color.data, orl_image_bytes(&a.color));
        orl_frame_finish(&a);
        orl_frame_finish(&b);
    }
    teardown(&f);
}

// --- section 5.3: packing ---

// A square of `size` pixels around the middle of what a camera of add_flat_photos shows, as a proxy.
static void show_square(struct proxy *proxy, float (*corners)[3], double size)
{
    for (int i = 0; i < 4; i++)
        for (int k = 0; k < 2; k++)
            corners[i][k] = (float)((i >> k & 1 ? 0.5 : -0.5) * size * 4 / 60);
    *proxy = (struct proxy){.kind = &orl_proxy_hull, .vertices = (const float(*)[3])corners,
                            .vertex_count = 4, .version = (uint64_t)size};
}

// From 4 away: the middle, the square beside the picture, and its left half.
static void add_flat_photos(struct fixture *f)
{
    static const uint8_t *const colors[] = {red, green, blue};
    static const double aside[] = {0, 6, 0.5 * SIDE * 4 / 60};
    setup_empty(f, 4);
    for (int i = 0; i < 3; i++)
        add_photo(f, look_from(aside[i], 0, -4, SIDE, 60), colors[i]);
}

// 9 pixels around the middle lie within 27 to 37, with 6 more in 21 to 43, and aligned to 4 in 20 to 44.
// Of the half, 6 pixels around lie outside of the picture: its border is repeated.
static void regions_lie_side_by_side(void **state)
{
    (void)state;
    struct fixture f;
    struct photos photos;
    struct proxy proxy;
    float corners[4][3] = {{0}};
    const struct orl_renderer_params none = {0};
    static const char *const no_room[] = {"fill=none"};
    struct orl_render_params params = params_of(no_room, 1);
    add_flat_photos(&f);
    show_square(&proxy, corners, 9);
    assert_int_equal(orl_photos_init(gpu, &f.scene, &none, 0, &photos), ORL_OK);
    struct frame frame = {.gpu = gpu, .scene = &f.scene, .params = &params, .proxy = &proxy,
                          .photos = &photos};
    assert_int_equal(orl_packing_update(&frame), ORL_OK);
    const struct packing *packing = photos.packing;
    static const struct packed_region expected[] = {
        {20, 20, 24, 24, 0}, {0, 0, 0, 0, 24}, {-8, 20, 20, 24, 24}};
    assert_true(frame.packs);
    assert_memory_equal(packing->regions, expected, sizeof expected);
    assert_int_equal(packing->color->params.width, 24 + 20 + 20);
    assert_int_equal(packing->color->params.height, 24 + 20);
    assert_int_equal(photos.uploaded, 3 * (24 + 20) * 24);
    uint8_t texels[44][64][4];
    orl_tex_read(packing->color, 0, GL_RGBA, GL_UNSIGNED_BYTE, sizeof texels, texels);
    for (int x = 0; x < 44; x++)
        assert_memory_equal(texels[12][x], x < 24 ? red : blue, 3);
    // Regions that are some pixels larger or smaller have room in the same texture.
    static const struct {
        double size;
        int side; // of the first region
        bool same;
    } sizes[] = {{17, 32, true}, {3, 16, true}, {33, 48, false}};
    for (size_t i = 0; i < ORL_COUNT(sizes); i++) {
        int width = packing->color->params.width;
        show_square(&proxy, corners, sizes[i].size);
        assert_int_equal(orl_packing_update(&frame), ORL_OK);
        assert_int_equal(packing->regions[0].width, sizes[i].side);
        assert_true((packing->color->params.width == width) == sizes[i].same);
    }
    corners[0][2] = -5; // behind the cameras: nothing is known of where the square is
    proxy.version++;
    assert_int_equal(orl_packing_update(&frame), ORL_OK);
    assert_true(packing->regions[0].x <= 0 && packing->regions[0].width >= SIDE);
    orl_photos_finish(gpu, &photos);
    teardown(&f);
}

// The picture is the one of whole photographs; what goes to the device is several times less.
static void packed_pictures_are_the_same(void **state)
{
    (void)state;
    static const char *const sets[][2] = {{"fill=none", "packing=on"}, {"fill=none", "packing=off"}};
    struct fixture f;
    struct orl_frame frames[2];
    size_t uploaded[2];
    setup_figure(&f, 6, 160, 120);
    struct orl_view view = f.photos[0].view;
    view.cam_from_world.t[2] += 0.3;
    for (int i = 0; i < 2; i++) {
        struct orl_render_params params = params_of(sets[i], 2);
        struct orl_renderer *renderer;
        assert_int_equal(orl_renderer_create(gpu, &f.scene, NULL, &renderer), ORL_OK);
        assert_int_equal(orl_renderer_draw(renderer, &view, &params, NULL, &frames[i]), ORL_OK);
        uploaded[i] = orl_renderer_uploaded(renderer);
        orl_renderer_destroy(&renderer);
    }
    float worst = 0;
    for (size_t i = 0; i < (size_t)3 * 160 * 120; i++)
        worst = fmaxf(worst, fabsf(frames[0].color.f32[i] - frames[1].color.f32[i]));
    print_message("largest difference %g, uploaded %zu and %zu bytes\n", (double)worst,
                  uploaded[0], uploaded[1]);
    assert_true(worst < 0.02f); // of linear light; texture coordinates are rounded differently
    assert_int_equal(uploaded[1], 6 * 3 * 160 * 120);
    assert_true(2 * uploaded[0] < uploaded[1]);
    orl_frame_finish(&frames[0]);
    orl_frame_finish(&frames[1]);
    teardown(&f);
}

// Where there are no silhouettes: the mesh if there is one, else the splats.
static void another_proxy_stands_in(void **state)
{
    (void)state;
    struct fixture f;
    struct orl_render_params params;
    const struct orl_method *li = orl_method_find(NULL, "li");
    setup(&f, false);
    add_photo(&f, look_from(0, 0, 0, SIDE, 40), green);
    orl_render_params_tuned(NULL, li, &f.scene, &params);
    assert_string_equal(orl_slot_name(params.proxy), "splats");
    struct orl_frame frame = draw(gpu, &f, look_from(0, 0, 0, SIDE, 40), &params, 0);
    assert_float_equal(color_at(&frame, SIDE / 2, SIDE / 2)[1], 1, 0.01);
    orl_frame_finish(&frame);
    f.photos[0].masked = true;
    orl_render_params_tuned(NULL, li, &f.scene, &params);
    assert_string_equal(orl_slot_name(params.proxy), "hull");
    f.photos[0].test = true; // a photograph that is held out carves nothing
    orl_render_params_tuned(NULL, li, &f.scene, &params);
    assert_string_equal(orl_slot_name(params.proxy), "splats");
    orl_points_finish(&f.scene.points);
    orl_render_params_tuned(NULL, li, &f.scene, &params);
    assert_string_equal(orl_slot_name(params.proxy), "mesh");
    teardown(&f);
}

// A photograph that sees the wall at less than 6 degrees does not colour it: here at 4.6 and at 11.
// What lies between is not in question.
static void tangent_surfaces_are_not_coloured(void **state)
{
    (void)state;
    static const char *const opaque[] = {"visibility=opaque", "fill=none", "depth_tolerance=0.2"};
    for (int i = 0; i < 2; i++) {
        struct fixture f;
        setup(&f, false);
        struct orl_view along = look_from(0, 0, 0, SIDE, 40);
        along.cam_from_world = (struct orl_pose){.r = {{0, 0, -1}, {0, 1, 0}, {1, 0, 0}},
                                                 .t = {i ? 3.4 : 3.76, 0, 3}};
        add_photo(&f, along, green);
        struct orl_render_params params = orl_method_find(NULL, "airieau")->params;
        assert_int_equal(orl_render_params_assign(NULL, &params, opaque, 3), ORL_OK);
        struct orl_frame frame = draw(gpu, &f, look_from(0, 0, 0, SIDE + 1, 40), &params, 0);
        assert_float_equal(frame.coverage.f32[SIDE / 2 * (SIDE + 1) + SIDE / 2], i, 0);
        orl_frame_finish(&frame);
        teardown(&f);
    }
}

int main(void)
{
    gpu = gpu_test_device();
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(the_hull_lies_on_the_cones),
        cmocka_unit_test(precision_can_be_tuned),
        cmocka_unit_test(near_and_far_are_tight),
        cmocka_unit_test(photographs_count_alike),
        cmocka_unit_test(tangent_surfaces_are_not_coloured),
        cmocka_unit_test(fat_outlines_stop_leaks),
        cmocka_unit_test(the_room_has_its_pictures),
        cmocka_unit_test(unseen_places_take_colors_of_their_own),
        cmocka_unit_test(the_subject_is_not_on_the_walls),
        cmocka_unit_test(turns_change_nothing),
        cmocka_unit_test(regions_lie_side_by_side),
        cmocka_unit_test(packed_pictures_are_the_same),
        cmocka_unit_test(another_proxy_stands_in),
    };
    int failed = cmocka_run_group_tests_name("li", tests, NULL, NULL);
    orl_gpu_destroy(&gpu);
    return failed;
}
