// What a frame costs: time by pass, memory by owner, and how both grow (tables 1 and 2 and figures
// 13 and 15 of Airieau 2012, for any scene).
#ifndef ORL_EVAL_BENCH_H
#define ORL_EVAL_BENCH_H

#include "oriel/option_row.h"
#include "oriel/progress.h"
#include "eval/choice.h"
#include "eval/timing.h"
#include "oriel/render.h"

enum { ORL_BENCH_MEMORY_MAX = 64 };

enum orl_bench_kind {
    ORL_BENCH_SIZES,       // of the picture: table 2
    ORL_BENCH_PHOTOGRAPHS, // their number: figure 13
    ORL_BENCH_POINTS,      // their number
    ORL_BENCH_RESOLUTION,  // of the photographs: figure 15
    ORL_BENCH_KIND_COUNT
};
// What the runs of a kind differ in.
extern const char *const orl_bench_kind_names[ORL_BENCH_KIND_COUNT];

// One row: a configuration, and what was measured of it.
struct orl_bench_run {
    enum orl_bench_kind kind;
    const char *method;
    struct orl_size size;       // of the picture
    size_t photographs, points;
    int photo_divide;           // photographs at 1/n of their size
    struct orl_timing timing;
    size_t device_bytes;
    size_t uploaded_bytes;      // photographs and masks that went to the device
    double psnr_db;             // ORL_BENCH_RESOLUTION, first method: PSNR against full size; else
                                // 0
    // ORL_BENCH_POINTS, first method: the same points drawn by the graphics pipeline, as GL_POINTS
    // with depth test; no frames: of other rows.
    size_t gl_points_frames;
    double gl_points_ms;
};
// What the run's kind varies, such as "512x512".
void orl_bench_run_print(const struct orl_bench_run *run, char text[32]);
// Time of all splatting passes of a frame.
double orl_bench_splat_ms(const struct orl_bench_run *run);

struct orl_bench_params {
    const struct orl_choice *choices;
    size_t choice_count;
    const struct orl_size *sizes; // growth is measured at the first size
    size_t size_count;
    const size_t *points; // for growth with points; NULL: an eighth, a quarter, half and all of the
                          // scene's, and a million
    size_t points_count;
    double seconds;        // approximate duration of the frames behind each median
    size_t frames_max;     // greatest number of frames behind each median
    bool growth;           // measures growth with photographs, points and resolution, and GL_POINTS
    size_t max_vram_bytes;
    enum orl_textures textures;
    const char *image_dir; // folder for pictures at each resolution of the photographs; NULL: none
    const char *trace;     // file for a trace of some frames; NULL: none
    const struct orl_progress *progress;
};

struct orl_bench {
    const struct orl_scene *scene; // not owned
    char device[128], driver[128];
    bool software;
    size_t photographs;      // number that the renderer may use
    int photo_width, photo_height; // largest
    size_t host_peak_bytes;
    struct orl_bench_run *runs; // owned, kind by kind
    size_t run_count;
    struct orl_gpu_memory memory[ORL_BENCH_MEMORY_MAX]; // of the first run
    size_t memory_count;
};

// Renders fixed views between neighbouring photographs, without using held-out photographs, of a
// sequence a time step a frame. Creates its own renderers, one after another.
enum orl_result orl_bench_run(struct orl_gpu *gpu, const struct orl_scene *scene,
                              const struct orl_bench_params *params,
                              struct orl_bench *bench) ORL_CHECK_RESULT;
void orl_bench_finish(struct orl_bench *bench);

// The report (docs/reference/json.md). A new reference; NULL: no memory.
json_t *orl_bench_report(const struct orl_bench *bench);
#endif
