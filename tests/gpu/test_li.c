// Li 2003: the hull as a mesh, blending by 1/N, shadow maps without leaks, and
// the room, against answers found by hand and on a figure whose shape is exact.
#include <math.h>

#include "figure_scene.h"
#include "mesh_help.h"
#include "render/proxy/mesh_proxy.h"
#include "render/frame/method.h"
#include "render/hull/voxels.h"
#include "render/photos/photos.h"

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

// Three photographs see the middle: a third of each.
static void photographs_count_alike(void **state)
{
    (void)state;
    struct fixture f;
    setup_ball(&f); // before photograph 0, the first, the second and the last see the middle
    struct orl_render_params params = params_of(NULL, 0);
    struct orl_frame frame = draw(gpu, &f, look_around(0, 4, SIDE, 60), &params, 0);
    const float *c = color_at(&frame, SIDE / 2, SIDE / 2);
    for (int k = 0; k < 3; k++)
        assert_float_equal(c[k], 1 / 3.0, 0.01);
    assert_float_equal(frame.coverage.f32[SIDE / 2 * SIDE + SIDE / 2], 1, 0);
    orl_frame_finish(&frame);
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
        leaks[0] += count_leaks(&f, &views[i], "visibility=shadow", &of_view);
        painted[0] += of_view;
        leaks[1] += count_leaks(&f, &views[i], "visibility=opaque", &of_view);
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

// A strip before the photograph, 0.08 of its pixels wide between two of them, has no depth there, and
// what is not there hides nothing.
static void what_has_no_depth_is_lit(void **state)
{
    (void)state;
    static const char *const choices[] = {"proxy=mesh", "fill=none"};
    static const float strip[4][3] = {{-0.02f, -2, 4}, {0.02f, -2, 4}, {0.02f, 2, 4}, {-0.02f, 2, 4}};
    static const uint32_t faces[2][3] = {{0, 1, 2}, {0, 2, 3}};
    struct fixture f;
    struct orl_mesh mesh;
    setup_empty(&f, 4);
    mesh = mesh_of(4, 2);
    memcpy(mesh.position, strip, sizeof strip);
    memcpy(mesh.triangle, faces, sizeof faces);
    char *path = orl_path_join(NULL, f.dir, "mesh.ply");
    assert_int_equal(orl_mesh_write(NULL, path, &mesh), ORL_OK);
    add_photo(&f, look_from(0, 0, 0, 8, 8), green);
    struct orl_render_params params = params_of(choices, 2);
    struct orl_frame frame = draw(gpu, &f, look_from(0, 0, 0, SIDE, 400), &params, 0);
    assert_float_equal(color_at(&frame, SIDE / 2, SIDE / 2)[1], 1, 1e-3);
    orl_frame_finish(&frame);
    orl_mesh_finish(&mesh);
    free(path);
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
        char *path = strdup(orl_scene_file(&f->scene, (size_t)i, ORL_FILE_BACKGROUND).text);
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

// Where the room's box is not known, its pictures are on a sphere around the scene.
static void a_sphere_stands_in_for_the_room(void **state)
{
    (void)state;
    struct fixture f;
    setup_room(&f, 2);
    f.scene.room.known = false;
    struct orl_render_params params = params_of(NULL, 0);
    struct orl_frame frame = draw(gpu, &f, f.photos[0].view, &params, 0);
    const float *wall = color_at(&frame, 8, 8);
    assert_float_equal(wall[0] + wall[1], 1, 0.01);
    assert_true(wall[0] > 0.4f);
    orl_frame_finish(&frame);
    teardown(&f);
}

// What completes the walls paints nothing that a photograph shows: its edge between columns 20 and 21,
// which are one pixel of the next level, stays sharp.
static void edges_on_walls_stay_sharp(void **state)
{
    (void)state;
    struct fixture f;
    struct orl_image background;
    setup_room(&f, 2);
    assert_int_equal(orl_image_init(NULL, &background, SIDE, SIDE, 3, ORL_PIXEL_U8), ORL_OK);
    for (int i = 0; i < SIDE * SIDE; i++)
        background.u8[3 * i] = i % SIDE < 21 ? 255 : 0;
    char *path = strdup(orl_scene_file(&f.scene, 0, ORL_FILE_BACKGROUND).text);
    assert_int_equal(orl_png_write(NULL, path, &background), ORL_OK);
    struct orl_render_params params = params_of(NULL, 0);
    struct orl_frame frame = draw(gpu, &f, f.photos[0].view, &params, 0);
    assert_true(color_at(&frame, 18, 8)[0] > 0.4f);
    assert_float_equal(color_at(&frame, 20, 8)[0], color_at(&frame, 18, 8)[0], 0.01);
    assert_float_equal(color_at(&frame, 21, 8)[0], 0, 0.01);
    orl_frame_finish(&frame);
    orl_image_finish(&background);
    free(path);
    teardown(&f);
}

// Seen from aside, where no photograph shows all of the ball nor all of the walls: neither takes
// colours of the other.
static void check_unseen_places(const char *method)
{
    struct fixture f;
    setup_room(&f, 2);
    struct orl_render_params params = orl_method_find(NULL, method)->params;
    params.proxy = &orl_proxy_hull;
    params.fill = ORL_FILL_ROOM;
    params.antialias = ORL_ANTIALIAS_OFF;
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

static void unseen_places_take_colors_of_their_own(void **state)
{
    (void)state;
    check_unseen_places("li");
    check_unseen_places("oriel");
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
    struct fixture f;
    setup_figure(&f, 4, 96, 72);
    struct orl_render_params params = params_of(NULL, 0);
    const struct orl_renderer_params whole = {.photo_divide = 4, .textures = ORL_TEXTURES_FULL};
    struct orl_renderer_params tight = whole;
    tight.max_vram_bytes = 1;
    struct orl_frame a = draw_by(gpu, &f, f.photos[0].view, &params, &whole);
    struct orl_frame b = draw_by(gpu, &f, f.photos[0].view, &params, &tight);
    assert_memory_equal(a.color.data, b.color.data, orl_image_bytes(&a.color));
    orl_frame_finish(&a);
    orl_frame_finish(&b);
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
    assert_string_equal(params.proxy->name, "splats");
    struct orl_frame frame = draw(gpu, &f, look_from(0, 0, 0, SIDE, 40), &params, 0);
    assert_float_equal(color_at(&frame, SIDE / 2, SIDE / 2)[1], 1, 0.01);
    orl_frame_finish(&frame);
    f.photos[0].masked = true;
    orl_render_params_tuned(NULL, li, &f.scene, &params);
    assert_string_equal(params.proxy->name, "hull");
    f.photos[0].test = true; // a photograph that is held out carves nothing
    orl_render_params_tuned(NULL, li, &f.scene, &params);
    assert_string_equal(params.proxy->name, "splats");
    orl_points_finish(&f.scene.points);
    orl_render_params_tuned(NULL, li, &f.scene, &params);
    assert_string_equal(params.proxy->name, "mesh");
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
        cmocka_unit_test(near_and_far_are_tight),
        cmocka_unit_test(photographs_count_alike),
        cmocka_unit_test(tangent_surfaces_are_not_coloured),
        cmocka_unit_test(fat_outlines_stop_leaks),
        cmocka_unit_test(what_has_no_depth_is_lit),
        cmocka_unit_test(the_room_has_its_pictures),
        cmocka_unit_test(a_sphere_stands_in_for_the_room),
        cmocka_unit_test(edges_on_walls_stay_sharp),
        cmocka_unit_test(unseen_places_take_colors_of_their_own),
        cmocka_unit_test(the_subject_is_not_on_the_walls),
        cmocka_unit_test(turns_change_nothing),
        cmocka_unit_test(another_proxy_stands_in),
    };
    int failed = cmocka_run_group_tests_name("li", tests, NULL, NULL);
    orl_gpu_destroy(&gpu);
    return failed;
}
