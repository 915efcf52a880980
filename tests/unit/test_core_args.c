// The command line parser, which is part of the program, not of the library.
#include "test.h"

#include <string.h>
#include <unistd.h>

#include "cli/args.h"

struct values {
    bool flag;
    const char *text;
    int whole;
    double number;
    struct arg_size size;
    struct orl_names list;
    struct arg_enum color;
    struct arg_common common;
    const char *positionals[2];
    size_t positional_count;
};

// Up to 8 words; ended by NULL.
static enum orl_result parse(struct values *v, ...)
{
    const struct arg_option options[] = {
        {"flag", ARG_FLAG, &v->flag, NULL, "a flag", 0, 0},
        {"text", ARG_STRING, &v->text, "TEXT", "a text", 0, 0},
        {"whole", ARG_INT, &v->whole, "N", "a whole number", -5, 10},
        {"number", ARG_NUMBER, &v->number, "X", "a number", 0, 1},
        {"size", ARG_SIZE, &v->size, "WxH", "a size", 0, 0},
        {"list", ARG_LIST, &v->list, "A,B", "a list", 0, 0},
        {"color", ARG_ENUM, &v->color, "NAME", "a colour", 0, 0},
        {0},
    };
    const struct arg_command command = {"try", "IN [OUT]", "Tries.", options, 1, 2};
    static const char *const colors[] = {"red", "green", NULL};
    char *argv[9];
    v->color.names = colors;
    int argc = 0;
    va_list words;
    va_start(words, v);
    for (char *word; (word = va_arg(words, char *));)
        argv[argc++] = word;
    va_end(words);
    return args_parse(NULL, &command, argc, argv, &v->common, v->positionals,
                      &v->positional_count);
}

static void every_type(void **state)
{
    (void)state;
    struct values v = {0};
    assert_int_equal(parse(&v, "in", "--flag", "--text", "a b", "--whole=-5", "out", NULL), ORL_OK);
    assert_true(v.flag);
    assert_string_equal(v.text, "a b");
    assert_int_equal(v.whole, -5);
    assert_int_equal(v.positional_count, 2);
    assert_string_equal(v.positionals[0], "in");
    assert_string_equal(v.positionals[1], "out");
    assert_int_equal(parse(&v, "--number", "0.25", "--size", "640x480", "in", NULL), ORL_OK);
    assert_float_equal(v.number, 0.25, 0);
    assert_int_equal(v.size.width, 640);
    assert_int_equal(v.size.height, 480);
}

static void lists(void **state)
{
    (void)state;
    struct values v = {0};
    assert_int_equal(parse(&v, "--list", "a,b", "in", "--list=c,,d,", NULL), ORL_OK);
    assert_int_equal(v.list.count, 4);
    assert_string_equal(v.list.items[1], "b");
    assert_string_equal(v.list.items[3], "d");
    orl_names_finish(&v.list);
}

static void enums(void **state)
{
    (void)state;
    struct values v = {.color = {NULL, -1}};
    assert_int_equal(parse(&v, "in", NULL), ORL_OK);
    assert_int_equal(v.color.value, -1);
    assert_int_equal(parse(&v, "in", "--color", "green", NULL), ORL_OK);
    assert_int_equal(v.color.value, 1);
    assert_int_equal(parse(&v, "in", "--color=gree", NULL), ORL_ERR_ARGUMENT);
    assert_int_equal(parse(&v, "in", "--color=", NULL), ORL_ERR_ARGUMENT);
    assert_int_equal(v.color.value, 1);
}

static void common_options(void **state)
{
    (void)state;
    struct values v = {0};
    assert_int_equal(parse(&v, "in", "--quiet", "--verbose", "--shader-dir", "d", NULL), ORL_OK);
    assert_true(v.common.quiet && v.common.verbose);
    assert_string_equal(v.common.shader_dir, "d");
    assert_false(v.common.help);
}

static void double_dash_ends_options(void **state)
{
    (void)state;
    struct values v = {0};
    assert_int_equal(parse(&v, "--", "--flag", "--text", NULL), ORL_OK);
    assert_false(v.flag);
    assert_string_equal(v.positionals[0], "--flag");
    assert_string_equal(v.positionals[1], "--text");
}

static void wrong_usage(void **state)
{
    (void)state;
    struct values v = {0};
    assert_int_equal(parse(&v, NULL), ORL_ERR_ARGUMENT); // IN is missing
    assert_int_equal(parse(&v, "a", "b", "c", NULL), ORL_ERR_ARGUMENT);
    assert_int_equal(parse(&v, "a", "--nonsense", NULL), ORL_ERR_ARGUMENT);
    assert_int_equal(parse(&v, "a", "--fla", NULL), ORL_ERR_ARGUMENT); // no abbreviations
    assert_int_equal(parse(&v, "a", "--flag=yes", NULL), ORL_ERR_ARGUMENT);
    assert_int_equal(parse(&v, "a", "--text", NULL), ORL_ERR_ARGUMENT);
    static const char *const wholes[] = {"11", "-6", "1.5", "x", "", "3x", "nan", "1e99"};
    for (size_t i = 0; i < ORL_COUNT(wholes); i++)
        assert_int_equal(parse(&v, "a", "--whole", wholes[i], NULL), ORL_ERR_ARGUMENT);
    static const char *const numbers[] = {"1.01", "-0.1", "inf", "0.5 ", "0,5"};
    for (size_t i = 0; i < ORL_COUNT(numbers); i++)
        assert_int_equal(parse(&v, "a", "--number", numbers[i], NULL), ORL_ERR_ARGUMENT);
    static const char *const sizes[] = {"640", "640x", "x480", "0x10", "-1x5", "10x20x30",
                                        "99999x1"};
    for (size_t i = 0; i < ORL_COUNT(sizes); i++)
        assert_int_equal(parse(&v, "a", "--size", sizes[i], NULL), ORL_ERR_ARGUMENT);
    assert_int_equal(v.whole, 0);
    assert_float_equal(v.number, 0, 0);
    assert_int_equal(v.size.width, 0);
}

// Help goes to stdout, names every option and asks for no positionals.
static void help(void **state)
{
    (void)state;
    char *dir = test_dir_make(), *path = orl_path_join(NULL, dir, "help");
    struct values v = {0};
    fflush(stdout);
    int kept = dup(STDOUT_FILENO);
    FILE *out = fopen(path, "wb");
    assert_int_equal(dup2(fileno(out), STDOUT_FILENO), STDOUT_FILENO);
    enum orl_result result = parse(&v, "--help", NULL);
    fflush(stdout);
    dup2(kept, STDOUT_FILENO);
    close(kept);
    fclose(out);
    assert_int_equal(result, ORL_OK);
    assert_true(v.common.help);
    uint8_t *text;
    size_t size;
    assert_int_equal(orl_file_read(NULL, path, 65536, &text, &size), ORL_OK);
    static const char *const words[] = {"oriel try IN [OUT]", "--flag", "--size WxH", "a list",
                                        "a colour: red, green", "--quiet",
                                        "--shader-dir"};
    for (size_t i = 0; i < ORL_COUNT(words); i++)
        assert_non_null(strstr((char *)text, words[i]));
    free(text);
    free(path);
    test_dir_remove(dir);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(every_type),
        cmocka_unit_test(lists),
        cmocka_unit_test(enums),
        cmocka_unit_test(common_options),
        cmocka_unit_test(double_dash_ends_options),
        cmocka_unit_test(wrong_usage),
        cmocka_unit_test(help),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
