// Where methods break: one thing at a time gets worse, and every method is measured at each
// severity (docs/reference/stress.md).
#ifndef ORL_EVAL_STRESS_H
#define ORL_EVAL_STRESS_H

#include "eval/row_store.h"
#include "oriel/gpu.h"
#include "oriel/names.h"
#include "oriel/progress.h"

enum {
    ORL_STRESS_LEVELS = 6,    // severities of an axis
    ORL_STRESS_LOSSES = 3,    // losses that are located: orl_stress_losses_db
    ORL_STRESS_SIDE_MIN = 96, // of the longer side of a picture
    ORL_STRESS_SIDE_MAX = 2048,
    ORL_STRESS_PHOTOGRAPHS_MIN = 4,
};
extern const double orl_stress_losses_db[ORL_STRESS_LOSSES]; // 1, 3, 6

#define ORL_STRESS_OPTIONS(ROW) \
    ROW(out, "out", NEEDED("DIR"), \
        "the report: stress.html, stress.json, figures; rows in it are used again") \
    ROW(axes, "axes", LIST("NAME,.."), "what gets worse; default: all that the scene serves") \
    ROW(methods, "method", LIST("NAME"), "methods; default: all") \
    ROW(quick, "quick", FLAG, "an overview: one view, three of the six severities") \
    ROW(side, "size", INT(192, ORL_STRESS_SIDE_MIN, ORL_STRESS_SIDE_MAX, "PX"), \
        "longer side of photographs and pictures") \
    ROW(photographs, "photographs", INT(16, ORL_STRESS_PHOTOGRAPHS_MIN, 500, "N"), \
        "of the synthetic monument") \
    ROW(views, "views", INT(2, 1, 100, "N"), "held-out photographs, at most") \
    ROW(part, "part", PART, \
        "only the K-th of N parts of the rows, kept for a run of all (oriel plan)") \
    ROW(seed, "seed", SEED, "of everything random")
struct orl_stress_params {
    ORL_STRESS_OPTIONS(ORL_OPTION_MEMBER)
    const char *scene; // folder; "synth": the synthetic monument, whose truth is known
    const struct orl_progress *progress;
};

// A method on one axis. Texts belong to the report's JSON.
struct orl_stress_loss {
    const char *axis, *unit, *method;
    double start_db, worst_db;            // PSNR at the first severity; the least of all
    double at[ORL_STRESS_LOSSES];         // severity at which so much is lost; NAN: at none
};

struct orl_stress {
    void *json;                     // json_t *, owned: stress.json
    struct orl_stress_loss *losses; // owned
    size_t loss_count;
    size_t measured, reused, left_out; // rows; left_out: those that failed, as logged
    size_t broken;                     // rows that break an invariant
};

// Names of all axes with their descriptions, for help. False past the end.
bool orl_stress_axis_name(size_t index, const char **name, const char **title);

// Measures the rows that OUT lacks and writes stress.json, stress.html and the SVG figures into
// OUT. After ORL_ERR_CANCELLED OUT keeps the finished rows, and after a part its rows, without a
// report.
enum orl_result orl_stress_run(struct orl_gpu *gpu, const struct orl_stress_params *params,
                               struct orl_stress *stress) ORL_CHECK_RESULT;
void orl_stress_finish(struct orl_stress *stress);

#endif
