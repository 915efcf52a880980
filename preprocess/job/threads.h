// The same work on several processors.
#ifndef ORL_PREPROCESS_THREADS_H
#define ORL_PREPROCESS_THREADS_H

#include "oriel/common.h"

// Calls `work` in as many threads as there are processors, `most` at most; the calling thread is one
// of them, and is told so. Returns when all have returned.
void orl_threads_run(size_t most, void (*work)(void *priv, bool caller), void *priv);

#endif
