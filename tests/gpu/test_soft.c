// Soft splats: what a splat draws, the gradient of the loss against finite differences, and a descent.
#include <math.h>

#include "core/memory.h"
#include "gpu_test.h"
#include "soft/descent.h"

enum { WIDTH = 40, HEIGHT = 32, SPLATS = 12 };

static struct orl_gpu *gpu;

static struct orl_soft_photo photograph(uint64_t seed)
{
    struct orl_soft_photo photo = {.view.camera = {.width = WIDTH, .height = HEIGHT, .fx = 50, .fy = 48, .cx = 19,
                                                   .cy = 16.5}};
    const double eye[3] = {0.4, -0.3, -4}, target[3] = {0, 0.1, 0}, up[3] = {0.1, -1, 0};
    photo.view.cam_from_world = orl_pose_look_at(eye, target, up);
    assert_int_equal(orl_image_init(NULL, &photo.color, WIDTH, HEIGHT, 3, ORL_PIXEL_F32), ORL_OK);
    for (size_t i = 0; i < 3 * WIDTH * HEIGHT; i++)
        photo.color.f32[i] = (float)(0.5 * orl_soft_random(&seed) + 0.25 * sin(0.1 * (double)i) + 0.25);
    return photo;
}

static struct orl_soft_model some_splats(void)
{
    struct orl_soft_model model = {0};
    uint64_t state = 88172645463325252u;
    for (int i = 0; i < SPLATS; i++) {
        const double place[3] = {1.6 * orl_soft_random(&state) - 0.8, 1.6 * orl_soft_random(&state) - 0.8,
                                 1.6 * orl_soft_random(&state) - 0.8};
        const float grey[3] = {0.5f, 0.5f, 0.5f};
        assert_int_equal(orl_soft_add(NULL, &model, place, 0.1, 0.5f, grey), ORL_OK);
        float *s = model.splats[i];
        for (int k = 0; k < 3; k++)
            s[ORL_SOFT_SIGMA + k] = (float)log(0.12 + 0.25 * orl_soft_random(&state));
        for (int k = 0; k < 4; k++)
            s[ORL_SOFT_TURN + k] = (float)(2 * orl_soft_random(&state) - 1);
        s[ORL_SOFT_OPACITY] = (float)(2 * orl_soft_random(&state) - 1);
        for (int k = 0; k < 3; k++)
            s[ORL_SOFT_COLOR + k] = (float)(orl_soft_random(&state) - 0.3);
    }
    return model;
}

// The loss of a model. gradient: NULL, or by its values.
static double loss_of(const struct orl_soft_model *model, const struct orl_soft_photo *photo, float *gradient)
{
    struct orl_soft_descent descent;
    double loss;
    assert_int_equal(orl_soft_descent_init(gpu, model, &descent), ORL_OK);
    assert_int_equal(orl_soft_descent_step(gpu, &descent, photo, 0, &loss), ORL_OK);
    const size_t values = model->count * ORL_SOFT_VALUES;
    if (gradient)
        orl_buf_read(descent.mean, values * sizeof *gradient, gradient);
    for (size_t i = 0; gradient && i < values; i++)
        gradient[i] *= 10; // the running mean of one gradient is a tenth of it
    orl_soft_descent_finish(gpu, &descent);
    return loss;
}

// Not so: the size of a pixel, and what fills the last row.
static bool is_adjusted(int value)
{
    return value != ORL_SOFT_PIXEL && value < ORL_SOFT_COLOR + 3;
}

static void test_gradient(void **state)
{
    (void)state;
    struct orl_soft_photo photo = photograph(1);
    struct orl_soft_model model = some_splats();
    static float gradient[SPLATS][ORL_SOFT_VALUES];
    double off[ORL_SOFT_VALUES] = {0}, size[ORL_SOFT_VALUES] = {0};
    loss_of(&model, &photo, gradient[0]);
    for (int i = 0; i < SPLATS; i++) {
        for (int k = 0; k < ORL_SOFT_VALUES; k++) {
            const float step = 1e-2f, value = model.splats[i][k];
            if (!is_adjusted(k))
                continue;
            model.splats[i][k] = value + step;
            double above = loss_of(&model, &photo, NULL);
            model.splats[i][k] = value - step;
            double below = loss_of(&model, &photo, NULL), slope = (above - below) / (2 * (double)step);
            model.splats[i][k] = value;
            off[k] += pow(slope - (double)gradient[i][k], 2);
            size[k] += slope * slope;
        }
    }
    // What is left is the jumps of opacities that are too small to be drawn, which the gradient leaves out.
    for (int k = 0; k < ORL_SOFT_VALUES; k++)
        assert_true(!is_adjusted(k) || sqrt(off[k]) < 0.2 * sqrt(size[k]));
    orl_image_finish(&photo.color);
    orl_soft_finish(&model);
}

// A camera at the origin that looks along z, `divide` times smaller than 64 x 48 pixels.
static struct orl_view ahead(int divide)
{
    return (struct orl_view){.camera = {.width = 64 / divide, .height = 48 / divide, .fx = 64.0 / divide,
                                        .fy = 64.0 / divide, .cx = 32.5 / divide, .cy = 24.5 / divide},
                             .cam_from_world = {.r = {{1, 0, 0}, {0, 1, 0}, {0, 0, 1}}}};
}

// RGBA of a model in a view.
static struct orl_image drawn(const struct orl_soft_model *model, const struct orl_view *view, bool smooths)
{
    struct orl_soft_raster raster;
    struct soft_block block;
    struct orl_image picture;
    assert_int_equal(orl_soft_raster_init(gpu, model, &raster), ORL_OK);
    assert_int_equal(orl_soft_raster_draw(gpu, &raster, view, smooths, &block), ORL_OK);
    assert_int_equal(orl_image_init(NULL, &picture, view->camera.width, view->camera.height, 4, ORL_PIXEL_F32), ORL_OK);
    orl_tex_read(raster.blended, 0, GL_RGBA, GL_FLOAT, orl_image_bytes(&picture), picture.f32);
    orl_soft_raster_finish(gpu, &raster);
    return picture;
}

static const float *pixel(const struct orl_image *picture, int x, int y)
{
    return picture->f32 + 4 * ((size_t)y * (size_t)picture->width + (size_t)x);
}

static void add(struct orl_soft_model *model, double x, double z, double sigma, float opacity, float red, float blue)
{
    const double place[3] = {x, 0, z};
    const float rgb[3] = {red, 0, blue};
    assert_int_equal(orl_soft_add(NULL, model, place, sigma, opacity, rgb), ORL_OK);
}

// One splat is a Gaussian of its size, and 0.3 pixels^2 wider; a nearer one covers a farther one.
static void test_splats_blend(void **state)
{
    (void)state;
    struct orl_soft_model model = {0};
    const struct orl_view view = ahead(1);
    add(&model, 0, 4, 0.25, 0.6f, 1, 0); // 4 pixels
    struct orl_image one = drawn(&model, &view, false);
    for (int off = 0; off <= 8; off += 4) {
        double opacity = 0.6 * exp(-0.5 * off * off / (16 + 0.3));
        assert_float_equal(pixel(&one, 32 + off, 24)[0], opacity, 1e-4);
        assert_float_equal(pixel(&one, 32, 24 + off)[3], 1 - opacity, 1e-4);
    }
    assert_float_equal(pixel(&one, 60, 24)[3], 1, 0);
    add(&model, 0, 2, 0.125, 0.5f, 0, 1);
    struct orl_image two = drawn(&model, &view, false);
    assert_float_equal(pixel(&two, 32, 24)[2], 0.5, 1e-4);
    assert_float_equal(pixel(&two, 32, 24)[0], 0.5 * 0.6, 1e-4);
    orl_image_finish(&one);
    orl_image_finish(&two);
    orl_soft_finish(&model);
}

// So many that a device may have too few work groups in a row: the last one is drawn and adjusted, too.
static void test_many_splats(void **state)
{
    (void)state;
    const size_t count = (size_t)65535 * ORL_POINT_GROUP + 1;
    struct orl_soft_model model = {0};
    struct orl_soft_descent descent;
    double loss;
    if (orl_memory_available() < (size_t)6 << 30)
        skip();
    add(&model, 0, 4, 0.25, 0.6f, 1, 0);
    const struct orl_view view = ahead(1);
    struct orl_image one = drawn(&model, &view, false);
    struct orl_soft_model many = {.splats = orl_array(NULL, count, sizeof *many.splats), .count = count};
    assert_non_null(many.splats); // at the camera, where none is seen
    memcpy(many.splats[count - 1], model.splats[0], sizeof *many.splats);
    struct orl_image picture = drawn(&many, &view, false);
    assert_memory_equal(picture.data, one.data, orl_image_bytes(&one));
    struct orl_soft_photo photo = {.view = view};
    assert_int_equal(orl_image_init(NULL, &photo.color, 64, 48, 3, ORL_PIXEL_F32), ORL_OK);
    assert_int_equal(orl_soft_descent_init(gpu, &many, &descent), ORL_OK);
    assert_int_equal(orl_soft_descent_step(gpu, &descent, &photo, 1, &loss), ORL_OK);
    orl_buf_read(descent.raster.splats, count * sizeof *many.splats, many.splats);
    assert_true(many.splats[count - 1][ORL_SOFT_OPACITY] < model.splats[0][ORL_SOFT_OPACITY]);
    orl_soft_descent_finish(gpu, &descent);
    orl_image_finish(&photo.color);
    orl_image_finish(&picture);
    orl_image_finish(&one);
    orl_soft_finish(&many);
    orl_soft_finish(&model);
}

static double covered(const struct orl_soft_model *model, const struct orl_view *view)
{
    struct orl_image picture = drawn(model, view, true);
    double sum = 0;
    for (int y = 0; y < picture.height; y++)
        for (int x = 0; x < picture.width; x++)
            sum += 1 - (double)pixel(&picture, x, y)[3];
    orl_image_finish(&picture);
    return sum;
}

// In a view of fewer pixels a small splat covers the same share of the picture, and in one of more pixels it is not
// sharper than the photographs.
static void test_size_of_the_view(void **state)
{
    (void)state;
    struct orl_soft_model model = {0};
    add(&model, 0, 4, 0.02, 0.6f, 1, 0);
    model.splats[0][ORL_SOFT_PIXEL] = 2 * 4 / 64.0f; // adjusted at half the size of ahead(1)
    const struct orl_view whole = ahead(1), half = ahead(2), quarter = ahead(4);
    double at_whole = covered(&model, &whole), at_half = covered(&model, &half), at_quarter = covered(&model, &quarter);
    assert_float_equal(at_whole / at_half, 4, 0.4);
    assert_float_equal(at_half / at_quarter, 4, 0.4);
    orl_soft_finish(&model);
}

// A far splat of the wrong colour, a quarter of the size and four pixels off, adjusted to a picture of the right one.
static void test_descent(void **state)
{
    (void)state;
    struct orl_soft_model right = {0}, model = {0};
    add(&right, 0, 4, 0.4, 0.9f, 0.8f, 0.2f);
    struct orl_soft_photo photo = {.view = ahead(1)};
    struct orl_image picture = drawn(&right, &photo.view, false);
    assert_int_equal(orl_image_init(NULL, &photo.color, 64, 48, 3, ORL_PIXEL_F32), ORL_OK);
    for (size_t i = 0; i < 64 * 48; i++)
        memcpy(photo.color.f32 + 3 * i, picture.f32 + 4 * i, 3 * sizeof(float));
    struct orl_soft_descent_params params = {.steps = 200, .first_size = 1, .part_s = HUGE_VAL};
    struct orl_soft_descent_report report = {0}, parts = {0}, none = {0};
    add(&model, 0.25, 4, 0.1, 0.6f, 0.3f, 0.6f);
    double before = loss_of(&model, &photo, NULL);
    assert_int_equal(orl_soft_descend(gpu, &photo, 1, &params, &model, &report), ORL_OK);
    assert_int_equal(report.steps, 200);
    assert_true(loss_of(&model, &photo, NULL) < 0.2 * before);
    assert_float_equal(model.splats[0][ORL_SOFT_PLACE], 0, 0.01);
    assert_float_equal(model.splats[0][ORL_SOFT_SIGMA], log(0.4), 0.1);
    assert_float_equal(model.splats[0][ORL_SOFT_PIXEL], 4 / 64.0, 1e-4);

    // The same again in parts of a step, to the bit; and none of it where the photograph shows what stands before the scene.
    struct orl_soft_model again = {0}, still = {0};
    add(&again, 0.25, 4, 0.1, 0.6f, 0.3f, 0.6f);
    add(&still, 0.25, 4, 0.1, 0.6f, 0.3f, 0.6f);
    for (params.part_s = 0; !parts.done;)
        assert_int_equal(orl_soft_descend(gpu, &photo, 1, &params, &again, &parts), ORL_OK);
    assert_memory_equal(model.splats, again.splats, sizeof *model.splats);
    assert_int_equal(orl_image_init(NULL, &photo.use, 64, 48, 1, ORL_PIXEL_U8), ORL_OK);
    params.part_s = HUGE_VAL;
    assert_int_equal(orl_soft_descend(gpu, &photo, 1, &params, &still, &none), ORL_OK);
    assert_float_equal(still.splats[0][ORL_SOFT_COLOR], (0.3 - 0.5) / 0.28209479, 1e-4);
    orl_image_finish(&picture);
    orl_image_finish(&photo.color);
    orl_image_finish(&photo.use);
    orl_soft_finish(&right);
    orl_soft_finish(&model);
    orl_soft_finish(&again);
    orl_soft_finish(&still);
}

static void watch_memory(void *priv, const char *step, double done, double total, const char *detail)
{
    (void)step, (void)done, (void)total, (void)detail;
    size_t *most = priv, now = orl_gpu_bytes(gpu);
    *most = now > *most ? now : *most;
}

// A descent keeps to the memory that is said to be enough for its lists, and stops where less is given.
static void test_memory(void **state)
{
    (void)state;
    struct orl_soft_photo photo = photograph(1);
    struct orl_soft_model model = some_splats();
    struct orl_soft_descent_report report = {0}, none = {0};
    size_t most = 0;
    const struct orl_progress progress = {.report = watch_memory, .priv = &most};
    const size_t tiles = (WIDTH / ORL_SOFT_TILE) * (HEIGHT / ORL_SOFT_TILE), before = orl_gpu_bytes(gpu);
    struct orl_soft_descent_params params = {.steps = 3, .first_size = 1, .part_s = HUGE_VAL, .progress = &progress,
                                             .max_bytes = orl_soft_descent_bytes(SPLATS, SPLATS * tiles, WIDTH, HEIGHT)};
    assert_int_equal(orl_soft_descend(gpu, &photo, 1, &params, &model, &report), ORL_OK);
    assert_true(most - before > params.max_bytes / 4 && most - before <= params.max_bytes);
    params.max_bytes = (most - before) / 2;
    assert_int_equal(orl_soft_descend(gpu, &photo, 1, &params, &model, &none), ORL_ERR_GPU);
    orl_image_finish(&photo.color);
    orl_soft_finish(&model);
}

enum { SIDE = 32, UNPAINTED = 3, MIDDLE = SIDE / 2 * SIDE + SIDE / 2 };

static struct orl_tex *make_picture(GLenum format, int levels, bool array)
{
    struct orl_tex *tex;
    const struct orl_tex_params params = {.width = SIDE, .height = SIDE, .layers = array, .levels = levels,
                                          .format = format, .linear = true, .tag = "test"};
    assert_int_equal(orl_tex_create(gpu, &params, &tex), ORL_OK);
    return tex;
}

// Splats of one grey, but for a pixel that is open, and one that is white, into `blended`.
static void show_splats(struct orl_tex *blended, size_t open, size_t white)
{
    float pixels[SIDE * SIDE][4];
    for (size_t i = 0; i < SIDE * SIDE; i++)
        for (int c = 0; c < 4; c++)
            pixels[i][c] = c == 3 ? i == open : i == open ? 0 : i == white ? 1 : 0.5f;
    orl_tex_write(blended, GL_RGBA, GL_FLOAT, pixels);
    orl_tex_make_mipmaps(blended, 0);
}

// What splats show is kept as luma; what is open is as what they show around it; beyond the photograph there is what
// its border shows.
static void test_keep(void **state)
{
    (void)state;
    struct orl_tex *blended = make_picture(GL_RGBA32F, 6, false), *slot = make_picture(GL_R8, 1, true);
    const struct soft_block block = {.view_size = {SIDE, SIDE - 1}, .mean_level = 1.5f};
    uint8_t kept[SIDE * SIDE];
    show_splats(blended, MIDDLE, (SIDE - 2) * SIDE);
    orl_gpu_dispatch(gpu, &(struct orl_dispatch){
        .prog = orl_prog_get(gpu, "soft/keep.comp", NULL, NULL), ORL_PARAMS(block),
        .textures = {blended}, .images = {slot}, .size = {SIDE, SIDE}});
    orl_tex_read(slot, 0, GL_RED, GL_UNSIGNED_BYTE, sizeof kept, kept);
    for (size_t i = 0; i < SIDE * SIDE; i++)
        assert_in_range(kept[i] + 1, i % SIDE == 0 && i / SIDE >= SIDE - 2 ? 255 : 128,
                        i % SIDE == 0 && i / SIDE >= SIDE - 2 ? 256 : 129);
    orl_tex_destroy(gpu, &blended);
    orl_tex_destroy(gpu, &slot);
}

// The fourth root of light goes with what is corrected, so that specks are found in it, but not where nothing was painted.
static void check_painted(const uint8_t painted[SIDE * SIDE][2], const float picture[SIDE * SIDE][4])
{
    for (size_t i = 0; i < SIDE * SIDE; i++) {
        const float *own = picture[i];
        double light = pow((double)(0.299f * own[0] + 0.587f * own[1] + 0.114f * own[2]), 0.25);
        assert_int_equal(painted[i][0], 50);
        assert_float_equal(painted[i][1], i == UNPAINTED ? 0 : fmin(fmax(255 * light, 1), 255), 1);
    }
}

// Corrects by `gathered` and mixes in `splats` of the splats.
static void mix(const float gathered[SIDE * SIDE], size_t open, float splats, float level,
                float picture[SIDE * SIDE][4])
{
    struct orl_tex *blended = make_picture(GL_RGBA32F, 6, false), *other = make_picture(GL_R16F, 1, false);
    struct orl_tex *differs = make_picture(GL_R16F, 6, false), *own = make_picture(GL_RGBA16F, 1, false);
    struct orl_tex *specks = make_picture(GL_RG8, 1, false);
    uint8_t painted[SIDE * SIDE][2];
    const struct soft_block block = {.view_size = {SIDE, SIDE}, .correct_share = 0.5f, .mix_share = splats,
                                     .mean_level = level};
    show_splats(blended, open, SIDE * SIDE);
    orl_tex_write(other, GL_RED, GL_FLOAT, gathered);
    orl_tex_write(own, GL_RGBA, GL_FLOAT, picture);
    for (size_t i = 0; i < SIDE * SIDE; i++)
        memcpy(painted[i], (uint8_t[]){50, i == UNPAINTED ? 0 : 100}, sizeof painted[i]);
    orl_tex_write(specks, GL_RG, GL_UNSIGNED_BYTE, painted);
    struct orl_dispatch d = {
        .prog = orl_prog_get(gpu, "soft/compare.comp", NULL, NULL), ORL_PARAMS(block),
        .textures = {blended}, .images = {other, differs}, .size = {SIDE, SIDE}};
    orl_gpu_dispatch(gpu, &d);
    orl_tex_make_mipmaps(differs, 0);
    d.prog = orl_prog_get(gpu, "soft/mix.comp", NULL, "SPECKS");
    d.textures[0] = differs;
    d.images[1] = own;
    d.images[2] = blended;
    d.images[3] = specks;
    orl_gpu_dispatch(gpu, &d);
    orl_tex_read(own, 0, GL_RGBA, GL_FLOAT, SIDE * SIDE * sizeof *picture, picture);
    orl_tex_read(specks, 0, GL_RG, GL_UNSIGNED_BYTE, sizeof painted, painted);
    check_painted(painted, picture);
    orl_tex_destroy(gpu, &blended);
    orl_tex_destroy(gpu, &other);
    orl_tex_destroy(gpu, &differs);
    orl_tex_destroy(gpu, &own);
    orl_tex_destroy(gpu, &specks);
}

static double encoded(double linear)
{
    return 1.055 * pow(linear, 1 / 2.4) - 0.055;
}

// How far a pixel of luma `from` goes towards splats of luma 0.5 that correct it by `more`.
static double way_of(double from, double more)
{
    const double gap = 0.5 - from, sure = 0.04;
    return fmin(fmax(more * gap / (gap * gap + sure * sure), 0), 1);
}

static void set_pixels(float picture[SIDE * SIDE][4], float value)
{
    for (size_t i = 0; i < SIDE * SIDE; i++)
        for (int c = 0; c < 4; c++)
            picture[i][c] = c == 3 ? 0.25f : value;
}

// A picture moves towards the splats by the fine part of what they show other than in its photographs, by its share, in
// luma of sRGB; not by the coarse part, not past them or away from them, and not where there is no photograph, or no
// splat. Light above white stays.
static void test_mix(void **state)
{
    (void)state;
    float gathered[SIDE * SIDE], picture[SIDE * SIDE][4];
    for (size_t i = 0; i < SIDE * SIDE; i++)
        gathered[i] = 0.25f;
    set_pixels(picture, 0.05f);
    mix(gathered, SIDE * SIDE, 0, 1.5f, picture);
    for (size_t i = 0; i < SIDE * SIDE; i++)
        for (int c = 0; c < 4; c++)
            assert_float_equal(picture[i][c], c == 3 ? 0.25 : 0.05, 1e-3);

    for (size_t i = 0; i < SIDE * SIDE; i++)
        gathered[i] = i == MIDDLE ? 0.25f : i == 4 * SIDE + 4 ? -1 : 0.5f;
    mix(gathered, 4 * SIDE + 24, 0, 1.5f, picture);
    for (size_t i = 0; i < SIDE * SIDE; i++)
        if (i / SIDE < 8 || i / SIDE > 24) // far from the pixel that differs
            assert_float_equal(picture[i][0], 0.05, 1e-3);
    const double from = encoded(0.05), to = encoded((double)picture[MIDDLE][0]);
    // The coarse part takes 0.03 of the difference at most.
    assert_true(to > from + way_of(from, 0.5 * 0.22) * (0.5 - from));
    assert_true(to < from + way_of(from, 0.5 * 0.25) * (0.5 - from));
    assert_float_equal(picture[MIDDLE][1], picture[MIDDLE][0], 1e-3);
    assert_float_equal(picture[MIDDLE][3], 0.25, 1e-6);

    // Where the coarse part is wider than the view, it is the view's mean.
    set_pixels(picture, 0.05f);
    mix(gathered, 4 * SIDE + 24, 0, 20, picture);
    assert_float_equal(encoded((double)picture[MIDDLE][0]), from + way_of(from, 0.125) * (0.5 - from), 3e-3);

    // Nearer to the splats than the difference is, a pixel goes to them and no farther; beyond them, it stays.
    set_pixels(picture, 0.15f); // 0.42 in sRGB
    mix(gathered, SIDE * SIDE, 0, 20, picture);
    assert_in_range((int)(1000 * encoded((double)picture[MIDDLE][0])), 495, 502);
    set_pixels(picture, 0.3f);
    mix(gathered, SIDE * SIDE, 0, 20, picture);
    assert_float_equal(picture[MIDDLE][0], 0.3, 1e-3);

    // Chroma goes the same way as luma, and what is above white stays.
    for (size_t i = 0; i < SIDE * SIDE; i++)
        picture[i][0] = 3, picture[i][1] = picture[i][2] = 0;
    mix(gathered, SIDE * SIDE, 0, 20, picture);
    const double red = way_of(0.299, 0.125);
    assert_float_equal(encoded((double)picture[MIDDLE][0] - 2), 1 - 0.5 * red, 5e-3);
    assert_float_equal(encoded((double)picture[MIDDLE][2]), 0.5 * red, 5e-3);

    // What splats cover is mixed, and what they leave open stays.
    for (size_t i = 0; i < SIDE * SIDE; i++)
        gathered[i] = 0.5f;
    set_pixels(picture, 0.05f);
    mix(gathered, 0, 0.5f, 1.5f, picture);
    assert_float_equal(picture[0][0], 0.05, 1e-3);
    assert_float_equal(encoded((double)picture[1][0]), (from + 0.5) / 2, 2e-3);
}

static int setup(void **state)
{
    (void)state;
    gpu = gpu_test_device();
    return 0;
}

static int teardown(void **state)
{
    (void)state;
    orl_gpu_destroy(&gpu);
    return 0;
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_gradient),
        cmocka_unit_test(test_splats_blend),
        cmocka_unit_test(test_many_splats),
        cmocka_unit_test(test_size_of_the_view),
        cmocka_unit_test(test_descent),
        cmocka_unit_test(test_memory),
        cmocka_unit_test(test_keep),
        cmocka_unit_test(test_mix),
    };
    return cmocka_run_group_tests(tests, setup, teardown);
}
