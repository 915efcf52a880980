// Processor time of all threads, which other work on the machine hardly changes: on a software
// renderer that is the frame; with a GPU it is the driver's and ours alone.
#ifndef ORL_TESTS_CPU_TIME_H
#define ORL_TESTS_CPU_TIME_H

#include <time.h>

// Of this process so far, seconds.
static inline double cpu_time_s(void)
{
    struct timespec t;
    clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &t);
    return (double)t.tv_sec + 1e-9 * (double)t.tv_nsec;
}

#endif
