// What the GPU tests share: a device, or exit 77 with a word.
#ifndef ORL_TESTS_GPU_TEST_H
#define ORL_TESTS_GPU_TEST_H

#include "oriel/gpu.h"
#include "test.h"

// A device for the whole test program, GL errors being failures.
static inline struct orl_gpu *gpu_test_device(void)
{
    static struct orl_log log;
    log = orl_log_stderr(ORL_LOG_WARNING);
    struct orl_gpu *gpu = NULL;
    if (orl_gpu_create(&log, &(struct orl_gpu_params){.debug = true}, &gpu) != ORL_OK) {
        fprintf(stderr, "skipped: no OpenGL 4.5 device\n");
        exit(77);
    }
    return gpu;
}

#endif
