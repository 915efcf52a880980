// Levels of detail: what is written is read again, level by level; damaged files.
#include <math.h>
#include <stdlib.h>
#include <string.h>
#include <xxhash.h>

#include "scene/point_lod_internal.h"
#include "scene/point_parts.h"
#include "test.h"

static char *dir, *ply, *file;

static int set_up(void **state)
{
    (void)state;
    file = NULL;
    if (test_file_make("points.ply", &dir, &ply) != 0)
        return -1;
    file = orl_path_join(NULL, dir, ORL_LOD_NAME);
    return file ? 0 : -1;
}

static int tear_down(void **state)
{
    (void)state;
    enum orl_result result = orl_dir_remove(NULL, dir);
    free(dir);
    free(ply);
    free(file);
    return result == ORL_OK ? 0 : -1;
}

enum { ROW = 300, COUNT = ROW * ROW };

// A wall of points at z = 2, a unit apart, whose colour tells where they are.
static void write_wall(float radius)
{
    struct orl_points wall;
    assert_int_equal(orl_points_init(NULL, &wall, COUNT), ORL_OK);
    for (size_t i = 0; i < COUNT; i++) {
        size_t at = i * 7919 % COUNT; // in no order
        wall.position[i][0] = (float)(at % ROW);
        wall.position[i][1] = (float)(at / ROW);
        wall.position[i][2] = 2;
        wall.normal[i][2] = -1;
        wall.radius[i] = radius;
        wall.color[i][0] = (uint8_t)(at % ROW / 2);
        wall.color[i][1] = (uint8_t)(at / ROW / 2);
    }
    assert_int_equal(orl_points_write(NULL, ply, &wall, false, NULL), ORL_OK);
    orl_points_finish(&wall);
}

static struct orl_lod *write_and_open(const struct orl_lod_params *params)
{
    struct orl_lod *lod = NULL;
    assert_int_equal(orl_lod_write(NULL, NULL, params, ply, file), ORL_OK);
    assert_int_equal(orl_lod_open(NULL, file, &lod), ORL_OK);
    return lod;
}

static void all_points_come_back(void **state)
{
    (void)state;
    // Least memory: the wall is sorted in several parts.
    static const struct orl_lod_params params = {ORL_LOD_DEFAULTS, .max_bytes = 1};
    static bool seen[COUNT];
    write_wall(0.75f);
    struct orl_lod *lod = write_and_open(&params);
    struct orl_points points;
    assert_int_equal(lod->points, COUNT);
    assert_int_equal(orl_lod_sample(lod, SIZE_MAX, &points), ORL_OK);
    assert_int_equal(points.count, COUNT);
    memset(seen, 0, sizeof seen);
    for (size_t i = 0; i < points.count; i++) {
        const float *p = points.position[i];
        long x = lrintf(p[0]), y = lrintf(p[1]);
        assert_between(x, 0, ROW - 1);
        assert_between(y, 0, ROW - 1);
        assert_float_equal(p[0], x, 0.75 / 32); // half of the largest step
        assert_float_equal(p[1], y, 0.75 / 32);
        assert_float_equal(p[2], 2, 0.75 / 32);
        assert_float_equal(points.normal[i][2], -1, 1e-3);
        assert_float_equal(points.radius[i], 0.75, 0.02);
        assert_int_equal(points.color[i][0], x / 2);
        assert_int_equal(points.color[i][1], y / 2);
        assert_false(seen[y * ROW + x]);
        seen[y * ROW + x] = true;
    }
    orl_points_finish(&points);
    orl_lod_close(&lod);
}

// The largest distance from a place on the wall to the nearest point, in a few places.
static float widest_gap(const struct orl_points *points)
{
    float widest = 0;
    for (int k = 0; k < 400; k++) {
        float x = (float)(k % 20 * 15), y = (float)(k / 20 * 15), nearest = INFINITY;
        for (size_t i = 0; i < points->count; i++)
            nearest = fminf(nearest, hypotf(points->position[i][0] - x,
                                            points->position[i][1] - y));
        widest = fmaxf(widest, nearest);
    }
    return widest;
}

static void coarser_levels_cover_the_same(void **state)
{
    (void)state;
    static const struct orl_lod_params params = {ORL_LOD_DEFAULTS};
    write_wall(0.75f);
    struct orl_lod *lod = write_and_open(&params);
    assert_int_equal(lod->level_count, 3); // 11 pages, 2 and 1
    size_t most = COUNT;
    double area = COUNT * 0.75 * 0.75;
    for (int level = 1; level < lod->level_count; level++) {
        struct orl_points points;
        double covered = 0;
        most = (size_t)lod->levels[level].count * ORL_LOD_BLOCKS * ORL_BLOCK_POINTS;
        assert_int_equal(orl_lod_sample(lod, most, &points), ORL_OK);
        for (size_t i = 0; i < points.count; i++)
            covered += (double)points.radius[i] * (double)points.radius[i];
        print_message("level %d: %zu points, gap %.2f, area %.3f\n", level, points.count,
                      (double)widest_gap(&points), covered / area);
        assert_between(points.count, (size_t)(COUNT >> 3 * level) * 9 / 10,
                       (size_t)(COUNT >> 3 * level) * 12 / 10);
        // An eighth of the points is spread evenly: no hole is much larger than their spacing.
        assert_true(widest_gap(&points) < 2.5 * pow(8, level / 2.0));
        assert_float_equal(covered / area, 1, 0.1);
        orl_points_finish(&points);
    }
    orl_lod_close(&lod);
}

static void pages_are_a_tree(void **state)
{
    (void)state;
    static const struct orl_lod_params params = {ORL_LOD_DEFAULTS};
    write_wall(0.75f);
    struct orl_lod *lod = write_and_open(&params);
    static bool reached[64];
    memset(reached, 0, sizeof reached);
    assert_between(lod->page_count, 3, 64);
    for (size_t page = lod->levels[1].first; page < lod->page_count; page++) {
        size_t first, count;
        assert_true(orl_lod_children(lod, page, &first, &count) > 0);
        assert_between(count, 1, ORL_LOD_CHILDREN);
        for (size_t c = first; c < first + count; c++) {
            assert_false(reached[c]);
            reached[c] = true;
            // A parent has a part of each child, within its bounds.
            for (int k = 0; k < 3; k++)
                assert_true(fabsf(lod->pages[c].middle[k] - lod->pages[page].middle[k]) <=
                            lod->pages[page].extent[k] + lod->pages[c].extent[k] + 1e-3f);
        }
    }
    for (size_t page = 0; page + 1 < lod->page_count; page++)
        assert_true(reached[page]);
    orl_lod_close(&lod);
}

static void radii_are_found_where_there_are_none(void **state)
{
    (void)state;
    static const struct orl_lod_params params = {ORL_LOD_DEFAULTS};
    struct orl_points points;
    write_wall(0);
    struct orl_lod *lod = write_and_open(&params);
    assert_int_equal(orl_lod_sample(lod, SIZE_MAX, &points), ORL_OK);
    assert_int_equal(points.count, COUNT);
    size_t near = 0; // the sixth neighbour on a grid is a diagonal away
    for (size_t i = 0; i < points.count; i++)
        near += fabsf(points.radius[i] - sqrtf(2)) < 0.05f;
    assert_true(near > COUNT * 98 / 100);
    orl_points_finish(&points);
    orl_lod_close(&lod);
}

// A hilly ground without radii or normals, denser towards one side, with points above it here and
// there, whose colour is their number. Written in no order, with a few that coincide.
static void make_ground(struct orl_points *ground)
{
    enum { SIDE = 600, POINTS = SIDE * SIDE };
    uint32_t random = 1;
    assert_int_equal(orl_points_init(NULL, ground, POINTS), ORL_OK);
    for (size_t i = 0; i < POINTS; i++) {
        float to[3];
        for (int k = 0; k < 3; k++) {
            random = random * 1664525u + 1013904223u;
            to[k] = (float)(random >> 8) / (1 << 24);
        }
        float x = 10 * to[0] * to[0], z = 10 * to[1] + 5;
        ground->position[i][0] = x;
        ground->position[i][1] = sinf(x) + cosf(z) + (i % 997 ? 0.01f : -2) * to[2];
        ground->position[i][2] = z;
        for (int k = 0; k < 3; k++)
            ground->color[i][k] = (uint8_t)(i >> 8 * k);
    }
    for (size_t i = 0; i < 40; i++)
        memcpy(ground->position[i], ground->position[0], sizeof ground->position[0]);
}

// In several parts, radii are those that are found with all points in memory, across the borders of
// the parts too, and the same points are dropped.
static void radii_in_parts_are_those_of_the_whole(void **state)
{
    (void)state;
    static const struct orl_view views[2] = {
        {{1024, 768, 700, 700, 512, 384}, {{{1, 0, 0}, {0, 1, 0}, {0, 0, 1}}, {-5, 4, 0}}},
        {{1024, 768, 900, 900, 512, 384}, {{{1, 0, 0}, {0, 1, 0}, {0, 0, 1}}, {-2, 4, -4}}}};
    const struct orl_lod_params params = {ORL_LOD_DEFAULTS, .max_bytes = 1, .views = views,
                                          .view_count = 2};
    struct orl_points ground, parts;
    make_ground(&ground);
    assert_int_equal(orl_points_write(NULL, ply, &ground, false, NULL), ORL_OK);
    struct orl_lod *lod = write_and_open(&params);
    float *expected = calloc(ground.count, sizeof *expected);
    assert_non_null(expected);
    size_t all = ground.count, far = 0;
    assert_int_equal(orl_points_find_radii(NULL, NULL, &params.radii, views, 2, &ground), ORL_OK);
    assert_between(ground.count, all * 9 / 10, all - 1); // some are isolated
    for (size_t i = 0; i < ground.count; i++) {
        const uint8_t *c = ground.color[i];
        expected[c[0] | c[1] << 8 | c[2] << 16] = ground.radius[i];
    }
    assert_int_equal(orl_lod_sample(lod, SIZE_MAX, &parts), ORL_OK);
    assert_int_equal(parts.count, ground.count);
    for (size_t i = 0; i < parts.count; i++) {
        const uint8_t *c = parts.color[i];
        size_t at = (size_t)(c[0] | c[1] << 8 | c[2] << 16);
        assert_true(at < all && expected[at] > 0);
        far += fabsf(parts.radius[i] / expected[at] - 1) > 0.023f; // 16 steps an octave
    }
    print_message("%zu of %zu radii differ\n", far, parts.count);
    assert_true(far <= 200); // those of points that coincide, and of some that stand alone
    free(expected);
    orl_points_finish(&parts);
    orl_points_finish(&ground);
    orl_lod_close(&lod);
}

// Makes the hashes of the first page and of the table fit what a stranger has changed.
static void seal(uint8_t *data, size_t length)
{
    size_t pages = (length - LOD_PAGES_AT) / (sizeof(struct orl_lod_data) + sizeof(struct orl_lod_page));
    struct orl_lod_page *table = (void *)(data + LOD_PAGES_AT + pages * sizeof(struct orl_lod_data));
    table[0].hash = XXH3_64bits(data + LOD_PAGES_AT, sizeof(struct orl_lod_data));
    ((struct lod_header *)(void *)data)->table_hash = XXH3_64bits(table, pages * sizeof *table);
}

static enum orl_result open_changed_file(size_t at, const void *bytes, size_t size, size_t cut,
                                         bool sealed)
{
    uint8_t *data;
    size_t length;
    struct orl_lod *lod = NULL;
    assert_int_equal(orl_file_read(NULL, file, SIZE_MAX / 2, &data, &length), ORL_OK);
    assert_true(at + size <= length && cut < length);
    memcpy(data + at, bytes, size);
    if (sealed)
        seal(data, length);
    char *changed = orl_path_join(NULL, dir, "changed.lod");
    assert_int_equal(orl_file_write(NULL, changed, data, length - cut), ORL_OK);
    enum orl_result result = orl_lod_open(NULL, changed, &lod);
    struct orl_lod_data *page = malloc(sizeof *page);
    assert_non_null(page);
    for (size_t i = 0; result == ORL_OK && i < lod->page_count; i++)
        result = orl_lod_read(lod, i, page);
    free(page);
    orl_lod_close(&lod);
    free(changed);
    free(data);
    return result;
}

static enum orl_result open_changed(size_t at, const void *bytes, size_t size, size_t cut)
{
    return open_changed_file(at, bytes, size, cut, false);
}

static void damage_is_told(void **state)
{
    (void)state;
    static const struct orl_lod_params params = {ORL_LOD_DEFAULTS};
    static const uint32_t many = 1000000;
    static const float nan = NAN, crowd = 129;
    write_wall(0.75f);
    struct orl_lod *lod = write_and_open(&params);
    size_t pages = lod->page_count;
    orl_lod_close(&lod);
    assert_int_equal(open_changed(0, "", 0, 0), ORL_OK);
    assert_int_equal(open_changed(0, "PLY", 3, 0), ORL_ERR_FORMAT);
    assert_int_equal(open_changed(8, &many, 4, 0), ORL_ERR_FORMAT);  // points of a block
    assert_int_equal(open_changed(20, &many, 4, 0), ORL_ERR_FORMAT); // levels
    assert_int_equal(open_changed(32, &many, 4, 0), ORL_ERR_FORMAT); // pages
    assert_int_equal(open_changed(0, "", 0, 1), ORL_ERR_FORMAT);     // cut off
    size_t table = 4096 + pages * sizeof(struct orl_lod_data);
    assert_int_equal(open_changed(table + 5, "?", 1, 0), ORL_ERR_FORMAT);
    assert_int_equal(open_changed(24, &many, 4, 0), ORL_ERR_FORMAT); // points
    assert_int_equal(open_changed(4096 + 94208 / 2, "?", 1, 0), ORL_ERR_FORMAT); // a position
    assert_int_equal(open_changed(table - 2, "?", 1, 0), ORL_ERR_FORMAT); // a colour
    assert_int_equal(open_changed_file(4096, "", 0, 0, true), ORL_OK);
    assert_int_equal(open_changed_file(4096 + 4, &nan, 4, 0, true), ORL_ERR_FORMAT); // a centre
    assert_int_equal(open_changed_file(4096 + 28, &crowd, 4, 0, true), ORL_ERR_FORMAT); // points
}

// Writes a wall of points of which most lie in a square of this size, and sorts it into parts of the least memory.
static void crowd(float square, struct said *said, struct point_parts *parts)
{
    struct orl_points wall;
    struct orl_log log = log_to(said);
    assert_int_equal(orl_points_init(NULL, &wall, COUNT), ORL_OK);
    for (size_t i = 0; i < COUNT; i++) {
        float scale = i % 10 ? square / ROW : 1;
        wall.position[i][0] = scale * (float)(i % ROW);
        wall.position[i][1] = scale * (float)(i / ROW);
    }
    assert_int_equal(orl_points_write(NULL, ply, &wall, false, NULL), ORL_OK);
    orl_points_finish(&wall);
    assert_int_equal(orl_point_parts_make(&log, NULL, ply, file, 1, parts), ORL_OK);
}

static void parts_fit_wherever_points_crowd(void **state)
{
    (void)state;
    struct said said;
    struct point_parts parts;
    size_t total = 0, largest = 0;
    crowd(12, &said, &parts);
    for (size_t i = 0; i < parts.count; i++) {
        size_t own = orl_point_parts_own(&parts, i);
        assert_between(own, 1, orl_point_parts_max(1));
        total += own;
    }
    assert_int_equal(total, COUNT);
    assert_int_equal(parts.total, COUNT);
    assert_null(strstr(said.text, "lie so close together"));
    orl_point_parts_finish(&parts);
    // Points at one place cannot be parted.
    crowd(0, &said, &parts);
    for (size_t i = 0; i < parts.count; i++)
        largest = orl_point_parts_own(&parts, i) > largest ? orl_point_parts_own(&parts, i) : largest;
    assert_between(largest, COUNT * 9 / 10, COUNT);
    assert_int_equal(parts.total, COUNT);
    assert_non_null(strstr(said.text, "lie so close together"));
    orl_point_parts_finish(&parts);
}

static size_t count_files(void)
{
    struct orl_names names;
    assert_int_equal(orl_dir_list(NULL, dir, &names), ORL_OK);
    size_t count = names.count;
    orl_names_finish(&names);
    return count;
}

static void odd_clouds_are_refused(void **state)
{
    (void)state;
    static const struct orl_lod_params params = {ORL_LOD_DEFAULTS};
    static const char text[] = "ply\nformat ascii 1.0\nelement vertex 1\nproperty float x\n"
                               "property float y\nproperty float z\nend_header\n1 2 3\n";
    static const char none[] = "ply\nformat binary_little_endian 1.0\nelement vertex 0\n"
                               "property float x\nproperty float y\nproperty float z\nend_header\n";
    static const char cut[] = "ply\nformat binary_little_endian 1.0\nelement vertex 9\n"
                              "property float x\nproperty float y\nproperty float z\nend_header\n"
                              "abcdefgh";
    write_wall(0.75f);
    size_t before = count_files();
    assert_int_equal(orl_file_write(NULL, ply, text, sizeof text - 1), ORL_OK);
    assert_int_equal(orl_lod_write(NULL, NULL, &params, ply, file), ORL_ERR_UNSUPPORTED);
    assert_int_equal(orl_file_write(NULL, ply, none, sizeof none - 1), ORL_OK);
    assert_int_equal(orl_lod_write(NULL, NULL, &params, ply, file), ORL_ERR_DATA);
    assert_int_equal(orl_file_write(NULL, ply, cut, sizeof cut - 1), ORL_OK);
    assert_int_equal(orl_lod_write(NULL, NULL, &params, ply, file), ORL_ERR_FORMAT);
    assert_int_equal(count_files(), before); // none is added, whole or in part
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(all_points_come_back),
        cmocka_unit_test(coarser_levels_cover_the_same),
        cmocka_unit_test(pages_are_a_tree),
        cmocka_unit_test(radii_are_found_where_there_are_none),
        cmocka_unit_test(radii_in_parts_are_those_of_the_whole),
        cmocka_unit_test(parts_fit_wherever_points_crowd),
        cmocka_unit_test(damage_is_told),
        cmocka_unit_test(odd_clouds_are_refused),
    };
    return cmocka_run_group_tests_name("point_lod", tests, set_up, tear_down);
}
