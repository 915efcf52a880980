// Command lines by the rows of a table, and records of their values.
#include "test.h"

#include <string.h>

#include "core/arguments.h"

#define COLORS(NAME) NAME(RED, "red") NAME(GREEN, "green")
enum color { COLORS(ORL_ENUMERATOR) };

static const char *shape_name(size_t index)
{
    static const char *const names[] = {"round", "square", NULL};
    return names[index];
}

#define TRY_OPTIONS(ROW) \
    ROW(flag, "flag", FLAG, "a flag") \
    ROW(text, "text", TEXT("TEXT"), "a text") \
    ROW(path, "path", PATH("DIR"), "a folder") \
    ROW(out, "out", NEEDED("DIR"), "where to", "-") \
    ROW(whole, "whole", INT(11, -5, 10, "N"), "a whole number", "paint=whole") \
    ROW(number, "number", NUMBER(0.5, 0, 1, "X"), "a number", "paint?number dry?amount") \
    ROW(seed, "seed", SEED, "of chance", "paint=seed") \
    ROW(memory, "memory", MIB(1 << 20), "memory", "paint=bytes") \
    ROW(size, "size", SIZE, "a size") \
    ROW(list, "list", LIST("A,B"), "a list") \
    ROW(color, "color", CHOICE(color, COLORS, GREEN, "NAME"), "a colour", "paint?color dry=color") \
    ROW(maybe, "maybe", MAYBE(COLORS, "NAME"), "a colour or none") \
    ROW(shape, "shape", NAMED(shape_name, 1, "NAME"), "a shape") \
    ROW(part, "part", PART, "a part") \
    ROW(block, "block", BLOCK, "a block")
struct try {
    TRY_OPTIONS(ORL_OPTION_MEMBER)
};
static ORL_OPTION_ROWS(try_rows, try, TRY_OPTIONS)
static const struct try usual = {TRY_OPTIONS(ORL_OPTION_PRESET)};

#define OTHER_OPTIONS(ROW) ROW(loud, "loud", FLAG, "say more")
struct other {
    OTHER_OPTIONS(ORL_OPTION_MEMBER)
};
static ORL_OPTION_ROWS(other_rows, other, OTHER_OPTIONS)

struct values {
    struct try try;
    struct other other;
    const char *positionals[2];
    size_t positional_count;
};

static enum orl_result parse_words(struct values *v, int count, const char *const *words)
{
    const struct orl_option_set sets[] = {{try_rows(), &v->try}, {other_rows(), &v->other}, {0}};
    return orl_arguments_parse(NULL, "try", sets, count, words, 2, v->positionals,
                               &v->positional_count);
}
#define PARSE(v, ...) \
    parse_words(v, (int)(sizeof((const char *[]){__VA_ARGS__}) / sizeof(char *)), \
                (const char *[]){__VA_ARGS__})

static void every_kind(void **state)
{
    (void)state;
    struct values v = {.try = usual};
    assert_int_equal(PARSE(&v, "in", "--flag", "--text", "a b", "--whole=-5", "out", "--loud"),
                     ORL_OK);
    assert_true(v.try.flag && v.other.loud);
    assert_string_equal(v.try.text, "a b");
    assert_int_equal(v.try.whole, -5);
    assert_int_equal(v.positional_count, 2);
    assert_string_equal(v.positionals[0], "in");
    assert_string_equal(v.positionals[1], "out");
    assert_int_equal(PARSE(&v, "--number", "0.25", "--size", "640x480", "--seed", "7", "--memory",
                           "3", "--part", "2/3", "--block", "4:9", "--path", "/"), ORL_OK);
    assert_float_equal(v.try.number, 0.25, 0);
    assert_int_equal(v.try.size.width, 640);
    assert_int_equal(v.try.size.height, 480);
    assert_int_equal(v.try.seed, 7);
    assert_int_equal(v.try.memory, 3 << 20);
    assert_int_equal(v.try.part.index, 1);
    assert_int_equal(v.try.part.count, 3);
    assert_int_equal(v.try.block.first, 4);
    assert_int_equal(v.try.block.end, 9);
    assert_string_equal(v.try.path, "/");
}

static void lists(void **state)
{
    (void)state;
    struct values v = {.try = usual};
    assert_int_equal(PARSE(&v, "--list", "a,b", "in", "--list=c,,d,"), ORL_OK);
    assert_int_equal(v.try.list.count, 4);
    assert_string_equal(v.try.list.items[1], "b");
    assert_string_equal(v.try.list.items[3], "d");
    orl_arguments_finish(try_rows(), &v.try);
    assert_int_equal(v.try.list.count, 0);
}

static void choices(void **state)
{
    (void)state;
    struct values v = {.try = usual};
    assert_int_equal(v.try.color, GREEN);
    assert_int_equal(v.try.maybe, -1);
    assert_int_equal(PARSE(&v, "--color", "red", "--maybe", "green", "--shape", "round"), ORL_OK);
    assert_int_equal(v.try.color, RED);
    assert_int_equal(v.try.maybe, GREEN);
    assert_int_equal(v.try.shape, 0);
    static const char *const wrong[] = {"gree", "greens", "", "red green", " "};
    for (size_t i = 0; i < ORL_COUNT(wrong); i++) {
        assert_int_equal(PARSE(&v, "--color", wrong[i]), ORL_ERR_ARGUMENT);
        assert_int_equal(PARSE(&v, "--shape", wrong[i]), ORL_ERR_ARGUMENT);
    }
    assert_int_equal(v.try.color, RED);
}

static void double_dash_ends_options(void **state)
{
    (void)state;
    struct values v = {.try = usual};
    assert_int_equal(PARSE(&v, "--", "--flag", "--text"), ORL_OK);
    assert_false(v.try.flag);
    assert_string_equal(v.positionals[0], "--flag");
    assert_string_equal(v.positionals[1], "--text");
}

static void wrong_usage(void **state)
{
    (void)state;
    struct values v = {.try = usual};
    assert_int_equal(PARSE(&v, "a", "b", "c"), ORL_ERR_ARGUMENT);
    assert_int_equal(PARSE(&v, "a", "--nonsense"), ORL_ERR_ARGUMENT);
    assert_int_equal(PARSE(&v, "a", "--fla"), ORL_ERR_ARGUMENT); // no abbreviations
    assert_int_equal(PARSE(&v, "a", "--flag=yes"), ORL_ERR_ARGUMENT);
    assert_int_equal(PARSE(&v, "a", "--text"), ORL_ERR_ARGUMENT);
    static const struct {
        const char *option, *values[10];
    } wrong[] = {
        {"--whole", {"11", "-6", "1.5", "x", "", "3x", "nan", "1e99"}},
        {"--number", {"1.01", "-0.1", "inf", "0.5 ", "0,5"}},
        {"--seed", {"-1", "0.5", "1e12", ""}},
        {"--memory", {"0", "-1", "0.5", "1048577"}},
        {"--size", {"640", "640x", "x480", "0x10", "-1x5", "10x20x30", "99999x1"}},
        {"--part", {"0/3", "4/3", "1", "1/", "1/0", "1/2/3", "-1/3"}},
        {"--block", {"3", "3:", "3:3", "5:3", "-1:3", "1:2:3"}},
    };
    for (size_t i = 0; i < ORL_COUNT(wrong); i++)
        for (size_t k = 0; wrong[i].values[k]; k++)
            assert_int_equal(PARSE(&v, wrong[i].option, wrong[i].values[k]), ORL_ERR_ARGUMENT);
    assert_memory_equal(&v.try, &usual, sizeof usual);
}

static void asks_for_what_is_needed(void **state)
{
    (void)state;
    struct try try = usual;
    struct said said;
    const struct orl_log log = log_to(&said);
    assert_int_equal(orl_arguments_check(&log, "try", try_rows(), &try), ORL_ERR_ARGUMENT);
    assert_non_null(strstr(said.text, "try: --out DIR is missing"));
    try.out = "x";
    assert_int_equal(orl_arguments_check(&log, "try", try_rows(), &try), ORL_OK);
}

static void assert_json(json_t *value, const char *expected)
{
    char *text = json_dumps(value, JSON_COMPACT | JSON_SORT_KEYS);
    assert_string_equal(text, expected);
    free(text);
    json_decref(value);
}

// What was given comes back from its record; defaults are recorded, too, and what has none is not.
static void records(void **state)
{
    (void)state;
    struct values v = {.try = usual}, again = {.try = usual};
    json_t *list = json_array();
    orl_arguments_record(list, try_rows(), &v.try);
    assert_json(list, "[\"--number\",\"0.5\",\"--seed\",\"1\",\"--color\",\"green\",\"--shape\","
                      "\"square\"]");
    assert_int_equal(PARSE(&v, "--flag", "--text", "a b", "--whole", "-5", "--number", "0.125",
                           "--seed", "7", "--memory", "3", "--size", "5x6", "--list", "a,b",
                           "--color", "red", "--maybe", "green", "--shape", "round", "--part", "2/3",
                           "--block", "4:9", "--out", "x"), ORL_OK);
    list = json_array();
    orl_arguments_record(list, try_rows(), &v.try);
    const char *words[40];
    size_t count = json_array_size(list);
    assert_true(count < ORL_COUNT(words));
    for (size_t i = 0; i < count; i++)
        words[i] = json_string_value(json_array_get(list, i));
    assert_int_equal(parse_words(&again, (int)count, words), ORL_OK);
    assert_null(again.try.out); // which is never recorded
    json_t *other = json_array();
    orl_arguments_record(other, try_rows(), &again.try);
    assert_true(json_equal(list, other));
    json_decref(other);
    json_decref(list);
    orl_arguments_finish(try_rows(), &v.try);
    orl_arguments_finish(try_rows(), &again.try);
}

// A path is recorded so that it holds in another folder.
static void records_paths(void **state)
{
    (void)state;
    char *dir = test_dir_make(), *round = orl_path_join(NULL, dir, "../");
    struct try try = usual;
    try.path = round;
    json_t *list = json_array();
    orl_arguments_record(list, try_rows(), &try);
    assert_string_equal(json_string_value(json_array_get(list, 0)), "--path");
    assert_null(strstr(json_string_value(json_array_get(list, 1)), ".."));
    json_decref(list);
    free(round);
    test_dir_remove(dir);
}

static void settings(void **state)
{
    (void)state;
    struct values v = {.try = usual};
    json_t *object = json_object();
    orl_arguments_settings(object, try_rows(), &v.try, "paint");
    assert_json(object, "{\"seed\":1}");
    assert_int_equal(PARSE(&v, "--whole", "4", "--number", "0.25", "--memory", "2", "--color",
                           "red"), ORL_OK);
    object = json_object();
    orl_arguments_settings(object, try_rows(), &v.try, "paint");
    struct try again = usual;
    assert_int_equal(orl_arguments_take(NULL, object, try_rows(), &again, "paint"), ORL_OK);
    assert_int_equal(again.whole, 4);
    assert_int_equal(again.color, RED);
    assert_json(object, "{\"bytes\":2097152,\"color\":\"red\",\"number\":0.25,\"seed\":1,"
                        "\"whole\":4}");
    object = json_object();
    orl_arguments_settings(object, try_rows(), &v.try, "dry");
    assert_json(object, "{\"amount\":0.25,\"color\":\"red\"}");
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(every_kind),
        cmocka_unit_test(lists),
        cmocka_unit_test(choices),
        cmocka_unit_test(double_dash_ends_options),
        cmocka_unit_test(wrong_usage),
        cmocka_unit_test(asks_for_what_is_needed),
        cmocka_unit_test(records),
        cmocka_unit_test(records_paths),
        cmocka_unit_test(settings),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
