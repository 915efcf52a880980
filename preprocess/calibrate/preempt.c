#include "preprocess/calibrate/preempt.h"

#include <pthread.h>
#include <stdatomic.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include "core/memory.h"
#include "preprocess/calibrate/database.h"

enum { COUNT = ORL_PREEMPT_FEATURES, SIZE = ORL_SIFT_SIZE };

static const float RATIO = 0.8f;
static const float LENGTH2 = 512.f * 512; // squared length of a descriptor

// 16-bit numbers multiply and add in pairs in one instruction (pmaddwd).
struct wide {
    int16_t rows[COUNT][SIZE];
    size_t count;
};

static void widen(const struct orl_descriptors *from, struct wide *to)
{
    to->count = from->count < COUNT ? from->count : COUNT;
    for (size_t i = 0; i < to->count; i++)
        for (size_t k = 0; k < SIZE; k++)
            to->rows[i][k] = from->data[i * SIZE + k];
}

static inline __attribute__((always_inline)) void dot_rows(const int16_t *row,
                                                           const struct wide *with, int32_t *dots)
{
    for (size_t j = 0; j < with->count; j++) {
        const int16_t *other = with->rows[j];
        int32_t sum = 0;
        for (size_t k = 0; k < SIZE; k++)
            sum += row[k] * other[k];
        dots[j] = sum;
    }
}

static void dot_plain(const int16_t *row, const struct wide *with, int32_t *dots)
{
    dot_rows(row, with, dots);
}

#ifdef __x86_64__
// Every x86-64 processor has SSE2 alone; most have AVX2, which is twice as wide.
__attribute__((target("avx2"))) static void dot_avx2(const int16_t *row, const struct wide *with,
                                                     int32_t *dots)
{
    dot_rows(row, with, dots);
}
#endif

static void dot(const int16_t *row, const struct wide *with, int32_t *dots)
{
#ifdef __x86_64__
    if (__builtin_cpu_supports("avx2")) {
        dot_avx2(row, with, dots);
        return;
    }
#endif
    dot_plain(row, with, dots);
}

// The nearest of a feature so far; -1 is less than any dot product.
struct nearest {
    int32_t best, second;
    size_t index;
};

static void consider(struct nearest *nearest, int32_t value, size_t index)
{
    if (value > nearest->best)
        *nearest = (struct nearest){value, nearest->best, index};
    else if (value > nearest->second)
        nearest->second = value;
}

static bool is_distinct(const struct nearest *nearest)
{
    // The squared distance on the unit sphere is 2 - 2 dot.
    float near2 = 2 - 2 * (float)nearest->best / LENGTH2;
    float next2 = 2 - 2 * (float)nearest->second / LENGTH2;
    // A lone feature has nothing to be told apart from.
    return nearest->second >= 0 && near2 < RATIO * RATIO * next2;
}

static int count_matches(const struct wide *a, const struct wide *b)
{
    int32_t dots[COUNT];
    struct nearest of_a[COUNT], of_b[COUNT];
    for (size_t j = 0; j < COUNT; j++)
        of_a[j] = of_b[j] = (struct nearest){-1, -1, 0};
    for (size_t i = 0; i < a->count; i++) {
        dot(a->rows[i], b, dots);
        for (size_t j = 0; j < b->count; j++) {
            consider(&of_a[i], dots[j], j);
            consider(&of_b[j], dots[j], i);
        }
    }
    int matches = 0;
    for (size_t i = 0; i < a->count; i++) {
        const struct nearest *back = &of_b[of_a[i].index];
        matches += is_distinct(&of_a[i]) && back->index == i && is_distinct(back);
    }
    return matches;
}

int orl_preempt_matches(const struct orl_descriptors *a, const struct orl_descriptors *b)
{
    struct wide wide_a, wide_b;
    widen(a, &wide_a);
    widen(b, &wide_b);
    return count_matches(&wide_a, &wide_b);
}

// --- many pairs ---

enum { BLOCK = 256, THREADS_MAX = 64 }; // BLOCK: pairs that a thread takes at once

struct work {
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
static void match_blocks(struct work *work, const struct orl_progress *progress)
{
    struct wide a, b;
    size_t start;
    while (!work->stop && (start = atomic_fetch_add(&work->next, BLOCK)) < work->count) {
        match_block(work, start, &a, &b);
        if (!progress)
            continue;
        orl_progress_report(progress, "pairs", 0.99 * (double)start, (double)work->count, NULL);
        if (orl_progress_cancelled(progress))
            work->stop = true;
    }
}

static void *run_thread(void *work)
{
    match_blocks(work, NULL);
    return NULL;
}

enum orl_result orl_preempt_match_all(const struct orl_log *log,
                                      const struct orl_progress *progress,
                                      const struct orl_descriptors *photos,
                                      struct orl_preempt_pair *pairs, size_t count)
{
    struct work work = {.photos = photos, .pairs = pairs, .count = count};
    pthread_t threads[THREADS_MAX];
    long processors = sysconf(_SC_NPROCESSORS_ONLN);
    size_t wanted = count / BLOCK, started = 0;
    if (wanted > THREADS_MAX)
        wanted = THREADS_MAX;
    // This thread is one of them. Fewer than wanted are enough.
    while (started < wanted && (long)started + 1 < processors &&
           pthread_create(&threads[started], NULL, run_thread, &work) == 0)
        started++;
    orl_logf(log, ORL_LOG_DEBUG, "pairs: preemptive matching of %zu pairs, %zu threads", count,
             started + 1);
    match_blocks(&work, progress);
    for (size_t i = 0; i < started; i++)
        pthread_join(threads[i], NULL);
    return work.stop ? ORL_ERR_CANCELLED : ORL_OK;
}
