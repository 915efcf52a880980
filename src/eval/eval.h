// The held-out protocol: held-out photographs are compared with renderings from the other
// photographs. docs/reference/metrics.md defines every figure.
#ifndef ORL_EVAL_EVAL_H
#define ORL_EVAL_EVAL_H

#include "oriel/progress.h"
#include "eval/choice.h"
#include "eval/metrics.h"
#include "eval/radiance_metrics.h"
#include "eval/timing.h"
#include "eval/truth.h"
#include "oriel/hdr.h"
#include "oriel/render.h"

struct orl_eval_view {
    size_t photo; // index in the scene
    int width, height;
    struct orl_metrics metrics;
    struct orl_radiance_metrics radiance; // only with a truth
    struct orl_part_metrics vehicle;     // only with one in the truth
    double render_ms, cpu_ms; // medians over frames, see timing.h; 0: not rendered here
    double flip;              // see orl_flip_compare
};

struct orl_eval {
    const struct orl_scene *scene; // not owned
    const char *method;            // not owned; of pictures "pictures"
    char setting[64];              // as in struct orl_choice
    char device[128];
    struct orl_eval_view *views; // owned
    size_t view_count;
    struct orl_eval_view mean; // arithmetic mean of each figure
    struct orl_timing_pass passes[ORL_TIMING_PASSES_MAX]; // means over the views
    size_t pass_count;
    size_t device_bytes[ORL_OWNER_COUNT]; // after the last view
    bool has_truth, has_vehicle;
};

struct orl_eval_params {
    const struct orl_choice *choice;
    // Folder for NAME.photo.png, NAME.<method>.png and NAME.<method>.diff.png, made if needed. The
    // last shows the photograph, the rendering and four times their difference side by side. NULL:
    // none.
    const char *image_dir;
    // Draws radiance instead of the renderer; NULL: the renderer draws. Radiance is brought to each
    // photograph's exposure, vignetting and response before the comparison.
    struct orl_hdr *hdr;
    // Another program's pictures of the views, PHOTO.png or .jpg, measured in place of renderings.
    const char *pictures;
    int views;  // held-out photographs at most, evenly chosen; 0: all
    int divide; // pictures at 1/divide of the photographs' size; 0: at that size
    // The scene itself where it is a sequence whose timed frames show a time step each; else NULL.
    struct orl_scene *sequence;
    const struct orl_truth *truth; // NULL: renderings are compared with the photographs alone
    const struct orl_progress *progress;
};

// ORL_ERR_DATA, with advice: the scene has no held-out photograph.
enum orl_result orl_eval_check(const struct orl_log *log,
                               const struct orl_scene *scene) ORL_CHECK_RESULT;
// Renders the view of every held-out photograph at the photograph's size and compares. A
// renderer with default orl_renderer_params uses no held-out photograph; with hdr or
// pictures it may be NULL. Fails as orl_eval_check does.
enum orl_result orl_eval_run(struct orl_gpu *gpu, struct orl_renderer *renderer,
                             const struct orl_scene *scene, const struct orl_eval_params *params,
                             struct orl_eval *eval) ORL_CHECK_RESULT;
void orl_eval_finish(struct orl_eval *eval);

// The report (docs/reference/json.md). A new reference; NULL: no memory, or a figure is no number.
json_t *orl_eval_report(const struct orl_eval *eval);

// --- figures of a held-out view: their names in reports, and how tables print them ---

enum orl_figure_group {
    ORL_FIGURES_PICTURE,
    ORL_FIGURES_RADIANCE, // only with a truth
    ORL_FIGURES_VEHICLE,  // only with one that has a vehicle
    ORL_FIGURE_GROUPS
};

struct orl_figure {
    const char *name;  // in JSON (docs/reference/metrics.md); NULL after the last
    const char *title; // of a table's column; NULL: reports alone
    int width, digits; // of the column
    double scale;      // from reports to tables
    enum orl_figure_group group;
    size_t offset;     // of the double in struct orl_eval_view
};
extern const struct orl_figure orl_figures[];

bool orl_figures_known(enum orl_figure_group group, const struct orl_eval *eval);
double orl_figure_value(const struct orl_figure *figure, const struct orl_eval_view *view);

#endif
