#include "core/json.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "core/file.h"
#include "core/memory.h"
#include "core/text.h"
#include "oriel/image.h"

// TEXT_SHARE: jansson collects a string in a buffer that it doubles, then copies. A buffer that cannot
// grow makes it read past its end, or abort (jansson 2.14), so that its memory must be there before.
enum { TEXT_SHARE = 8 };

enum orl_result orl_json_parse(const struct orl_log *log, const char *path, const void *text,
                               size_t size, json_t **out)
{
    json_error_t error;
    size_t mark = orl_utf8_mark_length(text, size);
    *out = NULL;
    if (orl_is_utf16(text, size))
        return orl_fail(log, ORL_ERR_FORMAT, "%s: is UTF-16: save it as UTF-8", path);
    if (size > orl_memory_available() / TEXT_SHARE)
        return orl_fail(log, ORL_ERR_MEMORY, "%s: %zu bytes of JSON are more than the memory left "
                        "can hold", path, size);
    *out = json_loadb((const char *)text + mark, size - mark, JSON_REJECT_DUPLICATES, &error);
    return *out ? ORL_OK
                : orl_fail(log, ORL_ERR_FORMAT, "%s: line %d (byte %d): %s", path, error.line,
                           error.position, error.text);
}

enum orl_result orl_json_load(const struct orl_log *log, const char *path, size_t most, json_t **out)
{
    *out = NULL;
    uint8_t *data = NULL;
    size_t size;
    enum orl_result result = orl_file_read(log, path, most, &data, &size);
    ORL_THEN(result, orl_json_parse(log, path, data, size, out));
    free(data);
    return result;
}

enum orl_result orl_json_read(const struct orl_log *log, const char *path, json_t **out)
{
    ORL_TRY(orl_json_load(log, path, ORL_JSON_MAX_BYTES, out));
    if (json_is_object(*out))
        return ORL_OK;
    json_decref(*out);
    *out = NULL;
    return orl_fail(log, ORL_ERR_FORMAT, "%s: byte 0: not a JSON object", path);
}

enum orl_result orl_json_write_digits(const struct orl_log *log, const char *path, const json_t *value,
                                      size_t digits)
{
    char *text = json_dumps(value, JSON_INDENT(1) | JSON_REAL_PRECISION(digits));
    if (!text)
        return orl_fail(log, ORL_ERR_MEMORY, "%s: no memory for its text", path);
    enum orl_result result = orl_file_write(log, path, text, strlen(text));
    free(text);
    return result;
}

enum orl_result orl_json_write(const struct orl_log *log, const char *path, const json_t *value)
{
    return orl_json_write_digits(log, path, value, ORL_JSON_DIGITS);
}

json_t *orl_json_string(const char *text)
{
    json_t *string = json_string(text);
    size_t size = 4 * strlen(text) + 1;
    char *shown = string ? NULL : malloc(size); // of a text that is not UTF-8
    if (!shown)
        return string;
    orl_text_escape(text, shown, size);
    string = json_string(shown);
    free(shown);
    return string;
}

enum orl_result orl_json_refuse(const struct orl_json_place *place, const char *key,
                                const char *wanted)
{
    return orl_fail(place->log, ORL_ERR_FORMAT, "%s: %s%s\"%s\" is not %s", place->path,
                    place->what ? place->what : "", place->what ? ": " : "", key, wanted);
}

static enum orl_result refuse_range(const struct orl_json_place *place, const char *key,
                                    const char *wanted, double low, double high)
{
    char text[128];
    snprintf(text, sizeof text, "%s from %g to %g", wanted, low, high);
    return orl_json_refuse(place, key, text);
}

// NULL when the value is absent or null.
static const json_t *find(const json_t *object, const char *key)
{
    const json_t *value = json_object_get(object, key);
    return json_is_null(value) ? NULL : value;
}

static bool is_within(const json_t *value, double low, double high)
{
    double number = json_number_value(value);
    return json_is_number(value) && number >= low && number <= high;
}

enum orl_result orl_json_number(const struct orl_json_place *place, const json_t *object,
                                const char *key, double low, double high, double *value)
{
    const json_t *item = find(object, key);
    if (!item)
        return ORL_OK;
    if (!is_within(item, low, high))
        return refuse_range(place, key, "a number", low, high);
    *value = json_number_value(item);
    return ORL_OK;
}

enum orl_result orl_json_integer(const struct orl_json_place *place, const json_t *object,
                                 const char *key, int low, int high, int *value)
{
    const json_t *item = find(object, key);
    if (!item)
        return ORL_OK;
    if (!json_is_integer(item) || !is_within(item, low, high))
        return refuse_range(place, key, "a whole number", low, high);
    *value = (int)json_integer_value(item);
    return ORL_OK;
}

enum orl_result orl_json_bool(const struct orl_json_place *place, const json_t *object,
                              const char *key, bool *value)
{
    const json_t *item = find(object, key);
    if (!item)
        return ORL_OK;
    if (!json_is_boolean(item))
        return orl_json_refuse(place, key, "true or false");
    *value = json_is_true(item);
    return ORL_OK;
}

enum orl_result orl_json_numbers(const struct orl_json_place *place, const json_t *object,
                                 const char *key, size_t count, double low, double high,
                                 double *values)
{
    const json_t *array = find(object, key);
    if (!array)
        return ORL_OK;
    char wanted[64];
    snprintf(wanted, sizeof wanted, "%zu numbers", count);
    bool good = orl_json_read_numbers(array, count, values);
    for (size_t i = 0; good && i < count; i++)
        good = values[i] >= low && values[i] <= high;
    return good ? ORL_OK : refuse_range(place, key, wanted, low, high);
}

bool orl_json_read_numbers(const json_t *array, size_t count, double *values)
{
    if (!json_is_array(array) || json_array_size(array) != count)
        return false;
    for (size_t i = 0; i < count; i++) {
        const json_t *item = json_array_get(array, i);
        values[i] = json_number_value(item);
        if (!json_is_number(item) || !isfinite(values[i]))
            return false;
    }
    return true;
}

bool orl_json_rows(const json_t *array, size_t rows, size_t columns, double *values)
{
    bool good = json_is_array(array) && json_array_size(array) == rows;
    for (size_t i = 0; good && i < rows; i++)
        good = orl_json_read_numbers(json_array_get(array, i), columns, values + i * columns);
    return good;
}

bool orl_json_pose(const json_t *array, struct orl_pose *pose)
{
    double rows[3][4];
    if (!orl_json_rows(array, 3, 4, &rows[0][0]))
        return false;
    for (int i = 0; i < 3; i++) {
        memcpy(pose->r[i], rows[i], sizeof pose->r[i]);
        pose->t[i] = rows[i][3];
    }
    return true;
}

int orl_json_side(const json_t *object, const char *key)
{
    json_int_t side = json_integer_value(json_object_get(object, key));
    return side >= 1 && side <= ORL_IMAGE_MAX_SIDE ? (int)side : 0;
}

double orl_json_value(const json_t *object, const char *key)
{
    return json_number_value(json_object_get(object, key));
}

const char *orl_json_text(const json_t *object, const char *key)
{
    return json_string_value(json_object_get(object, key));
}
