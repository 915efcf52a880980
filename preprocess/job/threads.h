// The same work on several processors.
#ifndef ORL_PREPROCESS_THREADS_H
#define ORL_PREPROCESS_THREADS_H

#include "oriel/progress.h"
#include "oriel/result.h"

// What is done with each of `count` items, and the progress of that: `step` goes from `done` to
// `done + share` of `total`.
struct orl_each {
    enum orl_result (*work)(void *priv, size_t item);
    void *priv;
    size_t count;
    size_t threads; // at most; 0: as many as there are processors
    const struct orl_progress *progress;
    const char *step;
    double done, share, total;
};
// Calls `work` for each item, in order, in as many threads as there are processors or fewer; the calling thread
// is one of them, and alone reports progress. What fails or cancels keeps further items from being
// begun, and is returned once all threads have finished theirs.
enum orl_result orl_threads_each(const struct orl_each *each) ORL_CHECK_RESULT;

#endif
