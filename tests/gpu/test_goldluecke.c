// Goldluecke 2003: the voxel hull, which photographs see a voxel, and billboards, against answers
// found by hand and on a figure whose silhouettes are exact.
#include <math.h>

#include "core/color.h"
#include "figure_scene.h"
#include "render/papers/billboards.h"
#include "render/hull/voxels.h"

enum { SIDE = 64, FIGURE_W = 96, FIGURE_H = 72, CAMERAS = 8 };

static struct orl_gpu *gpu;

static struct orl_render_params params_of(const char *const *choices, size_t count)
{
    struct orl_render_params params = orl_method_find(NULL, "goldluecke")->params;
    assert_int_equal(orl_render_params_assign(NULL, &params, choices, count), ORL_OK);
    return params;
}

// --- the hull ---

enum { RING = 6 };

// Balls of radius 0.5 as RING cameras around see them, 4 away: a disc of tan(asin(r / d)) f pixels.
struct ball_scene {
    struct orl_silhouette all[RING];
};

static void add_ball(struct orl_silhouette *s, const double centre[3], double radius)
{
    double p[3];
    const struct orl_camera *c = &s->view.camera;
    orl_pose_apply(&s->view.cam_from_world, centre, p);
    for (int i = 0; i < c->width * c->height; i++) {
        double ray[3] = {(i % c->width + 0.5 - c->cx) / c->fx, (i / c->width + 0.5 - c->cy) / c->fy,
                         1};
        double rr = ray[0] * ray[0] + ray[1] * ray[1] + 1;
        double rp = ray[0] * p[0] + ray[1] * p[1] + p[2];
        double pp = p[0] * p[0] + p[1] * p[1] + p[2] * p[2];
        if (pp - rp * rp / rr < radius * radius)
            s->mask.u8[i] = 255;
    }
}

static void setup_balls(struct ball_scene *scene, const double (*centres)[3], int count)
{
    for (int i = 0; i < RING; i++) {
        struct orl_silhouette *s = &scene->all[i];
        s->view = look_around(3.14159265 * i / RING, 4, SIDE, 60);
        assert_int_equal(orl_image_init(NULL, &s->mask, SIDE, SIDE, 1, ORL_PIXEL_U8), ORL_OK);
        for (int b = 0; b < count; b++)
            add_ball(s, centres[b], 0.5);
    }
}

static void finish_balls(struct ball_scene *scene)
{
    for (int i = 0; i < RING; i++)
        orl_image_finish(&scene->all[i].mask);
}

static float field_at(const struct voxels *v, double x, double y, double z)
{
    const double at[3] = {x, y, z};
    size_t index = 0, stride = 1;
    for (int k = 0; k < 3; k++) {
        double i = floor((at[k] - v->cube.origin[k]) / v->cube.voxel);
        if (i < 0 || i >= v->cube.side)
            return INFINITY;
        index += stride * (size_t)i;
        stride *= (size_t)v->cube.side;
    }
    return v->field[index];
}

// Of `side` voxels each way.
static void carve(const struct ball_scene *scene, int side, struct cones *cones, struct voxels *voxels)
{
    assert_int_equal(orl_cones_make(NULL, scene->all, RING, side, cones), ORL_OK);
    struct orl_buf *field;
    assert_int_equal(orl_cones_carve(gpu, cones, &field), ORL_OK);
    assert_int_equal(orl_voxels_read(NULL, cones, field, voxels), ORL_OK);
    assert_int_equal(orl_voxels_list(NULL, voxels), ORL_OK);
    orl_buf_destroy(gpu, &field);
}

// Equal to what the processor finds, but for the steps in which a texture is sampled between pixels.
static void the_hull_is_the_and_of_partial_hulls(void **state)
{
    (void)state;
    static const double centre[1][3] = {{0.1, -0.05, 0}};
    struct ball_scene scene;
    struct voxels voxels, turned;
    struct cones cones, others;
    float *field;
    setup_balls(&scene, centre, 1);
    carve(&scene, 32, &cones, &voxels);
    assert_int_equal(orl_cones_field(NULL, &cones, &field), ORL_OK);
    int inside = 0;
    for (int i = 0; i < 32 * 32 * 32; i++) {
        inside += voxels.field[i] <= 0;
        assert_float_equal(voxels.field[i], field[i], 0.02 * 4 / 60); // hundredths of a pixel there
    }
    double volume = inside * pow(voxels.cube.voxel, 3), ball = 4.18879 * 0.125;
    assert_true(volume > 0.95 * ball && volume < 1.35 * ball);
    struct orl_silhouette last = scene.all[RING - 1];
    scene.all[RING - 1] = scene.all[0];
    scene.all[0] = last;
    carve(&scene, 32, &others, &turned);
    assert_memory_equal(voxels.field, turned.field, 32 * 32 * 32 * sizeof *voxels.field);
    orl_voxels_finish(&voxels);
    orl_voxels_finish(&turned);
    orl_cones_finish(&cones);
    orl_cones_finish(&others);
    free(field);
    finish_balls(&scene);
}

static void several_objects_have_room_between(void **state)
{
    (void)state;
    static const double centres[2][3] = {{-0.9, 0, 0.1}, {0.9, 0.1, -0.1}};
    struct ball_scene scene;
    struct voxels voxels;
    struct cones cones;
    setup_balls(&scene, centres, 2);
    carve(&scene, 48, &cones, &voxels);
    assert_true(field_at(&voxels, -0.9, 0, 0.1) < 0 && field_at(&voxels, 0.9, 0.1, -0.1) < 0);
    assert_true(field_at(&voxels, 0, 0.05, 0) > 0);
    for (size_t i = 0; i < voxels.count; i++) {
        double nearest = INFINITY;
        for (int b = 0; b < 2; b++)
            nearest = fmin(nearest, hypot(hypot((double)voxels.centre[i][0] - centres[b][0],
                                                (double)voxels.centre[i][1] - centres[b][1]),
                                          (double)voxels.centre[i][2] - centres[b][2]));
        assert_true(nearest < 0.9);
    }
    orl_voxels_finish(&voxels);
    orl_cones_finish(&cones);
    finish_balls(&scene);
}

// Without silhouettes: the voxels that hold points.
static void points_fill_voxels(void **state)
{
    (void)state;
    struct fixture f;
    struct voxels voxels;
    setup(&f, false);
    assert_int_equal(orl_voxels_fill(NULL, &f.scene.points, 16, &voxels), ORL_OK);
    assert_true(voxels.count >= 15 * 15 && voxels.count <= 16 * 16);
    assert_true(field_at(&voxels, 0, 0, 4) < 0 && field_at(&voxels, 0, 0, 3) > 0);
    orl_voxels_finish(&voxels);
    teardown(&f);
}

// --- two photographs for a voxel ---

static void the_nearest_two_weigh_by_their_arcs(void **state)
{
    (void)state;
    struct fixture f;
    setup_empty(&f, 4);
    const double turns[4] = {0.5, -0.1, 0.3, -2};
    const size_t photos[4] = {0, 1, 2, 3};
    for (int i = 0; i < 4; i++)
        add_photo(&f, look_around(turns[i], 4, 8, 8), red);
    struct orl_view view = look_around(0, 4, 8, 8);
    struct orl_ranked ranked[4];
    orl_rank_by_axis(&f.scene, &view, photos, 4, ranked);
    assert_int_equal(ranked[0].index, 1);
    assert_int_equal(ranked[3].index, 3);
    assert_float_equal(ranked[1].key, 0.3, 1e-12);
    struct billboard b;
    uint32_t seen[2] = {0xf, 0xf};
    assert_true(orl_billboard_choose(ranked, 4, seen, 1, &b));
    assert_int_equal(b.photos, 0 | 1 << 16);
    assert_float_equal(b.second, 1 - 0.3 / 0.4, 1e-6); // and the first 1 - 0.1 / 0.4
    seen[0] = 1 << 0 | 1 << 2; // 1 sees a part alone
    assert_true(orl_billboard_choose(ranked, 4, seen, 1, &b));
    assert_int_equal(b.photos, 1 | 2 << 16);
    assert_float_equal(b.second, 1 - 0.5 / 0.8, 1e-6);
    seen[0] = 1 << 3;
    assert_true(orl_billboard_choose(ranked, 4, seen, 1, &b));
    assert_int_equal(b.photos & 0xffff, 3);
    assert_float_equal(b.second, 0, 0);
    seen[0] = 0;
    assert_true(orl_billboard_choose(ranked, 4, seen, 1, &b) && (b.photos & 0xffff) == 0);
    seen[1] = 0;
    assert_false(orl_billboard_choose(ranked, 4, seen, 1, &b));
    view = look_around(-0.1, 4, 8, 8); // the axis of photograph 1
    orl_rank_by_axis(&f.scene, &view, photos, 4, ranked);
    seen[0] = 0xf;
    assert_true(orl_billboard_choose(ranked, 4, seen, 1, &b));
    assert_int_equal(b.photos & 0xffff, 0);
    assert_float_equal(b.second, 0, 1e-6);
    teardown(&f);
}

// A red and a green photograph of a ball: the middle of a view between them has both colours by
// the weights of section 3, over black, and nothing is painted outside the silhouettes.
static void colours_blend_by_the_weights(void **state)
{
    (void)state;
    struct fixture f;
    setup_empty(&f, 4);
    double radius = 60 * tan(asin(0.5 / 4)), middle = 0.5 * SIDE;
    add_disc_photo(&f, look_around(0.3, 4, SIDE, 60), green, middle, middle, radius);
    add_disc_photo(&f, look_around(-0.1, 4, SIDE, 60), red, middle, middle, radius);
    add_disc_photo(&f, look_around(1.6, 4, SIDE, 60), blue, middle, middle, radius);
    struct orl_render_params params = orl_method_find(NULL, "goldluecke")->params;
    struct orl_frame frame = draw(gpu, &f, look_around(0, 4, SIDE, 60), &params, 0);
    const float *c = color_at(&frame, SIDE / 2, SIDE / 2);
    assert_float_equal(c[0], 0.75, 0.01);
    assert_float_equal(c[1], 0.25, 0.01);
    assert_float_equal(c[2], 0, 0.01);
    assert_float_equal(color_at(&frame, 4, 4)[0], 0, 0);
    assert_float_equal(frame.coverage.f32[SIDE / 2 * SIDE + SIDE / 2], 1, 0);
    assert_float_equal(frame.coverage.f32[0], 0, 0);
    orl_frame_finish(&frame);
    teardown(&f);
}

// Section 3: a silhouette's outermost pixels are half the subject's, so that each billboard leaves half
// of what is behind it there: of black 1 / 2^n behind n of them. The disc's last pixel on its middle
// row, seen as its photograph sees it.
static void borders_of_silhouettes_are_half_there(void **state)
{
    (void)state;
    enum { RADIUS = 12 };
    static const char *const coarse[] = {"hull_side=8"};
    struct fixture f;
    setup_empty(&f, 4);
    add_disc_photo(&f, look_around(0, 4, SIDE, 60), green, 0.5 * SIDE, 0.5 * SIDE, RADIUS);
    add_disc_photo(&f, look_around(1.6, 4, SIDE, 60), blue, 0.5 * SIDE, 0.5 * SIDE, RADIUS);
    struct orl_render_params params = params_of(coarse, 1);
    struct orl_frame frame = draw(gpu, &f, look_around(0, 4, SIDE, 60), &params, 0);
    const float *within = color_at(&frame, SIDE / 2 + RADIUS - 2, SIDE / 2);
    double layers = -log2(1 - (double)within[3 + 1]);
    print_message("%.2f billboards\n", layers);
    assert_float_equal(within[1], 1, 1e-3);
    assert_true(layers > 0.9 && layers < 6.1);
    assert_float_equal(layers, round(layers), 0.05);
    assert_float_equal(within[6 + 1], 0, 1e-3);
    orl_frame_finish(&frame);
    teardown(&f);
}

// A ball stands behind another one for the red photograph, which is the nearest by its axis. Beside
// it, from where both are seen, the far one has the colours of the others alone.
static void hidden_voxels_are_painted_by_others(void **state)
{
    (void)state;
    static const double centres[2][3] = {{0, 0, -1.2}, {0, 0, 1.2}}, turns[3] = {0, 1.2, -1.2};
    struct fixture f;
    setup_empty(&f, 4);
    for (int i = 0; i < 3; i++) {
        struct orl_silhouette s = {.view = look_around(turns[i], 4, SIDE, 60)};
        add_photo(&f, s.view, i ? green : red);
        assert_int_equal(orl_image_init(NULL, &s.mask, SIDE, SIDE, 1, ORL_PIXEL_U8), ORL_OK);
        for (int b = 0; b < 2; b++)
            add_ball(&s, centres[b], 0.5);
        mask_photo(&f, &s.mask);
    }
    struct orl_render_params params = orl_method_find(NULL, "goldluecke")->params;
    struct orl_frame frame = draw(gpu, &f, look_around(0.5, 4, SIDE, 60), &params, 0);
    const float *near = color_at(&frame, 20, SIDE / 2), *far = color_at(&frame, 39, SIDE / 2);
    assert_true(near[0] > 0.3f);
    assert_true(far[1] > 0.9f);
    assert_float_equal(far[0], 0, 0.02);
    orl_frame_finish(&frame);
    teardown(&f);
}

// Pixels of a ball that have the colour of a photograph straight before it, which ends `beyond` pixels
// beyond the ball's middle.
static int count_red(double beyond)
{
    static const char *const coarse[] = {"hull_side=8"};
    static const double turns[3] = {0, 1.2, -1.2}, centre[3] = {0, 0, 0};
    struct fixture f;
    setup_empty(&f, 4);
    for (int i = 0; i < 3; i++) {
        struct orl_silhouette s = {.view = look_around(turns[i], 4, SIDE, 60)};
        s.view.camera.cx = i ? 0.5 * SIDE : SIDE - beyond;
        add_photo(&f, s.view, i ? green : red);
        assert_int_equal(orl_image_init(NULL, &s.mask, SIDE, SIDE, 1, ORL_PIXEL_U8), ORL_OK);
        add_ball(&s, centre, 0.5);
        mask_photo(&f, &s.mask);
    }
    struct orl_render_params params = params_of(coarse, 1);
    struct orl_frame frame = draw(gpu, &f, look_around(0, 4, SIDE, 60), &params, 0);
    int count = 0;
    for (int i = 0; i < SIDE * SIDE; i++)
        count += frame.color.f32[3 * i] > 0.9f;
    orl_frame_finish(&frame);
    teardown(&f);
    return count;
}

// Voxels across the photograph's border have the colour of one that shows them whole, those within it
// have its own.
static void voxels_seen_in_part_are_painted_by_others(void **state)
{
    (void)state;
    int across = count_red(0), within = count_red(3);
    print_message("%d pixels, and %d with the voxels' column whole\n", across, within);
    assert_true(across > 0 && 3 * across < within);
}

// --- radiance and memory ---

// Makes the last photograph grey: `ball` within `radius` pixels of its middle, else `wall`.
static void paint_ball(struct fixture *f, double radius, uint8_t ball, uint8_t wall)
{
    struct orl_image image;
    assert_int_equal(orl_image_init(NULL, &image, SIDE, SIDE, 3, ORL_PIXEL_U8), ORL_OK);
    for (int i = 0; i < 3 * SIDE * SIDE; i++)
        image.u8[i] = hypot(i / 3 % SIDE + 0.5 - SIDE / 2, i / 3 / SIDE + 0.5 - SIDE / 2) < radius
                          ? ball : wall;
    repaint_photo(f, &image);
}

// Of two photographs that count alike the one that clips gives way, on the ball and on the walls.
static void clipped_photographs_give_way(void **state)
{
    (void)state;
    static const char *const methods[] = {"goldluecke", "li"};
    static const double turns[] = {0.3, -0.3, 1.6};
    const struct orl_renderer_params radiance = {.radiance = true};
    struct fixture f;
    setup_empty(&f, 4);
    f.scene.room = (struct orl_room){{-6, -3, -6}, {6, 3, 6}, true};
    double radius = 60 * tan(asin(0.5 / 4)), middle = 0.5 * SIDE;
    for (int i = 0; i < 3; i++) {
        add_disc_photo(&f, look_around(turns[i], 4, SIDE, 60), red, middle, middle, radius);
        paint_ball(&f, radius, i == 1 ? 255 : 150, i == 1 ? 255 : 188);
    }
    for (int c = 0; c < 3; c++)
        f.photos[1].gain[c] = 0.25f; // exposed for four times as long
    double ball = (double)orl_srgb_decode(150 / 255.0f);
    double wall = (double)orl_srgb_decode(188 / 255.0f);
    for (int m = 0; m < 2; m++) {
        struct orl_render_params params = orl_method_find(NULL, methods[m])->params;
        params.sample = ORL_SAMPLE_RADIANCE;
        params.fill = ORL_FILL_ROOM;
        struct orl_frame frame =
            draw_by(gpu, &f, look_around(0, 4, SIDE, 60), &params, &radiance);
        for (int c = 0; c < 3; c++) {
            assert_float_equal(color_at(&frame, SIDE / 2, SIDE / 2)[c], ball, 0.01);
            assert_float_equal(color_at(&frame, SIDE / 2, SIDE / 2 - 16)[c], wall, 0.01);
        }
        assert_float_equal(frame.depth.f32[(SIDE / 2 - 16) * SIDE + SIDE / 2], 0, 0);
        orl_frame_finish(&frame);
    }
    teardown(&f);
}

static void add_background(const struct fixture *f)
{
    struct orl_image image;
    size_t last = f->scene.photo_count - 1;
    const struct orl_camera *c = &f->photos[last].view.camera;
    char *folder = orl_path_join(NULL, f->dir, "background");
    char *path = strdup(orl_scene_file(&f->scene, last, ORL_FILE_BACKGROUND).text);
    assert_int_equal(orl_dir_make(NULL, folder), ORL_OK);
    assert_int_equal(orl_image_init(NULL, &image, c->width, c->height, 3, ORL_PIXEL_U8), ORL_OK);
    assert_int_equal(orl_png_write(NULL, path, &image), ORL_OK);
    orl_image_finish(&image);
    free(folder);
    free(path);
}

// Masks and pictures of the empty place are part of the plan for the device's memory.
static void memory_stays_within_the_plan(void **state)
{
    (void)state;
    enum { COUNT = 60, BUDGET = 3100 << 10 };
    static const char *const methods[] = {"goldluecke", "li"};
    struct fixture f;
    struct orl_renderer *renderer;
    setup_empty(&f, 4);
    for (int i = 0; i < COUNT; i++) {
        add_disc_photo(&f, look_around(6.2832 * i / COUNT, 4, SIDE, 60), red, 0.5 * SIDE,
                       0.5 * SIDE, 8);
        add_background(&f);
    }
    const struct orl_renderer_params limited = {.max_vram_bytes = BUDGET,
                                                .textures = ORL_TEXTURES_FULL};
    assert_int_equal(orl_renderer_create(gpu, &f.scene, &limited, &renderer), ORL_OK);
    for (int m = 0; m < 2; m++) {
        struct orl_render_params params = orl_method_find(NULL, methods[m])->params;
        params.fill = ORL_FILL_ROOM;
        assert_int_equal(orl_renderer_draw(renderer, &f.photos[0].view, &params, NULL, NULL),
                         ORL_OK);
    }
    size_t bytes = orl_gpu_owner_bytes(gpu, ORL_OWNER_PHOTOGRAPHS);
    print_message("photographs take %zu KiB of %d\n", bytes >> 10, BUDGET >> 10);
    assert_true(bytes > BUDGET / 2 && bytes <= BUDGET);
    orl_renderer_destroy(&renderer);
    teardown(&f);
}

// --- the figure ---

// PSNR to photograph `index` of all pixels that lie `margin` pixels within its silhouette.
static double psnr_within(const struct fixture *f, const struct orl_frame *frame, size_t index,
                          int margin)
{
    struct orl_image srgb, photo, mask;
    char *path = strdup(orl_scene_file(&f->scene, index, ORL_FILE_PHOTO).text);
    char *mask_path = strdup(orl_scene_file(&f->scene, index, ORL_FILE_MASK).text);
    assert_int_equal(orl_tone_srgb(NULL, &frame->color, &srgb), ORL_OK);
    assert_int_equal(orl_picture_read(NULL, path, 3, &photo), ORL_OK);
    assert_int_equal(orl_picture_read(NULL, mask_path, 1, &mask), ORL_OK);
    double squares = 0, count = 0;
    for (int y = margin; y < mask.height - margin; y++)
        for (int x = margin; x < mask.width - margin; x++) {
            bool within = true;
            for (int dy = -margin; dy <= margin; dy++)
                for (int dx = -margin; dx <= margin; dx++)
                    within = within && mask.u8[(y + dy) * mask.width + x + dx];
            for (int c = 0; within && c < 3; c++) {
                int i = 3 * (y * mask.width + x) + c;
                squares += pow((double)srgb.u8[i] - photo.u8[i], 2);
                count++;
            }
        }
    assert_true(count > 300);
    free(path);
    free(mask_path);
    orl_image_finish(&srgb);
    orl_image_finish(&photo);
    orl_image_finish(&mask);
    return squares > 0 ? 10 * log10(255 * 255 * count / squares) : 99;
}

// Section 3: "a camera's image is reproduced exactly if the viewing direction coincides with its
// optical axis"; 4: "despite the low resolution of the voxel model, much finer details are
// visible".
static void photographs_come_back_at_their_axis(void **state)
{
    (void)state;
    struct fixture f;
    setup_figure(&f, CAMERAS, FIGURE_W, FIGURE_H);
    // The last has more groups of 128 voxels than devices must take in one direction.
    static const char *const sides[] = {"hull_side=24", "hull_side=64", "hull_side=208"};
    double own[ORL_COUNT(sides)];
    for (size_t i = 0; i < ORL_COUNT(sides); i++) {
        struct orl_render_params params = params_of(&sides[i], 1);
        struct orl_frame frame = draw(gpu, &f, f.photos[0].view, &params, 0);
        own[i] = psnr_within(&f, &frame, 0, 1);
        orl_frame_finish(&frame);
    }
    // A voxel of 24^3 is 8 cm wide, a stripe of the figure's shirt 5 cm.
    print_message("own view %.1f dB at 24^3, %.1f at 64^3, %.1f at 208^3\n", own[0], own[1], own[2]);
    assert_true(own[0] > 35 && own[1] > 37 && own[2] > 37);
    teardown(&f);
}

// A photograph that is left out of a view has no part in its hull either.
static void a_photograph_left_out_carves_nothing(void **state)
{
    (void)state;
    struct fixture f;
    setup_empty(&f, 4);
    double middle = 0.5 * SIDE;
    for (int i = 0; i < 3; i++) // the last one sees half as much
        add_disc_photo(&f, look_around(i, 4, SIDE, 60), red, middle, middle, i < 2 ? 12 : 6);
    struct orl_render_params params = orl_method_find(NULL, "goldluecke")->params;
    struct orl_renderer *renderer;
    assert_int_equal(orl_renderer_create(gpu, &f.scene, NULL, &renderer), ORL_OK);
    const bool skip[3] = {false, false, true};
    double covered[3];
    for (int i = 0; i < 3; i++) { // with all, without the last, with all again
        struct orl_frame frame;
        covered[i] = 0;
        assert_int_equal(orl_renderer_draw(renderer, &f.photos[0].view, &params,
                                           i == 1 ? skip : NULL, &frame), ORL_OK);
        for (int p = 0; p < SIDE * SIDE; p++)
            covered[i] += (double)frame.coverage.f32[p];
        orl_frame_finish(&frame);
    }
    assert_true(covered[1] > 1.5 * covered[0]);
    assert_float_equal(covered[2], covered[0], 0);
    orl_renderer_destroy(&renderer);
    teardown(&f);
}

// Section 4: six pictures of 320 x 240 are 1.8 MB a frame.
static void a_frame_uploads_as_much_as_the_paper_says(void **state)
{
    (void)state;
    struct fixture f;
    setup_empty(&f, 4);
    for (int i = 0; i < 6; i++) {
        struct orl_view view = look_around(1.0472 * i, 4, 320, 300);
        view.camera.height = 240;
        view.camera.cy = 120;
        add_disc_photo(&f, view, red, 160, 120, 30);
    }
    struct orl_render_params params = orl_method_find(NULL, "goldluecke")->params;
    struct orl_renderer *renderer;
    assert_int_equal(orl_renderer_create(gpu, &f.scene, NULL, &renderer), ORL_OK);
    assert_int_equal(orl_renderer_draw(renderer, &f.photos[0].view, &params, NULL, NULL), ORL_OK);
    assert_int_equal(orl_renderer_uploaded(renderer), 6 * 320 * 240 * 4);
    orl_renderer_destroy(&renderer);
    teardown(&f);
}

static void a_scene_without_shape_says_so(void **state)
{
    (void)state;
    struct fixture f;
    struct orl_frame frame;
    struct orl_renderer *renderer;
    setup_empty(&f, 4);
    add_photo(&f, look_around(0, 4, SIDE, 60), red);
    struct orl_render_params params = orl_method_find(NULL, "goldluecke")->params;
    assert_int_equal(orl_renderer_create(gpu, &f.scene, NULL, &renderer), ORL_OK);
    assert_int_equal(orl_renderer_draw(renderer, &f.photos[0].view, &params, NULL, &frame),
                     ORL_ERR_NOT_FOUND);
    orl_renderer_destroy(&renderer);
    teardown(&f);
}

int main(void)
{
    gpu = gpu_test_device();
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(the_hull_is_the_and_of_partial_hulls),
        cmocka_unit_test(several_objects_have_room_between),
        cmocka_unit_test(points_fill_voxels),
        cmocka_unit_test(the_nearest_two_weigh_by_their_arcs),
        cmocka_unit_test(colours_blend_by_the_weights),
        cmocka_unit_test(borders_of_silhouettes_are_half_there),
        cmocka_unit_test(hidden_voxels_are_painted_by_others),
        cmocka_unit_test(voxels_seen_in_part_are_painted_by_others),
        cmocka_unit_test(clipped_photographs_give_way),
        cmocka_unit_test(memory_stays_within_the_plan),
        cmocka_unit_test(photographs_come_back_at_their_axis),
        cmocka_unit_test(a_photograph_left_out_carves_nothing),
        cmocka_unit_test(a_frame_uploads_as_much_as_the_paper_says),
        cmocka_unit_test(a_scene_without_shape_says_so),
    };
    int failed = cmocka_run_group_tests_name("goldluecke", tests, NULL, NULL);
    orl_gpu_destroy(&gpu);
    return failed;
}
