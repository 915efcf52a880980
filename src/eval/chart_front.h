// Which of several ways to do something nobody should use: another is faster and better.
#ifndef ORL_EVAL_CHART_FRONT_H
#define ORL_EVAL_CHART_FRONT_H

#include "oriel/common.h"

struct orl_chart_point {
    const char *method, *setting; // setting "": the method as it is
    double ms; // less is better; NAN: not known, takes no part
    double db; // more is better
    // Set by orl_chart_find_front:
    bool on_front;
    int dominated_by; // index of the best of those that are no slower and no worse; -1: none
};

// Marks the Pareto front. Of two equal points both may be on it.
void orl_chart_find_front(struct orl_chart_point *points, size_t count);

enum { ORL_CHART_SENTENCE_MAX = 512 };
// What a point buys for what, from the figures of its neighbours on the front.
void orl_chart_sentence(const struct orl_chart_point *points, size_t count, size_t index,
                        char text[ORL_CHART_SENTENCE_MAX]);

#endif
