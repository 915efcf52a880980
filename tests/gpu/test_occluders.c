// What one photograph alone shows before a wall is found by the others, and is then not painted.
#include "wall_scene.h"

#include "core/file.h"
#include "eval/occluder_masks.h"

enum { SIDE = 256, PHOTOS = 5, WITH = 2, EDGE = 96 }; // pixels of photographs; the occluder's side

static struct orl_gpu *gpu;

// A red wall. Photograph WITH has a blue square in its upper left corner, and no point there.
static void setup_occluder(struct fixture *f)
{
    setup(f, false);
    for (int i = 0; i < PHOTOS; i++) {
        add_photo(f, look_from(0.2 * (i - WITH), 0, 0, SIDE, 256), red);
        if (i != WITH)
            continue;
        struct orl_image image;
        assert_int_equal(orl_image_init(NULL, &image, SIDE, SIDE, 3, ORL_PIXEL_U8), ORL_OK);
        for (int k = 0; k < SIDE * SIDE; k++)
            memcpy(&image.u8[3 * k], k % SIDE < EDGE && k / SIDE < EDGE ? blue : red, 3);
        repaint_photo(f, &image);
    }
}

static void write_mask(struct fixture *f, const struct orl_image *mask, double share)
{
    char *path = strdup(orl_scene_file(&f->scene, WITH, ORL_FILE_OCCLUDERS).text);
    assert_int_equal(orl_file_make_folder(NULL, path), ORL_OK);
    assert_int_equal(orl_png_write(NULL, path, mask), ORL_OK);
    f->photos[WITH].occluded = (float)share;
    free(path);
}

// The red light in the middle of the occluder, in the view of its photograph, which has most weight.
static float red_at_occluder(struct fixture *f)
{
    struct orl_render_params params = orl_method_find(NULL, "oriel")->params;
    params.sharpness = 64;
    params.outliers = 0;
    struct orl_frame frame = draw(gpu, f, look_from(0, 0, 0, SIDE, 256), &params, 0);
    float light = color_at(&frame, EDGE / 2, EDGE / 2)[0];
    orl_frame_finish(&frame);
    return light;
}

static void an_occluder_is_found_and_dropped(void **state)
{
    (void)state;
    struct fixture f;
    struct orl_image masks[PHOTOS] = {{0}};
    double shares[PHOTOS] = {0};
    setup_occluder(&f);
    assert_int_equal(orl_occluders_find(gpu, &f.scene, NULL, masks, shares), ORL_OK);
    for (int i = 0; i < PHOTOS; i++)
        if (i != WITH)
            assert_float_equal(shares[i], 0, 0);
    double truth = (double)(EDGE * EDGE) / (SIDE * SIDE);
    print_message("share found %.3f, true %.3f\n", shares[WITH], truth);
    assert_true(shares[WITH] > truth && shares[WITH] < 1.2 * truth);
    assert_true(red_at_occluder(&f) < 0.5f);
    write_mask(&f, &masks[WITH], shares[WITH]);
    assert_float_equal(red_at_occluder(&f), 1, 0.01f);
    for (int i = 0; i < PHOTOS; i++)
        orl_image_finish(&masks[i]);
    teardown(&f);
}

static void two_photographs_are_too_few(void **state)
{
    (void)state;
    struct fixture f;
    struct orl_image masks[2] = {{0}};
    double shares[2] = {0};
    setup(&f, false);
    add_photo(&f, look_from(0, 0, 0, SIDE, 256), red);
    add_photo(&f, look_from(0.2, 0, 0, SIDE, 256), red);
    assert_int_equal(orl_occluders_find(gpu, &f.scene, NULL, masks, shares), ORL_ERR_DATA);
    teardown(&f);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(an_occluder_is_found_and_dropped),
        cmocka_unit_test(two_photographs_are_too_few),
    };
    gpu = gpu_test_device();
    int failed = cmocka_run_group_tests(tests, NULL, NULL);
    assert_int_equal(orl_gpu_finish(gpu), ORL_OK);
    orl_gpu_destroy(&gpu);
    return failed;
}
