#include "preprocess/calibrate/preempt.h"

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
    const struct orl_descriptors *photos;
    struct orl_preempt_pair *pairs;
    size_t count;
};

static enum orl_result match_block(void *priv, size_t block)
{
    const struct work *work = priv;
    size_t start = block * BLOCK, end = start + BLOCK < work->count ? start + BLOCK : work->count;
    struct wide a, b;
    for (size_t i = start; i < end; i++) {
        struct orl_preempt_pair *pair = &work->pairs[i];
        if (i == start || pair->a != pair[-1].a)
            widen(&work->photos[pair->a], &a);
        widen(&work->photos[pair->b], &b);
        pair->matches = count_matches(&a, &b);
    }
    return ORL_OK;
}

enum orl_result orl_preempt_match_all(const struct orl_log *log,
                                      const struct orl_progress *progress,
                                      const struct orl_descriptors *photos,
                                      struct orl_preempt_pair *pairs, size_t count)
{
    struct work work = {photos, pairs, count};
    size_t blocks = (count + BLOCK - 1) / BLOCK;
    orl_logf(log, ORL_LOG_DEBUG, "pairs: preemptive matching of %zu pairs", count);
    return orl_threads_each(&(struct orl_each){
        .work = match_block, .priv = &work, .count = blocks, .progress = progress, .step = "pairs",
        .share = 0.99 * (double)(blocks * BLOCK), .total = (double)count});
}
