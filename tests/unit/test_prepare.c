// The parts of prepare that need neither COLMAP nor a device: which photographs are
// taken, exposures, and what COLMAP's output says of progress.
#include <math.h>
#include <string.h>
#include <unistd.h>

#include <png.h>

#include "preprocess/expose/expose.h"
#include "preprocess/job/colmap_run.h"
#include "preprocess/photos/doubts.h"
#include "oriel/prepare.h"
#include "test.h"

static void reads_progress(void **state)
{
    (void)state;
    static const struct {
        const char *line;
        double progress;
    } cases[] = {
        {"Processed file [3/12]", 0.25},
        {"Matching block [1/2] in 7.686s", 0.5},
        {"Registering image #11 (3)", 0.3},
        {"Undistorting image [13/13]", 1},
        {"Processing view 3 / 6 for a.jpg", 0.5},
        {"Matching block [0/0]", -1},
        {"Processed file [1/0]", -1},
        {"  Name:            a.jpg", -1},
        {"", -1},
    };
    for (size_t i = 0; i < ORL_COUNT(cases); i++)
        assert_float_equal(orl_colmap_line_progress(cases[i].line, 10), cases[i].progress, 1e-12);
}

static void groups_exposures(void **state)
{
    (void)state;
    // Two brackets with a jitter of a twentieth of a stop, one unknown, and a held-out
    // photograph that must not move the median.
    struct orl_exposed e[] = {
        {.known = true, .ev = -8}, {.known = true, .ev = -10},  {.known = true, .ev = -8.05},
        {.known = false},          {.known = true, .ev = -8.02}, {.known = true, .ev = -10.03},
        {.known = true, .test = true, .ev = 3},
    };
    int series;
    assert_int_equal(
        orl_exposures_group(NULL, e, ORL_COUNT(e), ORL_EXPOSURE_STEP_EV, false, &series), ORL_OK);
    assert_int_equal(series, 2);
    const int expected[] = {1, 0, 1, 1, 1, 0, 1};
    for (size_t i = 0; i < ORL_COUNT(e); i++)
        assert_int_equal(e[i].series, expected[i]);
    assert_float_equal(e[2].ev, 0, 1e-12);
    assert_float_equal(e[0].ev, 0.05, 1e-12);
    assert_float_equal(e[3].ev, 0, 0);
    assert_false(e[3].known);
    assert_float_equal(e[6].ev, 11.05, 1e-12);
    // As far apart as a step: two series. The median is that of the lower one.
    struct orl_exposed two[2] = {{.known = true, .ev = ORL_EXPOSURE_STEP_EV}, {.known = true}};
    assert_int_equal(orl_exposures_group(NULL, two, 2, ORL_EXPOSURE_STEP_EV, false, &series), ORL_OK);
    assert_int_equal(series, 2);
    assert_float_equal(two[0].ev, ORL_EXPOSURE_STEP_EV, 0);
    assert_float_equal(two[1].ev, 0, 0);
    struct orl_exposed none[2] = {{0}, {.known = true, .test = true, .ev = 5}};
    assert_int_equal(orl_exposures_group(NULL, none, 2, ORL_EXPOSURE_STEP_EV, false, &series), ORL_OK);
    assert_int_equal(series, 1);
    assert_false(none[1].known);
    assert_float_equal(none[1].ev, 0, 0);
    // A list of times in place of stops: 1/250 s and 30 s.
    struct orl_exposed far[3] = {{.name = "a", .known = true, .ev = 0.004}, {.name = "b", .known = true, .ev = 0.004},
                                 {.name = "c", .known = true, .ev = 30, .from = ORL_EXPOSURE_LIST}};
    assert_int_equal(orl_exposures_group(NULL, far, 3, ORL_EXPOSURE_STEP_EV, false, &series), ORL_OK);
    assert_int_equal(series, 1);
    assert_true(far[0].known && far[1].known && !far[2].known);
    assert_int_equal(far[2].from, ORL_EXPOSURE_UNKNOWN);
    assert_float_equal(far[2].ev, 0, 0);
    assert_int_equal(far[2].series, 0);
}

// A photograph of noise, so that its file is long enough to be cut.
static void save_photo(const char *dir, const char *name, uint32_t seed)
{
    char path[4096];
    struct orl_image image;
    assert_int_equal(orl_image_init(NULL, &image, 96, 80, 3, ORL_PIXEL_U8), ORL_OK);
    for (size_t i = 0; i < orl_image_bytes(&image); i++) {
        seed = seed * 1664525u + 1013904223u;
        image.u8[i] = (uint8_t)(seed >> 24);
    }
    snprintf(path, sizeof path, "%s/%s", dir, name);
    enum orl_result result = strstr(name, ".png") ? orl_png_write(NULL, path, &image)
                                                  : orl_jpeg_write(NULL, path, &image, 90, NULL);
    assert_int_equal(result, ORL_OK);
    orl_image_finish(&image);
}

static void cut_file(const char *dir, const char *name)
{
    char path[4096];
    snprintf(path, sizeof path, "%s/%s", dir, name);
    uint8_t *data;
    size_t size;
    assert_int_equal(orl_file_read(NULL, path, 1 << 20, &data, &size), ORL_OK);
    assert_int_equal(orl_file_write(NULL, path, data, size / 2), ORL_OK);
    free(data);
}

struct world {
    char *photos, *scene;
    struct said said;
    struct orl_log log;
    struct orl_job job;
    struct orl_prepare_params params;
    const char *inputs[4];
};

static void world_open(struct world *w)
{
    memset(w, 0, sizeof *w);
    w->photos = test_dir_make();
    w->scene = test_dir_make();
    w->log = log_to(&w->said);
    w->inputs[0] = w->photos;
    w->params = (struct orl_prepare_params){.inputs = w->inputs, .input_count = 1,
                                            .out = w->scene};
    w->job = (struct orl_job){.log = &w->log, .params = &w->params, .dir = w->scene,
                              .lock_fd = -1, .skipped = json_array()};
}

static void world_close(struct world *w)
{
    for (size_t i = 0; i < w->job.source_count; i++) {
        free(w->job.sources[i].name);
        free(w->job.sources[i].given);
        free(w->job.sources[i].path);
        free(w->job.sources[i].original);
        free(w->job.sources[i].mask);
    }
    free(w->job.sources);
    json_decref(w->job.skipped);
    test_dir_remove(w->photos);
    test_dir_remove(w->scene);
}

static void collects_what_can_be_used(void **state)
{
    (void)state;
    struct world w;
    world_open(&w);
    static const char *const names[] = {"d.png", "a.jpg", "c.JPG", "b.jpg", "cut.jpg",
                                        "cut.png", "x,y.jpg"};
    for (size_t i = 0; i < ORL_COUNT(names); i++)
        save_photo(w.photos, names[i], (uint32_t)i);
    cut_file(w.photos, "cut.jpg");
    cut_file(w.photos, "cut.png");
    char path[4096];
    static const char *const others[] = {"text.jpg", "raw.dng", "notes.txt", ".hidden.jpg"};
    for (size_t i = 0; i < ORL_COUNT(others); i++) {
        snprintf(path, sizeof path, "%s/%s", w.photos, others[i]);
        assert_int_equal(orl_file_write(NULL, path, "hello", 5), ORL_OK);
    }
    snprintf(path, sizeof path, "%s/dangling.jpg", w.photos);
    assert_int_equal(symlink("/nowhere/at/all.jpg", path), 0);
    // Given a second time as a file, it counts once.
    snprintf(path, sizeof path, "%s/a.jpg", w.photos);
    w.inputs[1] = path;
    w.params.input_count = 2;
    w.params.test_every = 3;
    assert_int_equal(orl_stage_collect(&w.job), ORL_OK);
    assert_int_equal(w.job.given, 10);
    assert_int_equal(w.job.source_count, 4);
    static const char *const used[] = {"a.jpg", "b.jpg", "c.JPG", "d.png"};
    for (size_t i = 0; i < 4; i++) {
        assert_string_equal(w.job.sources[i].name, used[i]);
        assert_int_equal(w.job.sources[i].test, i % 3 == 0);
        assert_int_equal(w.job.sources[i].width, 96);
        char link[4096];
        snprintf(link, sizeof link, "%s/.oriel/photos/%s", w.scene, used[i]);
        assert_true(orl_path_is_file(link));
    }
    assert_int_equal(json_array_size(w.job.skipped), 6);
    static const char *const skipped[] = {"cut.jpg", "cut.png", "text.jpg", "raw.dng", "x,y.jpg",
                                          "dangling.jpg"};
    for (size_t i = 0; i < ORL_COUNT(skipped); i++)
        assert_non_null(strstr(w.said.text, skipped[i]));
    assert_null(strstr(w.said.text, "notes.txt"));
    world_close(&w);
}

// Masks that lie among the photographs are no photographs, whatever the custom; a photograph whose name
// only looks like a mask's stays. Alpha is mentioned.
static void knows_masks_among_photographs(void **state)
{
    (void)state;
    static const char *const photos[] = {"images/a.png", "images/b.jpg", "images/c.jpg", "images/old_mask.jpg"};
    static const char *const masks[] = {"masks/a.png", "masks/b.jpg.png", "images/c_mask.png",
                                        "images/b.mask.png", "images/dynamic_mask_c.png"};
    struct world w;
    world_open(&w);
    char path[4096];
    static const char *const folders[] = {"images", "masks"};
    for (size_t i = 0; i < ORL_COUNT(folders); i++) {
        snprintf(path, sizeof path, "%s/%s", w.photos, folders[i]);
        assert_int_equal(orl_dir_make(NULL, path), ORL_OK);
    }
    for (size_t i = 0; i < ORL_COUNT(photos); i++)
        save_photo(w.photos, photos[i], (uint32_t)i);
    for (size_t i = 0; i < ORL_COUNT(masks); i++)
        save_photo(w.photos, masks[i], (uint32_t)i + 10);
    static uint8_t pixels[96 * 80 * 4]; // transparent but for the first pixel
    pixels[3] = 255;
    png_image image = {.version = PNG_IMAGE_VERSION, .width = 96, .height = 80, .format = PNG_FORMAT_RGBA};
    snprintf(path, sizeof path, "%s/images/a.png", w.photos);
    assert_int_equal(png_image_write_to_file(&image, path, 0, pixels, 0, NULL), 1);
    assert_int_equal(orl_stage_collect(&w.job), ORL_OK);
    assert_int_equal(w.job.given, ORL_COUNT(photos));
    assert_int_equal(w.job.source_count, ORL_COUNT(photos));
    for (size_t i = 0; i < ORL_COUNT(photos); i++)
        assert_string_equal(w.job.sources[i].given, photos[i]);
    assert_non_null(strstr(w.said.text, "5 masks among the photographs, as images/b.mask.png, are not used"));
    assert_non_null(strstr(w.said.text, "images/a.png: its alpha is not used"));
    world_close(&w);
}

static void refuses_too_few(void **state)
{
    (void)state;
    for (int count = 0; count < 3; count++) {
        struct world w;
        world_open(&w);
        for (int i = 0; i < count; i++) {
            char name[16];
            snprintf(name, sizeof name, "%d.jpg", i);
            save_photo(w.photos, name, (uint32_t)i);
        }
        assert_int_equal(orl_stage_collect(&w.job), count ? ORL_ERR_DATA : ORL_ERR_NOT_FOUND);
        assert_non_null(strstr(w.said.text, w.photos));
        assert_non_null(strstr(w.said.text, count ? "three are needed" : "JPEG, PNG"));
        world_close(&w);
    }
}

static void refuses_ambiguous_names(void **state)
{
    (void)state;
    struct world w, other;
    world_open(&w);
    world_open(&other);
    save_photo(w.photos, "same.jpg", 1);
    save_photo(other.photos, "same.jpg", 2);
    w.inputs[1] = other.photos;
    w.params.input_count = 2;
    assert_int_equal(orl_stage_collect(&w.job), ORL_ERR_ARGUMENT);
    assert_non_null(strstr(w.said.text, w.photos));
    assert_non_null(strstr(w.said.text, other.photos));
    world_close(&w);
    world_close(&other);
}

static void holds_out_by_name(void **state)
{
    (void)state;
    struct orl_names list = {0};
    assert_int_equal(orl_names_add(NULL, &list, "1"), ORL_OK);
    assert_int_equal(orl_names_add(NULL, &list, "3.jpg"), ORL_OK);
    struct world w;
    world_open(&w);
    save_photo(w.photos, "0.jpg", 0);
    save_photo(w.photos, "1.jpg", 1);
    save_photo(w.photos, "2.jpg", 2);
    save_photo(w.photos, "3.jpg", 3);
    w.params.test_list = list;
    assert_int_equal(orl_stage_collect(&w.job), ORL_OK);
    for (size_t i = 0; i < 4; i++)
        assert_int_equal(w.job.sources[i].test, i % 2);
    world_close(&w);
    // One that is not there is a mistake, as is holding out nearly all.
    for (int which = 0; which < 2; which++) {
        assert_int_equal(orl_names_add(NULL, &list, which ? "0" : "7"), ORL_OK);
        world_open(&w);
        save_photo(w.photos, "0.jpg", 0);
        save_photo(w.photos, "1.jpg", 1);
        save_photo(w.photos, "3.jpg", 3);
        w.params.test_list = list;
        assert_int_equal(orl_stage_collect(&w.job), ORL_ERR_ARGUMENT);
        assert_non_null(strstr(w.said.text, which ? "at least two must remain" : "--test-list 7"));
        world_close(&w);
        free(list.items[--list.count]);
    }
    orl_names_finish(&list);
}

static void holds_out_a_block(void **state)
{
    (void)state;
    for (int end = 3; end <= 5; end += 2) {
        struct world w;
        world_open(&w);
        save_photo(w.photos, "0.jpg", 0);
        save_photo(w.photos, "1.jpg", 1);
        save_photo(w.photos, "2.jpg", 2);
        save_photo(w.photos, "3.jpg", 3);
        w.params.test_block = (struct orl_test_block){1, end};
        assert_int_equal(orl_stage_collect(&w.job), end == 3 ? ORL_OK : ORL_ERR_ARGUMENT);
        for (size_t i = 0; end == 3 && i < 4; i++)
            assert_int_equal(w.job.sources[i].test, i == 1 || i == 2);
        if (end == 5)
            assert_non_null(strstr(w.said.text, "--test-block 1:5: there are 4 photographs"));
        world_close(&w);
    }
}

// The source's mask is a copy of dir/NAME, in black and white.
static void expect_mask(const struct orl_source *source, const char *dir, const char *name)
{
    uint64_t hash;
    struct orl_image mask;
    char *path = test_path(dir, name);
    assert_int_equal(orl_file_hash(NULL, path, &hash), ORL_OK);
    assert_int_equal(source->mask_hash, hash);
    assert_non_null(strstr(source->mask, "/.oriel/masks/"));
    assert_int_equal(orl_picture_read(NULL, source->mask, 1, &mask), ORL_OK);
    for (size_t i = 0; i < orl_image_bytes(&mask); i++)
        assert_true(mask.u8[i] == 0 || mask.u8[i] == 255);
    orl_image_finish(&mask);
    free(path);
}

static void finds_masks(void **state)
{
    (void)state;
    struct world w, masks;
    world_open(&w);
    world_open(&masks);
    save_photo(w.photos, "0.jpg", 0);
    save_photo(w.photos, "1.jpg", 1);
    save_photo(w.photos, "2.jpg", 2);
    save_photo(masks.photos, "0.png", 0);
    save_photo(masks.photos, "1.jpg.png", 1);
    w.params.masks_dir = masks.photos;
    assert_int_equal(orl_stage_collect(&w.job), ORL_OK);
    expect_mask(&w.job.sources[0], masks.photos, "0.png");
    expect_mask(&w.job.sources[1], masks.photos, "1.jpg.png");
    assert_null(w.job.sources[2].mask);
    assert_non_null(strstr(w.said.text, "1 of 3 photographs have no mask"));
    world_close(&w);
    world_close(&masks);
}

// A scene of soft blobs from `at` pixels to the right, exposed by `gain`, with somebody in it.
static void save_view(const char *dir, const char *name, int at, double gain, int passer_by)
{
    char path[4096];
    struct orl_image image;
    assert_int_equal(orl_image_init(NULL, &image, 192, 144, 3, ORL_PIXEL_U8), ORL_OK);
    for (int y = 0; y < image.height; y++)
        for (int x = 0; x < image.width; x++) {
            double u = x + at, light = sin(u * 0.21 + y * 0.05) * cos(y * 0.17 - u * 0.03);
            light = 100 + 60 * light;
            if (x > passer_by && x < passer_by + 12 && y > 90)
                light = 30;
            for (int c = 0; c < 3; c++)
                image.u8[3 * (y * image.width + x) + c] = (uint8_t)(gain * light);
        }
    snprintf(path, sizeof path, "%s/%s", dir, name);
    assert_int_equal(orl_jpeg_write(NULL, path, &image, 90, NULL), ORL_OK);
    orl_image_finish(&image);
}

static void counts_views(void **state)
{
    (void)state;
    // Frames of a camera that stood still, of two, and of one that was moved a little.
    static const struct {
        int at[4];
        size_t views;
    } cases[] = {{{0, 0, 0, 0}, 1}, {{0, 90, 0, 90}, 2}, {{0, 6, 12, 18}, 3}};
    for (size_t k = 0; k < ORL_COUNT(cases); k++) {
        struct world w;
        world_open(&w);
        for (int i = 0; i < 4; i++) {
            char name[16];
            snprintf(name, sizeof name, "%d.jpg", i);
            save_view(w.photos, name, cases[k].at[i], 1 - 0.2 * i, 30 + 30 * i);
        }
        assert_int_equal(orl_stage_collect(&w.job), ORL_OK);
        size_t views;
        assert_int_equal(orl_count_views(&w.job, 3, &views), ORL_OK);
        assert_int_equal(views, cases[k].views);
        world_close(&w);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(reads_progress),
        cmocka_unit_test(groups_exposures),
        cmocka_unit_test(collects_what_can_be_used),
        cmocka_unit_test(knows_masks_among_photographs),
        cmocka_unit_test(refuses_too_few),
        cmocka_unit_test(refuses_ambiguous_names),
        cmocka_unit_test(holds_out_by_name),
        cmocka_unit_test(holds_out_a_block),
        cmocka_unit_test(finds_masks),
        cmocka_unit_test(counts_views),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
