// JSON values are checked as they are read, and errors name file, thing, key and range.
#include <stdio.h>
#include <string.h>
#include <sys/resource.h>
#include <unistd.h>

#include "core/file.h"
#include "core/json.h"
#include "test.h"

static json_t *parsed(const char *text)
{
    json_t *value;
    assert_int_equal(orl_json_parse(NULL, "text", text, strlen(text), &value), ORL_OK);
    return value;
}

static void reads_values(void **state)
{
    (void)state;
    const struct orl_json_place place = {NULL, "f.json", NULL};
    json_t *object = parsed("{\"n\": 2.5, \"i\": 7, \"b\": true, \"a\": [1, -2, 0.5], \"z\": null,"
                            " \"t\": \"text\"}");
    double number = 0, kept = 11, values[3];
    int integer = 0;
    bool truth = false;
    assert_int_equal(orl_json_number(&place, object, "n", 2, 3, &number), ORL_OK);
    assert_float_equal(number, 2.5, 0);
    assert_int_equal(orl_json_integer(&place, object, "i", 7, 7, &integer), ORL_OK);
    assert_int_equal(integer, 7);
    assert_int_equal(orl_json_bool(&place, object, "b", &truth), ORL_OK);
    assert_true(truth);
    assert_int_equal(orl_json_numbers(&place, object, "a", 3, -2, 1, values), ORL_OK);
    assert_float_equal(values[1], -2, 0);
    // What is not told leaves the default.
    assert_int_equal(orl_json_number(&place, object, "missing", 0, 1, &kept), ORL_OK);
    assert_int_equal(orl_json_number(&place, object, "z", 0, 1, &kept), ORL_OK);
    assert_float_equal(kept, 11, 0);
    assert_string_equal(orl_json_text(object, "t"), "text");
    assert_null(orl_json_text(object, "n"));
    json_decref(object);
}

static void refuses_values(void **state)
{
    (void)state;
    struct said said;
    struct orl_log log = log_to(&said);
    const struct orl_json_place place = {&log, "f.json", "photograph a.jpg"};
    json_t *object = parsed("{\"n\": 2.5, \"t\": \"text\", \"a\": [1, 2], \"m\": [1, \"x\", 2],"
                            " \"big\": 4294967297}");
    double number = -1, values[3];
    int integer = -1;
    bool truth = false;
    assert_int_equal(orl_json_number(&place, object, "n", 0, 2, &number), ORL_ERR_FORMAT);
    assert_non_null(strstr(said.text, "f.json: photograph a.jpg: \"n\" is not a number from 0 to 2"));
    assert_float_equal(number, -1, 0);
    assert_int_equal(orl_json_number(&place, object, "t", 0, 2, &number), ORL_ERR_FORMAT);
    assert_int_equal(orl_json_integer(&place, object, "n", 0, 9, &integer), ORL_ERR_FORMAT);
    assert_int_equal(orl_json_integer(&place, object, "big", 0, 9, &integer), ORL_ERR_FORMAT);
    assert_int_equal(orl_json_bool(&place, object, "n", &truth), ORL_ERR_FORMAT);
    assert_int_equal(orl_json_numbers(&place, object, "a", 3, 0, 9, values), ORL_ERR_FORMAT);
    assert_int_equal(orl_json_numbers(&place, object, "m", 3, 0, 9, values), ORL_ERR_FORMAT);
    assert_int_equal(orl_json_numbers(&place, object, "n", 1, 0, 9, values), ORL_ERR_FORMAT);
    json_decref(object);
}

static void refuses_files(void **state)
{
    (void)state;
    struct said said;
    struct orl_log log = log_to(&said);
    char *dir = test_dir_make(), path[4096];
    static const struct {
        const char *text, *says;
    } bad[] = {{"{\"a\": 1,\n x}", "line 2"}, {"[1]", "not a JSON object"}, {"", "line 1"},
               {"{\"a\": 1, \"a\": 2}", "uplicate"}};
    snprintf(path, sizeof path, "%s/bad.json", dir);
    for (size_t i = 0; i < ORL_COUNT(bad); i++) {
        json_t *value = (json_t *)1;
        assert_int_equal(orl_file_write(NULL, path, bad[i].text, strlen(bad[i].text)), ORL_OK);
        assert_int_equal(orl_json_read(&log, path, &value), ORL_ERR_FORMAT);
        assert_null(value);
        assert_non_null(strstr(said.text, path));
        assert_non_null(strstr(said.text, bad[i].says));
    }
    test_dir_remove(dir);
}

// A string whose buffer cannot grow would be read past its end.
static void refuses_what_memory_cannot_hold(void **state)
{
    (void)state;
    enum { SIZE = 24 << 20, ROOM = 64 << 20 };
    char *text = malloc(SIZE);
    assert_non_null(text);
    memset(text, 'a', SIZE);
    memcpy(text, "{\"k\": \"", 7);
    memcpy(text + SIZE - 2, "\"}", 2);
    struct rlimit before, tight;
    assert_int_equal(getrlimit(RLIMIT_AS, &before), 0);
    FILE *file = fopen("/proc/self/statm", "r");
    unsigned long pages = 0;
    assert_true(file && fscanf(file, "%lu", &pages) == 1);
    fclose(file);
    tight = (struct rlimit){.rlim_cur = pages * (rlim_t)sysconf(_SC_PAGE_SIZE) + ROOM,
                            .rlim_max = before.rlim_max};
    json_t *value = NULL;
    assert_int_equal(setrlimit(RLIMIT_AS, &tight), 0);
    enum orl_result result = orl_json_parse(NULL, "text", text, SIZE, &value);
    assert_int_equal(setrlimit(RLIMIT_AS, &before), 0);
    free(text);
    assert_int_equal(result, ORL_ERR_MEMORY);
    assert_null(value);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(reads_values),
        cmocka_unit_test(refuses_values),
        cmocka_unit_test(refuses_files),
        cmocka_unit_test(refuses_what_memory_cannot_hold),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
