// JSON files, and access to their values with checks of type and range.
#ifndef ORL_CORE_JSON_H
#define ORL_CORE_JSON_H

#include <jansson.h>

#include "oriel/camera.h"
#include "oriel/log.h"

// Parses text into a value of any JSON type, released with json_decref. Errors name `path`, the
// line, the byte and the reason.
enum orl_result orl_json_parse(const struct orl_log *log, const char *path, const void *text,
                               size_t size, json_t **out) ORL_CHECK_RESULT;
// Reads a file of at most `most` bytes as orl_json_parse does.
enum orl_result orl_json_load(const struct orl_log *log, const char *path, size_t most,
                              json_t **out) ORL_CHECK_RESULT;
// Reads a JSON object of at most ORL_JSON_MAX_BYTES, released with json_decref.
enum { ORL_JSON_MAX_BYTES = 64 << 20 };
enum orl_result orl_json_read(const struct orl_log *log, const char *path,
                              json_t **out) ORL_CHECK_RESULT;
// Of the numbers in files that are not integers; so many that none changes.
enum { ORL_JSON_DIGITS = 9, ORL_JSON_ALL_DIGITS = 17 };
// Writes indented JSON with keys in order of insertion. The file is written atomically. Without a
// value, memory has run out.
enum orl_result orl_json_write(const struct orl_log *log, const char *path,
                               const json_t *value) ORL_CHECK_RESULT;
// The same with another number of digits.
enum orl_result orl_json_write_digits(const struct orl_log *log, const char *path, const json_t *value,
                                      size_t digits) ORL_CHECK_RESULT;

// A JSON string, which must be UTF-8. Bytes of `text` that are not UTF-8, as file names may have,
// become "\xNN". NULL when memory runs out.
json_t *orl_json_string(const char *text);

// Where values are read from, for error messages of the form PATH: WHAT: "key" is not ...
struct orl_json_place {
    const struct orl_log *log;
    const char *path;
    const char *what; // such as "photograph 0001.jpg"; NULL: the file itself
};
// Logs that `key` is not what `wanted` describes, and returns ORL_ERR_FORMAT.
enum orl_result orl_json_refuse(const struct orl_json_place *place, const char *key,
                                const char *wanted) ORL_CHECK_RESULT;

// Read values of `object`. An absent or null value leaves *value unchanged and counts as success.
// A value of another type or outside the range is refused.
enum orl_result orl_json_number(const struct orl_json_place *place, const json_t *object,
                                const char *key, double low, double high,
                                double *value) ORL_CHECK_RESULT;
enum orl_result orl_json_integer(const struct orl_json_place *place, const json_t *object,
                                 const char *key, int low, int high, int *value) ORL_CHECK_RESULT;
enum orl_result orl_json_bool(const struct orl_json_place *place, const json_t *object,
                              const char *key, bool *value) ORL_CHECK_RESULT;
// Reads an array of exactly `count` numbers.
enum orl_result orl_json_numbers(const struct orl_json_place *place, const json_t *object,
                                 const char *key, size_t count, double low, double high,
                                 double *values) ORL_CHECK_RESULT;

// Copies an array of `count` finite numbers to `values`. False when it is anything else.
bool orl_json_read_numbers(const json_t *array, size_t count, double *values);
// The same of an array of `rows` arrays of `columns` numbers, row by row.
bool orl_json_rows(const json_t *array, size_t rows, size_t columns, double *values);
// The same of 3 rows of 4 numbers.
bool orl_json_pose(const json_t *array, struct orl_pose *cam_from_world);
// A picture's width or height; 0 when the value is missing or not valid.
int orl_json_side(const json_t *object, const char *key);
// The number of `key`; 0 when it is absent or not a number.
double orl_json_value(const json_t *object, const char *key);
// The text of `key`; NULL when it is absent or not a string.
const char *orl_json_text(const json_t *object, const char *key);

#endif
