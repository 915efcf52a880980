#include "test.h"

#include "oriel/log.h"
#include "core/json.h"
#include "core/text.h"

static void utf8(void **state)
{
    (void)state;
    const struct {
        const char *text;
        bool valid;
    } rows[] = {
        {"", true}, {"plain", true}, {"caf\xc3\xa9", true}, {"\xe2\x82\xac", true},
        {"\xf0\x9f\x8f\xb0", true}, {"\xf4\x8f\xbf\xbf", true},
        {"caf\xe9", false}, {"\xc0\xaf", false}, {"\xe0\x80\xaf", false}, {"\xed\xa0\x80", false},
        {"\xf4\x90\x80\x80", false}, {"\xf5\x80\x80\x80", false}, {"\xe2\x82", false},
        {"\x80", false},
    };
    for (size_t i = 0; i < ORL_COUNT(rows); i++) {
        char shown[64];
        orl_text_escape(rows[i].text, shown, sizeof shown);
        assert_int_equal(strcmp(shown, rows[i].text) == 0, rows[i].valid);
        json_t *string = orl_json_string(rows[i].text);
        assert_string_equal(json_string_value(string), shown);
        json_decref(string);
    }
}

static void escaping(void **state)
{
    (void)state;
    char out[64], tight[6];
    const char *const rows[][2] = {
        {"caf\xc3\xa9 \xe2\x82\xac\n\t.", "caf\xc3\xa9 \xe2\x82\xac\n\t."},
        {"\x1b[2J\x07\x7f\r", "\\x1b[2J\\x07\\x7f\\x0d"},
        {"\xe9t\xe9", "\\xe9t\\xe9"},
        {"\xc2\x9b" "31m", "\\xc2\\x9b" "31m"}, // the C1 form of ESC [
        {"a\xe2\x80\xaegpj.exe", "a\\xe2\\x80\\xaegpj.exe"}, // U+202E turns what follows
        {"\xe2\x81\xa6|\xe2\x80\x8f|\xd8\x9c", "\\xe2\\x81\\xa6|\\xe2\\x80\\x8f|\\xd8\\x9c"},
        {"\xd8\xa7\xe2\x80\x9c\xe2\x80\x8d", "\xd8\xa7\xe2\x80\x9c\xe2\x80\x8d"}, // letters, quotes, joiners
    };
    for (size_t i = 0; i < ORL_COUNT(rows); i++) {
        orl_text_escape(rows[i][0], out, sizeof out);
        assert_string_equal(out, rows[i][1]);
    }
    orl_text_escape("abcd\xc3\xa9", tight, sizeof tight); // no half characters
    assert_string_equal(tight, "abcd");
    orl_text_escape("ab\x1b", tight, sizeof tight);
    assert_string_equal(tight, "ab");
}

static void logs_cannot_steer_a_terminal(void **state)
{
    (void)state;
    struct said said;
    struct orl_log log = log_to(&said);
    (void)!orl_fail(&log, ORL_ERR_IO, "%s: bad", "evil\x1b]0;title\x07.jpg");
    assert_string_equal(said.text, "evil\\x1b]0;title\\x07.jpg: bad\n");
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(utf8),
        cmocka_unit_test(escaping),
        cmocka_unit_test(logs_cannot_steer_a_terminal),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
