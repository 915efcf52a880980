// Lists of names.
#ifndef ORIEL_NAMES_H
#define ORIEL_NAMES_H

#include "oriel/log.h"

struct orl_names {
    size_t count, capacity;
    char **items; // the array and each name are owned
};
enum orl_result orl_names_add(const struct orl_log *log, struct orl_names *names,
                              const char *name) ORL_CHECK_RESULT;
bool orl_names_contain(const struct orl_names *names, const char *name);
// Sorts bytewise.
void orl_names_sort(struct orl_names *names);
void orl_names_finish(struct orl_names *names);

#endif
