// What the GPU tests share: a device, or exit 77 with a word. ORIEL_TEST_DEVICE names a part of the
// renderer's name that must be there, so that a driver asked for is the one that is tested;
// ORIEL_TEST_SHADERS a folder of shaders to test in place of those in the program.
#ifndef ORL_TESTS_GPU_TEST_H
#define ORL_TESTS_GPU_TEST_H

#include <string.h>

#include "oriel/gpu.h"
#include "test.h"

// A device for the whole test program, GL errors being failures.
static inline struct orl_gpu *gpu_test_device(void)
{
    static struct orl_log log;
    log = orl_log_stderr(ORL_LOG_WARNING);
    struct orl_gpu *gpu = NULL;
    const struct orl_gpu_params params = {.debug = true, .shader_dir = getenv("ORIEL_TEST_SHADERS")};
    if (orl_gpu_create(&log, &params, &gpu) != ORL_OK) {
        fprintf(stderr, "skipped: no OpenGL 4.5 device\n");
        exit(77);
    }
    const char *wanted = getenv("ORIEL_TEST_DEVICE"), *found = orl_gpu_caps(gpu)->renderer;
    if (wanted && !strstr(found, wanted)) {
        fprintf(stderr, "the device is %s, not %s\n", found, wanted);
        exit(1);
    }
    return gpu;
}

#endif
