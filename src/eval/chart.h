// Speed and memory against accuracy: every method and its settings on held-out photographs of
// one or several scenes. docs/reference/chart.md.
#ifndef ORL_EVAL_CHART_H
#define ORL_EVAL_CHART_H

#include "core/file.h"
#include "oriel/progress.h"
#include "oriel/gpu.h"

// Pictures that another program rendered at the held-out cameras: DIR/SCENE/NAME.png or .jpg,
// or, without that folder, DIR/NAME.png or .jpg.
struct orl_chart_peer {
    const char *name, *dir;
    double ms, mib; // of a frame, of device memory, as its user says; 0: not known
};

struct orl_chart_params {
    const char *const *scenes; // folders
    size_t scene_count;
    const char *out;                 // folder for the report; rows in it are used again
    const struct orl_names *methods; // names; none or "all": all there are
    const char *varied;    // "KEY=A,B,..": each method that reads the option also with each of
                           // these values; NULL: none
    const struct orl_chart_peer *peers;
    size_t peer_count;
    size_t views;          // held-out photographs of a scene, at most, evenly chosen; 0: all
    double seconds;        // of timed frames for each row, about
    bool quick;            // an overview: methods alone, two photographs at half their size
    size_t max_vram_bytes; // 0: no limit
    const struct orl_progress *progress;
};

// What a table of the report has. Means over a scene's photographs, or over scenes.
struct orl_chart_row {
    const char *scene; // NULL: all of them
    const char *method, *setting;
    double psnr_db, ssim, flip;
    double frame_ms, device_mib; // NAN: not known
    bool on_front;               // nothing charted is both faster and better
};

struct orl_chart {
    void *json;                 // json_t *, owned: chart.json
    struct orl_chart_row *rows; // owned; texts belong to `json`
    size_t row_count;
    size_t measured, reused, left_out; // rows of scenes; left out: they failed, see the log
};

// Measures what OUT does not have yet, and writes chart.json, chart.html and the SVG figures
// into OUT. ORL_ERR_CANCELLED keeps the rows that are done.
enum orl_result orl_chart_run(struct orl_gpu *gpu, const struct orl_chart_params *params,
                              struct orl_chart *chart) ORL_CHECK_RESULT;
void orl_chart_finish(struct orl_chart *chart);

#endif
