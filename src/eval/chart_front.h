// The Pareto front of speed and accuracy: a way that is off the front has a faster and better one.
#ifndef ORL_EVAL_CHART_FRONT_H
#define ORL_EVAL_CHART_FRONT_H

#include "oriel/common.h"

struct orl_chart_point {
    const char *method, *setting; // setting "": the method's own values
    double ms; // less is better; NAN: unknown, the point takes no part
    double db; // more is better
    double covered_db; // of covered pixels, which sentences tell beside it; NAN: unknown
    // Results of orl_chart_find_front:
    bool on_front;
    int dominated_by; // index of the best point that dominates this one; -1: none
};

// Marks the Pareto front. Two equal points may both be on it.
void orl_chart_find_front(struct orl_chart_point *points, size_t count);

enum { ORL_CHART_SENTENCE_MAX = 512 };
// Describes what a point trades against its neighbours on the front, with their figures.
void orl_chart_sentence(const struct orl_chart_point *points, size_t count, size_t index,
                        char text[ORL_CHART_SENTENCE_MAX]);

#endif
