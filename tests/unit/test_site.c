// The point cloud of a published site.
#include "test.h"

#include <math.h>

#include "core/memory.h"
#include "scene/point_code.h"
#include "walk/internal.h"

enum { HEADER = 16, CELL = 44, POINT = 12 };

struct setup {
    char *dir;
    struct orl_log log;
    struct orl_scene scene;
    struct orl_publish_params params;
    struct orl_publish_report report;
    struct site site;
    uint8_t *coarse; // points/coarse.bin, once published
    size_t size;
    uint32_t cells;
};

// A flat square of side 1 with `count` points a side; its right half has radii of 0.04, the rest
// of 0.01.
static void start(struct setup *s, size_t side)
{
    memset(s, 0, sizeof *s);
    s->dir = test_dir_make();
    s->params = (struct orl_publish_params){ORL_PUBLISH_DEFAULTS};
    s->params.title = "square";
    s->site = (struct site){.log = &s->log, .scene = &s->scene, .params = &s->params,
                            .dir = s->dir, .folder = "", .report = &s->report};
    assert_int_equal(orl_points_init(&s->log, &s->scene.points, side * side), ORL_OK);
    for (size_t i = 0; i < side * side; i++) {
        struct orl_points *p = &s->scene.points;
        p->position[i][0] = (float)(i % side) / (float)side;
        p->position[i][1] = (float)(i / side) / (float)side;
        p->position[i][2] = 5;
        p->normal[i][2] = -1;
        p->radius[i] = p->position[i][0] > 0.5f ? 0.04f : 0.01f;
        p->color[i][0] = (uint8_t)(255 * p->position[i][0]);
    }
    assert_int_equal(orl_dir_make(&s->log, ORL_PATH(s->site.dir, "points")), ORL_OK);
}

static void finish(struct setup *s)
{
    free(s->coarse);
    orl_points_finish(&s->scene.points);
    test_dir_remove(s->dir);
}

static uint8_t *read_file(struct setup *s, const char *name, size_t *size)
{
    uint8_t *data = NULL;
    assert_int_equal(orl_file_read(&s->log, ORL_PATH(s->site.dir, "%s", name), 1 << 30, &data, size), ORL_OK);
    return data;
}

static void publish(struct setup *s)
{
    json_t *json = NULL;
    assert_int_equal(orl_site_scene_points(&s->site, &json), ORL_OK);
    json_decref(json);
    s->coarse = read_file(s, "points/coarse.bin", &s->size);
    memcpy(&s->cells, s->coarse + 8, sizeof s->cells);
}

static float word(const uint8_t *cell, int index)
{
    float value;
    memcpy(&value, cell + 4 * index, sizeof value);
    return value;
}

static uint32_t number(const uint8_t *cell, int index)
{
    uint32_t value;
    memcpy(&value, cell + 4 * index, sizeof value);
    return value;
}

static void decode(const uint8_t *cell, const uint8_t *point, float position[3], float *radius)
{
    const struct point_frame frame = {{word(cell, 0), word(cell, 1), word(cell, 2)}, word(cell, 3)};
    const uint32_t geometry[2] = {number(point, 0), number(point, 1)};
    assert_true(orl_point_decode_position(&frame, geometry, position));
    *radius = orl_point_decode_radius(&frame, geometry);
}

// All points come back: from the coarse file and the others, where they were, with their radii
// and colours.
static void test_points_come_back(void **state)
{
    (void)state;
    struct setup s;
    enum { SIDE = 300 };
    start(&s, SIDE);
    publish(&s);
    assert_int_equal(s.report.points, SIDE * SIDE);
    size_t rest_size[2], total = 0;
    const uint8_t *coarse = s.coarse;
    uint8_t *rest[2] = {read_file(&s, "points/0000.bin", &rest_size[0]),
                        read_file(&s, "points/0001.bin", &rest_size[1])};
    assert_int_equal(number(coarse, 3), POINT);
    assert_int_equal(s.cells, (SIDE * SIDE + 4095) / 4096);
    assert_true(s.size < 440 << 10);
    const uint8_t *next = coarse + HEADER + CELL * s.cells;
    uint8_t *seen = orl_array(&s.log, SIDE * SIDE, 1);
    for (uint32_t c = 0; c < s.cells; c++) {
        const uint8_t *cell = coarse + HEADER + CELL * c;
        uint32_t count = number(cell, 7), first = number(cell, 8), file = number(cell, 9);
        for (uint32_t i = 0; i < count; i++) {
            const uint8_t *point = i < first ? next + POINT * i
                                             : rest[file] + POINT * (number(cell, 10) + i - first);
            float p[3], radius;
            decode(cell, point, p, &radius);
            size_t x = (size_t)lrintf(p[0] * SIDE), y = (size_t)lrintf(p[1] * SIDE);
            assert_true(x < SIDE && y < SIDE && fabsf(p[2] - 5) < 1e-4f);
            assert_int_equal(seen[y * SIDE + x], 0);
            seen[y * SIDE + x] = 1;
            float expected = s.scene.points.radius[y * SIDE + x];
            assert_true(fabsf(radius / expected - 1) < 0.01f);
            assert_int_equal(point[8], s.scene.points.color[y * SIDE + x][0]);
        }
        next += POINT * first;
        total += count;
    }
    assert_int_equal(total, SIDE * SIDE);
    assert_int_equal(next - coarse, s.size);
    free(seen);
    free(rest[0]);
    free(rest[1]);
    finish(&s);
}

// Adds a point of a cell to the ninth of the cell's bounds that it lies in.
static void count_ninth(const uint8_t *cell, const uint8_t *point, int counts[9])
{
    float p[3], radius;
    decode(cell, point, p, &radius);
    int x = (int)fminf(2, 3 * (p[0] - word(cell, 0)) / word(cell, 4));
    int y = (int)fminf(2, 3 * (p[1] - word(cell, 1)) / word(cell, 5));
    counts[3 * y + x]++;
}

// A first part of a cell lies all over it: every ninth of its bounds has its share of the cell's
// points.
static void test_first_parts_are_spread(void **state)
{
    (void)state;
    struct setup s;
    start(&s, 256);
    publish(&s);
    size_t size;
    const uint8_t *cell = s.coarse + HEADER, *points = s.coarse + HEADER + CELL * s.cells;
    uint8_t *rest = read_file(&s, "points/0000.bin", &size);
    int some[9] = {0}, all[9] = {0}, first = 90, coarse = (int)number(cell, 8);
    assert_true(coarse >= first);
    for (int i = 0; i < first; i++)
        count_ninth(cell, points + POINT * i, some);
    for (int i = 0; i < (int)number(cell, 7); i++)
        count_ninth(cell, i < coarse ? points + POINT * i : rest + POINT * (i - coarse), all);
    for (int k = 0; k < 9; k++) {
        float share = (float)all[k] * (float)first / (float)number(cell, 7);
        assert_true(fabsf((float)some[k] - share) <= 0.5f * share + 1);
    }
    free(rest);
    finish(&s);
}

// Fewer points cover the same surface: radii grow by the root of the ratio.
static void test_thinned_points_grow(void **state)
{
    (void)state;
    struct setup s;
    start(&s, 256);
    s.params.max_points = 256 * 256 / 4;
    publish(&s);
    assert_int_equal(s.report.points, 256 * 256 / 4);
    const uint8_t *point = s.coarse + HEADER + CELL * s.cells;
    float least = INFINITY, most = 0;
    for (uint32_t c = 0; c < s.cells; c++) {
        const uint8_t *cell = s.coarse + HEADER + CELL * c;
        for (uint32_t i = 0; i < number(cell, 8); i++, point += POINT) {
            float p[3], radius;
            decode(cell, point, p, &radius);
            least = fminf(least, radius);
            most = fmaxf(most, radius);
        }
    }
    assert_true(fabsf(least - 0.02f) < 1e-4f && fabsf(most - 0.08f) < 1e-3f);
    finish(&s);
}

static void test_no_points_is_an_error(void **state)
{
    (void)state;
    struct setup s;
    start(&s, 2);
    s.scene.points.count = 0;
    json_t *json = NULL;
    assert_int_equal(orl_site_scene_points(&s.site, &json), ORL_ERR_DATA);
    finish(&s);
}

// Points at one place, and points that are nowhere.
static void test_degenerate_points(void **state)
{
    (void)state;
    struct setup s;
    start(&s, 100);
    for (size_t i = 0; i < 9000; i++)
        memset(s.scene.points.position[i], 0, sizeof s.scene.points.position[i]);
    for (size_t i = 9000; i < 9100; i++)
        s.scene.points.position[i][1] = NAN;
    publish(&s);
    assert_int_equal(s.report.points, 9900);
    finish(&s);
}

// A walk begins in the middle of a row of photographs, of which every fifth is held out, however many they are.
static void check_start(size_t count)
{
    const struct orl_log log = {0};
    struct orl_scene scene = {.photo_count = count, .photos = orl_array(&log, count, sizeof *scene.photos)};
    size_t start = 0;
    for (size_t i = 0; i < count; i++) {
        struct orl_pose *pose = &scene.photos[i].view.cam_from_world;
        pose->r[0][0] = pose->r[1][1] = pose->r[2][2] = 1;
        orl_pose_set_centre(pose, (double[3]){(double)i, 0, 0});
        scene.photos[i].test = i % 5 == 0;
    }
    assert_int_equal(orl_walk_start(&log, &scene, &start), ORL_OK);
    assert_true(start + 5 > count / 2 && start < count / 2 + 5 && start % 5 != 0);
    free(scene.photos);
}

static void test_start(void **state)
{
    (void)state;
    check_start(11);
    check_start(4500); // of five, one is asked: perhaps those alone that are held out
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_points_come_back),
        cmocka_unit_test(test_first_parts_are_spread),
        cmocka_unit_test(test_thinned_points_grow),
        cmocka_unit_test(test_no_points_is_an_error),
        cmocka_unit_test(test_degenerate_points),
        cmocka_unit_test(test_start),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
