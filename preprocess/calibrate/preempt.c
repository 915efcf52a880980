#include "preprocess/calibrate/preempt.h"

#include <stdatomic.h>

#include "preprocess/job/threads.h"

enum { COUNT = ORL_PREEMPT_FEATURES };

struct wide {
    int16_t rows[COUNT * ORL_SIFT_SIZE];
    size_t count;
};

static void widen(const struct orl_descriptors *from, struct wide *to)
{
    to->count = from->count < COUNT ? from->count : COUNT;
    orl_sift_widen(from->data, to->count, to->rows);
}

static int count_matches(const struct wide *a, const struct wide *b)
{
    struct orl_nearest of_a[COUNT], of_b[COUNT];
    int matches = 0;
    orl_sift_nearest(a->rows, a->count, b->rows, b->count, of_a, of_b);
    for (size_t i = 0; i < a->count; i++)
        matches += orl_sift_is_match(of_a, of_b, i);
    return matches;
}

enum { BLOCK = 256 }; // pairs that a thread takes at once

struct work {
    const struct orl_progress *progress;
    const struct orl_descriptors *photos;
    struct orl_preempt_pair *pairs;
    size_t count;
    atomic_size_t next;
    atomic_bool stop;
};

static void match_block(struct work *work, size_t start, struct wide *a, struct wide *b)
{
    size_t end = start + BLOCK < work->count ? start + BLOCK : work->count;
    for (size_t i = start; i < end; i++) {
        struct orl_preempt_pair *pair = &work->pairs[i];
        if (i == start || pair->a != pair[-1].a)
            widen(&work->photos[pair->a], a);
        widen(&work->photos[pair->b], b);
        pair->matches = count_matches(a, b);
    }
}

// Of the threads, only the caller's reports progress.
static void match_blocks(void *priv, bool caller)
{
    struct work *work = priv;
    struct wide a, b;
    size_t start;
    while (!work->stop && (start = atomic_fetch_add(&work->next, BLOCK)) < work->count) {
        match_block(work, start, &a, &b);
        if (!caller)
            continue;
        orl_progress_report(work->progress, "pairs", 0.99 * (double)start, (double)work->count, NULL);
        if (orl_progress_cancelled(work->progress))
            work->stop = true;
    }
}

enum orl_result orl_preempt_match_all(const struct orl_log *log,
                                      const struct orl_progress *progress,
                                      const struct orl_descriptors *photos,
                                      struct orl_preempt_pair *pairs, size_t count)
{
    struct work work = {.progress = progress, .photos = photos, .pairs = pairs, .count = count};
    orl_logf(log, ORL_LOG_DEBUG, "pairs: preemptive matching of %zu pairs", count);
    orl_threads_run(count / BLOCK + 1, match_blocks, &work);
    return work.stop ? ORL_ERR_CANCELLED : ORL_OK;
}
