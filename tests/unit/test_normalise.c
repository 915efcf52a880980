// Brightened copies of dark photographs, for features.
#include <math.h>
#include <unistd.h>

#include "core/color.h"
#include "preprocess/photos/normalise.h"
#include "test.h"

enum { SIDE = 64, COUNT = 4 };

struct world {
    char *dir;
    struct orl_source sources[COUNT];
    struct orl_job job;
};

// Grey photographs of linear light 0.2 at the given exposures.
static void world_open(struct world *w, const double ev[COUNT])
{
    memset(w, 0, sizeof *w);
    w->dir = test_dir_make();
    w->job = (struct orl_job){.dir = w->dir, .sources = w->sources, .source_count = COUNT};
    for (int i = 0; i < COUNT; i++) {
        struct orl_source *source = &w->sources[i];
        struct orl_image image;
        source->name = malloc(32);
        source->given = source->name;
        snprintf(source->name, 32, i == 3 ? "%d.png" : "%d.jpg", i);
        source->path = orl_path_join(NULL, w->dir, source->name);
        source->exif = (struct orl_exif){.make = "Oriel", .exposure_s = 0.01 * exp2(ev[i]),
                                         .aperture = 8, .iso = 100, .focal_35mm = 28};
        assert_int_equal(orl_image_init(NULL, &image, SIDE, SIDE, 3, ORL_PIXEL_U8), ORL_OK);
        memset(image.u8, (int)lrintf(255 * orl_srgb_encode((float)(0.2 * exp2(ev[i])))),
               orl_image_bytes(&image));
        assert_int_equal(i == 3 ? orl_png_write(NULL, source->path, &image)
                                : orl_jpeg_write(NULL, source->path, &image, 98, &source->exif),
                         ORL_OK);
        orl_image_finish(&image);
    }
}

static void world_close(struct world *w)
{
    for (int i = 0; i < COUNT; i++) {
        free(w->sources[i].name);
        free(w->sources[i].path);
    }
    test_dir_remove(w->dir);
}

static void dark_photographs_are_brightened(void **state)
{
    (void)state;
    const double ev[COUNT] = {0, -3, 1, -2};
    struct world w;
    size_t copies;
    world_open(&w, ev);
    assert_true(orl_normalise_wanted(&w.job));
    assert_int_equal(orl_normalise(&w.job, "copies", &copies), ORL_OK);
    assert_int_equal(copies, 2);
    for (int i = 0; i < COUNT; i++) {
        char path[4096], target[4096];
        struct orl_image image;
        snprintf(path, sizeof path, "%s/copies/%s", w.dir, w.sources[i].name);
        bool linked = readlink(path, target, sizeof target) > 0;
        assert_int_equal(linked, ev[i] >= 0);
        assert_int_equal(orl_picture_read(NULL, path, 3, &image), ORL_OK);
        assert_int_equal(image.width, SIDE);
        // Brought to the median, the upper of the two in the middle: 0 EV.
        double light = (double)orl_srgb_decode(image.u8[0] / 255.0f);
        assert_true(fabs(light - (i == 2 ? 0.4 : 0.2)) < 0.02);
        orl_image_finish(&image);
    }
    // COLMAP reads the focal length from it.
    struct orl_picture_info info;
    char *copy = orl_path_join(NULL, w.dir, "copies/1.jpg");
    assert_int_equal(orl_picture_inspect(NULL, copy, &info), ORL_OK);
    assert_float_equal(info.exif.focal_35mm, 28, 0);
    free(copy);
    world_close(&w);
}

static void like_exposures_need_no_copies(void **state)
{
    (void)state;
    const double ev[COUNT] = {0, -0.3, 0.3, 0.6};
    struct world w;
    size_t copies = 7;
    world_open(&w, ev);
    assert_false(orl_normalise_wanted(&w.job));
    assert_int_equal(orl_normalise(&w.job, "copies", &copies), ORL_OK);
    assert_int_equal(copies, 0);
    assert_false(orl_job_has(&w.job, "copies"));
    // A list knows better than EXIF.
    struct orl_listed_exposure listed[2] = {{.name = (char[]){"0.jpg"}, .ev = 4},
                                            {.name = (char[]){"1"}, .ev = 1}};
    w.job.exposures = (struct orl_exposure_list){listed, 2};
    assert_true(orl_normalise_wanted(&w.job));
    assert_int_equal(orl_normalise(&w.job, "copies", &copies), ORL_OK);
    assert_int_equal(copies, 1);
    world_close(&w);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(dark_photographs_are_brightened),
        cmocka_unit_test(like_exposures_need_no_copies),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
