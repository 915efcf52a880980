#include "preprocess/job/threads.h"

#include <pthread.h>
#include <stdatomic.h>
#include <unistd.h>

enum { THREADS_MAX = 64 };

struct task {
    const struct orl_each *each;
    atomic_size_t next;
    atomic_int result; // the first enum orl_result that is not ORL_OK
};

static void run_items(struct task *task, bool caller)
{
    const struct orl_each *e = task->each;
    size_t i;
    while (atomic_load(&task->result) == ORL_OK && (i = atomic_fetch_add(&task->next, 1)) < e->count) {
        int none = ORL_OK;
        enum orl_result result = e->work(e->priv, i);
        if (caller) {
            orl_progress_report(e->progress, e->step, e->done + e->share * (double)i / (double)e->count,
                                e->total, NULL);
            if (result == ORL_OK && orl_progress_cancelled(e->progress))
                result = ORL_ERR_CANCELLED;
        }
        atomic_compare_exchange_strong(&task->result, &none, (int)result);
    }
}

static void *run_task(void *priv)
{
    run_items(priv, false);
    return NULL;
}

enum orl_result orl_threads_each(const struct orl_each *each)
{
    struct task task = {.each = each};
    pthread_t threads[THREADS_MAX];
    long processors = sysconf(_SC_NPROCESSORS_ONLN);
    size_t started = 0, most = each->threads && each->threads < each->count ? each->threads : each->count;
    // Fewer than wanted will do.
    while (started < THREADS_MAX && started + 1 < most && (long)started + 1 < processors &&
           pthread_create(&threads[started], NULL, run_task, &task) == 0)
        started++;
    run_items(&task, true);
    for (size_t i = 0; i < started; i++)
        pthread_join(threads[i], NULL);
    return (enum orl_result)atomic_load(&task.result);
}
