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

struct orl_chart_params {
    const char *const *scenes; // folders
    size_t scene_count;
    const char *out;                 // folder for the report; rows in it are reused
    const struct orl_names *methods; // names; none or "all": all methods
    const char *varied;    // "KEY=A,B,..": also measures each method that reads the option with
                           // each of these values; NULL: none
    const struct orl_chart_peer *peers;
    size_t peer_count;
    size_t views;          // greatest number of held-out photographs of a scene, evenly chosen; 0:
                           // all
    double seconds;        // approximate duration of the timed frames of a row
    bool quick;            // an overview: only the methods themselves, on two photographs at half
                           // size
    size_t max_vram_bytes; // 0: no limit
    struct orl_row_part part; // of the rows of each scene
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
