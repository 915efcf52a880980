// The chart's arithmetic: fronts, sentences, means over scenes.
#include "test.h"

#include <jansson.h>
#include <math.h>

#include "eval/chart_front.h"
#include "eval/chart_internal.h"

static void front_of_known_points(void **state)
{
    (void)state;
    struct orl_chart_point points[] = {
        {"a", "", 10, 20, (double)NAN, false, 0},       // the fastest
        {"b", "", 20, 19, (double)NAN, false, 0},       // slower and worse than a
        {"c", "", 30, 25, (double)NAN, false, 0},       // on the front
        {"c", "x=1", 40, 25, (double)NAN, false, 0},    // as good as c, slower
        {"d", "", 100, 30, (double)NAN, false, 0},      // the best
        {"d", "x=1", 100, 29.5, (double)NAN, false, 0}, // as slow as d, worse
        {"e", "", (double)NAN, 40, (double)NAN, false, 0}}; // its time is not known
    static const bool front[] = {true, false, true, false, true, false, false};
    static const int by[] = {-1, 0, -1, 2, -1, 4, -1};
    orl_chart_find_front(points, ORL_COUNT(points));
    for (size_t i = 0; i < ORL_COUNT(points); i++) {
        assert_int_equal(points[i].on_front, front[i]);
        assert_int_equal(points[i].dominated_by, by[i]);
    }
    char text[ORL_CHART_SENTENCE_MAX];
    orl_chart_sentence(points, ORL_COUNT(points), 2, text);
    assert_string_equal(text, "c: 25.00 dB at 30 ms a frame. Nothing charted is both faster and "
                              "better. The next faster, a, takes 0.33 of its time for 5.00 dB "
                              "less. The next better, d, gains 5.00 dB for 3.33 times its time.");
    orl_chart_sentence(points, ORL_COUNT(points), 1, text);
    assert_string_equal(text, "b: 19.00 dB at 20 ms a frame. Here a is "
                              "1.00 dB better in 0.50 of its time.");
    orl_chart_sentence(points, ORL_COUNT(points), 3, text);
    assert_non_null(strstr(text, "c is 0.00 dB better in 0.75 of its time. On the front it is "
                                 "with"));
    orl_chart_sentence(points, ORL_COUNT(points), 6, text);
    assert_non_null(strstr(text, "a time that is not known"));
    // What covered pixels tell stands beside it: most of a difference may be of the background.
    points[0].covered_db = 27;
    points[1].covered_db = 26.5;
    orl_chart_sentence(points, ORL_COUNT(points), 1, text);
    assert_string_equal(text, "b: 19.00 dB (covered 26.50) at 20 ms a frame. Here "
                              "a is 1.00 dB (covered 0.50) better in 0.50 of its time.");
}

// The best of several that are faster and better.
static void dominated_by_the_best(void **state)
{
    (void)state;
    struct orl_chart_point points[] = {{"a", "", 10, 22, (double)NAN, false, 0},
                                       {"b", "", 20, 20, (double)NAN, false, 0},
                                       {"c", "", 15, 25, (double)NAN, false, 0}};
    orl_chart_find_front(points, 3);
    assert_int_equal(points[1].dominated_by, 2);
    struct orl_chart_point same[] = {{"a", "", 10, 22, (double)NAN, false, 0}, {"b", "", 10, 22, (double)NAN, false, 0}};
    orl_chart_find_front(same, 2);
    assert_true(same[0].on_front && same[1].on_front);
}

static json_t *row(const char *scene, const char *method, double db, double ms)
{
    return json_pack("{s:s, s:s, s:s, s:b, s:{s:f}, s:f, s:f, s:I}", "scene", scene, "method",
                     method, "setting", "", "peer", false, "mean", "psnr_db", db, "frame_ms", ms,
                     "flicker", 1.0, "device_bytes", (json_int_t)1000);
}

static const json_t *find(const json_t *rows, const char *method)
{
    for (size_t i = 0; i < json_array_size(rows); i++)
        if (strcmp(json_string_value(json_object_get(json_array_get(rows, i), "method")),
                   method) == 0)
            return json_array_get(rows, i);
    return NULL;
}

static double number(const json_t *object, const char *key)
{
    return json_number_value(json_object_get(object, key));
}

static void means_over_scenes(void **state)
{
    (void)state;
    json_t *root = json_pack("{s:[{s:s}, {s:s}], s:[o, o, o, o, o]}", "scenes", "name", "one",
                             "name", "two", "rows", row("one", "a", 20, 10),
                             row("one", "b", 30, 40), row("one", "c", 40, 400),
                             row("two", "a", 24, 90), row("two", "b", 22, 160));
    assert_int_equal(orl_chart_analyse(NULL, root), ORL_OK);
    const json_t *overall = json_object_get(root, "overall"), *a = find(overall, "a");
    assert_int_equal(json_array_size(overall), 2); // c was not measured everywhere
    assert_float_equal(number(json_object_get(a, "mean"), "psnr_db"), 22, 1e-9);
    assert_float_equal(number(json_object_get(a, "sd"), "psnr_db"), 2, 1e-9);
    assert_float_equal(number(a, "frame_ms"), 30, 1e-9); // geometric
    assert_float_equal(number(a, "device_bytes"), 1000, 1e-9);
    assert_true(json_is_null(json_object_get(a, "host_peak_bytes")));
    assert_true(json_is_true(json_object_get(a, "on_front")));
    assert_true(json_is_true(json_object_get(find(overall, "b"), "on_front")));
    // Of scene two alone b is slower and worse; other scenes' rows do not matter.
    const json_t *rows = json_object_get(root, "rows"), *last = json_array_get(rows, 4);
    assert_false(json_is_true(json_object_get(last, "on_front")));
    assert_string_equal(
        json_string_value(json_object_get(json_object_get(last, "dominated_by"), "method")), "a");
    assert_true(json_is_true(json_object_get(json_array_get(rows, 1), "on_front")));
    json_decref(root);
}

static void ids_are_file_names(void **state)
{
    (void)state;
    char id[ORL_ROW_ID_MAX];
    orl_row_id("oriel-fast", "", id);
    assert_string_equal(id, "oriel-fast");
    orl_row_id("oriel", "photographs at 1/2", id);
    assert_string_equal(id, "oriel.photographs-at-1-2");
    orl_row_id("../peer", "x=1", id);
    assert_null(strchr(id, '/'));
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(front_of_known_points),
        cmocka_unit_test(dominated_by_the_best),
        cmocka_unit_test(means_over_scenes),
        cmocka_unit_test(ids_are_file_names),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
