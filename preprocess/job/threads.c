#include "preprocess/job/threads.h"

#include <pthread.h>
#include <unistd.h>

enum { THREADS_MAX = 64 };

struct task {
    void (*work)(void *priv, bool caller);
    void *priv;
};

static void *run_task(void *priv)
{
    const struct task *task = priv;
    task->work(task->priv, false);
    return NULL;
}

void orl_threads_run(size_t most, void (*work)(void *priv, bool caller), void *priv)
{
    struct task task = {work, priv};
    pthread_t threads[THREADS_MAX];
    long processors = sysconf(_SC_NPROCESSORS_ONLN);
    size_t started = 0;
    // Fewer than wanted will do.
    while (started < THREADS_MAX && started + 1 < most && (long)started + 1 < processors &&
           pthread_create(&threads[started], NULL, run_task, &task) == 0)
        started++;
    work(priv, true);
    for (size_t i = 0; i < started; i++)
        pthread_join(threads[i], NULL);
}
