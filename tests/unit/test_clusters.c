// Clusters of photographs for fusion, of ten cameras in a row before a wall.
#include <stdio.h>
#include <stdlib.h>

#include "core/json.h"
#include "preprocess/cloud/clusters.h"
#include "preprocess/cloud/fuse.h"
#include "preprocess/cloud/fuse_memory.h"
#include "test.h"

enum { CAMERAS = 10, TEST = 4 };

// Camera i stands at x = i, looks along z and sees the wall's points at x = i - 1, i and i + 1.
static void make_row(struct orl_colmap_model *model, struct orl_names *train)
{
    *model = (struct orl_colmap_model){
        .cameras = calloc(1, sizeof *model->cameras), .camera_count = 1,
        .images = calloc(CAMERAS, sizeof *model->images), .image_count = CAMERAS,
        .points = calloc(CAMERAS, sizeof *model->points), .point_count = CAMERAS};
    *train = (struct orl_names){0};
    model->cameras[0].id = 1;
    model->cameras[0].pinhole = (struct orl_camera){100, 80, 90, 90, 50, 40};
    for (int i = 0; i < CAMERAS; i++) {
        struct orl_colmap_image *image = &model->images[i];
        char name[16];
        snprintf(name, sizeof name, "%d.png", i);
        image->camera_id = 1;
        image->name = strdup(name);
        image->points = calloc(3, sizeof *image->points);
        for (int k = 0; k < 3; k++)
            image->cam_from_world.r[k][k] = 1;
        image->cam_from_world.t[0] = -i;
        for (int p = i - 1; p <= i + 1; p++)
            if (p >= 0 && p < CAMERAS)
                image->points[image->point_count++] = (uint32_t)p;
        model->points[i].position[0] = i;
        model->points[i].position[2] = 5;
        if (i != TEST)
            assert_int_equal(orl_names_add(NULL, train, name), ORL_OK);
    }
}

static void each_photograph_and_point_has_one_cluster(void **state)
{
    struct orl_colmap_model model;
    struct orl_names train;
    struct orl_clusters clusters;
    (void)state;
    make_row(&model, &train);
    // Nine photographs, at most three each: three clusters along the row.
    assert_int_equal(orl_clusters_make(NULL, &model, &train, 3, &clusters), ORL_OK);
    static const int members[CAMERAS] = {0, 0, 0, 1, -1, 1, 1, 2, 2, 2};
    assert_int_equal(clusters.count, 3);
    for (int i = 0; i < CAMERAS; i++)
        assert_int_equal(clusters.member[i], members[i]);
    // Point 2 is shown by 1, 2 (cluster 0) and 3; point 3 by 2 and 3 alike, and the first wins.
    static const int owners[CAMERAS] = {0, 0, 0, 0, 1, 1, 1, 2, 2, 2};
    for (int i = 0; i < CAMERAS; i++)
        assert_int_equal(clusters.owner[i], owners[i]);
    orl_clusters_finish(&clusters);
    orl_names_finish(&train);
    orl_colmap_finish(&model);
}

static void neighbours_help_and_held_out_photographs_do_not(void **state)
{
    struct orl_colmap_model model;
    struct orl_names train, names = {0};
    struct orl_clusters clusters;
    (void)state;
    make_row(&model, &train);
    assert_int_equal(orl_clusters_make(NULL, &model, &train, 3, &clusters), ORL_OK);
    // Two helpers of the middle: 7 shows point 6, and no other photograph of a cluster beside it
    // shows 4, 5 or 6 but 3 (a member) and 4 (held out).
    assert_int_equal(orl_clusters_photographs(NULL, &clusters, 1, &names), ORL_OK);
    static const char *const expected[] = {"3.png", "5.png", "6.png", "7.png"};
    assert_int_equal(names.count, 4);
    for (int i = 0; i < 4; i++)
        assert_string_equal(names.items[i], expected[i]);
    orl_names_finish(&names);
    orl_clusters_finish(&clusters);
    orl_names_finish(&train);
    orl_colmap_finish(&model);
}

// Seven cameras at x = i, each of which sees the points at most 3 away, in four clusters as equal as can
// be.
static void make_seven(struct orl_colmap_model *model, struct orl_names *train)
{
    make_row(model, train);
    orl_names_finish(train);
    model->image_count = 7;
    model->point_count = 7;
    free(model->cameras);
    model->cameras = calloc(2, sizeof *model->cameras);
    model->camera_count = 2;
    for (int i = 0; i < 2; i++) {
        model->cameras[i].id = (uint32_t)i + 1;
        model->cameras[i].pinhole = (struct orl_camera){100, 80, 90 * (3 * i + 1), 90, 50, 40};
    }
    for (int i = 0; i < CAMERAS; i++) {
        struct orl_colmap_image *image = &model->images[i];
        if (i >= 7) {
            free(image->name);
            free(image->points);
            continue;
        }
        free(image->points);
        image->points = calloc(7, sizeof *image->points);
        image->point_count = 0;
        for (int p = i - 3; p <= i + 3; p++)
            if (p >= 0 && p < 7)
                image->points[image->point_count++] = (uint32_t)p;
        assert_int_equal(orl_names_add(NULL, train, image->name), ORL_OK);
    }
}

static void clusters_are_equal_and_take_the_best_helpers(void **state)
{
    struct orl_colmap_model model;
    struct orl_names train, names = {0};
    struct orl_clusters clusters;
    (void)state;
    make_seven(&model, &train);
    assert_int_equal(orl_clusters_make(NULL, &model, &train, 2, &clusters), ORL_OK);
    static const int members[7] = {0, 1, 1, 2, 2, 3, 3};
    // Both members of 1 see the points 0 to 4, which is most, and the first of equals wins.
    static const int owners[7] = {1, 1, 1, 1, 1, 2, 2};
    for (int i = 0; i < 7; i++) {
        assert_int_equal(clusters.member[i], members[i]);
        assert_int_equal(clusters.owner[i], owners[i]);
    }
    // Cameras 5 and 6 see both points of cluster 2, camera 2 one. There is one helper.
    assert_int_equal(orl_clusters_photographs(NULL, &clusters, 2, &names), ORL_OK);
    static const char *const expected[] = {"3.png", "4.png", "5.png"};
    assert_int_equal(names.count, 3);
    for (int i = 0; i < 3; i++)
        assert_string_equal(names.items[i], expected[i]);
    orl_names_finish(&names);
    orl_clusters_finish(&clusters);
    // Camera 2, with four times the focal length, shows point 5 better than 3 and 4 together.
    model.images[2].camera_id = 2;
    assert_int_equal(orl_clusters_make(NULL, &model, &train, 2, &clusters), ORL_OK);
    assert_int_equal(clusters.owner[5], 1);
    assert_int_equal(clusters.owner[6], 2);
    orl_clusters_finish(&clusters);
    orl_names_finish(&train);
    orl_colmap_finish(&model);
}

// Across the longest extent of where they stand, here along x.
static void clusters_part_the_longest_extent(void **state)
{
    struct orl_colmap_model model;
    struct orl_names train;
    struct orl_clusters clusters;
    (void)state;
    make_seven(&model, &train);
    for (int i = 0; i < 7; i++) {
        model.images[i].cam_from_world.t[1] = 0.02 * (3 * i % 7);
        model.images[i].cam_from_world.t[2] = 0.01 * (5 * i % 7);
    }
    assert_int_equal(orl_clusters_make(NULL, &model, &train, 4, &clusters), ORL_OK);
    for (int i = 0; i < 7; i++)
        assert_int_equal(clusters.member[i], i >= 3);
    orl_clusters_finish(&clusters);
    orl_names_finish(&train);
    orl_colmap_finish(&model);
}

static void points_are_kept_once(void **state)
{
    struct orl_colmap_model model;
    struct orl_names train;
    struct orl_clusters clusters;
    size_t sum = 0;
    (void)state;
    make_row(&model, &train);
    assert_int_equal(orl_clusters_make(NULL, &model, &train, 3, &clusters), ORL_OK);
    for (int c = 0; c < 3; c++) {
        struct orl_points points;
        assert_int_equal(orl_points_init(NULL, &points, 100), ORL_OK);
        for (int i = 0; i < 100; i++)
            points.position[i][0] = 0.1f * (float)i, points.position[i][2] = 5.1f;
        assert_int_equal(orl_clusters_keep_own(NULL, &clusters, c, &points), ORL_OK);
        for (size_t i = 0; i < points.count; i++)
            assert_true(c == 0   ? points.position[i][0] < 3.55f
                        : c == 1 ? points.position[i][0] > 3.45f && points.position[i][0] < 6.55f
                                 : points.position[i][0] > 6.45f);
        sum += points.count;
        orl_points_finish(&points);
    }
    assert_int_equal(sum, 100);
    orl_clusters_finish(&clusters);
    orl_names_finish(&train);
    orl_colmap_finish(&model);
}

// A hundred photographs of 0.8 megapixels.
enum { COUNT = 100, PIXELS = 1000 * 800 };

static void make_hundred(struct orl_colmap_model *model, struct orl_names *names)
{
    *model = (struct orl_colmap_model){
        .cameras = calloc(1, sizeof *model->cameras), .camera_count = 1,
        .images = calloc(COUNT, sizeof *model->images), .image_count = COUNT};
    *names = (struct orl_names){0};
    model->cameras[0].id = 1;
    model->cameras[0].pinhole = (struct orl_camera){1000, 800, 900, 900, 500, 400};
    for (int i = 0; i < COUNT; i++) {
        char name[16];
        snprintf(name, sizeof name, "%d.png", i);
        model->images[i] = (struct orl_colmap_image){.name = strdup(name), .camera_id = 1};
        assert_int_equal(orl_names_add(NULL, names, name), ORL_OK);
    }
}

// 32 MiB, and 20 bytes for each pixel.
static void clusters_follow_the_memory(void **state)
{
    const double mpx = PIXELS, program = 32 << 20, photo = 20 * mpx;
    struct orl_colmap_model model;
    struct orl_names names;
    size_t size;
    (void)state;
    make_hundred(&model, &names);
    assert_true(orl_fuse_pixels(&model, &names) == COUNT * mpx);
    const struct { double bytes; size_t most, size; } expected[] = {
        {program + photo * 100, 400, 100},     // all at once
        {program + photo * 100, 60, 60},       // 60 and 30 helpers fit
        {program + photo * 100 - 1, 400, 50},  // two clusters of 50 and 25 helpers
        {program + photo * 75 - 1, 400, 34},   // three of 34 and 17
        {program + photo * 51 - 1, 400, 25},   // four of 25 and 13
        {photo, 400, 8},                       // 13 of 8: no fewer than that
    };
    for (size_t i = 0; i < sizeof expected / sizeof *expected; i++) {
        assert_int_equal(orl_fuse_plan_size(NULL, &model, &names, expected[i].most,
                                            expected[i].bytes, &size), ORL_OK);
        assert_int_equal(size, expected[i].size);
    }
    // Normals take 24 bytes a pixel while they are read.
    assert_int_equal(orl_fuse_at_once(100 * mpx, 100, photo), 26);
    assert_int_equal(orl_fuse_at_once(100 * mpx, 100, program + photo * 100), 26);
    assert_int_equal(orl_fuse_at_once(100 * mpx, 100, program + photo * 100 + 24 * mpx * 3), 29);
    assert_int_equal(orl_fuse_at_once(2 * mpx, 2, program + photo * 2), 1);
    orl_names_finish(&names);
    orl_colmap_finish(&model);
}

// The size that a run of the job chooses with `max_ram_bytes` (0: not given).
static size_t choose(struct orl_job *job, size_t max_ram_bytes)
{
    struct orl_prepare_params params = {.max_ram_bytes = max_ram_bytes};
    struct orl_colmap_model model;
    struct orl_names names;
    size_t size = 0;
    make_hundred(&model, &names);
    job->params = &params;
    assert_int_equal(orl_fuse_choose(job, &model, &names, &size), ORL_OK);
    job->params = NULL;
    orl_names_finish(&names);
    orl_colmap_finish(&model);
    return size;
}

// Whatever memory is free in a run that goes on, its clusters are those of the run before.
static void a_run_that_goes_on_keeps_its_clusters(void **state)
{
    const size_t little = (size_t)10 * PIXELS;
    char *dir = test_dir_make(), *work = test_path(dir, ".oriel");
    char *records = test_path(work, "stages.json");
    struct orl_job job = {.dir = dir, .lock_fd = -1, .stages = json_object(), .keys = {
        [ORL_STAGE_FUSE] = "these photographs"}};
    (void)state;
    assert_int_equal(orl_dir_make(NULL, work), ORL_OK);
    size_t all = choose(&job, (size_t)1 << 40);
    assert_int_equal(all, COUNT);
    assert_int_equal(choose(&job, little), 8); // --max-ram asks for another choice
    // The next run reads the records from the file.
    json_decref(job.stages);
    assert_int_equal(orl_json_read(NULL, records, &job.stages), ORL_OK);
    assert_int_equal(choose(&job, 0), 8);
    // Other photographs or settings, and records that were changed: nothing is kept. The choice is
    // that of the memory that is free, whose least is 8.
    static const struct { const char *key; int size; } bad[] = {
        {"these photographs", 0}, {"these photographs", -3}, {"these photographs", 401},
        {"others", 5}};
    for (size_t i = 0; i < sizeof bad / sizeof *bad; i++) {
        json_object_set_new(job.stages, "fusion", json_pack("{s:s, s:i}", "key", bad[i].key,
                                                            "cluster_size", bad[i].size));
        size_t size = choose(&job, 0);
        assert_true(size >= 8 && size <= COUNT);
        assert_int_equal(choose(&job, 0), size);
    }
    json_decref(job.stages);
    free(records);
    free(work);
    test_dir_remove(dir);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(each_photograph_and_point_has_one_cluster),
        cmocka_unit_test(neighbours_help_and_held_out_photographs_do_not),
        cmocka_unit_test(clusters_are_equal_and_take_the_best_helpers),
        cmocka_unit_test(clusters_part_the_longest_extent),
        cmocka_unit_test(points_are_kept_once),
        cmocka_unit_test(clusters_follow_the_memory),
        cmocka_unit_test(a_run_that_goes_on_keeps_its_clusters),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
