// Speed and memory against accuracy: every method with its settings on held-out photographs of one
// or several scenes (docs/reference/chart.md).
#ifndef ORL_EVAL_CHART_H
#define ORL_EVAL_CHART_H

#include "core/file.h"
#include "eval/row_store.h"
#include "oriel/progress.h"
#include "oriel/gpu.h"

// Pictures that another program rendered at the held-out cameras: DIR/SCENE/NAME.png or .jpg,
// or, without that folder, DIR/NAME.png or .jpg.
struct orl_chart_peer {
    const char *name, *dir;
    double ms, mib; // of a frame; of device memory; as given by the user; 0: unknown
};

#define ORL_CHART_OPTIONS(ROW) \
    ROW(out, "out", NEEDED("DIR"), \
        "the report: chart.html, chart.json, figures; rows in it are used again") \
    ROW(methods, "method", LIST("NAME"), "methods; default: all") \
    ROW(varied, "vary", TEXT("KEY=A,B,.."), \
        "each method that reads this option with each of these values, too") \
    ROW(quick, "quick", FLAG, \
        "an overview: methods as they are, two photographs a scene at half their size") \
    ROW(views, "views", INT(8, 1, 100000, "N"), "held-out photographs of a scene, at most") \
    ROW(seconds, "seconds", NUMBER(1, 0, 3600, "S"), "of timed frames for each row") \
    ROW(part, "part", PART, \
        "only the K-th of N parts of the rows, kept for a run of all (oriel plan)") \
    ROW(max_vram_bytes, "max-vram", MIB(1 << 20), "device memory to plan for")
struct orl_chart_params {
    ORL_CHART_OPTIONS(ORL_OPTION_MEMBER) // views 0: all
    const char *const *scenes; // folders
    size_t scene_count;
    const struct orl_chart_peer *peers;
    size_t peer_count;
    const struct orl_progress *progress;
};

// One row of the report's table. Figures are means over a scene's photographs, or over scenes.
struct orl_chart_row {
    const char *scene; // NULL: mean over all scenes
    const char *method, *setting;
    double psnr_db, ssim, flip, crumbs;
    double frame_ms, device_mib; // NAN: unknown
    bool on_front;               // no other row is both faster and better
};

struct orl_chart {
    void *json;                 // json_t *, owned: chart.json
    struct orl_chart_row *rows; // owned; texts belong to `json`
    size_t row_count;
    size_t measured, reused, left_out; // rows of scenes; left_out: rows that failed, as logged
};

// Measures the rows that OUT lacks and writes chart.json, chart.html and the SVG figures into OUT.
// After ORL_ERR_CANCELLED OUT keeps the finished rows, and after a part its rows, without a report.
enum orl_result orl_chart_run(struct orl_gpu *gpu, const struct orl_chart_params *params,
                              struct orl_chart *chart) ORL_CHECK_RESULT;
void orl_chart_finish(struct orl_chart *chart);

#endif
