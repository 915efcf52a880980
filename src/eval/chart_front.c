#include "eval/chart_front.h"

#include <math.h>
#include <stdarg.h>
#include <stdio.h>
#include <string.h>

static bool dominates(const struct orl_chart_point *a, const struct orl_chart_point *b)
{
    return a->ms <= b->ms && a->db >= b->db && (a->ms < b->ms || a->db > b->db);
}

void orl_chart_find_front(struct orl_chart_point *points, size_t count)
{
    for (size_t i = 0; i < count; i++) {
        struct orl_chart_point *p = &points[i];
        p->dominated_by = -1;
        p->on_front = isfinite(p->ms) && isfinite(p->db);
        for (size_t k = 0; p->on_front && k < count; k++)
            if (dominates(&points[k], p) &&
                (p->dominated_by < 0 || dominates(&points[k], &points[p->dominated_by]) ||
                 points[k].db > points[p->dominated_by].db))
                p->dominated_by = (int)k;
        p->on_front = p->on_front && p->dominated_by < 0;
    }
}

ORL_PRINTF(2, 3)
static void add(char text[ORL_CHART_SENTENCE_MAX], const char *format, ...)
{
    size_t used = strlen(text);
    va_list args;
    va_start(args, format);
    vsnprintf(text + used, ORL_CHART_SENTENCE_MAX - used, format, args);
    va_end(args);
}

static void add_name(char text[ORL_CHART_SENTENCE_MAX], const struct orl_chart_point *p)
{
    add(text, "%s%s%s", p->method, p->setting[0] ? " " : "", p->setting);
}

// A figure of whole pictures and, in brackets, that of covered pixels.
static void add_db(char text[ORL_CHART_SENTENCE_MAX], double whole, double covered)
{
    add(text, "%.2f dB", whole);
    if (isfinite(covered))
        add(text, " (covered %.2f)", covered);
}

// The point's neighbour on the front: the next faster or the next better one.
static const struct orl_chart_point *neighbour(const struct orl_chart_point *points,
                                               size_t count, const struct orl_chart_point *p,
                                               bool faster)
{
    const struct orl_chart_point *best = NULL;
    for (size_t i = 0; i < count; i++) {
        const struct orl_chart_point *q = &points[i];
        if (!q->on_front || (faster ? !(q->ms < p->ms) : !(q->ms > p->ms)))
            continue;
        if (!best || (faster ? q->ms > best->ms : q->ms < best->ms))
            best = q;
    }
    return best;
}

static void add_neighbours(char text[ORL_CHART_SENTENCE_MAX],
                           const struct orl_chart_point *points, size_t count,
                           const struct orl_chart_point *p)
{
    const struct orl_chart_point *faster = neighbour(points, count, p, true);
    const struct orl_chart_point *better = neighbour(points, count, p, false);
    add(text, " Nothing charted is both faster and better.");
    if (faster) {
        add(text, " The next faster, ");
        add_name(text, faster);
        add(text, ", takes %.2f of its time for ", faster->ms / p->ms);
        add_db(text, p->db - faster->db, p->covered_db - faster->covered_db);
        add(text, " less.");
    }
    if (better) {
        add(text, " The next better, ");
        add_name(text, better);
        add(text, ", gains ");
        add_db(text, better->db - p->db, better->covered_db - p->covered_db);
        add(text, " for %.2f times its time.", better->ms / p->ms);
    }
}

// Adds the method's settings that are on the front when the method itself is not.
static void add_settings(char text[ORL_CHART_SENTENCE_MAX], const struct orl_chart_point *points,
                         size_t count, const struct orl_chart_point *p)
{
    bool first = true;
    for (size_t i = 0; i < count; i++) {
        const struct orl_chart_point *q = &points[i];
        if (!q->on_front || q == p || strcmp(q->method, p->method) != 0)
            continue;
        add(text, "%s%s", first ? " On the front it is with " : ", ", q->setting);
        first = false;
    }
    if (!first)
        add(text, ".");
}

void orl_chart_sentence(const struct orl_chart_point *points, size_t count, size_t index,
                        char text[ORL_CHART_SENTENCE_MAX])
{
    const struct orl_chart_point *p = &points[index];
    text[0] = '\0';
    add_name(text, p);
    add(text, ": ");
    add_db(text, p->db, p->covered_db);
    if (!isfinite(p->ms)) {
        add(text, ", in a time that is not known.");
        return;
    }
    add(text, p->ms < 1000 ? " at %.3g ms a frame." : " at %.0f ms a frame.", p->ms);
    if (p->on_front) {
        add_neighbours(text, points, count, p);
        return;
    }
    const struct orl_chart_point *q = &points[p->dominated_by];
    add(text, " Here ");
    add_name(text, q);
    add(text, " is ");
    add_db(text, q->db - p->db, q->covered_db - p->covered_db);
    add(text, " better in %.2f of its time.", q->ms / p->ms);
    add_settings(text, points, count, p);
}
