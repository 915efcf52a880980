// What a frame costs: time by pass and memory by owner (tables 1 and 2 of Airieau 2012, for any
// scene).
#ifndef ORL_EVAL_BENCH_H
#define ORL_EVAL_BENCH_H

#include "oriel/option_row.h"
#include "oriel/progress.h"
#include "eval/choice.h"
#include "eval/timing.h"
#include "oriel/render.h"

enum { ORL_BENCH_MEMORY_MAX = 64 };

// One row: a size and a method, and what was measured of it.
struct orl_bench_run {
    const char *method;
    struct orl_size size; // of the picture
    struct orl_timing timing;
    size_t device_bytes;
    size_t uploaded_bytes; // photographs and masks that went to the device
};

#define ORL_BENCH_OPTIONS(ROW) \
    ROW(sizes, "size", LIST("WxH"), "of the picture; default: 512x512 and 1024x1024") \
    ROW(seconds, "seconds", NUMBER(1, 0, 3600, "S"), "for each median, about") \
    ROW(frames, "frames", INT(100, ORL_TIMING_FRAMES_MIN, 100000, "N"), "for each median, at most") \
    ROW(trace, "trace", TEXT("FILE"), "write a few frames for chrome://tracing or ui.perfetto.dev") \
    ROW(textures, "textures", CHOICE(orl_textures, ORL_TEXTURES, ORL_TEXTURES_AUTO, "KIND"), \
        "photographs on the device") \
    ROW(max_vram_bytes, "max-vram", MIB(1 << 20), "device memory to plan for")
struct orl_bench_params {
    ORL_BENCH_OPTIONS(ORL_OPTION_MEMBER)
    const struct orl_choices *choices; // at least one
    const struct orl_progress *progress;
};

struct orl_bench {
    const struct orl_scene *scene; // not owned
    char device[128], driver[128];
    bool software;
    size_t photographs;      // number that the renderer may use
    int photo_width, photo_height; // largest
    size_t host_peak_bytes;
    struct orl_bench_run *runs; // owned
    size_t run_count, run_capacity;
    struct orl_gpu_memory memory[ORL_BENCH_MEMORY_MAX]; // of the first run
    size_t memory_count;
};

// Renders fixed views between neighbouring photographs, without using held-out photographs, of a
// sequence a time step a frame. Creates its own renderer. ORL_ERR_ARGUMENT: a text among the sizes is
// none.
enum orl_result orl_bench_run(struct orl_gpu *gpu, const struct orl_scene *scene,
                              const struct orl_bench_params *params,
                              struct orl_bench *bench) ORL_CHECK_RESULT;
void orl_bench_finish(struct orl_bench *bench);

// The report (docs/reference/json.md). A new reference; NULL: no memory.
json_t *orl_bench_report(const struct orl_bench *bench);
#endif
