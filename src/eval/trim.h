// Finds the least model that still serves: what of a scene can go without a loss that counts.
// Training photographs decide, each rendered without itself; held-out ones confirm once at the end.
#ifndef ORL_EVAL_TRIM_H
#define ORL_EVAL_TRIM_H

#include "eval/choice.h"
#include "oriel/option_row.h"
#include "oriel/progress.h"

// What a step makes smaller.
enum orl_trim_part {
    ORL_TRIM_POINTS,     // fewer points
    ORL_TRIM_PHOTOGRAPH, // fewer photographs
    ORL_TRIM_TEXTURES,   // compressed photographs on the device
    ORL_TRIM_DEPTH,      // smaller depth maps of photographs on the device
    ORL_TRIM_OPTION,     // a cheaper value of one of the method's options
    ORL_TRIM_PART_COUNT
};
extern const char *const orl_trim_part_names[ORL_TRIM_PART_COUNT];

// One step that was taken.
struct orl_trim_step {
    enum orl_trim_part part;
    char what[96];         // such as "points 50 %"
    double loss_db, loss_ssim; // means over the views that decided, against the state before it
    bool taken;            // false: it was taken back in the end
    // After it:
    double bytes, ms;      // of the model on the device; of a frame
    double total_loss_db, total_loss_ssim; // means, estimated from the losses of all steps
};

// What a scene takes and how good it is.
struct orl_trim_figures {
    size_t points, photographs;  // that are not held out
    size_t point_bytes, photo_bytes; // on the device; the model is both
    size_t device_bytes;         // all on the device, with the frame's own targets
    size_t file_bytes;           // points, photographs, masks and cameras on disk
    double frame_ms;             // as struct orl_trim_params says
    double psnr_db, ssim;        // means over training photographs, each left out
    double worst_loss_db;        // the most that one of them lost
    double held_psnr_db, held_ssim; // held-out photographs; 0: there are none
};

#define ORL_TRIM_OPTIONS(ROW) \
    ROW(out, "out", NEEDED("SCENE2"), "the folder to make") \
    ROW(tolerance_db, "tolerance", NUMBER(0.1, 0, 100, "DB"), \
        "training photographs may lose so much on average") \
    ROW(tolerance_ssim, "tolerance-ssim", NUMBER(0.01, 0, 1, "SHARE"), \
        "and so much of SSIM, which sees blur that PSNR does not") \
    ROW(worst_db, "worst", NUMBER(0.5, 0, 100, "DB"), "and one of them so much") \
    ROW(max_mib, "max-bytes", NUMBER(0, 0.001, 1 << 20, "MIB"), \
        "instead: the best picture within so much device memory for points and photographs") \
    ROW(max_frame_ms, "max-frame-ms", NUMBER(0, 0.001, 1e6, "MS"), \
        "instead: the best picture within so long a frame; with --max-bytes, both") \
    ROW(keep_options, "keep-options", FLAG, "do not tune the method's options first") \
    ROW(views, "views", INT(6, 2, 64, "N"), "photographs that decide on each step") \
    ROW(size_divide, "size-divide", INT(1, 1, 16, "N"), "compare at 1/N of their size") \
    ROW(budget_s, "budget", NUMBER(0, 0, 1e6, "SECONDS"), \
        "try nothing new after so long, by the clock; default: no limit")
struct orl_trim_params {
    ORL_TRIM_OPTIONS(ORL_OPTION_MEMBER)
    const struct orl_choice *start; // the method and its options
    void (*on_step)(void *priv, const struct orl_trim_step *step); // after each; may be NULL
    void *priv;
    const struct orl_progress *progress;
};

struct orl_trim {
    struct orl_trim_step *steps; // owned
    size_t step_count, step_capacity;
    struct orl_trim_figures before, after;
    size_t undone;  // steps taken back because all training photographs together lost too much
    bool complete;  // false: the time ran out
    struct orl_choice choice; // the method with the options that were found
};

// Times of frames are processor time on a software renderer, else wall time. Frames of two models
// are compared in turns (eval/timing.h).
// ORL_ERR_DATA: fewer than three training photographs, or a budget that cannot be kept.
enum orl_result orl_trim_run(struct orl_gpu *gpu, const struct orl_scene *scene,
                             const struct orl_trim_params *params,
                             struct orl_trim *trim) ORL_CHECK_RESULT;
void orl_trim_finish(struct orl_trim *trim);

// The report (docs/reference/json.md). A new reference; NULL: no memory.
json_t *orl_trim_report(const struct orl_scene *scene, const char *device, const struct orl_trim *trim);
#endif
