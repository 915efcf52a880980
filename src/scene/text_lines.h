// Text files with one record per line, for importers. Errors name the file, line and byte.
#ifndef ORL_SCENE_TEXT_LINES_H
#define ORL_SCENE_TEXT_LINES_H

#include "oriel/log.h"

struct orl_text_lines {
    const struct orl_log *log;
    char *path;         // owned
    uint8_t *data;      // owned
    char *next, *end;   // start of the next line; end of the text
    char *line, *at;    // start of the current line; position in it
    bool again;         // the next line is the current one
    size_t number;      // of the current line, from 1
};

enum orl_result orl_text_open(const struct orl_log *log, const char *path,
                              struct orl_text_lines *l) ORL_CHECK_RESULT;
void orl_text_close(struct orl_text_lines *l);
// Logs the reader's position and `what` is wrong there; returns ORL_ERR_FORMAT.
enum orl_result orl_text_bad(const struct orl_text_lines *l, const char *what);

// Goes to the next line, which may be empty. False at the end of the text.
bool orl_text_next_raw(struct orl_text_lines *l);
// Makes the current line the next one.
void orl_text_back(struct orl_text_lines *l);
// Goes to the next line that is neither empty nor a comment, which starts with '#'.
bool orl_text_next(struct orl_text_lines *l);

// Read values from the current line; false when a value is missing. orl_text_id reads integers
// from 0 to `max`.
bool orl_text_number(struct orl_text_lines *l, double *value);
bool orl_text_numbers(struct orl_text_lines *l, double *values, size_t count);
bool orl_text_id(struct orl_text_lines *l, uint64_t max, uint64_t *value);
// Cuts the current line at its separators into `most` fields or fewer, without spaces and quotes around
// them. How many.
size_t orl_text_split(struct orl_text_lines *l, char separator, char **fields, size_t most);

#endif
