// Private to the stress test: its parts in stress_*.c.
#ifndef ORL_EVAL_STRESS_INTERNAL_H
#define ORL_EVAL_STRESS_INTERNAL_H

#include <jansson.h>

#include "datasets/figures.h"
#include "datasets/synth.h"
#include "eval/row_store.h"
#include "eval/stress.h"
#include "oriel/render.h"

// --- stress_case.c: a scene in memory, all of which a perturbation may change ---

struct stress_view {
    size_t photo;             // index in the scene
    struct orl_view view;
    struct orl_image picture; // owned: what should be seen, U8 x3; empty in a walk
    struct orl_image depth;   // owned: true z, F32 x1; 0: sky; empty: unknown
    struct orl_scene *scene;  // owned: what may be used for this view; NULL: all of the case
    struct orl_renderer *renderer; // owned: of that scene; NULL: not opened, or the case's
};

struct stress_case {
    struct orl_gpu *gpu;
    struct orl_scene scene;      // its parts are owned; dir: where its files are
    struct orl_image *photos;    // owned: per photograph, U8 x3; of held-out ones empty
    struct orl_image *masks;     // owned: per photograph, U8 x1; empty: none
    int jpeg_quality;            // of the files; 0: lossless
    struct stress_view *views;   // owned: held-out views
    size_t view_count;
    struct stress_view *walk;    // owned: neighbouring frames, for flicker
    size_t walk_count;
    struct orl_renderer *renderer; // owned: of the scene; NULL: not opened
    struct orl_synth *synth;     // draws the truth; NULL: of a real scene
    bool borrowed_synth;
};
// Makes the monument as a scene: photographs, points from their true depth, held-out views.
enum orl_result orl_stress_make_synth(struct orl_gpu *gpu, const struct orl_stress_params *params,
                                      const struct orl_synth_params *generator,
                                      struct stress_case *c);
// Makes a walking figure in a room as a scene, with silhouettes, seen from all sides.
enum orl_result orl_stress_make_figure(struct orl_gpu *gpu, const struct orl_stress_params *params,
                                       struct stress_case *c);
// The generator's settings for `params`.
struct orl_synth_params orl_stress_generator(const struct orl_stress_params *params);
// Takes a scene with photographs of the size that `params` wants.
enum orl_result orl_stress_make_scene(struct orl_gpu *gpu, const struct orl_stress_params *params,
                                      const struct orl_scene *scene, struct stress_case *c);
enum orl_result orl_stress_copy(const struct stress_case *from, struct stress_case *to);
// Gives the view a scene of its own, which the caller may change.
enum orl_result orl_stress_own_scene(const struct stress_case *c, struct stress_view *view);
// Makes the renderers, when nothing changes any more.
enum orl_result orl_stress_open(struct stress_case *c);
void orl_stress_case_finish(struct stress_case *c);
// Sets the radii of all points as prepare does, which drops isolated ones.
enum orl_result orl_stress_set_radii(struct stress_case *c);
// Writes photographs, masks and the hull of the masks into `dir`, which becomes the scene's.
enum orl_result orl_stress_write_files(struct stress_case *c, const char *dir, bool hull);
// What the synthetic camera sees. depth may be NULL.
enum orl_result orl_stress_draw_truth(struct stress_case *c, const struct orl_view *view,
                                      struct orl_image *picture, struct orl_image *depth);

// --- stress_colors.c ---

// The photograph among those in use that would show a point best if nothing hid it, and the pixel;
// -1: none would.
int orl_stress_photo_of(const struct stress_case *c, size_t point, int pixel[2]);
// Gives each point the colour that it has in the photograph that shows it best among those in use,
// so that a trial knows nothing of other photographs. A point that none shows takes the colour of
// the nearest one that is shown. photos: as in struct stress_case.
enum orl_result orl_stress_color_points(const struct orl_log *log, const struct orl_image *photos,
                                        struct orl_scene *scene);

// --- stress_axes.c ---

enum {
    STRESS_NEEDS_TRUTH = 1,
    STRESS_NEEDS_MASKS = 2,
    STRESS_CHANGES_POINTS = 4,
    STRESS_CHANGES_FILES = 8,  // photographs or masks
    STRESS_RECOLORS = 16,      // points take the colours of the changed photographs
    STRESS_OWN_START = 32,     // the first severity is not the unchanged scene
    STRESS_OWN_TRUTH = 64,     // other severities show other pictures: PSNR may rise
    STRESS_ON_HULL = 128,      // methods stand on the visual hull
};

struct stress_axis {
    const char *name, *title, *unit;
    double levels[ORL_STRESS_LEVELS]; // from the mildest on
    unsigned flags;
    // Changes what the generator draws; NULL: nothing.
    void (*generate)(struct orl_synth_params *generator, double level);
    // Changes the scene; NULL: nothing. ORL_ERR_NOT_FOUND, not logged: the scene cannot be made as
    // bad as this.
    enum orl_result (*perturb)(struct stress_case *c, double level, uint64_t seed);
    const char *settings[3]; // KEY=VALUE for the methods that read the key; ended by NULL
};
extern const struct stress_axis orl_stress_axes[]; // ended by a NULL name

// The options of a method on this axis.
void orl_stress_axis_options(const struct stress_axis *axis, struct orl_render_params *render);
// The scene at a severity. `base`: the unchanged scene, whose files are used where they stay the
// same; others are written into `dir`. ORL_ERR_NOT_FOUND: the scene cannot be made as bad as this.
enum orl_result orl_stress_perturb(const struct stress_case *base,
                                   const struct orl_stress_params *params,
                                   const struct stress_axis *axis, double level, const char *dir,
                                   struct stress_case *c);

// --- perturbations ---

// A number of [0, 1), or a normal deviate, that depends on nothing but the arguments.
double orl_stress_uniform(uint64_t seed, uint64_t a, uint64_t b);
double orl_stress_normal(uint64_t seed, uint64_t a, uint64_t b);

// stress_points.c. Levels in percent.
enum orl_result orl_stress_fewer_points(struct stress_case *c, double level, uint64_t seed);
enum orl_result orl_stress_noisy_points(struct stress_case *c, double level, uint64_t seed);
enum orl_result orl_stress_outliers(struct stress_case *c, double level, uint64_t seed);

// stress_photos.c
enum orl_result orl_stress_exposure(struct stress_case *c, double level, uint64_t seed);
enum orl_result orl_stress_aligned_exposure(struct stress_case *c, double level, uint64_t seed);
enum orl_result orl_stress_white_balance(struct stress_case *c, double level, uint64_t seed);
enum orl_result orl_stress_blur(struct stress_case *c, double level, uint64_t seed);
enum orl_result orl_stress_noise(struct stress_case *c, double level, uint64_t seed);
enum orl_result orl_stress_jpeg(struct stress_case *c, double level, uint64_t seed);
enum orl_result orl_stress_passers_by(struct stress_case *c, double level, uint64_t seed);
enum orl_result orl_stress_silhouettes(struct stress_case *c, double level, uint64_t seed);
enum orl_result orl_stress_hull_cameras(struct stress_case *c, double level, uint64_t seed);

// stress_cameras.c
enum orl_result orl_stress_fewer_photos(struct stress_case *c, double level, uint64_t seed);
enum orl_result orl_stress_pose(struct stress_case *c, double level, uint64_t seed);
enum orl_result orl_stress_focal(struct stress_case *c, double level, uint64_t seed);
enum orl_result orl_stress_angle(struct stress_case *c, double level, uint64_t seed);
enum orl_result orl_stress_nearer(struct stress_case *c, double level, uint64_t seed);
enum orl_result orl_stress_farther(struct stress_case *c, double level, uint64_t seed);

// --- stress_measure.c ---

enum { STRESS_FIGURES = 6 };
extern const char *const orl_stress_figures[STRESS_FIGURES]; // psnr_db, ssim, flip, ...

// What no severity may break (docs/reference/stress.md).
struct stress_invariants {
    size_t not_finite;  // values of the pictures that are NaN or infinite
    double brightness;  // mean of the darkest picture over the mean of what should be seen
    double overshoot;   // farthest that a value lies beyond what photographs and points have, linear
    double moved_mean;  // mean change of a value when the view moves by 1e-4 of the scene, of 255
    double moved_share; // share of the pixels that change by more than STRESS_MOVED_STEP then
};
#define STRESS_BRIGHTNESS_MIN 0.05
#define STRESS_OVERSHOOT_MAX 0.35
#define STRESS_MOVED_STEP 16
#define STRESS_MOVED_MEAN_MAX 4.0
#define STRESS_MOVED_SHARE_MAX 0.1
bool orl_stress_invariants_hold(const struct stress_invariants *invariants);

struct stress_result {
    double figures[STRESS_FIGURES]; // means over the views
    double flicker;
    struct stress_invariants invariants;
    struct orl_image picture;       // owned: the first view, U8 x3
};
enum orl_result orl_stress_measure(const struct stress_case *c,
                                   const struct orl_render_params *render,
                                   struct stress_result *result);

// --- stress_report.c ---

// Severity at which `psnr` first is `loss_db` below its first value, linear between severities;
// NAN: nowhere. Missing values (NAN) are passed over.
double orl_stress_loss_at(const double *levels, const double *psnr, size_t count, double loss_db);
// Adds "losses" to the root, which holds "axes", "methods" and "rows".
enum orl_result orl_stress_analyse(const struct orl_log *log, json_t *root);
// Writes stress.json, a figure for each axis, and the page.
enum orl_result orl_stress_write(const struct orl_log *log, const char *out, const json_t *root);
extern const char orl_stress_page[]; // stress.html

#endif
