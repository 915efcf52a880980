// Text files of one record a line, for importers: errors name file, line and byte.
#ifndef ORL_SCENE_TEXT_LINES_H
#define ORL_SCENE_TEXT_LINES_H

#include "oriel/log.h"

struct orl_text_lines {
    const struct orl_log *log;
    char *path;         // owned
    uint8_t *data;      // owned
    char *next, *end;   // what is left
    char *at;           // in the current line
    size_t number;      // of the current line, from 1
};

enum orl_result orl_text_open(const struct orl_log *log, const char *path,
                              struct orl_text_lines *l) ORL_CHECK_RESULT;
void orl_text_close(struct orl_text_lines *l);
// ORL_ERR_FORMAT, saying where the reader stands and `what` is wrong there.
enum orl_result orl_text_bad(const struct orl_text_lines *l, const char *what);

// The next line, cut off at its end, also when it is empty. False at the end.
bool orl_text_next_raw(struct orl_text_lines *l);
// The same without empty lines and comments, which start with '#'.
bool orl_text_next(struct orl_text_lines *l);

// Take from the current line what they return; false when it is not there. orl_text_id takes
// whole numbers from 0 to `max`.
bool orl_text_number(struct orl_text_lines *l, double *value);
bool orl_text_numbers(struct orl_text_lines *l, double *values, size_t count);
bool orl_text_id(struct orl_text_lines *l, uint64_t max, uint64_t *value);

#endif
