// Finds the least model that still serves: what of a scene can go without a loss that counts.
// Training photographs decide, each rendered without itself; held-out ones confirm once at the end.
#ifndef ORL_EVAL_TRIM_H
#define ORL_EVAL_TRIM_H

#include "eval/choice.h"
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

struct orl_trim_params {
    const struct orl_choice *start; // the method and its options
    const char *out;                // the folder to make
    double tolerance_db;  // the most that the mean over training photographs may lose
    double tolerance_ssim; // the most SSIM that the mean may lose
    double worst_db;      // the most that one of them may lose
    size_t max_bytes;     // instead of a tolerance: least loss within these bytes of the model on
                          // the device; 0: none
    double max_frame_ms;  // the same for the time of a frame; 0: none
    size_t views;         // photographs that look at each step first, evenly chosen
    int size_divide;      // pictures are compared at 1/n of the photographs' size
    double budget_s;      // no new trial starts after this time; 0: no limit
    bool tune;            // tunes the method's options first, which may make room for other steps
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
// are compared in turns (eval/pair_timing.h).
// ORL_ERR_DATA: fewer than three training photographs, or a budget that cannot be kept.
enum orl_result orl_trim_run(struct orl_gpu *gpu, const struct orl_scene *scene,
                             const struct orl_trim_params *params,
                             struct orl_trim *trim) ORL_CHECK_RESULT;
void orl_trim_finish(struct orl_trim *trim);

// The report (docs/reference/json.md). A new reference; NULL: no memory.
json_t *orl_trim_report(const struct orl_scene *scene, const char *device, const struct orl_trim *trim);
#endif
