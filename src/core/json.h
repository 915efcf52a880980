// JSON files, and values in them that are checked as they are read.
#ifndef ORL_CORE_JSON_H
#define ORL_CORE_JSON_H

#include <jansson.h>

#include "oriel/log.h"

// Parses text of any kind, released with json_decref. Errors name `path`, the line, the byte
// and the reason.
enum orl_result orl_json_parse(const struct orl_log *log, const char *path, const void *text,
                               size_t size, json_t **out) ORL_CHECK_RESULT;
// Parses a JSON object of at most 64 MiB, released with json_decref.
enum orl_result orl_json_read(const struct orl_log *log, const char *path,
                              json_t **out) ORL_CHECK_RESULT;
// Indented, keys in order of insertion; written whole or not at all.
enum orl_result orl_json_write(const struct orl_log *log, const char *path,
                               const json_t *value) ORL_CHECK_RESULT;

// A string, which JSON wants in UTF-8: other bytes of `text`, which names of files may have, become
// "\xNN". NULL: no memory.
json_t *orl_json_string(const char *text);

// Where values are read from, for errors: "PATH: WHAT: "key" is not ...".
struct orl_json_place {
    const struct orl_log *log;
    const char *path;
    const char *what; // "photograph 0001.jpg"; NULL: the file itself
};
// ORL_ERR_FORMAT: `key` is not what `wanted` says.
enum orl_result orl_json_refuse(const struct orl_json_place *place, const char *key,
                                const char *wanted) ORL_CHECK_RESULT;

// Values of `object`. One that is absent or null leaves *value as it is and counts as read;
// one of another type or range is refused.
enum orl_result orl_json_number(const struct orl_json_place *place, const json_t *object,
                                const char *key, double low, double high,
                                double *value) ORL_CHECK_RESULT;
enum orl_result orl_json_integer(const struct orl_json_place *place, const json_t *object,
                                 const char *key, int low, int high, int *value) ORL_CHECK_RESULT;
enum orl_result orl_json_bool(const struct orl_json_place *place, const json_t *object,
                              const char *key, bool *value) ORL_CHECK_RESULT;
// An array of that many.
enum orl_result orl_json_numbers(const struct orl_json_place *place, const json_t *object,
                                 const char *key, size_t count, double low, double high,
                                 double *values) ORL_CHECK_RESULT;

// Is it an array of `count` finite numbers? Then they are in `values`.
bool orl_json_read_numbers(const json_t *array, size_t count, double *values);
// NULL where it is absent or no text.
const char *orl_json_text(const json_t *object, const char *key);

#endif
